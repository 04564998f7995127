/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 f28e8cc4792a48c36b88dd16465fbe754866335ac5f30cbfec3a05a1aecfd715 */

/* Tangent of head_on_strings.h: derivatives of the states by the groups.
 *
 * Products of series: 4 and those of the laws, then 2 a direction; backwards 7 and those of the laws'
 * derivatives. */

enum { BY_STOKES, BY_ASPECT, BY_WEIGHT, BY_STRING_RATIO, BY_GLASS_NUMBER, BY_ELASTIC_GAP, BY_ROUGH_GAP, BY_DRY_RESTITUTION };
const char group_names[] =
    "stokes "
    "aspect "
    "weight "
    "string_ratio "
    "glass_number "
    "elastic_gap "
    "rough_gap "
    "dry_restitution";
/* Groups that the rates depend on; the others enter at an event. */
static const unsigned char FLOWS[GROUPS] = { 1, 1, 1, 1, 0, 0, 0, 0 };

#if BACKWARD
typedef struct {
    film_resistance_slope_constants film_resistance_law;
    strings_stiffness_slope_constants strings_stiffness_law;
} slope_constants;

typedef struct {
    film_resistance_slopes film_resistance_law;
    strings_stiffness_slopes strings_stiffness_law;
} slopes;

/* Constants of the laws' derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    (void)c; (void)v;
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    strings_stiffness_slope_prepare(&c->strings_stiffness_law, &v->strings_stiffness_law);
}

/* Derivatives of the laws by their arguments. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v)
{
    (void)s; (void)c; (void)of; (void)v;
    film_resistance_slopes_of(&s->film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    strings_stiffness_slopes_of(&s->strings_stiffness_law, &c->strings_stiffness_law,
        &of->strings_stiffness_law, &v->strings_stiffness_law, of->offset_squared);
}

enum { CONSTANTS = 4 };
/* Derivatives of a result by the coefficients of the series of a step, and by the constants so far. */
typedef struct {
    vec constant[CONSTANTS];
    vec ahead[7];
    vec string_pull[TERMS];
    vec strings_stiffness_law[TERMS];
    vec gap_squared[TERMS];
    vec film_force[TERMS];
    vec film_resistance_law[TERMS];
} adjoint;

/* Transposed recurrences of coefficient k. `w` holds the derivatives of a result by coefficient k + 1 of the
 * states, then by coefficient k; `of_sum` those by their sums. Products of series: 7. */
INLINE void adjoint_coefficients(adjoint *bar, vec *w, const vec *of_sum, vec power, const series *of, const
    slopes *d, const constants *c, vec film, vec shear, mask moving, int k)
{
    double next = 1.0/(k + 1);
    (void)bar; (void)d; (void)c; (void)film; (void)shear; (void)moving;
    vec after_gap = w[GAP]*next;
    vec after_normal_velocity = only(moving, w[NORMAL_VELOCITY]*next);
    vec by_rate_of_normal_velocity = after_normal_velocity;
    bar->string_pull[k] = (-by_rate_of_normal_velocity);
    vec gap_by_string_pull = correlated(of->strings_stiffness_law.result, bar->string_pull, &bar->ahead[0],
        k);
    vec strings_stiffness_law_by_string_pull = correlated(of->gap, bar->string_pull, &bar->ahead[1], k);
    bar->constant[0] += of->gap[k]*gap_by_string_pull;
    bar->strings_stiffness_law[k] = c->string_pull_factor*strings_stiffness_law_by_string_pull;
    bar->constant[1] += d->strings_stiffness_law.by_string_ratio[k]*bar->strings_stiffness_law[k];
    vec strings_stiffness_law_offset_squared = correlated(d->strings_stiffness_law.by_offset_squared,
        bar->strings_stiffness_law, &bar->ahead[2], k);
    vec by_offset_squared = strings_stiffness_law_offset_squared;
    bar->constant[2] += of->gap_squared[k]*by_offset_squared;
    bar->gap_squared[k] = c->offset_squared_per_gap_squared*by_offset_squared;
    vec by_gap_squared = correlated(of->gap, bar->gap_squared, &bar->ahead[3], k);
    bar->film_force[k] = (-by_rate_of_normal_velocity);
    vec normal_velocity_by_film_force = correlated(of->film_resistance_law.result, bar->film_force,
        &bar->ahead[4], k);
    vec film_resistance_law_by_film_force = correlated(of->normal_velocity, bar->film_force, &bar->ahead[5],
        k);
    bar->constant[3] += film*of->normal_velocity[k]*normal_velocity_by_film_force;
    bar->film_resistance_law[k] = film*c->film_force_factor*film_resistance_law_by_film_force;
    vec film_resistance_law_gap = correlated(d->film_resistance_law.by_gap, bar->film_resistance_law,
        &bar->ahead[6], k);
    w[GAP] = of_sum[GAP]*power + c->string_pull_factor*gap_by_string_pull + 2.0*by_gap_squared +
        film_resistance_law_gap;
    w[NORMAL_VELOCITY] = of_sum[NORMAL_VELOCITY]*power + after_gap +
        film*c->film_force_factor*normal_velocity_by_film_force;
}

