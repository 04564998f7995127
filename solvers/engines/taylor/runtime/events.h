/* The first root of a series within a step, in each lane: by bounds, then Bernstein coefficients, then isolation.
 *
 * Which series reach which targets, in which lanes, is emitted from derive/equations/automaton.py into guards.h. Of
 * coincident events the one searched first counts.
 */
#pragma once

#include "model.h"
#include "own_events.h"
#include "rest_in_friction.h"
#include "roots.h"
#include "state.h"

typedef struct {
    vec time;              /* of the first event, as a fraction of the step; above 1 if there is none */
    mask event;
    vec gap;               /* at the end of the step */
} first_event;

/* sum of |a_k| h^k, k = 1..ORDER: bound on the change of a function within the step */
static inline vec reach(const vec *a, vec h)
{
    vec sum = vec_abs(a[ORDER]);
    for (int k = ORDER - 1; k > 0; k--)
        sum = sum*h + vec_abs(a[k]);
    return sum*h;
}

/* A lower bound of sign(a(0)) a(t) for 0 <= t <= h: the minimum of its parabola minus a bound of the remainder.
 *
 * For a decay, whose coefficients alternate in sign, this bound is much sharper than `reach`.
 */
static inline vec least_of(const vec *a, vec h)
{
    word sign = pattern(a[0]) & SIGN;
    vec rest = vec_abs(a[ORDER]);
    for (int k = ORDER - 1; k > 2; k--)
        rest = rest*h + vec_abs(a[k]);
    vec start = vec_abs(a[0]), slope = from_pattern(pattern(a[1]) ^ sign)*h, bend = from_pattern(pattern(a[2]) ^ sign)*h*h;
    vec end = start + slope + bend;
    mask dips = (slope < 0.0) & (-slope < 2.0*bend);
    vec lowest = choose(dips, start - 0.25*slope*slope/choose(dips, bend, splat(1.0)), vec_min(start, end));
    return lowest - rest*h*h*h;
}

static inline vec sum_at(const vec *a, vec t)
{
    vec sum = a[ORDER];
    for (int k = ORDER - 1; k >= 0; k--)
        sum = sum*t + a[k];
    return sum;
}

/* The derivative of a series. */
static inline vec rate_at(const vec *a, vec t)
{
    vec rate = ORDER*a[ORDER];
    for (int k = ORDER - 1; k > 0; k--)
        rate = rate*t + k*a[k];
    return rate;
}

static inline void states_at(const vec (*a)[TERMS], vec t, vec *y)
{
    for (int state = 0; state < STATES; state++)
        y[state] = sum_at(a[state], t);
}

/* The part of the step up to a turn, which then is the whole step to search. */
static inline vec up_to_turn(first_event *first)
{
    mask within = (first->time <= 1.0) & (first->time > 0.0);
    vec part = choose(within, first->time, splat(1.0));
    first->time = choose(within, splat(1.0), first->time);
    return part;
}

/* Searches the lanes of `close` for sign (a(t) - target) falling through zero; an earlier event is kept.
 *
 * Bernstein coefficients are computed for all lanes at once. If all are positive there is no root (the usual case).
 * With one change of sign there is one root, found by bracketed Newton iteration. With more, the lane's first root is
 * isolated.
 */
