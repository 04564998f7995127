/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 de6daef125dd7ea2f65f69c13d393df6e958d5ae294d4113eea61b7d054f82cc */

/* Oblique doublet with pendulum strings.
 *
 * Time in x0/v0. States (per unit):
 * - gap [x0]: gap over film thickness
 * - normal_velocity [v0]: normal velocity over impact speed, negative on approach
 * - orbital_momentum [a^2 Omega]: orbital angular momentum r^2 omega over a^2 Omega
 * - spin [Omega]: spin of each sphere over its scale Omega
 * - rotation [rad]: angle turned by the line of centres
 *
 * Groups:
 * - stokes [1]: Stokes number m v0/(6 pi mu a^2)
 * - aspect [1]: film thickness over reduced radius, x0/a
 * - obliquity [1]: largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0
 * - initial_turning [1]: tan(theta0)/T, 1 without spins
 * - initial_spin [Omega]: spin at initial contact over Omega
 * - weight [1]: gravity over impact deceleration, g x0/v0^2
 * - string_ratio [1]: string length over reduced radius
 * - glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
 * - elastic_gap [x0]: elastic length over film thickness
 * - rough_gap [x0]: roughness over film thickness
 * - dry_restitution [1]: restitution of the dry contact
 *
 * Law slots: film, glass, shear, arm, strings.
 *
 * Products of series: 12.5 and those of the laws. */

#define OBLIQUE 1
#define BRIDGE 0
#define STRINGS 1
#define REDUCED 0
#define ATTRACTION 0
#define SPREAD 0
#define WALL 0
#define SPACE 0
#define CAPILLARY_STATE 0
#define TURNING_STATE (WITH_ROTATION && 0)
#if WITH_LEDGER
#define LEDGER_STATES 2
#else
#define LEDGER_STATES 0
#endif
/* Index of coefficient k of a series used in sums only; the cases listed also read past coefficients. */
#define PASSING(k) (GRADIENTS || WITH_LEDGER || CAPILLARY_STATE ? (k) : 0)

enum { GAP, NORMAL_VELOCITY, ORBITAL_MOMENTUM, SPIN, ROTATION, MODEL_STATES };
enum { STATES = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE + LEDGER_STATES };
enum { CAPILLARY_WORK = MODEL_STATES, TURNED = MODEL_STATES + CAPILLARY_STATE };
#if WITH_LEDGER
enum { NORMAL_LOSS = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE, TANGENTIAL_LOSS };
#define TANGENTIAL 1
#endif
enum { GROUPS = 11 };

#if WITH_LEDGER
typedef struct {
    vec rate_of_tangential_loss_factor;
    vec kinetic_per_distance_squared_by_orbital_rate_squared;
    vec kinetic_per_spin_squared;
    vec strings_per_strings_rise_law;
    vec dry_contact_per_normal_velocity_squared;
    vec combination_offset;
    vec angular_momentum_per_combination;
} ledger_constants;

#endif
typedef struct {
    vec stokes; /* Stokes number m v0/(6 pi mu a^2) */
    vec aspect; /* film thickness over reduced radius, x0/a */
    vec obliquity; /* largest of tan(theta0) and R_i |xi_i|/v0: the scale of tangential speeds over v0 */
    vec initial_turning; /* tan(theta0)/T, 1 without spins */
    vec initial_spin; /* spin at initial contact over Omega */
    vec weight; /* gravity over impact deceleration, g x0/v0^2 */
    vec string_ratio; /* string length over reduced radius */
    vec glass_number; /* glass-transition pressure over 3 mu a v0/x0^2 */
    vec elastic_gap; /* elastic length over film thickness */
    vec rough_gap; /* roughness over film thickness */
    vec dry_restitution; /* restitution of the dry contact */
    vec shear_force_factor;
    vec centrifugal_force_factor;
    vec film_force_factor;
    vec offset_squared_per_gap_squared;
    vec string_sideways_factor;
    vec rate_of_rotation_per_orbital_rate;
    vec normal_velocity_2_per_normal_velocity;
    vec energy_per_distance_squared_by_orbital_rate_squared;
    vec energy_per_spin_squared;
    vec energy_per_strings_rise_law;
    vec tangential_restitution_factor;
    vec contact;
    vec nearest;
    vec farthest;
    vec part_ratio;
    vec edge;
    shear_log_factor_constants shear_log_factor_law;
    film_resistance_constants film_resistance_law;
    strings_stiffness_constants strings_stiffness_law;
    arm_lever_constants arm_lever_law;
    strings_rise_constants strings_rise_law;
    glass_pressure_clearance_constants glass;
#if WITH_LEDGER
    ledger_constants ledger;
#endif
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_STRING_LENGTH, SI_GRAVITY, SI_SPEED, SI_ANGLE, SI_IMPACT_SPIN, QUANTITIES };
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
    "string_length "
    "gravity "
    "speed "
    "angle "
    "impact_spin";

