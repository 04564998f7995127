/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 1f44a1259a45572cf6def3abc32cbad9e13b200f1fbe8462be3b24ff9402c492 */

/* Tangent of head_on_bridge.h: derivatives of the states by the groups.
 *
 * Products of series: 2 and those of the laws, then 2 a direction; backwards 4 and those of the laws'
 * derivatives. */

enum { BY_STOKES, BY_ASPECT, BY_CAPILLARY, BY_VOLUME, BY_CONTACT_ANGLE, BY_GLASS_NUMBER, BY_ELASTIC_GAP, BY_ROUGH_GAP, BY_RUPTURE_GAP, BY_DRY_RESTITUTION };
const char group_names[] =
    "stokes "
    "aspect "
    "capillary "
    "volume "
    "contact_angle "
    "glass_number "
    "elastic_gap "
    "rough_gap "
    "rupture_gap "
    "dry_restitution";
/* Groups that the rates depend on; the others enter at an event. */
static const unsigned char FLOWS[GROUPS] = { 1, 1, 1, 1, 1, 0, 0, 0, 0, 0 };

#if BACKWARD
typedef struct {
    film_resistance_slope_constants film_resistance_law;
    bridge_force_slope_constants bridge_force_law;
} slope_constants;

typedef struct {
    film_resistance_slopes film_resistance_law;
    bridge_force_slopes bridge_force_law;
} slopes;

/* Constants of the laws' derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    (void)c; (void)v;
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    bridge_force_slope_prepare(&c->bridge_force_law, &v->bridge_force_law);
}

/* Derivatives of the laws by their arguments. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v)
{
    (void)s; (void)c; (void)of; (void)v;
    film_resistance_slopes_of(&s->film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    bridge_force_slopes_of(&s->bridge_force_law, &c->bridge_force_law, &of->bridge_force_law,
        &v->bridge_force_law, of->scaled_gap);
}

enum { CONSTANTS = 5 };
/* Derivatives of a result by the coefficients of the series of a step, and by the constants so far. */
typedef struct {
    vec constant[CONSTANTS];
    vec ahead[4];
    vec bridge_force_law[TERMS];
    vec film_force[TERMS];
    vec film_resistance_law[TERMS];
} adjoint;

/* Transposed recurrences of coefficient k. `w` holds the derivatives of a result by coefficient k + 1 of the
 * states, then by coefficient k; `of_sum` those by their sums. Products of series: 4. */
INLINE void adjoint_coefficients(adjoint *bar, vec *w, const vec *of_sum, vec power, const series *of, const
    slopes *d, const constants *c, vec film, vec shear, mask moving, int k)
{
    double next = 1.0/(k + 1);
    (void)bar; (void)d; (void)c; (void)film; (void)shear; (void)moving;
    vec after_gap = w[GAP]*next;
    vec after_normal_velocity = only(moving, w[NORMAL_VELOCITY]*next);
    vec by_rate_of_normal_velocity = after_normal_velocity;
    vec by_bridge_force = (-by_rate_of_normal_velocity);
    bar->constant[0] += of->bridge_force_law.result[k]*by_bridge_force;
    bar->bridge_force_law[k] = c->bridge_force_per_bridge_force_law*by_bridge_force;
    vec bridge_force_law_gap_over_radius = correlated(d->bridge_force_law.by_gap_over_radius,
        bar->bridge_force_law, &bar->ahead[0], k);
    bar->constant[1] += d->bridge_force_law.by_volume[k]*bar->bridge_force_law[k];
    bar->constant[2] += d->bridge_force_law.by_contact_angle[k]*bar->bridge_force_law[k];
    vec by_scaled_gap = bridge_force_law_gap_over_radius;
    bar->constant[3] += of->gap[k]*by_scaled_gap;
    bar->film_force[k] = (-by_rate_of_normal_velocity);
    vec normal_velocity_by_film_force = correlated(of->film_resistance_law.result, bar->film_force,
        &bar->ahead[1], k);
    vec film_resistance_law_by_film_force = correlated(of->normal_velocity, bar->film_force, &bar->ahead[2],
        k);
    bar->constant[4] += film*of->normal_velocity[k]*normal_velocity_by_film_force;
    bar->film_resistance_law[k] = film*c->film_force_factor*film_resistance_law_by_film_force;
    vec film_resistance_law_gap = correlated(d->film_resistance_law.by_gap, bar->film_resistance_law,
        &bar->ahead[3], k);
    w[GAP] = of_sum[GAP]*power + c->scaled_gap_per_gap*by_scaled_gap + film_resistance_law_gap;
    w[NORMAL_VELOCITY] = of_sum[NORMAL_VELOCITY]*power + after_gap +
        film*c->film_force_factor*normal_velocity_by_film_force;
}

