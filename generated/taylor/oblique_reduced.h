/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 c611586f35bcc10135e6fb71d1601fb3cd7b34600b04c5754661e9c9c5af465a */

/* Oblique doublet with a film only, spin eliminated through the conserved angular momentum.
 *
 * Time in x0/v0. States (per unit):
 * - gap [x0]: gap over film thickness
 * - normal_velocity [v0]: normal velocity over impact speed, negative on approach
 * - orbital_momentum [a^2 Omega]: orbital angular momentum r^2 omega over a^2 Omega
 *
 * Groups:
 * - stokes [1]: Stokes number m v0/(6 pi mu a^2)
 * - aspect [1]: film thickness over reduced radius, x0/a
 * - obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
 * - initial_turning [1]: tan(theta0)/T, 1 without spins
 * - initial_spin [Omega]: spin at initial contact over Omega
 * - glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
 * - elastic_gap [x0]: elastic length over film thickness
 * - rough_gap [x0]: roughness over film thickness
 * - dry_restitution [1]: restitution of the dry contact
 *
 * Law slots: film, glass, shear.
 *
 * Products of series: 6 and those of the laws. */

#define OBLIQUE 1
#define BRIDGE 0
#define STRINGS 0
#define REDUCED 1
#define ATTRACTION 0
#define SPREAD 0
#define WALL 0
#define SPACE 0
#define CAPILLARY_STATE 0
#define TURNING_STATE (WITH_ROTATION && 1)
#define LEDGER_STATES 0
/* Index of coefficient k of a series used in sums only; the cases listed also read past coefficients. */
#define PASSING(k) (GRADIENTS || WITH_LEDGER || CAPILLARY_STATE ? (k) : 0)

enum { GAP, NORMAL_VELOCITY, ORBITAL_MOMENTUM, MODEL_STATES };
enum { STATES = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE + LEDGER_STATES };
enum { CAPILLARY_WORK = MODEL_STATES, TURNED = MODEL_STATES + CAPILLARY_STATE };
enum { GROUPS = 9 };

typedef struct {
    vec stokes; /* Stokes number m v0/(6 pi mu a^2) */
    vec aspect; /* film thickness over reduced radius, x0/a */
    vec obliquity; /* largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0 */
    vec initial_turning; /* tan(theta0)/T, 1 without spins */
    vec initial_spin; /* spin at initial contact over Omega */
    vec glass_number; /* glass-transition pressure over 3 mu a v0/x0^2 */
    vec elastic_gap; /* elastic length over film thickness */
    vec rough_gap; /* roughness over film thickness */
    vec dry_restitution; /* restitution of the dry contact */
    vec momentum;
    vec spin_offset;
    vec shear_force_factor;
    vec centrifugal_force_factor;
    vec film_force_factor;
    vec rate_of_rotation_per_orbital_rate;
    vec normal_velocity_2_per_normal_velocity;
    vec energy_per_distance_squared_by_orbital_rate_squared;
    vec energy_per_spin_squared;
    vec tangential_restitution_factor;
    vec energy_per_inverse_inertia_ratio;
    vec slope_per_distance_over_inertia_ratio_squared;
    vec contact;
    vec first_momentum;
    vec relaxation_per_combination_by_shear_log_factor_law_over_distance;
    vec edge;
    shear_log_factor_constants shear_log_factor_law;
    film_resistance_constants film_resistance_law;
    glass_pressure_clearance_constants glass;
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_SPEED, SI_ANGLE, SI_IMPACT_SPIN, QUANTITIES };
const char quantity_names[] =
    "reduced_radius "
    "reduced_mass "
    "roughness "
    "dry_restitution "
    "youngs_modulus "
    "poisson_ratio "
    "viscosity "
    "film_thickness "
    "glass_transition_pressure "
    "speed "
    "angle "
    "impact_spin";

#include "shared/scale_oblique.h"

/* Omega, the unit of angular velocities, in rad/s. */
static inline vec rate_scale(const constants *c, const vec *q)
{
    return 0.25*c->obliquity*q[SI_SPEED]/q[SI_REDUCED_RADIUS];
}

