/* The certificates of a model (derive/equations/certificates/), and the lanes in which they hold. */
#pragma once

#include "automaton.h"
#include "criteria.h"
#include "energy_barrier.h"
#include "own_events.h"
#include "proofs.h"

#define TURNS (OBLIQUE && !WALL)
#define PROOF_BY_ENERGY (TURNS ? ATTRACTS && !STRINGS : ATTRACTS || STRINGS)
#if TURNS || STRINGS || BRIDGE || (ATTRACTION && CAPILLARY_STATE)
#define PROOF_BY_FILM 0
#else
#define PROOF_BY_FILM FILM_MOMENTUM
#endif

#if OWN_EVENTS
#undef PROOF_BY_ENERGY
#define PROOF_BY_ENERGY 0 /* its barriers are those of the start; held_beside_events instead */
#if !OWN_PROOFS || ATTRACTION
#undef PROOF_BY_FILM
#define PROOF_BY_FILM 0
#endif
#endif /* OWN_EVENTS */
#if OWN_TERMS
/* The energy decides where the terms store or take it and L is conserved; the film alone, where they only take. */
#undef PROOF_BY_ENERGY
#define PROOF_BY_ENERGY (OWN_TERMS_BARRIER && !DRIFTS && (ATTRACTS || STRINGS || OWN_TERMS_STORE))
#if !OWN_TERMS_BARRIER || OWN_TERMS_STORE || OWN_TERMS_ADD_INERTIA
#undef PROOF_BY_FILM
#define PROOF_BY_FILM 0
#endif
#endif /* OWN_TERMS */
/* Lanes in which a force other than that of the dry contact drives the rotation at rest. */
#define DRIVEN(shear) (STRINGS ? splat_mask(TRUTH) : (shear) != 0.0)
#if OWN_TERMS
#undef DRIVEN
#define DRIVEN(shear) (STRINGS || OWN_TERMS_ROTATE ? splat_mask(TRUTH) : (shear) != 0.0)
#endif /* OWN_TERMS */
#if PROOF_BY_FILM
#if ATTRACTION
enum { DEPTHS = ATTRACTED_FILM_DEPTHS };
#else
enum { DEPTHS = FILM_DEPTHS };
#endif

/* Loss of normal velocity in the film between two gaps. */
#if defined(FILM_RESISTANCE_WORK)
static inline vec film_takes(const constants *c, vec low, vec high)
{
    return film_momentum(c, high) - film_momentum(c, low);
}
#else
static inline vec slowing_in_logarithm(const constants *c, const vec *y, vec gap)
{
    (void)y;
    return film_slowing(c, gap)*gap;
}

static vec film_takes(const constants *c, vec low, vec high)
{
    return integral(c, NULL, vec_log(low), vec_log(high), slowing_in_logarithm);
}
#endif

/* Ratio of successive gaps in a geometric sequence from `start` to contact. */
static inline vec ratio_of_depths(vec start, vec contact)
{
    return vec_exp(vec_log(vec_max(contact, start*LEAST_DEPTH)/start)*(1.0/(double)DEPTHS));
}

#if !ATTRACTION
/* Film certificate without attraction: the normal velocity at every gap follows from the film's momentum integral.
 *
 * While closing, the film stops the motion at a gap before which the glass criterion is not met; while opening, before
 * the gap x0. As the gap decreases, the speed falls and the pressure per speed rises, so the speed before a step and
 * the gap after it bound the pressure in between.
 */
static mask stopped_by_film(const constants *c, const vec *y, vec contact, mask closing, double tolerance)
{
    double margin = SAFETY*tolerance;
    vec gap = y[GAP], speed = -y[NORMAL_VELOCITY], ratio = ratio_of_depths(gap, contact), there[STATES];
    memcpy(there, y, sizeof there);
#if defined(FILM_CAVITATES)
    mask stopped = splat_mask(0);
#else
    mask stopped = NOT(closing) & is_stopped(y[NORMAL_VELOCITY] - film_takes(c, gap, splat(1.0)), splat(margin));
#endif
    mask clear = closing;
    for (int k = 0; k < DEPTHS; k++) {
        there[NORMAL_VELOCITY] = -speed*(1.0/(1.0 - margin));
        speed -= film_takes(c, there[GAP]*ratio, there[GAP]);
        there[GAP] *= ratio;
        clear &= glass_clearance(c, there) > 0.0;
        stopped |= clear & is_stopped(speed, splat(margin));
    }
    return stopped;
}
#else
/* Film certificate with an attraction, without a bridge, for motion along the line of centres.
 *
 * If the approach velocity with the film only is w, it is at most w + g with the attraction, where g^2/2 is the work
 * of the attraction from x0 on.
 */