/* From derivatives by the constants of the recurrences to those by the groups. */
static inline void along_constants(const constants *v, const vec *constant, vec *by_group)
{
    (void)v; (void)constant;
    by_group[BY_STOKES] += -1.0/(v->capillary*(v->stokes*v->stokes))*constant[0] +
        -1.0/(v->stokes*v->stokes)*constant[4];
    by_group[BY_ASPECT] += 0.5*constant[3];
    by_group[BY_CAPILLARY] += -1.0/((v->capillary*v->capillary)*v->stokes)*constant[0];
    by_group[BY_VOLUME] += constant[1];
    by_group[BY_CONTACT_ANGLE] += constant[2];
}

#else
typedef struct {
    vec film_force_by_gap_factor;
    vec normal_velocity_by_gap_per_bridge_force_law_by_gap_over_radius;
    vec normal_velocity_by_normal_velocity_per_film_resistance_law;
    vec normal_velocity_by_aspect_per_bridge_force_by_aspect;
    vec normal_velocity_by_capillary_per_bridge_force;
    film_resistance_slope_constants film_resistance_law;
    bridge_force_slope_constants bridge_force_law;
} slope_constants;

/* Constants of the derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    c->film_force_by_gap_factor = 1.0/v->stokes;
    c->normal_velocity_by_gap_per_bridge_force_law_by_gap_over_radius =
        -0.5*v->aspect/(v->capillary*v->stokes);
    c->normal_velocity_by_normal_velocity_per_film_resistance_law = -1.0/v->stokes;
    c->normal_velocity_by_aspect_per_bridge_force_by_aspect = -1.0/(v->capillary*v->stokes);
    c->normal_velocity_by_capillary_per_bridge_force = 1.0/v->capillary;
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    bridge_force_slope_prepare(&c->bridge_force_law, &v->bridge_force_law);
}

/* Derivatives of the rates: entries of the matrix, and source terms of a direction. */
typedef struct {
    vec normal_velocity_by_gap[TERMS];
    vec normal_velocity_by_normal_velocity[TERMS];
    vec normal_velocity_by_stokes[TERMS];
    vec normal_velocity_by_aspect[TERMS];
    vec normal_velocity_by_capillary[TERMS];
    vec normal_velocity_by_volume[TERMS];
    vec normal_velocity_by_contact_angle[TERMS];
} slopes;

