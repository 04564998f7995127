#pragma once
/* The energy barrier over intervals: a doublet with less energy than the least that any state at some larger gap has,
 * work of the attractions included, never gets there. Dissipation only takes energy (derive/checks/certificate.py). */
#include "set.h"

enum { WORK_ORDER = 10, PANELS = 96 };

typedef struct {
    int known, count;
    double middle[PANELS], upper[PANELS], first, gap; /* the first gap, and the barrier's */
    iv force[PANELS][WORK_ORDER + 1], sum[PANELS]; /* coefficients of the force; work up to the panel's middle */
    iv level; /* least energy and work at the barrier */
} barrier;

/* Attraction at rest as a series in the gap. */
static void attraction(const problem *p, flow *s, iv gap, int order, iv *force)
{
    active = 0;
    for (int i = 0; i < STATES; i++) {
        s->state[i].v[0] = iv_point(0.0);
        s->state[i].mask = 0;
    }
    s->state[GAP].v[0] = gap;
    for (int k = 0; k <= order; k++) {
        advance(s, &p->box, k);
        force[k] = iv_mul(iv_point(-(k + 1.0)), s->state[NORMAL_VELOCITY].v[k + 1]);
        for (int i = 0; i < STATES; i++)
            s->state[i].v[k + 1] = iv_point(i == GAP && k == 0 ? 1.0 : 0.0);
    }
}

/* Integral of a panel's force from its middle. */
static iv panel_work(const barrier *b, int n, iv gap)
{
    const iv t = iv_sub(gap, iv_point(b->middle[n]));
    iv sum = iv_point(0.0);
    for (int k = WORK_ORDER; k >= 0; k--)
        sum = iv_mul(t, iv_add(iv_mul(b->force[n][k], RECIPROCAL[k + 1]), sum));
    return sum;
}

/* Work from the first gap up to `gap`, which lies within the panels. */
static iv work_to(const barrier *b, iv gap)
{
    iv work = {-INFINITY, -INFINITY};
    for (int n = 0; n < b->count; n++) {
        iv part = iv_meet(gap, iv_of(n ? b->upper[n - 1] : b->first, b->upper[n]));
        if (iv_lo(part) <= iv_hi(part))
            work = iv_hull(work, iv_add(b->sum[n], panel_work(b, n, part)));
    }
    return work;
}

static iv energy_at(const problem *p, const iv *x, dual (*function)(const constants *, const dual *))
{
    dual y[STATES];
    for (int i = 0; i < STATES; i++)
        y[i] = d_value(x[i]);
    return function(&p->box, y).v;
}

static void find_barrier(const problem *p, flow *s, barrier *b)
{
    const double first = larger(0.5*iv_lo(p->level[CONTACT_GAP].v), 1e-9), last = iv_lo(p->level[RUPTURE_GAP].v);
    iv rest[WORK_ORDER + 1], work = iv_point(0.0), x[STATES];
    double at = first, best = -INFINITY;
    b->known = 1;
    b->first = first;
    b->count = 0;
    b->gap = -1.0;
    if (!(BRIDGE || ATTRACTION))
        return;
    memset(x, 0, sizeof x);
    while (at < last && b->count < PANELS) {
        const int n = b->count++;
        double to = b->count == PANELS || at*1.3 >= last ? last : at*1.3;
        b->middle[n] = 0.5*(at + to);
        b->upper[n] = to;
        attraction(p, s, iv_point(b->middle[n]), WORK_ORDER - 1, b->force[n]);
        attraction(p, s, iv_of(at, to), WORK_ORDER, rest);
        b->force[n][WORK_ORDER] = rest[WORK_ORDER];
        b->sum[n] = iv_sub(work, panel_work(b, n, iv_point(at)));
        work = iv_add(b->sum[n], panel_work(b, n, iv_point(to)));
        at = to;
    }
    double from = first, to = last;
    for (int pass = 0; pass < 5; pass++) { /* any gap is a valid choice */
        const double step = (to - from)/24.0;
        double where = b->gap;
        for (int i = 0; i <= 24; i++) {
            x[GAP] = iv_point(smaller(from + step*i, last));
            iv level = iv_add(energy_at(p, x, least_energy), work_to(b, x[GAP]));
            if (iv_lo(level) > best) {
                best = iv_lo(level);
                where = iv_lo(x[GAP]);
                b->level = level;
            }
        }
        b->gap = where;
        from = larger(where - step, first);
        to = smaller(where + step, last);
    }
}

/* True if all states of a box are behind the barrier. */
static int below_barrier(const problem *p, const barrier *b, const iv *x)
{
    if (!(iv_hi(x[GAP]) < b->gap && iv_lo(x[GAP]) >= b->first))
        return 0;
    return iv_negative(iv_sub(iv_add(energy_at(p, x, stored_energy), work_to(b, x[GAP])), b->level));
}

/* Slope over the gap of the least energy, work included. */
static iv slope_of(const problem *p, flow *s, iv gap)
{
    dual y[STATES];
    iv force;
    for (int i = 0; i < STATES; i++)
        y[i] = d_value(iv_point(0.0));
    y[GAP] = d_value(gap);
    y[GAP].mask = 1u << GAP;
    y[GAP].d[GAP] = iv_point(1.0);
    attraction(p, s, gap, 0, &force);
    const dual least = least_energy(&p->box, y);
    return HAS(&least, GAP) ? iv_add(force, least.d[GAP]) : force;
}

/* True if the least energy rises, from a box of states on, by more than they have above it: energies beside a saddle differ
 * by less than their rounding errors, but their slope does not, nor the excess, which is made of squares
 * (derive/checks/enclosure.py). */
static int below_rise(const problem *p, flow *s, const iv *x)
{
    const iv excess = energy_at(p, x, excess_energy);
    const double rise = iv_lo(slope_of(p, s, x[GAP])), length = 2.0*iv_hi(excess)/rise;
    const iv way = iv_of(iv_lo(x[GAP]), iv_hi(x[GAP]) + length);
    if (!(rise > 0.0 && length > 0.0 && iv_hi(way) < iv_lo(p->level[RUPTURE_GAP].v)))
        return 0;
    return iv_positive(iv_sub(iv_mul(slope_of(p, s, way), iv_point(0.99*length)), excess));
}