static mask stopped_by_film(const constants *c, const vec *y, vec contact, mask closing, double tolerance)
{
    double margin = SAFETY*tolerance;
#if defined(FILM_CAVITATES)
    mask held = splat_mask(0);
#else
    mask held = NOT(closing) & is_stopped(y[NORMAL_VELOCITY] - film_takes(c, y[GAP], splat(1.0)), splat(margin));
#endif
    vec start = choose(closing, y[GAP], splat(1.0)); /* an opening doublet may reach x0 before it falls back */
    vec speed = only(closing, -y[NORMAL_VELOCITY]), ratio = ratio_of_depths(start, contact), there[STATES];
    vec surface = capillary_work(c, splat(1.0));
    mask clear = splat_mask(TRUTH);
    memcpy(there, y, sizeof there);
    there[GAP] = start;
    for (int k = 0; k < DEPTHS; k++) {
        vec next = there[GAP]*ratio, fastest = vec_max(speed, splat(0.0));
        speed -= only(closing, film_takes(c, next, there[GAP]));
        there[GAP] = next;
        there[NORMAL_VELOCITY] = -(fastest + vec_sqrt(2.0*(surface - capillary_work(c, next))))*(1.0/(1.0 - margin));
        clear &= glass_clearance(c, there) > 0.0;
    }
    return clear & (held | (closing & is_stopped(speed, splat(margin))));
}
#endif
#endif

#if PENDULUM_MARGINS
/* Lanes in which all forces but that of the film point inward. */
static mask pulled_inward(const constants *c, const vec *y, double margin)
{
    vec outward, pull;
    pendulum_inward(c, y, &outward, &pull);
    return points_inward(outward, pull, margin);
}

/* The error of the margins, and what the rotation may still drive outward. */
static vec pendulum_error(const constants *c, const vec *y, double margin)
{
    mask outward = NOT(pulled_inward(c, y, margin));
    vec error = margin*vec_larger(c->stokes, splat(1.0)), impulse;
    if (!bits(outward))
        return error;
    pendulum_impulse(c, y, &impulse);
    return error + only(outward, c->stokes*impulse);
}

/* Pendulum certificate (derive/equations/certificates/pendulum.py): the film stops the doublet, and every rebound. At a
 * turn the impulse of the rotation is allowed for; elsewhere all other forces must point inward.
 */
static mask held_by_strings(const constants *c, const vec *y, mask candidates, int turn, double tolerance)
{
    double margin = SAFETY*tolerance;
    vec film, recoil;
    candidates &= turn ? vec_abs(y[NORMAL_VELOCITY]) <= STILL : pulled_inward(c, y, margin);
    if (!bits(candidates))
        return candidates;
    vec error = turn ? pendulum_error(c, y, margin) : margin*vec_larger(c->stokes, splat(1.0));
    pendulum_stops(c, y, &film, &recoil);
    return candidates & is_stopped(film, error) & is_stopped(recoil, error);
}

/* The next part of the film for bounds of the approach: a gap, and the largest speed there. */
static inline vec next_part(const constants *c, vec *bounds)
{
    vec deeper, slowed, fastest;
    approach_step(c, bounds, &deeper, &slowed, &fastest);
    bounds[GAP] = deeper;
    bounds[NORMAL_VELOCITY] = -slowed;
    return fastest;
}

/* Clearance of the glass criterion in the part of the film that ends here, for the largest speed in it. */
static inline mask clear_of_glass(const constants *c, const vec *bounds, vec fastest, double margin)
{
    vec there[STATES];
    memcpy(there, bounds, sizeof there);
    there[NORMAL_VELOCITY] = fastest*(-1.0/(1.0 - margin));
    return glass_clearance(c, there) > 0.0;
}

