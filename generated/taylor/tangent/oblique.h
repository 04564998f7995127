/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 3df67a51b229b7814eaddce727e39d6f2a7d76418779fd31394dde1f83f27043 */

/* Tangent of oblique.h: derivatives of the states by the groups.
 *
 * Products of series: 24 and those of the laws, then 9 a direction; backwards 17 and those of the laws'
 * derivatives. */

enum { BY_STOKES, BY_ASPECT, BY_OBLIQUITY, BY_INITIAL_TURNING, BY_INITIAL_SPIN, BY_GLASS_NUMBER, BY_ELASTIC_GAP, BY_ROUGH_GAP, BY_DRY_RESTITUTION };
const char group_names[] =
    "stokes "
    "aspect "
    "obliquity "
    "initial_turning "
    "initial_spin "
    "glass_number "
    "elastic_gap "
    "rough_gap "
    "dry_restitution";
/* Groups that the rates depend on; the others enter at an event. */
static const unsigned char FLOWS[GROUPS] = { 1, 1, 1, 0, 0, 0, 0, 0, 0 };

#if BACKWARD
typedef struct {
    shear_log_factor_slope_constants shear_log_factor_law;
    film_resistance_slope_constants film_resistance_law;
    arm_lever_slope_constants arm_lever_law;
} slope_constants;

typedef struct {
    shear_log_factor_slopes shear_log_factor_law;
    film_resistance_slopes film_resistance_law;
    arm_lever_slopes arm_lever_law;
} slopes;

/* Constants of the laws' derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    (void)c; (void)v;
    shear_log_factor_slope_prepare(&c->shear_log_factor_law, &v->shear_log_factor_law);
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    arm_lever_slope_prepare(&c->arm_lever_law, &v->arm_lever_law);
}

/* Derivatives of the laws by their arguments. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v)
{
    (void)s; (void)c; (void)of; (void)v;
    shear_log_factor_slopes_of(&s->shear_log_factor_law, &c->shear_log_factor_law, &of->shear_log_factor_law,
        &v->shear_log_factor_law, of->gap);
    film_resistance_slopes_of(&s->film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    arm_lever_slopes_of(&s->arm_lever_law, &c->arm_lever_law, &of->arm_lever_law, &v->arm_lever_law,
        of->distance);
}

enum { CONSTANTS = 4 };
/* Derivatives of a result by the coefficients of the series of a step, and by the constants so far. */
typedef struct {
    vec constant[CONSTANTS];
    vec ahead[17];
    vec rate_of_spin[TERMS];
    vec rate_of_orbital_momentum[TERMS];
    vec arm_lever_law[TERMS];
    vec film_force[TERMS];
    vec film_resistance_law[TERMS];
    vec centrifugal_force[TERMS];
    vec orbital_rate_squared[TERMS];
    vec shear_force[TERMS];
    vec shear_log_factor_law[TERMS];
    vec orbital_rate[TERMS];
    vec distance_squared[TERMS];
} adjoint;

/* Transposed recurrences of coefficient k. `w` holds the derivatives of a result by coefficient k + 1 of the
 * states, then by coefficient k; `of_sum` those by their sums. Products of series: 17. */
