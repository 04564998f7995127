/* Two spheres: motion in a plane by planar collisions, the rest with vectors. */

/* The planar collision of a pair in a plane; an angle is not negative, so that the axis may have to be turned over. */
static law_impact in_plane(const bodies *b, const arrival *a, const plane *p)
{
    law_impact made;
    double sense = p->turning < 0.0 ? -1.0 : 1.0;
    made.speed = a->speed;
    made.angle = atan2(b->contact*fabs(p->turning), a->speed);
    made.spin = sense*p->spin[0];
    made.partner_spin = sense*p->spin[1];
    return made;
}

/* What rounding leaves of the spins out of the plane stays as it is. */
static ending out_of_plane(const bodies *b, const arrival *a, const plane *p, const law_collision *found)
{
    ending made = planar_end(b, a, found);
    vector3 axis = times(p->turning < 0.0 ? -1.0 : 1.0, p->axis);
    made.normal = plus(times(cos(found->rotation), a->normal), sin(found->rotation), cross(axis, a->normal));
    if (found->outcome == LAW_STICK)
        return made;
    made.slip = fabs(found->slip_restitution); /* a ratio of lengths */
    made.turning = times(found->final_rotation_rate, axis);
    for (int k = 0; k < 2; k++) {
        made.spin[k] = plus(a->spin[k], -p->spin[k], p->axis);
        made.spin[k] = plus(made.spin[k], k ? found->final_partner_spin : found->final_spin, axis);
    }
    return made;
}

/* The ends of pairs that arrive, those of `those`. */
static void find_ends(const law_material *m, const bodies *b, const arrival *rows, const int *those, int count,
                      double rtol, int budget, ending *ends)
{
    law_impact impacts[PAIRS];
    law_collision found[PAIRS];
    plane planes[PAIRS];
    int flat[PAIRS], solid[PAIRS], flats = 0, solids = 0;
    for (int k = 0; k < count; k++) {
        planes[flats] = plane_of(b, rows + those[k]);
        if (planes[flats].is_plane) {
            impacts[flats] = in_plane(b, rows + those[k], planes + flats);
            set_unknown(found + flats, LAW_OK);
            flat[flats++] = those[k];
        } else
            solid[solids++] = those[k];
    }
    if (flats)
        collide_planar(m, impacts, flats, rtol, budget, found);
    for (int k = 0; k < flats; k++)
        ends[flat[k]] = out_of_plane(b, rows + flat[k], planes + k, found + k);
    if (solids)
        space_find_ends_with_vectors(m, b, rows, solid, solids, rtol, budget, ends);
}

