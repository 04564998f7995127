/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 1f44a1259a45572cf6def3abc32cbad9e13b200f1fbe8462be3b24ff9402c492 */

/* Head-on doublet with a liquid bridge.
 *
 * Time in x0/v0. States (per unit):
 * - gap [x0]: gap over film thickness
 * - normal_velocity [v0]: normal velocity over impact speed, negative on approach
 *
 * Groups:
 * - stokes [1]: Stokes number m v0/(6 pi mu a^2)
 * - aspect [1]: film thickness over reduced radius, x0/a
 * - capillary [1]: capillary number 3 mu a v0/(sigma x0)
 * - volume [1]: bridge volume over R^3 (constant)
 * - contact_angle [rad]: contact angle of the liquid on the sphere
 * - glass_number [1]: glass-transition pressure over 3 mu a v0/x0^2
 * - elastic_gap [x0]: elastic length over film thickness
 * - rough_gap [x0]: roughness over film thickness
 * - rupture_gap [x0]: rupture distance over film thickness
 * - dry_restitution [1]: restitution of the dry contact
 *
 * Law slots: film, glass, bridge.
 *
 * Products of series: 2 and those of the laws. */

#define OBLIQUE 0
#define BRIDGE 1
#define STRINGS 0
#define REDUCED 0
#define ATTRACTION 0
#define SPREAD 0
#define WALL 0
#define SPACE 0
#if defined(BRIDGE_FORCE_WORK) && !WITH_LEDGER
#define CAPILLARY_STATE 0
#else
#define CAPILLARY_STATE 1 /* no closed form, or a ledger: the work is a state */
#endif
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
enum { GROUPS = 10 };

#if WITH_LEDGER
typedef struct {
    vec dry_contact_per_normal_velocity_squared;
} ledger_constants;

#endif
typedef struct {
    vec stokes; /* Stokes number m v0/(6 pi mu a^2) */
    vec aspect; /* film thickness over reduced radius, x0/a */
    vec capillary; /* capillary number 3 mu a v0/(sigma x0) */
    vec volume; /* bridge volume over R^3 (constant) */
    vec contact_angle; /* contact angle of the liquid on the sphere */
    vec glass_number; /* glass-transition pressure over 3 mu a v0/x0^2 */
    vec elastic_gap; /* elastic length over film thickness */
    vec rough_gap; /* roughness over film thickness */
    vec rupture_gap; /* rupture distance over film thickness */
    vec dry_restitution; /* restitution of the dry contact */
    vec film_force_factor;
    vec scaled_gap_per_gap;
    vec bridge_force_per_bridge_force_law;
    vec normal_velocity_2_per_normal_velocity;
    vec bridge_work_factor;
    film_resistance_constants film_resistance_law;
    bridge_force_constants bridge_force_law;
    glass_pressure_clearance_constants glass;
#if WITH_LEDGER
    ledger_constants ledger;
#endif
} constants;

enum { SI_REDUCED_RADIUS, SI_REDUCED_MASS, SI_ROUGHNESS, SI_DRY_RESTITUTION, SI_YOUNGS_MODULUS, SI_POISSON_RATIO, SI_VISCOSITY, SI_FILM_THICKNESS, SI_GLASS_TRANSITION_PRESSURE, SI_SURFACE_TENSION, SI_SPEED, SI_VOLUME, SI_CONTACT_ANGLE, QUANTITIES };
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
    "volume "
    "contact_angle";

/* The groups of a collision from its quantities in SI. */
static inline void scale(constants *c, const vec *q)
{
    c->stokes =
        0.16666666666666666*q[SI_REDUCED_MASS]*q[SI_SPEED]/(3.141592653589793*(q[SI_REDUCED_RADIUS]*q[SI_REDUCED_RADIUS])*q[SI_VISCOSITY]);
    c->aspect = q[SI_FILM_THICKNESS]/q[SI_REDUCED_RADIUS];
    c->capillary =
        3.0*q[SI_REDUCED_RADIUS]*q[SI_SPEED]*q[SI_VISCOSITY]/(q[SI_FILM_THICKNESS]*q[SI_SURFACE_TENSION]);
    c->volume = q[SI_VOLUME];
    c->contact_angle = q[SI_CONTACT_ANGLE];
    c->glass_number =
        0.3333333333333333*(q[SI_FILM_THICKNESS]*q[SI_FILM_THICKNESS])*q[SI_GLASS_TRANSITION_PRESSURE]/(q[SI_REDUCED_RADIUS]*q[SI_SPEED]*q[SI_VISCOSITY]);
    c->elastic_gap =
        1.148698354997035*1.5518455739153596*vec_exp(0.6*vec_log(q[SI_REDUCED_RADIUS]))*vec_exp(0.4*vec_log(q[SI_SPEED]*q[SI_VISCOSITY]*(1.0
        - (q[SI_POISSON_RATIO]*q[SI_POISSON_RATIO]))/q[SI_YOUNGS_MODULUS]))/q[SI_FILM_THICKNESS];
    c->rough_gap = q[SI_ROUGHNESS]/q[SI_FILM_THICKNESS];
    c->rupture_gap = 2.0*q[SI_REDUCED_RADIUS]*(0.5*q[SI_CONTACT_ANGLE] +
        1.0)*vec_exp(0.3333333333333333*vec_log(q[SI_VOLUME]))/q[SI_FILM_THICKNESS];
    c->dry_restitution = q[SI_DRY_RESTITUTION];
#if OWN_RUPTURE
    c->rupture_gap = 2.0*q[SI_REDUCED_RADIUS]*bridge_rupture_distance(q[SI_VOLUME],
        q[SI_CONTACT_ANGLE])/q[SI_FILM_THICKNESS];
#endif
}

