/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 d76574b5e8c063dadf18b6548bec1ce80c072871f4d8b39da6f2629f44e895ac */

/* Oblique doublet with a liquid bridge, spin eliminated through the conserved angular momentum.
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
 * - capillary [1]: capillary number 3 mu a v0/(sigma x0)
 * - volume [1]: bridge volume over R^3 (constant)
 * - contact_angle [rad]: contact angle of the liquid on the sphere
 * - glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
 * - elastic_gap [x0]: elastic length over film thickness
 * - rough_gap [x0]: roughness over film thickness
 * - rupture_gap [x0]: rupture distance over film thickness
 * - dry_restitution [1]: restitution of the dry contact
 *
 * Law slots: film, glass, shear, bridge.
 *
 * Products of series: 7 and those of the laws. */

#define OBLIQUE 1
#define BRIDGE 1
#define STRINGS 0
#define REDUCED 1
#define ATTRACTION 0
#define SPREAD 0
#define WALL 0
#define SPACE 0
#if defined(BRIDGE_FORCE_WORK)
#define CAPILLARY_STATE 0
#else
#define CAPILLARY_STATE 1 /* no closed form, or a ledger: the work is a state */
#endif
#define TURNING_STATE (WITH_ROTATION && 1)
#define LEDGER_STATES 0
/* Index of coefficient k of a series used in sums only; the cases listed also read past coefficients. */
#define PASSING(k) (GRADIENTS || WITH_LEDGER || CAPILLARY_STATE ? (k) : 0)

enum { GAP, NORMAL_VELOCITY, ORBITAL_MOMENTUM, MODEL_STATES };
enum { STATES = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE + LEDGER_STATES };
enum { CAPILLARY_WORK = MODEL_STATES, TURNED = MODEL_STATES + CAPILLARY_STATE };
enum { GROUPS = 13 };

typedef struct {
    vec stokes; /* Stokes number m v0/(6 pi mu a^2) */
    vec aspect; /* film thickness over reduced radius, x0/a */
    vec obliquity; /* largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0 */
    vec initial_turning; /* tan(theta0)/T, 1 without spins */
    vec initial_spin; /* spin at initial contact over Omega */
    vec capillary; /* capillary number 3 mu a v0/(sigma x0) */
    vec volume; /* bridge volume over R^3 (constant) */
    vec contact_angle; /* contact angle of the liquid on the sphere */
    vec glass_number; /* glass-transition pressure over 3 mu a v0/x0^2 */
    vec elastic_gap; /* elastic length over film thickness */
    vec rough_gap; /* roughness over film thickness */
    vec rupture_gap; /* rupture distance over film thickness */
    vec dry_restitution; /* restitution of the dry contact */
    vec momentum;
    vec spin_offset;
    vec shear_force_factor;
    vec centrifugal_force_factor;
    vec film_force_factor;
    vec scaled_gap_per_gap;
    vec bridge_force_per_bridge_force_law;
    vec rate_of_rotation_per_orbital_rate;
    vec normal_velocity_2_per_normal_velocity;
    vec energy_per_distance_squared_by_orbital_rate_squared;
    vec energy_per_spin_squared;
    vec tangential_restitution_factor;
    vec energy_per_inverse_inertia_ratio;
    vec slope_per_distance_over_inertia_ratio_squared;
    vec contact;
    vec nearest;
    vec farthest;
    vec spun_up;
    vec rotation_energy_unit;
    vec relaxation_per_combination_by_shear_log_factor_law_over_distance;
    vec bridge_work_factor;
    vec edge;
    shear_log_factor_constants shear_log_factor_law;
    film_resistance_constants film_resistance_law;
    bridge_force_constants bridge_force_law;
    glass_pressure_clearance_constants glass;
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_SURFACE_TENSION, SI_SPEED, SI_ANGLE, SI_IMPACT_SPIN, SI_VOLUME, SI_CONTACT_ANGLE, QUANTITIES };
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
    "surface_tension "
    "speed "
    "angle "
    "impact_spin "
    "volume "
    "contact_angle";

