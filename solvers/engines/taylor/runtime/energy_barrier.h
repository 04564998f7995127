/* Barriers of the effective potential, and the energy certificate.
 *
 * A gap ahead whose potential exceeds the energy cannot be passed. So a maximum missed by the grid makes the
 * certificate later or impossible, but never wrong.
 */
#pragma once

#include "automaton.h"
#include "friction.h"
#include "model.h"
#include "proofs.h"

#define ATTRACTS (BRIDGE || ATTRACTION)

typedef struct {
    vec near_gap, near_height; /* the first maximum not exceeded by any beyond it, and the next such maximum */
    vec far_gap, far_height;   /* heights include the work against attractions; -infinity if there is none */
#if DRIFTS
    vec near_work, far_work; /* the part of the heights that does not depend on the rotation */
#endif
    vec largest;               /* energy at initial contact */
    vec touch;                 /* capillary work at initial contact */
} barrier;

static const double NODES[6] = {
    0.125233408511468916, 0.367831498998180194, 0.587317954286617447,
    0.769902674194304687, 0.904117256370474857, 0.981560634246719251};
static const double WEIGHTS[6] = {
    0.249147045813402785, 0.233492536538354809, 0.203167426723065922,
    0.160078328543346226, 0.106939325995318431, 0.047175336386511827};

#if KINKS
static const double OF_FEW[6] = {
    0.5116108699897961, 0.45525978380314713, 0.3912332407867609,
    0.3311779941539137, 0.22992967190160998, 0.08078843936477209}; /* of every second node, on one side of the middle */

/* Integral over ln(gap); a panel in which two rules differ is halved, so that a kink or a jump ends one. */
static vec integral(
    const constants *c, const vec *y, vec low, vec high, vec (*integrand)(const constants *, const vec *, vec))
{
    vec whole = high - low, sum = splat(0.0), size = splat(0.0), place = splat(0.0), width = splat(0.125);
    mask on = place < 1.0;
    for (int count = 0; count < 4000 && bits(on); count++) { /* each lane has its own panels */
        vec half = 0.5*width, twelve = splat(0.0), six = splat(0.0), most = splat(0.0);
        for (int node = 0; node < 12; node++) {
            int which = node % 6;
            double at = node < 6 ? NODES[which] : -NODES[which];
            vec value = integrand(c, y, vec_exp(low + whole*(place + half*(1.0 + at))));
            most = vec_max(most, vec_abs(value));
            twelve += WEIGHTS[which]*value;
            if ((node < 6) == (which % 2 == 0))
                six += OF_FEW[which]*value;
        }
        vec apart = vec_abs(twelve - six)*half;
        mask done = on & ((apart <= 1e-6*most*width) | (apart <= 1e-13*(size + most*width)) | (width < 1e-10));
        sum += only(done, twelve*half);
        size += only(done, most*width);
        place += only(done, width);
        width = vec_min(choose(done, 2.0*width, 0.5*width), vec_min(splat(0.125), 1.0 - place));
        on = place < 1.0;
    }
    return sum*whole;
}
#endif /* KINKS */
#if !KINKS
/* Integral over ln(gap) by Gauss-Legendre panels; the integrand takes the gap. */
static vec integral(
    const constants *c, const vec *y, vec low, vec high, vec (*integrand)(const constants *, const vec *, vec))
{
    vec whole = high - low, panels; /* each lane has its own panels, so that results do not depend on neighbours */
    int most = 0;
    EACH_LANE(lane) {
        int own = 2 + (int)(2.0*fmax(0.0, fabs(LANE(whole, lane))));
        LANE(panels, lane) = own;
        most = own > most ? own : most;
    }
    vec half = whole*(0.5/panels), sum = splat(0.0);
    for (int panel = 0; panel < most; panel++)
        for (int node = 0; node < 12; node++) {
            double place = node < 6 ? NODES[node] : -NODES[node - 6];
            vec term = WEIGHTS[node % 6]*integrand(c, y, vec_exp(low + half*(2*panel + 1 + place)));
            sum += only(panel < panels, term);
        }
    return sum*half;
}
#endif