/* The groups of a collision from its quantities in SI. */
static inline void scale(constants *c, const vec *q)
{
    c->stokes =
        0.16666666666666666*q[SI_REDUCED_MASS]*q[SI_SPEED]/(3.141592653589793*(q[SI_REDUCED_RADIUS]*q[SI_REDUCED_RADIUS])*q[SI_VISCOSITY]);
    c->aspect = q[SI_FILM_THICKNESS]/q[SI_REDUCED_RADIUS];
    c->obliquity = vec_larger(vec_tan(q[SI_ANGLE]),
        2.0*q[SI_REDUCED_RADIUS]*vec_abs(q[SI_IMPACT_SPIN])/q[SI_SPEED]);
    c->initial_turning = vec_tan(q[SI_ANGLE])/c->obliquity;
    c->initial_spin = 4.0*q[SI_IMPACT_SPIN]*q[SI_REDUCED_RADIUS]/(c->obliquity*q[SI_SPEED]);
    c->weight = q[SI_FILM_THICKNESS]*q[SI_GRAVITY]/(q[SI_SPEED]*q[SI_SPEED]);
    c->string_ratio = q[SI_STRING_LENGTH]/q[SI_REDUCED_RADIUS];
    c->glass_number =
        0.3333333333333333*(q[SI_FILM_THICKNESS]*q[SI_FILM_THICKNESS])*q[SI_GLASS_TRANSITION_PRESSURE]/(q[SI_REDUCED_RADIUS]*q[SI_SPEED]*q[SI_VISCOSITY]);
    c->elastic_gap =
        1.148698354997035*1.5518455739153596*vec_exp(0.6*vec_log(q[SI_REDUCED_RADIUS]))*vec_exp(0.4*vec_log(q[SI_SPEED]*q[SI_VISCOSITY]*(1.0
        - (q[SI_POISSON_RATIO]*q[SI_POISSON_RATIO]))/q[SI_YOUNGS_MODULUS]))/q[SI_FILM_THICKNESS];
    c->rough_gap = q[SI_ROUGHNESS]/q[SI_FILM_THICKNESS];
    c->dry_restitution = q[SI_DRY_RESTITUTION];
}

/* Omega, the unit of angular velocities, in rad/s. */
static inline vec rate_scale(const constants *c, const vec *q)
{
    return 0.25*c->obliquity*q[SI_SPEED]/q[SI_REDUCED_RADIUS];
}

