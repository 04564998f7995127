/* The rules of derive/equations/automaton.py; the effects of the events are emitted into effects.h. */
#pragma once

#include "certificates.h"
#include "criteria.h"
#include "friction.h"
#include "ledger.h"
#include "queue.h"
#include "rest_in_friction.h"
#include "state.h"
#include "tangents.h"
#include "tape.h"

static void separated(queue *q, lanes *l, fixed *f, int lane)
{
    note(q, LANE(l->index, lane), KIND_RUPTURE, LANE(l->time, lane));
    finish(q, l, f, lane, DECIDED, LANE(l->reversal, lane) >= 0 ? BOUNCE : ROTATE, 0);
}

/* Rupture: a separation, unless rounding alone may have set it off. */
static void parts(queue *q, lanes *l, fixed *f, int lane)
{
#if OBLIQUE
    if (is_within_rounding(LANE(l->y[NORMAL_VELOCITY], lane), LANE(f->c.obliquity, lane), LANE(f->c.aspect, lane))) {
        finish(q, l, f, lane, WITHIN_ROUNDING, STICK, 0);
        return;
    }
#endif
    separated(q, l, f, lane);
}

/* Begins an opening phase; on an edge, the phase is beyond that edge. */
static void opens(lanes *l, const fixed *f, int lane)
{
    LANE(l->closing, lane) = 0;
    LANE(l->resting, lane) = 0;
    if (!SPREAD && is_on_edge(LANE(l->y[GAP], lane), 1.0))
        LANE(l->film, lane) = 0.0;
    if (is_on_edge(LANE(l->y[GAP], lane), LANE(f->edge, lane)))
        LANE(l->shear, lane) = 0.0;
#if FRICTION
    LANE(l->sliding, lane) = LANE(l->rolling, lane) = 0.0;
#endif
}

/* Begins a new phase; the rebound criteria are checked on its entry. */
static void new_phase(lanes *l, int lane)
{
    LANE(l->phases, lane)++;
    LANE(l->fresh, lane) = TRUTH;
}

#if FRICTION
/* Friction of a rebound, or of one that `rests`, in a lane's state. */
static void rub(queue *q, lanes *l, fixed *f, int lane, int kind, int rests)
{
    vec after[STATES];
    touch o = touched(&f->c, l->y, lane, kind, rests);
    memcpy(after, l->y, sizeof after);
    rubbed(&f->c, l->y, splat(o.impulse), after);
#if GRADIENTS
    if (o.most > 0.0)
        along_near(&l->along, lane, fabs(log(fabs(o.sticking)/o.most)), GRIPS);
#if !BACKWARD
    along_friction(&l->along, &f->c, l->y, &o, lane);
#endif
#endif
#if WITH_LEDGER
    LANE(l->y[FRICTION_LOSS], lane) += in_lane(friction_loss(&f->c, l->y, splat(o.impulse)), lane);
#endif
    (void)q;
    for (int state = 0; state < MODEL_STATES; state++)
        LANE(l->y[state], lane) = LANE(after[state], lane);
}
#endif

/* Whether a rebound to this state is too weak to open the gap. */
static int too_weak(const queue *q, const fixed *f, const vec *after, int lane)
{
    double inward = in_lane(inward_force(&f->c, after), lane);
    return is_too_weak(inward, LANE(after[NORMAL_VELOCITY], lane), q->rtol, LANE(after[GAP], lane));
}

#if FRICTION
/* The same before the friction of the rebound. */
static int comes_to_rest(const queue *q, const lanes *l, const fixed *f, int lane, int kind)
{
    vec slid[STATES], after[STATES];
    memcpy(slid, l->y, sizeof slid);
    rubbed(&f->c, l->y, splat(touched(&f->c, l->y, lane, kind, 0).impulse), slid);
    memcpy(after, slid, sizeof after);
    rebound(&f->c, slid, after);
    return !is_parted(LANE(after[GAP], lane), LANE(f->end, lane)) && too_weak(q, f, after, lane);
}
#endif

#if OWN_EVENTS
/* Whether no declared event will set a resting lane free. */
static int stays_at_rest(const lanes *l, const fixed *f, int lane)
{
    return bits(rests_beside_events(&f->c, l->y, l->film)) >> lane & 1;
}
#endif /* OWN_EVENTS */