/* Constants computed once per collision from its groups. */
static inline void prepare(constants *c)
{
    c->momentum = 6.4*c->initial_spin + c->initial_turning*((c->aspect + 4.0)*(c->aspect + 4.0));
    c->spin_offset = 0.15625*c->momentum;
    c->shear_force_factor = 1.3333333333333333*c->aspect/c->stokes;
    c->centrifugal_force_factor = 0.0625*c->aspect*(c->obliquity*c->obliquity);
    c->film_force_factor = 1.0/c->stokes;
    c->rate_of_rotation_per_orbital_rate = 0.25*c->aspect*c->obliquity;
    c->normal_velocity_2_per_normal_velocity = -c->dry_restitution;
    c->energy_per_distance_squared_by_orbital_rate_squared = 0.03125*(c->obliquity*c->obliquity);
    c->energy_per_spin_squared = 0.2*(c->obliquity*c->obliquity);
    c->tangential_restitution_factor = 1.0/(c->initial_turning*(c->aspect + 4.0));
    c->energy_per_inverse_inertia_ratio = 0.03125*(c->momentum*c->momentum)*(c->obliquity*c->obliquity);
    c->slope_per_distance_over_inertia_ratio_squared =
        -0.0625*c->aspect*(c->momentum*c->momentum)*(c->obliquity*c->obliquity);
    c->contact = vec_larger(c->elastic_gap, c->rough_gap);
    c->first_momentum = vec_larger(splat(0.0), vec_larger(6.4*c->initial_spin + c->initial_turning*((c->aspect
        + 4.0)*(c->aspect + 4.0)), -6.4*c->initial_spin - c->initial_turning*((c->aspect + 4.0)*(c->aspect +
        4.0)))/(c->initial_turning*((c->aspect + 4.0)*(c->aspect + 4.0)) + vec_larger(-6.4*c->initial_spin,
        6.4*c->initial_spin)) - 3.552713678800501e-15);
    c->relaxation_per_combination_by_shear_log_factor_law_over_distance =
        0.041666666666666664*c->aspect/c->stokes;
    c->edge = shear_edge(c->aspect);
    shear_log_factor_prepare(&c->shear_log_factor_law, c->aspect);
    film_resistance_prepare(&c->film_resistance_law);
    glass_pressure_clearance_prepare(&c->glass, c->glass_number);
}

typedef struct {
    vec gap[TERMS]; /* gap over film thickness */
    vec normal_velocity[TERMS]; /* normal velocity over impact speed, negative on approach */
    vec orbital_momentum[TERMS]; /* orbital angular momentum r^2 omega over a^2 Omega */
#if CAPILLARY_STATE
    vec capillary_work[TERMS];
#endif
#if TURNING_STATE
    vec turned[TERMS];
#endif
    vec distance[TERMS];
    vec distance_squared[TERMS];
    vec orbital_rate[TERMS];
    vec over_orbital_rate;
    vec spin[PASSING(ORDER) + 1];
    vec slip[TERMS];
    shear_log_factor_series shear_log_factor_law;
    vec shear_force[TERMS];
    vec orbital_rate_squared[TERMS];
    vec centrifugal_force[PASSING(ORDER) + 1];
    film_resistance_series film_resistance_law;
    vec film_force[PASSING(ORDER) + 1];
    vec rate_of_normal_velocity[PASSING(ORDER) + 1];
    vec rate_of_orbital_momentum[PASSING(ORDER) + 1];
    vec rate_of_rotation[PASSING(ORDER) + 1];
    vec acceleration[TERMS]; /* of the gap, also while it is held */
    vec approach[TERMS];
    glass_pressure_clearance_series glass;
} series;

/* Coefficient k of every series and k + 1 of the states. Region: film is 1 inside the film, shear 1 inside
 * the tangential edge, else 0; the gap is held in lanes that are not moving. */
INLINE void coefficients(series *s, const constants *c, vec film, vec shear, mask moving, int k)
{
    (void)film; (void)shear;
    s->distance[k] = k == 0 ? c->aspect*s->gap[k] + 4.0 : c->aspect*s->gap[k];
    s->distance_squared[k] = square(s->distance, k);
    s->orbital_rate[k] = quotient(s->orbital_momentum, s->distance_squared, s->orbital_rate,
        &s->over_orbital_rate, k);
    s->spin[PASSING(k)] = k == 0 ? -0.15625*s->orbital_momentum[k] + c->spin_offset :
        -0.15625*s->orbital_momentum[k];
    s->slip[k] = s->orbital_rate[k] - s->spin[PASSING(k)];
    shear_log_factor_next(&s->shear_log_factor_law, &c->shear_log_factor_law, s->gap, k);
    s->shear_force[k] = shear*c->shear_force_factor*product(s->slip, s->shear_log_factor_law.result, k);
    s->orbital_rate_squared[k] = square(s->orbital_rate, k);
    s->centrifugal_force[PASSING(k)] = c->centrifugal_force_factor*product(s->distance,
        s->orbital_rate_squared, k);
    film_resistance_next(&s->film_resistance_law, &c->film_resistance_law, s->gap, k);
    s->film_force[PASSING(k)] = film*c->film_force_factor*product(s->normal_velocity,
        s->film_resistance_law.result, k);
    s->rate_of_normal_velocity[PASSING(k)] = s->centrifugal_force[PASSING(k)] - s->film_force[PASSING(k)];
    s->rate_of_orbital_momentum[PASSING(k)] = -product(s->distance, s->shear_force, k);
    s->rate_of_rotation[PASSING(k)] = c->rate_of_rotation_per_orbital_rate*s->orbital_rate[k];
    double next = 1.0/(k + 1);
    s->gap[k + 1] = s->normal_velocity[k]*next;
    s->acceleration[k] = s->rate_of_normal_velocity[PASSING(k)];
    s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);
    s->orbital_momentum[k + 1] = s->rate_of_orbital_momentum[PASSING(k)]*next;
