/* Friction of the dry contact: the tangential impulse of a rebound in one lane, and its derivative. */
#pragma once

#include "automaton.h"
#include "model.h"

/* Whether resting contact with friction rolls (rest_in_friction.h): in space it creeps. */
#define ROLLS (FRICTION && !SPACE)

#if FRICTION
/* What the dry contact does in a lane: its impulse, whether it sticks, and the sign with which it slides (0: without
 * friction). */
typedef struct {
    double impulse, most, sticking, slides;
    int sticks;
} touch;

/* That of a rebound, or of one that `rests`. */
static touch touched(const constants *c, const vec *y, int lane, int kind, int rests)
{
    vec impulses[IMPULSES];
    dry_slip(c, y, impulses);
    touch o;
    memset(&o, 0, sizeof o);
    o.sticking = LANE(impulses[STICKING], lane);
    if (kind != KIND_GLASS || FRICTION_ON_GLASS) {
        o.most = LANE(impulses[rests ? REST_MOST : MOST], lane);
        o.slides = o.sticking < 0.0 ? -1.0 : 1.0;
    }
    o.sticks = fabs(o.sticking) < o.most;
    o.impulse = o.sticking > o.most ? o.most : o.sticking < -o.most ? -o.most : o.sticking;
    return o;
}

#if GRADIENTS
/* Derivative of the state after the friction of a rebound, in a direction. */
static void friction_along(const constants *v, const vec *y, const vec *t, int group, const touch *o, int lane, vec *after)
{
    vec impulses[IMPULSES];
    dry_slip_along(v, y, t, group, impulses);
    double moved = o->sticks ? LANE(impulses[STICKING], lane) : o->slides*LANE(impulses[MOST], lane);
    rubbed_along(v, y, t, group, splat(o->impulse), splat(moved), after);
}
#endif
#endif
