/* The driver: series, step, first event and its effect, for all lanes at once until the queue is empty.
 *
 * Of a collision that is not decided, the status says why.
 */
#pragma once

#include "certificates.h"
#include "chatter.h"
#include "damped_sum.h"
#include "effects.h"
#include "guards.h"
#include "implicit.h"
#include "kinks.h"
#include "model.h"
#include "nearness.h"
#include "queue.h"
#include "settled.h"
#include "state.h"
#include "step.h"
#include "step_record.h"
#include "tangent_step.h"
#include "tape.h"

/* What a step works with besides its lanes. */
typedef struct {
    series s;
#if GRADIENTS && !BACKWARD
    slopes d;
    tangents t;
#elif BACKWARD
    vec contraction;
#endif
#if FRICTION
    rubbing r;
#endif
#if SPACE
    axes turning;
    mask turns; /* lanes in axes that turn along: what creeps turns as one body */
#endif
#if OWN_EVENTS
    mask settled; /* lanes that rest and turn steadily */
#endif /* OWN_EVENTS */
} expansion;

/* Puts the first collisions into the lanes; false if there is none. Idle lanes repeat a live one: no traps, no slow
 * arithmetic. */
static int begin_lanes(queue *q, lanes *l, fixed *f)
{
    EACH_LANE(lane) refill(q, l, f, lane);
#if JUMPS
    if (!bits(l->alive) && q->jump_count) { /* all may jump from initial contact */
        jump(q);
        EACH_LANE(lane) refill(q, l, f, lane);
    }
#endif
    if (!bits(l->alive))
        return 0;
    int live = first_of(bits(l->alive));
    EACH_LANE(lane) if (!LANE(l->alive, lane)) {
        for (int field = 0; field < FIXED; field++)
            LANE(((vec *)f)[field], lane) = LANE(((vec *)f)[field], live);
        for (int state = 0; state < STATES; state++)
            LANE(l->y[state], lane) = LANE(l->y[state], live);
    }
    return 1;
}

/* Takes up what waits for implicit steps or for a jump, where that fills a vector or nothing else is left. */
static void take_up_waiting(queue *q, lanes *l, fixed *f)
{
    if (q->parks && (q->parks >= LANES || !bits(l->alive))) {
        crawl(q);
        EACH_LANE(lane) if (!LANE(l->alive, lane)) refill(q, l, f, lane);
    }
#if JUMPS
    if (q->jump_count && (q->jump_count >= LANES || !bits(l->alive))) {
        jump(q);
        EACH_LANE(lane) if (!LANE(l->alive, lane)) refill(q, l, f, lane);
    }
#endif
}

/* Ends the trajectories that are shown to stick. */
static void end_sticks(queue *q, lanes *l, fixed *f)
{
    mask tested = l->alive & now_and_then(l->fresh, l->phases, l->steps);
    mask sticks = held_sticks(&f->c, l->y, tested, q->rtol);
    sticks |= proved_underway(l, f, q->rtol);
    mask tests = provable(q, l->closing);
    EACH_OF(lane, bits(l->alive & sticks & tests))
        sticks_for_good(q, l, f, lane, 1);
#if CHATTER_TESTS
    mask stays = held_in_chatter(l, f, q->rtol);
    EACH_OF(lane, bits(stays & provable(q, l->closing)))
        sticks_for_good(q, l, f, lane, CHATTER_PROVES);
#endif
#if (KINKS || !FILM_MOMENTUM) && !OWN_EVENTS
    mask stopped = stopped_for_good(l, f);
    EACH_OF(lane, bits(stopped) ? bits(stopped & provable(q, l->closing)) : 0)
        sticks_for_good(q, l, f, lane, 0);
#endif /* (KINKS || !FILM_MOMENTUM) && !OWN_EVENTS */
#if SPACE && PROOF_BY_ENERGY
    mask doubled = ((l->steps & (l->steps + 1)) == 0) & (l->steps > 8); /* soon and ever more rarely, then at intervals */
    mask late = l->alive & (doubled | ((l->steps & (INTERVAL - 1)) == INTERVAL - 1));
    EACH_OF(lane, bits(late) ? bits(late & tumbles(&f->c, l->y, &f->b, q->rtol)) : 0)
        sticks_for_good(q, l, f, lane, 0);
#endif
}

/* The effects of the events of lanes. */
static void act_on(queue *q, lanes *l, fixed *f, mask happens, mask event)
{
    EACH_OF(lane, bits(happens)) {
        mask index = l->index;
#if WITH_TRAJECTORY
        act_for_purpose(q, l, f, lane, (int)LANE(event, lane));
#else
        act(q, l, f, lane, (int)LANE(event, lane));
#endif
        if (LANE(l->alive, lane) && LANE(l->index, lane) == LANE(index, lane))
            note_mode(q, l, lane);
    }
}

