/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 c611586f35bcc10135e6fb71d1601fb3cd7b34600b04c5754661e9c9c5af465a */

enum { GAP, NORMAL_VELOCITY, ORBITAL_MOMENTUM, STATES };
enum { OBLIQUE = 1, BRIDGE = 0, ATTRACTION = 0 };
#include "series.h"

typedef struct {
    dual stokes;
    dual aspect;
    dual obliquity;
    dual initial_turning;
    dual initial_spin;
    dual glass_number;
    dual elastic_gap;
    dual rough_gap;
    dual dry_restitution;
    dual film;
    dual shear;
    dual k0;
    dual momentum;
    dual k2;
    dual k3;
    dual k4;
    dual k5;
    dual k6;
    dual k7;
    dual k8;
    shear_log_factor_constants shear_log_factor_law_constants;
    film_resistance_constants film_resistance_law_constants;
    glass_pressure_constants glass;
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_SPEED, SI_ANGLE, SI_IMPACT_SPIN, SI_STOKES, QUANTITIES };
static const char quantity_names[] = "reduced_radius reduced_mass roughness dry_restitution youngs_modulus poisson_ratio viscosity film_thickness glass_transition_pressure speed angle impact_spin stokes";

/* The groups of a collision from its quantities in SI; the speed from the Stokes number, if that is given. */
static void scale(constants *c, dual *q)
{
    if (!d_absent(q[SI_STOKES]))
        q[SI_SPEED] = d_div(d_mul(d_mul(d_mul(d_mul(d_ratio(6.0, 1.0), d_pi()), d_power(q[SI_REDUCED_RADIUS],
        2)), q[SI_STOKES]), q[SI_VISCOSITY]), q[SI_REDUCED_MASS]);
    c->stokes = d_div(d_mul(q[SI_REDUCED_MASS], q[SI_SPEED]), d_mul(d_mul(d_mul(d_ratio(6.0, 1.0), d_pi()),
        d_power(q[SI_REDUCED_RADIUS], 2)), q[SI_VISCOSITY]));
    c->aspect = d_div(q[SI_FILM_THICKNESS], q[SI_REDUCED_RADIUS]);
    c->obliquity = d_larger(d_tan(q[SI_ANGLE]), d_div(d_mul(d_mul(d_ratio(2.0, 1.0), q[SI_REDUCED_RADIUS]),
        d_abs(q[SI_IMPACT_SPIN])), q[SI_SPEED]));
    c->initial_turning = d_div(d_ratio(1.0, 1.0), d_larger(d_ratio(1.0, 1.0), d_div(d_mul(d_mul(d_ratio(2.0,
        1.0), q[SI_REDUCED_RADIUS]), d_abs(q[SI_IMPACT_SPIN])), d_mul(q[SI_SPEED], d_tan(q[SI_ANGLE])))));
    c->initial_spin = d_div(d_mul(d_mul(d_ratio(4.0, 1.0), q[SI_IMPACT_SPIN]), q[SI_REDUCED_RADIUS]),
        d_mul(c->obliquity, q[SI_SPEED]));
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
    c->dry_restitution = q[SI_DRY_RESTITUTION];
}

/* Constants from the groups and the region's flags. */
static void prepare(constants *c)
{
    c->k0 = d_ratio(-1.0, 1.0);
    c->momentum = d_add(d_mul(d_ratio(32.0, 5.0), c->initial_spin), d_mul(c->initial_turning,
        d_power(d_add(c->aspect, d_ratio(4.0, 1.0)), 2)));
    c->k2 = d_ratio(4.0, 1.0);
    c->k3 = d_ratio(-5.0, 32.0);
    c->k4 = d_mul(d_ratio(5.0, 32.0), c->momentum);
    c->k5 = d_ratio(1.0, 1.0);
    c->k6 = d_div(d_mul(d_mul(d_ratio(4.0, 1.0), c->aspect), c->shear), d_mul(d_ratio(3.0, 1.0), c->stokes));
    c->k7 = d_mul(d_mul(d_ratio(1.0, 16.0), c->aspect), d_power(c->obliquity, 2));
    c->k8 = d_div(c->film, c->stokes);
    shear_log_factor_prepare(&c->shear_log_factor_law_constants, c->aspect);
    film_resistance_prepare(&c->film_resistance_law_constants);
    glass_pressure_prepare(&c->glass, c->glass_number);
}

typedef struct {
    series state[STATES];
    series distance;
    series distance_squared;
    series orbital_rate;
    series spin;
    series slip;
    series shear_log_factor_law;
    series shear_force;
    series orbital_rate_squared;
    series centrifugal_force;
    series film_resistance_law;
    series film_force;
    series rate_of_normal_velocity;
    series rate_of_orbital_momentum;
    shear_log_factor_series shear_log_factor_law_parts;
    film_resistance_series film_resistance_law_parts;
    series approach, clearance;
    glass_pressure_series glass;
} flow;

