/* From derivatives by groups to derivatives by quantities in SI, for a vector of collisions at once. */
#pragma once

#include "model.h"
#include "state.h"

#if GRADIENTS
static void in_quantities(const queue *q, long first)
{
    fixed f;
    for (; first < q->count; first += LANES) {
        int many = q->count - first < LANES ? (int)(q->count - first) : LANES;
        vec given[QUANTITIES], slope[GROUPS], row[GROUPS][RESULTS];
        for (int k = 0; k < QUANTITIES; k++)
            EACH_LANE(lane) LANE(given[k], lane) = quantity(q, k, first + (lane < many ? lane : 0));
        scale(&f.c, given);
        EACH_LANE(lane)
        {
            const double *own = q->by_group + (first + (lane < many ? lane : 0))*GROUPS*RESULTS;
            for (int place = 0; place < GROUPS*RESULTS; place++)
                LANE(row[place/RESULTS][place%RESULTS], lane) = own[place];
        }
        for (int k = 0; k < QUANTITIES; k++) {
            scale_along(&f.c, given, k, slope);
            for (int result = 0; result < RESULTS; result++) {
                vec sum = splat(0.0);
                for (int group = 0; group < GROUPS; group++)
                    sum += only(slope[group] != 0.0, slope[group]*row[group][result]);
                for (int lane = 0; lane < many; lane++)
                    q->gradients[((first + lane)*QUANTITIES + k)*RESULTS + result] = LANE(sum, lane);
            }
        }
    }
}
#endif
