/* How near a trajectory comes to a boundary between outcomes, where derivatives jump or diverge: the measures of
 * solvers/sensitivity/boundary_distance.py, on the series of each step.
 *
 * `along_near` keeps the smallest measure of the trajectory with the boundary that it belongs to. Some measures are
 * relative distances; those of boundaries before TIE in the enumeration are not (a passage is a squared speed), and say
 * only that the distance has to be computed (`hint`). A near miss of the glass criterion is not measured where a bound
 * shows that it exceeds FARTHEST_GRAZE.
 */
#pragma once

#include "certificates.h"
#include "criteria.h"
#include "events.h"
#include "model.h"
#include "state.h"
#include "tangents.h"

#if GRADIENTS
static const double FARTHEST_GRAZE = 1e-2; /* relative clearance of the glass criterion */
enum { PLACES = 8 };

/* The least relative clearance of the glass criterion within a step: the lowest of some samples, refined by Newton's
 * iteration to the minimum.
 */
OUTLINE vec least_pressure_margin(const fixed *f, const series *s, vec h)
{
    const vec (*a)[TERMS] = (const vec (*)[TERMS])s;
    const vec *clearance = s->glass.result;
    vec slope[TERMS], bend[TERMS], lowest = splat(HUGE_VAL), place = splat(0.0);
    slope[ORDER] = bend[ORDER] = splat(0.0);
    for (int k = 0; k < ORDER; k++)
        slope[k] = (k + 1.0)*clearance[k + 1];
    for (int k = 0; k < ORDER; k++)
        bend[k] = (k + 1.0)*slope[k + 1];
    for (int k = 0; k <= PLACES; k++) {
        vec t = h*((double)k/PLACES), here = sum_at(clearance, t);
        mask lower = here < lowest;
        lowest = choose(lower, here, lowest);
        place = choose(lower, t, place);
    }
    for (int count = 0; count < 4; count++) {
        vec step = sum_at(slope, place)/sum_at(bend, place);
        vec next = place - step;
        mask lower = (next > 0.0) & (next < h);
        next = choose(lower, next, place);
        lower &= sum_at(clearance, next) <= sum_at(clearance, place);
        place = choose(lower, next, place);
    }
    vec y[STATES];
    states_at(a, place, y);
    return pressure_margin(&f->c, y);
}

/* How far the pressure would exceed its limit without the rebound, to second order, over the limit. */
static double flatness(const fixed *f, const series *s, const vec *at, double h, int lane)
{
    double slope = 0.0, bend = 0.0;
    vec still[STATES];
    for (int k = ORDER; k > 0; k--)
        slope = slope*h + k*LANE(s->glass.result[k], lane);
    for (int k = ORDER; k > 1; k--)
        bend = bend*h + (double)k*(k - 1)*LANE(s->glass.result[k], lane);
    memcpy(still, at, sizeof still);
    still[NORMAL_VELOCITY] = splat(0.0);
    return bend > 0.0 ? slope*slope/(2.0*bend*in_lane(glass_clearance(&f->c, still), lane)) : HUGE_VAL;
}

#if PROOF_BY_ENERGY
/* Squared relative distance of a turning point from the nearest saddle; `saddle` is 0 if no barrier but the rim exists. */
static double near_saddle(const fixed *f, double gap, int lane, int *saddle)
{
    double gaps[2] = {LANE(f->b.near_gap, lane), LANE(f->b.far_gap, lane)};
    double heights[2] = {LANE(f->b.near_height, lane), LANE(f->b.far_height, lane)};
    double least = HUGE_VAL;
    *saddle = 0;
    for (int k = 0; k < 2; k++)
        if (heights[k] > -HUGE_VAL && gaps[k] < LANE(f->end, lane)*(1.0 - 1e-12)) {
            double off = gap/gaps[k] - 1.0;
            *saddle = 1;
            least = fmin(least, off*off);
        }
    return least;
}

/* The least squared normal velocity within a step. */
static double slowest(const series *s, double h, int lane)
{
    double low = 0.0, high = h, sign = LANE(s->normal_velocity[1], lane) < 0.0 ? -1.0 : 1.0;
    for (int count = 0; count < 40; count++) {
        double t = 0.5*(low + high);
        if (in_lane(rate_at(s->normal_velocity, splat(t)), lane)*sign > 0.0)
            low = t;
        else
            high = t;
    }
    double speed = in_lane(sum_at(s->normal_velocity, splat(0.5*(low + high))), lane);
    return speed*speed;
}
#endif

