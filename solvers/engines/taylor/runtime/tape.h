/* Tape for the adjoint sweep: state, step and event of every step, and what happened to lanes in between. */
#pragma once

#include "state.h"

#if BACKWARD
enum { BATCH = 256 }; /* collisions on one tape, with MOST_STEPS steps each; mostly it stays in the cache */
enum { ACTS = 1, SHEARS = 2, MOVES = 4, CREEPS = 8, FALLS = 16, EVENT = 5 }; /* bits of a step; EVENT: those above */

typedef struct {
    vec y[STATES]; /* at the start of the step */
    vec h;
    mask flags;
} taped_step;

typedef struct {
    long after, before; /* number of steps before the rebound; the lane's rebound before it, or -1 */
    double y[STATES];
    int kind;
} taped_rebound;

/* A trajectory that separated: a lane's steps from `begun` to `after`. */
typedef struct {
    long index, begun, after, rebound; /* its last rebound, or -1 */
    int lane;
    double y[STATES];
} taped_end;

enum {
    STEP_ROOM = (BATCH/LANES + 2)*(MOST_STEPS + 2), /* lanes are full while the queue is not empty */
    REBOUND_ROOM = 16*BATCH,
};

struct tape {
    taped_step *steps;
    taped_rebound *rebounds;
    taped_end *ends;
    double (*rows)[FIXED];         /* constants of the trajectories that separated */
    struct derivatives *derivatives; /* of them (adjoint.h) */
    long stepped, rebounded, ended;
    long begun[LANES], rebound[LANES];
    int full;
};

/* A mode that has decayed in the state may persist in its tangent: limit the step to where it stays stable
 * (damped_sum.h). */
static const double STEADY = 6.0, STEADY_DAMPED = 13.0;

static inline vec held_for_derivatives(vec contraction, vec h, mask creeps)
{
    vec most = choose(creeps, splat(STEADY_DAMPED), splat(STEADY));
    return vec_min(h, most/contraction); /* infinite without decay */
}

static void keep_on_tape(const queue *q, const lanes *l, vec h, mask creeps, mask falls, mask event)
{
    struct tape *t = q->tape;
    if (t->stepped == STEP_ROOM) {
        t->full = 1;
        return;
    }
    taped_step *step = &t->steps[t->stepped++];
    memcpy(step->y, l->y, sizeof step->y);
    step->h = h;
    falls &= h > 0.0; /* a criterion met on entry (h = 0) does not cross its surface */
    step->flags = only_whole(acting(l) != 0.0, splat_mask(ACTS)) | only_whole(l->shear != 0.0, splat_mask(SHEARS)) |
                  only_whole(NOT(l->resting), splat_mask(MOVES)) | only_whole(creeps, splat_mask(CREEPS)) |
                  only_whole(falls, splat_mask(FALLS)) | event << EVENT;
}

static void begin_on_tape(const queue *q, int lane)
{
    q->tape->begun[lane] = q->tape->stepped;
    q->tape->rebound[lane] = -1;
}

static void rebound_on_tape(const queue *q, int lane, const vec *y, int kind)
{
    struct tape *t = q->tape;
    if (t->rebounded == REBOUND_ROOM) {
        t->full = 1;
        return;
    }
    taped_rebound *own = &t->rebounds[t->rebounded];
    own->after = t->stepped;
    own->before = t->rebound[lane];
    own->kind = kind;
    t->rebound[lane] = t->rebounded++;
    for (int state = 0; state < STATES; state++)
        own->y[state] = LANE(y[state], lane);
}

static void end_on_tape(const queue *q, long index, int lane, const vec *y, const fixed *f)
{
    struct tape *t = q->tape;
    double *row = t->rows[t->ended];
    taped_end *own = &t->ends[t->ended++];
    *own = (taped_end){index, t->begun[lane], t->stepped, t->rebound[lane], lane, {0}};
    for (int state = 0; state < STATES; state++)
        own->y[state] = LANE(y[state], lane);
    for (int field = 0; field < FIXED; field++)
        row[field] = LANE(((const vec *)f)[field], lane);
}

/* Without room on the tape, trajectories end without an answer. */
static inline mask only_if_full(const queue *q, mask alive)
{
    return q->tape->full ? alive : splat_mask(0);
}
#endif
