/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 f28e8cc4792a48c36b88dd16465fbe754866335ac5f30cbfec3a05a1aecfd715 */

/* Head-on doublet with pendulum strings.
 *
 * Time in x0/v0. States (per unit):
 * - gap [x0]: gap over film thickness
 * - normal_velocity [v0]: normal velocity over impact speed, negative on approach
 *
 * Groups:
 * - stokes [1]: Stokes number m v0/(6 pi mu a^2)
 * - aspect [1]: film thickness over reduced radius, x0/a
 * - weight [1]: gravity over impact deceleration, g x0/v0^2
 * - string_ratio [1]: string length over reduced radius
 * - glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
 * - elastic_gap [x0]: elastic length over film thickness
 * - rough_gap [x0]: roughness over film thickness
 * - dry_restitution [1]: restitution of the dry contact
 *
 * Law slots: film, glass, strings.
 *
 * Products of series: 2.5 and those of the laws. */

#define OBLIQUE 0
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
#define LEDGER_STATES 1
#else
#define LEDGER_STATES 0
#endif
/* Index of coefficient k of a series used in sums only; the cases listed also read past coefficients. */
#define PASSING(k) (GRADIENTS || WITH_LEDGER || CAPILLARY_STATE ? (k) : 0)

enum { GAP, NORMAL_VELOCITY, MODEL_STATES };
enum { STATES = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE + LEDGER_STATES };
enum { CAPILLARY_WORK = MODEL_STATES, TURNED = MODEL_STATES + CAPILLARY_STATE };
#if WITH_LEDGER
enum { NORMAL_LOSS = MODEL_STATES + CAPILLARY_STATE + TURNING_STATE };
#endif
enum { GROUPS = 8 };

#if WITH_LEDGER
typedef struct {
    vec strings_per_strings_rise_law;
    vec dry_contact_per_normal_velocity_squared;
} ledger_constants;

#endif
typedef struct {
    vec stokes; /* Stokes number m v0/(6 pi mu a^2) */
    vec aspect; /* film thickness over reduced radius, x0/a */
    vec weight; /* gravity over impact deceleration, g x0/v0^2 */
    vec string_ratio; /* string length over reduced radius */
    vec glass_number; /* glass-transition pressure over 3 mu a v0/x0^2 */
    vec elastic_gap; /* elastic length over film thickness */
    vec rough_gap; /* roughness over film thickness */
    vec dry_restitution; /* restitution of the dry contact */
    vec film_force_factor;
    vec offset_squared_per_gap_squared;
    vec string_pull_factor;
    vec normal_velocity_2_per_normal_velocity;
    vec energy_per_strings_rise_law;
    film_resistance_constants film_resistance_law;
    strings_stiffness_constants strings_stiffness_law;
    strings_rise_constants strings_rise_law;
    glass_pressure_clearance_constants glass;
#if WITH_LEDGER
    ledger_constants ledger;
#endif
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_STRING_LENGTH, SI_GRAVITY, SI_SPEED, QUANTITIES };
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
    "speed";

