/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 de6daef125dd7ea2f65f69c13d393df6e958d5ae294d4113eea61b7d054f82cc */

/* Tangent of oblique_strings.h: derivatives of the states by the groups.
 *
 * Products of series: 50 and those of the laws, then 13 a direction; backwards 27 and those of the laws'
 * derivatives. */

enum { BY_STOKES, BY_ASPECT, BY_OBLIQUITY, BY_INITIAL_TURNING, BY_INITIAL_SPIN, BY_WEIGHT, BY_STRING_RATIO, BY_GLASS_NUMBER, BY_ELASTIC_GAP, BY_ROUGH_GAP, BY_DRY_RESTITUTION };
const char group_names[] =
    "stokes "
    "aspect "
    "obliquity "
    "initial_turning "
    "initial_spin "
    "weight "
    "string_ratio "
    "glass_number "
    "elastic_gap "
    "rough_gap "
    "dry_restitution";
/* Groups that the rates depend on; the others enter at an event. */
static const unsigned char FLOWS[GROUPS] = { 1, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0 };

#if BACKWARD
typedef struct {
    shear_log_factor_slope_constants shear_log_factor_law;
    film_resistance_slope_constants film_resistance_law;
    strings_stiffness_slope_constants strings_stiffness_law;
    arm_lever_slope_constants arm_lever_law;
} slope_constants;

typedef struct {
    shear_log_factor_slopes shear_log_factor_law;
    film_resistance_slopes film_resistance_law;
    strings_stiffness_slopes strings_stiffness_law;
    arm_lever_slopes arm_lever_law;
} slopes;