/* Constants computed once per collision from its groups. */
static inline void prepare(constants *c)
{
    c->film_force_factor = 1.0/c->stokes;
    c->scaled_gap_per_gap = 0.5*c->aspect;
    c->bridge_force_per_bridge_force_law = 1.0/(c->capillary*c->stokes);
    c->normal_velocity_2_per_normal_velocity = -c->dry_restitution;
    c->bridge_work_factor = 2.0/(c->aspect*c->capillary*c->stokes);
    film_resistance_prepare(&c->film_resistance_law);
    bridge_force_prepare(&c->bridge_force_law, c->volume, c->contact_angle);
    glass_pressure_clearance_prepare(&c->glass, c->glass_number);
#if WITH_LEDGER
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
    vec scaled_gap[TERMS];
    bridge_force_series bridge_force_law;
    vec bridge_force[PASSING(ORDER) + 1];
    vec rate_of_normal_velocity[PASSING(ORDER) + 1];
    vec rate_of_capillary[PASSING(ORDER) + 1];
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
    s->scaled_gap[k] = c->scaled_gap_per_gap*s->gap[k];
    bridge_force_next(&s->bridge_force_law, &c->bridge_force_law, s->scaled_gap, k);
    s->bridge_force[PASSING(k)] = c->bridge_force_per_bridge_force_law*s->bridge_force_law.result[k];
    s->rate_of_normal_velocity[PASSING(k)] = -s->bridge_force[PASSING(k)] - s->film_force[PASSING(k)];
#if CAPILLARY_STATE
    s->rate_of_capillary[PASSING(k)] = product(s->normal_velocity, s->bridge_force, k);
#endif
    double next = 1.0/(k + 1);
    s->gap[k + 1] = s->normal_velocity[k]*next;
    s->acceleration[k] = s->rate_of_normal_velocity[PASSING(k)];
    s->normal_velocity[k + 1] = only(moving, s->acceleration[k]*next);
#if CAPILLARY_STATE
    s->capillary_work[k + 1] = s->rate_of_capillary[PASSING(k)]*next;
#endif
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
    vec scaled_gap = c->scaled_gap_per_gap*y[GAP];
    vec bridge_force_law = bridge_force_value(&c->bridge_force_law, scaled_gap);
    vec bridge_force = c->bridge_force_per_bridge_force_law*bridge_force_law;
    return bridge_force;
}

#include "shared/stored_energy_head_on.h"

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
    return splat(0.0);
}

/* Least energy over m v0^2 at this gap and angular momentum, without the capillary work, and the slope of the
 * least energy along the gap, capillary work included. */
static inline vec potential_slope(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec scaled_gap = c->scaled_gap_per_gap*y[GAP];
    vec bridge_force_law = bridge_force_value(&c->bridge_force_law, scaled_gap);
    vec bridge_force = c->bridge_force_per_bridge_force_law*bridge_force_law;
    return bridge_force;
}

#define SLOW_MANIFOLD 0

#if !CAPILLARY_STATE
/* Capillary work up to a gap over m v0^2, from a fixed but arbitrary gap. */
static inline vec capillary_work(const constants *c, vec gap)
{
    return c->bridge_work_factor*bridge_force_work(&c->bridge_force_law, c->scaled_gap_per_gap*gap);
}
#endif

#if WITH_LEDGER
enum { ENERGIES = 1 };
/* Energies of the state over m v0^2. In order: kinetic. */
static inline void energies(const constants *c, const vec *y, vec *energy)
{
    (void)c; (void)y;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec kinetic = 0.5*normal_velocity_squared;
    energy[0] = kinetic;
}

#include "shared/rebound_loss_head_on.h"

/* No angular momentum is conserved. */
static inline vec booked_momentum(const constants *c, const vec *y)
{
    (void)c; (void)y;
    return splat(1.0);
}
#endif