/* Measures of an event in a lane, at a time `h` after the beginning of the step (0: met at the start of a phase). */
static void measure_event(carried *a, const lanes *l, const fixed *f, const series *s, const vec *at, double h,
    int event, int lane)
{
    double gap = LANE(at[GAP], lane), normal_velocity = LANE(at[NORMAL_VELOCITY], lane), contact = LANE(f->contact, lane);
    int closing = LANE(l->closing, lane) != 0;
    if (event == AT_GLASS && h == 0.0)
        along_near(a, lane, fabs(log(1.0 - in_lane(pressure_margin(&f->c, at), lane))), TOUCH);
    else if (event == AT_GLASS)
        along_near(a, lane, flatness(f, s, at, h, lane), GLASS_GRAZE);
    if (contact > 0.0 && (event == AT_GLASS || (event == AT_TURNING && closing)))
        along_near(a, lane, fabs(log(gap/contact)), CONTACT_GRAZE);
    if (event == AT_CONTACT) {
        double slowing = LANE(s->normal_velocity[1], lane);
        for (int k = 2; k <= ORDER; k++)
            slowing += k*LANE(s->normal_velocity[k], lane)*pow(h, k - 1);
        double smaller = second_gap(&f->c, lane);
        if (slowing > 0.0)
            along_near(a, lane, normal_velocity*normal_velocity/(2.0*slowing*contact), CONTACT_GRAZE);
        if (smaller > 0.0)
            along_near(a, lane, log(contact/smaller), TIE);
    }
#if PROOF_BY_ENERGY
    int saddle;
    double off = near_saddle(f, gap, lane, &saddle);
    if (event == AT_TURNING && saddle)
        along_near(a, lane, off, PASSAGE);
#endif
    if (event == AT_RUPTURE && (BRIDGE || STRINGS || ATTRACTION))
        along_near(a, lane, normal_velocity*normal_velocity, RIM);
    else if (event == AT_RUPTURE && (!OBLIQUE || WALL))
        along_near(a, lane, normal_velocity, RIM);
#if OBLIQUE && STRINGS
    if (event == AT_RUPTURE) {
        double first = 4.0 + LANE(f->c.aspect, lane);
        along_near(a, lane, 1.0 - LANE(at[ROTATION], lane)/PI, HALF_TURNED);
        along_near(a, lane, LANE(at[ORBITAL_MOMENTUM], lane)/(first*first), UNWOUND);
    }
#endif
}

/* Measures of a step, and of the event that ends it in the lanes of `ends`. */
static void measure(lanes *l, const fixed *f, const series *s, vec h, mask ends, mask event)
{
    const vec (*a)[TERMS] = (const vec (*)[TERMS])s;
    carried *along = &l->along;
    mask moves = l->alive & NOT(l->resting);
    mask close = moves & l->closing & NOT(ends & (event == AT_GLASS));
    if (bits(close)) /* what still falls is the next step's: on the way to the criterion it is no near miss */
        close &= ends | (rate_at(s->glass.result, h) > 0.0);
    if (bits(close)) { /* the clearance without motion decreases as the gap closes: its least is at an end of the step */
        vec start[STATES];
        memcpy(start, l->y, sizeof start);
        start[NORMAL_VELOCITY] = splat(0.0);
        close &= NOT(least_of(s->glass.result, h) > FARTHEST_GRAZE*glass_clearance(&f->c, start));
    }
    if (bits(close)) {
        vec end[STATES];
        states_at(a, h, end);
        end[NORMAL_VELOCITY] = splat(0.0);
        close &= NOT(least_of(s->glass.result, h) > FARTHEST_GRAZE*glass_clearance(&f->c, end));
    }
    if (bits(close)) {
        vec least = vec_abs(vec_log(1.0 - least_pressure_margin(f, s, h)));
        EACH_OF(lane, bits(close))
            along_near(along, lane, LANE(least, lane), GLASS_GRAZE);
    }
#if PROOF_BY_ENERGY
    mask dips = moves & (choose(l->closing, -s->normal_velocity[1], s->normal_velocity[1]) < 0.0) & (vec_abs(s->normal_velocity[0]) < 0.3);
    if (bits(dips)) {
        vec rate = rate_at(s->normal_velocity, h);
        dips &= choose(l->closing, -rate, rate) > 0.0; /* the speed decreases first and increases last */
    }
    EACH_OF(lane, bits(dips)) {
        int saddle;
        near_saddle(f, 1.0, lane, &saddle);
        if (saddle)
            along_near(along, lane, slowest(s, LANE(h, lane), lane), PASSAGE);
    }
#endif
    ends &= (event == AT_GLASS) | (event == AT_CONTACT) | (event == AT_TURNING) | (event == AT_RUPTURE);
    if (!bits(ends))
        return;
    vec at[STATES];
    states_at(a, h, at);
    EACH_OF(lane, bits(ends))
        measure_event(along, l, f, s, at, LANE(h, lane), (int)LANE(event, lane), lane);
}
#endif
