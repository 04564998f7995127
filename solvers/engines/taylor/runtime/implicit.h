/* Implicit steps for trajectories that creep for long: past a saddle, or in a film pressed by strings, only a slow
 * mode is left.
 *
 * A Taylor step is limited to 13 decay times of the fast modes (damped_sum.h), and near a separatrix there are 1e4
 * such steps. Lanes that have crept for PATIENCE steps are parked. When a full vector of such lanes is available, or
 * nothing else remains, they are continued by the extrapolated linearly implicit Euler method (Deuflhard, SIAM Rev.
 * 27, 505 (1985); Hairer & Wanner, Solving ODEs II, IV.9), which is L-stable, so that steps follow the slow mode only.
 * Every lane has its own step. In space the axes turn along with the doublet, and each step ends in the laboratory's.
 *
 * The error is measured relative to the change over a step, not to the state: the unstable mode grows from nearly
 * zero, and the time of its departure depends on its relative error. A step that could contain an event is rejected,
 * and the lane returns to Taylor steps.
 */
#pragma once

#include "certificates.h"
#include "guards.h"
#include "model.h"
#include "own_events.h"
#include "queue.h"
#include "rest_in_friction.h"
#include "settled.h"
#include "state.h"
#include "turning_axes.h"

enum { PATIENCE = SPACE ? 25 : 100, PENALTY = SPACE ? 75 : 1000, COLUMNS = SPACE ? 8 : 7, TRIES = 4000 };
static const double WORTH = SPACE ? 10.0 : 25.0; /* least number of Taylor steps replaced by one, which costs 5 to 10 */
static const double FLOOR = SPACE ? 1e-12 : 5e-14; /* relative rounding error of a state, amplified by extrapolation */
static const double TICK = 2.3e-16;     /* relative: the next time that differs */
static const double EXCITED = 0.1;      /* as WORTH, where friction rests in space: Taylor steps excite its slip, a few of these damp it */
static const double LEAST_TERM = 0.1; /* a smaller angle or loss counts as this: its rate is rounded like those of the large ones */
static const double LEAST = 1e-300;    /* error allowed where a state is zero and stays so */
static const double ESTIMATED = SPACE ? 20.0 : 1.0; /* times the tolerance: what the last column but one may err by */
#if SPACE
static const double FLOOR_OF_VECTOR = 1e-11; /* more than rtol, where that is small: little changes in these axes */
static const double LEAST_VECTOR = 1e-3;     /* a smaller one counts as this, as in step.h */
static const double MOST_TURNED = 1e9;       /* turns in a step */
#else
static const double FLOOR_OF_MOMENTUM = 1e-12; /* of the largest: their stiff exchange is rounded in every part of a step */
#endif
enum { COST = SPACE ? 8 : 6 }; /* of a step, from the budget: about as long as so many Taylor steps */

typedef struct {
    vec rates[STATES][MODEL_STATES]; /* derivatives of the states' rates */
    series s;                        /* only orders zero and one are used */
    const constants *c;
    vec film, shear;
    mask moving;
#if FRICTION
    rubbing r;
    const lanes *l;
#endif
#if SPACE
    axes turning;
    double rtol;
#if FRICTION
    vec ratio[STATES];     /* of what friction does to a vector, and to the last one */
    vec line[3], force[3]; /* where the step begins: the line of centres, and the friction on the last vector */
    mask chief[3];         /* the largest component of the line */
#endif
#endif
} slow;

#if SPACE
static void turn_rates(const slow *w, const vec *y, vec *rate)
{
    for (int first = FIRST_VECTOR; first < END_OF_VECTORS; first += 3)
        for (int k = 0; k < 3; k++) rate[first + k] -= swept(&w->turning, y + first, 1, k);
}
#endif

#if SPACE && FRICTION
/* Friction at rest is stiff by 1/CREEP in space, which would be rounded where it cancels: in the sums of momenta that it
 * leaves as they are, and along the line of centres. So these sums, and what is along the line, have rows of their own, in
 * place of those of all vectors but the last, and of the last one's chief component. It stands in two rows alone.
 */
enum { LAST_VECTOR = END_OF_VECTORS - 3 };
#define IN_SUM(state) ((state) >= FIRST_VECTOR + 3 && (state) < LAST_VECTOR)
#define LAST_OF(state) (LAST_VECTOR + ((state) - FIRST_VECTOR)%3)
#define IN_LAST(state) ((state) >= LAST_VECTOR && (state) < END_OF_VECTORS)

