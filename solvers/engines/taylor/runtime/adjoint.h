/* Adjoint sweep: derivatives of the restitution by all groups at once, from the tape of a trajectory, in reverse.
 *
 * `of` holds the derivatives of the restitution by the states. A step is a program of recurrences; the sweep expands it
 * again and applies the transposed recurrences in reverse order (derive/emit/taylor/adjoint.py). The forward pass has
 * no directions: its steps are controlled for the states, with a stricter tolerance. That does not suffice for modes
 * that decay faster than the series of a step resolves; such trajectories, and long ones, are left to the forward
 * directions, which limit the step.
 *
 * Each lane reads the steps of its own trajectory and takes the next one when it is done. It is done at the start of the
 * trajectory, or where the film has contracted all memory of what came before: what the rest of the trajectory adds to
 * the derivative by a group g is `of`.dy/dg, dy/dg being the derivative of the states there.
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
/* Derivatives of the states by the logarithm of a group, over 1 + |y|: at most this until the film forgets them. */
static const double STEEPEST = 100.0;
/* Part of the tolerance that the neglected rest may take. */
static const double NEGLECTED = 0.1;

typedef struct {
    vec of[STATES];
    vec at_gap[MOVING_GAPS];         /* by the gaps of events */
    vec by_group[GROUPS];            /* by what is no constant of a recurrence: glass criterion, rebound, outputs */
    adjoint bar;
    vec least; /* size of `of` below which the rest is neglected */
    mask active;
    fixed f;
    series s;
    slopes d;
    taped_step step; /* the next to be taken back, of each lane's trajectory */
    long end[LANES], next[LANES], rebound[LANES];
} sweep;

/* Derivatives of the restitution of a trajectory by the constants of its recurrences, its events and its start. */
struct derivatives {
    double of[STATES], constant[CONSTANTS], at_gap[MOVING_GAPS], by_group[GROUPS];
};

#define ADJOINT_TERM(number) { \
    enum { k = number <= ORDER ? ORDER - number : 0 }; \
    if (number > 0 && number <= ORDER) \
        adjoint_coefficients(&r->bar, w, r->of, power[k], &r->s, &r->d, &r->f.c, film, shear, moving, k); \
}

/* Derivatives by the states at the start of the step, from those at its end. */
OUTLINE void retrace(sweep *r, const vec *power, vec film, vec shear, mask moving)
{
    vec w[STATES];
    for (int state = 0; state < STATES; state++)
        w[state] = r->of[state]*power[ORDER];
    EVERY(ADJOINT_TERM)
    for (int state = 0; state < MODEL_STATES; state++)
        r->of[state] = w[state];
}

/* The saltation at the event that ended a step. */
static void unmeet(sweep *r, mask falls, mask damped)
{
    vec whole[STATES][TERMS];
    memcpy(whole, &r->s, sizeof whole);
    if (bits(damped))
        damp(whole, damped);
    meeting m = met(&r->f, (const void *)whole, r->step.h, falls, r->step.flags >> EVENT);
    vec total = splat(0.0), one = splat(1.0), zero = splat(0.0);
    for (int state = 0; state < STATES; state++)
        total += r->of[state]*m.rate[state];
    vec value = only(falls, -total/choose(falls, m.pace, one)); /* d restitution/d event function */
    r->of[GAP] += only(falls, value*choose(m.gap, one, choose(m.velocity, zero, m.by_gap)));
    r->of[NORMAL_VELOCITY] += only(falls, value*choose(m.gap, zero, choose(m.velocity, one, -m.by_approach)));
    for (int which = 0; which < MOVING_GAPS; which++)
        r->at_gap[which] -= only(m.moving[which], value);
    r->by_group[BY_GLASS_NUMBER] += only(m.glass, value);
#if OWN_GLASS
    for (int own = 0; own < OWN_GLASS; own++)
        r->by_group[OWN_GLASS_GROUP[own]] += only(m.glass, value*m.by_own[own]);
#endif /* OWN_GLASS */
}

static vec flagged(mask flags, int64_t bit)
{
    return only((flags & bit) != 0, splat(1.0));
}

/* The equations do not depend on time, so the derivative along the flow, `of`.dy/dt, is zero. Its error, of the steps'
 * tolerance, would not decay with the rest where the film forgets: it is taken away, by the smallest change of `of`. */
static void forget_time(sweep *r)
{
    const vec (*a)[TERMS] = (const vec (*)[TERMS])&r->s;
    vec along = splat(0.0), size = splat(1e-300), by_scale[STATES];
    for (int state = 0; state < MODEL_STATES; state++) {
        vec over = 1.0/(1.0 + vec_abs(r->step.y[state]));
        by_scale[state] = a[state][1]*over*over;
        along += r->of[state]*a[state][1];
        size += by_scale[state]*a[state][1];
    }
    along /= size;
    for (int state = 0; state < MODEL_STATES; state++)
        r->of[state] -= along*by_scale[state];
}

