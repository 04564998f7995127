/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 9c0c0ffb27a17979f3562663046278677d18eb4d8b7c0d9476875130197ccc53 */

enum { GAP, NORMAL_VELOCITY, ORBITAL_MOMENTUM, SPIN, STATES };
enum { OBLIQUE = 1, BRIDGE = 1, ATTRACTION = 0 };
#include "series.h"

typedef struct {
    dual stokes;
    dual aspect;
    dual obliquity;
    dual initial_turning;
    dual initial_spin;
    dual initial_partner_spin;
    dual capillary;
    dual volume;
    dual contact_angle;
    dual radius_ratio;
    dual mass_ratio;
    dual glass_number;
    dual elastic_gap;
    dual rough_gap;
    dual rupture_gap;
    dual dry_restitution;
    dual film;
    dual shear;
    dual k0;
    dual centres;
    dual radius;
    dual partner_radius;
    dual spin_inertia;
    dual partner_inertia;
    dual momentum;
    dual k7;
    dual k8;
    dual k9;
    dual k10;
    dual k11;
    dual k12;
    dual k13;
    dual k14;
    dual k15;
    dual k16;
    dual k17;
    dual k18;
    dual k19;
    dual k20;
    shear_log_factor_constants shear_log_factor_law_constants;
    film_resistance_constants film_resistance_law_constants;
    bridge_force_constants bridge_force_law_constants;
    glass_pressure_constants glass;
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_SURFACE_TENSION, SI_SPEED, SI_ANGLE, SI_IMPACT_SPIN, SI_IMPACT_PARTNER_SPIN, SI_RADIUS_RATIO, SI_MASS_RATIO, SI_VOLUME, SI_CONTACT_ANGLE, SI_STOKES, QUANTITIES };
static const char quantity_names[] = "reduced_radius reduced_mass roughness dry_restitution youngs_modulus poisson_ratio viscosity film_thickness glass_transition_pressure surface_tension speed angle impact_spin impact_partner_spin radius_ratio mass_ratio volume contact_angle stokes";

