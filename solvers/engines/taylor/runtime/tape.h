/* Tape for the adjoint sweep: state, step and event of every step, and what happened to lanes in between. */
#pragma once

#include "state.h"

#if BACKWARD
enum { BATCH = 512 }; /* collisions on one tape, with MOST_STEPS steps each */

typedef struct {
    vec y[STATES]; /* at the start of the step */
    vec h, film, shear;
    mask moving, creeps;
    mask falls, event; /* the event at its end */
} taped_step;

typedef struct {
    long after; /* number of steps before the note */
    long index;
    int kind, lane;
    double y[STATES];
    long row; /* row with the constants of a trajectory, for notes of its end */
} taped_note;

enum {
    STEP_ROOM = (BATCH/LANES + 2)*(MOST_STEPS + 2), /* lanes are full while the queue is not empty */
    NOTE_ROOM = 16*BATCH,
};

struct tape {
    taped_step *steps;
    taped_note *notes;
    double (*rows)[FIXED];
    long stepped, noted, ended;
    int full;
};

/* A mode that has decayed in the state may persist in its tangent: limit the step to where it stays stable
 * (damped_sum.h). */
static const double STEADY = 6.0, STEADY_DAMPED = 13.0;

static inline vec held_for_derivatives(const lanes *l, const fixed *f, const series *s, vec h, mask creeps)
{
    vec most = choose(creeps, splat(STEADY_DAMPED), splat(STEADY));
    return vec_min(h, most/contraction(s, &f->c, acting(l), l->shear)); /* infinite without decay */
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
    step->film = acting(l);
    step->shear = l->shear;
    step->moving = ~l->resting;
    step->creeps = creeps;
    step->falls = falls & (h > 0.0); /* a criterion met on entry (h = 0) does not cross its surface */
    step->event = event;
}

static void note_on_tape(const queue *q, int kind, long index, int lane, const vec *y, const fixed *f)
{
    struct tape *t = q->tape;
    if (t->noted == NOTE_ROOM) {
        t->full = 1;
        return;
    }
    taped_note *note = &t->notes[t->noted++];
    note->after = t->stepped;
    note->index = index;
    note->kind = kind;
    note->lane = lane;
    for (int state = 0; state < STATES; state++)
        note->y[state] = y[state][lane];
    if (kind == ENDED) {
        note->row = t->ended++;
        for (int field = 0; field < FIXED; field++)
            t->rows[note->row][field] = ((const vec *)f)[field][lane];
    }
}

/* Without room on the tape, trajectories end without an answer. */
static inline mask only_if_full(const queue *q, mask alive)
{
    return q->tape->full ? alive : splat_mask(0);
}
#endif