/* The groups of a collision from its quantities in SI. */
static inline void scale(constants *c, const vec *q)
{
    c->stokes =
        0.16666666666666666*q[SI_REDUCED_MASS]*q[SI_SPEED]/(3.141592653589793*(q[SI_REDUCED_RADIUS]*q[SI_REDUCED_RADIUS])*q[SI_VISCOSITY]);
    c->aspect = q[SI_FILM_THICKNESS]/q[SI_REDUCED_RADIUS];
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

/* Constants computed once per collision from its groups. */
static inline void prepare(constants *c)
{
    c->film_force_factor = 1.0/c->stokes;
    c->offset_squared_per_gap_squared = 0.25*(c->aspect*c->aspect);
    c->string_pull_factor = c->aspect*c->weight;
    c->normal_velocity_2_per_normal_velocity = -c->dry_restitution;
    c->energy_per_strings_rise_law = 4.0*c->weight/c->aspect;
    film_resistance_prepare(&c->film_resistance_law);
    strings_stiffness_prepare(&c->strings_stiffness_law, c->string_ratio);
    strings_rise_prepare(&c->strings_rise_law, c->string_ratio);
    glass_pressure_clearance_prepare(&c->glass, c->glass_number);
#if WITH_LEDGER
    c->ledger.strings_per_strings_rise_law = 4.0*c->weight/c->aspect;
    c->ledger.dry_contact_per_normal_velocity_squared = 0.5 - 0.5*(c->dry_restitution*c->dry_restitution);
#endif
}

typedef struct {
    vec gap[TERMS]; /* gap over film thickness */
    vec normal_velocity[TERMS]; /* normal velocity over impact speed, negative on approach */
#if CAPILLARY_STATE
    vec capillary_work[TERMS];
#endif
#if TURNING_STATE
    vec turned[TERMS];
#endif
#if WITH_LEDGER
    vec normal_loss[TERMS]; /* energy dissipated by the normal force of the film, over m v0^2 */
#endif
    film_resistance_series film_resistance_law;
    vec film_force[PASSING(ORDER) + 1];
    vec gap_squared[PASSING(ORDER) + 1];
    vec offset_squared[TERMS];
    strings_stiffness_series strings_stiffness_law;
    vec string_pull[PASSING(ORDER) + 1];
    vec rate_of_normal_velocity[PASSING(ORDER) + 1];
#if WITH_LEDGER
    vec rate_of_normal_loss[TERMS];
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
    film_resistance_next(&s->film_resistance_law, &c->film_resistance_law, s->gap, k);
    s->film_force[PASSING(k)] = film*c->film_force_factor*product(s->normal_velocity,
        s->film_resistance_law.result, k);
    s->gap_squared[PASSING(k)] = square(s->gap, k);
    s->offset_squared[k] = c->offset_squared_per_gap_squared*s->gap_squared[PASSING(k)];
    strings_stiffness_next(&s->strings_stiffness_law, &c->strings_stiffness_law, s->offset_squared, k);
    s->string_pull[PASSING(k)] = c->string_pull_factor*product(s->gap, s->strings_stiffness_law.result, k);
    s->rate_of_normal_velocity[PASSING(k)] = -s->film_force[PASSING(k)] - s->string_pull[PASSING(k)];
    double next = 1.0/(k + 1);
    s->gap[k + 1] = s->normal_velocity[k]*next;
    s->acceleration[k] = s->rate_of_normal_velocity[PASSING(k)];
    s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);
#if WITH_LEDGER
    s->rate_of_normal_loss[k] = product(s->film_force, s->normal_velocity, k);
    s->normal_loss[k + 1] = s->rate_of_normal_loss[k]*next;
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
}

#include "shared/rebound_head_on.h"

/* Sum of the normal forces except the film's, over m v0^2/x0: positive inward. */
static inline vec inward_force(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec gap_squared = y[GAP]*y[GAP];
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared;
    vec strings_stiffness_law = strings_stiffness_value(&c->strings_stiffness_law, offset_squared);
    vec string_pull = c->string_pull_factor*y[GAP]*strings_stiffness_law;
    return string_pull;
}

/* Energies of the state over m v0^2. Their sum. */
static inline vec stored_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec gap_squared = y[GAP]*y[GAP];
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec energy = 0.5*normal_velocity_squared + c->energy_per_strings_rise_law*strings_rise_law;
    return energy;
}

enum { OUTPUTS = 1 };
/* Results for a separated doublet: restitutions, and rates over their scale. */
static inline void outputs(const constants *c, const vec *y, vec *shown)
{
    (void)c; (void)y;
    shown[0] = y[NORMAL_VELOCITY];
}

#define POTENTIAL 1
/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static inline vec potential_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec gap_squared = y[GAP]*y[GAP];
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared;
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec energy = c->energy_per_strings_rise_law*strings_rise_law;
    return energy;
}

/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static inline vec potential_slope(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec gap_squared = y[GAP]*y[GAP];
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared;
    vec strings_stiffness_law = strings_stiffness_value(&c->strings_stiffness_law, offset_squared);
    vec string_pull = c->string_pull_factor*y[GAP]*strings_stiffness_law;
    return string_pull;
}

#define SLOW_MANIFOLD 0

#if WITH_LEDGER
enum { ENERGIES = 2 };
/* Energies of the state over m v0^2. In order: kinetic, strings. */
static inline void energies(const constants *c, const vec *y, vec *energy)
{
    (void)c; (void)y;
    vec gap_squared = y[GAP]*y[GAP];
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec kinetic = 0.5*normal_velocity_squared;
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec strings = c->ledger.strings_per_strings_rise_law*strings_rise_law;
    energy[0] = kinetic;
    energy[1] = strings;
}

#include "shared/rebound_loss_head_on.h"

/* No angular momentum is conserved. */
static inline vec booked_momentum(const constants *c, const vec *y)
{
    (void)c; (void)y;
    return splat(1.0);
}
#endif