/* Constants of the laws' derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    (void)c; (void)v;
    shear_log_factor_slope_prepare(&c->shear_log_factor_law, &v->shear_log_factor_law);
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    strings_stiffness_slope_prepare(&c->strings_stiffness_law, &v->strings_stiffness_law);
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
    strings_stiffness_slopes_of(&s->strings_stiffness_law, &c->strings_stiffness_law,
        &of->strings_stiffness_law, &v->strings_stiffness_law, of->offset_squared);
    arm_lever_slopes_of(&s->arm_lever_law, &c->arm_lever_law, &of->arm_lever_law, &v->arm_lever_law,
        of->distance);
}

enum { CONSTANTS = 9 };
/* Derivatives of a result by the coefficients of the series of a step, and by the constants so far. */
typedef struct {
    vec constant[CONSTANTS];
    vec ahead[27];
    vec rate_of_spin[TERMS];
    vec rate_of_orbital_momentum[TERMS];
    vec arm_lever_law[TERMS];
    vec string_sideways[TERMS];
    vec string_pull[TERMS];
    vec strings_stiffness_law[TERMS];
    vec distance_by_combination[TERMS];
    vec cosine_of_rotation[TERMS];
    vec sine_of_rotation[TERMS];
    vec gap_squared[TERMS];
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
 * states, then by coefficient k; `of_sum` those by their sums. Products of series: 27. */
INLINE void adjoint_coefficients(adjoint *bar, vec *w, const vec *of_sum, vec power, const series *of, const
    slopes *d, const constants *c, vec film, vec shear, mask moving, int k)
{
    double next = 1.0/(k + 1);
    (void)bar; (void)d; (void)c; (void)film; (void)shear; (void)moving;
    vec after_gap = w[GAP]*next;
    vec after_normal_velocity = only(moving, w[NORMAL_VELOCITY]*next);
    vec after_orbital_momentum = w[ORBITAL_MOMENTUM]*next;
    vec after_spin = w[SPIN]*next;
    vec after_rotation = w[ROTATION]*next;
    vec by_rate_of_rotation = after_rotation;
    bar->constant[0] += of->orbital_rate[k]*by_rate_of_rotation;
    bar->rate_of_spin[k] = after_spin;
    vec arm_lever_law_by_rate_of_spin = correlated(of->shear_force, bar->rate_of_spin, &bar->ahead[0], k);
    vec shear_force_by_rate_of_spin = correlated(of->arm_lever_law.result, bar->rate_of_spin, &bar->ahead[1],
        k);
    bar->rate_of_orbital_momentum[k] = after_orbital_momentum;
    vec distance_by_rate_of_orbital_momentum = correlated(of->combination_3, bar->rate_of_orbital_momentum,
        &bar->ahead[2], k);
    vec combination_3_by_rate_of_orbital_momentum = correlated(of->distance, bar->rate_of_orbital_momentum,
        &bar->ahead[3], k);
    vec by_combination_3 = (-combination_3_by_rate_of_orbital_momentum);
    vec by_rate_of_normal_velocity = after_normal_velocity;
    bar->arm_lever_law[k] = 0.3125*arm_lever_law_by_rate_of_spin;
    vec arm_lever_law_distance = correlated(d->arm_lever_law.by_distance, bar->arm_lever_law, &bar->ahead[4],
        k);
    bar->string_sideways[k] = by_combination_3;
    vec strings_stiffness_law_by_string_sideways = correlated(of->sine_of_rotation, bar->string_sideways,
        &bar->ahead[5], k);
    vec sine_of_rotation_by_string_sideways = correlated(of->strings_stiffness_law.result,
        bar->string_sideways, &bar->ahead[6], k);
    bar->constant[1] += of->strings_stiffness_law.result[k]*strings_stiffness_law_by_string_sideways;
    bar->string_pull[k] = (-by_rate_of_normal_velocity);
    vec combination_2_by_string_pull = correlated(of->strings_stiffness_law.result, bar->string_pull,
        &bar->ahead[7], k);
    vec strings_stiffness_law_by_string_pull = correlated(of->combination_2, bar->string_pull, &bar->ahead[8],
        k);
    bar->constant[2] += of->combination_2[k]*combination_2_by_string_pull;
    bar->strings_stiffness_law[k] = c->string_sideways_factor*strings_stiffness_law_by_string_sideways +
        c->weight*strings_stiffness_law_by_string_pull;
    bar->constant[3] += d->strings_stiffness_law.by_string_ratio[k]*bar->strings_stiffness_law[k];
    vec strings_stiffness_law_offset_squared = correlated(d->strings_stiffness_law.by_offset_squared,
        bar->strings_stiffness_law, &bar->ahead[9], k);
    vec by_combination_2 = c->weight*combination_2_by_string_pull;
    bar->constant[4] += of->gap[k]*by_combination_2;
    vec by_offset_squared = strings_stiffness_law_offset_squared;
    bar->constant[5] += of->gap_squared[k]*by_offset_squared;
    bar->distance_by_combination[k] = 4.0*by_offset_squared;
    vec distance_by_distance_by_combination = correlated(of->combination, bar->distance_by_combination,
        &bar->ahead[10], k);
    vec combination_by_distance_by_combination = correlated(of->distance, bar->distance_by_combination,
        &bar->ahead[11], k);
    vec by_combination = 8.0*by_combination_2 + combination_by_distance_by_combination;
    bar->cosine_of_rotation[k] = (-0.5)*by_combination;
    vec by_cosine_of_rotation = correlated(of->sine_of_rotation, bar->cosine_of_rotation, &bar->ahead[12], k);
    bar->sine_of_rotation[k] = c->string_sideways_factor*sine_of_rotation_by_string_sideways;
    vec by_sine_of_rotation = correlated(of->cosine_of_rotation, bar->sine_of_rotation, &bar->ahead[13], k);
    bar->gap_squared[k] = c->offset_squared_per_gap_squared*by_offset_squared;
    vec by_gap_squared = correlated(of->gap, bar->gap_squared, &bar->ahead[14], k);
    bar->film_force[k] = (-by_rate_of_normal_velocity);
    vec normal_velocity_by_film_force = correlated(of->film_resistance_law.result, bar->film_force,
        &bar->ahead[15], k);
    vec film_resistance_law_by_film_force = correlated(of->normal_velocity, bar->film_force, &bar->ahead[16],
        k);
    bar->constant[6] += film*of->normal_velocity[k]*normal_velocity_by_film_force;
    bar->film_resistance_law[k] = film*c->film_force_factor*film_resistance_law_by_film_force;
    vec film_resistance_law_gap = correlated(d->film_resistance_law.by_gap, bar->film_resistance_law,
        &bar->ahead[17], k);
    bar->centrifugal_force[k] = by_rate_of_normal_velocity;
    vec distance_by_centrifugal_force = correlated(of->orbital_rate_squared, bar->centrifugal_force,
        &bar->ahead[18], k);
    vec orbital_rate_squared_by_centrifugal_force = correlated(of->distance, bar->centrifugal_force,
        &bar->ahead[19], k);
    bar->constant[7] += of->distance[k]*distance_by_centrifugal_force;
    bar->orbital_rate_squared[k] = c->centrifugal_force_factor*orbital_rate_squared_by_centrifugal_force;
    vec by_orbital_rate_squared = correlated(of->orbital_rate, bar->orbital_rate_squared, &bar->ahead[20], k);
    bar->shear_force[k] = 0.3125*shear_force_by_rate_of_spin + by_combination_3;
    vec slip_by_shear_force = correlated(of->shear_log_factor_law.result, bar->shear_force, &bar->ahead[21],
        k);
    vec shear_log_factor_law_by_shear_force = correlated(of->slip, bar->shear_force, &bar->ahead[22], k);
    bar->constant[8] += shear*of->slip[k]*slip_by_shear_force;
    bar->shear_log_factor_law[k] = shear*c->shear_force_factor*shear_log_factor_law_by_shear_force;
    vec shear_log_factor_law_gap = correlated(d->shear_log_factor_law.by_gap, bar->shear_log_factor_law,
        &bar->ahead[23], k);
    bar->constant[4] += d->shear_log_factor_law.by_aspect[k]*bar->shear_log_factor_law[k];
    vec by_slip = shear*c->shear_force_factor*slip_by_shear_force;
    bar->orbital_rate[k] = (c->rate_of_rotation_per_orbital_rate*by_rate_of_rotation +
        2.0*by_orbital_rate_squared + by_slip - beyond(of->distance_squared, bar->orbital_rate,
        &bar->ahead[24], k))*of->over_orbital_rate;
    vec by_orbital_rate = correlated(of->orbital_rate, bar->orbital_rate, &bar->ahead[25], k);
    bar->distance_squared[k] = (-by_orbital_rate);
    vec by_distance_squared = correlated(of->distance, bar->distance_squared, &bar->ahead[26], k);
    vec by_distance = (-distance_by_rate_of_orbital_momentum) + arm_lever_law_distance +
        distance_by_distance_by_combination + c->centrifugal_force_factor*distance_by_centrifugal_force +
        2.0*by_distance_squared;
    bar->constant[4] += of->gap[k]*by_distance;
    w[GAP] = of_sum[GAP]*power + c->aspect*by_combination_2 + 2.0*by_gap_squared + film_resistance_law_gap +
        shear_log_factor_law_gap + c->aspect*by_distance;
    w[NORMAL_VELOCITY] = of_sum[NORMAL_VELOCITY]*power + after_gap +
        film*c->film_force_factor*normal_velocity_by_film_force;
    w[ORBITAL_MOMENTUM] = of_sum[ORBITAL_MOMENTUM]*power + bar->orbital_rate[k];
    w[SPIN] = of_sum[SPIN]*power + (-by_slip);
    w[ROTATION] = of_sum[ROTATION]*power + (-by_cosine_of_rotation) + by_sine_of_rotation;
}

/* From derivatives by the constants of the recurrences to those by the groups. */
static inline void along_constants(const constants *v, const vec *constant, vec *by_group)
{
    (void)v; (void)constant;
    by_group[BY_STOKES] += -1.0/(v->stokes*v->stokes)*constant[6] +
        -1.3333333333333333*v->aspect/(v->stokes*v->stokes)*constant[8];
    by_group[BY_ASPECT] += 0.25*v->obliquity*constant[0] + constant[4] + 0.5*v->aspect*constant[5] +
        0.0625*(v->obliquity*v->obliquity)*constant[7] + 1.3333333333333333/v->stokes*constant[8];
    by_group[BY_OBLIQUITY] += 0.25*v->aspect*constant[0] +
        -16.0*v->weight/(v->obliquity*v->obliquity)*constant[1] + 0.125*v->aspect*v->obliquity*constant[7];
    by_group[BY_WEIGHT] += 16.0/v->obliquity*constant[1] + constant[2];
    by_group[BY_STRING_RATIO] += constant[3];
}

#else
typedef struct {
    vec film_force_by_gap_factor;
    vec offset_squared_by_gap_per_gap;
    vec offset_squared_by_gap_per_combination;
    vec combination_4_per_gap;
    vec combination_4_per_combination;
    vec centrifugal_force_by_aspect_per_gap_by_orbital_rate_squared;
    vec centrifugal_force_by_aspect_per_centrifugal_force;
    vec offset_squared_by_aspect_per_gap_squared;
    vec centrifugal_force_by_obliquity_per_centrifugal_force;
    vec shear_force_by_gap_per_orbital_rate_by_shear_log_factor_law_over_distance;
    vec shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip;
    vec string_sideways_by_gap_factor;
    vec shear_force_by_aspect_per_gap_by_orbital_rate_by_shear_log_factor_law_over_distance;
    vec string_sideways_by_obliquity_per_string_sideways;
    vec normal_velocity_by_gap_per_orbital_rate_squared;
    vec normal_velocity_by_normal_velocity_per_film_resistance_law;
    vec normal_velocity_by_orbital_momentum_per_orbital_rate_over_distance;
    vec normal_velocity_by_weight_per_string_pull;
    vec orbital_momentum_by_gap_per_shear_force;
    vec orbital_momentum_by_orbital_momentum_per_shear_log_factor_law_over_distance;
    vec spin_by_gap_per_arm_lever_law_by_distance_by_shear_force;
    vec spin_by_orbital_momentum_per_arm_lever_law_by_shear_log_factor_law_over_distance_squared;
    vec spin_by_spin_per_arm_lever_law_by_shear_log_factor_law;
    vec rotation_by_gap_per_orbital_rate_over_distance;
    vec rotation_by_orbital_momentum_per_inverse_distance_squared;
    vec rotation_by_aspect_per_gap_by_orbital_rate_over_distance;
    vec rotation_by_aspect_per_orbital_rate;
    vec rotation_by_obliquity_per_orbital_rate;
    shear_log_factor_slope_constants shear_log_factor_law;
    film_resistance_slope_constants film_resistance_law;
    strings_stiffness_slope_constants strings_stiffness_law;
    arm_lever_slope_constants arm_lever_law;
} slope_constants;

/* Constants of the derivatives, computed once per collision. */
static inline void prepare_slopes(slope_constants *c, const constants *v)
{
    c->film_force_by_gap_factor = 1.0/v->stokes;
    c->offset_squared_by_gap_per_gap = 0.5*(v->aspect*v->aspect);
    c->offset_squared_by_gap_per_combination = 4.0*v->aspect;
    c->combination_4_per_gap = v->aspect*v->weight;
    c->combination_4_per_combination = 8.0*v->weight;
    c->centrifugal_force_by_aspect_per_gap_by_orbital_rate_squared =
        -0.1875*v->aspect*(v->obliquity*v->obliquity);
    c->centrifugal_force_by_aspect_per_centrifugal_force = 1.0/v->aspect;
    c->offset_squared_by_aspect_per_gap_squared = 0.5*v->aspect;
    c->centrifugal_force_by_obliquity_per_centrifugal_force = 2.0/v->obliquity;
    c->shear_force_by_gap_per_orbital_rate_by_shear_log_factor_law_over_distance =
        -2.6666666666666665*(v->aspect*v->aspect)/v->stokes;
    c->shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip = 1.3333333333333333*v->aspect/v->stokes;
    c->string_sideways_by_gap_factor = 16.0*v->weight/v->obliquity;
    c->shear_force_by_aspect_per_gap_by_orbital_rate_by_shear_log_factor_law_over_distance =
        -2.6666666666666665*v->aspect/v->stokes;
    c->string_sideways_by_obliquity_per_string_sideways = -1.0/v->obliquity;
    c->normal_velocity_by_gap_per_orbital_rate_squared =
        -0.1875*(v->aspect*v->aspect)*(v->obliquity*v->obliquity);
    c->normal_velocity_by_normal_velocity_per_film_resistance_law = -1.0/v->stokes;
    c->normal_velocity_by_orbital_momentum_per_orbital_rate_over_distance =
        0.125*v->aspect*(v->obliquity*v->obliquity);
    c->normal_velocity_by_weight_per_string_pull = -1.0/v->weight;
    c->orbital_momentum_by_gap_per_shear_force = -v->aspect;
    c->orbital_momentum_by_orbital_momentum_per_shear_log_factor_law_over_distance =
        -1.3333333333333333*v->aspect/v->stokes;
    c->spin_by_gap_per_arm_lever_law_by_distance_by_shear_force = 0.3125*v->aspect;
    c->spin_by_orbital_momentum_per_arm_lever_law_by_shear_log_factor_law_over_distance_squared =
        0.4166666666666667*v->aspect/v->stokes;
    c->spin_by_spin_per_arm_lever_law_by_shear_log_factor_law = -0.4166666666666667*v->aspect/v->stokes;
    c->rotation_by_gap_per_orbital_rate_over_distance = -0.5*(v->aspect*v->aspect)*v->obliquity;
    c->rotation_by_orbital_momentum_per_inverse_distance_squared = 0.25*v->aspect*v->obliquity;
    c->rotation_by_aspect_per_gap_by_orbital_rate_over_distance = -0.5*v->aspect*v->obliquity;
    c->rotation_by_aspect_per_orbital_rate = 0.25*v->obliquity;
    c->rotation_by_obliquity_per_orbital_rate = 0.25*v->aspect;
    shear_log_factor_slope_prepare(&c->shear_log_factor_law, &v->shear_log_factor_law);
    film_resistance_slope_prepare(&c->film_resistance_law, &v->film_resistance_law);
    strings_stiffness_slope_prepare(&c->strings_stiffness_law, &v->strings_stiffness_law);
    arm_lever_slope_prepare(&c->arm_lever_law, &v->arm_lever_law);
}

/* Derivatives of the rates: entries of the matrix, and source terms of a direction. */
typedef struct {
    vec centrifugal_force_by_obliquity[TERMS];
    vec normal_velocity_by_gap[TERMS];
    vec normal_velocity_by_normal_velocity[TERMS];
    vec normal_velocity_by_orbital_momentum[TERMS];
    vec normal_velocity_by_rotation[TERMS];
    vec normal_velocity_by_stokes[TERMS];
    vec normal_velocity_by_aspect[TERMS];
    vec normal_velocity_by_weight[TERMS];
    vec normal_velocity_by_string_ratio[TERMS];
    vec orbital_momentum_by_gap[TERMS];
    vec orbital_momentum_by_orbital_momentum[TERMS];
    vec orbital_momentum_by_spin[TERMS];
    vec orbital_momentum_by_rotation[TERMS];
    vec orbital_momentum_by_stokes[TERMS];
    vec orbital_momentum_by_aspect[TERMS];
    vec orbital_momentum_by_obliquity[TERMS];
    vec orbital_momentum_by_weight[TERMS];
    vec orbital_momentum_by_string_ratio[TERMS];
    vec spin_by_gap[TERMS];
    vec spin_by_orbital_momentum[TERMS];
    vec spin_by_spin[TERMS];
    vec spin_by_stokes[TERMS];
    vec spin_by_aspect[TERMS];
    vec rotation_by_gap[TERMS];
    vec rotation_by_orbital_momentum[TERMS];
    vec rotation_by_aspect[TERMS];
    vec rotation_by_obliquity[TERMS];
} slopes;

/* Derivatives of the rates by the states, and by the requested groups. */
OUTLINE void expand_slopes(slopes *restrict s, const slope_constants *c, const series *of, const constants *v,
    vec film, vec shear, unsigned asked)
{
    shear_log_factor_slopes shear_log_factor_law;
    film_resistance_slopes film_resistance_law;
    strings_stiffness_slopes strings_stiffness_law;
    arm_lever_slopes arm_lever_law;
    vec film_force_by_gap[TERMS];
    vec offset_squared_by_gap[TERMS];
    vec strings_stiffness_by_gap[TERMS];
    vec combination_4[TERMS];
    vec strings_stiffness_by_gap_by_combination_4[TERMS];
    vec string_pull_by_gap[TERMS];
    vec scaled_rotation[TERMS];
    vec sine_of_scaled_rotation[TERMS], slope_of_scaled_rotation[TERMS];
    vec cosine_of_scaled_rotation[TERMS];
    vec distance_by_sine_of_scaled_rotation[TERMS];
    vec offset_squared_by_rotation[TERMS];
    vec strings_stiffness_by_rotation[TERMS];
    vec strings_stiffness_by_rotation_by_combination_4[TERMS];
    vec strings_stiffness_law_by_sine_of_scaled_rotation[TERMS];
    vec strings_stiffness_law_by_sine_of_scaled_rotation_by_cosine_of_scaled_rotation[TERMS];
    vec string_pull_by_rotation[TERMS];
    vec gap_by_orbital_rate_squared[TERMS];
    vec centrifugal_force_by_aspect[TERMS];
    vec gap_by_combination[TERMS];
    vec offset_squared_by_aspect[TERMS];
    vec strings_stiffness_by_aspect[TERMS];
    vec combination_5[TERMS];
    vec gap_by_combination_5[TERMS];
    vec strings_stiffness_by_aspect_by_combination[TERMS];
    vec string_pull_by_aspect[TERMS];
    vec string_pull_by_string_ratio[TERMS];
    vec orbital_rate_by_shear_log_factor_law[TERMS];
    vec orbital_rate_by_shear_log_factor_law_over_distance[TERMS];
    vec over_orbital_rate_by_shear_log_factor_law_over_distance;
    vec shear_log_factor_law_by_gap_by_slip[TERMS];
    vec shear_force_by_gap[TERMS];
    vec string_sideways_by_gap[TERMS];
    vec strings_stiffness_by_rotation_by_sine_of_rotation[TERMS];
    vec strings_stiffness_law_by_cosine_of_rotation[TERMS];
    vec string_sideways_by_rotation[TERMS];
    vec shear_log_factor_law_by_aspect_by_slip[TERMS];
    vec gap_by_orbital_rate[TERMS];
    vec gap_by_orbital_rate_by_shear_log_factor_law[TERMS];
    vec gap_by_orbital_rate_by_shear_log_factor_law_over_distance[TERMS];
    vec over_gap_by_orbital_rate_by_shear_log_factor_law_over_distance;
    vec shear_force_by_aspect[TERMS];
    vec string_sideways_by_aspect[TERMS];
    vec string_sideways_by_obliquity[TERMS];
    vec string_sideways_by_string_ratio[TERMS];
    vec arm_lever_by_aspect[TERMS];
    vec orbital_rate_over_distance[TERMS];
    vec over_orbital_rate_over_distance;
    vec combination_6[TERMS];
    vec distance_by_combination_6[TERMS];
    vec shear_log_factor_law_over_distance[TERMS];
    vec over_shear_log_factor_law_over_distance;
    vec combination_7[TERMS];
    vec distance_by_combination_7[TERMS];
    vec gap_by_shear_force[TERMS];
    vec gap_by_string_sideways[TERMS];
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
    strings_stiffness_slopes_of(&strings_stiffness_law, &c->strings_stiffness_law, &of->strings_stiffness_law,
        &v->strings_stiffness_law, of->offset_squared);
    arm_lever_slopes_of(&arm_lever_law, &c->arm_lever_law, &of->arm_lever_law, &v->arm_lever_law,
        of->distance);
    EACH_TERM(film_force_by_gap[k] = film*c->film_force_by_gap_factor*product(film_resistance_law.by_gap,
        of->normal_velocity, k);)
    EACH_TERM(offset_squared_by_gap[k] = c->offset_squared_by_gap_per_gap*of->gap[k] +
        c->offset_squared_by_gap_per_combination*of->combination[k];)
    EACH_TERM(strings_stiffness_by_gap[k] = product(strings_stiffness_law.by_offset_squared,
        offset_squared_by_gap, k);)
    EACH_TERM(combination_4[k] = c->combination_4_per_gap*of->gap[k] +
        c->combination_4_per_combination*of->combination[k];)
    EACH_TERM(strings_stiffness_by_gap_by_combination_4[k] = product(strings_stiffness_by_gap, combination_4,
        k);)
    EACH_TERM(string_pull_by_gap[k] = c->combination_4_per_gap*of->strings_stiffness_law.result[k] +
        strings_stiffness_by_gap_by_combination_4[k];)
    EACH_TERM(scaled_rotation[k] = 0.5*of->rotation[k];)
    EACH_TERM(circular(scaled_rotation, slope_of_scaled_rotation, sine_of_scaled_rotation,
        cosine_of_scaled_rotation, k);)
    /* cosine_of_scaled_rotation comes with its sine */
    EACH_TERM(distance_by_sine_of_scaled_rotation[k] = product(of->distance, sine_of_scaled_rotation, k);)
    EACH_TERM(offset_squared_by_rotation[k] = 4.0*product(cosine_of_scaled_rotation,
        distance_by_sine_of_scaled_rotation, k);)
    EACH_TERM(strings_stiffness_by_rotation[k] = product(strings_stiffness_law.by_offset_squared,
        offset_squared_by_rotation, k);)
    EACH_TERM(strings_stiffness_by_rotation_by_combination_4[k] = product(combination_4,
        strings_stiffness_by_rotation, k);)
    EACH_TERM(strings_stiffness_law_by_sine_of_scaled_rotation[k] = product(of->strings_stiffness_law.result,
        sine_of_scaled_rotation, k);)
    EACH_TERM(strings_stiffness_law_by_sine_of_scaled_rotation_by_cosine_of_scaled_rotation[k] =
        product(cosine_of_scaled_rotation, strings_stiffness_law_by_sine_of_scaled_rotation, k);)
    EACH_TERM(string_pull_by_rotation[k] = strings_stiffness_by_rotation_by_combination_4[k] +
        c->combination_4_per_combination*strings_stiffness_law_by_sine_of_scaled_rotation_by_cosine_of_scaled_rotation[k];)
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
    EACH_TERM(string_sideways_by_gap[k] = c->string_sideways_by_gap_factor*product(of->sine_of_rotation,
        strings_stiffness_by_gap, k);)
    EACH_TERM(strings_stiffness_by_rotation_by_sine_of_rotation[k] = product(of->sine_of_rotation,
        strings_stiffness_by_rotation, k);)
    EACH_TERM(strings_stiffness_law_by_cosine_of_rotation[k] = product(of->strings_stiffness_law.result,
        of->cosine_of_rotation, k);)
    EACH_TERM(string_sideways_by_rotation[k] =
        c->string_sideways_by_gap_factor*strings_stiffness_by_rotation_by_sine_of_rotation[k] +
        c->string_sideways_by_gap_factor*strings_stiffness_law_by_cosine_of_rotation[k];)
    EACH_TERM(s->normal_velocity_by_gap[k] =
        c->normal_velocity_by_gap_per_orbital_rate_squared*of->orbital_rate_squared[k] - film_force_by_gap[k]
        - string_pull_by_gap[k];)
    EACH_TERM(s->normal_velocity_by_normal_velocity[k] =
        film*c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->film_resistance_law.result[k];)
    EACH_TERM(orbital_rate_over_distance[k] = quotient(of->orbital_rate, of->distance,
        orbital_rate_over_distance, &over_orbital_rate_over_distance, k);)
    EACH_TERM(s->normal_velocity_by_orbital_momentum[k] =
        c->normal_velocity_by_orbital_momentum_per_orbital_rate_over_distance*orbital_rate_over_distance[k];)
    EACH_TERM(s->normal_velocity_by_rotation[k] = -string_pull_by_rotation[k];)
    EACH_TERM(combination_6[k] = -shear_force_by_gap[k] - string_sideways_by_gap[k];)
    EACH_TERM(distance_by_combination_6[k] = product(of->distance, combination_6, k);)
    EACH_TERM(s->orbital_momentum_by_gap[k] = c->orbital_momentum_by_gap_per_shear_force*of->shear_force[k] +
        c->orbital_momentum_by_gap_per_shear_force*of->string_sideways[k] + distance_by_combination_6[k];)
    EACH_TERM(shear_log_factor_law_over_distance[k] = quotient(of->shear_log_factor_law.result, of->distance,
        shear_log_factor_law_over_distance, &over_shear_log_factor_law_over_distance, k);)
    EACH_TERM(s->orbital_momentum_by_orbital_momentum[k] =
        shear*c->orbital_momentum_by_orbital_momentum_per_shear_log_factor_law_over_distance*shear_log_factor_law_over_distance[k];)
    EACH_TERM(s->orbital_momentum_by_spin[k] =
        shear*c->shear_force_by_gap_per_shear_log_factor_law_by_gap_by_slip*product(of->distance,
        of->shear_log_factor_law.result, k);)
    EACH_TERM(s->orbital_momentum_by_rotation[k] = -product(of->distance, string_sideways_by_rotation, k);)
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
    EACH_TERM(s->rotation_by_gap[k] =
        c->rotation_by_gap_per_orbital_rate_over_distance*orbital_rate_over_distance[k];)
    EACH_TERM(inverse_distance_squared[k] = reciprocal(of->distance_squared, inverse_distance_squared, k);)
    EACH_TERM(s->rotation_by_orbital_momentum[k] =
        c->rotation_by_orbital_momentum_per_inverse_distance_squared*inverse_distance_squared[k];)
    if (asked & (1u << BY_ASPECT)) {
        EACH_TERM(gap_by_orbital_rate_squared[k] = product(of->gap, of->orbital_rate_squared, k);)
        EACH_TERM(centrifugal_force_by_aspect[k] =
        c->centrifugal_force_by_aspect_per_gap_by_orbital_rate_squared*gap_by_orbital_rate_squared[k] +
        c->centrifugal_force_by_aspect_per_centrifugal_force*of->centrifugal_force[k];)
        EACH_TERM(gap_by_combination[k] = product(of->gap, of->combination, k);)
        EACH_TERM(offset_squared_by_aspect[k] = c->offset_squared_by_aspect_per_gap_squared*of->gap_squared[k]
        + 4.0*gap_by_combination[k];)
        EACH_TERM(strings_stiffness_by_aspect[k] = product(strings_stiffness_law.by_offset_squared,
        offset_squared_by_aspect, k);)
        EACH_TERM(combination_5[k] = c->combination_4_per_gap*strings_stiffness_by_aspect[k] +
        v->weight*of->strings_stiffness_law.result[k];)
        EACH_TERM(gap_by_combination_5[k] = product(of->gap, combination_5, k);)
        EACH_TERM(strings_stiffness_by_aspect_by_combination[k] = product(of->combination,
        strings_stiffness_by_aspect, k);)
        EACH_TERM(string_pull_by_aspect[k] = gap_by_combination_5[k] +
        c->combination_4_per_combination*strings_stiffness_by_aspect_by_combination[k];)
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
        EACH_TERM(string_sideways_by_aspect[k] =
        c->string_sideways_by_gap_factor*product(of->sine_of_rotation, strings_stiffness_by_aspect, k);)
        EACH_TERM(arm_lever_by_aspect[k] = product(arm_lever_law.by_distance, of->gap, k);)
        EACH_TERM(s->normal_velocity_by_aspect[k] = centrifugal_force_by_aspect[k] -
        string_pull_by_aspect[k];)
        EACH_TERM(combination_7[k] = -shear_force_by_aspect[k] - string_sideways_by_aspect[k];)
        EACH_TERM(distance_by_combination_7[k] = product(of->distance, combination_7, k);)
        EACH_TERM(gap_by_shear_force[k] = product(of->gap, of->shear_force, k);)
        EACH_TERM(gap_by_string_sideways[k] = product(of->gap, of->string_sideways, k);)
        EACH_TERM(s->orbital_momentum_by_aspect[k] = distance_by_combination_7[k] - gap_by_shear_force[k] -
        gap_by_string_sideways[k];)
        EACH_TERM(arm_lever_by_aspect_by_shear_force[k] = product(of->shear_force, arm_lever_by_aspect, k);)
        EACH_TERM(arm_lever_law_by_shear_force_by_aspect[k] = product(of->arm_lever_law.result,
        shear_force_by_aspect, k);)
        EACH_TERM(s->spin_by_aspect[k] = 0.3125*arm_lever_by_aspect_by_shear_force[k] +
        0.3125*arm_lever_law_by_shear_force_by_aspect[k];)
        EACH_TERM(gap_by_orbital_rate_over_distance[k] = quotient(gap_by_orbital_rate, of->distance,
        gap_by_orbital_rate_over_distance, &over_gap_by_orbital_rate_over_distance, k);)
        EACH_TERM(s->rotation_by_aspect[k] =
        c->rotation_by_aspect_per_gap_by_orbital_rate_over_distance*gap_by_orbital_rate_over_distance[k] +
        c->rotation_by_aspect_per_orbital_rate*of->orbital_rate[k];)
    }
    if (asked & (1u << BY_OBLIQUITY)) {
        EACH_TERM(s->centrifugal_force_by_obliquity[k] =
        c->centrifugal_force_by_obliquity_per_centrifugal_force*of->centrifugal_force[k];)
        EACH_TERM(string_sideways_by_obliquity[k] =
        c->string_sideways_by_obliquity_per_string_sideways*of->string_sideways[k];)
        EACH_TERM(s->orbital_momentum_by_obliquity[k] = -product(of->distance, string_sideways_by_obliquity,
        k);)
        EACH_TERM(s->rotation_by_obliquity[k] =
        c->rotation_by_obliquity_per_orbital_rate*of->orbital_rate[k];)
    }
    if (asked & (1u << BY_STOKES)) {
        EACH_TERM(s->normal_velocity_by_stokes[k] = c->film_force_by_gap_factor*of->film_force[k];)
        EACH_TERM(s->orbital_momentum_by_stokes[k] = c->film_force_by_gap_factor*product(of->distance,
        of->shear_force, k);)
        EACH_TERM(s->spin_by_stokes[k] =
        c->normal_velocity_by_normal_velocity_per_film_resistance_law*of->rate_of_spin[k];)
    }
    if (asked & (1u << BY_STRING_RATIO)) {
        EACH_TERM(string_pull_by_string_ratio[k] = v->weight*product(strings_stiffness_law.by_string_ratio,
        of->combination_2, k);)
        EACH_TERM(string_sideways_by_string_ratio[k] =
        c->string_sideways_by_gap_factor*product(strings_stiffness_law.by_string_ratio, of->sine_of_rotation,
        k);)
        EACH_TERM(s->normal_velocity_by_string_ratio[k] = -string_pull_by_string_ratio[k];)
        EACH_TERM(s->orbital_momentum_by_string_ratio[k] = -product(of->distance,
        string_sideways_by_string_ratio, k);)
    }
    if (asked & (1u << BY_WEIGHT)) {
        EACH_TERM(s->normal_velocity_by_weight[k] =
        c->normal_velocity_by_weight_per_string_pull*of->string_pull[k];)
        EACH_TERM(s->orbital_momentum_by_weight[k] =
        c->normal_velocity_by_weight_per_string_pull*product(of->distance, of->string_sideways, k);)
    }
}

/* Coefficient k + 1 of a derivative of the states, with its source terms. */
INLINE void tangent_coefficients(vec (*t)[TERMS], const slopes *s, const slope_constants *c, const series *of,
    const constants *v, vec film, vec shear, const vec *const *source, int k)
{
    double next = 1.0/(k + 1);
    (void)s; (void)c; (void)of; (void)v; (void)film; (void)shear;
    t[GAP][k + 1] = (t[NORMAL_VELOCITY][k])*next;
    t[NORMAL_VELOCITY][k + 1] = (product(s->normal_velocity_by_gap, t[GAP], k) +
        product(s->normal_velocity_by_normal_velocity, t[NORMAL_VELOCITY], k) +
        product(s->normal_velocity_by_orbital_momentum, t[ORBITAL_MOMENTUM], k) +
        product(s->normal_velocity_by_rotation, t[ROTATION], k) + source[NORMAL_VELOCITY][k])*next;
    t[ORBITAL_MOMENTUM][k + 1] = (product(s->orbital_momentum_by_gap, t[GAP], k) +
        product(s->orbital_momentum_by_orbital_momentum, t[ORBITAL_MOMENTUM], k) +
        product(s->orbital_momentum_by_spin, t[SPIN], k) + product(s->orbital_momentum_by_rotation,
        t[ROTATION], k) + source[ORBITAL_MOMENTUM][k])*next;
    t[SPIN][k + 1] = (product(s->spin_by_gap, t[GAP], k) + product(s->spin_by_orbital_momentum,
        t[ORBITAL_MOMENTUM], k) + product(s->spin_by_spin, t[SPIN], k) + source[SPIN][k])*next;
    t[ROTATION][k + 1] = (product(s->rotation_by_gap, t[GAP], k) + product(s->rotation_by_orbital_momentum,
        t[ORBITAL_MOMENTUM], k) + source[ROTATION][k])*next;
}

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
        source[NORMAL_VELOCITY] = s->normal_velocity_by_aspect;
        source[ORBITAL_MOMENTUM] = s->orbital_momentum_by_aspect;
        source[SPIN] = s->spin_by_aspect;
        source[ROTATION] = s->rotation_by_aspect;
        break;
    case BY_OBLIQUITY:
        source[NORMAL_VELOCITY] = s->centrifugal_force_by_obliquity;
        source[ORBITAL_MOMENTUM] = s->orbital_momentum_by_obliquity;
        source[ROTATION] = s->rotation_by_obliquity;
        break;
    case BY_WEIGHT:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_weight;
        source[ORBITAL_MOMENTUM] = s->orbital_momentum_by_weight;
        break;
    case BY_STRING_RATIO:
        source[NORMAL_VELOCITY] = s->normal_velocity_by_string_ratio;
        source[ORBITAL_MOMENTUM] = s->orbital_momentum_by_string_ratio;
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

/* Derivative of the initial state by a group. */
static inline void start_along(const constants *v, int group, vec *after)
{
    (void)v;
    after[GAP] = splat(0.0);
    after[NORMAL_VELOCITY] = splat(0.0);
    after[ORBITAL_MOMENTUM] = splat(0.0);
    after[SPIN] = splat(0.0);
    after[ROTATION] = splat(0.0);
    switch (group) {
    case BY_ASPECT:
        after[ORBITAL_MOMENTUM] += 2.0*v->initial_turning*(v->aspect + 4.0);
        break;
    case BY_INITIAL_TURNING:
        after[ORBITAL_MOMENTUM] += ((v->aspect + 4.0)*(v->aspect + 4.0));
        break;
    case BY_INITIAL_SPIN:
        after[SPIN] += 1.0;
        break;
    }
}

/* Derivative of the state just after a rebound. */
static inline void rebound_along(const constants *v, const vec *y, const vec *t, int group, vec *after)
{
    (void)v;
    (void)y;
    after[GAP] = t[GAP];
    after[NORMAL_VELOCITY] = -v->dry_restitution*t[NORMAL_VELOCITY];
    after[ORBITAL_MOMENTUM] = t[ORBITAL_MOMENTUM];
    after[SPIN] = t[SPIN];
    after[ROTATION] = t[ROTATION];
    switch (group) {
    case BY_DRY_RESTITUTION:
        after[NORMAL_VELOCITY] += -y[NORMAL_VELOCITY];
        break;
    }
}

#include "shared/outputs_along_oblique.h"

#include "shared/tangential_edge_along_oblique.h"

/* The groups that each quantity in SI moves, as bits. */
const unsigned moved_groups[QUANTITIES] = { 467, 1, 512, 1024, 256, 256, 385, 930, 128, 64, 32, 433, 8, 16 };

/* How the groups change with a quantity in SI. */
static inline void scale_along(const constants *v, const vec *q, int quantity, vec *slope)
{
    (void)v; (void)q;
    memset(slope, 0, sizeof(vec)*GROUPS);
    switch (quantity) {
    case SI_REDUCED_RADIUS:
        slope[BY_STOKES] = -2.0*v->stokes/q[SI_REDUCED_RADIUS];
        slope[BY_ASPECT] = -v->aspect/q[SI_REDUCED_RADIUS];
        slope[BY_INITIAL_SPIN] = v->initial_spin/q[SI_REDUCED_RADIUS];
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
        slope[BY_INITIAL_SPIN] = -v->initial_spin/q[SI_SPEED];
        slope[BY_WEIGHT] = -2.0*v->weight/q[SI_SPEED];
        slope[BY_GLASS_NUMBER] = -v->glass_number/q[SI_SPEED];
        slope[BY_ELASTIC_GAP] = 0.4*v->elastic_gap/q[SI_SPEED];
        break;
    case SI_ANGLE:
        slope[BY_INITIAL_TURNING] = ((vec_tan(q[SI_ANGLE])*vec_tan(q[SI_ANGLE])) + 1.0)/v->obliquity;
        break;
    case SI_IMPACT_SPIN:
        slope[BY_INITIAL_SPIN] = 4.0*q[SI_REDUCED_RADIUS]/(v->obliquity*q[SI_SPEED]);
        break;
    }
}
