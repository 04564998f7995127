#pragma once
/* Boxes that are too wide to be followed as a set. `approach`, by bounds over the gap: to solid contact or the glass
 * criterion, and apart from there, or to where all of it is behind the energy barrier. `turns_apart`: a slow set turns, and
 * opens. */
#include "events.h"

/* Bounds that hold both. */
static void joined(bounds *all, const bounds *more)
{
    for (int i = 0; i < OPENING; i++) {
        all->low[i] = smaller(all->low[i], more->low[i]);
        all->high[i] = larger(all->high[i], more->high[i]);
    }
}

/* The sign of the glass criterion's clearance over a box; 0 if it has both. */
static int clearance_of(proof *w, const iv *x)
{
    expand(&w->rest, &w->p.box, x, 0, 0);
    advance_clearance(&w->rest, &w->p.box, 0);
    return iv_positive(w->rest.clearance.v[0]) ? 1 : iv_negative(w->rest.clearance.v[0]) ? -1 : 0;
}

/* True if a film alone stops all trajectories from a box, head-on: u' = -c u there, so that u keeps its sign and the gap
 * changes by less than |u|/c, and they meet nothing on this way. */
static int stopped(proof *w, const iv *from)
{
    iv x[STATES] = {from[GAP], iv_hull(from[NORMAL_VELOCITY], iv_point(0.0))}, rate[STATES], own[STATES];
    const double most = iv_magnitude(from[NORMAL_VELOCITY]);
    double way = 0.0;
    for (int trial = 0; trial < 2 && !(OBLIQUE || BRIDGE || ATTRACTION) && w->here.film; trial++) {
        field(&w->p, &w->rest, x, rate, own);
        const double passed = iv_negative(own[NORMAL_VELOCITY]) ? most/-iv_hi(own[NORMAL_VELOCITY]) : INFINITY;
        if (passed < way)
            return clearance_of(w, x) > 0;
        way = 2.0*passed;
        x[GAP] = iv_add(from[GAP], iv_ball(way));
        if (!(iv_lo(x[GAP]) > iv_hi(w->p.level[CONTACT_GAP].v) && iv_hi(x[GAP]) < 1.0))
            return 0;
    }
    return 0;
}

/* The tangential force acts throughout the film. */
static int in_shear(const proof *w)
{
    return !OBLIQUE || iv_lo(w->p.level[TANGENTIAL_EDGE].v) >= 1.0;
}

/* All trajectories rebound at gaps and speeds within a box, and open. */
static int rebounds_apart(proof *w, double low, double high, const bounds *b, double panel)
{
    dual y[STATES], after[STATES];
    iv x[STATES];
    x[GAP] = iv_of(low, high);
    box_of(TOGETHER, b, x);
    for (int i = 0; i < STATES; i++)
        y[i] = d_value(x[i]);
    rebound(&w->p.box, y, after);
    for (int i = 0; i < STATES; i++)
        x[i] = after[i].v;
    w->rebounds = 1;
    w->smallest = low;
    if (iv_positive(x[NORMAL_VELOCITY]) && opens(w, x, panel))
        return 1;
    w->rebounds = 0;
    w->smallest = 1.0;
    return 0;
}

/* All trajectories from a box of slow states turn within a box in which their acceleration is outward, meet no criterion
 * there, and open. While v' >= a + k |v| holds, with a, k > 0, v = -fast becomes v = slow in the time (fast + slow)/a, and
 * the gap falls by less than fast^2/2a and fast/k. The others pass an end by no more than their rate there allows, as
 * their rates fall with them. */
