/* What is known of collisions on their way: enumerations, what is fixed for a trajectory, trajectories side by side, what was asked. */
#pragma once

#include "automaton.h"
#include "certificates.h"
#include "energy_barrier.h"
#include "layout.h"
#include "model.h"
#include "tangents.h"

static const double SLOW = 0.1; /* of v0: a normal velocity below counts as this for errors, since in a film they die */

_Static_assert(OUTPUTS <= sizeof(((answer *)0)->shown)/sizeof(double), "all outputs are shown");

/* What is fixed for a trajectory. */
typedef struct {
    constants c;
    barrier b;
    vec tolerance, rest; /* relative error of a step, and the normal velocity that counts as none */
    vec contact, end, edge;
#if GRADIENTS
    slope_constants slopes;
#if !BACKWARD
    vec one[GROUPS]; /* a derivative's size where its elasticity is one, of a state of one */
#endif
#endif
} fixed;

typedef struct {
    vec y[STATES];
    vec time, smallest, film, shear;
    vec stride; /* the last step */
    mask alive, closing, resting, fresh;
    mask index, steps, phases, reversal, crept; /* crept: steps in a row that only a damped sum could take */
#if GRADIENTS
    carried along;
#endif
} lanes;

enum { FIXED = sizeof(fixed)/sizeof(vec), LANE_STATE = sizeof(lanes)/sizeof(vec) };

typedef struct {
    task *t; /* what was asked; its buffers are as large as they say (solvers/engines/taylor/layout.py) */
    const buffer *columns; /* quantities in SI */
    double rtol;
    answer *answers;
    happening *log; /* `log_room` a collision, whose answer counts those that found none as well */
    long log_room;
#if WITH_LEDGER
    ledger *books; /* one a collision */
#endif
#if WITH_TRAJECTORY
    struct step_row *written; /* `step_room` steps of all collisions; the task counts those that found none as well */
    long step_room;
    double *peaks; /* one a collision; null for none */
#endif
    long count, next;
    int budget;
    long queued, taken; /* collisions that are waiting, of `rows` */
    long waiting[LANES];
    double rows[LANES][FIXED];
    double starts[LANES][STATES];
    int parks, resumes; /* trajectories that wait for implicit.h, and that come from there */
    double parked[LANES][FIXED + LANE_STATE], resumed[LANES][FIXED + LANE_STATE];
#if GRADIENTS
    double *by_group, *gradients; /* RESULTS derivatives by each group, by each quantity */
    nearness *near;
    unsigned asked;               /* groups, as bits */
#endif
#if BACKWARD
    struct tape *tape;
#endif
} queue;

#if WITH_TRAJECTORY
/* Lanes whose stick may be proved, for the purpose of a trajectory. */
static mask provable(const queue *q, mask closing)
{
    long purpose = q->t->purpose;
    return purpose == WHOLE ? splat_mask(-1) : purpose == ESCAPE ? closing : splat_mask(0);
}
#endif

/* A quantity of a collision: its own, or the one for all. */
static inline double quantity(const queue *q, int k, long index)
{
    const buffer *column = q->columns + k;
    return ((const double *)column->at)[column->bytes > (int64_t)sizeof(double) ? index : 0];
}

static void put(queue *q, long index, int status, int outcome, int certified)
{
    certified = certified && !SURFACE_ARM; /* angular momentum drifts: no theorem */
    answer *a = &q->answers[index];
    a->status = status;
    a->outcome = outcome;
    a->certified = certified;
    a->reversal = -1;
}

static void note(queue *q, long index, int kind, double time)
{
    answer *a = &q->answers[index];
    if (a->events < q->log_room)
        q->log[index*q->log_room + a->events] = (happening){kind, time};
    a->events++;
}

/* Lanes that are proved to stick as they are. */
static mask proved_underway(const lanes *l, const fixed *f, double tolerance)
{
    return proved_sticks(&f->c, l->y, &f->b, f->contact, l->closing, l->resting, tolerance);
}

/* Where the film acts: a liquid that cavitates does not while it is opened. */
static inline vec acting(const lanes *l)
{
#if defined(FILM_CAVITATES)
    return only(l->closing, l->film);
#else
    return l->film;
#endif
}