/* Friction changes every vector by `ratio` times what it does to the last one: row i of I - h J is row i less that times the
 * row of the last vector, and the last vector's chief row is all of its rows along the line.
 */
static void begin_rows(slow *w, const vec *y)
{
    vec change[STATES], square = splat(0.0), largest = square;
    rubbed(w->c, y, splat(1.0), change);
    for (int state = FIRST_VECTOR + 3; state < END_OF_VECTORS; state++)
        change[state] -= y[state];
    for (int k = 0; k < 3; k++) {
        square += change[LAST_VECTOR + k]*change[LAST_VECTOR + k];
        w->line[k] = y[FIRST_VECTOR + k];
        largest = vec_larger(largest, vec_abs(w->line[k]));
    }
    mask free = w->l->resting;
    for (int k = 0; k < 3; k++) {
        w->chief[k] = free & (vec_abs(w->line[k]) == largest);
        free &= NOT(w->chief[k]);
    }
    for (int state = FIRST_VECTOR + 3; state < LAST_VECTOR; state += 3) {
        vec along = splat(0.0);
        for (int k = 0; k < 3; k++)
            along += change[state + k]*change[LAST_VECTOR + k];
        for (int k = 0; k < 3; k++)
            w->ratio[state + k] = only(w->l->resting, along/square);
    }
}

/* The rows of rates, or of their derivatives, without friction, to which it adds `force` along the line, else `push`. */
static void share_friction(const slow *w, const vec *push, vec force, vec *rate)
{
    for (int k = 0; k < 3; k++)
        force += w->line[k]*rate[LAST_VECTOR + k];
    for (int state = 0; state < STATES; state++)
        if (IN_SUM(state))
            rate[state] -= w->ratio[state]*rate[LAST_OF(state)];
        else
            rate[state] += push[state];
    for (int k = 0; k < 3; k++)
        rate[LAST_VECTOR + k] = choose(w->chief[k], force, rate[LAST_VECTOR + k]);
}
#endif

#if FRICTION
/* Adds friction at rest to rates: the difference of those with it and without. */
static void add_friction(slow *w, const vec *y, vec *rate)
{
    vec with[STATES];
    memcpy(with, rate, sizeof with);
    rubbing_rates(&w->r, w->c, w->l, y, with);
#if SPACE
    const vec (*a)[TERMS] = (const vec (*)[TERMS])&w->s, *n = y + FIRST_VECTOR;
    vec along = splat(0.0), square = along, force = along;
    for (int state = 0; state < STATES; state++)
        with[state] = only(w->l->resting, with[state] - a[state][1]);
    for (int k = 0; k < 3; k++) {
        along += n[k]*with[LAST_VECTOR + k];
        square += n[k]*n[k];
    }
    for (int k = 0; k < 3; k++) {
        w->force[k] = with[LAST_VECTOR + k] -= along/square*n[k]; /* rounding leaves something along the line */
        force += (w->line[k] - n[k])*w->force[k];
    }
    share_friction(w, with, force, rate);
#else
    memcpy(rate, with, sizeof with);
#endif
}
#endif

OUTLINE void rates_at(slow *w, const vec *y, vec *rate)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])&w->s;
    for (int state = 0; state < STATES; state++)
        a[state][0] = y[state];
    coefficients(&w->s, w->c, w->film, w->shear, w->moving, 0);
    for (int state = 0; state < STATES; state++)
        rate[state] = a[state][1];
#if SPACE
    turn_rates(w, y, rate);
#endif
#if FRICTION
    if (bits(w->l->resting))
        add_friction(w, y, rate);
#endif
}

#if OWN_EVENTS
/* The series of a motion with these rates for good. */
static const series *along_rates(series *s, const vec *y, const vec *rate)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])s;
    for (int state = 0; state < STATES; state++) {
        memset(a[state], 0, sizeof a[state]);
        a[state][0] = y[state];
        a[state][1] = rate[state];
    }
    return s;
}
#endif /* OWN_EVENTS */

/* Derivatives of the rates: the second coefficients of series that begin along each state. Differences would not do, as
 * extrapolation does not remove an error from the stiff part, and friction changes within CREEP. `rates_at` comes before.
 */