static int turns_apart(proof *w, const iv *from, double panel)
{
    iv x[STATES], face[STATES], rate[STATES], own[STATES], there[STATES];
    const double fast = -iv_lo(from[NORMAL_VELOCITY]);
    double depth = 0.0, rise = 0.0, below[STATES] = {0.0}, above[STATES] = {0.0};
    memcpy(x, from, sizeof x);
    x[NORMAL_VELOCITY] = iv_point(0.0);
    field(&w->p, &w->rest, x, rate, own);
    const double slow = smaller(0.5*fast, 0.3*iv_lo(rate[NORMAL_VELOCITY])/(iv_magnitude(own[NORMAL_VELOCITY]) + 1e-300));
    if (!(slow > 0.0 && slow > iv_hi(from[NORMAL_VELOCITY])))
        return 0;
    x[NORMAL_VELOCITY] = iv_of(-fast, slow);
    for (int trial = 0, inside = 0; !inside; trial++) {
        field(&w->p, &w->rest, x, rate, own);
        const double least = iv_lo(rate[NORMAL_VELOCITY]), film = -iv_hi(own[NORMAL_VELOCITY]);
        if (!(least > 0.0) || trial > 12)
            return 0;
        const double falls = film > 0.0 ? smaller(fast*fast/(2.0*least), fast/film) : fast*fast/(2.0*least);
        const double rises = slow*slow/(2.0*least), time = (fast + slow)/least;
        inside = falls < depth && rises < rise;
        for (int i = NORMAL_VELOCITY + 1; i < STATES; i++) {
            if (!(iv_hi(own[i]) <= 0.0))
                return 0;
            for (int up = 0; up < 2; up++) {
                double *passed = up ? &above[i] : &below[i];
                memcpy(face, x, sizeof face);
                face[i] = iv_point(up ? iv_hi(from[i]) : iv_lo(from[i]));
                field(&w->p, &w->rest, face, there, NULL);
                const double out = up ? iv_hi(there[i]) : -iv_lo(there[i]);
                if (!(out <= DBL_MAX))
                    return 0;
                const double change = larger(out, 0.0)*time;
                inside &= change <= *passed;
                if (!(change <= *passed))
                    *passed = 1.2*change;
            }
            x[i] = iv_add(from[i], iv_of(-below[i], above[i]));
        }
        if (!inside) {
            depth = larger(depth, 1.2*falls + 1e-300);
            rise = larger(rise, 1.2*rises + 1e-300);
            x[GAP] = iv_add(from[GAP], iv_of(-depth, rise));
            if (!(iv_lo(x[GAP]) > iv_hi(w->p.level[CONTACT_GAP].v) &&
                  iv_hi(x[GAP]) < smaller(1.0, iv_lo(w->p.level[RUPTURE_GAP].v))))
                return 0;
        }
    }
    const double deepest = iv_lo(x[GAP]);
    if (clearance_of(w, x) <= 0)
        return 0;
    x[NORMAL_VELOCITY] = iv_point(slow);
    if (!opens(w, x, panel))
        return 0;
    w->smallest = deepest;
    return 1;
}

/* True with a proof; else the set and its region are as before. */
static int approach(proof *w, const options *o)
{
    iv x[STATES];
    bounds now, after, met;
    const iv contact = w->p.level[CONTACT_GAP].v;
    double at = 1.0, first = 0.0, panel = o->panel;
    hull_of(&w->p, &w->s, x);
    if (!in_shear(w) || !(iv_hi(contact) < 1.0) || iv_width(x[GAP]) > 0.0)
        return 0;
    now.low[0] = iv_lo(iv_mul(iv_point(0.5), iv_square(x[NORMAL_VELOCITY])));
    now.high[0] = iv_hi(iv_mul(iv_point(0.5), iv_square(x[NORMAL_VELOCITY])));
    for (int i = 1; i < OPENING; i++) {
        now.low[i] = iv_lo(x[i + 1]);
        now.high[i] = iv_hi(x[i + 1]);
    }
    if (!w->wall.known)
        find_barrier(&w->p, &w->rest, &w->wall);
    while (at > iv_lo(contact)) {
        const double to = at > iv_hi(contact) ? larger(at*(1.0 - panel), iv_hi(contact)) : iv_lo(contact);
        const int last = to <= iv_hi(contact), touches = at <= iv_hi(contact);
        const iv gap = iv_of(to, at), h = iv_sub(iv_point(at), iv_point(to));
        ++w->panels;
        if (!crosses(TOGETHER, &w->p, &w->rest, gap, h, panel, NULL, &now, &after)) {
            panel *= 0.5;
            if (panel < 0.3*o->panel || touches)
                return 0;
            continue;
        }
        bounds within = now;
        joined(&within, &after);
        x[GAP] = gap;
        box_of(TOGETHER, &within, x);
        if (first > 0.0 || touches || clearance_of(w, x) <= 0) { /* some may rebound from here on */
            if (o->expected == STICK)
                return 0;
            if (!(first > 0.0)) {
                first = at;
                met = within;
            }
            joined(&met, &within);
            x[GAP] = iv_point(to);
            box_of(TOGETHER, &after, x);
            if (touches || clearance_of(w, x) < 0)
                return rebounds_apart(w, to, first, &met, o->panel);
        } else {
            x[GAP] = iv_point(to);
            box_of(TOGETHER, &after, x);
            set all;
            set_of(x, &all);
            if (below_barrier(&w->p, &w->wall, &all) || stopped(w, x)) {
                w->smallest = 0.0;
                end(w, STICK, PROVED);
                return 1;
            }
        }
        if (o->expected != STICK && last && iv_hi(contact) == iv_lo(contact)) /* contact is a number: all arrive there */
            return rebounds_apart(w, to, first > 0.0 ? first : to, first > 0.0 ? &met : &after, o->panel);
        now = after;
        at = to;
        panel = smaller(o->panel, 1.5*panel);
    }
    return 0;
}