/* The groups of a collision from its quantities in SI; the speed from the Stokes number, if that is given. */
static void scale(constants *c, dual *q)
{
    if (!d_absent(q[SI_STOKES]))
        q[SI_SPEED] = d_div(d_mul(d_mul(d_mul(d_mul(d_ratio(6.0, 1.0), d_pi()), d_power(q[SI_REDUCED_RADIUS],
        2)), q[SI_STOKES]), q[SI_VISCOSITY]), q[SI_REDUCED_MASS]);
    c->stokes = d_div(d_mul(q[SI_REDUCED_MASS], q[SI_SPEED]), d_mul(d_mul(d_mul(d_ratio(6.0, 1.0), d_pi()),
        d_power(q[SI_REDUCED_RADIUS], 2)), q[SI_VISCOSITY]));
    c->aspect = d_div(q[SI_FILM_THICKNESS], q[SI_REDUCED_RADIUS]);
    c->obliquity = d_larger(d_larger(d_tan(q[SI_ANGLE]), d_div(d_mul(d_mul(q[SI_REDUCED_RADIUS],
        d_add(q[SI_RADIUS_RATIO], d_ratio(1.0, 1.0))), d_abs(q[SI_IMPACT_PARTNER_SPIN])), q[SI_SPEED])),
        d_div(d_mul(d_mul(q[SI_REDUCED_RADIUS], d_add(q[SI_RADIUS_RATIO], d_ratio(1.0, 1.0))),
        d_abs(q[SI_IMPACT_SPIN])), d_mul(q[SI_RADIUS_RATIO], q[SI_SPEED])));
    c->initial_turning = d_div(d_ratio(1.0, 1.0), d_larger(d_larger(d_ratio(1.0, 1.0),
        d_div(d_mul(d_mul(q[SI_REDUCED_RADIUS], d_add(q[SI_RADIUS_RATIO], d_ratio(1.0, 1.0))),
        d_abs(q[SI_IMPACT_PARTNER_SPIN])), d_mul(q[SI_SPEED], d_tan(q[SI_ANGLE])))),
        d_div(d_mul(d_mul(q[SI_REDUCED_RADIUS], d_add(q[SI_RADIUS_RATIO], d_ratio(1.0, 1.0))),
        d_abs(q[SI_IMPACT_SPIN])), d_mul(d_mul(q[SI_RADIUS_RATIO], q[SI_SPEED]), d_tan(q[SI_ANGLE])))));
    c->initial_spin = d_div(d_mul(d_mul(q[SI_IMPACT_SPIN], q[SI_REDUCED_RADIUS]),
        d_power(d_add(q[SI_RADIUS_RATIO], d_ratio(1.0, 1.0)), 2)), d_mul(d_mul(c->obliquity,
        q[SI_RADIUS_RATIO]), q[SI_SPEED]));
    c->initial_partner_spin = d_div(d_mul(d_mul(q[SI_IMPACT_PARTNER_SPIN], q[SI_REDUCED_RADIUS]),
        d_power(d_add(q[SI_RADIUS_RATIO], d_ratio(1.0, 1.0)), 2)), d_mul(d_mul(c->obliquity,
        q[SI_RADIUS_RATIO]), q[SI_SPEED]));
    c->capillary = d_div(d_mul(d_mul(d_mul(d_ratio(3.0, 1.0), q[SI_REDUCED_RADIUS]), q[SI_SPEED]),
        q[SI_VISCOSITY]), d_mul(q[SI_FILM_THICKNESS], q[SI_SURFACE_TENSION]));
    c->volume = q[SI_VOLUME];
    c->contact_angle = q[SI_CONTACT_ANGLE];
    c->radius_ratio = q[SI_RADIUS_RATIO];
    c->mass_ratio = q[SI_MASS_RATIO];
    c->glass_number = d_div(d_mul(d_power(q[SI_FILM_THICKNESS], 2), q[SI_GLASS_TRANSITION_PRESSURE]),
        d_mul(d_mul(d_mul(d_ratio(3.0, 1.0), q[SI_REDUCED_RADIUS]), q[SI_SPEED]), q[SI_VISCOSITY]));
    c->elastic_gap = d_absent(q[SI_REDUCED_RADIUS]) || d_absent(q[SI_YOUNGS_MODULUS]) ||
        d_absent(q[SI_POISSON_RATIO]) || d_absent(q[SI_VISCOSITY]) || d_absent(q[SI_FILM_THICKNESS]) ||
        d_absent(q[SI_SPEED]) ? d_ratio(0.0, 1.0) :
        d_div(d_mul(d_mul(d_mul(d_mul(d_mul(d_exp(d_mul(d_ratio(1.0, 5.0), d_log(d_ratio(2.0, 1.0)))),
        d_exp(d_mul(d_ratio(2.0, 5.0), d_log(d_ratio(3.0, 1.0))))), d_exp(d_mul(d_ratio(3.0, 5.0),
        d_log(q[SI_REDUCED_RADIUS])))), d_exp(d_mul(d_ratio(2.0, 5.0), d_log(q[SI_SPEED])))),
        d_exp(d_mul(d_ratio(2.0, 5.0), d_log(q[SI_VISCOSITY])))), d_exp(d_mul(d_ratio(2.0, 5.0),
        d_log(d_add(d_ratio(1.0, 1.0), d_mul(d_ratio(-1.0, 1.0), d_power(q[SI_POISSON_RATIO], 2))))))),
        d_mul(q[SI_FILM_THICKNESS], d_exp(d_mul(d_ratio(2.0, 5.0), d_log(q[SI_YOUNGS_MODULUS])))));
    c->rough_gap = d_absent(q[SI_ROUGHNESS]) || d_absent(q[SI_FILM_THICKNESS]) ? d_ratio(0.0, 1.0) :
        d_div(q[SI_ROUGHNESS], q[SI_FILM_THICKNESS]);
    c->rupture_gap = OWN_RUPTURE ? d_div(d_mul(d_mul(d_ratio(2.0, 1.0), q[SI_REDUCED_RADIUS]),
        BRIDGE_RUPTURE_DISTANCE(q[SI_VOLUME], q[SI_CONTACT_ANGLE])), q[SI_FILM_THICKNESS]) :
        d_div(d_mul(d_mul(d_mul(d_ratio(2.0, 1.0), q[SI_REDUCED_RADIUS]), d_exp(d_mul(d_ratio(1.0, 3.0),
        d_log(q[SI_VOLUME])))), d_add(q[SI_CONTACT_ANGLE], d_ratio(2.0, 1.0))), d_mul(d_ratio(2.0, 1.0),
        q[SI_FILM_THICKNESS]));
    c->dry_restitution = q[SI_DRY_RESTITUTION];
}