static void find_rates(slow *w)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])&w->s, along[STATES], change[STATES];
    for (int by = 0; by < MODEL_STATES; by++) {
        for (int state = 0; state < STATES; state++)
            a[state][1] = along[state] = splat(state == by);
        coefficients(&w->s, w->c, w->film, w->shear, w->moving, 1);
        for (int state = 0; state < STATES; state++)
            change[state] = 2.0*a[state][2];
#if SPACE
        turn_rates(w, along, change);
#endif
#if FRICTION
        if (bits(w->l->resting)) {
            vec (*own)[TERMS] = (vec (*)[TERMS])&w->r;
            for (int state = 0; state < STATES; state++)
                own[state][1] = along[state];
            rubbing_coefficients(&w->r, w->c, w->film, w->shear, w->l->sliding, w->l->rolling, 1);
            rubbing_next(&w->r, w->c, w->film, w->shear, w->l->sliding, w->l->rolling, 1);
#if SPACE
            for (int state = 0; state < STATES; state++)
                along[state] = only(w->l->resting, 2.0*(own[state][2] - a[state][2]));
            share_friction(w, along, by < FIRST_VECTOR + 3 && by >= FIRST_VECTOR ? -w->force[by - FIRST_VECTOR] : splat(0.0), change);
#else
            for (int state = 0; state < STATES; state++)
                change[state] = choose(w->l->resting, 2.0*own[state][2], change[state]);
#endif
        }
#endif
        for (int state = 0; state < STATES; state++)
            w->rates[state][by] = change[state];
    }
}

/* The unit matrix, in those rows. */
static inline vec unit(const slow *w, int i, int j)
{
    vec one = splat(i == j);
    (void)w;
#if SPACE && FRICTION
    if (IN_SUM(i) && j == LAST_OF(i))
        return -w->ratio[i];
    if (IN_LAST(i) && IN_LAST(j))
        return choose(w->chief[i - LAST_VECTOR], w->line[j - LAST_VECTOR], one);
#endif
    return one;
}

/* LU factors of I - h J without pivoting: where that fails, a lane becomes NaN and its step is rejected. */
typedef struct {
    vec left[MODEL_STATES][MODEL_STATES], over[MODEL_STATES];
} eliminated;

static void eliminate(const slow *w, vec h, eliminated *e)
{
    for (int i = 0; i < MODEL_STATES; i++)
        UNROLL
        for (int j = 0; j < MODEL_STATES; j++)
            e->left[i][j] = unit(w, i, j) - h*w->rates[i][j];
    UNROLL
    for (int k = 0; k < MODEL_STATES; k++) {
        e->over[k] = 1.0/e->left[k][k];
        UNROLL
        for (int i = k + 1; i < MODEL_STATES; i++) {
            e->left[i][k] *= e->over[k];
            UNROLL
            for (int j = k + 1; j < MODEL_STATES; j++)
                e->left[i][j] -= e->left[i][k]*e->left[k][j];
        }
    }
}

/* Solves (I - h J) d = h f; quadratures have no column. */
static void advance(const slow *w, const eliminated *e, vec h, const vec *rate, vec *d)
{
    for (int i = 0; i < MODEL_STATES; i++)
        d[i] = h*rate[i];
    UNROLL
    for (int j = 0; j < MODEL_STATES; j++) /* by columns: no row waits for another */
        UNROLL
        for (int i = j + 1; i < MODEL_STATES; i++)
            d[i] -= e->left[i][j]*d[j];
    UNROLL
    for (int j = MODEL_STATES - 1; j >= 0; j--) {
        d[j] *= e->over[j];
        UNROLL
        for (int i = 0; i < j; i++)
            d[i] -= e->left[i][j]*d[j];
    }
    for (int i = MODEL_STATES; i < STATES; i++) {
        d[i] = h*rate[i];
        for (int j = 0; j < MODEL_STATES; j++)
            d[i] += h*w->rates[i][j]*d[j];
    }
}

/* Lanes in which no event can lie between two states. */
static mask clear_of_events(const lanes *l, const fixed *f, const vec *from, const vec *to)
{
    mask opens = from[NORMAL_VELOCITY] > 0.0;
    mask goes_on = (opens & (to[NORMAL_VELOCITY] > 0.0)) | (NOT(opens) & (to[NORMAL_VELOCITY] < 0.0));
    mask clear = (l->resting | (goes_on & (opens ^ l->closing))) & guards_kept(l, f, from, to);
#if ROLLS
    if (bits(l->resting))
        clear &= NOT(l->resting) | keeps_rubbing(&f->c, l, from, to);
#endif
#if OWN_EVENTS
    clear &= own_guards_kept(&f->c, from, to, l->closing, l->resting, l->film);
#endif /* OWN_EVENTS */
    return clear;
}

