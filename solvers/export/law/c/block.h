/* A block of collisions of one material that a kernel integrates side by side, and what is said of them. */
#pragma once

#include "vector.h"

enum { BLOCK = 512 }; /* so many that few lanes idle at its end */

typedef struct {
    double speed[BLOCK], angle[BLOCK], spin[BLOCK], partner_spin[BLOCK];
    long which[BLOCK]; /* place of their results */
    long count;
} block;

static void add_impact(block *b, const law_impact *impact, long which)
{
    b->speed[b->count] = impact->speed;
    b->angle[b->count] = impact->angle;
    b->spin[b->count] = impact->spin;
    b->partner_spin[b->count] = impact->partner_spin;
    b->which[b->count++] = which;
}

/* A collision of which nothing is known but why. */
static void set_unknown(law_collision *found, int status)
{
    found->status = status;
    found->outcome = LAW_UNDECIDED;
    found->certified = 0;
    found->rebound = LAW_NO_REBOUND;
    found->restitution = found->tangential_restitution = found->slip_restitution = (double)NAN;
    found->contact_time = found->rotation = found->smallest_gap = found->final_gap = (double)NAN;
    found->final_spin = found->final_partner_spin = found->final_rotation_rate = (double)NAN;
}

/* Of a stick only outcome and restitution are defined by the physics. */
static void hide_stick(law_collision *stick)
{
    law_collision shown;
    set_unknown(&shown, LAW_OK);
    shown.outcome = stick->outcome;
    shown.certified = stick->certified;
    shown.rebound = stick->rebound;
    shown.restitution = 0.0;
    *stick = shown;
}