INLINE void adjoint_coefficients(adjoint *bar, vec *w, const vec *of_sum, vec power, const series *of, const
    slopes *d, const constants *c, vec film, vec shear, mask moving, int k)
{
    double next = 1.0/(k + 1);
    (void)bar; (void)d; (void)c; (void)film; (void)shear; (void)moving;
    vec after_gap = w[GAP]*next;
    vec after_normal_velocity = only(moving, w[NORMAL_VELOCITY]*next);
    vec after_orbital_momentum = w[ORBITAL_MOMENTUM]*next;
    vec after_spin = w[SPIN]*next;
    bar->rate_of_spin[k] = after_spin;
    vec arm_lever_law_by_rate_of_spin = correlated(of->shear_force, bar->rate_of_spin, &bar->ahead[0], k);
    vec shear_force_by_rate_of_spin = correlated(of->arm_lever_law.result, bar->rate_of_spin, &bar->ahead[1],
        k);
    bar->rate_of_orbital_momentum[k] = after_orbital_momentum;
    vec distance_by_rate_of_orbital_momentum = correlated(of->shear_force, bar->rate_of_orbital_momentum,
        &bar->ahead[2], k);
    vec shear_force_by_rate_of_orbital_momentum = correlated(of->distance, bar->rate_of_orbital_momentum,
        &bar->ahead[3], k);
    vec by_rate_of_normal_velocity = after_normal_velocity;
    bar->arm_lever_law[k] = 0.3125*arm_lever_law_by_rate_of_spin;
    vec arm_lever_law_distance = correlated(d->arm_lever_law.by_distance, bar->arm_lever_law, &bar->ahead[4],
        k);
    bar->film_force[k] = (-by_rate_of_normal_velocity);
    vec normal_velocity_by_film_force = correlated(of->film_resistance_law.result, bar->film_force,
        &bar->ahead[5], k);
    vec film_resistance_law_by_film_force = correlated(of->normal_velocity, bar->film_force, &bar->ahead[6],
        k);
    bar->constant[0] += film*of->normal_velocity[k]*normal_velocity_by_film_force;
    bar->film_resistance_law[k] = film*c->film_force_factor*film_resistance_law_by_film_force;
    vec film_resistance_law_gap = correlated(d->film_resistance_law.by_gap, bar->film_resistance_law,
        &bar->ahead[7], k);
    bar->centrifugal_force[k] = by_rate_of_normal_velocity;
    vec distance_by_centrifugal_force = correlated(of->orbital_rate_squared, bar->centrifugal_force,
        &bar->ahead[8], k);
    vec orbital_rate_squared_by_centrifugal_force = correlated(of->distance, bar->centrifugal_force,
        &bar->ahead[9], k);
    bar->constant[1] += of->distance[k]*distance_by_centrifugal_force;
    bar->orbital_rate_squared[k] = c->centrifugal_force_factor*orbital_rate_squared_by_centrifugal_force;
    vec by_orbital_rate_squared = correlated(of->orbital_rate, bar->orbital_rate_squared, &bar->ahead[10], k);
    bar->shear_force[k] = 0.3125*shear_force_by_rate_of_spin + (-shear_force_by_rate_of_orbital_momentum);
    vec slip_by_shear_force = correlated(of->shear_log_factor_law.result, bar->shear_force, &bar->ahead[11],
        k);
    vec shear_log_factor_law_by_shear_force = correlated(of->slip, bar->shear_force, &bar->ahead[12], k);
    bar->constant[2] += shear*of->slip[k]*slip_by_shear_force;
    bar->shear_log_factor_law[k] = shear*c->shear_force_factor*shear_log_factor_law_by_shear_force;
    vec shear_log_factor_law_gap = correlated(d->shear_log_factor_law.by_gap, bar->shear_log_factor_law,
        &bar->ahead[13], k);
    bar->constant[3] += d->shear_log_factor_law.by_aspect[k]*bar->shear_log_factor_law[k];
    vec by_slip = shear*c->shear_force_factor*slip_by_shear_force;
    bar->orbital_rate[k] = (2.0*by_orbital_rate_squared + by_slip - beyond(of->distance_squared,
        bar->orbital_rate, &bar->ahead[14], k))*of->over_orbital_rate;
    vec by_orbital_rate = correlated(of->orbital_rate, bar->orbital_rate, &bar->ahead[15], k);
    bar->distance_squared[k] = (-by_orbital_rate);
    vec by_distance_squared = correlated(of->distance, bar->distance_squared, &bar->ahead[16], k);
    vec by_distance = (-distance_by_rate_of_orbital_momentum) + arm_lever_law_distance +
        c->centrifugal_force_factor*distance_by_centrifugal_force + 2.0*by_distance_squared;
    bar->constant[3] += of->gap[k]*by_distance;
    w[GAP] = of_sum[GAP]*power + film_resistance_law_gap + shear_log_factor_law_gap + c->aspect*by_distance;
    w[NORMAL_VELOCITY] = of_sum[NORMAL_VELOCITY]*power + after_gap +
        film*c->film_force_factor*normal_velocity_by_film_force;
    w[ORBITAL_MOMENTUM] = of_sum[ORBITAL_MOMENTUM]*power + bar->orbital_rate[k];
    w[SPIN] = of_sum[SPIN]*power + (-by_slip);
}

