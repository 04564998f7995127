/* How a pair answers along a line of centres that is held for a step of the host, in SI, by the kernel with vectors. */
#pragma once

#include "criteria.h"
#include "guards.h"
#include "in_si.h"
#include "integrate.h"

enum { PLACES = 4 }; /* of Gauss's quadrature: 2e-6 of the mean of 1/x between gaps of ratio 2, 1e-9 of ratio 1.3 */

/* Of one material and one speed of impact, by which elastic length and units go. */
typedef struct {
    constants c;
    double film, speed, force, torque; /* units of gap, velocity and force, and of torque over slip */
    double contact, end;               /* gaps at which solids meet and the pair separates, m */
    vec edge;                          /* of the tangential force, in film thicknesses */
    double friction, returns;          /* of the dry contact: Coulomb's coefficient, and its tangential restitution */
    int rubs_glass;
} held;

/* Means between two gaps: film force over velocity, attractions, and torques over slips. */
typedef struct {
    double resistance, attraction, own, mutual, partner;
} response;

static void hold(held *h, const law_material *m, double speed)
{
    static const double none = 0.0;
    buffer columns[QUANTITIES];
    vec given[QUANTITIES];
    for (int k = 0; k < QUANTITIES; k++)
        columns[k].at = (void *)(uintptr_t)&none; /* nothing turns or spins: no unit follows from it */
    set_material(columns, m);
    columns[SI_SPEED].at = &speed;
    load(given, columns, 0, 1);
    scale(&h->c, given);
    prepare(&h->c);
    h->film = m->film_thickness;
    h->speed = speed;
    h->force = m->reduced_mass*speed*speed/h->film;
    h->torque = m->reduced_mass*m->reduced_radius*m->reduced_radius*speed/h->film;
    h->contact = h->film*in_lane(contact_gap(&h->c), 0);
#if BRIDGE
    h->end = h->film*LANE(h->c.rupture_gap, 0);
#else
    h->end = h->film;
#endif
    h->edge = tangential_edge(&h->c);
    h->friction = h->returns = 0.0;
    h->rubs_glass = 0;
#if FRICTION
    h->friction = m->friction;
    h->returns = m->contact_tangential_restitution;
    h->rubs_glass = FRICTION_ON_GLASS;
#endif
}

static response mean_response(const held *h, double from, double to, double velocity)
{
    static const double place[PLACES] = {
        0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
    static const double weight[PLACES] = {
        0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
    double sums[RESPONSES] = {0.0};
    response made;
    vec y[STATES], found[RESPONSES];
    memset(y, 0, sizeof y);
    y[NORMAL_VELOCITY] = splat(velocity/h->speed);
    for (int first = 0; first < PLACES; first += LANES) {
        vec film = splat(1.0);
        EACH_LANE(lane) {
            int k = first + lane < PLACES ? first + lane : 0;
            LANE(y[GAP], lane) = (from + (to - from)*place[k])/h->film;
        }
#if !SPREAD
        film = only(y[GAP] < 1.0, film);
#endif
#if defined(FILM_CAVITATES)
        film = velocity > 0.0 ? splat(0.0) : film;
#endif
        held_response(&h->c, y, film, only(y[GAP] < h->edge, splat(1.0)), found);
        for (int lane = 0; lane < LANES && first + lane < PLACES; lane++)
            for (int k = 0; k < RESPONSES; k++)
                sums[k] += weight[first + lane]*LANE(found[k], lane);
    }
    made.resistance = h->force/h->speed*sums[HELD_RESISTANCE];
    made.attraction = h->force*sums[HELD_ATTRACTION];
    made.own = h->torque*sums[HELD_TORQUE_OWN];
    made.mutual = h->torque*sums[HELD_TORQUE_MUTUAL];
    made.partner = h->torque*sums[HELD_TORQUE_PARTNER];
    return made;
}

/* Positive before the glass criterion is met. */
static double glass_clears(const held *h, double gap, double velocity)
{
    vec y[STATES];
    memset(y, 0, sizeof y);
    y[GAP] = splat(gap/h->film);
    y[NORMAL_VELOCITY] = splat(velocity/h->speed);
    return in_lane(glass_clearance(&h->c, y), 0);
}

/* The velocity after a rebound. */
static double rebounds_with(const held *h, double velocity)
{
    vec y[STATES], after[STATES];
    memset(y, 0, sizeof y);
    y[NORMAL_VELOCITY] = splat(velocity/h->speed);
    rebound(&h->c, y, after);
    return h->speed*LANE(after[NORMAL_VELOCITY], 0);
}

/* The criterion that is met at the gap where solids meet. */
static int solid_kind(const held *h)
{
    return contact_kind(&h->c, 0);
}