#if TURNING_STATE
    s->turned[k + 1] = s->rate_of_rotation[PASSING(k)]*next;
#endif
}

/* Coefficient k of the clearance of the glass criterion. */
INLINE void glass_coefficients(series *s, const constants *c, int k)
{
    s->approach[k] = -s->normal_velocity[k];
    glass_pressure_clearance_next(&s->glass, &c->glass, s->gap, s->approach, k);
}

static inline vec glass_clearance(const constants *c, const vec *y)
{
    return glass_pressure_clearance_value(&c->glass, y[GAP], -y[NORMAL_VELOCITY]);
}

#include "shared/start_oblique_reduced.h"

#include "shared/rebound_oblique_reduced.h"

#include "shared/inward_force_oblique.h"

#include "shared/stored_energy_oblique_reduced.h"

enum { OUTPUTS = 4 };
/* Results for a separated doublet: restitutions, and rates over their scale. */
static inline void outputs(const constants *c, const vec *y, vec *shown)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec spin = -0.15625*y[ORBITAL_MOMENTUM] + c->spin_offset;
    vec tangential_restitution = c->tangential_restitution_factor*distance*orbital_rate;
    shown[0] = y[NORMAL_VELOCITY];
    shown[1] = tangential_restitution;
    shown[2] = orbital_rate;
    shown[3] = spin;
}

#define POTENTIAL 1
/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static inline vec potential_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec inertia_ratio = distance_squared + 6.4;
    vec inverse_inertia_ratio = 1.0/inertia_ratio;
    vec energy = c->energy_per_inverse_inertia_ratio*inverse_inertia_ratio;
    return energy;
}

/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static inline vec potential_slope(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec inertia_ratio = distance_squared + 6.4;
    vec inertia_ratio_squared = inertia_ratio*inertia_ratio;
    vec distance_over_inertia_ratio_squared = distance/inertia_ratio_squared;
    vec slope = c->slope_per_distance_over_inertia_ratio_squared*distance_over_inertia_ratio_squared;
    return slope;
}

#include "shared/rigid_momentum_oblique_reduced.h"

#include "shared/surface_slip_oblique_reduced.h"

#if defined(FILM_STOPPING) && defined(SHEAR_LOG_FACTOR_FALLS)
#define SPIN_DOWN_MARGINS (1)
/* Margins of the spin-down certificate (lever arm at mid-gap, a shear that falls with the gap, L = 0): stays
 * < 0 and rate > 0 exclude separation; momentum is |L| over its parts at the start, beyond rounding. So do
 * apart < 0 and inside < 0 where J = 0. */
static inline void spin_down_margins(const constants *c, const vec *y, vec *stays, vec *rate_margin, vec
    *apart, vec *inside, vec *momentum_margin)
{
    vec distance = c->aspect*y[GAP] + 4.0;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/(distance*distance);
    vec spin = 0.15625*c->momentum - 0.15625*y[ORBITAL_MOMENTUM];
    vec shear_end = shear_edge(c->aspect);
    vec beyond = 0.5*y[GAP] + 0.5*vec_smaller(splat(1.0), shear_end);
    vec near = c->aspect*c->contact + distance - c->aspect*y[GAP];
    vec far = c->aspect*beyond + distance - c->aspect*y[GAP];
    vec leak = shear_log_factor_value(&c->shear_log_factor_law, beyond);
    vec rate = 0.08333333333333333*c->aspect*leak*(5.0*far*near + 32.0)/(far*c->stokes);
    *stays =
        2.0*c->aspect*(distance*distance)*c->stokes*(0.03125*(distance*distance)*(c->obliquity*c->obliquity)*(orbital_rate*orbital_rate)
        + 0.2*(c->obliquity*c->obliquity)*(spin*spin))/((near*near*near)*rate) +
        c->stokes*vec_larger(y[NORMAL_VELOCITY], -c->dry_restitution*y[NORMAL_VELOCITY]) +
        film_stopping(beyond) - film_stopping(y[GAP]);
    *rate_margin = rate;
    *apart = vec_larger(film_stopping(y[GAP]) - y[NORMAL_VELOCITY]*c->stokes - film_stopping(shear_end),
        c->stokes*vec_larger(y[NORMAL_VELOCITY], -c->dry_restitution*y[NORMAL_VELOCITY]) -
        film_stopping(y[GAP]));
    *inside = shear_end - y[GAP];
    *momentum_margin = c->first_momentum;
}
#else
#define SPIN_DOWN_MARGINS 0
#endif

