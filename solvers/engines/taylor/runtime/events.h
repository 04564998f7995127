/* The first event of a step in each lane: by bounds, then Bernstein coefficients, then isolation.
 *
 * The guards are those of derive/equations/automaton.py. Of coincident events the one searched first counts, so the calls
 * of `look` are in the order of its table.
 */
#pragma once

#include "model.h"
#include "own_events.h"
#include "rest_in_friction.h"
#include "roots.h"
#include "state.h"

/* The first event of a step; event functions are series that are positive before their event. */
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

/* Searches the lanes of `close` for sign (a(t) - target) falling through zero; an earlier event is kept.
 *
 * Bernstein coefficients are computed for all lanes at once. If all are positive there is no root (the usual case).
 * With one change of sign there is one root, found by bracketed Newton iteration. With more, the lane's first root is
 * isolated.
 */
OUTLINE void look(
    first_event *found, mask close, const vec *a, vec target, vec sign, vec h, mask event)
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
            vec value = g[ORDER], slope = splat(0.0);
            for (int k = ORDER - 1; k >= 0; k--) {
                slope = slope*t + value;
                value = value*t + g[k];
            }
            mask before = value > 0.0;
            low = choose(before, t, low);
            high = choose(before, high, t);
            vec newton = t - value/slope;
            mask inside = (newton >= low) & (newton <= high);
            vec next = choose(inside, newton, 0.5*(low + high));
            /* Newton converges quadratically: after a step of 1e-9 the error is about 1e-17 */
            mask arrived = (inside & (vec_abs(next - t) <= 1e-9*next)) | (high - low <= 4e-16*high);
            t = choose(moves, next, t);
            moves &= NOT(arrived);
        }
        time = choose(one, t, time);
    }
    for (unsigned left = bits(many); left; left &= left - 1) {
        int lane = first_of(left);
        double own[TERMS + 1], bernstein[TERMS + 1];
        for (int k = 0; k <= ORDER; k++) {
            own[k] = LANE(g[k], lane);
            bernstein[k] = LANE(b[k], lane);
        }
        LANE(time, lane) = isolated(own, ORDER, bernstein, 0.0, 1.0, 0);
    }
    mask first = close & (time <= 1.0) & (time < found->time);
    found->time = choose(first, time, found->time);
    found->event = choose_whole(first, event, found->event);
}

#if OWN_EVENTS
/* The first declared event of a step that comes before those found already. */
OUTLINE void find_own_events(
    const series *s, const lanes *l, const fixed *f, vec h, mask moves, first_event *found)
{
    own_series own;
    int made = 0;
    for (int which = 0; which < OWN_EVENTS; which++) {
        mask close = moves & own_watched(l->y, which, l->closing, l->film);
        if (!bits(close))
            continue;
        if (!made)
            for (int k = 0; k <= ORDER; k++)
                own_coefficients(&own, s, &f->c, k);
        made = 1;
        close &= NOT((own.guard[which][0] > 0.0) & (least_of(own.guard[which], h) > 0.0));
        if (bits(close))
            look(found, close, own.guard[which], splat(0.0), splat(1.0), h, splat_mask(OWN[which].event));
    }
}
#endif /* OWN_EVENTS */
#if RUBS
/* The end of sliding, where the slip vanishes, and of rolling, which needs more than friction gives. */
OUTLINE void find_rubbing_events(const rubbing *r, const lanes *l, vec h, first_event *found)
{
    mask rests = l->alive & l->resting, rolls = rests & (l->rolling != 0.0);
    mask close = rests & (l->sliding != 0.0);
    close &= NOT(least_of(r->rest_slip, h) > 0.0);
    /* sliding that has just begun has no slip yet: its sign, and that of its rate, are rounding */
    vec least = only(l->sliding*r->rest_slip[0] < NO_SLIP, -NO_SLIP*l->sliding);
    if (bits(close))
        look(found, close, r->rest_slip, least, l->sliding, h, splat_mask(AT_SLIPPING));
    for (double way = -1.0; bits(rolls) && way <= 1.0; way += 2.0) {
        vec left[TERMS];
        for (int k = 0; k <= ORDER; k++)
            left[k] = r->rest_limit[k] + way*r->rest_holding[k];
        close = rolls & NOT((left[0] > 0.0) & (least_of(left, h) > 0.0));
        if (bits(close))
            look(found, close, left, splat(0.0), splat(1.0), h, splat_mask(AT_ROLLING));
    }
}
#endif

