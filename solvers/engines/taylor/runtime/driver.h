/* The driver: series, step, first event and its effect, for all lanes at once until the queue is empty.
 *
 * Collisions too rare to be worth fast code are handed over to solvers/engines/casadi/locate.py; their status says why.
 */
#pragma once

#include "certificates.h"
#include "chatter.h"
#include "damped_sum.h"
#include "effects.h"
#include "events.h"
#include "implicit.h"
#include "model.h"
#include "nearness.h"
#include "queue.h"
#include "state.h"
#include "step.h"
#include "step_record.h"
#include "tangent_step.h"
#include "tape.h"

static void run(queue *q)
{
    lanes l;
    fixed f;
    series s;
#if GRADIENTS && !BACKWARD
    slopes d;
    tangents t;
    memset(&d, 0, sizeof d);
    memset(&t, 0, sizeof t);
#endif
#if RUBS
    rubbing r;
    memset(&r, 0, sizeof r);
#endif
    memset(&l, 0, sizeof l);
    memset(&s, 0, sizeof s);
    memset(&f, 0, sizeof f);
    EACH_LANE(lane) refill(q, &l, &f, lane);
#if JUMPS
    if (!bits(l.alive) && q->turns) { /* all may jump from initial contact */
        jump(q);
        EACH_LANE(lane) refill(q, &l, &f, lane);
    }
#endif
    if (!bits(l.alive))
        return;
    int live = first_of(bits(l.alive)); /* idle lanes repeat a live one: no traps, no slow arithmetic */
    EACH_LANE(lane) if (!LANE(l.alive, lane)) {
        for (int field = 0; field < FIXED; field++)
            LANE(((vec *)&f)[field], lane) = LANE(((vec *)&f)[field], live);
        for (int state = 0; state < STATES; state++)
            LANE(l.y[state], lane) = LANE(l.y[state], live);
    }
    vec (*a)[TERMS] = (vec (*)[TERMS])&s;
    for (;;) {
        if (q->parks && (q->parks >= LANES || !bits(l.alive))) {
            crawl(q);
            EACH_LANE(lane) if (!LANE(l.alive, lane)) refill(q, &l, &f, lane);
        }
#if JUMPS
        if (q->turns && (q->turns >= LANES || !bits(l.alive))) {
            jump(q);
            EACH_LANE(lane) if (!LANE(l.alive, lane)) refill(q, &l, &f, lane);
        }
#endif
        if (!bits(l.alive))
            break;
        mask checked = l.alive & now_and_then(l.fresh, l.phases, l.steps);
        mask sticks = held_sticks(&f.c, l.y, checked, q->rtol);
        sticks |= proved_underway(&l, &f, q->rtol);
        mask rounded = rounded_separations(&f.c, l.y, checked & NOT(sticks), q->rtol);
#if FLOATS
        sticks |= floating(&l, &f, q->rtol);
#endif
#if WELLS
        mask late = l.alive & ((l.steps & (INTERVAL - 1)) == INTERVAL - 1);
        sticks |= in_a_well(&f.c, l.y, f.end, late, q->rtol);
#endif
#if WITH_TRAJECTORY
        sticks &= provable(q, l.closing);
        rounded &= provable(q, l.closing);
#endif
        for (unsigned proved = bits(l.alive & sticks); proved; proved &= proved - 1)
            sticks_for_good(q, &l, &f, first_of(proved), 1);
        for (unsigned lost = bits(rounded); lost; lost &= lost - 1)
            finish(q, &l, &f, first_of(lost), WITHIN_ROUNDING, STICK, 0);
#if CHATTER_TESTS
        mask stays = held_in_chatter(&l, &f, q->rtol);
#if WITH_TRAJECTORY
        stays &= provable(q, l.closing);
#endif
        for (unsigned held = bits(stays); held; held &= held - 1)
            sticks_for_good(q, &l, &f, first_of(held), CHATTER_PROVES);
#endif
#if SPACE && PROOF_BY_ENERGY
        for (unsigned held = bits(late) ? bits(late & tumbles(&f.c, l.y, &f.b, q->rtol)) : 0; held; held &= held - 1)
            sticks_for_good(q, &l, &f, first_of(held), 0);
#endif
        criteria_met(q, &l, &f);
#if FRICTION && TURNS && !RUBS
        if (rests_ended(q, &l, &f)) /* other collisions may have taken these lanes */
            continue;
#endif
        if (!bits(l.alive))
            continue;
#if OWN_EVENTS
        mask happens = splat_mask(0), due = own_events_due(&l, &f, &happens);
        for (unsigned left = bits(due); left; left &= left - 1) {
            int lane = first_of(left);
#if WITH_TRAJECTORY
            act_for_purpose(q, &l, &f, lane, (int)LANE(happens, lane));
#else
            act(q, &l, &f, lane, (int)LANE(happens, lane));
#endif
        }
        if (bits(due))
            continue;
#endif /* OWN_EVENTS */
        for (int state = 0; state < STATES; state++)
            a[state][0] = l.y[state];
#if SPACE
        axes turning;
        mask turns = l.alive & (l.crept != splat_mask(0)); /* what creeps turns as one body */
        if (bits(turns))
            begin_turning(&turning, &f.c, l.y, turns);
        expand(&s, &f.c, acting(&l), l.shear, NOT(l.resting), bits(turns) ? &turning : 0);
#else
        expand(&s, &f.c, acting(&l), l.shear, NOT(l.resting));
#endif
#if RUBS
        if (bits(l.alive & l.resting))
            expand_rubbing(&r, &s, &f.c, &l);
#endif
#if TURNS
        if (bits(l.alive & l.resting) && stills_ended(q, &l, &f, a)) /* other collisions may have taken these lanes */
            continue;
#endif
        mask creeps;
#if GRADIENTS && !BACKWARD
        if (q->asked)
            expand_slopes(&d, &f.slopes, &s, &f.c, acting(&l), l.shear, q->asked);
        expand_along(&t, &l, &f, &s, &d, q->asked);
        vec h = only(l.alive, step_size(&s, &f, &creeps, &t));
        for (unsigned left = bits(creeps) ? t.asked : 0; left; left &= left - 1)
            damp(t.t[first_of(left)], creeps);
#else
        vec h = only(l.alive, step_size(&s, &f, &creeps));
#endif
#if BACKWARD
        h = held_for_derivatives(&l, &f, &s, h, creeps);
#endif
        if (bits(creeps))
            damp(a, creeps);
#if RUBS
        if (bits(creeps & l.alive & l.resting))
            expand_damped(&r, &s, &f.c, &l);
#endif
        if (bits(l.alive & l.closing))
            expand_glass(&s, &f.c);
#if WITH_TRAJECTORY
        if (q->t->purpose == APPROACH) { /* no glass criterion */
            memset(s.glass.result, 0, sizeof s.glass.result);
            s.glass.result[0] = splat(1.0);
        }
#endif
        first_event found;
        find_events(&s, &l, &f, h, &found);
#if RUBS
        if (bits(l.alive & l.resting))
            find_rubbing_events(&r, &l, h, &found);
#endif
        mask falls = l.alive & (found.time <= 1.0);
        h = choose(falls, h*found.time, h);
#if WITH_LIMIT
        if (reached(q, &l, &f, a, h))
            break;
#endif
#if GRADIENTS
        measure(&l, &f, &s, h, falls, found.event);
#endif
#if BACKWARD
        keep_on_tape(q, &l, h, creeps, falls, found.event);
#elif GRADIENTS
        if (q->asked)
            carry(&l, &f, &s, &t, h, falls, found.event, q->asked);
#endif
#if WITH_TRAJECTORY
        keep_steps(q, &l, a, h);
#if GLASS_REACH
        if (q->peaks)
            note_peaks(q, &l, &f, &s, h);
#endif
#endif
        if (bits(falls))
            found.gap = sum_at(a[GAP], h);
        l.y[GAP] = choose(l.alive, found.gap, l.y[GAP]);
        for (int state = GAP + 1; state < STATES; state++)
            l.y[state] = choose(l.alive, sum_at(a[state], h), l.y[state]);
#if SPACE
        if (bits(turns))
            turn_back(&turning, h, l.y);
#endif
        l.time += h;
        l.smallest = vec_min(l.smallest, l.y[GAP]);
        l.steps += 1; /* before a lane may take another collision, which must not depend on this one */
        l.crept = only_whole(creeps, l.crept + 1);
        l.stride = h;
        mask sound = vec_abs(l.y[GAP]) < INFINITY;
        sound &= vec_abs(l.y[NORMAL_VELOCITY]) < INFINITY;
        mask lost = l.alive & NOT(sound);
        for (unsigned event = bits(falls & NOT(lost)); event; event &= event - 1) {
            int lane = first_of(event);
#if WITH_TRAJECTORY
            act_for_purpose(q, &l, &f, lane, (int)LANE(found.event, lane));
#else
            act(q, &l, &f, lane, (int)LANE(found.event, lane));
#endif
        }
#if JUMPS
        park_turned(q, &l, &f, falls & NOT(lost) & (found.event == splat_mask(AT_TURNING)) & l.alive & NOT(l.closing));
#endif
        mask spent = l.alive & (lost | (l.steps > q->budget));
        unsigned slow_ones = bits(l.alive & NOT(falls) & NOT(spent) & (l.crept > splat_mask(PATIENCE)));
#if BACKWARD
        spent |= only_if_full(q, l.alive);
        slow_ones = 0;
#elif GRADIENTS
        slow_ones = q->asked ? 0 : slow_ones; /* implicit.h does not compute derivatives */
#endif
#if WITH_TRAJECTORY
        /* only series steps are recorded, and implicit.h ignores the purpose */
        slow_ones = q->step_room || q->t->purpose != WHOLE ? 0 : slow_ones;
#endif
        for (; slow_ones; slow_ones &= slow_ones - 1)
            park(q, &l, &f, first_of(slow_ones));
        for (unsigned failed = bits(spent); failed; failed &= failed - 1) {
            int lane = first_of(failed);
            int status = LANE(lost, lane) ? NOT_FINITE : LANE(l.phases, lane) > CHATTER_PHASES ? CHATTER : NO_BUDGET;
            finish(q, &l, &f, lane, status, STICK, 0);
        }
    }
}
