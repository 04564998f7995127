/* What a trajectory leaves for the way back: where each step began and what ended it, and what happened to lanes in between. */
#pragma once

#include "state.h"

#if BACKWARD
enum { BATCH = 512 }; /* collisions on one tape, of MOST_STEPS steps each */

typedef struct {
    vec y[STATES]; /* as the step began */
    vec h, film, shear;
    mask moving, creeps;
    mask falls, event; /* what was met at its end */
} taped_step;

typedef struct {
    long after; /* so many steps */
    long index;
    int kind, lane;
    double y[STATES];
    long row; /* of what was fixed for a trajectory, where it ended */
} taped_note;

enum {
    STEP_ROOM = (BATCH/LANES + 2)*(MOST_STEPS + 2), /* lanes are full while there is a queue */
    NOTE_ROOM = 16*BATCH,
};

struct tape {
    taped_step *steps;
    taped_note *notes;
    double (*rows)[FIXED];
    long stepped, noted, ended;
    int full;
};

/* A mode that is gone from the states may not be from their derivatives: no step that would enlarge it (damped_sum.h). */
static const double STEADY = 6.0, STEADY_DAMPED = 13.0;

static inline vec held_for_derivatives(const lanes *l, const fixed *f, const series *s, vec h, mask creeps)
{
    vec most = choose(creeps, splat(STEADY_DAMPED), splat(STEADY));
    return vec_min(h, most/contraction(s, &f->c, acting(l), l->shear)); /* infinite where nothing decays */
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
    step->falls = falls & (h > 0.0); /* what is true on entry jumps where it is: no surface is met */
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

/* Where there is no room left, trajectories end without an answer. */
static inline mask only_if_full(const queue *q, mask alive)
{
    return q->tape->full ? alive : splat_mask(0);
}
#endif
