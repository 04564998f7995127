/* The slow-manifold jump: a doublet goes on from a later gap, with the state of the slow manifold there.
 *
 * Lanes that turn inside the film are parked, and collisions that surely turn there do not begin at all. When a full
 * vector of them is available, each gets a gap of its own, as late as the series of the manifold are accurate. It
 * jumps if no event is met on the way and any two solutions in the tube are closer than the tolerance at the end
 * (slow_manifold.h). Otherwise it goes on as it is.
 *
 * Neither time nor angle are known after a jump, nor the smallest gap if the approach is left out (`jumps` of the task).
 */
#pragma once

#include "energy_barrier.h"
#include "model.h"
#include "rows.h"
#include "slow_manifold.h"
#include "state.h"

#if JUMPS
#if CAPILLARY_STATE
static vec attraction_in_logarithm(const constants *c, const vec *y, vec gap)
{
    (void)y;
    slow_series s;
    place at;
    look_at(&s, c, gap, &at);
    return gap*at.attractions;
}
#endif

/* The parked lanes jump where they may, and all return to the queue. */
OUTLINE void jump(queue *q)
{
    lanes l;
    fixed f;
    slow_series s;
    int count = q->jump_count < LANES ? q->jump_count : LANES;
    for (int lane = 0; lane < LANES; lane++)
        unpack(q->for_jump[lane < count ? lane : 0], &l, &f, lane);
    vec last = LAST*vec_smaller(splat(1.0), f.edge);
    opening from = {l.y[GAP], l.y[GAP], splat(0.0)}, falls = from;
    place here;
    look_at(&s, &f.c, l.y[GAP], &here);
    from.lag = vec_abs(l.y[ORBITAL_MOMENTUM] - here.rigid);
    mask waits = NOT(l.closing);
#if LEAPS
    if (bits(l.closing)) {
        waits |= l.closing & descends(&s, &f, l.y, &falls);
        from.lowest = choose(l.closing, falls.lowest, from.lowest);
        from.highest = choose(l.closing, falls.highest, from.highest);
        from.lag = choose(l.closing, falls.lag, from.lag);
    }
#endif
    vec start = from.highest;
    for (int target = 0; target < TARGETS && bits(waits); target++) {
        vec low = vec_log(start), high = vec_log(last);
        for (int k = 0; k < BISECTIONS; k++) {
            vec middle = 0.5*(low + high);
            mask strong = separation(&s, &f.c, vec_exp(middle)) > MORE[target]*separation_for(q->rtol);
            low = choose(strong, middle, low);
            high = choose(strong, high, middle);
        }
        vec to = vec_exp(low), reached[2] = {splat(0.0), splat(0.0)};
        vec wrong = on_manifold(&s, &f.c, to, &reached[0], &reached[1]);
        mask jumps = waits & (to > start) & (wrong <= COARSEST);
        if (!bits(jumps))
            continue;
        jumps &= forgets(&s, &f.c, &from, to, wrong, reached, f.tolerance, last);
        if (!bits(jumps))
            continue;
#if CAPILLARY_STATE
        vec work = integral(&f.c, l.y, vec_log(l.y[GAP]), vec_log(to), attraction_in_logarithm);
        l.y[CAPILLARY_WORK] += only(jumps, work);
#endif
        l.y[GAP] = choose(jumps, to, l.y[GAP]);
        l.y[NORMAL_VELOCITY] = choose(jumps, reached[0], l.y[NORMAL_VELOCITY]);
        l.y[ORBITAL_MOMENTUM] = choose(jumps, reached[1], l.y[ORBITAL_MOMENTUM]);
        l.closing &= NOT(jumps);
        l.crept = only_whole(NOT(jumps), l.crept);
        waits &= NOT(jumps);
    }
    for (int lane = 0; lane < count; lane++)
        pack(q->resumed[q->resumes++], &l, &f, lane);
    q->jump_count -= count;
    memmove(q->for_jump[0], q->for_jump[count], sizeof q->for_jump[0]*(size_t)q->jump_count);
}
#endif
