#pragma once
/* A step of a proof, up to the next event and across it. */
#include "approach.h"

/* A box that the motion does not leave within a step, and the length of that step; K terms are known over `x`. */
static int a_priori(proof *w, const options *o, const iv *x, double width, iv *box, iv *power)
{
    const double want = larger(o->tolerance, 2e-3*width);
    int contained = 0;
    dual target;
    iv centre;
    for (int trial = 0; trial < 60 && !contained; trial++) {
        if (!(w->h > 1e-14))
            return end(w, UNPROVED, STEP_TOO_SMALL);
        const iv t = iv_of(0.0, w->h);
        iv first[STATES];
        int leaves = 1;
        for (int i = 0; i < STATES; i++) {
            first[i] = horner(w->box.state[i].v, o->order, t);
            box[i] = iv_add(first[i], iv_ball(4.0*want + 1e-14*iv_magnitude(first[i])));
        }
        for (int event = 0; event < AT_GLASS; event++) { /* from a surface the motion must lead away */
            const int sign = gap_guard(w, event, &target, &centre);
            if (is_present(w, event) && !iv_positive(iv_mul(iv_point(sign), iv_sub(x[GAP], target.v))))
                leaves &= iv_positive(iv_mul(iv_point(sign), box[NORMAL_VELOCITY]));
        }
        if (!leaves || !iv_positive(box[GAP])) {
            w->h *= 0.5;
            continue;
        }
        expand(&w->rest, &w->p.box, box, o->order + 1, 0);
        *power = iv_point(1.0);
        for (int k = 0; k <= o->order; k++)
            *power = iv_mul(*power, iv_point(w->h));
        double most = 0.0;
        contained = 1;
        for (int i = 0; i < STATES; i++) {
            iv rest = iv_mul(w->rest.state[i].v[o->order + 1], iv_of(0.0, iv_hi(*power)));
            iv whole = iv_add(first[i], rest);
            contained &= whole[0] < box[i][0] && whole[1] < box[i][1];
            most = larger(most, iv_magnitude(rest));
        }
        contained &= most <= want;
        if (!contained) {
            double factor = pow(0.5*want/(most + 1e-300), 1.0/(o->order + 1));
            w->h *= factor > 0.3 ? smaller(factor, 0.9) : 0.3;
        }
    }
    return contained || end(w, UNPROVED, STEP_TOO_SMALL);
}

/* The set along its trajectories onto a plane g (x - z) = 0 through its centre, as how far each has come does not matter: x
 * becomes x - v m with v = g (x - z) and m a mean of f/(g f) over its way. Any g will do that keeps g f positive there; this
 * one is near the flow of gap and velocity, both scaled. Left as it is where an event is near. */
static void straighten(proof *w)
{
    iv x[STATES], way[STATES], f[STATES], z[STATES], by[STATES][DIRECTIONS], along, centre;
    dual g = d_value(iv_point(0.0)), target;
    for (int i = 0; i < STATES; i++) {
        z[i] = iv_point(w->s.z[i]);
        g.d[i] = iv_point(0.0);
    }
    field(&w->p, &w->rest, z, f, NULL);
    g.mask = (1u << STATES) - 1;
    g.d[GAP] = iv_point(w->s.z[NORMAL_VELOCITY]);
    g.d[NORMAL_VELOCITY] = iv_point(iv_positive(f[NORMAL_VELOCITY]) ? 0.5*w->s.z[GAP] : -0.5*w->s.z[GAP]);
    const iv apart = over_set(&w->p, &w->s, iv_point(0.0), &g);
    hull_of(&w->p, &w->s, x);
    memcpy(way, x, sizeof x);
    for (int trial = 0, inside = 0; !inside; trial++) { /* what they pass on the way */
        field(&w->p, &w->rest, way, f, NULL);
        along = iv_add(iv_mul(g.d[GAP], f[GAP]), iv_mul(g.d[NORMAL_VELOCITY], f[NORMAL_VELOCITY]));
        if (trial > 4 || !iv_positive(along))
            return;
        const iv time = iv_hull(iv_point(0.0), iv_neg(iv_div(apart, along)));
        inside = 1;
        for (int i = 0; i < STATES; i++) {
            const iv moved = iv_add(x[i], iv_mul(f[i], time));
            if (!iv_within(moved, way[i])) {
                way[i] = iv_add(moved, iv_ball(0.1*iv_width(moved)));
                inside = 0;
            }
        }
    }
    for (int event = 0; event < AT_GLASS; event++) {
        (void)gap_guard(w, event, &target, &centre);
        if (is_present(w, event) && iv_hi(target.v) >= iv_lo(way[GAP]) && iv_lo(target.v) <= iv_hi(way[GAP]))
            return;
    }
    if (!iv_positive(way[NORMAL_VELOCITY]) && clearance_of(w, way) <= 0)
        return;
    for (int i = 0; i < STATES; i++) {
        const iv part = iv_div(f[i], along);
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = j < STATES ? iv_sub(iv_point(i == j), iv_mul(part, g.d[j])) : iv_point(0.0);
    }
    if (map_set(&w->p, &w->s, z, by)) /* else the set is as before */
        w->smallest = smaller(w->smallest, iv_lo(way[GAP]));
}

