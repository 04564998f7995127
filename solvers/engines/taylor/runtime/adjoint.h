/* Adjoint sweep: derivatives of the restitution by all groups at once, from the tape of a trajectory, in reverse.
 *
 * `of` holds the derivatives of the restitution by the states. The effect of a step on a direction (tangent_step.h) is
 * linear, a product of matrices. The adjoint sweep applies the transposed product, at the cost of a single direction
 * for any number of groups, with the same result up to rounding. The forward pass has no directions: its steps are
 * controlled for the states, with a stricter tolerance. That does not suffice for modes that decay faster than the
 * series of a step resolves; such trajectories, and long ones, are left to the forward directions, which limit the
 * step.
 */
#pragma once

#include "chain_to_si.h"
#include "damped_sum.h"
#include "driver.h"
#include "model.h"
#include "saltation.h"
#include "state.h"
#include "step.h"
#include "tape.h"
#include "whole_series.h"

#if BACKWARD
typedef struct {
    vec of[STATES], by_group[GROUPS];
    mask active;
    fixed f;
    series s;
    slopes d;
} retreat;

#define COTANGENT_TERM(number) { \
    enum { k = number <= ORDER ? ORDER - number : 0 }; \
    if (number > 0 && number <= ORDER) { \
        for (int state = 0; state < STATES; state++) { \
            after[state][k] = w[state][k + 1]*(1.0/(k + 1)); \
            w[state][k] = of[state]*power[k]; \
        } \
        cotangent_coefficients(w, after, d, c, v, film, shear, k); \
    } \
}

/* Derivatives by the state at the start of the step, and in `after` those by the source term of each coefficient. */
static __attribute__((noinline)) void retrace(vec *of, vec (*after)[TERMS], const vec *power, const slopes *d,
    const slope_constants *c, const constants *v, vec film, vec shear)
{
    vec w[STATES][TERMS];
    for (int state = 0; state < STATES; state++)
        w[state][ORDER] = of[state]*power[ORDER];
    EVERY(COTANGENT_TERM)
    for (int state = 0; state < STATES; state++)
        of[state] = w[state][0];
}

/* The saltation at the event that ended a step. */
static void unmeet(retreat *r, const taped_step *step, mask falls, unsigned asked)
{
    meeting m = met(&r->f, (const void *)&r->s, step->h, falls, step->event);
    vec total = splat(0.0), one = splat(1.0), zero = splat(0.0);
    for (int state = 0; state < STATES; state++)
        total += r->of[state]*m.rate[state];
    vec value = only(falls, -total/choose(falls, m.pace, one)); /* d restitution/d event function */
    r->of[GAP] += value*choose(m.gap, one, choose(m.turned, zero, m.by_gap));
    r->of[NORMAL_VELOCITY] += value*choose(m.gap, zero, choose(m.turned, one, -m.by_approach));
    for (int group = 0; group < GROUPS; group++)
        if (asked >> group & 1)
            r->by_group[group] -= value*target_along(&r->f, &m, group);
    r->by_group[BY_GLASS_NUMBER] += only(m.glass, value);
}

static void unstep(retreat *r, const taped_step *step, unsigned asked)
{
    series *s = &r->s;
    vec(*a)[TERMS] = (void *)s;
    const fixed *f = &r->f;
    for (int state = 0; state < STATES; state++)
        a[state][0] = step->y[state];
    expand(s, &f->c, step->film, step->shear, step->moving);
    expand_slopes(&r->d, &f->slopes, s, &f->c, step->film, step->shear, asked);
    mask damped = step->creeps & r->active, falls = step->falls & r->active;
    vec power[TERMS], of[STATES], after[STATES][TERMS];
    power[0] = splat(1.0);
    for (int k = 1; k <= ORDER; k++)
        power[k] = power[k - 1]*step->h;
    if (bits(damped)) {
        damp(a, damped);
        for (int k = EXACT + 1; k <= ORDER; k++)
            power[k] = choose(damped, damping(k)*power[k], power[k]);
    }
    if (bits(falls))
        unmeet(r, step, falls, asked);
    memcpy(of, r->of, sizeof of);
    retrace(of, after, power, &r->d, &f->slopes, &f->c, step->film, step->shear);
    for (int state = 0; state < STATES; state++)
        r->of[state] = choose(r->active, of[state], r->of[state]);
    for (int group = 0; group < GROUPS; group++) {
        if (!(asked >> group & 1) || !FLOWS[group])
            continue;
        const vec *source[STATES] = {0};
        sources(&r->d, s, group, source);
        vec sum = splat(0.0);
        for (int state = 0; state < STATES; state++)
            if (source[state])
                sum += correlated(source[state], after[state], 0);
        r->by_group[group] += only(r->active, sum);
    }
}