/* Constants computed once per collision from its groups. */
static inline void prepare(constants *c)
{
    c->shear_force_factor = 1.3333333333333333*c->aspect/c->stokes;
    c->centrifugal_force_factor = 0.0625*c->aspect*(c->obliquity*c->obliquity);
    c->film_force_factor = 1.0/c->stokes;
    c->offset_squared_per_gap_squared = 0.25*(c->aspect*c->aspect);
    c->string_sideways_factor = 16.0*c->weight/c->obliquity;
    c->rate_of_rotation_per_orbital_rate = 0.25*c->aspect*c->obliquity;
    c->normal_velocity_2_per_normal_velocity = -c->dry_restitution;
    c->energy_per_distance_squared_by_orbital_rate_squared = 0.03125*(c->obliquity*c->obliquity);
    c->energy_per_spin_squared = 0.2*(c->obliquity*c->obliquity);
    c->energy_per_strings_rise_law = 4.0*c->weight/c->aspect;
    c->tangential_restitution_factor = 1.0/(c->initial_turning*(c->aspect + 4.0));
    c->contact = vec_larger(c->elastic_gap, c->rough_gap);
    c->nearest = c->aspect*c->contact + 4.0;
    c->farthest = c->aspect + 4.0;
    c->part_ratio = vec_exp(0.041666666666666664*vec_log(vec_larger(vec_larger(splat(0.01), c->elastic_gap),
        c->rough_gap)));
    c->edge = shear_edge(c->aspect);
    shear_log_factor_prepare(&c->shear_log_factor_law, c->aspect);
    film_resistance_prepare(&c->film_resistance_law);
    strings_stiffness_prepare(&c->strings_stiffness_law, c->string_ratio);
    arm_lever_prepare(&c->arm_lever_law);
    strings_rise_prepare(&c->strings_rise_law, c->string_ratio);
    glass_pressure_clearance_prepare(&c->glass, c->glass_number);
#if WITH_LEDGER
    c->ledger.rate_of_tangential_loss_factor = 0.0625*(c->obliquity*c->obliquity);
    c->ledger.kinetic_per_distance_squared_by_orbital_rate_squared = 0.03125*(c->obliquity*c->obliquity);
    c->ledger.kinetic_per_spin_squared = 0.2*(c->obliquity*c->obliquity);
    c->ledger.strings_per_strings_rise_law = 4.0*c->weight/c->aspect;
    c->ledger.dry_contact_per_normal_velocity_squared = 0.5 - 0.5*(c->dry_restitution*c->dry_restitution);
    c->ledger.combination_offset = -6.4*c->initial_spin - c->initial_turning*((c->aspect + 4.0)*(c->aspect +
        4.0));
    c->ledger.angular_momentum_per_combination = 1.0/(c->initial_turning*((c->aspect + 4.0)*(c->aspect + 4.0))
        + 6.4*vec_abs(c->initial_spin));
#endif
}

typedef struct {
    vec gap[TERMS]; /* gap over film thickness */
    vec normal_velocity[TERMS]; /* normal velocity over impact speed, negative on approach */
    vec orbital_momentum[TERMS]; /* orbital angular momentum r^2 omega over a^2 Omega */
    vec spin[TERMS]; /* spin of each sphere over its scale Omega */
    vec rotation[TERMS]; /* angle turned by the line of centres */
#if CAPILLARY_STATE
    vec capillary_work[TERMS];
#endif
#if TURNING_STATE
    vec turned[TERMS];
#endif
#if WITH_LEDGER
    vec normal_loss[TERMS]; /* energy dissipated by the normal force of the film, over m v0^2 */
    vec tangential_loss[TERMS]; /* energy dissipated by the tangential force, over m v0^2 */
#endif
    vec distance[TERMS];
    vec distance_squared[TERMS];
    vec orbital_rate[TERMS];
    vec over_orbital_rate;
    vec slip[TERMS];
    shear_log_factor_series shear_log_factor_law;
    vec shear_force[TERMS];
    vec orbital_rate_squared[TERMS];
    vec centrifugal_force[PASSING(ORDER) + 1];
    film_resistance_series film_resistance_law;
    vec film_force[PASSING(ORDER) + 1];
    vec gap_squared[PASSING(ORDER) + 1];
    vec sine_of_rotation[TERMS], slope_of_rotation[TERMS];
    vec cosine_of_rotation[TERMS];
    vec combination[TERMS];
    vec distance_by_combination[PASSING(ORDER) + 1];
    vec offset_squared[TERMS];
    vec combination_2[TERMS];
    strings_stiffness_series strings_stiffness_law;
    vec string_pull[PASSING(ORDER) + 1];
    vec string_sideways[PASSING(ORDER) + 1];
    arm_lever_series arm_lever_law;
    vec rate_of_normal_velocity[PASSING(ORDER) + 1];
    vec combination_3[TERMS];
    vec rate_of_orbital_momentum[PASSING(ORDER) + 1];
    vec rate_of_spin[PASSING(ORDER) + 1];
    vec rate_of_rotation[PASSING(ORDER) + 1];
#if WITH_LEDGER
    vec rate_of_normal_loss[TERMS];
    vec distance_by_orbital_rate[TERMS];
    vec arm_lever_law_by_spin[TERMS];
    vec combination_4[TERMS];
    vec rate_of_tangential_loss[TERMS];
#endif
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
    s->slip[k] = s->orbital_rate[k] - s->spin[k];
    shear_log_factor_next(&s->shear_log_factor_law, &c->shear_log_factor_law, s->gap, k);
    s->shear_force[k] = shear*c->shear_force_factor*product(s->slip, s->shear_log_factor_law.result, k);
    s->orbital_rate_squared[k] = square(s->orbital_rate, k);
    s->centrifugal_force[PASSING(k)] = c->centrifugal_force_factor*product(s->distance,
        s->orbital_rate_squared, k);
    film_resistance_next(&s->film_resistance_law, &c->film_resistance_law, s->gap, k);
    s->film_force[PASSING(k)] = film*c->film_force_factor*product(s->normal_velocity,
        s->film_resistance_law.result, k);
    s->gap_squared[PASSING(k)] = square(s->gap, k);
    circular(s->rotation, s->slope_of_rotation, s->sine_of_rotation, s->cosine_of_rotation, k);
    /* cosine_of_rotation comes with its sine */
    s->combination[k] = k == 0 ? -0.5*s->cosine_of_rotation[k] + 0.5 : -0.5*s->cosine_of_rotation[k];
    s->distance_by_combination[PASSING(k)] = product(s->distance, s->combination, k);
    s->offset_squared[k] = c->offset_squared_per_gap_squared*s->gap_squared[PASSING(k)] +
        4.0*s->distance_by_combination[PASSING(k)];
    s->combination_2[k] = c->aspect*s->gap[k] + 8.0*s->combination[k];
    strings_stiffness_next(&s->strings_stiffness_law, &c->strings_stiffness_law, s->offset_squared, k);
    s->string_pull[PASSING(k)] = c->weight*product(s->combination_2, s->strings_stiffness_law.result, k);
    s->string_sideways[PASSING(k)] = c->string_sideways_factor*product(s->sine_of_rotation,
        s->strings_stiffness_law.result, k);
    arm_lever_next(&s->arm_lever_law, &c->arm_lever_law, s->distance, k);
    s->rate_of_normal_velocity[PASSING(k)] = s->centrifugal_force[PASSING(k)] - s->film_force[PASSING(k)] -
        s->string_pull[PASSING(k)];
    s->combination_3[k] = s->shear_force[k] + s->string_sideways[PASSING(k)];
    s->rate_of_orbital_momentum[PASSING(k)] = -product(s->distance, s->combination_3, k);
    s->rate_of_spin[PASSING(k)] = 0.3125*product(s->shear_force, s->arm_lever_law.result, k);
    s->rate_of_rotation[PASSING(k)] = c->rate_of_rotation_per_orbital_rate*s->orbital_rate[k];
    double next = 1.0/(k + 1);
    s->gap[k + 1] = s->normal_velocity[k]*next;
    s->acceleration[k] = s->rate_of_normal_velocity[PASSING(k)];
    s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);
    s->orbital_momentum[k + 1] = s->rate_of_orbital_momentum[PASSING(k)]*next;
    s->spin[k + 1] = s->rate_of_spin[PASSING(k)]*next;
    s->rotation[k + 1] = s->rate_of_rotation[PASSING(k)]*next;
