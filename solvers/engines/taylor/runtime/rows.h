/* A lane's trajectory as a row of numbers, while it waits. */
#pragma once

#include "state.h"

/* Copies a lane's trajectory to a row, and back. */
static void pack(double *row, const lanes *l, const fixed *f, int lane)
{
    for (int field = 0; field < FIXED; field++)
        row[field] = LANE(((const vec *)f)[field], lane);
    for (int field = 0; field < LANE_STATE; field++)
        memcpy(row + FIXED + field, (const char *)l + sizeof(double)*(size_t)(field*LANES + lane), sizeof(double));
}

static void unpack(const double *row, lanes *l, fixed *f, int lane)
{
    for (int field = 0; field < FIXED; field++)
        LANE(((vec *)f)[field], lane) = row[field];
    for (int field = 0; field < LANE_STATE; field++)
        memcpy((char *)l + sizeof(double)*(size_t)(field*LANES + lane), row + FIXED + field, sizeof(double));
}