/* Lanes in which the film stops the doublet, and every rebound that a criterion may cause, for good. */
static mask held_on_approach(const constants *c, const vec *y, vec contact, double tolerance)
{
    double margin = SAFETY*tolerance;
    vec film, recoil, rebound, beneath, bounds[STATES], there[STATES];
    vec error = pendulum_error(c, y, margin);
    pendulum_stops(c, y, &film, &recoil);
    mask possible = (contact < y[GAP]) & is_stopped(film, error);
    memcpy(bounds, y, sizeof bounds);
    memcpy(there, y, sizeof there);
    for (int part = 0; part < APPROACH_PARTS && bits(possible); part++) {
        there[GAP] = bounds[GAP];
        there[NORMAL_VELOCITY] = -next_part(c, bounds);
        pendulum_rebounds(c, there, &rebound, &beneath);
        possible &= clear_of_glass(c, bounds, -there[NORMAL_VELOCITY], margin) | is_stopped(rebound, error);
    }
    pendulum_rebounds(c, bounds, &rebound, &beneath);
    return possible & is_stopped(beneath, error);
}
#endif

#if ATTRACTION_MARGINS
/* Attraction certificate: the margins of derive/equations/certificates/attraction.py exceed their error.
 *
 * Comparisons with NaN are false. The margins take the contact gap as the smallest gap; if initial contact lies below
 * it, the certificate does not apply.
 */
static mask held_by_attraction(const constants *c, const vec *y, double tolerance)
{
    vec hold, escape, rebound, energy = vec_larger(y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY], splat(1.0));
    attraction_margins(c, y, &hold, &escape, &rebound);
    return attraction_holds(y[GAP], contact_gap(c), SAFETY*tolerance, hold, rebound, escape, energy);
}
#endif

#if SPIN_DOWN_MARGINS
/* Spin-down certificate: without angular momentum the rotation dies out, and the film alone holds the doublet
 * (derive/equations/certificates/spin_down.py). Beyond the edge of the shear, where nothing turns without orbital
 * momentum, `rate` is not positive.
 */
static inline mask spun_down(const constants *c, const vec *y, mask candidates, double tolerance)
{
    candidates &= (c->first_momentum <= 0.0) | (y[ORBITAL_MOMENTUM] == 0.0);
    if (!bits(candidates))
        return candidates;
    vec stays, rate, apart, inside, momentum, error = SAFETY*tolerance*vec_larger(c->stokes, splat(1.0));
    spin_down_margins(c, y, &stays, &rate, &apart, &inside, &momentum);
    return candidates & spins_down(y[GAP], contact_gap(c), SAFETY*tolerance, momentum, rate, stays, error,
        y[ORBITAL_MOMENTUM], inside, apart);
}
#endif

/* Whether chatter is ended by a test at maxima of the gap (chatter.h). */
#if SPACE && ((BRIDGE && !defined(BRIDGE_FORCE_FALLS)) || (ATTRACTION && !defined(ATTRACTION_FORCE_FALLS)))
#define CHATTER_TESTS 0
#elif SPACE
#define CHATTER_TESTS ATTRACTS
#else
#define CHATTER_TESTS (TURNS && ATTRACTS && (ORBITAL_MARGINS || !STRINGS))
#endif
#if OWN_EVENTS
#undef CHATTER_TESTS
#define CHATTER_TESTS 0
#endif /* OWN_EVENTS */
#if OWN_TERMS
#undef CHATTER_TESTS
#define CHATTER_TESTS 0
#endif /* OWN_TERMS */
/* Whether the test of chatter is a proof. */
#define CHATTER_PROVES (SPACE || (ORBITAL_MARGINS && !STRINGS))

#define HELD_AT_REST (TURNS && ATTRACTS && !STRINGS)
#if OWN_TERMS
#undef HELD_AT_REST
#define HELD_AT_REST SPACE /* in a plane its bound is of the library's energy */
#endif /* OWN_TERMS */
#if HELD_AT_REST
#if SPACE
/* Resting contact that persists: the slip energy never grows, which bounds the orbital momentum for good. */
static mask held_at_rest(const constants *c, const vec *y, double tolerance)
{
    vec bound[2]; /* outward, inward */
    resting_bound(c, y, bound);
    return rests_for_good(bound[1] - bound[0], SAFETY*tolerance, bound[1]);
}
#else
/* Resting contact that persists while the slip decays: |J| exceeds that of rigid rotation by no more than the slip
 * energy allows, or by twice that where angular momentum drifts (derive/checks/partners.py).
 */
