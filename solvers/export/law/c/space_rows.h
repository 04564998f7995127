/* Pairs by the kernel with vectors, in the laboratory's axes. */
#pragma once

#include "ends.h"
#include "integrate.h"

static vector3 shown_vector(const answer *a, int first, double unit)
{
    return times(unit, vector_of(a->shown + first));
}

static void put_column(double (*columns)[PAIRS], int first, int row, vector3 v)
{
    columns[first][row] = v.x;
    columns[first + 1][row] = v.y;
    columns[first + 2][row] = v.z;
}

static ending end_with_vectors(const bodies *b, const arrival *a, const answer *found, double unit)
{
    ending made = as_arrived(b, a);
    made.status = found->status > LAST_ANSWER ? found->status : LAW_OK;
    made.outcome = found->outcome;
    made.certified = found->certified;
    if (found->status != DECIDED)
        return made;
    made.time = found->time*b->film/a->speed;
    made.gap = found->final_gap*b->film;
    made.slip = found->slip;
    made.opening = a->speed*found->shown[AT_RESTITUTION];
    made.normal = shown_vector(found, AT_FINAL_NORMAL, 1.0);
    made.turning = shown_vector(found, AT_FINAL_ROTATION_RATE, unit);
    made.spin[0] = shown_vector(found, AT_FINAL_SPIN, unit);
    made.spin[1] = shown_vector(found, AT_FINAL_SPIN_PARTNER, unit);
    return made;
}

static void find_ends_with_vectors(const law_material *m, const bodies *b, const arrival *rows, const int *those,
                                   int count, double rtol, int budget, ending *ends)
{
    double values[QUANTITIES][PAIRS], unit[PAIRS];
    buffer columns[QUANTITIES];
    answer found[PAIRS];
    set_material(columns, m);
    columns[SI_SPEED].at = values[SI_SPEED];
    columns[SI_SPEED].bytes = sizeof values[SI_SPEED];
    for (int k = SI_INITIAL_NORMAL_X; k <= SI_IMPACT_PARTNER_SPIN_Z; k++) {
        columns[k].at = values[k];
        columns[k].bytes = sizeof values[k];
    }
    for (int k = 0; k < count; k++) {
        const arrival *a = rows + those[k];
        values[SI_SPEED][k] = a->speed;
        put_column(values, SI_INITIAL_NORMAL_X, k, a->normal);
        put_column(values, SI_IMPACT_TURNING_X, k, a->turning);
        put_column(values, SI_IMPACT_SPIN_X, k, a->spin[0]);
        put_column(values, SI_IMPACT_PARTNER_SPIN_X, k, a->spin[1]);
    }
    integrate(columns, count, rtol, budget, found, NULL);
    find_rate_scales(columns, count, unit);
    for (int k = 0; k < count; k++)
        ends[those[k]] = end_with_vectors(b, rows + those[k], found + k, unit[k]);
}
