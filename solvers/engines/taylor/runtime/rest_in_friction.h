/* Resting contact with friction: the surfaces slide against Coulomb's limit, or roll without slip.
 *
 * The gap is held and the tangential states go on, by recurrences of their own (derive/emit/taylor/resting.py). A lane
 * slides until its slip vanishes, and rolls while friction can hold the surfaces together; in space it slides in the
 * direction of its slip, and creeps. No derivative passes resting contact, so that those of a trajectory through it mean
 * nothing.
 */
#pragma once

#include "friction.h"
#include "model.h"
#include "state.h"
#include "turning_axes.h"

#if ROLLS
/* Whether friction can hold the surfaces of a lane together; `sense` is that in which they are driven past each other. */
static int can_hold(const lanes *l, const fixed *f, int lane, double *sense)
{
    vec forces[DRY_FORCES];
    dry_forces(&f->c, l->y, l->film, l->shear, forces);
    double holding = LANE(forces[HOLDING], lane);
    *sense = holding > 0.0 ? 1.0 : holding < 0.0 ? -1.0 : 0.0;
    return friction_holds(holding, LANE(forces[GRIP_LIMIT], lane));
}

/* Sliding from zero slip. */
static void slides(lanes *l, const fixed *f, int lane)
{
    double sense;
    can_hold(l, f, lane, &sense);
    LANE(l->sliding, lane) = sense;
    LANE(l->rolling, lane) = 0.0;
}

/* Without slip: rolling if friction can hold the surfaces together, else sliding. Returns what is reported. */
static int grips(lanes *l, const fixed *f, int lane)
{
    double sense;
    int holds = can_hold(l, f, lane, &sense);
    LANE(l->sliding, lane) = holds ? 0.0 : sense;
    LANE(l->rolling, lane) = holds ? 1.0 : 0.0;
    return holds ? KIND_ROLLS : KIND_SLIDES;
}

/* The mode of a lane that has come to rest; returns whether it rolls. */
static int rubs(lanes *l, const fixed *f, int lane)
{
    vec impulses[IMPULSES];
    dry_slip(&f->c, l->y, impulses);
    double slip = LANE(impulses[SLIP], lane);
    if (has_no_slip(slip))
        return grips(l, f, lane) == KIND_ROLLS;
    LANE(l->sliding, lane) = slip < 0.0 ? -1.0 : 1.0;
    LANE(l->rolling, lane) = 0.0;
    return 0;
}

/* Lanes whose slip or hold keeps half its value between two states. */
static mask keeps_rubbing(const constants *c, const lanes *l, const vec *from, const vec *to)
{
    vec before[DRY_FORCES], after[DRY_FORCES], slip[IMPULSES], later[IMPULSES];
    dry_forces(c, from, l->film, l->shear, before);
    dry_forces(c, to, l->film, l->shear, after);
    dry_slip(c, from, slip);
    dry_slip(c, to, later);
    mask slides_on = 2.0*l->sliding*later[SLIP] > l->sliding*slip[SLIP];
    mask holds = 2.0*(after[GRIP_LIMIT] - vec_abs(after[HOLDING])) > before[GRIP_LIMIT] - vec_abs(before[HOLDING]);
    return choose_whole(l->rolling != 0.0, holds, (l->sliding == 0.0) | slides_on);
}
#endif

#if FRICTION
/* The series of lanes that rest, in place of those without friction. */
#if SPACE
OUTLINE void expand_rubbing(rubbing *r, series *s, const constants *c, const lanes *l, const axes *turning)
#else
OUTLINE void expand_rubbing(rubbing *r, series *s, const constants *c, const lanes *l)
#endif
{
    vec (*a)[TERMS] = (vec (*)[TERMS])s, (*own)[TERMS] = (vec (*)[TERMS])r;
    for (int state = 0; state < STATES; state++)
        own[state][0] = l->y[state];
    for (int k = 0; k <= ORDER; k++) {
        rubbing_coefficients(r, c, l->film, l->shear, l->sliding, l->rolling, k);
        if (k < ORDER) {
            rubbing_next(r, c, l->film, l->shear, l->sliding, l->rolling, k);
            TURN(own, k)
        }
        for (int state = 0; state < STATES; state++)
            a[state][k] = choose(l->resting, own[state][k], a[state][k]);
        s->acceleration[k] = choose(l->resting, -r->rest_reaction[k], s->acceleration[k]);
    }
}

/* The series of their events, from damped series of the states. */
OUTLINE void expand_damped(rubbing *r, series *s, const constants *c, const lanes *l)
{
    vec (*a)[TERMS] = (vec (*)[TERMS])s, (*own)[TERMS] = (vec (*)[TERMS])r;
    for (int state = 0; state < STATES; state++)
        memcpy(own[state], a[state], sizeof own[state]);
    for (int k = 0; k <= ORDER; k++) {
        rubbing_coefficients(r, c, l->film, l->shear, l->sliding, l->rolling, k);
        s->acceleration[k] = choose(l->resting, -r->rest_reaction[k], s->acceleration[k]);
    }
}

/* Rates of lanes that rest, in place of those without friction. */
static void rubbing_rates(rubbing *r, const constants *c, const lanes *l, const vec *y, vec *rate)
{
    vec (*own)[TERMS] = (vec (*)[TERMS])r;
    for (int state = 0; state < STATES; state++)
        own[state][0] = y[state];
    rubbing_coefficients(r, c, l->film, l->shear, l->sliding, l->rolling, 0);
    rubbing_next(r, c, l->film, l->shear, l->sliding, l->rolling, 0);
    for (int state = 0; state < STATES; state++)
        rate[state] = choose(l->resting, own[state][1], rate[state]);
}
#endif