/* One step of each lane: the changes, their errors relative to the tolerance, and whether an event is excluded. */
static vec extrapolated(slow *w, const lanes *l, const fixed *f, const vec *rate, vec h, vec *change, mask *clear)
{
    vec table[COLUMNS][STATES], y[STATES], now[STATES], d[STATES], error = splat(0.0), carried = error;
    *clear = splat_mask(TRUTH);
    for (int row = 0; row < COLUMNS; row++) {
        int parts = row + 1;
        vec part = h*(1.0/parts), sum[STATES], last[STATES];
        eliminated e;
        eliminate(w, part, &e);
        memset(sum, 0, sizeof sum);
        memcpy(last, l->y, sizeof last);
        for (int step = 0; step < parts; step++) {
            if (step)
                rates_at(w, last, now);
            advance(w, &e, part, step ? now : rate, d);
            for (int state = 0; state < STATES; state++) {
                sum[state] += d[state];
                y[state] = l->y[state] + sum[state];
            }
            if (row == COLUMNS - 1)
                *clear &= clear_of_events(l, f, l->y, y);
            memcpy(last, y, sizeof last);
        }
        for (int state = 0; state < STATES; state++) {
            vec better = sum[state];
            for (int column = 0; column < row; column++) {
                vec worse = table[column][state];
                table[column][state] = better;
                better += (better - worse)*((double)(row - column)/(column + 1));
            }
            table[row][state] = better;
        }
    }
#if !SPACE
    vec largest = splat(0.0);
    for (int state = NORMAL_VELOCITY + 1; state < MODEL_STATES; state++)
        largest = vec_larger(largest, vec_abs(l->y[state]));
#endif
    for (int state = 0; state < STATES; state++) {
        change[state] = table[COLUMNS - 1][state];
        y[state] = l->y[state] + change[state];
        d[state] = change[state] - table[COLUMNS - 2][state];
    }
    EACH_SIZE(state) {
        vec size = size_of(l->y, 1, state) + (state < MODEL_STATES ? 0.0 : LEAST_TERM);
        vec allowed = ESTIMATED*f->tolerance*size_of(change, 1, state) + FLOOR*size + LEAST;
#if SPACE
        if (state >= FIRST_VECTOR && state < END_OF_VECTORS)
            allowed += (w->rtol + FLOOR_OF_VECTOR)*(size + LEAST_VECTOR);
#else
        if (state != GAP && state != NORMAL_VELOCITY && state < MODEL_STATES)
            allowed += FLOOR_OF_MOMENTUM*largest;
#endif
        if (state == GAP)
            carried = allowed/l->stride; /* an error of the normal velocity decays within a Taylor step */
        if (state == NORMAL_VELOCITY)
            allowed = carried;
        error = vec_larger(error, size_of(d, 1, state)/allowed);
    }
    *clear &= clear_of_events(l, f, l->y, y);
    return error;
}

/* Takes lanes to the next gap with an event where rounding keeps them from it: the gap no longer changes in a step of
 * the series, and is reached within a few of the least steps here. */
static void arrive(lanes *l, const fixed *f, const vec *rate, vec least_step, mask leaves)
{
    mask event;
    vec time = (next_gap(l, f, &event) - l->y[GAP])/rate[GAP];
    mask stays = l->y[GAP] + l->stride*rate[GAP] == l->y[GAP];
    time = only(leaves & stays & (time > 0.0) & (time < 8.0*least_step), time);
#if OWN_EVENTS
    vec there[STATES];
    for (int state = 0; state < STATES; state++)
        there[state] = l->y[state] + time*rate[state];
    time = only(own_guards_kept(&f->c, l->y, there, l->closing, l->resting, l->film), time);
#endif /* OWN_EVENTS */
#if defined(ANGLE_STATE)
    l->y[ANGLE_STATE] += time*rate[ANGLE_STATE];
#endif
#if defined(TIME_STATE)
    vec idle = only(leaves & (l->time + l->stride == l->time), l->time*TICK); /* a time rounds steps of the series away, too */
    l->time += idle;
    l->y[TIME_STATE] += time + idle;
#endif
    l->y[GAP] += time*rate[GAP];
    for (int state = MODEL_STATES; state < STATES; state++)
        l->y[state] += time*rate[state];
    l->time += time;
}