/* From derivatives by the constants of the recurrences to those by the groups. */
static inline void along_constants(const constants *v, const vec *constant, vec *by_group)
{
    (void)v; (void)constant;
    by_group[BY_STOKES] += -1.0/(v->stokes*v->stokes)*constant[3];
    by_group[BY_ASPECT] += v->weight*constant[0] + 0.5*v->aspect*constant[2];
    by_group[BY_WEIGHT] += v->aspect*constant[0];
    by_group[BY_STRING_RATIO] += constant[1];
}

#else
typedef struct {
    vec film_force_by_gap_factor;
    vec string_pull_by_gap_per_offset_squared_by_strings_stiffness_law_by_offset_squared;
    vec string_pull_by_gap_per_strings_stiffness_law;
    vec strings_stiffness_by_aspect_per_offset_squared_by_strings_stiffness_law_by_offset_squared;
    vec string_pull_by_aspect_per_string_pull;
    vec normal_velocity_by_normal_velocity_per_film_resistance_law;
    vec normal_velocity_by_weight_per_string_pull;
    film_resistance_slope_constants film_resistance_law;
    strings_stiffness_slope_constants strings_stiffness_law;
} slope_constants;

/* Constants of the derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    c->film_force_by_gap_factor = 1.0/v->stokes;
    c->string_pull_by_gap_per_offset_squared_by_strings_stiffness_law_by_offset_squared =
        2.0*v->aspect*v->weight;
    c->string_pull_by_gap_per_strings_stiffness_law = v->aspect*v->weight;
    c->strings_stiffness_by_aspect_per_offset_squared_by_strings_stiffness_law_by_offset_squared =
        2.0/v->aspect;
    c->string_pull_by_aspect_per_string_pull = 1.0/v->aspect;
    c->normal_velocity_by_normal_velocity_per_film_resistance_law = -1.0/v->stokes;
    c->normal_velocity_by_weight_per_string_pull = -1.0/v->weight;
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    strings_stiffness_slope_prepare(&c->strings_stiffness_law, &v->strings_stiffness_law);
}

/* Derivatives of the rates: entries of the matrix, and source terms of a direction. */
typedef struct {
    vec normal_velocity_by_gap[TERMS];
    vec normal_velocity_by_normal_velocity[TERMS];
    vec normal_velocity_by_stokes[TERMS];
    vec normal_velocity_by_aspect[TERMS];
    vec normal_velocity_by_weight[TERMS];
    vec normal_velocity_by_string_ratio[TERMS];
} slopes;