/* From derivatives by the constants of the recurrences to those by the groups. */
static inline void along_constants(const constants *v, const vec *constant, vec *by_group)
{
    (void)v; (void)constant;
    by_group[BY_STOKES] += -1.0/(v->stokes*v->stokes)*constant[0] +
        -1.3333333333333333*v->aspect/(v->stokes*v->stokes)*constant[2];
    by_group[BY_ASPECT] += 0.0625*(v->obliquity*v->obliquity)*constant[1] +
        1.3333333333333333/v->stokes*constant[2] + constant[3];
    by_group[BY_OBLIQUITY] += 0.125*v->aspect*v->obliquity*constant[1];
}

#else
typedef struct {
    vec film_force_by_gap_factor;
    vec centrifugal_force_by_aspect_per_gap_by_orbital_rate_squared;
    vec centrifugal_force_by_aspect_per_centrifugal_force;
    vec centrifugal_force_by_obliquity_per_centrifugal_force;
    vec shear_force_by_gap_per_orbital_rate_by_shear_log_factor_law_over_distance;
    vec shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip;
    vec shear_force_by_aspect_per_gap_by_orbital_rate_by_shear_log_factor_law_over_distance;
    vec normal_velocity_by_gap_per_orbital_rate_squared;
    vec normal_velocity_by_normal_velocity_per_film_resistance_law;
    vec normal_velocity_by_orbital_momentum_per_orbital_rate_over_distance;
    vec orbital_momentum_by_gap_per_shear_force;
    vec orbital_momentum_by_orbital_momentum_per_shear_log_factor_law_over_distance;
    vec spin_by_gap_per_arm_lever_law_by_distance_by_shear_force;
    vec spin_by_orbital_momentum_per_arm_lever_law_by_shear_log_factor_law_over_distance_squared;
    vec spin_by_spin_per_arm_lever_law_by_shear_log_factor_law;
    vec turned_by_gap_per_orbital_rate_over_distance;
    vec turned_by_orbital_momentum_per_inverse_distance_squared;
    vec turned_by_aspect_per_gap_by_orbital_rate_over_distance;
    vec turned_by_aspect_per_orbital_rate;
    vec turned_by_obliquity_per_orbital_rate;
    shear_log_factor_slope_constants shear_log_factor_law;
    film_resistance_slope_constants film_resistance_law;
    arm_lever_slope_constants arm_lever_law;
} slope_constants;