/* Constants from the groups and the region's flags. */
static void prepare(constants *c)
{
    c->k0 = d_ratio(-1.0, 1.0);
    c->centres = d_div(d_power(d_add(c->radius_ratio, d_ratio(1.0, 1.0)), 2), c->radius_ratio);
    c->radius = d_div(d_add(c->radius_ratio, d_ratio(1.0, 1.0)), c->radius_ratio);
    c->partner_radius = d_add(c->radius_ratio, d_ratio(1.0, 1.0));
    c->spin_inertia = d_div(d_mul(d_mul(d_ratio(2.0, 1.0), d_add(c->mass_ratio, d_ratio(1.0, 1.0))),
        d_power(d_add(c->radius_ratio, d_ratio(1.0, 1.0)), 2)), d_mul(d_mul(d_ratio(5.0, 1.0), c->mass_ratio),
        d_power(c->radius_ratio, 2)));
    c->partner_inertia = d_mul(d_mul(d_ratio(2.0, 5.0), d_add(c->mass_ratio, d_ratio(1.0, 1.0))),
        d_power(d_add(c->radius_ratio, d_ratio(1.0, 1.0)), 2));
    c->momentum = d_add(d_add(d_mul(c->initial_partner_spin, c->partner_inertia), d_mul(c->initial_spin,
        c->spin_inertia)), d_mul(c->initial_turning, d_power(d_add(c->aspect, c->centres), 2)));
    c->k7 = d_mul(d_ratio(-1.0, 1.0), c->spin_inertia);
    c->k8 = d_div(d_ratio(1.0, 1.0), c->partner_inertia);
    c->k9 = d_ratio(1.0, 1.0);
    c->k10 = d_div(d_mul(c->aspect, c->shear), d_mul(d_ratio(3.0, 1.0), c->stokes));
    c->k11 = d_div(d_ratio(1.0, 1.0), c->centres);
    c->k12 = d_mul(d_ratio(4.0, 1.0), c->radius);
    c->k13 = d_mul(d_ratio(2.0, 5.0), c->radius);
    c->k14 = d_mul(d_ratio(4.0, 1.0), c->partner_radius);
    c->k15 = d_mul(d_ratio(2.0, 5.0), c->partner_radius);
    c->k16 = d_div(c->film, c->stokes);
    c->k17 = d_mul(d_ratio(1.0, 2.0), c->aspect);
    c->k18 = d_div(d_ratio(1.0, 1.0), d_mul(c->capillary, c->stokes));
    c->k19 = d_div(d_mul(c->aspect, d_power(c->obliquity, 2)), d_power(c->centres, 2));
    c->k20 = d_div(d_ratio(1.0, 1.0), c->spin_inertia);
    shear_log_factor_prepare(&c->shear_log_factor_law_constants, c->aspect);
    film_resistance_prepare(&c->film_resistance_law_constants);
    bridge_force_prepare(&c->bridge_force_law_constants, c->volume, c->contact_angle);
    glass_pressure_prepare(&c->glass, c->glass_number);
}

typedef struct {
    series state[STATES];
    series distance;
    series distance_squared;
    series orbital_rate;
    series combination;
    series partner_spin;
    series slip;
    series partner_slip;
    series shear_log_factor_law;
    series drag;
    series lever;
    series combination_2;
    series drag_by_lever;
    series torque;
    series combination_3;
    series partner_torque;
    series combination_4;
    series combination_4_over_lever;
    series shear_force;
    series film_resistance_law;
    series film_force;
    series scaled_gap;
    series bridge_force_law;
    series bridge_force;
    series orbital_rate_squared;
    series distance_by_orbital_rate_squared;
    series rate_of_normal_velocity;
    series rate_of_orbital_momentum;
    series rate_of_spin;
    shear_log_factor_series shear_log_factor_law_parts;
    film_resistance_series film_resistance_law_parts;
    bridge_force_series bridge_force_law_parts;
    series approach, clearance;
    glass_pressure_series glass;
} flow;

