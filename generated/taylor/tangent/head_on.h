/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 5bb85b7457d42805a0bc607bb05b818a64a138863ee7dcc49b2d16aff121d307 */

/* Tangent of head_on.h: derivatives of the states by the groups.
 *
 * Products of series: 1 and those of the laws, then 2 a direction; backwards 3 and those of the laws'
 * derivatives. */

enum { BY_STOKES, BY_GLASS_NUMBER, BY_ELASTIC_GAP, BY_ROUGH_GAP, BY_DRY_RESTITUTION };
const char group_names[] =
    "stokes "
    "glass_number "
    "elastic_gap "
    "rough_gap "
    "dry_restitution";
/* Groups that the rates depend on; the others enter at an event. */
static const unsigned char FLOWS[GROUPS] = { 1, 0, 0, 0, 0 };

#if BACKWARD
typedef struct {
    film_resistance_slope_constants film_resistance_law;
} slope_constants;

typedef struct {
    film_resistance_slopes film_resistance_law;
} slopes;

/* Constants of the laws' derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    (void)c; (void)v;
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
}

/* Derivatives of the laws by their arguments. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v)
{
    (void)s; (void)c; (void)of; (void)v;
    film_resistance_slopes_of(&s->film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
}

enum { CONSTANTS = 1 };
/* Derivatives of a result by the coefficients of the series of a step, and by the constants so far. */
typedef struct {
    vec constant[CONSTANTS];
    vec ahead[3];
    vec film_force[TERMS];
    vec film_resistance_law[TERMS];
} adjoint;

/* Transposed recurrences of coefficient k. `w` holds the derivatives of a result by coefficient k + 1 of the
 * states, then by coefficient k; `of_sum` those by their sums. Products of series: 3. */
INLINE void adjoint_coefficients(adjoint *bar, vec *w, const vec *of_sum, vec power, const series *of, const
    slopes *d, const constants *c, vec film, vec shear, mask moving, int k)
{
    double next = 1.0/(k + 1);
    (void)bar; (void)d; (void)c; (void)film; (void)shear; (void)moving;
    vec after_gap = w[GAP]*next;
    vec after_normal_velocity = only(moving, w[NORMAL_VELOCITY]*next);
    vec by_rate_of_normal_velocity = after_normal_velocity;
    bar->film_force[k] = (-by_rate_of_normal_velocity);
    vec normal_velocity_by_film_force = correlated(of->film_resistance_law.result, bar->film_force,
        &bar->ahead[0], k);
    vec film_resistance_law_by_film_force = correlated(of->normal_velocity, bar->film_force, &bar->ahead[1],
        k);
    bar->constant[0] += film*of->normal_velocity[k]*normal_velocity_by_film_force;
    bar->film_resistance_law[k] = film*c->film_force_factor*film_resistance_law_by_film_force;
    vec film_resistance_law_gap = correlated(d->film_resistance_law.by_gap, bar->film_resistance_law,
        &bar->ahead[2], k);
    w[GAP] = of_sum[GAP]*power + film_resistance_law_gap;
    w[NORMAL_VELOCITY] = of_sum[NORMAL_VELOCITY]*power + after_gap +
        film*c->film_force_factor*normal_velocity_by_film_force;
}

/* From derivatives by the constants of the recurrences to those by the groups. */
static inline void along_constants(const constants *v, const vec *constant, vec *by_group)
{
    (void)v; (void)constant;
    by_group[BY_STOKES] += -1.0/(v->stokes*v->stokes)*constant[0];
}

#else
typedef struct {
    vec film_force_by_gap_factor;
    vec normal_velocity_by_normal_velocity_per_film_resistance_law;
    film_resistance_slope_constants film_resistance_law;
} slope_constants;

/* Constants of the derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    c->film_force_by_gap_factor = 1.0/v->stokes;
    c->normal_velocity_by_normal_velocity_per_film_resistance_law = -1.0/v->stokes;
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
}

/* Derivatives of the rates: entries of the matrix, and source terms of a direction. */
typedef struct {
    vec normal_velocity_by_gap[TERMS];
    vec normal_velocity_by_normal_velocity[TERMS];
    vec normal_velocity_by_stokes[TERMS];
} slopes;

/* Derivatives of the rates by the states, and by the requested groups. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v,
    vec film, vec shear, unsigned asked)
{
    film_resistance_slopes film_resistance_law;
    vec film_force_by_gap[TERMS];
    (void)film; (void)shear; (void)c; (void)asked;
    film_resistance_slopes_of(&film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    EACH_TERM(film_force_by_gap[k] = film*c->film_force_by_gap_factor*product(film_resistance_law.by_gap,
        of->normal_velocity, k);)
    EACH_TERM(s->normal_velocity_by_gap[k] = -film_force_by_gap[k];)
    EACH_TERM(s->normal_velocity_by_normal_velocity[k] =
        film*c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->film_resistance_law.result[k];)
    if (asked & (1u << BY_STOKES)) {
        EACH_TERM(s->normal_velocity_by_stokes[k] = c->film_force_by_gap_factor*of->film_force[k];)
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
const unsigned moved_groups[QUANTITIES] = { 7, 1, 8, 16, 4, 4, 7, 14, 2, 7 };

/* How the groups change with a quantity in SI. */
static inline void scale_along(const constants *v, const vec *q, int quantity, vec *slope)
{
    (void)v; (void)q;
    memset(slope, 0, sizeof(vec)*GROUPS);
    switch (quantity) {
    case SI_REDUCED_RADIUS:
        slope[BY_STOKES] = -2.0*v->stokes/q[SI_REDUCED_RADIUS];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_REDUCED_RADIUS];
        slope[BY_ELASTIC_GAP] = 0.6*v->elastic_gap/q[SI_REDUCED_RADIUS];
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
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_VISCOSITY];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_VISCOSITY];
        break;
    case SI_FILM_THICKNESS:
        slope[BY_GLASS_NUMBER] = 2.0*v->glass_number/q[SI_FILM_THICKNESS];
        slope[BY_ELASTIC_GAP] = -v->elastic_gap/q[SI_FILM_THICKNESS];
        slope[BY_ROUGH_GAP] = -v->rough_gap/q[SI_FILM_THICKNESS];
        break;
    case SI_GLASS_TRANSITION_PRESSURE:
        slope[BY_GLASS_NUMBER] = v->glass_number/q[SI_GLASS_TRANSITION_PRESSURE];
        break;
    case SI_SPEED:
        slope[BY_STOKES] = v->stokes/q[SI_SPEED];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_SPEED];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_SPEED];
        break;
    }
}