static void unstep(sweep *r)
{
    series *s = &r->s;
    vec (*a)[TERMS] = (vec (*)[TERMS])s;
    mask flags = r->step.flags, moving = (flags & MOVES) != 0;
    vec film = flagged(flags, ACTS), shear = flagged(flags, SHEARS);
    for (int state = 0; state < STATES; state++)
        a[state][0] = r->step.y[state];
    expand_whole(s, &r->f.c, film, shear, moving);
    expand_slopes(&r->d, &r->f.slopes, s, &r->f.c);
    mask damped = r->active & ((flags & CREEPS) != 0), falls = r->active & ((flags & FALLS) != 0);
    vec power[TERMS];
    power[0] = splat(1.0);
    for (int k = 1; k <= ORDER; k++)
        power[k] = power[k - 1]*r->step.h;
    if (bits(damped))
        for (int k = EXACT + 1; k <= ORDER; k++)
            power[k] = choose(damped, damping(k)*power[k], power[k]);
    if (bits(falls))
        unmeet(r, falls, damped);
    retrace(r, power, film, shear, moving);
    forget_time(r);
}

/* The end of a trajectory: derivatives of the restitution by the states there. */
static void unend(sweep *r, const taped_end *own, int lane)
{
    vec y[STATES], at[STATES], shown[OUTPUTS];
    for (int state = 0; state < STATES; state++)
        y[state] = splat(own->y[state]);
    for (int state = 0; state < STATES; state++) {
        memset(at, 0, sizeof at);
        at[state] = splat(1.0);
        outputs_along(&r->f.c, y, at, GROUPS, shown);
        LANE(r->of[state], lane) = LANE(shown[0], lane);
    }
    memset(at, 0, sizeof at);
    for (int group = 0; group < GROUPS; group++) {
        outputs_along(&r->f.c, y, at, group, shown);
        LANE(r->by_group[group], lane) = LANE(shown[0], lane);
    }
    outputs(&r->f.c, y, shown);
    LANE(r->least, lane) = NEGLECTED/STEEPEST*LANE(r->f.tolerance, lane)*fabs(LANE(shown[0], lane));
}

static void undo_rebound(sweep *r, const taped_rebound *own, int lane)
{
    vec y[STATES], at[STATES], behind[STATES], before[STATES];
    for (int state = 0; state < STATES; state++)
        y[state] = splat(own->y[state]);
#if FRICTION
    touch o = touched(&r->f.c, y, lane, own->kind, 0);
#endif
    for (int by = 0; by < STATES + GROUPS; by++) {
        memset(at, 0, sizeof at);
        if (by < STATES)
            at[by] = splat(1.0);
        memcpy(behind, at, sizeof behind);
#if FRICTION
        friction_along(&r->f.c, y, at, by < STATES ? GROUPS : by - STATES, &o, lane, behind);
        memcpy(at, behind, sizeof at);
#endif
        rebound_along(&r->f.c, y, at, by < STATES ? GROUPS : by - STATES, behind);
        vec sum = splat(0.0);
        for (int state = 0; state < STATES; state++)
            sum += r->of[state]*behind[state];
        if (by < STATES)
            before[by] = sum;
        else
            LANE(r->by_group[by - STATES], lane) += LANE(sum, lane);
    }
    for (int state = 0; state < STATES; state++)
        LANE(r->of[state], lane) = LANE(before[state], lane);
}

/* The derivatives of a lane's trajectory are complete. */
static void put_derivatives(const sweep *r, struct derivatives *into, int lane)
{
    for (int state = 0; state < STATES; state++)
        into->of[state] = LANE(r->of[state], lane);
    for (int place = 0; place < CONSTANTS; place++)
        into->constant[place] = LANE(r->bar.constant[place], lane);
    for (int which = 0; which < MOVING_GAPS; which++)
        into->at_gap[which] = LANE(r->at_gap[which], lane);
    for (int group = 0; group < GROUPS; group++)
        into->by_group[group] = LANE(r->by_group[group], lane);
}

/* Puts a trajectory into a lane. */
static void load(sweep *r, const struct tape *t, long end, int lane)
{
    const taped_end *own = &t->ends[end];
    r->end[lane] = end;
    r->next[lane] = own->after;
    r->rebound[lane] = own->rebound;
    for (int field = 0; field < FIXED; field++)
        LANE(((vec *)&r->f)[field], lane) = t->rows[end][field];
    for (int place = 0; place < CONSTANTS; place++)
        LANE(r->bar.constant[place], lane) = 0.0;
    for (int which = 0; which < MOVING_GAPS; which++)
        LANE(r->at_gap[which], lane) = 0.0;
    unend(r, own, lane);
}