enum { AHEAD = 48 }; /* gaps ahead at which a margin is evaluated, denser at small distances */

#if defined(POTENTIAL)
enum { INNER = 6, OUTER = 12, HALVINGS = 8 }; /* grid points in the film and beyond, iterations for a maximum */

static vec slope_at(const constants *c, const vec *y, vec gap)
{
    vec there[STATES];
    memcpy(there, y, sizeof there);
    there[GAP] = gap;
    return potential_slope(c, there);
}

static vec energy_at(const constants *c, const vec *y, vec gap)
{
    vec there[STATES];
    memcpy(there, y, sizeof there);
    there[GAP] = gap;
    return potential_energy(c, there);
}

#if CAPILLARY_STATE
static inline vec slope_in_logarithm(const constants *c, const vec *y, vec gap)
{
    return slope_at(c, y, gap)*gap;
}

static vec height_at(const constants *c, const vec *y, vec gap)
{
    return energy_at(c, y, splat(1.0)) + integral(c, y, splat(0.0), vec_log(gap), slope_in_logarithm);
}
#else
static vec height_at(const constants *c, const vec *y, vec gap)
{
    vec height = energy_at(c, y, gap);
#if ATTRACTS
    height += capillary_work(c, gap) - capillary_work(c, splat(1.0));
#endif
    return height;
}
#endif

/* The zero of the slope between low and high, to a small fraction of the width of the maximum. */
static vec summit(const constants *c, const vec *y, vec low, vec high)
{
    vec at_low = slope_at(c, y, low), at_high = slope_at(c, y, high);
    for (int count = 0; count < HALVINGS; count++) {
        vec middle = low + (high - low)*(at_low/(at_low - at_high));
        middle = choose((middle > low) & (middle < high), middle, 0.5*(low + high));
        vec slope = slope_at(c, y, middle);
        mask rising = slope > 0.0;
        /* Illinois method: the value at an end kept twice is halved */
        at_high = choose(rising, 0.5*at_high, slope);
        at_low = choose(rising, slope, 0.5*at_low);
        low = choose(rising, middle, low);
        high = choose(rising, high, middle);
    }
    return 0.5*(low + high);
}

static void find_barriers(const constants *c, const vec *y, vec contact, vec end, barrier *b)
{
    vec none = splat(-HUGE_VAL);
    vec start = vec_min(vec_max(contact, splat(1e-6)), splat(0.5));
    vec ratio = vec_exp(vec_log(start)*(-1.0/(int)INNER)), width = (end - 1.0)*(1.0/(int)OUTER);
    vec low = start, slope = slope_at(c, y, start);
    vec lower[2] = {start, start}, upper[2] = {start, start};
    mask first = splat_mask(0), second = splat_mask(0);
    for (int k = 1; k <= INNER + OUTER; k++) {
        vec high = k < INNER ? low*ratio : k == INNER ? splat(1.0) : k < INNER + OUTER ? low + width : end;
        vec next = slope_at(c, y, high);
        mask top = (slope > 0.0) & (next <= 0.0);
        mask own = top & NOT(first);
        lower[0] = choose(own, low, lower[0]);
        upper[0] = choose(own, high, upper[0]);
        mask other = top & first; /* the last one b is kept */
        lower[1] = choose(other, low, lower[1]);
        upper[1] = choose(other, high, upper[1]);
        first |= top;
        second |= other;
        low = high;
        slope = next;
    }
    mask rim = slope > 0.0;
    b->near_gap = b->far_gap = splat(0.0);
    b->near_height = b->far_height = none;
    if (bits(first)) {
        b->near_gap = summit(c, y, lower[0], upper[0]);
        b->near_height = choose(first, height_at(c, y, vec_max(b->near_gap, start)), none);
    }
    if (bits(second)) {
        vec gap = summit(c, y, lower[1], upper[1]);
        b->far_gap = gap;
        b->far_height = choose(second, height_at(c, y, vec_max(gap, start)), none);
    }
    if (bits(rim)) { /* the rim is the outermost: it replaces the second maximum unless that is higher */
        vec height = choose(rim, height_at(c, y, end), none);
        mask higher = height > b->far_height;
        b->far_gap = choose(higher, end, b->far_gap);
        b->far_height = choose(higher, height, b->far_height);
    }
    mask hidden = NOT(b->near_height > b->far_height);
    b->near_gap = choose(hidden, b->far_gap, b->near_gap);
    b->near_height = choose(hidden, b->far_height, b->near_height);
#if DRIFTS
    b->near_work = b->near_height - energy_at(c, y, b->near_gap);
    b->far_work = b->far_height - energy_at(c, y, b->far_gap);
#endif
}

