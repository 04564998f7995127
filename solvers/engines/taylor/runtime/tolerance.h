/* Tolerances, as in solvers/engines/casadi/integrators.py.
 *
 * Near grazing incidence the doublet turns within a tiny part of x0. At very small angles without attraction, it is
 * opened by a force of tan^2(theta0) x0/a in v0^2/x0.
 */
#pragma once

#include "automaton.h"
#include "state.h"

static const double PER_STEP = 0.5; /* errors of the steps add up: with it e_n keeps rtol times its conditioning */
#if OBLIQUE
static const double TIGHTEST = 1e-14;
#endif

/* Sets the tolerances of trajectories from their constants; returns the lanes beyond any tolerance. */
static unsigned set_tolerance(const queue *q, fixed *f)
{
    unsigned beyond = 0;
    double rtol = PER_STEP*q->rtol;
    f->tolerance = splat(rtol);
    f->rest = splat(SLOW);
#if OBLIQUE
    vec centrifugal = f->c.obliquity*f->c.obliquity*f->c.aspect*(1.0/16.0), net = centrifugal;
#if STRINGS
    net -= f->c.weight*f->c.aspect/f->c.string_ratio;
#endif
    EACH_LANE(lane)
    {
        double of = LANE(centrifugal, lane);
        if (!BRIDGE && !STRINGS && of > 0.0 && of < 1e-6)
            LANE(f->rest, lane) = pow(10.0, fmax(4.0*floor(log10(of)/4.0) - 3.0, -200.0));
        if (LANE(net, lane) > 1.0)
            LANE(f->tolerance, lane) = fmax(rtol*pow(10.0, -ceil(log10(LANE(net, lane)))), fmin(rtol, TIGHTEST));
        if (is_too_oblique(LANE(f->c.obliquity, lane), LANE(f->c.aspect, lane)))
            beyond |= 1u << lane;
    }
#endif
    return beyond;
}
