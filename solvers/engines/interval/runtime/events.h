#pragma once
/* The events of a proof: their guards, the set on their surfaces, and what they do to it. */
#include "barrier.h"
#include "contact.h"

enum { UNPROVED, STICK, ROTATE, BOUNCE };
enum event { AT_CONTACT, AT_FILM_IN, AT_FILM_OUT, AT_SHEAR_IN, AT_SHEAR_OUT, AT_RUPTURE, AT_GLASS, EVENTS };
enum { MOST_REBOUNDS = 200 };
#define NO_SPEED 1e-9 /* slower rebounds go on towards rest in contact, which is not enclosed */

typedef struct {
    int order, most_steps, funnels; /* funnels: 1 once the pair opens or turns, 2 on the approach, too */
    double tolerance, widest, panel;
    int expected; /* the only outcome that is looked for; UNPROVED: any */
} options;

typedef struct {
    problem p;
    set s;
    region here;
    barrier wall;
    flow centre, box, rest;
    int outcome, why, steps, rebounds, criterion;
    long panels;
    double h, smallest;
    iv speed;
} proof;

/* A guard of an event on a gap: its target, and +1 where the gap falls to it, -1 where it rises. */
static int gap_guard(const proof *w, int event, dual *target, iv *centre)
{
    const int level = event == AT_CONTACT ? CONTACT_GAP : event == AT_RUPTURE ? RUPTURE_GAP : TANGENTIAL_EDGE;
    if (event == AT_FILM_IN || event == AT_FILM_OUT) {
        *target = d_value(iv_point(1.0));
        *centre = iv_point(1.0);
    } else {
        *target = w->p.level[level];
        *centre = w->p.level_centre[level];
    }
    return event == AT_CONTACT || event == AT_FILM_IN || event == AT_SHEAR_IN ? 1 : -1;
}

static int is_present(const proof *w, int event)
{
    const int film = w->here.film, shear = iv_positive(w->here.shear);
    const iv edge = w->p.level[TANGENTIAL_EDGE].v, end = w->p.level[RUPTURE_GAP].v;
    const int edged = OBLIQUE && iv_lo(edge) < iv_hi(end) && !(edge[0] == -1.0 && edge[1] == 1.0);
    switch (event) {
    case AT_FILM_IN: return !film;
    case AT_FILM_OUT: return film && iv_hi(end) > 1.0;
    case AT_SHEAR_IN: return edged && !shear;
    case AT_SHEAR_OUT: return edged && shear;
    case AT_RUPTURE: return !film || iv_hi(end) <= 1.0;
    default: return 1;
    }
}

static void set_region(proof *w, int film, iv shear)
{
    const iv edge = w->p.level[TANGENTIAL_EDGE].v;
    w->here.film = film;
    w->here.shear = edge[0] == -1.0 && edge[1] == 1.0 ? iv_point(film) : shear; /* the edge of the film, too */
    enter_region(&w->p, w->here);
}

/* Expand the states of `x` up to `order`, with derivatives by states and parameters or without. */
static void expand(flow *s, const constants *c, const iv *x, int order, int derivatives)
{
    active = derivatives ? (1u << DIRECTIONS) - 1 : 0;
    for (int i = 0; i < STATES; i++) {
        s->state[i].v[0] = x[i];
        s->state[i].mask = active; /* parameters, too: they move a gap by its velocity, from order 2 on */
        EACH_DIRECTION(j, active) s->state[i].d[j][0] = iv_point(i == (int)j ? 1.0 : 0.0);
    }
    for (int k = 0; k < order; k++)
        advance(s, c, k);
}

/* True if a series is positive over [a, b], by mean values and bisection. */
static int stays_positive(const iv *g, int order, double a, double b, int depth)
{
    const double m = 0.5*a + 0.5*b;
    const iv t = iv_of(a, b), middle = horner(g, order, iv_point(m));
    if (iv_positive(iv_add(middle, iv_mul(horner_slope(g, order, t), iv_sub(t, iv_point(m))))))
        return 1;
    if (depth == 0 || !(b - a > 1e-15) || !iv_positive(middle))
        return 0;
    return stays_positive(g, order, a, m, depth - 1) && stays_positive(g, order, m, b, depth - 1);
}

static double value_at(const double *c, int order, double t)
{
    double sum = c[order];
    for (int k = order - 1; k >= 0; k--)
        sum = c[k] + t*sum;
    return sum;
}

/* About where the middle of a series falls to zero within [0, h]: between samples, or in a dip; -1 if nowhere. */
static double first_zero(const iv *g, int order, double h)
{
    double c[TERMS], slope[TERMS], last = 0.0;
    for (int k = 0; k <= order; k++)
        c[k] = iv_middle(g[k]);
    for (int k = 0; k < order; k++)
        slope[k] = (k + 1)*c[k + 1];
    for (int i = 1; i <= 32; i++) {
        double from = last, to = h*i/32;
        if (value_at(c, order, to) > 0.0 && value_at(slope, order - 1, from) < 0.0 && value_at(slope, order - 1, to) > 0.0) {
            double a = from, b = to;
            for (int n = 0; n < 60; n++) {
                double m = 0.5*(a + b);
                *(value_at(slope, order - 1, m) < 0.0 ? &a : &b) = m;
            }
            to = value_at(c, order, a) <= 0.0 ? a : to;
        }
        last = h*i/32;
        if (value_at(c, order, to) > 0.0)
            continue;
        for (int n = 0; n < 60; n++) {
            double m = 0.5*(from + to);
            *(value_at(c, order, m) > 0.0 ? &from : &to) = m;
        }
        return 0.5*(from + to);
    }
    return -1.0;
}

