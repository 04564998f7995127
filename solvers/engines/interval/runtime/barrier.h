#pragma once
/* The barrier over intervals: a doublet with less energy than it needs to reach some larger gap, work of the attractions included,
 * never gets there. That is the margin of the orbital-momentum certificate where that is derived
 * (derive/checks/orbital_momentum_certificate.py), and else the energy above the least one (derive/checks/certificate.py). */
#include "set.h"

enum { WORK_ORDER = 10, PANELS = 96 };

typedef struct {
    int known, count;
    double middle[PANELS], upper[PANELS], first, gap, reach; /* `gap` has the barrier */
    iv force[PANELS][WORK_ORDER + 1], below[PANELS], above[PANELS]; /* coefficients; integrals from the middle to both ends */
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

/* Work between two gaps within the panels; what all of it has in common cancels. */
static iv work(const barrier *b, iv from, iv to)
{
    iv all = {-INFINITY, -INFINITY};
    if (!b->count)
        return iv_point(0.0);
    if (!(smaller(iv_lo(from), iv_lo(to)) >= b->first && larger(iv_hi(from), iv_hi(to)) <= b->upper[b->count - 1]))
        return iv_line();
    for (int m = 0; m < b->count; m++) {
        const iv start = iv_meet(from, iv_of(m ? b->upper[m - 1] : b->first, b->upper[m]));
        for (int n = 0; iv_width(start) >= 0.0 && n < b->count; n++) {
            const iv end = iv_meet(to, iv_of(n ? b->upper[n - 1] : b->first, b->upper[n]));
            if (!(iv_width(end) >= 0.0))
                continue;
            iv sum = iv_sub(panel_work(b, n, end), panel_work(b, m, start));
            for (int k = m; k < n; k++)
                sum = iv_add(sum, iv_sub(b->above[k], b->below[k + 1]));
            for (int k = n; k < m; k++)
                sum = iv_sub(sum, iv_sub(b->above[k], b->below[k + 1]));
            all = iv_hull(all, sum);
        }
    }
    return all;
}

static void find_barrier(const problem *p, flow *s, barrier *b)
{
    const double first = larger(0.5*iv_lo(p->level[CONTACT_GAP].v), 1e-9), last = iv_lo(p->level[RUPTURE_GAP].v);
    iv rest[WORK_ORDER + 1];
    double at = first;
    b->known = 1;
    b->first = first;
    b->count = 0;
    b->gap = -1.0;
    b->reach = 0.05;
    if (!(BRIDGE || ATTRACTION))
        return;
    while (at < last && b->count < PANELS) {
        const int n = b->count++;
        double to = b->count == PANELS || at*1.6 >= last ? last : at*1.6;
        b->middle[n] = 0.5*(at + to);
        b->upper[n] = to;
        attraction(p, s, iv_point(b->middle[n]), WORK_ORDER - 1, b->force[n]);
        attraction(p, s, iv_of(at, to), WORK_ORDER, rest);
        b->force[n][WORK_ORDER] = rest[WORK_ORDER];
        b->below[n] = panel_work(b, n, iv_point(at));
        b->above[n] = panel_work(b, n, iv_point(to));
        at = to;
    }
}

/* A function of the states over the set: its value at the centre, and its derivatives. */
static iv over_set(const problem *p, const set *s, iv centre, const dual *by)
{
    for (int j = 0; j < PARAMETERS; j++) {
        iv slope = HAS(by, STATES + j) ? by->d[STATES + j] : iv_point(0.0);
        for (int l = 0; l < STATES; l++)
            slope = iv_add(slope, iv_mul(by->d[l], iv_point(s->parameter[l][j])));
        centre = iv_add(centre, iv_mul(slope, p->rho[j]));
    }
    for (int j = 0; j < STATES; j++) {
        iv slope = iv_point(0.0);
        for (int l = 0; l < STATES; l++)
            slope = iv_add(slope, iv_mul(by->d[l], iv_point(s->q[l][j])));
        centre = iv_add(centre, iv_mul(slope, s->r[j]));
    }
    return centre;
}

/* Energy that a set has above what it needs to reach a gap, work included: the margin of the orbital-momentum certificate. */
static iv margin(const problem *p, const barrier *b, const set *s, iv gap)
{
    const constants *each[2] = {&p->centre, &p->box};
    dual y[STATES], rest[STATES], above[2];
    iv x[STATES];
    hull_of(p, s, x);
    for (int n = 0; n < 2; n++) {
        for (int i = 0; i < STATES; i++) {
            y[i] = d_value(n ? x[i] : iv_point(s->z[i]));
            for (int j = 0; j < STATES; j++)
                y[i].d[j] = iv_point(i == j);
            y[i].mask = n ? (1u << STATES) - 1 : 0;
        }
        memcpy(rest, y, sizeof y);
        rest[GAP] = d_value(gap);
        above[n] = d_add(held_energy(each[n], y), d_negative(needed_energy(each[n], rest)));
    }
    const iv energy = iv_meet(over_set(p, s, above[0].v, &above[1]), above[1].v);
    return iv_sub(energy, work(b, x[GAP], gap));
}

/* True if no state of a set ever reaches some larger gap. Any will do: the one that asks most of the centre is followed from
 * call to call. */
static int below_barrier(const problem *p, barrier *b, const set *s)
{
    iv x[STATES];
    dual y[STATES];
    double best = -INFINITY, from = b->gap;
    hull_of(p, s, x);
    const double least = iv_hi(x[GAP]), last = b->count ? b->upper[b->count - 1] : 0.0;
    if (!(iv_lo(x[GAP]) >= b->first && least < last))
        return 0;
    for (int i = 0; i < STATES; i++)
        y[i] = d_value(iv_point(s->z[i]));
    const int tries = from > 0.0 ? 3 : 24;
    for (int i = 0; i < tries; i++) {
        const double at = tries > 3 ? least + (last - least)*(i + 1)/tries : from*(1.0 + (i - 1)*b->reach);
        const double to = smaller(larger(at, least), last);
        y[GAP] = d_value(iv_point(to));
        const double level = iv_middle(iv_add(needed_energy(&p->centre, y).v, work(b, iv_point(least), iv_point(to))));
        if (level > best) {
            best = level;
            b->gap = to;
        }
    }
    b->reach = b->gap == from ? larger(0.5*b->reach, 1e-3) : smaller(2.0*b->reach, 0.1);
    return iv_negative(margin(p, b, s, iv_point(b->gap)));
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
    dual y[STATES];
    for (int i = 0; i < STATES; i++)
        y[i] = d_value(x[i]);
    const iv excess = excess_energy(&p->box, y).v;
    const double rise = iv_lo(slope_of(p, s, x[GAP])), length = 2.0*iv_hi(excess)/rise;
    const iv way = iv_of(iv_lo(x[GAP]), iv_hi(x[GAP]) + length);
    if (!(rise > 0.0 && length > 0.0 && iv_hi(way) < iv_lo(p->level[RUPTURE_GAP].v)))
        return 0;
    return iv_positive(iv_sub(iv_mul(slope_of(p, s, way), iv_point(0.99*length)), excess));
}