#if WITH_LEDGER
    s->rate_of_normal_loss[k] = product(s->film_force, s->normal_velocity, k);
    s->distance_by_orbital_rate[k] = product(s->distance, s->orbital_rate, k);
    s->arm_lever_law_by_spin[k] = product(s->arm_lever_law.result, s->spin, k);
    s->combination_4[k] = s->distance_by_orbital_rate[k] - 2.0*s->arm_lever_law_by_spin[k];
    s->rate_of_tangential_loss[k] = c->ledger.rate_of_tangential_loss_factor*product(s->shear_force,
        s->combination_4, k);
    s->normal_loss[k + 1] = s->rate_of_normal_loss[k]*next;
    s->tangential_loss[k + 1] = s->rate_of_tangential_loss[k]*next;
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

/* State at initial contact. */
static inline void start(const constants *c, vec *y)
{
    (void)c; (void)y;
    y[GAP] = splat(1.0);
    y[NORMAL_VELOCITY] = splat((-1.0));
    y[ORBITAL_MOMENTUM] = c->initial_turning*((c->aspect + 4.0)*(c->aspect + 4.0));
    y[SPIN] = c->initial_spin;
    y[ROTATION] = splat(0.0);
}

/* State just after a rebound: u -> -e_dry u; the other states are continuous. */
static inline void rebound(const constants *c, const vec *y, vec *after)
{
    (void)c; (void)y;
    vec normal_velocity_2 = c->normal_velocity_2_per_normal_velocity*y[NORMAL_VELOCITY];
    after[GAP] = y[GAP];
    after[NORMAL_VELOCITY] = normal_velocity_2;
    after[ORBITAL_MOMENTUM] = y[ORBITAL_MOMENTUM];
    after[SPIN] = y[SPIN];
    after[ROTATION] = y[ROTATION];
}