static int end(proof *w, int outcome, int why)
{
    w->outcome = outcome;
    w->why = why;
    return 0;
}

/* The set onto the surface of an event, whose crossing states lie in `x`; the set is at one time near them. */
static int onto_surface(proof *w, int event, iv *x)
{
    iv hull[STATES], at[STATES], by[STATES][DIRECTIONS], z[STATES], value, along = iv_point(0.0), f[STATES], gradient[DIRECTIONS];
    hull_of(&w->p, &w->s, hull);
    for (int i = 0; i < STATES; i++) {
        hull[i] = iv_hull(hull[i], x[i]);
        z[i] = iv_point(w->s.z[i]);
    }
    dual target;
    iv centre;
    const int sign = gap_guard(w, event, &target, &centre);
    expand(&w->box, &w->p.box, hull, 1, 1);
    for (int j = 0; j < DIRECTIONS; j++)
        gradient[j] = iv_point(0.0);
    for (int i = 0; i < STATES; i++)
        f[i] = w->box.state[i].v[1];
    if (event == AT_GLASS) {
        advance_clearance(&w->box, &w->p.box, 0);
        EACH_DIRECTION(j, w->box.clearance.mask) gradient[j] = w->box.clearance.d[j][0];
        expand(&w->centre, &w->p.centre, z, 0, 0);
        advance_clearance(&w->centre, &w->p.centre, 0);
        value = w->centre.clearance.v[0];
    } else {
        gradient[GAP] = iv_point(sign);
        EACH_DIRECTION(j, target.mask) gradient[j] = iv_mul(iv_point(-sign), target.d[j]);
        value = iv_mul(iv_point(sign), iv_sub(z[GAP], centre));
    }
    for (int i = 0; i < STATES; i++)
        along = iv_add(along, iv_mul(gradient[i], f[i]));
    if (!iv_negative(along))
        return end(w, UNPROVED, GRAZE);
    for (int i = 0; i < STATES; i++) {
        const iv part = iv_div(f[i], along);
        at[i] = iv_sub(z[i], iv_mul(part, value));
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = iv_sub(iv_point(i == j ? 1.0 : 0.0), iv_mul(part, gradient[j]));
    }
    if (event != AT_GLASS) { /* known exactly */
        at[GAP] = centre;
        for (int j = 0; j < DIRECTIONS; j++)
            by[GAP][j] = HAS(&target, j) ? target.d[j] : iv_point(0.0);
    }
    return map_set(&w->p, &w->s, at, by) || end(w, UNPROVED, TOO_WIDE);
}

/* The rebound, by the emitted jump of the state; its words are those of the automaton. */
static int bounce(proof *w, int criterion)
{
    dual y[STATES], z[STATES], after[STATES], at_centre[STATES];
    iv x[STATES], at[STATES], by[STATES][DIRECTIONS];
    hull_of(&w->p, &w->s, x);
    for (int i = 0; i < STATES; i++) {
        y[i] = d_value(x[i]);
        y[i].mask = 1u << i;
        y[i].d[i] = iv_point(1.0);
        z[i] = d_value(iv_point(w->s.z[i]));
    }
    rebound(&w->p.box, y, after);
    rebound(&w->p.centre, z, at_centre);
    for (int i = 0; i < STATES; i++) {
        at[i] = at_centre[i].v;
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = HAS(&after[i], j) ? after[i].d[j] : iv_point(0.0);
    }
    if (!map_set(&w->p, &w->s, at, by))
        return end(w, UNPROVED, TOO_WIDE);
    hull_of(&w->p, &w->s, x);
    if (!w->rebounds)
        w->criterion = criterion;
    w->rebounds++;
    if (stays_in_contact(&w->p, &w->rest, w->here, x))
        return end(w, STICK, PROVED);
    if (w->rebounds > MOST_REBOUNDS)
        return end(w, UNPROVED, TOO_MANY_REBOUNDS);
    return iv_lo(x[NORMAL_VELOCITY]) > NO_SPEED || end(w, UNPROVED, CHATTER);
}

static int separate(proof *w, iv speed)
{
    w->speed = speed;
    return end(w, w->rebounds ? BOUNCE : ROTATE, PROVED);
}

/* True if all trajectories from a box open and separate, by bounds over the gap. */
static int opens(proof *w, const iv *x, double panel)
{
    iv speed;
    if (!funnel(&w->p, &w->rest, x, w->here, panel, &speed, &w->panels)) {
        enter_region(&w->p, w->here);
        return 0;
    }
    separate(w, speed);
    return 1;
}