#if defined(FILM_RESISTANCE_FALLS) && defined(SHEAR_LOG_FACTOR_FALLS) && !defined(FILM_CAVITATES)
#define SLOW_MANIFOLD 1
/* Inside the film, as series in the gap (derive/equations/certificates/slow_manifold.py): `distance` centre
 * distance over a; `slowing` loss of normal velocity in the film per gap, over v0/x0: f; `relaxation` rate at
 * which shear brings the orbital momentum to its rigid value, per x0/v0: s; `rigid` orbital momentum in rigid
 * rotation: J_r; `centrifugal` centrifugal force over the square of the orbital momentum: c; `attractions`
 * attractive forces: A. */
typedef struct {
    vec gap[TERMS];
    vec distance[TERMS];
    film_resistance_series film_resistance_law;
    vec slowing[TERMS];
    vec distance_squared[TERMS];
    vec combination[TERMS];
    shear_log_factor_series shear_log_factor_law;
    vec combination_by_shear_log_factor_law[TERMS];
    vec combination_by_shear_log_factor_law_over_distance[TERMS];
    vec over_combination_by_shear_log_factor_law_over_distance;
    vec relaxation[TERMS];
    vec combination_2[TERMS];
    vec distance_squared_over_combination_2[TERMS];
    vec over_distance_squared_over_combination_2;
    vec rigid[TERMS];
    vec distance_squared_by_distance[TERMS];
    vec inverse_distance_squared_by_distance[TERMS];
    vec centrifugal[TERMS];
    vec attractions[TERMS];
} slow_series;

INLINE void slow_coefficients(slow_series *s, const constants *c, int k)
{
    (void)c;
    s->distance[k] = k == 0 ? c->aspect*s->gap[k] + 4.0 : c->aspect*s->gap[k];
    film_resistance_next(&s->film_resistance_law, &c->film_resistance_law, s->gap, k);
    s->slowing[k] = c->film_force_factor*s->film_resistance_law.result[k];
    s->distance_squared[k] = square(s->distance, k);
    s->combination[k] = k == 0 ? 5.0*s->distance_squared[k] + 32.0 : 5.0*s->distance_squared[k];
    shear_log_factor_next(&s->shear_log_factor_law, &c->shear_log_factor_law, s->gap, k);
    s->combination_by_shear_log_factor_law[k] = product(s->combination, s->shear_log_factor_law.result, k);
    s->combination_by_shear_log_factor_law_over_distance[k] = quotient(s->combination_by_shear_log_factor_law,
        s->distance, s->combination_by_shear_log_factor_law_over_distance,
        &s->over_combination_by_shear_log_factor_law_over_distance, k);
    s->relaxation[k] =
        c->relaxation_per_combination_by_shear_log_factor_law_over_distance*s->combination_by_shear_log_factor_law_over_distance[k];
    s->combination_2[k] = k == 0 ? s->distance_squared[k] + 6.4 : s->distance_squared[k];
    s->distance_squared_over_combination_2[k] = quotient(s->distance_squared, s->combination_2,
        s->distance_squared_over_combination_2, &s->over_distance_squared_over_combination_2, k);
    s->rigid[k] = c->momentum*s->distance_squared_over_combination_2[k];
    s->distance_squared_by_distance[k] = product(s->distance, s->distance_squared, k);
    s->inverse_distance_squared_by_distance[k] = reciprocal(s->distance_squared_by_distance,
        s->inverse_distance_squared_by_distance, k);
    s->centrifugal[k] = c->centrifugal_force_factor*s->inverse_distance_squared_by_distance[k];
    s->attractions[k] = k == 0 ? splat(0.0) : splat(0.0);
}

#if defined(FILM_BRAKING)
/* Velocity that the film takes from x0 to a gap, over v0. */
static inline void film_taken(const constants *c, const vec *y, vec *taken)
{
    *taken = film_braking(y[GAP])/c->stokes;
}
#endif
#else
#define SLOW_MANIFOLD 0
#endif

/* Gap beyond which there is no tangential force. */
static inline vec tangential_edge(const constants *c)
{
    return c->edge;
}
