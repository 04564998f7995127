/* What a host calls for collisions in space: any velocities and spins of two spheres, or of a sphere and a wall. */

/* At most PAIRS pairs. */
static void collide_block(const law_material *m, const bodies *b, const law_pair *pairs, int count, double rtol,
                          int budget, law_pair_after *after)
{
    arrival rows[PAIRS];
    ending ends[PAIRS];
    int those[PAIRS], arriving = 0;
    for (int k = 0; k < count; k++) {
        int status = arrives(b, pairs + k, rows + k);
        if (status == LAW_OK)
            those[arriving++] = k;
        else
            refuse(status, after + k);
    }
    find_ends(m, b, rows, those, arriving, rtol, budget, ends);
    for (int k = 0; k < arriving; k++)
        both_after(b, rows + those[k], ends + those[k], after + those[k]);
}

long law_collide_pair_many(
    const law_material *material, const law_pair *pairs, long count, double rtol, int budget, law_pair_after *after)
{
    long failed = 0;
    int wrong = check_material(material);
    if (wrong == LAW_OK)
        wrong = check_settings(rtol, budget);
    if (wrong == LAW_OK) {
        bodies b = bodies_of(material);
        for (long first = 0; first < count; first += PAIRS)
            collide_block(material, &b, pairs + first, count - first < PAIRS ? (int)(count - first) : PAIRS, rtol,
                          budget, after + first);
    }
    for (long k = 0; k < count; k++) {
        if (wrong != LAW_OK)
            refuse(wrong, after + k);
        failed += after[k].status != LAW_OK;
    }
    return failed;
}

int law_collide_pair(const law_material *material, const law_pair *pair, double rtol, int budget, law_pair_after *after)
{
    law_collide_pair_many(material, pair, 1, rtol, budget, after);
    return after->status;
}