/* The series of the states about the start of a step. */
static void expand_states(expansion *e, const lanes *l, const fixed *f)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])&e->s;
    for (int state = 0; state < STATES; state++)
        a[state][0] = l->y[state];
#if SPACE
    e->turns = l->alive & (l->crept != splat_mask(0));
    if (bits(e->turns))
        begin_turning(&e->turning, &f->c, l->y, e->turns);
    expand(&e->s, &f->c, acting(l), l->shear, NOT(l->resting), bits(e->turns) ? &e->turning : 0);
#elif BACKWARD
    e->contraction = expand(&e->s, &f->c, acting(l), l->shear, NOT(l->resting));
#else
    expand(&e->s, &f->c, acting(l), l->shear, NOT(l->resting));
#endif
#if FRICTION
    if (bits(l->alive & l->resting))
#if SPACE
        expand_rubbing(&e->r, &e->s, &f->c, l, bits(e->turns) ? &e->turning : 0);
#else
        expand_rubbing(&e->r, &e->s, &f->c, l);
#endif
#endif
#if OWN_EVENTS
    e->settled = bits(l->alive & l->resting) ? hold_settled(&e->s, &f->c, l) : splat_mask(0);
#if FRICTION
    if (bits(e->settled))
        expand_damped(&e->r, &e->s, &f->c, l);
#endif
#endif /* OWN_EVENTS */
}

/* The length of the step, after which the series are those that are summed; lanes in `creeps` are damped. */
static vec length_of_step(queue *q, expansion *e, const lanes *l, const fixed *f, mask *creeps)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])&e->s;
    (void)q;
#if GRADIENTS && !BACKWARD
    if (q->requested)
        expand_slopes(&e->d, &f->slopes, &e->s, &f->c, acting(l), l->shear, q->requested);
    expand_along(&e->t, l, f, &e->s, &e->d, q->requested);
    vec h = only(l->alive, step_size(&e->s, f, creeps, &e->t));
    EACH_OF(group, bits(*creeps) ? e->t.requested : 0)
        damp(e->t.t[group], *creeps);
#else
    vec h = only(l->alive, step_size(&e->s, f, creeps));
#endif
#if BACKWARD
    h = held_for_derivatives(e->contraction, h, *creeps);
#endif
#if OWN_EVENTS
    *creeps &= NOT(e->settled);
#endif /* OWN_EVENTS */
    if (bits(*creeps))
        damp(a, *creeps);
#if OWN_EVENTS
    h = guards_resolved(&e->s, l, f, h);
#endif /* OWN_EVENTS */
#if FRICTION
    if (bits(*creeps & l->alive & l->resting))
        expand_damped(&e->r, &e->s, &f->c, l);
#endif
    return h;
}

/* The first event of the step. */
static first_event event_of_step(queue *q, expansion *e, const lanes *l, const fixed *f, vec h)
{
    (void)q;
    if (bits(l->alive & l->closing))
        expand_glass(&e->s, &f->c);
#if WITH_TRAJECTORY
    if (q->t->purpose == APPROACH) { /* no glass criterion */
        memset(e->s.glass.result, 0, sizeof e->s.glass.result);
        e->s.glass.result[0] = splat(1.0);
    }
#endif
    first_event first = find_events(&e->s, l, f, h);
#if ROLLS
    if (bits(l->alive & l->resting))
        find_events_at_rest(&e->r, l, h, &first);
#endif
#if OWN_EVENTS
    mask floats = floating(l, &e->s) & (first.event == splat_mask(AT_TURNING));
    if (bits(floats)) {
        first.time = choose(floats, splat(NO_ROOT), first.time);
        find_own_events(&e->s, l, f, h, &first);
    }
#endif /* OWN_EVENTS */
    return first;
}

/* What is kept of the step: nearness to boundaries, derivatives, tape, rows. */
static void keep_step(queue *q, expansion *e, lanes *l, const fixed *f, vec h, mask creeps, mask falls, mask event)
{
    (void)q; (void)e; (void)l; (void)f; (void)h; (void)creeps; (void)falls; (void)event;
#if GRADIENTS
    measure(l, f, &e->s, h, falls, event);
#endif
#if BACKWARD
    keep_on_tape(q, l, h, creeps, falls, event);
#elif GRADIENTS
    if (q->requested)
        carry(l, f, &e->s, &e->t, h, falls, event, q->requested);
#endif
#if WITH_TRAJECTORY
    keep_steps(q, l, (vec (*)[TERMS])&e->s, h);
#if GLASS_REACH
    if (q->peaks)
        note_peaks(q, l, f, &e->s, h);
#endif
#endif
}

/* The states at the end of the step; returns the lanes in which they are not finite. */
static mask take_step(expansion *e, lanes *l, vec h, mask creeps, vec gap)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])&e->s;
    l->y[GAP] = choose(l->alive, gap, l->y[GAP]);
    for (int state = GAP + 1; state < STATES; state++)
        l->y[state] = choose(l->alive, sum_at(a[state], h), l->y[state]);
