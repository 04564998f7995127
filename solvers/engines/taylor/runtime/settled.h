/* Resting contact in which no force changes any more: it ends as a stick, or goes on for what declared events watch. */
#pragma once

#include "criteria.h"
#include "model.h"
#include "own_events.h"
#include "queue.h"
#include "state.h"

#if TURNS || OWN_EVENTS
/* What a decaying state may still lose, relative to itself, to count as constant: rounding, also that of a larger state
 * which it is exchanged with. */
static const double SETTLED = 1e-14, LEAST_SIZE = 1e-3;

static mask is_constant(const vec *a)
{
    mask constant = splat_mask(TRUTH);
    for (int k = 1; k <= ORDER; k++)
        constant &= a[k] == 0.0;
    return constant;
}

/* Lanes in which a state decays and has less than that to go: A of A exp(-z t), by its first terms. What grows has the
 * same sign in both. */
static mask has_decayed(const vec *a)
{
    mask decays = ((a[1] < 0.0) & (a[2] > 0.0)) | ((a[1] > 0.0) & (a[2] < 0.0));
    return decays & (a[1]*a[1] <= 2.0*SETTLED*vec_abs(a[2])*(vec_abs(a[0]) + LEAST_SIZE));
}

/* Ends as sticks those of these lanes, which do not move along the line of centres, that are pressed together at rest or
 * without a force. Returns whether there were any. The sticks are not certified: the force is taken without an error.
 */
static int ended_at_rest(queue *q, lanes *l, fixed *f, mask still)
{
    still &= l->alive & provable(q, l->closing);
#if WITH_LIMIT
    if (q->contact && q->contact->stuck)
        return 0;
#endif
    if (bits(still)) {
        vec inward = inward_force(&f->c, l->y);
        still &= (inward == 0.0) | (l->resting & (inward > 0.0));
    }
    EACH_OF(lane, bits(still))
        sticks_for_good(q, l, f, lane, 0);
    return bits(still) != 0;
}
#endif

#if (KINKS || !FILM_MOMENTUM) && !OWN_EVENTS
/* Over m v0^2/x0: of a bridge that has ended at a step, what the rounding of kinks leaves (derive/user/kinks.py). */
static const double NO_FORCE = 1e-12;

/* Lanes that the film has stopped where no force acts: an equilibrium. Decides a stick, but is no certificate: that velocity
 * has been rounded to zero. With a force proportional to it, the film's momentum proves such sticks before they move, but
 * beside no bridge.
 */
static mask stopped_for_good(const lanes *l, const fixed *f)
{
    mask still = l->alive & NOT(l->resting) & (l->y[NORMAL_VELOCITY] == 0.0);
    if (!bits(still))
        return still;
    vec inward = inward_force(&f->c, l->y);
    return still & (inward >= 0.0) & (inward <= NO_FORCE);
}
#endif /* (KINKS || !FILM_MOMENTUM) && !OWN_EVENTS */
#if OWN_EVENTS
/* In x0/v0, and rad: a doublet that has rested and turned for so long counts as a stick, without proof. */
static const double LONGEST_REST = 1e12, FARTHEST_TURN = 6300.0;

static mask has_rested_long(const lanes *l)
{
    mask rested = l->time > LONGEST_REST;
#if defined(ANGLE_STATE)
    rested |= vec_abs(l->y[ANGLE_STATE]) > FARTHEST_TURN;
#endif
    return rested & (l->y[NORMAL_VELOCITY] == 0.0);
}

/* Lanes that do not move in which a declared event may come whose guard varies with any of these. */
static mask own_to_come(const constants *c, const lanes *l, int varies)
{
    vec least[OWN_EVENTS];
    mask come = splat_mask(0);
    own_least(c, l->y, least);
    for (int which = 0; which < OWN_EVENTS; which++)
        if (OWN[which].varies & varies) {
            mask comes = own_watched(l->y, which, l->closing, l->resting, l->film);
            come |= OWN[which].varies == BY_TIME ? comes & NOT(least[which] > 0.0) : comes;
        }
    return come;
}

/* Lanes that float: a film has stopped them where no other force acts along the line of centres. They do not turn again. */
static mask floating(const lanes *l, const series *s)
{
    return l->alive & NOT(l->resting) & (l->y[NORMAL_VELOCITY] == 0.0) & is_constant(s->normal_velocity);
}

/* Makes the series constant, and those of clocks and integrals linear, in lanes that rest beside events to come and have
 * settled. Returns them.
 *
 * Only guards then limit the step. Otherwise rounding of what has decayed would, to some decay times of it.
 */
static mask hold_settled(series *s, const constants *c, const lanes *l)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])s;
    mask settled = l->alive & l->resting & own_to_come(c, l, BY_ROTATION | BY_ANGLE | BY_TIME);
    for (int state = 0; state < MODEL_STATES; state++)
        if (state != ANGLE_CLOCK && state != TIME_CLOCK)
            settled &= is_constant(a[state]) | has_decayed(a[state]);
    if (!bits(settled))
        return settled;
    for (int state = 0; state < STATES; state++) {
        int goes_on = state >= MODEL_STATES || state == ANGLE_CLOCK || state == TIME_CLOCK;
        for (int k = goes_on ? 2 : 1; k <= ORDER; k++)
            a[state][k] = only(NOT(settled), a[state][k]);
    }
    for (int k = 1; k <= ORDER; k++)
        s->acceleration[k] = only(NOT(settled), s->acceleration[k]);
    return settled;
}
#endif /* OWN_EVENTS */

#if TURNS || OWN_EVENTS
/* Ends as sticks the lanes at rest, or floating, whose series are constant: no force changes any more. */
static int stills_ended(queue *q, lanes *l, fixed *f, vec (*a)[TERMS])
{
    mask still = l->resting;
#if OWN_EVENTS
    mask by_angle = own_to_come(&f->c, l, BY_ANGLE), by_time = own_to_come(&f->c, l, BY_TIME);
    still |= l->y[NORMAL_VELOCITY] == 0.0;
#endif /* OWN_EVENTS */
    for (int state = 0; state < MODEL_STATES; state++) {
        mask constant = is_constant(a[state]);
#if OWN_TERMS
        constant |= has_decayed(a[state]); /* under a drag: exactly constant long after all forces are */
#endif /* OWN_TERMS */
#if OWN_EVENTS
        if (state == ANGLE_CLOCK || state == TIME_CLOCK) /* they change nothing but the guards of events to come */
            constant |= NOT(state == ANGLE_CLOCK ? by_angle : by_time);
#endif /* OWN_EVENTS */
        still &= constant;
    }
    return ended_at_rest(q, l, f, still);
}
#endif