/* The end of a trajectory: derivatives of the restitution by the states there. */
static void unend(retreat *r, const struct tape *t, const taped_note *note)
{
    int lane = note->lane;
    vec y[STATES], at[STATES], shown[OUTPUTS];
    for (int field = 0; field < FIXED; field++)
        ((double *)&((vec *)&r->f)[field])[lane] = t->rows[note->row][field];
    for (int state = 0; state < STATES; state++)
        y[state] = splat(note->y[state]);
    for (int state = 0; state < STATES; state++) {
        memset(at, 0, sizeof at);
        at[state] = splat(1.0);
        outputs_along(&r->f.c, y, at, GROUPS, shown);
        r->of[state][lane] = shown[0][lane];
    }
    memset(at, 0, sizeof at);
    for (int group = 0; group < GROUPS; group++) {
        outputs_along(&r->f.c, y, at, group, shown);
        r->by_group[group][lane] = shown[0][lane];
    }
    r->active[lane] = -1;
}

static void undo_rebound(retreat *r, const taped_note *note)
{
    int lane = note->lane;
    vec y[STATES], at[STATES], behind[STATES], found[STATES];
    for (int state = 0; state < STATES; state++)
        y[state] = splat(note->y[state]);
    for (int by = 0; by < STATES + GROUPS; by++) {
        memset(at, 0, sizeof at);
        if (by < STATES)
            at[by] = splat(1.0);
        memcpy(behind, at, sizeof behind);
        rebound_along(&r->f.c, y, at, by < STATES ? GROUPS : by - STATES, behind);
        vec sum = splat(0.0);
        for (int state = 0; state < STATES; state++)
            sum += r->of[state]*behind[state];
        if (by < STATES)
            found[by] = sum;
        else
            r->by_group[by - STATES][lane] += sum[lane];
    }
    for (int state = 0; state < STATES; state++)
        r->of[state][lane] = found[state][lane];
}

/* The start of a trajectory: adds the dependence of the initial state on the groups, and writes the result. */
static void unbegin(retreat *r, const queue *q, const taped_note *note)
{
    int lane = note->lane;
    double *into = q->by_group + note->index*GROUPS;
    for (int group = 0; group < GROUPS; group++) {
        vec at[STATES];
        start_along(&r->f.c, group, at);
        double sum = r->by_group[group][lane];
        for (int state = 0; state < STATES; state++)
            sum += r->of[state][lane]*at[state][lane];
        into[group] = sum;
    }
    r->active[lane] = 0;
}

static void take_back(const queue *q, retreat *r)
{
    const struct tape *t = q->tape;
    long note = t->noted - 1;
    memset(r, 0, sizeof *r);
    if (t->ended) /* idle lanes repeat a live one */
        for (int field = 0; field < FIXED; field++)
            ((vec *)&r->f)[field] = splat(t->rows[t->ended - 1][field]);
    for (long step = t->stepped; step >= 0; step--) {
        for (; note >= 0 && t->notes[note].after == step; note--) {
            const taped_note *own = &t->notes[note];
            if (own->kind == ENDED)
                unend(r, t, own);
            else if (r->active[own->lane] && own->kind == REBOUND)
                undo_rebound(r, own);
            else if (r->active[own->lane])
                unbegin(r, q, own);
        }
        if (step > 0 && bits(r->active))
            unstep(r, &t->steps[step - 1], q->asked);
    }
}

/* All collisions, one tape at a time; 0 if memory for the tape is not available. */
static int there_and_back(queue *q)
{
    struct tape t;
    retreat r;
    long count = q->count;
    memset(&t, 0, sizeof t);
    t.steps = aligned_alloc(sizeof(vec) < 16 ? 16 : sizeof(vec), STEP_ROOM*sizeof(taped_step));
    t.notes = malloc(NOTE_ROOM*sizeof(taped_note));
    t.rows = malloc(BATCH*sizeof *t.rows);
    int found = t.steps && t.notes && t.rows;
    q->tape = &t;
    for (long first = 0; found && first < count; first += BATCH) {
        q->next = first;
        q->count = count - first < BATCH ? count : first + BATCH;
        t.stepped = t.noted = t.ended = t.full = 0;
        run(q);
        take_back(q, &r);
        in_quantities(q, first);
    }
    free(t.steps);
    free(t.notes);
    free(t.rows);
    return found;
}
#endif