/* Coefficient k of every series and k + 1 of the states. */
static void advance(flow *s, const constants *c, int k)
{
    s_linear(&s->distance, 1, (const series *[]){&s->state[GAP]}, (const dual *[]){&c->aspect}, &c->centres,
        k);
    s_square(&s->distance_squared, &s->distance, k);
    s_quotient(&s->orbital_rate, &s->state[ORBITAL_MOMENTUM], &s->distance_squared, k);
    s_linear(&s->combination, 2, (const series *[]){&s->state[ORBITAL_MOMENTUM], &s->state[SPIN]}, (const dual
        *[]){&c->k0, &c->k7}, &c->momentum, k);
    s_scaled(&s->partner_spin, &s->combination, &c->k8, k);
    s_linear(&s->slip, 2, (const series *[]){&s->orbital_rate, &s->state[SPIN]}, (const dual *[]){&c->k9,
        &c->k0}, NULL, k);
    s_linear(&s->partner_slip, 2, (const series *[]){&s->orbital_rate, &s->partner_spin}, (const dual
        *[]){&c->k9, &c->k0}, NULL, k);
    shear_log_factor_next(&s->shear_log_factor_law_parts, &s->shear_log_factor_law,
        &c->shear_log_factor_law_constants, &s->state[GAP], k);
    s_scaled(&s->drag, &s->shear_log_factor_law, &c->k10, k);
    s_scaled(&s->lever, &s->distance, &c->k11, k);
    s_linear(&s->combination_2, 2, (const series *[]){&s->partner_slip, &s->slip}, (const dual
        *[]){&c->partner_radius, &c->k12}, NULL, k);
    s_product(&s->drag_by_lever, &s->drag, &s->lever, NULL, k);
    s_product(&s->torque, &s->drag_by_lever, &s->combination_2, &c->k13, k);
    s_linear(&s->combination_3, 2, (const series *[]){&s->partner_slip, &s->slip}, (const dual *[]){&c->k14,
        &c->radius}, NULL, k);
    s_product(&s->partner_torque, &s->drag_by_lever, &s->combination_3, &c->k15, k);
    s_linear(&s->combination_4, 2, (const series *[]){&s->partner_torque, &s->torque}, (const dual
        *[]){&c->k9, &c->k9}, NULL, k);
    s_quotient(&s->combination_4_over_lever, &s->combination_4, &s->lever, k);
    s_scaled(&s->shear_force, &s->combination_4_over_lever, &c->k11, k);
    film_resistance_next(&s->film_resistance_law_parts, &s->film_resistance_law,
        &c->film_resistance_law_constants, &s->state[GAP], k);
    s_product(&s->film_force, &s->state[NORMAL_VELOCITY], &s->film_resistance_law, &c->k16, k);
    s_scaled(&s->scaled_gap, &s->state[GAP], &c->k17, k);
    bridge_force_next(&s->bridge_force_law_parts, &s->bridge_force_law, &c->bridge_force_law_constants,
        &s->scaled_gap, k);
    s_scaled(&s->bridge_force, &s->bridge_force_law, &c->k18, k);
    s_square(&s->orbital_rate_squared, &s->orbital_rate, k);
    s_product(&s->distance_by_orbital_rate_squared, &s->distance, &s->orbital_rate_squared, NULL, k);
    s_linear(&s->rate_of_normal_velocity, 3, (const series *[]){&s->distance_by_orbital_rate_squared,
        &s->bridge_force, &s->film_force}, (const dual *[]){&c->k19, &c->k0, &c->k0}, NULL, k);
    s_product(&s->rate_of_orbital_momentum, &s->distance, &s->shear_force, &c->k0, k);
    s_scaled(&s->rate_of_spin, &s->torque, &c->k20, k);
    s_advance(&s->state[GAP], &s->state[NORMAL_VELOCITY], NULL, k);
    s_advance(&s->state[NORMAL_VELOCITY], &s->rate_of_normal_velocity, NULL, k);
    s_advance(&s->state[ORBITAL_MOMENTUM], &s->rate_of_orbital_momentum, NULL, k);
    s_advance(&s->state[SPIN], &s->rate_of_spin, NULL, k);
}

/* Coefficient k of the clearance of the glass criterion. */
static void advance_clearance(flow *s, const constants *c, int k)
{
    s_scaled(&s->approach, &s->state[NORMAL_VELOCITY], &c->k0, k);
    glass_pressure_next(&s->glass, &s->clearance, &c->glass, &s->state[GAP], &s->approach, k);
}

enum { CONTACT_GAP, RUPTURE_GAP, TANGENTIAL_EDGE, LEVELS };
/* Gaps of events. */
static void levels(const constants *c, dual *level)
{
    level[CONTACT_GAP] = d_larger(c->elastic_gap, c->rough_gap);
    level[RUPTURE_GAP] = c->rupture_gap;
    level[TANGENTIAL_EDGE] = shear_edge(c->aspect);
}

/* State at initial contact. */
static void start(const constants *c, dual *y)
{
    (void)c; (void)y;
    y[GAP] = d_ratio(1.0, 1.0);
    y[NORMAL_VELOCITY] = d_ratio(-1.0, 1.0);
    y[ORBITAL_MOMENTUM] = d_mul(c->initial_turning, d_power(d_add(c->aspect, c->centres), 2));
    y[SPIN] = c->initial_spin;
}