/* One step, or up to the next event and across it. False at the end. */
static int step(proof *w, const options *o, const iv *x, double width)
{
    const int order = o->order, terms = order + 1;
    iv box[STATES], power, z[STATES], guard[EVENTS][TERMS];
    int watched[EVENTS] = {0}, met = -1;
    for (int i = 0; i < STATES; i++)
        z[i] = iv_point(w->s.z[i]);
    expand(&w->centre, &w->p.centre, z, order, 0);
    expand(&w->box, &w->p.box, x, order, 1);
    double size = 0.0;
    for (int i = 0; i < STATES; i++)
        size = larger(size, iv_magnitude(w->centre.state[i].v[order])*(i > NORMAL_VELOCITY ? 0.05 : 1.0));
    const double reach = 1.6*pow(o->tolerance/(size + 1e-300), 1.0/order);
    w->h = smaller(w->steps ? 2.5*w->h : 1e-2, reach);
    if (!a_priori(w, o, x, width, box, &power))
        return 0;
    for (int i = 0; i < STATES; i++)
        w->box.state[i].v[terms] = w->centre.state[i].v[terms] = w->rest.state[i].v[terms];
    w->smallest = smaller(w->smallest, iv_lo(box[GAP]));
    /* events within the step */
    const int closes = !iv_positive(box[NORMAL_VELOCITY]), opens = !iv_negative(box[NORMAL_VELOCITY]);
    double h = w->h, when = 0.0;
    for (int event = 0; event < EVENTS; event++) {
        dual target;
        iv centre;
        if (event == AT_GLASS) {
            if (!closes)
                continue;
            for (int k = 0; k <= terms; k++)
                advance_clearance(&w->rest, &w->p.box, k);
            active = 0;
            for (int k = 0; k <= order; k++)
                advance_clearance(&w->box, &w->p.box, k);
            memcpy(guard[event], w->box.clearance.v, sizeof(iv)*terms);
            guard[event][terms] = w->rest.clearance.v[terms];
        } else {
            const int sign = gap_guard(w, event, &target, &centre);
            if (!is_present(w, event) || !(sign > 0 ? closes : opens) ||
                iv_positive(iv_mul(iv_point(sign), iv_sub(box[GAP], target.v))))
                continue;
            for (int k = 0; k <= terms; k++)
                guard[event][k] = iv_mul(iv_point(sign), k ? w->box.state[GAP].v[k] : iv_sub(w->box.state[GAP].v[0], target.v));
        }
        if (stays_positive(guard[event], terms, 0.0, h, 40))
            continue;
        watched[event] = 1;
        double zero = first_zero(guard[event], terms, h);
        if (zero < 0.0) { /* near the end, or a graze, which a shorter step shows */
            zero = 1.0000001*h;
        }
        if (met < 0 || zero < when) {
            met = event;
            when = zero;
        }
    }
    double early = 0.0, late = 0.0;
    if (met >= 0) {
        const iv *g = guard[met];
        const double error = iv_magnitude(horner(g, terms, iv_point(smaller(when, h))));
        const double slope = iv_magnitude(horner_slope(g, terms, iv_point(smaller(when, h))));
        const double half = 1.5*(error + 1e-300)/(slope + 1e-300) + 1e-15*when;
        early = when - half;
        late = when + half;
        if (late > h) { /* the event belongs to the next step */
            h *= when > h && early > 0.0 ? 0.8 : 0.5;
            for (int event = 0; event < EVENTS; event++)
                while (watched[event] && h > 1e-13 && !stays_positive(guard[event], terms, 0.0, h, 40))
                    h *= 0.5;
            if (!(h > 1e-13))
                return end(w, UNPROVED, GRAZE);
            met = -1;
        } else {
            if (!(early > 0.0))
                return end(w, UNPROVED, width > 1e-6 ? TOO_WIDE : GRAZE);
            for (int event = 0; event < EVENTS; event++)
                if (watched[event] && !stays_positive(guard[event], terms, 0.0, event == met ? early : late, 40))
                    return end(w, UNPROVED, event == met ? GRAZE : ORDER);
            if (!iv_negative(horner_slope(g, terms, iv_of(early, late))) || !iv_negative(horner(g, terms, iv_point(late))))
                return end(w, UNPROVED, GRAZE);
            h = when;
        }
    }
    iv at[STATES], by[STATES][DIRECTIONS], crossing[STATES];
    const iv t = iv_point(h), event_time = iv_of(early, late);
    for (int i = 0; i < STATES; i++) {
        series *state = &w->box.state[i];
        at[i] = horner(w->centre.state[i].v, terms, t);
        crossing[i] = iv_meet(horner(state->v, terms, event_time), box[i]);
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = HAS(state, j) ? horner(state->d[j], order, t) : iv_point(0.0);
    }
    if (!map_set(&w->p, &w->s, at, by))
        return end(w, UNPROVED, TOO_WIDE);
    w->h = h;
    if (met < 0)
        return 1;
    if (!onto_surface(w, met, crossing))
        return 0;
    w->h *= 0.5;
    iv now[STATES];
    hull_of(&w->p, &w->s, now);
    switch (met) {
    case AT_RUPTURE: return separate(w, now[NORMAL_VELOCITY]);
    case AT_FILM_IN: case AT_FILM_OUT: set_region(w, met == AT_FILM_IN, w->here.shear); return 1;
    case AT_SHEAR_IN: case AT_SHEAR_OUT: set_region(w, w->here.film, iv_point(met == AT_SHEAR_IN)); return 1;
    default: return bounce(w, met);
    }
}
