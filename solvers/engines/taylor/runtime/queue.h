/* The queue: quantities in, constants and certificates at initial contact, lanes filled and emptied, answers out. */
#pragma once

#include "certificates.h"
#include "criteria.h"
#include "energy_barrier.h"
#include "jump.h"
#include "ledger.h"
#include "limit.h"
#include "rows.h"
#include "slow_manifold.h"
#include "state.h"
#include "tangents.h"
#include "tape.h"
#include "tolerance.h"

/* Constants, barrier and start of the collisions from `first` on; returns the lanes that are too oblique. */
static unsigned constants_of(const queue *q, long first, int many, fixed *f, vec *y)
{
    vec quantities[QUANTITIES];
    for (int k = 0; k < QUANTITIES; k++)
        EACH_LANE(lane) LANE(quantities[k], lane) = quantity(q, k, first + (lane < many ? lane : 0));
    scale(&f->c, quantities);
    prepare(&f->c);
#if GRADIENTS
    prepare_slopes(&f->slopes, &f->c);
#if !BACKWARD
    for (int group = 0; group < GROUPS; group++) {
        vec size = vec_abs(((const vec *)&f->c)[group]);
        f->one[group] = DERIVATIVES/choose(size > 0.0, size, splat(1.0));
    }
#endif
#endif
    unsigned beyond = set_tolerance(q, f);
    memset(y, 0, STATES*sizeof *y);
    start(&f->c, y);
    f->contact = contact_gap(&f->c);
    f->end = splat(1.0);
    f->edge = splat(HUGE_VAL);
#if BRIDGE
    f->end = f->c.rupture_gap;
#endif
#if OBLIQUE
    f->edge = tangential_edge(&f->c);
#endif
#if PROOF_BY_ENERGY
    find_barriers(&f->c, y, f->contact, f->end, &f->b);
    f->b.largest = stored_energy(&f->c, y);
    f->b.touch = splat(0.0);
#if ATTRACTS && !CAPILLARY_STATE
    f->b.touch = capillary_work(&f->c, splat(1.0));
#endif
#endif
    return beyond;
}

/* The lanes whose collisions are proved to stick at initial contact. */
static unsigned proved_at_start(queue *q, const fixed *f, const vec *y)
{
    mask all = splat_mask(TRUTH), none = splat_mask(0);
    unsigned proved = bits(proved_sticks(&f->c, y, &f->b, f->contact, all, none, q->rtol)) |
                      bits(held_sticks(&f->c, y, all, q->rtol));
#if PENDULUM_MARGINS
    if (~proved & bits(all))
        proved |= bits(held_on_approach(&f->c, y, f->contact, q->rtol));
#endif
#if WITH_LIMIT
    if (proved & 1 && goes_on_stuck(q, 1))
        proved = 0;
#endif
    return proved & bits(provable(q, all));
}

/* The next collisions that are not decided at initial contact; those that are never take a lane. */
static void fill_queue(queue *q)
{
    fixed f;
    vec y[STATES];
    q->queued = q->taken = 0;
    while (q->queued == 0 && q->next < q->count) {
        long first = q->next;
        int many = q->count - first < LANES ? (int)(q->count - first) : LANES;
        q->next += many;
        unsigned beyond = constants_of(q, first, many, &f, y), proved = proved_at_start(q, &f, y);
#if LEAPS
        unsigned leaps = q->t->jumps > 1 ? bits(may_leap(&f.c, f.edge, q->rtol)) : 0;
#endif
        for (int lane = 0; lane < many; lane++) {
            if (beyond >> lane & 1)
                put(q, first + lane, TOO_OBLIQUE, STICK, 0);
            else if (proved >> lane & 1) {
                put(q, first + lane, PROVED_AT_TOUCH, STICK, 1);
#if WITH_LEDGER
                close_book(q->books + first + lane, &f.c, y, lane);
#endif
            } else {
                q->waiting[q->queued] = first + lane;
                for (int field = 0; field < FIXED; field++)
                    q->rows[q->queued][field] = LANE(((vec *)&f)[field], lane);
                for (int state = 0; state < STATES; state++)
                    q->starts[q->queued][state] = LANE(y[state], lane);
#if LEAPS
                q->leaps[q->queued] = leaps >> lane & 1;
#endif
                q->queued++;
            }
        }
    }
}

/* Puts the collision of a row into a lane, at initial contact. */
static void begin(queue *q, lanes *l, fixed *f, int lane, long row)
{
    for (int field = 0; field < FIXED; field++)
        LANE(((vec *)f)[field], lane) = q->rows[row][field];
    for (int state = 0; state < STATES; state++)
        LANE(l->y[state], lane) = q->starts[row][state];
    LANE(l->index, lane) = q->waiting[row];
    LANE(l->time, lane) = 0.0;
    LANE(l->smallest, lane) = 1.0;
    LANE(l->film, lane) = 1.0;
    LANE(l->shear, lane) = LANE(f->edge, lane) >= 1.0;
    LANE(l->alive, lane) = LANE(l->closing, lane) = LANE(l->fresh, lane) = TRUTH;
    LANE(l->resting, lane) = 0;
#if CHATTER_TESTS
    LANE(l->top, lane) = LANE(l->swing, lane) = 0.0;
    LANE(l->cycles, lane) = 0;
#endif
#if FRICTION
    LANE(l->sliding, lane) = LANE(l->rolling, lane) = 0.0;
#endif
    LANE(l->steps, lane) = LANE(l->phases, lane) = LANE(l->crept, lane) = 0;
    LANE(l->reversal, lane) = -1;
#if WITH_LIMIT
    if (q->contact && q->contact->begun)
        take_up(q->contact, l, lane);
#endif
#if BACKWARD
    along_start(&l->along, lane);
    begin_on_tape(q, lane);
#elif GRADIENTS
    along_start(&l->along, &f->c, lane);
#endif
}

