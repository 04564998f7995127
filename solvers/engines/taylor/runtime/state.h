/* Data of collisions under way: enumerations, constants of a trajectory, trajectories side by side, and the task. */
#pragma once

#include "automaton.h"
#include "certificates.h"
#include "energy_barrier.h"
#include "layout.h"
#include "model.h"
#include "tangents.h"

/* Whether trajectories may be replaced by the slow manifold (slow_manifold.h). */
#if SLOW_MANIFOLD && !WITH_LIMIT && !GRADIENTS && !WITH_TRAJECTORY && !WITH_LEDGER && !TURNING_STATE
#define JUMPS 1
#else
#define JUMPS 0
#endif
#if JUMPS && defined(FILM_BRAKING) && defined(GLASS_REACH) /* the glass pressure falls with the gap */
#define LEAPS 1 /* from initial contact */
#else
#define LEAPS 0
#endif

static const double SLOW = 0.1; /* in v0: least scale of the error of the normal velocity, which decays in a film */

STATIC_ASSERT(OUTPUTS <= sizeof(((answer *)0)->shown)/sizeof(double)); /* all outputs are shown */

/* Magnitude of a state, one of `stride` numbers each. That of the first component of a vector is the vector's length, and
 * EACH_SIZE passes over the others, so that error norms distinguish no direction.
 */
#if SPACE
#define EACH_SIZE(state) \
    for (int state = 0; state < STATES; state += state >= FIRST_VECTOR && state < END_OF_VECTORS ? 3 : 1)

static inline vec size_of(const vec *all, int stride, int state)
{
    const vec *x = all + state*stride;
    if (state < FIRST_VECTOR || state >= END_OF_VECTORS)
        return vec_abs(x[0]);
    return vec_abs(vec_sqrt(x[0]*x[0] + x[stride]*x[stride] + x[2*stride]*x[2*stride])); /* a NaN may have a sign */
}
#else
#define EACH_SIZE(state) for (int state = 0; state < STATES; state++)

static inline vec size_of(const vec *all, int stride, int state)
{
    return vec_abs(all[state*stride]);
}
#endif

/* Constants of a trajectory. */
typedef struct {
    constants c;
    barrier b;
    vec tolerance, rest; /* relative error of a step, and the normal velocity that counts as zero */
    vec contact, end, edge;
#if GRADIENTS
    slope_constants slopes;
#if !BACKWARD
    vec one[GROUPS]; /* magnitude of a derivative of elasticity one, for a state of magnitude one */
#endif
#endif
} fixed;

typedef struct {
    vec y[STATES];
    vec time, smallest, film, shear;
    vec stride; /* the last step */
#if CHATTER_TESTS
    vec top, swing; /* gap and size of the orbital momentum at the last maximum of the gap */
    mask cycles;    /* successive maxima that did not grow (chatter.h) */
#endif
#if FRICTION
    vec sliding, rolling; /* at rest: the sign of the slip, or 0; 1 without slip, else 0 */
#endif
    mask alive, closing, resting, fresh;
    mask index, steps, phases, reversal, crept; /* crept: consecutive steps that required the damped sum */
#if GRADIENTS
    carried along;
#endif
} lanes;

enum { FIXED = sizeof(fixed)/sizeof(vec), LANE_STATE = sizeof(lanes)/sizeof(vec) };

