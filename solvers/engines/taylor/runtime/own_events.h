/* Declared events of a user's model: which can still happen, and the energy certificate beside them.
 *
 * Only kernels of models that declare events contain this file and the blocks `#if OWN_EVENTS` (build.py). An event happens
 * once; its mark, a state, is 1 before and 0 after it.
 */
#pragma once

#include "automaton.h"
#include "criteria.h"
#include "energy_barrier.h"
#include "model.h"

#if OWN_EVENTS
/* Lanes in which a declared event may still happen, in this direction or at rest, and in this part of the film. */
static inline mask own_watched(const vec *y, int which, mask closing, mask resting, vec film)
{
    int motion = OWN[which].motion, part = OWN[which].film;
    mask wanted = y[OWN[which].mark] > 0.5;
    if (motion)
        wanted &= NOT(resting) & (motion < 0 ? closing : NOT(closing));
    if (part >= 0)
        wanted &= film == (double)part;
    return wanted;
}

/* Lanes at rest that no declared event sets free: each has happened, does no harm, or has a guard that stays positive. */
static mask rests_beside_events(const constants *c, const vec *y, vec film)
{
    vec guard[OWN_EVENTS];
    mask rests = splat_mask(TRUTH), stays = rests;
    own_least(c, y, guard); /* the guard where no time is in it */
    for (int which = 0; which < OWN_EVENTS; which++)
        if (!OWN[which].harmless) {
            mask comes = own_watched(y, which, NOT(rests), rests, film);
            stays &= NOT(OWN[which].varies & ~BY_TIME ? comes : comes & NOT(guard[which] > 0.0));
        }
    return stays;
}

/* Lanes in which no declared event lies between two states, as far as shows: each guard keeps half its value. */
static mask own_guards_kept(const constants *c, const vec *from, const vec *to, mask closing, mask resting, vec film)
{
    vec before[OWN_EVENTS], after[OWN_EVENTS];
    mask kept = splat_mask(TRUTH);
    own_guards(c, from, before);
    own_guards(c, to, after);
    for (int which = 0; which < OWN_EVENTS; which++)
        kept &= NOT(own_watched(from, which, closing, resting, film)) | (2.0*after[which] > before[which]);
    return kept;
}

#if defined(POTENTIAL) && !OWN_TERMS && (!DRIFTS || WALL || !OBLIQUE)
#define OWN_PROOFS 1
enum { OWN_PARTS = 24 }; /* of the film, and as many beyond it, within which the potential is bounded by its parts at their ends */

static inline vec gap_of_part(vec start, vec end, int k)
{
    double part = (double)(k < OWN_PARTS ? k : k - OWN_PARTS)/(int)OWN_PARTS;
    return k < OWN_PARTS ? start*vec_exp(vec_log(start)*-part) : vec_exp(vec_log(end)*part);
}

/* The rise of the effective potential from one gap to the next. */
static inline vec risen(const constants *c, const vec *y, vec low, vec high)
{
#if CAPILLARY_STATE
    return integral(c, y, vec_log(low), vec_log(high), slope_in_logarithm);
#else
    return height_at(c, y, high) - height_at(c, y, low);
#endif
}

/* Kinetic energy and potential of the attractions, as heights are counted. */
static inline vec whole_energy(const constants *c, const vec *y)
{
    return stored_energy(c, y) + height_at(c, y, y[GAP]) - energy_at(c, y, y[GAP]);
}

/* Lanes in which this energy does not suffice for any declared event that has not happened, but for those as harmless.
 *
 * At a gap the speed is at most that of the energy above the height there; the guard is positive in the worst corner of every
 * part of the gap and of the speeds there, by the signs of its slopes.
 */
static mask own_events_excluded(const constants *c, const vec *y, vec energy, mask opens, int harmless)
{
    vec end = splat(1.0);
#if BRIDGE
    end = c->rupture_gap;
#endif
    vec contact = contact_gap(c), start = vec_min(vec_max(contact, splat(1e-6)), splat(0.5));
    vec there[STATES], guard[OWN_EVENTS], last = start, height = height_at(c, y, start);
    vec rotating = energy_at(c, y, start), attracted = height - rotating;
    mask excluded = splat_mask(TRUTH);
    for (int which = 0; which < OWN_EVENTS; which++) {
        if (OWN[which].harmless >= harmless)
            continue;
        mask over = y[OWN[which].mark] < 0.5;
        if (OWN[which].motion > 0)
            over |= NOT(opens);
        if (!OWN[which].known)
            excluded &= over;
        else if (OWN[which].film != 0) /* below the least gap of the parts nothing is shown */
            excluded &= over | (contact >= start);
    }
    memcpy(there, y, sizeof there);
    for (int k = 1; k <= 2*OWN_PARTS && bits(excluded); k++) {
        vec next = gap_of_part(start, end, k), above = height + risen(c, y, last, next);
        /* rotation falls and attraction rises: their sum may have a minimum in between, attraction alone where its force may rise */
        vec turning = energy_at(c, y, next), pulled = above - turning;
        vec least = vec_min(rotating, turning) + vec_min(attracted, pulled);
#if (BRIDGE && !defined(BRIDGE_FORCE_FALLS)) || (ATTRACTION && !defined(ATTRACTION_FORCE_FALLS))
        least -= vec_abs(pulled - attracted);
#endif
        mask reached = energy > least;
        vec speed = vec_sqrt(2.0*vec_max(energy - least, splat(0.0)));
        for (int which = 0; which < OWN_EVENTS; which++) {
            int known = OWN[which].known && OWN[which].harmless < harmless;
            if (!known || OWN[which].film == (k <= OWN_PARTS ? 0 : 1))
                continue;
            there[GAP] = OWN[which].by_gap > 0 ? last : next;
            for (int way = -1; way <= 1; way += 2) {
                if (OWN[which].motion && OWN[which].motion != way)
                    continue;
                int by_speed = way > 0 ? OWN[which].opening : OWN[which].closing;
                there[NORMAL_VELOCITY] = by_speed > 0 ? splat(0.0) : way*speed;
                own_guards(c, there, guard);
                mask over = y[OWN[which].mark] < 0.5;
                if (way > 0)
                    over |= NOT(opens);
                excluded &= over | NOT(reached) | (guard[which] > 0.0);
            }
        }
        last = next;
        height = above;
        rotating = turning;
        attracted = pulled;
    }
    return excluded;
}

/* Energy certificate for the forces that act since the last declared event, where no other can happen. */
static mask held_beside_events(const constants *c, const vec *y, mask candidates, double tolerance)
{
#if ATTRACTS || STRINGS
    barrier b;
    vec first[STATES], end = splat(1.0);
#if BRIDGE
    end = c->rupture_gap;
#endif
    memset(&b, 0, sizeof b);
    memset(first, 0, sizeof first);
    start(c, first);
    find_barriers(c, y, contact_gap(c), end, &b);
#if DRIFTS
    return splat_mask(0);
#else
    vec height = height_ahead(y, &b), energy = whole_energy(c, y);
    vec margin = SAFETY*tolerance*(vec_max(stored_energy(c, first), vec_abs(energy)) + vec_abs(height));
    candidates &= energy < height - margin;
    if (bits(candidates))
        candidates &= own_events_excluded(c, y, energy + margin, splat_mask(TRUTH), 1);
    return candidates;
#endif
#else
    (void)c; (void)y; (void)candidates; (void)tolerance;
    return splat_mask(0);
#endif
}
#else
#define OWN_PROOFS 0
#endif
#endif /* OWN_EVENTS */