/* State just after a rebound: u -> -e_dry u; the other states are continuous. */
static void rebound(const constants *c, const dual *y, dual *after)
{
    (void)c; (void)y;
    after[GAP] = y[GAP];
    after[NORMAL_VELOCITY] = d_mul(d_mul(d_ratio(-1.0, 1.0), c->dry_restitution), y[NORMAL_VELOCITY]);
    after[ORBITAL_MOMENTUM] = y[ORBITAL_MOMENTUM];
    after[SPIN] = y[SPIN];
}

/* Energy above the least at the same gap and angular momentum, over m v0^2. */
static dual excess_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), c->centres);
    dual orbital_rate = d_div(y[ORBITAL_MOMENTUM], d_power(distance, 2));
    dual partner_spin = d_div(d_add(d_add(c->momentum, d_mul(d_ratio(-1.0, 1.0), y[ORBITAL_MOMENTUM])),
        d_mul(d_mul(d_ratio(-1.0, 1.0), y[SPIN]), c->spin_inertia)), c->partner_inertia);
    return d_add(d_mul(d_ratio(1.0, 2.0), d_power(y[NORMAL_VELOCITY], 2)), d_div(d_mul(d_mul(d_power(distance,
        4), d_power(c->obliquity, 2)), d_add(d_mul(d_power(distance, 4), d_add(d_mul(c->partner_inertia,
        d_power(d_add(orbital_rate, d_mul(d_ratio(-1.0, 1.0), partner_spin)), 2)), d_mul(c->spin_inertia,
        d_power(d_add(orbital_rate, d_mul(d_ratio(-1.0, 1.0), y[SPIN])), 2)))),
        d_mul(d_mul(d_mul(d_power(distance, 2), c->partner_inertia), c->spin_inertia),
        d_power(d_add(d_mul(d_ratio(-1.0, 1.0), partner_spin), y[SPIN]), 2)))), d_mul(d_mul(d_mul(d_ratio(2.0,
        1.0), d_power(c->centres, 2)), d_power(distance, 6)), d_add(d_add(d_power(distance, 2),
        c->partner_inertia), c->spin_inertia))));
}

/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static dual least_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), c->centres);
    dual inertia_ratio = d_add(d_add(d_power(distance, 2), c->partner_inertia), c->spin_inertia);
    return d_div(d_mul(d_power(c->momentum, 2), d_power(c->obliquity, 2)), d_mul(d_mul(d_ratio(2.0, 1.0),
        d_power(c->centres, 2)), inertia_ratio));
}

/* Energy over m v0^2 that may carry the state to a larger gap. */
static dual held_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), c->centres);
    dual orbital_rate = d_div(y[ORBITAL_MOMENTUM], d_power(distance, 2));
    dual partner_spin = d_div(d_add(d_add(c->momentum, d_mul(d_ratio(-1.0, 1.0), y[ORBITAL_MOMENTUM])),
        d_mul(d_mul(d_ratio(-1.0, 1.0), y[SPIN]), c->spin_inertia)), c->partner_inertia);
    return d_add(d_add(d_add(d_mul(d_ratio(1.0, 2.0), d_power(y[NORMAL_VELOCITY], 2)),
        d_div(d_mul(d_mul(d_power(distance, 2), d_power(c->obliquity, 2)), d_power(orbital_rate, 2)),
        d_mul(d_ratio(2.0, 1.0), d_power(c->centres, 2)))), d_div(d_mul(d_mul(d_power(c->obliquity, 2),
        c->partner_inertia), d_power(partner_spin, 2)), d_mul(d_ratio(2.0, 1.0), d_power(c->centres, 2)))),
        d_div(d_mul(d_mul(d_power(c->obliquity, 2), d_power(y[SPIN], 2)), c->spin_inertia), d_mul(d_ratio(2.0,
        1.0), d_power(c->centres, 2))));
}

/* What is needed of it at this gap with this momentum, over m v0^2, without work. */
static dual needed_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), c->centres);
    dual inertia_ratio = d_add(d_add(d_power(distance, 2), c->partner_inertia), c->spin_inertia);
    return d_div(d_mul(d_power(c->momentum, 2), d_power(c->obliquity, 2)), d_mul(d_mul(d_ratio(2.0, 1.0),
        d_power(c->centres, 2)), inertia_ratio));
}