/* Constants of the derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    c->film_force_by_gap_factor = 1.0/v->stokes;
    c->centrifugal_force_by_aspect_per_gap_by_orbital_rate_squared =
        -0.1875*v->aspect*(v->obliquity*v->obliquity);
    c->centrifugal_force_by_aspect_per_centrifugal_force = 1.0/v->aspect;
    c->centrifugal_force_by_obliquity_per_centrifugal_force = 2.0/v->obliquity;
    c->shear_force_by_gap_per_orbital_rate_by_shear_log_factor_law_over_distance =
        -2.6666666666666665*(v->aspect*v->aspect)/v->stokes;
    c->shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip = 1.3333333333333333*v->aspect/v->stokes;
    c->shear_force_by_aspect_per_gap_by_orbital_rate_by_shear_log_factor_law_over_distance =
        -2.6666666666666665*v->aspect/v->stokes;
    c->normal_velocity_by_gap_per_orbital_rate_squared =
        -0.1875*(v->aspect*v->aspect)*(v->obliquity*v->obliquity);
    c->normal_velocity_by_normal_velocity_per_film_resistance_law = -1.0/v->stokes;
    c->normal_velocity_by_orbital_momentum_per_orbital_rate_over_distance =
        0.125*v->aspect*(v->obliquity*v->obliquity);
    c->orbital_momentum_by_gap_per_shear_force = -v->aspect;
    c->orbital_momentum_by_orbital_momentum_per_shear_log_factor_law_over_distance =
        -1.3333333333333333*v->aspect/v->stokes;
    c->spin_by_gap_per_arm_lever_law_by_distance_by_shear_force = 0.3125*v->aspect;
    c->spin_by_orbital_momentum_per_arm_lever_law_by_shear_log_factor_law_over_distance_squared =
        0.4166666666666667*v->aspect/v->stokes;
    c->spin_by_spin_per_arm_lever_law_by_shear_log_factor_law = -0.4166666666666667*v->aspect/v->stokes;
    c->turned_by_gap_per_orbital_rate_over_distance = -0.5*(v->aspect*v->aspect)*v->obliquity;
    c->turned_by_orbital_momentum_per_inverse_distance_squared = 0.25*v->aspect*v->obliquity;
    c->turned_by_aspect_per_gap_by_orbital_rate_over_distance = -0.5*v->aspect*v->obliquity;
    c->turned_by_aspect_per_orbital_rate = 0.25*v->obliquity;
    c->turned_by_obliquity_per_orbital_rate = 0.25*v->aspect;
    shear_log_factor_slope_prepare(&c->shear_log_factor_law, &v->shear_log_factor_law);
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    arm_lever_slope_prepare(&c->arm_lever_law, &v->arm_lever_law);
}

/* Derivatives of the rates: entries of the matrix, and source terms of a direction. */
typedef struct {
    vec centrifugal_force_by_aspect[TERMS];
    vec centrifugal_force_by_obliquity[TERMS];
    vec normal_velocity_by_gap[TERMS];
    vec normal_velocity_by_normal_velocity[TERMS];
    vec normal_velocity_by_orbital_momentum[TERMS];
    vec normal_velocity_by_stokes[TERMS];
    vec orbital_momentum_by_gap[TERMS];
    vec orbital_momentum_by_orbital_momentum[TERMS];
    vec orbital_momentum_by_spin[TERMS];
    vec orbital_momentum_by_stokes[TERMS];
    vec orbital_momentum_by_aspect[TERMS];
    vec spin_by_gap[TERMS];
    vec spin_by_orbital_momentum[TERMS];
    vec spin_by_spin[TERMS];
    vec spin_by_stokes[TERMS];
    vec spin_by_aspect[TERMS];
    vec turned_by_gap[TERMS];
    vec turned_by_orbital_momentum[TERMS];
    vec turned_by_aspect[TERMS];
    vec turned_by_obliquity[TERMS];
} slopes;