/* Sum of the normal forces except the film's, over m v0^2/x0: positive inward. */
static inline vec inward_force(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec orbital_rate_squared = orbital_rate*orbital_rate;
    vec centrifugal_force = c->centrifugal_force_factor*distance*orbital_rate_squared;
    vec gap_squared = y[GAP]*y[GAP];
    vec scaled_rotation = 0.5*y[ROTATION];
    vec sine_of_scaled_rotation = vec_sin(scaled_rotation);
    vec sine_of_scaled_rotation_squared = sine_of_scaled_rotation*sine_of_scaled_rotation;
    vec distance_by_sine_of_scaled_rotation_squared = distance*sine_of_scaled_rotation_squared;
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared +
        4.0*distance_by_sine_of_scaled_rotation_squared;
    vec combination = c->aspect*y[GAP] + 8.0*sine_of_scaled_rotation_squared;
    vec strings_stiffness_law = strings_stiffness_value(&c->strings_stiffness_law, offset_squared);
    vec string_pull = c->weight*combination*strings_stiffness_law;
    vec inward_force = string_pull - centrifugal_force;
    return inward_force;
}

/* Energies of the state over m v0^2. Their sum. */
static inline vec stored_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec gap_squared = y[GAP]*y[GAP];
    vec scaled_rotation = 0.5*y[ROTATION];
    vec sine_of_scaled_rotation = vec_sin(scaled_rotation);
    vec sine_of_scaled_rotation_squared = sine_of_scaled_rotation*sine_of_scaled_rotation;
    vec distance_by_sine_of_scaled_rotation_squared = distance*sine_of_scaled_rotation_squared;
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared +
        4.0*distance_by_sine_of_scaled_rotation_squared;
    vec orbital_rate_squared = orbital_rate*orbital_rate;
    vec distance_squared_by_orbital_rate_squared = distance_squared*orbital_rate_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec spin_squared = y[SPIN]*y[SPIN];
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec energy =
        c->energy_per_distance_squared_by_orbital_rate_squared*distance_squared_by_orbital_rate_squared +
        0.5*normal_velocity_squared + c->energy_per_spin_squared*spin_squared +
        c->energy_per_strings_rise_law*strings_rise_law;
    return energy;
}

enum { OUTPUTS = 4 };
/* Results for a separated doublet: restitutions, and rates over their scale. */
static inline void outputs(const constants *c, const vec *y, vec *shown)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec tangential_restitution = c->tangential_restitution_factor*distance*orbital_rate;
    shown[0] = y[NORMAL_VELOCITY];
    shown[1] = tangential_restitution;
    shown[2] = orbital_rate;
    shown[3] = y[SPIN];
}

#include "shared/surface_slip_oblique.h"

