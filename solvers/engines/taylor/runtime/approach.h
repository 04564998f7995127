/* Approach certificate: a stick decided at initial contact, before any step (derive/equations/certificates/approach.py).
 *
 * Bounds of the closing speed are carried from part to part of the film. While they exclude the rebound criteria, the
 * energy of an approach that has come so far is below a bound, and so is that of one that has turned before.
 */
#pragma once

#include "automaton.h"
#include "certificates.h"

#if APPROACH_BOUNDS
/* The next part of the film for bounds of the approach: a gap, and the largest speed there. */
static inline vec next_part(const constants *c, vec *bounds)
{
    vec deeper, slowed, fastest;
    approach_step(c, bounds, &deeper, &slowed, &fastest);
    bounds[GAP] = deeper;
    bounds[NORMAL_VELOCITY] = -slowed;
    return fastest;
}

/* Clearance of the glass criterion in the part of the film that ends here, for the largest speed in it. */
static inline mask clear_of_glass(const constants *c, const vec *bounds, vec fastest, double margin)
{
    vec there[STATES];
    memcpy(there, bounds, sizeof there);
    there[NORMAL_VELOCITY] = fastest*(-1.0/(1.0 - margin));
    return glass_clearance(c, there) > 0.0;
}

#if STRINGS && PENDULUM
/* Lanes in which the film stops the doublet, and every rebound that a criterion may cause, for good. */
static mask held_on_approach(const constants *c, const vec *y, vec contact, double tolerance)
{
    double margin = SAFETY*tolerance;
    vec film, recoil, rebound, beneath, bounds[STATES], there[STATES];
    vec error = pendulum_error(c, y, margin);
    pendulum_stops(c, y, &film, &recoil);
    mask possible = (contact < y[GAP]) & is_stopped(film, error);
    memcpy(bounds, y, sizeof bounds);
    memcpy(there, y, sizeof there);
    for (int part = 0; part < APPROACH_PARTS && bits(possible); part++) {
        there[GAP] = bounds[GAP];
        there[NORMAL_VELOCITY] = -next_part(c, bounds);
        pendulum_rebounds(c, there, &rebound, &beneath);
        possible &= clear_of_glass(c, bounds, -there[NORMAL_VELOCITY], margin) | is_stopped(rebound, error);
    }
    pendulum_rebounds(c, bounds, &rebound, &beneath);
    return possible & is_stopped(beneath, error);
}
#elif !STRINGS
/* Lanes in which the energy falls below the barrier beyond the film before a criterion can be met. */
static mask held_on_approach(const constants *c, const vec *y, const barrier *b, vec contact, double tolerance)
{
    double margin = SAFETY*tolerance;
    vec none = splat(-INFINITY), outward, bounds[STATES];
    vec height = choose(b->near_gap >= y[GAP], b->near_height, choose(b->far_gap >= y[GAP], b->far_height, none));
    vec rest = b->largest - 0.5*y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY], zero = splat(0.0);
    mask possible = (contact < y[GAP]) & is_below_barrier(rest, height, margin, b->largest, zero), proved = splat_mask(0);
    if (!bits(possible))
        return proved;
    approach_force(c, y, &outward);
    memcpy(bounds, y, sizeof bounds);
    for (int part = 0; part < APPROACH_PARTS && bits(possible & NOT(proved)); part++) {
        vec fastest = next_part(c, bounds), slowed = bounds[NORMAL_VELOCITY];
        possible &= clear_of_glass(c, bounds, fastest, margin);
        vec energy = 0.5*slowed*slowed + rest + outward*(y[GAP] - bounds[GAP]);
        proved |= possible & is_below_barrier(energy, height, margin, b->largest, zero);
    }
    return proved;
}
#endif
#endif
