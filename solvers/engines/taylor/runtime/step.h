/* A step: the series of the states about its start, and the step length for which they are accurate. */
#pragma once

#include "damped_sum.h"
#include "model.h"
#include "state.h"
#include "tangents.h"
#include "turning_axes.h"

/* The bits of a positive double, read as an integer, approximate its logarithm, with an error of some percent. */
static const int64_t ONE = 0x3ff0000000000000;

static inline vec power_of(vec logarithm)
{
    logarithm = vec_min(logarithm, splat(60.0*4503599627370496.0));
    return from_pattern((word)(to_whole(logarithm) + ONE));
}

/* Least logarithm of a state's scale over `share` times its coefficient k; `least_room` if that is smaller. */
static inline mask room_of(const mask *magnitude, const vec (*a)[TERMS], int k, double share, mask least_room)
{
    EACH_SIZE(state)
        least_room = least(magnitude[state] - (mask)pattern(share*size_of(&a[0][k], TERMS, state)), least_room);
    return least_room;
}

#if GRADIENTS && !BACKWARD
static inline vec room(const mask *magnitude, const vec (*a)[TERMS], int k, double share, const tangents *along)
{
    mask least_so_far = room_of(magnitude, a, k, share, splat_mask(INT64_MAX));
    EACH_OF(group, along->requested)
        least_so_far = room_of(along->scale[group], (const vec (*)[TERMS])along->t[group], k, share, least_so_far);
    return to_vec(least_so_far);
}
#define ROOM(k, share) room(magnitude, a, k, share, along)
#else
#define ROOM(k, share) to_vec(room_of(magnitude, a, k, share, splat_mask(INT64_MAX)))
#endif

/* The step for which the last two coefficients are below the tolerance (Jorba & Zou 2005, section 3.2). Lanes limited by
 * a decaying mode are returned in `creeps`, with the step of the damped sum. */
#if GRADIENTS && !BACKWARD
static inline vec step_size(const series *s, const fixed *f, mask *creeps, const tangents *along)
#else
static inline vec step_size(const series *s, const fixed *f, mask *creeps)
#endif
{
    const vec (*a)[TERMS] = (const vec (*)[TERMS])s;
    mask magnitude[STATES];
    EACH_SIZE(state) {
        vec size = size_of(a[0], TERMS, state);
        magnitude[state] = (mask)pattern(state == NORMAL_VELOCITY ? size + f->rest : state == GAP ? size : size + 1e-3);
    }
    vec allowed = to_vec((mask)pattern(f->tolerance) - ONE);
    vec last = ROOM(ORDER, 1.0), before = ROOM(ORDER - 1, 1.0);
    vec step = vec_min((allowed + last)*(1.0/ORDER), (allowed + before)*(1.0/(ORDER - 1)));
    /* for a mode exp(-z), z is ORDER times the ratio of the last two terms */
    *creeps = step + before - last > log2(STIFF_FROM/ORDER)*4503599627370496.0;
    if (bits(*creeps)) {
        vec damped = splat(HUGE_VAL);
        for (int k = EXACT + 1; k <= ORDER; k++) {
            vec own = ROOM(k, STRICTER*(1.0 - damping(k)));
            damped = vec_min(damped, (allowed + own)*(1.0/k));
        }
        step = choose(*creeps, damped, step);
    }
    return power_of(step);
}

#define TERM(k) if (k < ORDER) { coefficients(w, c, film, shear, moving, k); TURN(w, k) }
#define GLASS_TERM(k) if (k <= ORDER) glass_coefficients(s, c, k);

/* Series of the states from their first coefficients. Unless others are read later, they are local: most of their
 * coefficients then stay in registers.
 */
#if SPACE
SCHEDULED OUTLINE void expand(series *RESTRICT s, const constants *c, vec film, vec shear, mask moving, const axes *turning)
#elif BACKWARD
SCHEDULED OUTLINE vec expand(series *RESTRICT s, const constants *c, vec film, vec shear, mask moving)
#else
SCHEDULED OUTLINE void expand(series *RESTRICT s, const constants *c, vec film, vec shear, mask moving)
#endif
{
#if READS_SERIES || FRICTION
    series *w = s;
    EVERY(TERM)
#else
    series local, *w = &local;
    vec (*a)[TERMS] = (vec (*)[TERMS])s, (*b)[TERMS] = (vec (*)[TERMS])w;
    UNROLL
    for (int state = 0; state < STATES; state++)
        b[state][0] = a[state][0];
    EVERY(TERM)
    UNROLL
    for (int state = 0; state < STATES; state++)
        UNROLL
        for (int k = 1; k <= ORDER; k++)
            a[state][k] = b[state][k];
    UNROLL
    for (int k = 0; k < ORDER; k++)
        s->acceleration[k] = w->acceleration[k];
#endif
    s->acceleration[ORDER] = splat(0.0); /* not computed at this order */
#if BACKWARD
    return contraction(w, c, film, shear);
#endif
}

#if BACKWARD
/* The same with all series, for the sweep back. */
OUTLINE void expand_whole(series *w, const constants *c, vec film, vec shear, mask moving)
{
    EVERY(TERM)
}
#endif

OUTLINE void expand_glass(series *s, const constants *c)
{
    EVERY(GLASS_TERM)
}