#if defined(FILM_BRAKING) && defined(FILM_STOPPING) && defined(GLASS_REACH)
#define PENDULUM_MARGINS (MIDGAP_ARM)
/* The strings outweigh the rotation from now on if outward < pull (lever arm at mid-gap). */
static inline void pendulum_inward(const constants *c, const vec *y, vec *outward_margin, vec *pull_margin)
{
    vec momentum = y[ORBITAL_MOMENTUM] + 6.4*y[SPIN];
    vec spun_up = (c->farthest*c->farthest)*momentum/((c->farthest*c->farthest) + 6.4);
    vec largest_momentum = vec_larger(y[ORBITAL_MOMENTUM], spun_up);
    vec outward =
        0.0625*c->aspect*(largest_momentum*largest_momentum)*(c->obliquity*c->obliquity)/(c->nearest*c->nearest*c->nearest);
    vec pull = c->weight*(c->aspect*c->contact +
        8.0*(vec_sin(0.5*y[ROTATION])*vec_sin(0.5*y[ROTATION])))*strings_stiffness_value(&c->strings_stiffness_law,
        0.25*(c->aspect*c->aspect)*(c->contact*c->contact) + 4.0*(c->aspect*c->contact +
        4.0)*(vec_sin(0.5*y[ROTATION])*vec_sin(0.5*y[ROTATION])));
    *outward_margin = outward;
    *pull_margin = pull;
}
/* Bound of the outward impulse of all forces but the film's from now on. */
static inline void pendulum_impulse(const constants *c, const vec *y, vec *impulse)
{
    vec momentum = y[ORBITAL_MOMENTUM] + 6.4*y[SPIN];
    vec spun_up = (c->farthest*c->farthest)*momentum/((c->farthest*c->farthest) + 6.4);
    vec largest_momentum = vec_larger(y[ORBITAL_MOMENTUM], spun_up);
    vec outward =
        0.0625*c->aspect*(largest_momentum*largest_momentum)*(c->obliquity*c->obliquity)/(c->nearest*c->nearest*c->nearest);
    vec weighing = c->weight*strings_stiffness_value(&c->strings_stiffness_law,
        0.25*(c->aspect*c->aspect)*(c->contact*c->contact) + 4.0*(c->aspect*c->contact +
        4.0)*(vec_sin(0.5*y[ROTATION])*vec_sin(0.5*y[ROTATION])));
    vec scaled_momentum = largest_momentum*c->obliquity;
    vec decrease_by_cosine =
        640.0*(c->farthest*c->farthest)*(c->nearest*c->nearest*c->nearest)*weighing/(c->aspect*(5.0*(c->farthest*c->farthest)
        + 32.0));
    vec final_half_sine = vec_sqrt(vec_larger(splat(0.0), vec_smaller(splat(1.0), 0.125*outward/weighing -
        0.125*c->aspect*c->contact)));
    vec width = 0.125*vec_larger(splat(0.0),
        (final_half_sine*final_half_sine*final_half_sine)*1.1415926535897933 + 2.0*final_half_sine -
        y[ROTATION]);
    vec angle_0 = y[ROTATION];
    vec angle_1 = y[ROTATION] + width;
    vec angle_2 = y[ROTATION] + 2.0*width;
    vec angle_3 = y[ROTATION] + 3.0*width;
    vec angle_4 = y[ROTATION] + 4.0*width;
    vec angle_5 = y[ROTATION] + 5.0*width;
    vec angle_6 = y[ROTATION] + 6.0*width;
    vec angle_7 = y[ROTATION] + 7.0*width;
    vec scaled_momentum_0 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_0))));
    vec scaled_momentum_1 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_1))));
    vec scaled_momentum_2 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_2))));
    vec scaled_momentum_3 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_3))));
    vec scaled_momentum_4 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_4))));
    vec scaled_momentum_5 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_5))));
    vec scaled_momentum_6 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_6))));
    vec scaled_momentum_7 = vec_sqrt(vec_larger(splat(0.0), (scaled_momentum*scaled_momentum) -
        decrease_by_cosine*(vec_cos(y[ROTATION]) - vec_cos(angle_7))));
    *impulse = width*(vec_larger(splat(0.0), 0.25*(c->aspect*(scaled_momentum_0*scaled_momentum_0) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_0)))/(c->aspect*c->nearest*scaled_momentum_0)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_1*scaled_momentum_1) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_1)))/(c->aspect*c->nearest*scaled_momentum_1)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_2*scaled_momentum_2) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_2)))/(c->aspect*c->nearest*scaled_momentum_2)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_3*scaled_momentum_3) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_3)))/(c->aspect*c->nearest*scaled_momentum_3)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_4*scaled_momentum_4) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_4)))/(c->aspect*c->nearest*scaled_momentum_4)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_5*scaled_momentum_5) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_5)))/(c->aspect*c->nearest*scaled_momentum_5)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_6*scaled_momentum_6) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_6)))/(c->aspect*c->nearest*scaled_momentum_6)) + vec_larger(splat(0.0),
        0.25*(c->aspect*(scaled_momentum_7*scaled_momentum_7) -
        16.0*(c->nearest*c->nearest*c->nearest)*weighing*(c->aspect*c->contact + 4.0 -
        4.0*vec_cos(angle_7)))/(c->aspect*c->nearest*scaled_momentum_7)));
}
/* The film then stops the opening and every rebound if film < 0 and recoil < 0, the impulse added. */
static inline void pendulum_stops(const constants *c, const vec *y, vec *film, vec *recoil)
{
    vec largest_pull = c->weight*(c->aspect + 8.0)*strings_stiffness_value(&c->strings_stiffness_law,
        0.25*(c->aspect*c->aspect) + 4.0*c->aspect + 16.0);
    vec fastest = vec_sqrt(2.0*largest_pull + (vec_smaller(splat(0.0),
        y[NORMAL_VELOCITY])*vec_smaller(splat(0.0), y[NORMAL_VELOCITY])));
    vec reach = vec_larger(c->contact, glass_reach(fastest, c->glass_number));
    *film = y[NORMAL_VELOCITY]*c->stokes - film_stopping(y[GAP]);
    *recoil = c->dry_restitution*fastest*c->stokes - film_stopping(reach);
}
/* It stops a rebound from this gap and speed, or one from any smaller gap, if these are negative. */
static inline void pendulum_rebounds(const constants *c, const vec *y, vec *rebound, vec *beneath)
{
    vec largest_pull = c->weight*(c->aspect + 8.0)*strings_stiffness_value(&c->strings_stiffness_law,
        0.25*(c->aspect*c->aspect) + 4.0*c->aspect + 16.0);
    *rebound = -c->dry_restitution*y[NORMAL_VELOCITY]*c->stokes - film_stopping(y[GAP]);
    *beneath = c->dry_restitution*c->stokes*(1.4142135623730951*vec_sqrt(y[GAP])*vec_sqrt(largest_pull) -
        y[NORMAL_VELOCITY]) - film_stopping(y[GAP]);
}
/* Bounds over the next part of the film, from a gap and a bound of the closing speed there (the normal
 * velocity): the part's end, the largest speed there and within it. */