/* Derivatives of the rates by the states, and by the requested groups. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v,
    vec film, vec shear, unsigned asked)
{
    film_resistance_slopes film_resistance_law;
    bridge_force_slopes bridge_force_law;
    vec film_force_by_gap[TERMS];
    vec bridge_force_by_aspect[TERMS];
    (void)film; (void)shear; (void)c; (void)asked;
    film_resistance_slopes_of(&film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    bridge_force_slopes_of(&bridge_force_law, &c->bridge_force_law, &of->bridge_force_law,
        &v->bridge_force_law, of->scaled_gap);
    EACH_TERM(film_force_by_gap[k] = film*c->film_force_by_gap_factor*product(film_resistance_law.by_gap,
        of->normal_velocity, k);)
    EACH_TERM(s->normal_velocity_by_gap[k] =
        c->normal_velocity_by_gap_per_bridge_force_law_by_gap_over_radius*bridge_force_law.by_gap_over_radius[k]
        - film_force_by_gap[k];)
    EACH_TERM(s->normal_velocity_by_normal_velocity[k] =
        film*c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->film_resistance_law.result[k];)
    if (asked & (1u << BY_ASPECT)) {
        EACH_TERM(bridge_force_by_aspect[k] = 0.5*product(bridge_force_law.by_gap_over_radius, of->gap, k);)
        EACH_TERM(s->normal_velocity_by_aspect[k] =
        c->normal_velocity_by_aspect_per_bridge_force_by_aspect*bridge_force_by_aspect[k];)
    }
    if (asked & (1u << BY_CAPILLARY)) {
        EACH_TERM(s->normal_velocity_by_capillary[k] =
        c->normal_velocity_by_capillary_per_bridge_force*of->bridge_force[k];)
    }
    if (asked & (1u << BY_CONTACT_ANGLE)) {
        EACH_TERM(s->normal_velocity_by_contact_angle[k] =
        c->normal_velocity_by_aspect_per_bridge_force_by_aspect*bridge_force_law.by_contact_angle[k];)
    }
    if (asked & (1u << BY_STOKES)) {
        EACH_TERM(s->normal_velocity_by_stokes[k] = c->film_force_by_gap_factor*of->bridge_force[k] +
        c->film_force_by_gap_factor*of->film_force[k];)
    }
    if (asked & (1u << BY_VOLUME)) {
        EACH_TERM(s->normal_velocity_by_volume[k] =
        c->normal_velocity_by_aspect_per_bridge_force_by_aspect*bridge_force_law.by_volume[k];)
    }
}

#include "shared/tangent_coefficients_head_on.h"

/* Source terms of the derivatives by a group; zero ones are left unset. */
static inline void sources(const slopes *s, const series *of, int group, const vec **source)
{
    (void)s; (void)of;
    switch (group) {
    case BY_STOKES:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_stokes;
        break;
    case BY_ASPECT:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_aspect;
        break;
    case BY_CAPILLARY:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_capillary;
        break;
    case BY_VOLUME:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_volume;
        break;
    case BY_CONTACT_ANGLE:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_contact_angle;
        break;
    }
}

#endif
/* Contraction rate of a volume of states at the start of a step, dominated by the fast modes. */
static inline vec contraction(const series *of, const constants *v, vec film, vec shear)
{
    (void)of; (void)v; (void)film; (void)shear;
    return film*of->film_resistance_law.result[0]/v->stokes;
}

#include "shared/start_along_head_on.h"

#include "shared/rebound_along_head_on.h"

#include "shared/outputs_along_head_on.h"

/* The groups that each quantity in SI moves, as bits. */
const unsigned moved_groups[QUANTITIES] = { 359, 1, 128, 512, 64, 64, 101, 486, 32, 4, 101, 264, 272 };

/* How the groups change with a quantity in SI. */
static inline void scale_along(const constants *v, const vec *q, int quantity, vec *slope)
{
    (void)v; (void)q;
    memset(slope, 0, sizeof(vec)*GROUPS);
    switch (quantity) {
    case SI_REDUCED_RADIUS:
        slope[BY_STOKES] = -2.0*v->stokes/q[SI_REDUCED_RADIUS];
        slope[BY_ASPECT] = -v->aspect/q[SI_REDUCED_RADIUS];
        slope[BY_CAPILLARY] = v->capillary/q[SI_REDUCED_RADIUS];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_REDUCED_RADIUS];
        slope[BY_ELASTIC_GAP] = 0.6*v->elastic_gap/q[SI_REDUCED_RADIUS];
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] = v->rupture_gap/q[SI_REDUCED_RADIUS];
#else
        slope[BY_RUPTURE_GAP] = v->rupture_gap/q[SI_REDUCED_RADIUS];