static void find_events(const series *s, const lanes *l, const fixed *f, vec h, first_event *found)
{
    const vec zero = splat(0.0), one = splat(1.0);
    found->time = splat(NO_ROOT);
    found->event = splat_mask(0);
    mask closing = l->closing, moves = l->alive & NOT(l->resting), close;
    vec away = choose(closing, one, -one); /* the sign with which event functions of the gap increase */
    /* The turning point comes first: up to there the gap is monotonic, and extremal at the end. Under a constant force
     * steps are unlimited, and all events before the turning point lie in a tiny part of the step.
     */
    vec part = one;
    mask turns = moves & NOT(least_of(s->normal_velocity, h) > 0.0);
    if (bits(turns)) {
        look(found, turns, s->normal_velocity, zero, -away, h, splat_mask(AT_TURNING));
        mask turned = (found->time <= 1.0) & (found->time > 0.0);
        part = choose(turned, found->time, one);
        found->time = choose(turned, one, found->time);
        h *= part;
    }
    found->gap = sum_at(s->gap, h);
    vec to = found->gap;
    if (bits(moves & closing)) {
        close = moves & closing & NOT((s->glass.result[0] > 0.0) & (least_of(s->glass.result, h) > 0.0));
        if (bits(close))
            look(found, close, s->glass.result, zero, one, h, splat_mask(AT_GLASS));
    }
    /* the next gap with an event: contact, or the film edge from outside; film edge or rupture while opening */
#if BRIDGE && !SPREAD
    mask inside = l->film != 0.0, edge = closing ^ inside; /* closing from outside, or opening from inside */
    edge &= NOT(closing & (f->contact >= 1.0)); /* soft solids touch outside the film */
    vec target = choose(edge, one, choose(closing, f->contact, f->end));
    mask event = choose_whole(closing, splat_mask(AT_CONTACT), splat_mask(AT_RUPTURE));
    event = choose_whole(edge, splat_mask(AT_FILM_EDGE), event);
#else
    vec target = choose(closing, f->contact, f->end);
    mask event = choose_whole(closing, splat_mask(AT_CONTACT), splat_mask(AT_RUPTURE));
#endif
    close = moves & NOT(away*(to - target) > 0.0);
    if (bits(close))
        look(found, close, s->gap, target, away, h, event);
#if OBLIQUE
    mask own = moves & (f->edge != 1.0) & (f->edge < f->end) & (f->edge > vec_min(f->contact, one));
    close = own & (closing ^ (l->shear != 0.0)) & NOT(away*(to - f->edge) > 0.0);
    if (bits(close))
        look(found, close, s->gap, f->edge, away, h, splat_mask(AT_TANGENTIAL_EDGE));
#endif
    close = l->alive & l->resting;
#if OBLIQUE && !STRINGS
    close &= l->shear != 0.0;
#endif
    if (OBLIQUE && !WALL && bits(close)) { /* beside a wall and head-on the forces at rest stay as they are */
        close &= NOT(-s->acceleration[0] > reach(s->acceleration, h));
        if (bits(close))
            look(found, close, s->acceleration, zero, -one, h, splat_mask(AT_RELEASE));
    }
#if OBLIQUE && STRINGS
    close = l->alive & NOT(s->rotation[0] + reach(s->rotation, h) < PI);
    if (bits(close))
        look(found, close, s->rotation, splat(PI), -one, h, splat_mask(AT_HALF_TURN));
    close = l->alive & NOT(s->orbital_momentum[0] > reach(s->orbital_momentum, h));
    if (bits(close))
        look(found, close, s->orbital_momentum, zero, one, h, splat_mask(AT_UNWINDING));
#endif
#if OWN_EVENTS
    find_own_events(s, l, f, h, moves, found);
#endif /* OWN_EVENTS */
    found->time *= part;
}