typedef struct {
#if WITH_LIMIT
    struct interrupted *contact; /* the only collision, if a host may interrupt it; else null (limit.h) */
#endif
    task *t; /* the task; its buffers have the sizes it states (solvers/engines/taylor/layout.py) */
    const buffer *columns; /* quantities in SI */
    double rtol;
    answer *answers;
    happening *log; /* `log_room` rows per collision; the last has the last event, which its answer counts too */
    long log_room;
#if WITH_LEDGER
    ledger *books; /* one per collision */
#endif
#if WITH_TRAJECTORY
    struct step_row *written; /* `step_room` rows for the steps of all collisions; the task counts all steps */
    long step_room;
    double *peaks; /* one per collision; null if not requested */
#endif
    long count, next;
    int budget;
    long queued, taken; /* collisions waiting in `rows`, and how many of them were taken */
    long waiting[LANES];
    double rows[LANES][FIXED];
    double starts[LANES][STATES];
#if LEAPS
    int leaps[LANES]; /* whether they may jump from initial contact */
#endif
    int parks, resumes; /* trajectories waiting for implicit.h, and trajectories that return to lanes */
    double parked[2*LANES][FIXED + LANE_STATE], resumed[4*LANES][FIXED + LANE_STATE];
#if JUMPS
    int jump_count; /* trajectories waiting for jump.h */
    double for_jump[2*LANES][FIXED + LANE_STATE];
#endif
#if GRADIENTS
    double *by_group, *gradients; /* RESULTS derivatives by each group, and by each quantity */
    nearness *near;
    unsigned requested;               /* requested groups, as bits */
#endif
#if BACKWARD
    struct tape *tape;
#endif
} queue;

/* Lanes in which certificates are evaluated, given the purpose of the trajectory. */
static inline mask provable(const queue *q, mask closing)
{
    long purpose = WITH_TRAJECTORY ? q->t->purpose : (long)WHOLE;
    return purpose == WHOLE ? splat_mask(TRUTH) : purpose == ESCAPE ? closing : splat_mask(0);
}

/* A quantity of a collision: its own value, or the common one. */
static inline double quantity(const queue *q, int k, long index)
{
    const buffer *column = q->columns + k;
    return ((const double *)column->at)[column->bytes > (int64_t)sizeof(double) ? index : 0];
}

static void put(queue *q, long index, int status, int outcome, int certified)
{
    certified = certified && !DRIFTS; /* angular momentum drifts, so this is no certificate */
    answer *a = &q->answers[index];
    a->status = status;
    a->outcome = outcome;
    a->certified = certified;
    a->reversal = -1;
}

/* The row of the event of a collision that was noted last; null without a log. */
static happening *last_row(const queue *q, long index)
{
    long events = q->answers[index].events, row = events < q->log_room ? events : q->log_room;
    return row > 0 ? q->log + index*q->log_room + row - 1 : 0;
}

static void note(queue *q, long index, int kind, double time)
{
    q->answers[index].events++;
    happening *row = last_row(q, index);
    if (row) {
        row->kind = kind;
        row->time = time;
    }
}

/* The mode of a lane, beside the event noted last: that which follows it. */
static void note_mode(queue *q, const lanes *l, int lane)
{
    happening *row = last_row(q, LANE(l->index, lane));
    if (!row)
        return;
    row->closing = LANE(l->closing, lane) != 0;
    row->resting = LANE(l->resting, lane) != 0;
    row->film = LANE(l->film, lane) != 0.0;
    row->shear = LANE(l->shear, lane) != 0.0;
#if FRICTION
    row->sliding = (int32_t)LANE(l->sliding, lane);
#if ROLLS
    row->rolling = LANE(l->rolling, lane) != 0.0;
#endif
#endif
}

/* Lanes in which a certificate excludes separation from the present state. */
static mask proved_underway(const lanes *l, const fixed *f, double tolerance)
{
    mask proved = proved_sticks(&f->c, l->y, &f->b, f->contact, l->closing, l->resting, tolerance);
#if OWN_EVENTS
    if (bits(proved & l->resting))
        proved &= NOT(l->resting) | rests_beside_events(&f->c, l->y, l->film);
#endif /* OWN_EVENTS */
    return proved;
}

/* 1 where the film acts; a cavitating liquid exerts no force while opening. */
static inline vec acting(const lanes *l)
{
#if defined(FILM_CAVITATES)
    return only(l->closing, l->film);
#else
    return l->film;
#endif
}
