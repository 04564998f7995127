/* Saltation: the derivatives of an event's function, its rate along the trajectory, and the motion of its surface. */
#pragma once

#include "guards.h"
#include "model.h"
#include "state.h"

#if GRADIENTS
/* Derivatives of the function of an event that ends a step. */
typedef struct {
    mask gap, velocity, glass; /* lanes by what the function depends on */
    mask moving[MOVING_GAPS];  /* of those at a gap that moves with a group, at which */
    vec rate[STATES];          /* of the states at the event */
    vec by_gap, by_approach;   /* of the glass criterion */
#if OWN_GLASS
    vec by_own[OWN_GLASS];     /* of the same, by groups of a model */
#endif /* OWN_GLASS */
    vec pace;                  /* rate of the event's function along the trajectory */
    vec at[STATES];            /* the states at the event */
} meeting;

static meeting met(const fixed *f, const vec (*a)[TERMS], vec h, mask falls, mask event)
{
    meeting m;
    memset(&m, 0, sizeof m);
    for (int state = 0; state < STATES; state++)
        m.rate[state] = rate_at(a[state], h);
    states_at(a, h, m.at);
    for (int which = 0; which < MOVING_GAPS; which++)
        m.moving[which] = falls & (event == EVENT_AT[which]);
    m.gap = falls & is_on_gap(event);
    m.velocity = falls & is_on_normal_velocity(event);
    m.glass = falls & is_on_glass_clearance(event);
#if OWN_GLASS
    own_glass_slopes(&f->c, m.at, &m.by_gap, &m.by_approach, m.by_own);
#else
    vec limit;
    glass_pressure_margin_slopes(
        m.at[GAP], -m.at[NORMAL_VELOCITY], f->c.glass_number, &m.by_gap, &m.by_approach, &limit);
#endif /* OWN_GLASS */
    m.pace = choose(m.gap, m.rate[GAP], choose(m.velocity, m.rate[NORMAL_VELOCITY],
        m.by_gap*m.rate[GAP] - m.by_approach*m.rate[NORMAL_VELOCITY]));
    return m;
}

/* Derivative of the gap of an event by a group. */
static inline vec target_along(const fixed *f, const meeting *m, int group)
{
    vec moved = splat(0.0);
    for (int which = 0; which < MOVING_GAPS; which++)
        if (bits(m->moving[which]))
            moved = choose(m->moving[which], moving_gap_along(f, which, group), moved);
    return moved;
}
#endif
