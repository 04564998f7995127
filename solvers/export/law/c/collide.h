/* What a host calls: a block for each kernel is filled, and run when it is full. */

/* Planar collisions of those that are marked as LAW_OK. Of a stick no number is used. */
static void collide_planar(
    const law_material *material, const law_impact *impacts, long count, double rtol, int budget, law_collision *found)
{
    block oblique, head_on;
    oblique.count = head_on.count = 0;
    for (long k = 0; k < count; k++) {
        const law_impact *impact = impacts + k;
        if (found[k].status != LAW_OK)
            ;
        else if (impact->angle > 0.0 || impact->spin != 0.0 || impact->partner_spin != 0.0)
            add_impact(&oblique, impact, k);
        else
            add_impact(&head_on, impact, k);
        int last = k == count - 1;
        if (oblique.count == BLOCK || (last && oblique.count > 0)) {
            plane_run_block(material, &oblique, rtol, budget, found);
            oblique.count = 0;
        }
        if (head_on.count == BLOCK || (last && head_on.count > 0)) {
            head_on_run_block(material, &head_on, rtol, budget, found);
            head_on.count = 0;
        }
    }
}

long law_collide_many(
    const law_material *material, const law_impact *impacts, long count, double rtol, int budget, law_collision *found)
{
    long failed = 0;
    int wrong = check_material(material);
    if (wrong == LAW_OK)
        wrong = check_settings(rtol, budget);
    for (long k = 0; k < count; k++)
        set_unknown(found + k, wrong == LAW_OK ? check_impact(impacts + k) : wrong);
    collide_planar(material, impacts, count, rtol, budget, found);
    for (long k = 0; k < count; k++) {
        if (found[k].outcome == LAW_STICK)
            hide_stick(found + k);
        failed += found[k].status != LAW_OK;
    }
    return failed;
}

int law_collide(const law_material *material, const law_impact *impact, double rtol, int budget, law_collision *found)
{
    law_collide_many(material, impact, 1, rtol, budget, found);
    return found->status;
}