/* Derivatives of the rates by the states, and by the requested groups. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v,
    vec film, vec shear, unsigned asked)
{
    shear_log_factor_slopes shear_log_factor_law;
    film_resistance_slopes film_resistance_law;
    arm_lever_slopes arm_lever_law;
    vec film_force_by_gap[TERMS];
    vec gap_by_orbital_rate_squared[TERMS];
    vec orbital_rate_by_shear_log_factor_law[TERMS];
    vec orbital_rate_by_shear_log_factor_law_over_distance[TERMS];
    vec over_orbital_rate_by_shear_log_factor_law_over_distance;
    vec shear_log_factor_law_by_gap_by_slip[TERMS];
    vec shear_force_by_gap[TERMS];
    vec shear_log_factor_law_by_aspect_by_slip[TERMS];
    vec gap_by_orbital_rate[TERMS];
    vec gap_by_orbital_rate_by_shear_log_factor_law[TERMS];
    vec gap_by_orbital_rate_by_shear_log_factor_law_over_distance[TERMS];
    vec over_gap_by_orbital_rate_by_shear_log_factor_law_over_distance;
    vec shear_force_by_aspect[TERMS];
    vec arm_lever_by_aspect[TERMS];
    vec orbital_rate_over_distance[TERMS];
    vec over_orbital_rate_over_distance;
    vec distance_by_shear_force_by_gap[TERMS];
    vec shear_log_factor_law_over_distance[TERMS];
    vec over_shear_log_factor_law_over_distance;
    vec distance_by_shear_force_by_aspect[TERMS];
    vec gap_by_shear_force[TERMS];
    vec arm_lever_law_by_distance_by_shear_force[TERMS];
    vec arm_lever_law_by_shear_force_by_gap[TERMS];
    vec arm_lever_law_by_shear_log_factor_law[TERMS];
    vec arm_lever_law_by_shear_log_factor_law_over_distance_squared[TERMS];
    vec over_arm_lever_law_by_shear_log_factor_law_over_distance_squared;
    vec arm_lever_by_aspect_by_shear_force[TERMS];
    vec arm_lever_law_by_shear_force_by_aspect[TERMS];
    vec inverse_distance_squared[TERMS];
    vec gap_by_orbital_rate_over_distance[TERMS];
    vec over_gap_by_orbital_rate_over_distance;
    (void)film; (void)shear; (void)c; (void)asked;
    shear_log_factor_slopes_of(&shear_log_factor_law, &c->shear_log_factor_law, &of->shear_log_factor_law,
        &v->shear_log_factor_law, of->gap);
    film_resistance_slopes_of(&film_resistance_law, &c->film_resistance_law, &of->film_resistance_law,
        &v->film_resistance_law, of->gap);
    arm_lever_slopes_of(&arm_lever_law, &c->arm_lever_law, &of->arm_lever_law, &v->arm_lever_law,
        of->distance);
    EACH_TERM(film_force_by_gap[k] = film*c->film_force_by_gap_factor*product(film_resistance_law.by_gap,
        of->normal_velocity, k);)
    EACH_TERM(orbital_rate_by_shear_log_factor_law[k] = product(of->orbital_rate,
        of->shear_log_factor_law.result, k);)
    EACH_TERM(orbital_rate_by_shear_log_factor_law_over_distance[k] =
        quotient(orbital_rate_by_shear_log_factor_law, of->distance,
        orbital_rate_by_shear_log_factor_law_over_distance,
        &over_orbital_rate_by_shear_log_factor_law_over_distance, k);)
    EACH_TERM(shear_log_factor_law_by_gap_by_slip[k] = product(shear_log_factor_law.by_gap, of->slip, k);)
    EACH_TERM(shear_force_by_gap[k] =
        shear*c->shear_force_by_gap_per_orbital_rate_by_shear_log_factor_law_over_distance*orbital_rate_by_shear_log_factor_law_over_distance[k]
        +
        shear*c->shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip*shear_log_factor_law_by_gap_by_slip[k];)
    EACH_TERM(s->normal_velocity_by_gap[k] =
        c->normal_velocity_by_gap_per_orbital_rate_squared*of->orbital_rate_squared[k] -
        film_force_by_gap[k];)
    EACH_TERM(s->normal_velocity_by_normal_velocity[k] =
        film*c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->film_resistance_law.result[k];)
    EACH_TERM(orbital_rate_over_distance[k] = quotient(of->orbital_rate, of->distance,
        orbital_rate_over_distance, &over_orbital_rate_over_distance, k);)
    EACH_TERM(s->normal_velocity_by_orbital_momentum[k] =
        c->normal_velocity_by_orbital_momentum_per_orbital_rate_over_distance*orbital_rate_over_distance[k];)
    EACH_TERM(distance_by_shear_force_by_gap[k] = product(of->distance, shear_force_by_gap, k);)
    EACH_TERM(s->orbital_momentum_by_gap[k] = c->orbital_momentum_by_gap_per_shear_force*of->shear_force[k] -
        distance_by_shear_force_by_gap[k];)
    EACH_TERM(shear_log_factor_law_over_distance[k] = quotient(of->shear_log_factor_law.result, of->distance,
        shear_log_factor_law_over_distance, &over_shear_log_factor_law_over_distance, k);)
    EACH_TERM(s->orbital_momentum_by_orbital_momentum[k] =
        shear*c->orbital_momentum_by_orbital_momentum_per_shear_log_factor_law_over_distance*shear_log_factor_law_over_distance[k];)
    EACH_TERM(s->orbital_momentum_by_spin[k] =
        shear*c->shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip*product(of->distance,
        of->shear_log_factor_law.result, k);)
    EACH_TERM(arm_lever_law_by_distance_by_shear_force[k] = product(arm_lever_law.by_distance,
        of->shear_force, k);)
    EACH_TERM(arm_lever_law_by_shear_force_by_gap[k] = product(of->arm_lever_law.result, shear_force_by_gap,
        k);)
    EACH_TERM(s->spin_by_gap[k] =
        c->spin_by_gap_per_arm_lever_law_by_distance_by_shear_force*arm_lever_law_by_distance_by_shear_force[k]
        + 0.3125*arm_lever_law_by_shear_force_by_gap[k];)
    EACH_TERM(arm_lever_law_by_shear_log_factor_law[k] = product(of->arm_lever_law.result,
        of->shear_log_factor_law.result, k);)
    EACH_TERM(arm_lever_law_by_shear_log_factor_law_over_distance_squared[k] =
        quotient(arm_lever_law_by_shear_log_factor_law, of->distance_squared,
        arm_lever_law_by_shear_log_factor_law_over_distance_squared,
        &over_arm_lever_law_by_shear_log_factor_law_over_distance_squared, k);)
    EACH_TERM(s->spin_by_orbital_momentum[k] =
        shear*c->spin_by_orbital_momentum_per_arm_lever_law_by_shear_log_factor_law_over_distance_squared*arm_lever_law_by_shear_log_factor_law_over_distance_squared[k];)
    EACH_TERM(s->spin_by_spin[k] =
        shear*c->spin_by_spin_per_arm_lever_law_by_shear_log_factor_law*arm_lever_law_by_shear_log_factor_law[k];)
#if TURNING_STATE
    EACH_TERM(s->turned_by_gap[k] =
        c->turned_by_gap_per_orbital_rate_over_distance*orbital_rate_over_distance[k];)
#endif
    EACH_TERM(inverse_distance_squared[k] = reciprocal(of->distance_squared, inverse_distance_squared, k);)
#if TURNING_STATE
    EACH_TERM(s->turned_by_orbital_momentum[k] =
        c->turned_by_orbital_momentum_per_inverse_distance_squared*inverse_distance_squared[k];)
#endif
    if (asked & (1u << BY_ASPECT)) {
        EACH_TERM(gap_by_orbital_rate_squared[k] = product(of->gap, of->orbital_rate_squared, k);)
        EACH_TERM(s->centrifugal_force_by_aspect[k] =
        c->centrifugal_force_by_aspect_per_gap_by_orbital_rate_squared*gap_by_orbital_rate_squared[k] +
        c->centrifugal_force_by_aspect_per_centrifugal_force*of->centrifugal_force[k];)
        EACH_TERM(shear_log_factor_law_by_aspect_by_slip[k] = product(shear_log_factor_law.by_aspect,
        of->slip, k);)
        EACH_TERM(gap_by_orbital_rate[k] = product(of->gap, of->orbital_rate, k);)
        EACH_TERM(gap_by_orbital_rate_by_shear_log_factor_law[k] = product(of->shear_log_factor_law.result,
        gap_by_orbital_rate, k);)
        EACH_TERM(gap_by_orbital_rate_by_shear_log_factor_law_over_distance[k] =
        quotient(gap_by_orbital_rate_by_shear_log_factor_law, of->distance,
        gap_by_orbital_rate_by_shear_log_factor_law_over_distance,
        &over_gap_by_orbital_rate_by_shear_log_factor_law_over_distance, k);)
        EACH_TERM(shear_force_by_aspect[k] =
        shear*c->shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip*shear_log_factor_law_by_aspect_by_slip[k]
        +
        shear*c->shear_force_by_aspect_per_gap_by_orbital_rate_by_shear_log_factor_law_over_distance*gap_by_orbital_rate_by_shear_log_factor_law_over_distance[k]
        + c->centrifugal_force_by_aspect_per_centrifugal_force*of->shear_force[k];)
        EACH_TERM(arm_lever_by_aspect[k] = product(arm_lever_law.by_distance, of->gap, k);)
        EACH_TERM(distance_by_shear_force_by_aspect[k] = product(of->distance, shear_force_by_aspect, k);)
        EACH_TERM(gap_by_shear_force[k] = product(of->gap, of->shear_force, k);)
        EACH_TERM(s->orbital_momentum_by_aspect[k] = -distance_by_shear_force_by_aspect[k] -
        gap_by_shear_force[k];)
        EACH_TERM(arm_lever_by_aspect_by_shear_force[k] = product(of->shear_force, arm_lever_by_aspect, k);)
        EACH_TERM(arm_lever_law_by_shear_force_by_aspect[k] = product(of->arm_lever_law.result,
        shear_force_by_aspect, k);)
        EACH_TERM(s->spin_by_aspect[k] = 0.3125*arm_lever_by_aspect_by_shear_force[k] +
        0.3125*arm_lever_law_by_shear_force_by_aspect[k];)
        EACH_TERM(gap_by_orbital_rate_over_distance[k] = quotient(gap_by_orbital_rate, of->distance,
        gap_by_orbital_rate_over_distance, &over_gap_by_orbital_rate_over_distance, k);)
#if TURNING_STATE
        EACH_TERM(s->turned_by_aspect[k] =
        c->turned_by_aspect_per_gap_by_orbital_rate_over_distance*gap_by_orbital_rate_over_distance[k] +
        c->turned_by_aspect_per_orbital_rate*of->orbital_rate[k];)
#endif
    }
    if (asked & (1u << BY_OBLIQUITY)) {
        EACH_TERM(s->centrifugal_force_by_obliquity[k] =
        c->centrifugal_force_by_obliquity_per_centrifugal_force*of->centrifugal_force[k];)
#if TURNING_STATE
        EACH_TERM(s->turned_by_obliquity[k] = c->turned_by_obliquity_per_orbital_rate*of->orbital_rate[k];)
#endif
    }
    if (asked & (1u << BY_STOKES)) {
        EACH_TERM(s->normal_velocity_by_stokes[k] = c->film_force_by_gap_factor*of->film_force[k];)
        EACH_TERM(s->orbital_momentum_by_stokes[k] =
        c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->rate_of_orbital_momentum[k];)
        EACH_TERM(s->spin_by_stokes[k] =
        c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->rate_of_spin[k];)
    }
}

#include "shared/tangent_coefficients_oblique.h"

/* Source terms of the derivatives by a group; zero ones are left unset. */
static inline void sources(const slopes *s, const series *of, int group, const vec **source)
{
    (void)s; (void)of;
    switch (group) {
    case BY_STOKES:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_stokes;
        source[ORBITAL_MOMENTUM] = s->orbital_momentum_by_stokes;
        source[SPIN] = s->spin_by_stokes;
        break;
    case BY_ASPECT:
        source[NORMAL_VELOCITY] = s->centrifugal_force_by_aspect;
        source[ORBITAL_MOMENTUM] = s->orbital_momentum_by_aspect;
        source[SPIN] = s->spin_by_aspect;
#if TURNING_STATE
        source[TURNED] = s->turned_by_aspect;
#endif
        break;
    case BY_OBLIQUITY:
        source[NORMAL_VELOCITY] = s->centrifugal_force_by_obliquity;
#if TURNING_STATE
        source[TURNED] = s->turned_by_obliquity;
#endif
        break;
    }
}

#endif
/* Contraction rate of a volume of states at the start of a step, dominated by the fast modes. */
static inline vec contraction(const series *of, const constants *v, vec film, vec shear)
{
    (void)of; (void)v; (void)film; (void)shear;
    return (0.4166666666666667*of->arm_lever_law.result[0]*v->aspect*shear*of->shear_log_factor_law.result[0]
        + 1.3333333333333333*v->aspect*shear*of->shear_log_factor_law.result[0]/of->distance[0] +
        film*of->film_resistance_law.result[0])/v->stokes;
}

#include "shared/start_along_oblique.h"

#include "shared/rebound_along_oblique.h"

#include "shared/outputs_along_oblique.h"

#include "shared/tangential_edge_along_oblique.h"

/* The groups that each quantity in SI moves, as bits. */
const unsigned moved_groups[QUANTITIES] = { 115, 1, 128, 256, 64, 64, 97, 226, 32, 113, 8, 16 };

#include "shared/scale_along_oblique.h"