/* Puts the next collision of the queue into a lane; the lane becomes idle if there is none. */
static void refill(queue *q, lanes *l, fixed *f, int lane)
{
    for (;;) {
        if (q->resumes) {
            unpack(q->resumed[--q->resumes], l, f, lane);
            return;
        }
        if (q->taken == q->queued)
            fill_queue(q);
        if (q->taken == q->queued) {
            LANE(l->alive, lane) = 0;
            return;
        }
        long row = q->taken++;
        begin(q, l, f, lane, row);
#if LEAPS
        if (q->leaps[row]) {
            pack(q->for_jump[q->jump_count++], l, f, lane);
            if (q->jump_count >= LANES)
                jump(q);
            continue;
        }
#endif
        return;
    }
}

/* Moves a lane's trajectory to those waiting for implicit.h; a full vector of them waits at most for one step. */
static void park(queue *q, lanes *l, fixed *f, int lane)
{
    pack(q->parked[q->parks++], l, f, lane);
    refill(q, l, f, lane);
}

#if JUMPS
/* Moves trajectories that have just turned from approach to separation to those that wait for the jump along the slow
 * manifold (jump.h), where they may take it. */
static void park_for_jump(queue *q, lanes *l, fixed *f, mask rebounds)
{
    unsigned left = q->t->jumps ? bits(rebounds) : 0;
    if (left)
        EACH_OF(lane, left & bits(may_jump(l, f, q->rtol))) {
            pack(q->for_jump[q->jump_count++], l, f, lane);
            refill(q, l, f, lane);
        }
}
#endif


/* Writes the answer of a trajectory. */
static void settle(queue *q, const lanes *l, const fixed *f, int lane, int status, int outcome, int certified)
{
    answer *a = &q->answers[LANE(l->index, lane)];
    put(q, LANE(l->index, lane), status, outcome, certified);
    a->time = LANE(l->time, lane);
    a->smallest_gap = LANE(l->smallest, lane);
    a->final_gap = LANE(l->y[GAP], lane);
    a->steps = (int32_t)LANE(l->steps, lane);
    a->reversal = (int32_t)LANE(l->reversal, lane);
#if TURNING_STATE
    a->turned = LANE(l->y[TURNED], lane);
#elif OBLIQUE && STRINGS
    a->turned = LANE(l->y[ROTATION], lane);
#endif
    if (status > PROVED_AT_TOUCH) /* undecided: the state reached, without marks of declared events beyond the room */
        for (int k = 0; k < MODEL_STATES - NORMAL_VELOCITY && k < (int)(sizeof a->shown/sizeof(double)); k++)
            a->shown[k] = LANE(l->y[NORMAL_VELOCITY + k], lane);
    if (status == DECIDED && (SPACE || outcome != STICK)) {
        vec shown[OUTPUTS];
        outputs(&f->c, l->y, shown);
        for (int k = 0; k < OUTPUTS; k++)
            a->shown[k] = LANE(shown[k], lane);
#if OBLIQUE
        vec first[STATES];
        start(&f->c, first);
        double slip = in_lane(surface_slip(&f->c, first), lane);
        a->slip = fabs(slip) < LEAST_SLIP ? (double)NAN : in_lane(surface_slip(&f->c, l->y), lane)/slip;
#endif
#if GRADIENTS
        nearness *near = q->near + LANE(l->index, lane);
        near->least = LANE(l->along.near, lane);
        near->boundary = LANE(l->along.boundary, lane);
        near->hint = LANE(l->along.hint, lane);
#if BACKWARD
        if (near->least >= q->t->nearest)
            end_on_tape(q, LANE(l->index, lane), lane, l->y, f);
#else
        if (outcome != STICK)
            along_finished(&l->along, &f->c, l->y, lane, (void *)(q->by_group + LANE(l->index, lane)*GROUPS*RESULTS));
#endif
#endif
    }
#if WITH_LEDGER
    close_book(q->books + LANE(l->index, lane), &f->c, l->y, lane);
#endif
#if WITH_LIMIT
    if (q->contact)
        end_of(q, l, f, lane, a);
#endif
}

/* Ends the trajectory of a lane: its answer is written, and the next collision takes the lane. */
static void finish(queue *q, lanes *l, fixed *f, int lane, int status, int outcome, int certified)
{
    settle(q, l, f, lane, status, outcome, certified);
    refill(q, l, f, lane);
}

/* Ends it as a stick; one that a host interrupts goes on. */
static void sticks_for_good(queue *q, lanes *l, fixed *f, int lane, int certified)
{
#if WITH_LIMIT
    if (goes_on_stuck(q, certified))
        return;
#endif
    finish(q, l, f, lane, DECIDED, STICK, certified);
}