#if SPACE
    if (bits(e->turns))
        turn_back(&e->turning, h, l->y);
#endif
    l->time += h;
    l->smallest = vec_min(l->smallest, l->y[GAP]);
    l->steps += 1; /* before a lane may take another collision, which must not depend on this one */
    l->crept = only_whole(creeps, l->crept + 1);
    l->stride = h;
    mask finite = vec_abs(l->y[GAP]) < HUGE_VAL;
    finite &= vec_abs(l->y[NORMAL_VELOCITY]) < HUGE_VAL;
    return l->alive & NOT(finite);
}

/* Hands over what is lost or has no budget left, and parks what creeps for long for implicit.h. A collision that has
 * just come into a lane is not in `stepped`: what a step alone may still decide must not depend on the other lanes. */
static void leave_to_others(queue *q, lanes *l, fixed *f, mask lost, mask falls, mask stepped)
{
    mask spent = l->alive & (lost | (stepped & (l->steps > q->budget)));
    unsigned others = bits(l->alive & NOT(falls) & NOT(spent) & (l->crept > splat_mask(PATIENCE)));
#if BACKWARD
    spent |= only_if_full(q, l->alive);
    others = 0;
#elif GRADIENTS
    others = q->requested ? 0 : others; /* implicit.h does not compute derivatives */
#endif
#if WITH_TRAJECTORY
    /* only steps of series are recorded, and implicit.h ignores the purpose */
    others = q->step_room || q->t->purpose != WHOLE ? 0 : others;
#endif
#if KINKS
    others = 0; /* implicit.h takes derivatives across kinks */
#endif /* KINKS */
    EACH_OF(lane, others)
        park(q, l, f, lane);
    EACH_OF(lane, bits(spent)) {
        int status = LANE(lost, lane) ? NOT_FINITE : LANE(l->phases, lane) > CHATTER_PHASES ? CHATTER : NO_BUDGET;
        finish(q, l, f, lane, status, STICK, 0);
    }
}

static void run(queue *q)
{
    lanes l;
    fixed f;
    expansion e;
    memset(&l, 0, sizeof l);
    memset(&f, 0, sizeof f);
    memset(&e, 0, sizeof e);
    if (!begin_lanes(q, &l, &f))
        return;
    for (;;) {
        take_up_waiting(q, &l, &f);
        if (!bits(l.alive))
            return;
        end_sticks(q, &l, &f);
        criteria_met(q, &l, &f);
        if (!bits(l.alive))
            continue;
#if OWN_EVENTS
        mask happens = splat_mask(0), due = own_events_due(&l, &f, &happens);
        act_on(q, &l, &f, due, happens);
        if (bits(due))
            continue;
        mask rested = l.alive & has_rested_long(&l);
        if (bits(rested) && ended_at_rest(q, &l, &f, rested))
            continue;
#endif /* OWN_EVENTS */
        expand_states(&e, &l, &f);
#if TURNS || OWN_EVENTS
        if (bits(l.alive & (l.y[NORMAL_VELOCITY] == 0.0)) && stills_ended(q, &l, &f, (vec (*)[TERMS])&e.s))
            continue; /* other collisions may have taken these lanes */
#endif
        mask creeps;
        vec h = length_of_step(q, &e, &l, &f, &creeps);
#if KINKS
        expand_glass(&e.s, &f.c); /* its pressure may have kinks */
        h = before_kinks(&e.s, h, creeps);
#endif /* KINKS */
        first_event first = event_of_step(q, &e, &l, &f, h);
#if WITH_LIMIT
        pass_over_rounding(q, &e.s, h, &first);
#endif
        mask falls = l.alive & (first.time <= 1.0);
        h = choose(falls, h*first.time, h);
#if WITH_LIMIT
        double since = until_limit(q, &l, h);
        if (since >= 0.0) {
#if WITH_TRAJECTORY
            keep_steps(q, &l, (vec (*)[TERMS])&e.s, splat(since));
#endif
            leave_within(q, &l, &f, (vec (*)[TERMS])&e.s, since);
            return;
        }
#endif
        keep_step(q, &e, &l, &f, h, creeps, falls, first.event);
        mask lost = take_step(&e, &l, h, creeps, bits(falls) ? sum_at(e.s.gap, h) : first.gap);
        mask index = l.index;
        act_on(q, &l, &f, falls & NOT(lost), first.event);
#if JUMPS
        park_for_jump(q, &l, &f, falls & NOT(lost) & (first.event == splat_mask(AT_TURNING)) & l.alive & NOT(l.closing));
#endif
        leave_to_others(q, &l, &f, lost, falls, l.index == index);
    }
}