/* Derivatives of the rates by the states, and by the requested groups. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v,
    vec film, vec shear, unsigned asked)
{
    film_resistance_slopes film_resistance_law;
    strings_stiffness_slopes strings_stiffness_law;
    vec film_force_by_gap[TERMS];
    vec offset_squared_by_strings_stiffness_law_by_offset_squared[TERMS];
    vec string_pull_by_gap[TERMS];
    vec strings_stiffness_by_aspect[TERMS];
    vec gap_by_strings_stiffness_by_aspect[TERMS];
    vec string_pull_by_aspect[TERMS];
    vec string_pull_by_string_ratio[TERMS];
    (void)film; (void)shear; (void)c; (void)asked;
    film_resistance_slopes_of(&film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    strings_stiffness_slopes_of(&strings_stiffness_law, &c->strings_stiffness_law, &of->strings_stiffness_law,
        &v->strings_stiffness_law, of->offset_squared);
    EACH_TERM(film_force_by_gap[k] = film*c->film_force_by_gap_factor*product(film_resistance_law.by_gap,
        of->normal_velocity, k);)
    EACH_TERM(offset_squared_by_strings_stiffness_law_by_offset_squared[k] = product(of->offset_squared,
        strings_stiffness_law.by_offset_squared, k);)
    EACH_TERM(string_pull_by_gap[k] =
        c->string_pull_by_gap_per_offset_squared_by_strings_stiffness_law_by_offset_squared*offset_squared_by_strings_stiffness_law_by_offset_squared[k]
        + c->string_pull_by_gap_per_strings_stiffness_law*of->strings_stiffness_law.result[k];)
    EACH_TERM(s->normal_velocity_by_gap[k] = -film_force_by_gap[k] - string_pull_by_gap[k];)
    EACH_TERM(s->normal_velocity_by_normal_velocity[k] =
        film*c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->film_resistance_law.result[k];)
    if (asked & (1u << BY_ASPECT)) {
        EACH_TERM(strings_stiffness_by_aspect[k] =
        c->strings_stiffness_by_aspect_per_offset_squared_by_strings_stiffness_law_by_offset_squared*offset_squared_by_strings_stiffness_law_by_offset_squared[k];)
        EACH_TERM(gap_by_strings_stiffness_by_aspect[k] = product(of->gap, strings_stiffness_by_aspect, k);)
        EACH_TERM(string_pull_by_aspect[k] =
        c->string_pull_by_gap_per_strings_stiffness_law*gap_by_strings_stiffness_by_aspect[k] +
        c->string_pull_by_aspect_per_string_pull*of->string_pull[k];)
        EACH_TERM(s->normal_velocity_by_aspect[k] = -string_pull_by_aspect[k];)
    }
    if (asked & (1u << BY_STOKES)) {
        EACH_TERM(s->normal_velocity_by_stokes[k] = c->film_force_by_gap_factor*of->film_force[k];)
    }
    if (asked & (1u << BY_STRING_RATIO)) {
        EACH_TERM(string_pull_by_string_ratio[k] =
        c->string_pull_by_gap_per_strings_stiffness_law*product(of->gap,
        strings_stiffness_law.by_string_ratio, k);)
        EACH_TERM(s->normal_velocity_by_string_ratio[k] = -string_pull_by_string_ratio[k];)
    }
    if (asked & (1u << BY_WEIGHT)) {
        EACH_TERM(s->normal_velocity_by_weight[k] =
        c->normal_velocity_by_weight_per_string_pull*of->string_pull[k];)
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
    case BY_WEIGHT:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_weight;
        break;
    case BY_STRING_RATIO:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_string_ratio;
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
const unsigned moved_groups[QUANTITIES] = { 59, 1, 64, 128, 32, 32, 49, 118, 16, 8, 4, 53 };

/* How the groups change with a quantity in SI. */
static inline void scale_along(const constants *v, const vec *q, int quantity, vec *slope)
{
    (void)v; (void)q;
    memset(slope, 0, sizeof(vec)*GROUPS);
    switch (quantity) {
    case SI_REDUCED_RADIUS:
        slope[BY_STOKES] = -2.0*v->stokes/q[SI_REDUCED_RADIUS];
        slope[BY_ASPECT] = -v->aspect/q[SI_REDUCED_RADIUS];
        slope[BY_STRING_RATIO] = -v->string_ratio/q[SI_REDUCED_RADIUS];
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
        slope[BY_ASPECT] = v->aspect/q[SI_FILM_THICKNESS];
        slope[BY_WEIGHT] = v->weight/q[SI_FILM_THICKNESS];
        slope[BY_GLASS_NUMBER] = 2.0*v->glass_number/q[SI_FILM_THICKNESS];
        slope[BY_ELASTIC_GAP] = -v->elastic_gap/q[SI_FILM_THICKNESS];
        slope[BY_ROUGH_GAP] = -v->rough_gap/q[SI_FILM_THICKNESS];
        break;
    case SI_GLASS_TRANSITION_PRESSURE:
        slope[BY_GLASS_NUMBER] = v->glass_number/q[SI_GLASS_TRANSITION_PRESSURE];
        break;
    case SI_STRING_LENGTH:
        slope[BY_STRING_RATIO] = v->string_ratio/q[SI_STRING_LENGTH];
        break;
    case SI_GRAVITY:
        slope[BY_WEIGHT] = v->weight/q[SI_GRAVITY];
        break;
    case SI_SPEED:
        slope[BY_STOKES] = v->stokes/q[SI_SPEED];
        slope[BY_WEIGHT] = -2.0*v->weight/q[SI_SPEED];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_SPEED];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_SPEED];
        break;
    }
}