/* A rebound; one too weak to open the gap becomes resting contact, one at the rupture gap separates the doublet. */
static void rebounds(queue *q, lanes *l, fixed *f, int lane, int kind)
{
    vec after[STATES];
#if WITH_LEDGER
    book_rebound(q->books + LANE(l->index, lane), &f->c, l->y, lane);
#endif
#if BACKWARD
    rebound_on_tape(q, lane, l->y, kind);
#endif
#if FRICTION
    int rests = comes_to_rest(q, l, f, lane, kind);
    rub(q, l, f, lane, kind, rests);
#endif
    memcpy(after, l->y, sizeof after);
    rebound(&f->c, l->y, after);
#if GRADIENTS && !BACKWARD
    along_rebound(&l->along, &f->c, l->y, lane);
#endif
    LANE(l->y[NORMAL_VELOCITY], lane) = LANE(after[NORMAL_VELOCITY], lane);
    if (LANE(l->reversal, lane) < 0)
        LANE(l->reversal, lane) = kind;
    new_phase(l, lane);
    note(q, LANE(l->index, lane), kind, LANE(l->time, lane));
    if (is_parted(LANE(l->y[GAP], lane), LANE(f->end, lane))) {
        separated(q, l, f, lane);
        return;
    }
#if !FRICTION
    int rests = too_weak(q, f, l->y, lane);
#endif
    if (!TURNS && LANE(l->y[NORMAL_VELOCITY], lane) == 0.0 && in_lane(inward_force(&f->c, l->y), lane) == 0.0) {
        /* equilibrium */
        LANE(l->resting, lane) = TRUTH;
        LANE(l->closing, lane) = 0;
#if OWN_EVENTS
        note_mode(q, l, lane);
        if (!stays_at_rest(l, f, lane))
            return;
#endif /* OWN_EVENTS */
        sticks_for_good(q, l, f, lane, 1);
        return;
    }
    if (rests) {
        note(q, LANE(l->index, lane), KIND_RESTS, LANE(l->time, lane));
#if GRADIENTS
        along_near(&l->along, lane, 0.0, CHATTERS);
#endif
#if WITH_LEDGER
        book_rest(q->books + LANE(l->index, lane), l->y, lane);
#if OWN_TERMS
        vec more = 0.5*own_inertia(&f->c, l->y)*l->y[NORMAL_VELOCITY]*l->y[NORMAL_VELOCITY];
        q->books[LANE(l->index, lane)].dry += LANE(more, lane);
#endif /* OWN_TERMS */
#endif
        LANE(l->y[NORMAL_VELOCITY], lane) = 0.0;
        opens(l, f, lane);
        LANE(l->resting, lane) = TRUTH;
#if ROLLS
        if (rubs(l, f, lane))
            note(q, LANE(l->index, lane), KIND_ROLLS, LANE(l->time, lane));
#elif FRICTION
        LANE(l->sliding, lane) = 1.0;
#endif
        note_mode(q, l, lane);
#if OWN_TERMS
        if (TURNS && OWN_TERMS_ROTATE) /* the reaction may vanish where no shear acts */
            return;
#endif /* OWN_TERMS */
#if OWN_EVENTS
        if (!stays_at_rest(l, f, lane))
            return;
#endif /* OWN_EVENTS */
        if (!TURNS || (!STRINGS && LANE(l->shear, lane) == 0.0)) /* the reaction never vanishes (derive/checks/friction.py) */
            sticks_for_good(q, l, f, lane, 1);
    } else {
        opens(l, f, lane);
        note_mode(q, l, lane);
    }
}

#if OWN_EVENTS
/* The jump of a declared event; false if it creates energy that it does not declare. */
static int own_event_jumps(queue *q, lanes *l, fixed *f, int lane, int event)
{
    vec after[STATES], released;
    int which = 0; /* a structure need not have all of a model's events */
    while (OWN[which].event != event)
        which++;
    memcpy(after, l->y, sizeof after);
    own_jump(&f->c, l->y, which, after, &released);
    double before = in_lane(stored_energy(&f->c, l->y), lane), left = in_lane(stored_energy(&f->c, after), lane);
    if (!(left - before <= LANE(released, lane) + SAFETY*q->rtol*fabs(before))) {
        note_mode(q, l, lane);
        finish(q, l, f, lane, left == left ? UNDECLARED : NOT_FINITE, STICK, 0);
        return 0;
    }
#if WITH_LEDGER
    q->books[LANE(l->index, lane)].own_events += before - left;
#endif
    for (int state = 0; state < STATES; state++)
        LANE(l->y[state], lane) = LANE(after[state], lane);
    return 1;
}