static mask held_at_rest(const constants *c, const vec *y, double tolerance)
{
    vec momentum = vec_abs(rigid_momentum(c, y)), there[STATES];
    memset(there, 0, sizeof there);
    there[GAP] = y[GAP];
#if OWN_EVENTS
    for (int which = 0; which < OWN_EVENTS; which++)
        there[OWN[which].mark] = y[OWN[which].mark];
#endif /* OWN_EVENTS */
#if REDUCED
    momentum = vec_larger(vec_abs(y[ORBITAL_MOMENTUM]), momentum);
#else
    there[ORBITAL_MOMENTUM] = splat(1.0);
    vec rigid[STATES], slip[STATES]; /* deviation from rigid rotation: no cancellation in its energy */
    memcpy(slip, there, sizeof slip);
    rigid_rotation(c, y, rigid);
    for (int state = ORBITAL_MOMENTUM; state < MODEL_STATES; state++)
        slip[state] = y[state] - rigid[state];
    momentum += (DRIFTS ? 2.0 : 1.0)*vec_sqrt(stored_energy(c, slip)/stored_energy(c, there));
#endif
    there[ORBITAL_MOMENTUM] = splat(0.0);
    vec still = inward_force(c, there);
    there[ORBITAL_MOMENTUM] = momentum;
    return rests_for_good(inward_force(c, there), SAFETY*tolerance, still);
}
#endif
#endif

/* Lanes in which one of the certificates that are tested at every step excludes separation. */
static inline mask proved_sticks(
    const constants *c, const vec *y, const barrier *b, vec contact, mask closing, mask resting, double tolerance)
{
    mask proved = splat_mask(0);
    (void)c; (void)y; (void)b; (void)contact; (void)closing; (void)resting; (void)tolerance;
#if PROOF_BY_ENERGY
    proved |= below_barrier(c, y, b, resting, tolerance);
#endif
#if HELD_AT_REST
    if (bits(resting))
        proved |= resting & held_at_rest(c, y, tolerance);
#endif
#if PROOF_BY_FILM
    proved |= NOT(resting) & stopped_by_film(c, y, contact, closing, tolerance);
#endif
#if PENDULUM_MARGINS
    proved |= held_by_strings(c, y, splat_mask(TRUTH), 0, tolerance);
#endif
#if OWN_EVENTS
#if OWN_PROOFS
    if (bits(proved & NOT(resting))) /* the film stops a closing doublet before it opens */
        proved &= resting | own_events_excluded(c, y, whole_energy(c, y)*(1.0 + SAFETY*tolerance), NOT(closing), 2);
#else
    proved &= resting;
#endif
#endif /* OWN_EVENTS */
    return proved;
}

#if SPACE && PROOF_BY_ENERGY
/* Lanes whose doublet tumbles as one body, and is held even if all of its angular momentum turns across the line of
 * centres (derive/checks/space.py). Decides a stick, but is no certificate.
 */
static mask tumbles(const constants *c, const vec *y, const barrier *b, double tolerance)
{
    vec rest = wobble(c, y), rigid = potential_energy(c, y), height = height_ahead(y, b);
    return tumbles_for_good(rest, rigid, work_done(c, y, b), height, SAFETY*tolerance, b->largest);
}
#endif

/* Lanes in which the certificates of `held_sticks` are tested: at the start of a phase and after each INTERVAL of steps.
 * Where an energy certificate decides most sticks before, only from the fourth phase on.
 */
enum { EARLIEST_PHASE = PROOF_BY_ENERGY ? 4 : 1, INTERVAL = PROOF_BY_ENERGY ? 64 : 16 };

static inline mask now_and_then(mask fresh, mask phases, mask steps)
{
    return (fresh & (phases >= splat_mask(EARLIEST_PHASE))) | ((steps & (INTERVAL - 1)) == INTERVAL - 1);
}

/* Lanes in which one of the certificates that are tested at intervals excludes separation. */
static inline mask held_sticks(const constants *c, const vec *y, mask candidates, double tolerance)
{
    (void)c; (void)y; (void)candidates; (void)tolerance;
#if OWN_EVENTS
#if OWN_PROOFS
    return bits(candidates) ? held_beside_events(c, y, candidates, tolerance) : candidates;
#else
    return splat_mask(0);
#endif
#endif /* OWN_EVENTS */
#if SPIN_DOWN_MARGINS
    return spun_down(c, y, candidates, tolerance);
#endif
#if PENDULUM_MARGINS
    return held_by_strings(c, y, candidates, 1, tolerance);
#endif
#if ATTRACTION_MARGINS
    if (bits(candidates))
        return candidates & held_by_attraction(c, y, tolerance);
#endif
    return splat_mask(0);
}
