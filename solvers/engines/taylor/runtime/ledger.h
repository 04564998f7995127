/* The energy ledger of a trajectory, in m v0^2: energies from the states at initial contact and at the end, losses and works as
 * integrals along the trajectory, and what rebounds took. Nothing is made to close: what is left over is the trajectory's error.
 */
#pragma once

#include "layout.h"
#include "model.h"

#if WITH_LEDGER
/* What a rebound from this state takes. */
static void book_rebound(ledger *book, const constants *c, const vec *y, int lane)
{
    book->dry += rebound_loss(c, y)[lane];
}

/* Contact takes what is left of a rebound that rests. */
static void book_rest(ledger *book, const vec *y, int lane)
{
    book->dry += 0.5*y[NORMAL_VELOCITY][lane]*y[NORMAL_VELOCITY][lane];
}

/* The trajectory of a lane is over in this state. */
static void close_book(ledger *book, const constants *c, const vec *y, int lane)
{
    vec first[STATES], stored[2][ENERGIES];
    start(c, first);
    energies(c, first, stored[0]);
    energies(c, y, stored[1]);
    book->initial = stored[0][0][lane];
    book->final = stored[1][0][lane];
    book->lifted = ENERGIES > 1 ? stored[1][ENERGIES - 1][lane] - stored[0][ENERGIES - 1][lane] : 0.0;
    book->normal = y[NORMAL_LOSS][lane];
#if defined(TANGENTIAL)
    book->tangential = y[TANGENTIAL_LOSS][lane];
#endif
#if ATTRACTION
    book->attraction = y[ATTRACTION_WORK][lane];
#endif
#if CAPILLARY_STATE
    book->capillary = y[CAPILLARY_WORK][lane] - book->attraction; /* the state is the work against all that attracts */
#endif
    book->momentum = booked_momentum(c, y)[lane];
}
#endif