OUTLINE void look(first_event *first, mask close, const vec *a, vec target, vec sign, vec h, mask event)
{
    vec g[TERMS + 1], b[TERMS + 1], power = sign;
    for (int k = 0; k <= ORDER; k++) {
        g[k] = a[k]*power;
        power *= h;
    }
    g[0] = sign*(a[0] - target);
    mask zero = g[0] == 0.0; /* a function that vanishes at the start: that root is divided out */
    if (bits(close & zero)) {
        for (int k = 0; k < ORDER; k++)
            g[k] = choose(zero, g[k + 1], g[k]);
        g[ORDER] = choose(zero, splat(0.0), g[ORDER]);
    }
    for (int k = 0; k <= ORDER; k++)
        b[k] = g[k]*INVERSE_BINOMIAL[k];
    for (int k = 1; k <= ORDER; k++)
        for (int j = ORDER; j >= k; j--)
            b[j] += b[j - 1];
    mask falls = g[0] <= 0.0, below = b[0] < 0.0, changes = splat_mask(0);
    for (int k = 1; k <= ORDER; k++) {
        mask here = b[k] < 0.0;
        changes += below ^ here; /* counts in units of TRUTH */
        below = here;
    }
    vec time = choose(falls, splat(0.0), splat(NO_ROOT));
    const mask once = splat_mask(TRUTH);
    mask one = close & NOT(falls) & (changes == once);
    mask many = close & NOT(falls) & (changes != 0) & (changes != once);
    if (bits(one)) {
        vec from = b[0], to = b[ORDER], place = splat(0.0); /* initial guess: the sign change of the control polygon */
        for (int k = 1; k <= ORDER; k++) {
            mask change = (b[k - 1] >= 0.0) & (b[k] < 0.0);
            from = choose(change, b[k - 1], from);
            to = choose(change, b[k], to);
            place = choose(change, splat(k - 1.0), place);
        }
        vec low = splat(0.0), high = splat(1.0), t = (place + from/(from - to))*(1.0/ORDER);
        mask moves = one; /* converged lanes stay unchanged, so that results do not depend on neighbouring lanes */
        for (int count = 0; count < 60 && bits(moves); count++) {
            vec value = g[ORDER], slope = splat(0.0), bend = splat(0.0);
            for (int k = ORDER - 1; k >= 0; k--) {
                bend = bend*t + slope;
                slope = slope*t + value;
                value = value*t + g[k];
            }
            mask before = value > 0.0;
            low = choose(before, t, low);
            high = choose(before, high, t);
            vec halley = t - value*slope/(slope*slope - value*bend);
            mask inside = (halley >= low) & (halley <= high);
            vec next = choose(inside, halley, 0.5*(low + high));
            /* the iteration converges cubically: after a step of 1e-6 the error is about 1e-18 */
            mask arrived = (inside & (vec_abs(next - t) <= 1e-6*next)) | (high - low <= 4e-16*high);
            t = choose(moves, next, t);
            moves &= NOT(arrived);
        }
        time = choose(one, t, time);
    }
    EACH_OF(lane, bits(many)) {
        double own[TERMS + 1], bernstein[TERMS + 1];
        for (int k = 0; k <= ORDER; k++) {
            own[k] = LANE(g[k], lane);
            bernstein[k] = LANE(b[k], lane);
        }
        LANE(time, lane) = isolated(own, ORDER, bernstein, 0.0, 1.0, 0);
    }
    mask earlier = close & (time <= 1.0) & (time < first->time);
    first->time = choose(earlier, time, first->time);
    first->event = choose_whole(earlier, event, first->event);
}

#if OWN_EVENTS
/* The step, no longer than the series of the guards are accurate, which may vary faster than the states. */
OUTLINE vec guards_resolved(const series *s, const lanes *l, const fixed *f, vec h)
{
    own_series own;
    for (int k = 0; k <= ORDER; k++)
        own_coefficients(&own, s, &f->c, k);
    for (int which = 0; which < OWN_EVENTS; which++) {
        mask watched = l->alive & own_watched(l->y, which, l->closing, l->resting, l->film);
        vec size = f->tolerance*(vec_abs(own.guard[which][0]) + 1e-3);
        for (int k = ORDER - 1; k <= ORDER; k++) {
            vec error = vec_max(vec_abs(own.guard[which][k])/size, splat(1e-300)); /* of a step of 1; not the inverse, as guards may be large */
            h = choose(watched, vec_min(h, vec_exp(vec_log(error)*(-1.0/k))), h);
        }
    }
    return h;
}

/* Declared events of a step; an earlier event is kept. */
OUTLINE void find_own_events(const series *s, const lanes *l, const fixed *f, vec h, first_event *first)
{
    own_series own;
    int expanded = 0;
    for (int which = 0; which < OWN_EVENTS; which++) {
        mask close = l->alive & own_watched(l->y, which, l->closing, l->resting, l->film);
        if (!bits(close))
            continue;
        if (!expanded)
            for (int k = 0; k <= ORDER; k++)
                own_coefficients(&own, s, &f->c, k);
        expanded = 1;
        close &= NOT((own.guard[which][0] > 0.0) & (least_of(own.guard[which], h) > 0.0));
        if (bits(close))
            look(first, close, own.guard[which], splat(0.0), splat(1.0), h, splat_mask(OWN[which].event));
    }
}
#endif /* OWN_EVENTS */