static inline void approach_step(const constants *c, const vec *y, vec *deeper_gap, vec *slowed, vec *fastest)
{
    vec largest_pull = c->weight*(c->aspect + 8.0)*strings_stiffness_value(&c->strings_stiffness_law,
        0.25*(c->aspect*c->aspect) + 4.0*c->aspect + 16.0);
    vec deeper = y[GAP]*c->part_ratio;
    vec path = y[GAP] - deeper;
    vec left = -y[NORMAL_VELOCITY] - (film_braking(deeper) - film_braking(y[GAP]))/c->stokes;
    vec gain = largest_pull*path/vec_larger(left,
        0.5*1.4142135623730951*vec_sqrt(largest_pull)*vec_sqrt(path));
    *deeper_gap = deeper;
    *slowed = gain + vec_larger(splat(0.0), left);
    *fastest = gain - y[NORMAL_VELOCITY];
}
#else
#define PENDULUM_MARGINS 0
#endif

#define SLOW_MANIFOLD 0

#if WITH_LEDGER
enum { ENERGIES = 2 };
/* Energies of the state over m v0^2. In order: kinetic, strings. */
static inline void energies(const constants *c, const vec *y, vec *energy)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec gap_squared = y[GAP]*y[GAP];
    vec scaled_rotation = 0.5*y[ROTATION];
    vec sine_of_scaled_rotation = vec_sin(scaled_rotation);
    vec sine_of_scaled_rotation_squared = sine_of_scaled_rotation*sine_of_scaled_rotation;
    vec distance_by_sine_of_scaled_rotation_squared = distance*sine_of_scaled_rotation_squared;
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared +
        4.0*distance_by_sine_of_scaled_rotation_squared;
    vec orbital_rate_squared = orbital_rate*orbital_rate;
    vec distance_squared_by_orbital_rate_squared = distance_squared*orbital_rate_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec spin_squared = y[SPIN]*y[SPIN];
    vec kinetic =
        c->ledger.kinetic_per_distance_squared_by_orbital_rate_squared*distance_squared_by_orbital_rate_squared
        + 0.5*normal_velocity_squared + c->ledger.kinetic_per_spin_squared*spin_squared;
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec strings = c->ledger.strings_per_strings_rise_law*strings_rise_law;
    energy[0] = kinetic;
    energy[1] = strings;
}

#include "shared/rebound_loss_head_on.h"

/* 1 + the change of the angular momentum over its size at initial contact. */
static inline vec booked_momentum(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec momentum = y[ORBITAL_MOMENTUM] + 6.4*y[SPIN];
    vec combination = momentum + c->ledger.combination_offset;
    vec angular_momentum = c->ledger.angular_momentum_per_combination*combination + 1.0;
    return angular_momentum;
}
#endif

/* Gap beyond which there is no tangential force. */
static inline vec tangential_edge(const constants *c)
{
    return c->edge;
}