#include "shared/scale_oblique_bridge.h"

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
    c->scaled_gap_per_gap = 0.5*c->aspect;
    c->bridge_force_per_bridge_force_law = 1.0/(c->capillary*c->stokes);
    c->rate_of_rotation_per_orbital_rate = 0.25*c->aspect*c->obliquity;
    c->normal_velocity_2_per_normal_velocity = -c->dry_restitution;
    c->energy_per_distance_squared_by_orbital_rate_squared = 0.03125*(c->obliquity*c->obliquity);
    c->energy_per_spin_squared = 0.2*(c->obliquity*c->obliquity);
    c->tangential_restitution_factor = 1.0/(c->initial_turning*(c->aspect + 4.0));
    c->energy_per_inverse_inertia_ratio = 0.03125*(c->momentum*c->momentum)*(c->obliquity*c->obliquity);
    c->slope_per_distance_over_inertia_ratio_squared =
        -0.0625*c->aspect*(c->momentum*c->momentum)*(c->obliquity*c->obliquity);
    c->contact = vec_larger(c->elastic_gap, c->rough_gap);
    c->nearest = c->aspect*c->contact + 4.0;
    c->farthest = c->aspect*c->rupture_gap + 4.0;
    c->spun_up = (c->farthest*c->farthest)*c->momentum/((c->farthest*c->farthest) + 6.4);
    c->rotation_energy_unit = 0.0625*(c->obliquity*c->obliquity);
    c->relaxation_per_combination_by_shear_log_factor_law_over_distance =
        0.041666666666666664*c->aspect/c->stokes;
    c->bridge_work_factor = 2.0/(c->aspect*c->capillary*c->stokes);
    c->edge = shear_edge(c->aspect);
    shear_log_factor_prepare(&c->shear_log_factor_law, c->aspect);
    film_resistance_prepare(&c->film_resistance_law);
    bridge_force_prepare(&c->bridge_force_law, c->volume, c->contact_angle);
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
    vec scaled_gap[TERMS];
    bridge_force_series bridge_force_law;
    vec bridge_force[PASSING(ORDER) + 1];
    vec rate_of_normal_velocity[PASSING(ORDER) + 1];
    vec rate_of_orbital_momentum[PASSING(ORDER) + 1];
    vec rate_of_rotation[PASSING(ORDER) + 1];
    vec rate_of_capillary[PASSING(ORDER) + 1];
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
    s->scaled_gap[k] = c->scaled_gap_per_gap*s->gap[k];
    bridge_force_next(&s->bridge_force_law, &c->bridge_force_law, s->scaled_gap, k);
    s->bridge_force[PASSING(k)] = c->bridge_force_per_bridge_force_law*s->bridge_force_law.result[k];
    s->rate_of_normal_velocity[PASSING(k)] = s->centrifugal_force[PASSING(k)] - s->bridge_force[PASSING(k)] -
        s->film_force[PASSING(k)];
    s->rate_of_orbital_momentum[PASSING(k)] = -product(s->distance, s->shear_force, k);
    s->rate_of_rotation[PASSING(k)] = c->rate_of_rotation_per_orbital_rate*s->orbital_rate[k];
#if CAPILLARY_STATE
    s->rate_of_capillary[PASSING(k)] = product(s->normal_velocity, s->bridge_force, k);
#endif
    double next = 1.0/(k + 1);
    s->gap[k + 1] = s->normal_velocity[k]*next;
    s->acceleration[k] = s->rate_of_normal_velocity[PASSING(k)];
    s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);
    s->orbital_momentum[k + 1] = s->rate_of_orbital_momentum[PASSING(k)]*next;
#if CAPILLARY_STATE
    s->capillary_work[k + 1] = s->rate_of_capillary[PASSING(k)]*next;
#endif
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

#include "shared/inward_force_oblique_bridge.h"

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
    vec scaled_gap = c->scaled_gap_per_gap*y[GAP];
    vec bridge_force_law = bridge_force_value(&c->bridge_force_law, scaled_gap);
    vec bridge_force = c->bridge_force_per_bridge_force_law*bridge_force_law;
    vec inertia_ratio_squared = inertia_ratio*inertia_ratio;
    vec distance_over_inertia_ratio_squared = distance/inertia_ratio_squared;
    vec slope = c->slope_per_distance_over_inertia_ratio_squared*distance_over_inertia_ratio_squared +
        bridge_force;
    return slope;
}

#include "shared/rigid_momentum_oblique_reduced.h"

#include "shared/surface_slip_oblique_reduced.h"