/* Puts a lane's next step into `step`, with the rebounds behind it; 0 at the start of the trajectory. */
static int read_step(sweep *r, const struct tape *t, int lane)
{
    const taped_end *own = &t->ends[r->end[lane]];
    for (; r->rebound[lane] >= 0 && t->rebounds[r->rebound[lane]].after == r->next[lane];
         r->rebound[lane] = t->rebounds[r->rebound[lane]].before)
        undo_rebound(r, &t->rebounds[r->rebound[lane]], lane);
    if (r->next[lane] == own->begun)
        return 0;
    const taped_step *step = &t->steps[--r->next[lane]];
    for (int state = 0; state < STATES; state++)
        LANE(r->step.y[state], lane) = LANE(step->y[state], own->lane);
    LANE(r->step.h, lane) = LANE(step->h, own->lane);
    LANE(r->step.flags, lane) = LANE(step->flags, own->lane);
    for (unsigned field = 0; r->next[lane] > 0 && field < sizeof(taped_step)/sizeof(vec); field++)
        __builtin_prefetch((const vec *)(step - 1) + field); /* read after this step */
    return 1;
}

/* Lanes in which the rest of the trajectory cannot matter: by |dy/d ln g| at most STEEPEST times 1 + |y|, it adds
 * no more to the derivative by ln g, for any group, than a part of the tolerance times the restitution. */
static mask forgotten(const sweep *r)
{
    vec size = splat(0.0);
    for (int state = 0; state < MODEL_STATES; state++)
        size += vec_abs(r->of[state])*(1.0 + vec_abs(r->step.y[state]));
    return r->active & (size <= r->least);
}

static void take_back(const struct tape *t, sweep *r)
{
    long taken = 0;
    memset(r, 0, sizeof *r);
    for (;;) {
        EACH_LANE(lane)
        {
            if (!LANE(r->active, lane)) {
                if (taken == t->ended)
                    continue;
                load(r, t, taken++, lane);
                LANE(r->active, lane) = TRUTH;
            }
            while (!read_step(r, t, lane)) {
                put_derivatives(r, &t->derivatives[r->end[lane]], lane);
                if (taken == t->ended) {
                    LANE(r->active, lane) = 0;
                    break;
                }
                load(r, t, taken++, lane);
            }
        }
        if (!bits(r->active))
            return;
        unstep(r);
        EACH_OF(lane, bits(forgotten(r))) {
            for (int state = 0; state < STATES; state++)
                LANE(r->of[state], lane) = 0.0;
            put_derivatives(r, &t->derivatives[r->end[lane]], lane);
            LANE(r->active, lane) = 0;
        }
    }
}

/* From derivatives by constants, events and the start to those by groups, for a vector of trajectories at once. */
static void in_groups(const queue *q)
{
    const struct tape *t = q->tape;
    for (long first = 0; first < t->ended; first += LANES) {
        int many = t->ended - first < LANES ? (int)(t->ended - first) : LANES;
        fixed f;
        vec quantities[QUANTITIES], at[STATES], by_lane[sizeof(struct derivatives)/sizeof(double)];
        EACH_LANE(lane)
        {
            long row = first + (lane < many ? lane : 0);
            for (int k = 0; k < QUANTITIES; k++)
                LANE(quantities[k], lane) = quantity(q, k, t->ends[row].index);
            for (unsigned place = 0; place < sizeof by_lane/sizeof *by_lane; place++)
                LANE(by_lane[place], lane) = ((const double *)(t->derivatives + row))[place];
        }
        scale(&f.c, quantities);
        vec *of = by_lane, *constant = of + STATES, *events = constant + CONSTANTS, *by_group = events + MOVING_GAPS;
        along_constants(&f.c, constant, by_group);
        for (int group = 0; group < GROUPS; group++) {
            vec by_gaps = splat(0.0);
            for (int which = 0; which < MOVING_GAPS; which++)
                by_gaps += events[which]*moving_gap_along(&f, which, group);
            by_group[group] += by_gaps;
            start_along(&f.c, group, at);
            for (int state = 0; state < MODEL_STATES; state++)
                by_group[group] += of[state]*at[state];
            for (int lane = 0; lane < many; lane++)
                q->by_group[t->ends[first + lane].index*GROUPS + group] = LANE(by_group[group], lane);
        }
    }
}

/* All collisions, one tape at a time; 0 if memory for the tape is not available. */
static int there_and_back(queue *q)
{
    struct tape t;
    sweep r;
    long count = q->count;
    memset(&t, 0, sizeof t);
    t.steps = aligned_alloc(sizeof(vec) < 16 ? 16 : sizeof(vec), STEP_ROOM*sizeof(taped_step));
    t.rebounds = malloc(REBOUND_ROOM*sizeof(taped_rebound));
    t.ends = malloc(BATCH*sizeof(taped_end));
    t.rows = malloc(BATCH*sizeof *t.rows);
    t.derivatives = malloc(BATCH*sizeof(struct derivatives));
    int allocated = t.steps && t.rebounds && t.ends && t.rows && t.derivatives;
    q->tape = &t;
    for (long first = 0; allocated && first < count; first += BATCH) {
        q->next = first;
        q->count = count - first < BATCH ? count : first + BATCH;
        t.stepped = t.rebounded = t.ended = t.full = 0;
        run(q);
        take_back(&t, &r);
        in_groups(q);
        in_quantities(q, first);
    }
    free(t.steps);
    free(t.rebounds);
    free(t.ends);
    free(t.rows);
    free(t.derivatives);
    return allocated;
}
#endif
