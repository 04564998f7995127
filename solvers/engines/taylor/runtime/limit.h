/* A collision that a host interrupts: integrated up to a time, left there, and taken up again (`advance`).
 *
 * The step within which the time lies is not taken: the state at that time is read from its series, and the next call
 * starts from where the step did. So a collision takes the steps that it takes in one go, wherever it is interrupted
 * (but for implicit steps, which are cut). A stick that is proved goes on moving; nothing is proved twice.
 *
 * Only kernels compiled with WITH_LIMIT contain this file.
 */
#pragma once

#include "events.h"
#include "layout.h"
#include "ledger.h"
#include "model.h"
#include "state.h"

#if WITH_LIMIT
/* The lane's trajectory as it was left, and what the host is told of the time asked for. */
struct interrupted {
    double limit; /* the time to stop at, in x0/v0 */
    int begun, over, stuck, certified;
    int closing, resting, film;
    answer now; /* at the time reached: time, gap, smallest gap, angle turned, outputs in `shown` */
#if WITH_LEDGER
    ledger book; /* at that time */
#endif
    double lane[LANE_STATE];
};

/* Notes a stick of an interrupted collision, whose motion goes on; false if the collision may end. */
static inline int goes_on_stuck(queue *q, int certified)
{
    if (!q->contact)
        return 0;
    if (!q->contact->stuck) {
        q->contact->stuck = 1;
        q->contact->certified = certified && !DRIFTS;
    }
    return 1;
}

/* Leaves a lane's collision as it is, with a state that it reaches from there. */
static void leave(queue *q, const lanes *l, const fixed *f, int lane, const vec *y, double time)
{
    struct interrupted *h = q->contact;
    vec shown[OUTPUTS];
    outputs(&f->c, y, shown);
    for (int k = 0; k < OUTPUTS; k++)
        h->now.shown[k] = LANE(shown[k], lane);
    h->now.time = time;
    h->now.final_gap = LANE(y[GAP], lane);
    h->now.smallest_gap = fmin(LANE(l->smallest, lane), h->now.final_gap);
    h->now.reversal = (int32_t)LANE(l->reversal, lane);
    h->now.steps = (int32_t)LANE(l->steps, lane);
#if TURNING_STATE
    h->now.turned = LANE(y[TURNED], lane);
#elif OBLIQUE && STRINGS
    h->now.turned = LANE(y[ROTATION], lane);
#endif
    h->closing = LANE(l->closing, lane) != 0;
    h->resting = LANE(l->resting, lane) != 0;
    h->film = LANE(l->film, lane) != 0.0;
    h->begun = 1;
#if WITH_LEDGER
    close_book(&h->book, &f->c, y, lane);
#endif
    for (int field = 0; field < LANE_STATE; field++) /* doubles or integers */
        memcpy(h->lane + field, (const char *)l + sizeof(double)*(size_t)(field*LANES + lane), sizeof(double));
}

/* Takes up a collision that was left. */
static void take_up(const struct interrupted *h, lanes *l, int lane)
{
    for (int field = 0; field < LANE_STATE; field++)
        memcpy((char *)l + sizeof(double)*(size_t)(field*LANES + lane), h->lane + field, sizeof(double));
    LANE(l->index, lane) = 0;
    LANE(l->alive, lane) = TRUTH;
}

/* Ends an interrupted collision in the state of its lane; `status` may be changed. */
static void end_of(queue *q, const lanes *l, const fixed *f, int lane, answer *a)
{
    struct interrupted *h = q->contact;
    leave(q, l, f, lane, l->y, LANE(l->time, lane));
    h->over = 1;
    if (h->stuck && a->outcome != STICK) {
        if (h->certified)
            a->status = ESCAPED;
        h->stuck = h->certified = 0;
    }
}

/* The part of a step after which the collision is left, as its time lies within; negative if it does not. */
static double until_limit(const queue *q, const lanes *l, vec h)
{
    if (!q->contact)
        return -1.0;
    int lane = first_of(bits(l->alive));
    double since = q->contact->limit - LANE(l->time, lane);
    return since < LANE(h, lane) ? fmax(since, 0.0) : -1.0;
}

/* Leaves the collision within a step. */
static void leave_within(queue *q, lanes *l, const fixed *f, vec (*a)[TERMS], double since)
{
    int lane = first_of(bits(l->alive));
    vec y[STATES];
    states_at((const vec (*)[TERMS])a, splat(since), y);
    leave(q, l, f, lane, y, q->contact->limit);
    LANE(l->alive, lane) = 0;
}

static const double NO_MOTION = 1e-13; /* in v0: rounding alone turns a stick that is as slow */

/* Passes over the turning points of a stick that no longer moves along the line of centres. */
static void pass_over_rounding(const queue *q, const series *s, vec h, first_event *first)
{
    if (!q->contact || !q->contact->stuck)
        return;
    mask still = first->event == splat_mask(AT_TURNING);
    for (int half = 0; half <= 2; half++)
        still &= vec_abs(sum_at(s->normal_velocity, 0.5*half*h)) < NO_MOTION;
    first->time = choose(still, splat(NO_ROOT), first->time);
}

/* The answer of a collision that was followed to its limit: a stick, with the state reached. */
static void answer_at_limit(const struct interrupted *h, answer *a)
{
    int32_t events = a->events;
    if (h->over)
        return;
    *a = h->now;
    a->events = events;
    a->status = DECIDED;
    a->outcome = STICK;
    a->certified = h->certified;
}
#endif