#if !DRIFTS
/* The height of the barrier ahead of a gap; -infinity if there is none. */
static inline vec height_ahead(const vec *y, const barrier *b)
{
    vec none = splat(-HUGE_VAL), gap = y[GAP];
    return choose(b->near_gap > gap, b->near_height, choose(b->far_gap > gap, b->far_height, none));
}
#endif

/* The work done against attractions since initial contact. */
static inline vec work_done(const constants *c, const vec *y, const barrier *b)
{
#if CAPILLARY_STATE
    (void)c;
    (void)b;
    return y[CAPILLARY_WORK];
#elif ATTRACTS
    return capillary_work(c, y[GAP]) - b->touch;
#else
    (void)c;
    (void)y;
    (void)b;
    return splat(0.0);
#endif
}

#if DRIFTS && ATTRACTS
/* The orbital momentum of rigid rotation at a gap. */
static inline vec rigid_at(const constants *c, const vec *y, vec gap)
{
    vec there[STATES];
    memcpy(there, y, sizeof there);
    there[GAP] = gap;
    return rigid_momentum(c, there);
}

/* Lanes whose energy is below the height of a gap ahead, lowered by the largest possible effect of the drift of angular
 * momentum. Decides a stick, but is no certificate.
 */
static inline mask below(const constants *c, const vec *y, const barrier *b, vec gap, vec work, mask rests, double tolerance)
{
    vec one[STATES], rigid = rigid_momentum(c, y), reach = choose(rests, y[GAP], gap);
    vec risen = vec_abs(rigid_at(c, y, gap) - rigid_at(c, y, splat(0.0)));
    vec deviation = vec_abs(y[ORBITAL_MOMENTUM] - rigid);
#if FRICTION /* impulses that reverse the slip again and again */
    deviation *= (1.0 + c->contact_tangential_restitution)/(1.0 - c->contact_tangential_restitution);
#endif
    vec change = deviation + only(NOT(rests), risen);
    memset(one, 0, sizeof one);
    one[GAP] = reach;
    vec lost = change*vec_abs(momentum_share(c, one));
    one[GAP] = y[GAP];
    one[ORBITAL_MOMENTUM] = splat(1.0);
    vec drift = 4.0*stored_energy(c, one)*vec_larger(vec_abs(y[ORBITAL_MOMENTUM]), vec_abs(rigid))*lost;
    vec height = work + energy_at(c, y, gap), energy = stored_energy(c, y) + work_done(c, y, b);
    return (gap > y[GAP]) & is_below_barrier(energy, height, SAFETY*tolerance, b->largest, drift);
}

static inline mask below_barrier(const constants *c, const vec *y, const barrier *b, mask rests, double tolerance)
{
    return below(c, y, b, b->near_gap, b->near_work, rests, tolerance)
           | below(c, y, b, b->far_gap, b->far_work, rests, tolerance);
}
#elif !DRIFTS
/* Lanes whose mechanical energy is below the barrier ahead by more than its error. */
static inline mask below_barrier(const constants *c, const vec *y, const barrier *b, mask rests, double tolerance)
{
    vec energy = stored_energy(c, y) + work_done(c, y, b); /* the height is NaN without a barrier */
    (void)rests;
    return is_below_barrier(energy, height_ahead(y, b), SAFETY*tolerance, b->largest, splat(0.0));
}
#endif
#endif