/* Continues parked lanes until they no longer creep: certified, or returned to the queue with their new state. */
OUTLINE void crawl(queue *q)
{
    lanes l;
    fixed f;
    slow w;
    memset(&w, 0, sizeof w);
    int many = q->parks < LANES ? q->parks : LANES;
    q->parks -= many; /* the last ones: the others stay where they are */
    for (int lane = 0; lane < LANES; lane++)
        unpack(q->parked[q->parks + (lane < many ? lane : 0)], &l, &f, lane);
    mask busy = splat_mask(0);
    for (int lane = 0; lane < many; lane++)
        LANE(busy, lane) = TRUTH;
    w.c = &f.c;
    w.film = acting(&l);
    w.shear = l.shear;
    w.moving = NOT(l.resting);
#if FRICTION
    w.l = &l;
#endif
#if SPACE
    w.rtol = q->rtol;
#endif
    vec least_step = WORTH*l.stride, h = 4.0*least_step, parked = l.time;
#if SPACE && FRICTION
    least_step = choose(l.resting, EXCITED*l.stride, least_step);
#endif
    for (int count = 0; count < TRIES && bits(busy); count++) {
        mask sticks = proved_underway(&l, &f, q->rtol) | held_sticks(&f.c, l.y, busy, q->rtol);
#if WITH_LIMIT
        if (bits(busy & sticks) && goes_on_stuck(q, 1))
            sticks = splat_mask(0);
        if (q->contact) {
            vec left = splat(q->contact->limit) - l.time;
            h = vec_min(h, left);
            if (!(LANE(left, 0) > LANE(least_step, 0))) { /* its time lies within a series step */
                LANE(l.crept, 0) = -10*PATIENCE;
                break;
            }
        }
#endif
        EACH_OF(lane, bits(busy & sticks))
            settle(q, &l, &f, lane, DECIDED, STICK, 1);
        busy &= NOT(sticks);
#if SPACE && PROOF_BY_ENERGY
        mask held = busy & tumbles(&f.c, l.y, &f.b, q->rtol);
        EACH_OF(lane, bits(held))
            settle(q, &l, &f, lane, DECIDED, STICK, 0);
        busy &= NOT(held);
#endif
        vec rate[STATES], change[STATES];
        mask clear;
#if SPACE
        begin_turning(&w.turning, &f.c, l.y, busy);
#if FRICTION
        begin_rows(&w, l.y);
#endif
        h = vec_min(h, MOST_TURNED/w.turning.rate);
#endif
        rates_at(&w, l.y, rate);
#if OWN_EVENTS
        h = guards_resolved(along_rates(&w.s, l.y, rate), &l, &f, h);
#endif /* OWN_EVENTS */
        find_rates(&w);
        vec error = extrapolated(&w, &l, &f, rate, h, change, &clear);
        mask taken = busy & clear & (error <= 1.0);
        for (int state = 0; state < STATES; state++)
            l.y[state] += only(taken, change[state]);
#if SPACE
        turn_back(&w.turning, only(taken, h), l.y);
#endif
        l.time += only(taken, h);
        l.smallest = vec_min(l.smallest, l.y[GAP]);
        l.steps += splat_mask(COST);
        vec better = 0.8*vec_exp(vec_log(vec_max(error, splat(1e-8)))*(-1.0/(int)COLUMNS));
        h *= choose(clear & (error == error), vec_min(better, splat(4.0)), splat(0.25));
        mask leaves = busy & (NOT(h > least_step) | (l.time + h == l.time) | (l.steps > splat_mask(q->budget)));
#if OWN_EVENTS
        leaves |= busy & has_rested_long(&l);
#endif /* OWN_EVENTS */
        arrive(&l, &f, rate, least_step, leaves & NOT(taken));
        EACH_OF(lane, bits(leaves)) {
            int came_on = SPACE ? LANE(l.time, lane) > LANE(parked, lane) : LANE(taken, lane) != 0;
            LANE(l.crept, lane) = came_on ? 0 : -PENALTY; /* without success: not again for a while */
            pack(q->resumed[q->resumes++], &l, &f, lane);
        }
        busy &= NOT(leaves);
    }
    EACH_OF(lane, bits(busy))
        pack(q->resumed[q->resumes++], &l, &f, lane);
}
