/* A lane's trajectory as a row of numbers, while it waits. */
#pragma once

#include "state.h"

typedef double word_of_lane __attribute__((may_alias)); /* fields are doubles or integers */

/* Copies a lane's trajectory to a row, and back. */
static void pack(double *row, const lanes *l, const fixed *f, int lane)
{
    for (int field = 0; field < FIXED; field++)
        row[field] = ((const vec *)f)[field][lane];
    for (int field = 0; field < LANE_STATE; field++)
        row[FIXED + field] = ((const word_of_lane *)l)[field*LANES + lane];
}

static void unpack(const double *row, lanes *l, fixed *f, int lane)
{
    for (int field = 0; field < FIXED; field++)
        ((double *)&((vec *)f)[field])[lane] = row[field];
    for (int field = 0; field < LANE_STATE; field++)
        ((word_of_lane *)l)[field*LANES + lane] = row[FIXED + field];
}
