/* A sphere and a wall: the line of centres does not turn, so that planar collisions give the motion in space exactly.
 *
 * The normal motion does not depend on the tangential one. Friction is linear in sliding and rolling and the same in
 * every direction along the wall, so both components of these vectors go through one linear map. Two planar collisions
 * with the same normal motion give it: one that slides, and one that slides and spins. Spin along the normal stays.
 */

/* The two planar collisions: sliding and rolling are as fast as the approach. */
static void along_wall(const bodies *b, const arrival *a, law_impact *slides, law_impact *both)
{
    slides->speed = a->speed;
    slides->angle = 0.7853981633974483;
    slides->spin = slides->partner_spin = 0.0;
    *both = *slides;
    both->spin = a->speed/b->radius[0];
}

static ending beside_wall(const bodies *b, const arrival *a, const law_collision *slides, const law_collision *both)
{
    ending made = planar_end(b, a, slides);
    double radius = b->radius[0], unit = radius/a->speed, roll = unit*slides->final_spin;
    vector3 sliding = times(-1.0, a->sliding), rolling = times(radius, cross(a->normal, a->spin[0])), rolls;
    if (made.status == LAW_OK)
        made.status = both->status;
    if (made.status != LAW_OK || made.outcome == LAW_STICK)
        return made;
    made.sliding = times(slides->tangential_restitution, sliding);
    made.sliding = plus(made.sliding, both->tangential_restitution - slides->tangential_restitution, rolling);
    rolls = plus(times(roll, sliding), unit*both->final_spin - roll, rolling);
    made.spin[0] = times(dot(a->spin[0], a->normal), a->normal);
    made.spin[0] = plus(made.spin[0], 1.0/radius, cross(rolls, a->normal));
    double first = length(plus(sliding, -1.0, rolling)), last = length(plus(made.sliding, -1.0, rolls));
    made.slip = first > 0.0 ? last/first : (double)NAN;
    return made;
}

/* The ends of pairs that arrive, those of `those`. */
static void find_ends(const law_material *m, const bodies *b, const arrival *rows, const int *those, int count,
                      double rtol, int budget, ending *ends)
{
    law_impact impacts[2*PAIRS];
    law_collision found[2*PAIRS];
    for (int k = 0; k < count; k++) {
        along_wall(b, rows + those[k], impacts + 2*k, impacts + 2*k + 1);
        set_unknown(found + 2*k, LAW_OK);
        set_unknown(found + 2*k + 1, LAW_OK);
    }
    if (count)
        collide_planar(m, impacts, 2*count, rtol, budget, found);
    for (int k = 0; k < count; k++)
        ends[those[k]] = beside_wall(b, rows + those[k], found + 2*k, found + 2*k + 1);
}