/* Coefficient k of every series and k + 1 of the states. */
static void advance(flow *s, const constants *c, int k)
{
    s_linear(&s->distance, 1, (const series *[]){&s->state[GAP]}, (const dual *[]){&c->aspect}, &c->k2, k);
    s_square(&s->distance_squared, &s->distance, k);
    s_quotient(&s->orbital_rate, &s->state[ORBITAL_MOMENTUM], &s->distance_squared, k);
    s_linear(&s->spin, 1, (const series *[]){&s->state[ORBITAL_MOMENTUM]}, (const dual *[]){&c->k3}, &c->k4,
        k);
    s_linear(&s->slip, 2, (const series *[]){&s->orbital_rate, &s->spin}, (const dual *[]){&c->k5, &c->k0},
        NULL, k);
    shear_log_factor_next(&s->shear_log_factor_law_parts, &s->shear_log_factor_law,
        &c->shear_log_factor_law_constants, &s->state[GAP], k);
    s_product(&s->shear_force, &s->slip, &s->shear_log_factor_law, &c->k6, k);
    s_square(&s->orbital_rate_squared, &s->orbital_rate, k);
    s_product(&s->centrifugal_force, &s->distance, &s->orbital_rate_squared, &c->k7, k);
    film_resistance_next(&s->film_resistance_law_parts, &s->film_resistance_law,
        &c->film_resistance_law_constants, &s->state[GAP], k);
    s_product(&s->film_force, &s->state[NORMAL_VELOCITY], &s->film_resistance_law, &c->k8, k);
    s_linear(&s->rate_of_normal_velocity, 2, (const series *[]){&s->centrifugal_force, &s->film_force}, (const
        dual *[]){&c->k5, &c->k0}, NULL, k);
    s_product(&s->rate_of_orbital_momentum, &s->distance, &s->shear_force, &c->k0, k);
    s_advance(&s->state[GAP], &s->state[NORMAL_VELOCITY], NULL, k);
    s_advance(&s->state[NORMAL_VELOCITY], &s->rate_of_normal_velocity, NULL, k);
    s_advance(&s->state[ORBITAL_MOMENTUM], &s->rate_of_orbital_momentum, NULL, k);
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
    level[RUPTURE_GAP] = d_ratio(1.0, 1.0);
    level[TANGENTIAL_EDGE] = shear_edge(c->aspect);
}

/* State at initial contact. */
static void start(const constants *c, dual *y)
{
    (void)c; (void)y;
    y[GAP] = d_ratio(1.0, 1.0);
    y[NORMAL_VELOCITY] = d_ratio(-1.0, 1.0);
    y[ORBITAL_MOMENTUM] = d_mul(c->initial_turning, d_power(d_add(c->aspect, d_ratio(4.0, 1.0)), 2));
}

/* State just after a rebound: u -> -e_dry u; the other states are continuous. */
static void rebound(const constants *c, const dual *y, dual *after)
{
    (void)c; (void)y;
    after[GAP] = y[GAP];
    after[NORMAL_VELOCITY] = d_mul(d_mul(d_ratio(-1.0, 1.0), c->dry_restitution), y[NORMAL_VELOCITY]);
    after[ORBITAL_MOMENTUM] = y[ORBITAL_MOMENTUM];
}

/* Energy above the least at the same gap and angular momentum, over m v0^2. */
static dual excess_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), d_ratio(4.0, 1.0));
    dual orbital_rate = d_div(y[ORBITAL_MOMENTUM], d_power(distance, 2));
    dual spin = d_add(d_mul(d_ratio(5.0, 32.0), c->momentum), d_mul(d_mul(d_ratio(-1.0, 1.0), d_ratio(5.0,
        32.0)), y[ORBITAL_MOMENTUM]));
    return d_add(d_mul(d_ratio(1.0, 2.0), d_power(y[NORMAL_VELOCITY], 2)),
        d_div(d_mul(d_mul(d_mul(d_ratio(5.0, 1.0), d_power(distance, 2)), d_power(c->obliquity, 2)),
        d_power(d_add(orbital_rate, d_mul(d_ratio(-1.0, 1.0), spin)), 2)), d_add(d_mul(d_ratio(25.0, 1.0),
        d_power(distance, 2)), d_ratio(160.0, 1.0))));
}

/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static dual least_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), d_ratio(4.0, 1.0));
    dual inertia_ratio = d_add(d_power(distance, 2), d_ratio(32.0, 5.0));
    return d_div(d_mul(d_power(c->momentum, 2), d_power(c->obliquity, 2)), d_mul(d_ratio(32.0, 1.0),
        inertia_ratio));
}

/* Energy over m v0^2 that may carry the state to a larger gap. */
static dual held_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), d_ratio(4.0, 1.0));
    dual orbital_rate = d_div(y[ORBITAL_MOMENTUM], d_power(distance, 2));
    dual spin = d_add(d_mul(d_ratio(5.0, 32.0), c->momentum), d_mul(d_mul(d_ratio(-1.0, 1.0), d_ratio(5.0,
        32.0)), y[ORBITAL_MOMENTUM]));
    return d_add(d_add(d_mul(d_mul(d_mul(d_ratio(1.0, 32.0), d_power(distance, 2)), d_power(c->obliquity, 2)),
        d_power(orbital_rate, 2)), d_mul(d_ratio(1.0, 2.0), d_power(y[NORMAL_VELOCITY], 2))),
        d_mul(d_mul(d_ratio(1.0, 5.0), d_power(c->obliquity, 2)), d_power(spin, 2)));
}

/* What is needed of it at this gap with this momentum, over m v0^2, without work. */
static dual needed_energy(const constants *c, const dual *y)
{
    (void)c; (void)y;
    dual distance = d_add(d_mul(c->aspect, y[GAP]), d_ratio(4.0, 1.0));
    dual inertia_ratio = d_add(d_power(distance, 2), d_ratio(32.0, 5.0));
    return d_div(d_mul(d_power(c->momentum, 2), d_power(c->obliquity, 2)), d_mul(d_ratio(32.0, 1.0),
        inertia_ratio));
}
