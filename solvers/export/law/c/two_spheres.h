/* Two spheres: motion in a plane by planar collisions, the rest with vectors. */
#pragma once

#include "planar_pairs.h"

/* The ends of pairs that arrive, those of `those`. */
static void find_ends(const law_material *m, const bodies *b, const arrival *rows, const int *those, int count,
                      double rtol, ending *ends)
{
    law_impact impacts[PAIRS];
    law_collision found[PAIRS];
    plane planes[PAIRS];
    int flat[PAIRS], solid[PAIRS], flats = 0, solids = 0;
    for (int k = 0; k < count; k++) {
        planes[flats] = plane_of(b, rows + those[k]);
        if (planes[flats].is_plane) {
            impacts[flats] = in_plane(b, rows + those[k], planes + flats);
            flat[flats++] = those[k];
        } else
            solid[solids++] = those[k];
    }
    if (flats)
        collide_planar(m, impacts, flats, rtol, found);
    for (int k = 0; k < flats; k++)
        ends[flat[k]] = out_of_plane(b, rows + flat[k], planes + k, found + k);
    if (solids)
        space_find_ends_with_vectors(m, b, rows, solid, solids, rtol, ends);
}
