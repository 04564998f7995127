/* The energy ledger of a trajectory, in m v0^2: energies of the initial and final states, losses and works as
 * integrals along the trajectory, and losses at rebounds. The terms are computed independently, so their residual is
 * the numerical error.
 */
#pragma once

#include "friction.h"
#include "layout.h"
#include "model.h"

#if WITH_LEDGER
/* Books the loss of a rebound from this state. */
static void book_rebound(ledger *book, const constants *c, const vec *y, int lane)
{
    book->dry += in_lane(rebound_loss(c, y), lane);
}

/* Books the remaining kinetic energy of a rebound that rests as dry contact. */
static void book_rest(ledger *book, const vec *y, int lane)
{
    book->dry += 0.5*LANE(y[NORMAL_VELOCITY], lane)*LANE(y[NORMAL_VELOCITY], lane);
}

/* Closes the ledger with the final state of a lane's trajectory. */
static void close_book(ledger *book, const constants *c, const vec *y, int lane)
{
    vec first[STATES], stored[2][ENERGIES];
    start(c, first);
    energies(c, first, stored[0]);
    energies(c, y, stored[1]);
    book->initial = LANE(stored[0][0], lane);
    book->final = LANE(stored[1][0], lane);
    book->lifted = ENERGIES > 1 ? LANE(stored[1][ENERGIES - 1], lane) - LANE(stored[0][ENERGIES - 1], lane) : 0.0;
    book->normal = LANE(y[NORMAL_LOSS], lane);
#if defined(TANGENTIAL)
    book->tangential = LANE(y[TANGENTIAL_LOSS], lane);
#endif
#if FRICTION
    book->friction = LANE(y[FRICTION_LOSS], lane);
#endif
#if ATTRACTION
    book->attraction = LANE(y[ATTRACTION_WORK], lane);
#endif
#if CAPILLARY_STATE
    book->capillary = LANE(y[CAPILLARY_WORK], lane) - book->attraction; /* the state includes all attractions */
#endif
#if OWN_TERMS
    book->lifted = STRINGS ? LANE(stored[1][STRINGS], lane) - LANE(stored[0][STRINGS], lane) : 0.0;
#if defined(OWN_ENERGY)
    book->own_terms += LANE(stored[1][OWN_ENERGY], lane) - LANE(stored[0][OWN_ENERGY], lane);
#endif
#if defined(OWN_WORKS)
    book->own_terms += LANE(y[OWN_WORK], lane);
#endif
#endif /* OWN_TERMS */
    book->momentum = in_lane(booked_momentum(c, y), lane);
}
#endif
