/* Chatter: a doublet that rebounds again and again, and what shows at a maximum of the gap that it stays.
 *
 * Equal spheres with the library's laws: the orbital-momentum certificate
 * (derive/equations/certificates/orbital_momentum.py); on strings for cycles whose maxima do not grow. Others without
 * strings: such cycles, confined by an attraction. In space: rebounds that take more than the rotation gives
 * (derive/checks/space.py).
 */
#pragma once

#include "automaton.h"
#include "certificates.h"
#include "energy_barrier.h"
#include "model.h"
#include "state.h"

#if CHATTER_TESTS
#if SPACE
/* Lanes in which every rebound from here ends below the present gap. */
static mask held_at_top(const constants *c, const vec *y, vec end, double tolerance)
{
    vec here[2], deepest[2], below[STATES], contact = contact_gap(c); /* outward, inward */
    (void)end;
    memcpy(below, y, sizeof below);
    below[GAP] = contact;
    resting_bound(c, y, here);
    resting_bound(c, below, deepest);
    vec work = vec_max(splat(0.0), deepest[1])*(y[GAP] - contact);
    vec centres = (1.0 + c->radius_ratio)*(1.0 + c->radius_ratio)/c->radius_ratio;
    vec far = centres + c->aspect*y[GAP], near = centres + c->aspect*contact, ratio = (far/near)*(far/near);
    vec sum = vec_sqrt(here[0]) + vec_sqrt(2.0*work*c->aspect/far);
    vec lost = (1.0 - c->dry_restitution*c->dry_restitution)*here[1];
    return (contact > 0.0) & (contact < y[GAP]) & comes_back(sum*sum*ratio*ratio, lost, SAFETY*tolerance);
}
#else
/* Works against the inward force from one gap to another, at the present orbital momentum and at none. */
static void works_ahead(const constants *c, const vec *y, vec low, vec high, vec *pull, vec *attraction)
{
    vec there[STATES], half = 0.5*(high - low), middle = 0.5*(high + low), turning = splat(0.0), still = turning;
    memcpy(there, y, sizeof there);
    for (int node = 0; node < 12; node++) {
        double place = node < 6 ? NODES[node] : -NODES[node - 6];
        there[GAP] = middle + place*half;
        there[ORBITAL_MOMENTUM] = y[ORBITAL_MOMENTUM];
        turning += WEIGHTS[node % 6]*inward_force(c, there);
        there[ORBITAL_MOMENTUM] = splat(0.0);
        still += WEIGHTS[node % 6]*inward_force(c, there);
    }
    *pull = turning*half;
    *attraction = still*half;
}

#if ORBITAL_MARGINS
/* Energy that shear can still take from the spin to the orbit before a gap; beyond the edge of the shear, only until
 * omega = xi at the edge. */
static vec exchanged(const constants *c, const vec *there, vec energy, vec edge)
{
#if STRINGS
    (void)c; (void)there; (void)edge;
    return energy;
#else
    mask beyond = there[GAP] > edge;
    if (!bits(beyond))
        return energy;
    vec at_edge[STATES], slip, left, rigid;
    memcpy(at_edge, there, sizeof at_edge);
    at_edge[GAP] = edge;
    rigid = rigid_momentum(c, at_edge);
#if !REDUCED
    vec settled[STATES];
    rigid_rotation(c, at_edge, settled);
    at_edge[SPIN] = settled[SPIN];
#endif
    at_edge[GAP] = there[GAP];
    at_edge[ORBITAL_MOMENTUM] = rigid;
    transferable(c, at_edge, &slip, &left);
    mask past = choose(rigid < 0.0, -there[ORBITAL_MOMENTUM], there[ORBITAL_MOMENTUM]) >= vec_abs(rigid);
    return choose(beyond, choose(past, splat(0.0), energy - left), energy);
#endif
}

