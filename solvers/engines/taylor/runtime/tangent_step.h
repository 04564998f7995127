/* Derivatives over a step: matrix and source terms once, a linear recurrence per direction, saltation at an event. */
#pragma once

#include "events.h"
#include "model.h"
#include "saltation.h"
#include "state.h"
#include "tangents.h"

#if GRADIENTS && !BACKWARD
#define TANGENT_TERM(k) if (k < ORDER) tangent_coefficients(t, d, c, s, v, film, shear, source, k);

OUTLINE void expand_tangent(vec (*t)[TERMS], const slopes *d, const slope_constants *c,
    const series *s, const constants *v, vec film, vec shear, const vec *const *source)
{
    EVERY(TANGENT_TERM)
}

static const vec NOTHING[TERMS];

/* Series of the derivatives, and the scale of their errors: their own magnitude, or the state's for an elasticity of
 * one. A mode that has decayed in the state may persist in its tangent, so both share the step.
 */
static void expand_along(tangents *all, const lanes *l, const fixed *f, const series *s, const slopes *d, unsigned requested)
{
    vec own[STATES];
    EACH_SIZE(state)
        own[state] = size_of(l->y, 1, state) + (state == NORMAL_VELOCITY ? f->rest : state == GAP ? splat(0.0) : splat(1e-3));
    all->requested = 0;
    for (int group = 0; group < GROUPS; group++) {
        if (!(requested >> group & 1) || !bits(l->along.there[group] & l->alive))
            continue;
        all->requested |= 1u << group;
        const vec *source[STATES];
        vec(*t)[TERMS] = all->t[group];
        for (int state = 0; state < STATES; state++) {
            source[state] = NOTHING;
            t[state][0] = l->along.t[group][state];
        }
        EACH_SIZE(state)
            all->scale[group][state] = (mask)pattern(DERIVATIVES*size_of(t[0], TERMS, state) + f->one[group]*own[state]);
        sources(d, s, group, source);
        expand_tangent(t, d, &f->slopes, s, &f->c, acting(l), l->shear, source);
    }
}

/* Derivatives at the end of a step, on the surface of the event that ends it. */
static void carry(lanes *l, const fixed *f, const series *s, const tangents *all, vec h, mask falls, mask event,
    unsigned requested)
{
    carried *a = &l->along;
    meeting m;
    falls &= h > 0.0; /* a criterion met on entry (h = 0) does not cross its surface */
    int meets = bits(falls) != 0;
    if (meets)
        m = met(f, (const vec (*)[TERMS])s, h, falls, event);
    for (int group = 0; group < GROUPS; group++) {
        if (!(requested >> group & 1))
            continue;
        if (all->requested >> group & 1)
            for (int state = 0; state < STATES; state++)
                a->t[group][state] = choose(l->alive, sum_at(all->t[group][state], h), a->t[group][state]);
        if (!meets)
            continue;
        vec *here = a->t[group], target = target_along(f, &m, group);
        vec value = choose(m.gap, here[GAP] - target, choose(m.velocity, here[NORMAL_VELOCITY],
            m.by_gap*here[GAP] - m.by_approach*here[NORMAL_VELOCITY]));
        if (group == BY_GLASS_NUMBER)
            value += only(m.glass, splat(1.0));
#if OWN_GLASS
        for (int own = 0; own < OWN_GLASS; own++)
            if (group == OWN_GLASS_GROUP[own])
                value += only(m.glass, m.by_own[own]);
#endif /* OWN_GLASS */
        vec later = only(falls, -value/choose(falls, m.pace, splat(1.0)));
        for (int state = 0; state < STATES; state++)
            here[state] += only(falls, m.rate[state]*later);
        here[GAP] = choose(m.gap, target, here[GAP]);
        here[NORMAL_VELOCITY] = only(NOT(m.velocity), here[NORMAL_VELOCITY]);
        a->time[group] += later;
        a->there[group] |= falls & (later != 0.0);
        a->smallest[group] = choose(falls & (m.at[GAP] < a->least), here[GAP], a->smallest[group]);
    }
    if (meets)
        a->least = choose(falls & (m.at[GAP] < a->least), m.at[GAP], a->least);
}
#endif
