/* The steps of a trajectory, one row each: states as polynomials in the time since the start of the step. */
#pragma once

#include "events.h"
#include "model.h"
#include "queue.h"
#include "state.h"
#include "effects.h"

#if WITH_TRAJECTORY
typedef struct step_row {
    double time, length;
    int64_t collision;
    int32_t phase, closing, resting, film; /* phases are counted from 0 */
    double series[STATES][TERMS];
} step_row;

/* Layout of the rows for the caller. */
const int row_states = STATES, row_terms = TERMS, row_bytes = sizeof(step_row);
#if OBLIQUE && STRINGS
const int row_turned = ROTATION;
#elif TURNING_STATE
const int row_turned = TURNED;
#else
const int row_turned = -1;
#endif

/* Rows beyond the available room are counted but not written; the caller repeats the call with more room. */
static void keep_steps(queue *q, const lanes *l, const vec (*a)[TERMS], vec length)
{
    EACH_OF(lane, bits(l->alive)) {
        if (q->t->steps++ >= q->step_room)
            continue;
        step_row *row = q->written + q->t->steps - 1;
        row->time = LANE(l->time, lane);
        row->length = LANE(length, lane);
        row->collision = LANE(l->index, lane);
        row->phase = (int32_t)LANE(l->phases, lane);
        row->closing = LANE(l->closing, lane) != 0;
        row->resting = LANE(l->resting, lane) != 0;
        row->film = LANE(l->film, lane) != 0.0;
        for (int state = 0; state < STATES; state++)
            for (int k = 0; k < TERMS; k++)
                row->series[state][k] = LANE(a[state][k], lane);
    }
}

#if GLASS_REACH
enum { LOOKS = 8 };

/* Largest margin of the glass criterion within a step: twice the logarithm of the gap at which the present speed would
 * meet it, over the present gap; ln(pressure/limit) for the literal criterion.
 */
OUTLINE void note_peaks(const queue *q, const lanes *l, const fixed *f, const series *s, vec h)
{
    vec largest = splat(0.0);
    for (int k = 0; k <= LOOKS; k++) {
        vec t = h*((double)k/LOOKS), approach = -sum_at(s->normal_velocity, t);
        vec reach = glass_reach(vec_max(approach, splat(0.0)), f->c.glass_number);
        largest = vec_max(largest, reach/sum_at(s->gap, t));
    }
    EACH_OF(lane, bits(l->alive & l->closing)) {
        double *peak = q->peaks + LANE(l->index, lane);
        *peak = fmax(*peak, 2.0*log(LANE(largest, lane)));
    }
}
#endif

/* The effect of an event; ends the trajectory if its purpose is fulfilled. */
static void act_for_purpose(queue *q, lanes *l, fixed *f, int lane, int event)
{
    long purpose = q->t->purpose, index = LANE(l->index, lane);
    int closing = LANE(l->closing, lane) != 0;
    act(q, l, f, lane, event);
    if (purpose == WHOLE || !LANE(l->alive, lane) || LANE(l->index, lane) != index)
        return;
    int closes = LANE(l->closing, lane) != 0;
    if (purpose == APPROACH ? closing && !closes : LANE(l->resting, lane) || (!closing && closes))
        finish(q, l, f, lane, DECIDED, STICK, 0);
}
#endif