#endif
        break;
    case SI_REDUCED_MASS:
        slope[BY_STOKES] = v->stokes/q[SI_REDUCED_MASS];
        break;
    case SI_ROUGHNESS:
        slope[BY_ROUGH_GAP] = v->rough_gap/q[SI_ROUGHNESS];
        break;
    case SI_DRY_RESTITUTION:
        slope[BY_DRY_RESTITUTION] = splat(1.0);
        break;
    case SI_YOUNGS_MODULUS:
        slope[BY_ELASTIC_GAP] = -0.4*v->elastic_gap/q[SI_YOUNGS_MODULUS];
        break;
    case SI_POISSON_RATIO:
        slope[BY_ELASTIC_GAP] =
        -0.8*1.148698354997035*1.5518455739153596*q[SI_POISSON_RATIO]*vec_exp(0.6*vec_log(q[SI_REDUCED_RADIUS]/(1.0
        -
        (q[SI_POISSON_RATIO]*q[SI_POISSON_RATIO]))))*vec_exp(0.4*vec_log(q[SI_SPEED]*q[SI_VISCOSITY]/q[SI_YOUNGS_MODULUS]))/q[SI_FILM_THICKNESS];
        break;
    case SI_VISCOSITY:
        slope[BY_STOKES] = -v->stokes/q[SI_VISCOSITY];
        slope[BY_CAPILLARY] = v->capillary/q[SI_VISCOSITY];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_VISCOSITY];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_VISCOSITY];
        break;
    case SI_FILM_THICKNESS:
        slope[BY_ASPECT] = v->aspect/q[SI_FILM_THICKNESS];
        slope[BY_CAPILLARY] = -v->capillary/q[SI_FILM_THICKNESS];
        slope[BY_GLASS_NUMBER] = 2.0*v->glass_number/q[SI_FILM_THICKNESS];
        slope[BY_ELASTIC_GAP] = -v->elastic_gap/q[SI_FILM_THICKNESS];
        slope[BY_ROUGH_GAP] = -v->rough_gap/q[SI_FILM_THICKNESS];
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] = -v->rupture_gap/q[SI_FILM_THICKNESS];
#else
        slope[BY_RUPTURE_GAP] = -v->rupture_gap/q[SI_FILM_THICKNESS];
#endif
        break;
    case SI_GLASS_TRANSITION_PRESSURE:
        slope[BY_GLASS_NUMBER] = v->glass_number/q[SI_GLASS_TRANSITION_PRESSURE];
        break;
    case SI_SURFACE_TENSION:
        slope[BY_CAPILLARY] = -v->capillary/q[SI_SURFACE_TENSION];
        break;
    case SI_SPEED:
        slope[BY_STOKES] = v->stokes/q[SI_SPEED];
        slope[BY_CAPILLARY] = v->capillary/q[SI_SPEED];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_SPEED];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_SPEED];
        break;
    case SI_VOLUME:
        slope[BY_VOLUME] = splat(1.0);
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] = 2.0*q[SI_REDUCED_RADIUS]*bridge_rupture_distance_by_volume(q[SI_VOLUME],
        q[SI_CONTACT_ANGLE])/q[SI_FILM_THICKNESS];
#else
        slope[BY_RUPTURE_GAP] = 0.3333333333333333*v->rupture_gap/q[SI_VOLUME];
#endif
        break;
    case SI_CONTACT_ANGLE:
        slope[BY_CONTACT_ANGLE] = splat(1.0);
#if OWN_RUPTURE
        slope[BY_RUPTURE_GAP] =
        2.0*q[SI_REDUCED_RADIUS]*bridge_rupture_distance_by_contact_angle(q[SI_VOLUME],
        q[SI_CONTACT_ANGLE])/q[SI_FILM_THICKNESS];
#else
        slope[BY_RUPTURE_GAP] =
        q[SI_REDUCED_RADIUS]*vec_exp(0.3333333333333333*vec_log(q[SI_VOLUME]))/q[SI_FILM_THICKNESS];
#endif
        break;
    }
}
