/* Saltation: the derivatives of an event's function, its rate along the trajectory, and the motion of its surface. */
#pragma once

#include "criteria.h"
#include "events.h"
#include "model.h"
#include "state.h"

#if GRADIENTS
/* Derivatives of the function of an event that ends a step. */
typedef struct {
    mask gap, turned, glass;   /* lanes by the kind of function */
    mask contact, end, edge;   /* of those at a gap, which one */
    vec rate[STATES];          /* of the states at the event */
    vec by_gap, by_approach;   /* of the glass criterion */
    vec pace;                  /* rate of the event's function along the trajectory */
    vec at[STATES];            /* the states at the event */
} meeting;

static meeting met(const fixed *f, const vec (*a)[TERMS], vec h, mask falls, mask event)
{
    meeting m;
    memset(&m, 0, sizeof m);
    for (int state = 0; state < STATES; state++) {
        vec rate = ORDER*a[state][ORDER];
        for (int k = ORDER - 1; k > 0; k--)
            rate = rate*h + k*a[state][k];
        m.rate[state] = rate;
        m.at[state] = sum_at(a[state], h);
    }
    m.contact = falls & (event == AT_CONTACT);
    m.end = falls & (event == AT_RUPTURE);
    m.edge = falls & (event == AT_TANGENTIAL_EDGE);
    m.gap = m.contact | m.end | m.edge | (falls & (event == AT_FILM_EDGE));
    m.turned = falls & (event == AT_TURNING);
    m.glass = falls & (event == AT_GLASS);
    vec limit;
    glass_pressure_margin_slopes(
        m.at[GAP], -m.at[NORMAL_VELOCITY], f->c.glass_number, &m.by_gap, &m.by_approach, &limit);
    m.pace = choose(m.gap, m.rate[GAP], choose(m.turned, m.rate[NORMAL_VELOCITY],
        m.by_gap*m.rate[GAP] - m.by_approach*m.rate[NORMAL_VELOCITY]));
    return m;
}

/* Derivative of the gap of an event by a group. */
static inline vec target_along(const fixed *f, const meeting *m, int group)
{
    vec zero = splat(0.0), one = splat(1.0);
    vec moved = choose(m->contact & contact_moves_with(&f->c, group), one, zero);
#if BRIDGE
    if (group == BY_RUPTURE_GAP)
        moved = choose(m->end, one, zero);
#endif
#if OBLIQUE
    if (bits(m->edge))
        moved = choose(m->edge, tangential_edge_along(&f->c, group), moved);
#endif
    return moved;
}
#endif
