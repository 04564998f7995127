/* Kinks of a user's laws: a step ends where a guard vanishes, as its series know nothing of the other side.
 *
 * Only kernels with kinks contain the blocks `#if KINKS` (source.py). Behind a kink the side is that of the guard, which
 * is rounded within WIDTH of derive/user/kinks.py: there steps are as short as the series demand.
 */
#pragma once

#include "events.h"
#include "model.h"

#if KINKS
/* Of a guard: from NEAR_KINK on, a step goes half of the way, so that derivatives by a step of the force are those of the
 * whole rounded side; below ON_KINK the series see it. */
static const double NEAR_KINK = 1e-6, ON_KINK = 4e-10;

/* The part of a step before the first kink. */
OUTLINE vec before_kinks(const series *s, vec h, mask creeps)
{
    const vec *guards[] = {KINKS_OF(s)};
    first_event first = {splat(NO_ROOT), splat_mask(0), splat(0.0)};
    for (int which = 0; which < KINKS; which++) {
        vec guard[TERMS];
        for (int k = 0; k <= ORDER; k++)
            guard[k] = k > EXACT ? choose(creeps, damping(k)*guards[which][k], guards[which][k]) : guards[which][k];
        vec size = vec_abs(guard[0]), sign = choose(guard[0] > 0.0, splat(1.0), splat(-1.0));
        mask on = (size <= ON_KINK) & (guard[1] != 0.0);
        h = choose(on, vec_min(h, vec_abs(4.0*ON_KINK/guard[1])), h); /* off it, for laws that no state's series has */
        vec target = sign*choose(size > 2.0*NEAR_KINK, splat(NEAR_KINK), 0.5*size);
        mask close = (size > ON_KINK) & NOT(least_of(guard, h) > NEAR_KINK);
        if (bits(close))
            look(&first, close, guard, target, sign, h, splat_mask(0));
    }
    return choose(first.time <= 1.0, h*first.time, h);
}
#endif /* KINKS */