/* Lanes in which some gap ahead can never be reached. */
static mask held_at_top(const constants *c, const vec *y, vec end, double tolerance)
{
    vec from[STATES], slip, energy, inward = splat(0.0), attraction = inward, low = y[GAP], edge = tangential_edge(c);
    memcpy(from, y, sizeof from);
    mask candidates = low < end, held = splat_mask(0);
    vec u = from[NORMAL_VELOCITY];
    for (int k = 1; k <= AHEAD; k++) {
        double part = (double)k/(int)AHEAD;
        vec high = y[GAP] + (end - y[GAP])*(part*part*part), pull, still; /* denser at small distances */
        works_ahead(c, from, low, high, &pull, &still);
        inward += pull;
        attraction += still;
        vec there[STATES];
        memcpy(there, from, sizeof there);
        there[GAP] = low = high;
        transferable(c, there, &slip, &energy);
        vec gained = exchanged(c, there, energy, edge), distance = 4.0 + c->aspect*high;
        slip = vec_abs(slip);
        vec size = vec_abs(from[ORBITAL_MOMENTUM]) + slip*distance*distance;
        vec rotational = c->obliquity*c->obliquity*(1.0/16.0)*size*only(gained > 0.0, slip);
        vec error = u*u + vec_abs(u) + 2.0*vec_abs(attraction) + vec_abs(inward) + rotational;
        held |= stays_below(0.5*u*u - inward + gained, SAFETY*tolerance, error);
    }
    return candidates & held;
}
#else
/* Lanes in which no larger orbital momentum is to come, and the inward force allows no higher maximum. */
static mask held_at_top(const constants *c, const vec *y, vec end, double tolerance)
{
    vec there[STATES], pulled = splat(0.0), weight = pulled, low = y[GAP];
    memcpy(there, y, sizeof there);
    there[GAP] = end;
    mask candidates = (low < end) & (vec_abs(y[ORBITAL_MOMENTUM]) >= vec_abs(rigid_momentum(c, there))), held = splat_mask(0);
    for (int k = 1; k <= AHEAD && bits(candidates); k++) {
        double part = (double)k/(int)AHEAD;
        vec high = y[GAP] + (end - y[GAP])*(part*part*part), pull, still;
        works_ahead(c, y, low, high, &pull, &still);
        pulled += pull;
        weight += vec_abs(still) + vec_abs(still - pull);
        low = high;
        held |= stays_below(-pulled, SAFETY*tolerance, weight);
    }
    return candidates & held;
}
#endif
#endif

/* Lanes at a maximum of the gap from which they stay; their maxima are counted. */
static mask held_in_chatter(lanes *l, const fixed *f, double tolerance)
{
    mask tops = l->alive & l->fresh & l->closing & NOT(l->resting) & (vec_abs(l->y[NORMAL_VELOCITY]) <= STILL);
    if (!bits(tops))
        return tops;
#if SPACE
    return tops & held_at_top(&f->c, l->y, f->end, tolerance);
#else
    double more = 1.0 + SAFETY*tolerance;
    mask grows = NOT(l->y[GAP] <= l->top*more);
#if !STRINGS
    vec swing = vec_abs(l->y[ORBITAL_MOMENTUM]);
    grows |= NOT(swing <= l->swing*more);
    l->swing = choose(tops, swing, l->swing);
#endif
    l->top = choose(tops, l->y[GAP], l->top);
#if ORBITAL_MARGINS && !STRINGS
    mask next = l->cycles + 1; /* they may grow; candidates at the first, second, fourth, ... */
    mask candidates = tops & ((next & (next - 1)) == splat_mask(0));
    (void)grows;
#else
    mask next = only_whole(NOT(grows), l->cycles + 1);
    mask candidates = tops & (next >= splat_mask(CYCLES)) & (((next - splat_mask(CYCLES)) & 15) == splat_mask(0));
#endif
    l->cycles = choose_whole(tops, next, l->cycles);
    return bits(candidates) ? candidates & held_at_top(&f->c, l->y, f->end, tolerance) : candidates;
#endif
}
#endif