#if defined(BRIDGE_FORCE_FALLS)
#define ATTRACTION_MARGINS (1)
/* Margins of the attraction certificate (lever arm at mid-gap, forces that decrease with the gap): hold > 0,
 * escape < 0 and rebound < 0 exclude separation. */
static inline void attraction_margins(const constants *c, const vec *y, vec *hold_margin, vec *escape, vec
    *rebound)
{
    vec largest_momentum = vec_larger(vec_larger(vec_larger(y[ORBITAL_MOMENTUM], c->spun_up),
        -y[ORBITAL_MOMENTUM]), -c->spun_up);
    vec least_attraction = bridge_force_value(&c->bridge_force_law,
        0.5*c->aspect*c->rupture_gap)/(c->capillary*c->stokes);
    vec hold = least_attraction -
        0.0625*c->aspect*(largest_momentum*largest_momentum)*(c->obliquity*c->obliquity)/(c->nearest*c->nearest*c->nearest);
    *hold_margin = hold;
    *escape = 0.5*(vec_larger(y[NORMAL_VELOCITY],
        -c->dry_restitution*y[NORMAL_VELOCITY])*vec_larger(y[NORMAL_VELOCITY],
        -c->dry_restitution*y[NORMAL_VELOCITY])) - hold*(c->rupture_gap - y[GAP]);
    *rebound = (c->dry_restitution*c->dry_restitution)*least_attraction - hold;
}
#else
#define ATTRACTION_MARGINS 0
#endif

#define ORBITAL_MARGINS (LIBRARY_LAWS)
/* Slip omega - xi at this gap, and the slip energy over m v0^2 that shear can still transfer before it (lever
 * arm at mid-gap). */
static inline void transferable(const constants *c, const vec *y, vec *slip_margin, vec *slip_energy)
{
    vec distance = c->aspect*y[GAP] + 4.0;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/(distance*distance);
    vec spin = 0.15625*c->momentum - 0.15625*y[ORBITAL_MOMENTUM];
    vec slip = orbital_rate - spin;
    *slip_margin = slip;
    *slip_energy = 0.5*c->rotation_energy_unit*(0.15625 +
        1.0/(distance*distance))*((vec_larger(vec_smaller(splat(0.0), (distance*distance)*(y[ORBITAL_MOMENTUM]
        + 6.4*spin)/((distance*distance) + 6.4)), vec_smaller(y[ORBITAL_MOMENTUM], vec_larger(splat(0.0),
        (distance*distance)*(y[ORBITAL_MOMENTUM] + 6.4*spin)/((distance*distance) + 6.4)))) -
        (distance*distance)*(y[ORBITAL_MOMENTUM] + 6.4*spin)/((distance*distance) +
        6.4))*(vec_larger(vec_smaller(splat(0.0), (distance*distance)*(y[ORBITAL_MOMENTUM] +
        6.4*spin)/((distance*distance) + 6.4)), vec_smaller(y[ORBITAL_MOMENTUM], vec_larger(splat(0.0),
        (distance*distance)*(y[ORBITAL_MOMENTUM] + 6.4*spin)/((distance*distance) + 6.4)))) -
        (distance*distance)*(y[ORBITAL_MOMENTUM] + 6.4*spin)/((distance*distance) + 6.4)));
}

#if defined(BRIDGE_FORCE_FALLS) && defined(FILM_RESISTANCE_FALLS) && defined(SHEAR_LOG_FACTOR_FALLS) && !defined(FILM_CAVITATES)
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
    vec scaled_gap[TERMS];
    bridge_force_series bridge_force_law;
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
    s->scaled_gap[k] = c->scaled_gap_per_gap*s->gap[k];
    bridge_force_next(&s->bridge_force_law, &c->bridge_force_law, s->scaled_gap, k);
    s->attractions[k] = c->bridge_force_per_bridge_force_law*s->bridge_force_law.result[k];
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

#if !CAPILLARY_STATE
/* Capillary work up to a gap over m v0^2, from a fixed but arbitrary gap. */
static inline vec capillary_work(const constants *c, vec gap)
{
    return c->bridge_work_factor*bridge_force_work(&c->bridge_force_law, c->scaled_gap_per_gap*gap);
}
#endif

/* Gap beyond which there is no tangential force. */
static inline vec tangential_edge(const constants *c)
{
    return c->edge;
}