/* Resting contact after a declared event: it goes on, or is released where the forces turn outward. */
static void rests_on(queue *q, lanes *l, fixed *f, int lane, double pull)
{
    int kind = pull < 0.0 ? KIND_RELEASED : -1;
#if ROLLS
    double rolled = LANE(l->rolling, lane);
    if (kind < 0 && rubs(l, f, lane) != (rolled != 0.0))
        kind = rolled ? KIND_SLIDES : KIND_ROLLS;
#endif
    note_mode(q, l, lane);
    if (kind >= 0)
        note(q, LANE(l->index, lane), kind, LANE(l->time, lane));
    if (kind == KIND_RELEASED) {
        LANE(l->y[NORMAL_VELOCITY], lane) = RELEASE_SPEED;
        opens(l, f, lane);
    } else if (!TURNS && stays_at_rest(l, f, lane))
        sticks_for_good(q, l, f, lane, 1);
}

/* The phase that follows a declared event: in the direction of the velocity, from rest in that of the forces. */
static void goes_on(queue *q, lanes *l, fixed *f, int lane)
{
    double velocity = LANE(l->y[NORMAL_VELOCITY], lane);
    double pull = velocity == 0.0 ? in_lane(inward_force(&f->c, l->y), lane) : -velocity;
    new_phase(l, lane);
    if (LANE(l->resting, lane) && velocity == 0.0) {
        rests_on(q, l, f, lane, pull);
        return;
    }
    if (LANE(l->resting, lane))
        opens(l, f, lane);
    LANE(l->closing, lane) = pull > 0.0 ? TRUTH : 0;
}

/* Lanes with a declared event whose guard is not positive where it is watched, and the first of these events. */
static mask own_events_due(const lanes *l, const fixed *f, mask *event)
{
    vec guard[OWN_EVENTS];
    mask due = splat_mask(0);
    own_guards(&f->c, l->y, guard);
    for (int which = OWN_EVENTS - 1; which >= 0; which--) {
        mask now = l->alive & own_watched(l->y, which, l->closing, l->resting, l->film) & (guard[which] <= 0.0);
        *event = choose_whole(now, splat_mask(OWN[which].event), *event);
        due |= now;
    }
    return due;
}
#endif /* OWN_EVENTS */
/* Relative: what falls back this near to contact never gets there, as its steps are rounded away. */
static const double ROUNDING_OF_GAP = 1.8e-15;

/* Rebound by the first criterion of the table that is met already, in these lanes, which start a closing phase. */
static void criteria_met_by(queue *q, lanes *l, fixed *f, mask candidates)
{
    unsigned glass = bits(candidates & (glass_clearance(&f->c, l->y) <= 0.0));
#if WITH_TRAJECTORY
    glass = q->t->purpose == APPROACH ? 0 : glass;
#endif
    unsigned any = glass | bits(candidates & (l->y[GAP] <= f->contact*(1.0 + ROUNDING_OF_GAP)));
#if GRADIENTS
    if (glass) {
        vec met = vec_abs(vec_log(1.0 - pressure_margin(&f->c, l->y)));
        EACH_OF(lane, glass)
            along_near(&l->along, lane, LANE(met, lane), TOUCH);
    }
#endif
    EACH_LANE(lane)
        if (any >> lane & 1) {
            double gap = fmin(LANE(l->y[GAP], lane), LANE(f->contact, lane));
            rebounds(q, l, f, lane, glass >> lane & 1 ? KIND_GLASS : kind_at_gap(&f->c, gap, lane));
        }
}

/* Criteria on entry into a closing phase.
 *
 * A rebound at initial contact may end its collision; the next collision in that lane is then checked as well.
 */
static void criteria_met(queue *q, lanes *l, fixed *f)
{
    mask candidates = l->fresh & l->alive & l->closing & NOT(l->resting);
    l->fresh = splat_mask(0);
    while (bits(candidates)) {
        criteria_met_by(q, l, f, candidates);
        candidates = l->fresh & l->alive & l->closing & NOT(l->resting);
        l->fresh &= NOT(candidates);
    }
}
