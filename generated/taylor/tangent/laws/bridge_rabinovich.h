/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 36e46923a94b238902fde09d8f0a84cd7caa23f0ba2ee09a4e8f1a196b537dce */

/* Slopes of the bridge law `rabinovich`. */

typedef struct { vec by_gap_over_radius_per_inverse_cylinder_reach, by_gap_over_radius_per_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach, by_volume_per_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach, by_contact_angle_per_gap_over_radius_over_cylinder_reach, by_contact_angle_offset; } bridge_force_slope_constants;

static inline void bridge_force_slope_prepare(bridge_force_slope_constants *c, const bridge_force_constants
    *v)
{
    (void)c; (void)v;
    c->by_gap_over_radius_per_inverse_cylinder_reach = -2.0*vec_cos(v->contact_angle);
    c->by_gap_over_radius_per_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach =
        2.0*vec_cos(v->contact_angle);
    c->by_volume_per_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach =
        2.0*vec_cos(v->contact_angle)/3.141592653589793;
    c->by_contact_angle_per_gap_over_radius_over_cylinder_reach = 2.0*vec_sin(v->contact_angle);
    c->by_contact_angle_offset = -2.0*vec_sin(v->contact_angle);
}

typedef struct {
    vec gap_over_radius_over_half_filling_angle[TERMS];
    vec over_gap_over_radius_over_half_filling_angle;
    vec gap_over_radius_over_half_filling_angle_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_over_half_filling_angle_over_cylinder_reach;
    vec inverse_half_filling_angle[TERMS];
    vec half_filling_angle_by_gap_over_radius[TERMS];
    vec half_filling_angle_by_gap_over_radius_by_sine_of_half_filling_angle[TERMS];
    vec half_filling_angle_by_gap_over_radius_by_sine_of_half_filling_angle_by_cosine_of_combination_4[TERMS];
    vec half_filling_angle_by_gap_over_radius_by_sine_of_combination_4[TERMS];
    vec half_filling_angle_by_gap_over_radius_by_sine_of_combination_4_by_cosine_of_half_filling_angle[TERMS];
    vec inverse_cylinder_reach[TERMS];
    vec cylinder_reach_squared[TERMS];
    vec gap_over_radius_squared_over_cylinder_reach_squared[TERMS];
    vec over_gap_over_radius_squared_over_cylinder_reach_squared;
    vec gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach;
    vec by_gap_over_radius[TERMS];
    vec sine_of_half_filling_angle_by_cosine_of_combination_4[TERMS];
    vec sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle[TERMS];
    vec sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle_over_cylinder_reach[TERMS];
    vec over_sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle_over_cylinder_reach;
    vec sine_of_combination_4_by_cosine_of_half_filling_angle[TERMS];
    vec sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle[TERMS];
    vec sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle_over_cylinder_reach[TERMS];
    vec over_sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle_over_cylinder_reach;
    vec gap_over_radius_over_cylinder_reach_squared[TERMS];
    vec over_gap_over_radius_over_cylinder_reach_squared;
    vec gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach;
    vec by_volume[TERMS];
    vec by_contact_angle[TERMS];
} bridge_force_slopes;

/* Derivatives of bridge_force by its arguments; products of series: 18.5. */
INLINE void bridge_force_slopes_of(bridge_force_slopes *restrict s, const bridge_force_slope_constants *c,
    const bridge_force_series *of, const bridge_force_constants *v, const vec *gap_over_radius)
{
    (void)gap_over_radius; (void)of; (void)c; (void)v;
    EACH_TERM(s->gap_over_radius_over_half_filling_angle[k] = quotient(gap_over_radius,
        of->half_filling_angle, s->gap_over_radius_over_half_filling_angle,
        &s->over_gap_over_radius_over_half_filling_angle, k);)
    EACH_TERM(s->gap_over_radius_over_half_filling_angle_over_cylinder_reach[k] =
        quotient(s->gap_over_radius_over_half_filling_angle, of->cylinder_reach,
        s->gap_over_radius_over_half_filling_angle_over_cylinder_reach,
        &s->over_gap_over_radius_over_half_filling_angle_over_cylinder_reach, k);)
    EACH_TERM(s->inverse_half_filling_angle[k] = reciprocal(of->half_filling_angle,
        s->inverse_half_filling_angle, k);)
    EACH_TERM(s->half_filling_angle_by_gap_over_radius[k] =
        0.5*s->gap_over_radius_over_half_filling_angle_over_cylinder_reach[k] -
        0.5*s->inverse_half_filling_angle[k];)
    EACH_TERM(s->half_filling_angle_by_gap_over_radius_by_sine_of_half_filling_angle[k] =
        product(of->sine_of_half_filling_angle, s->half_filling_angle_by_gap_over_radius, k);)
    EACH_TERM(s->half_filling_angle_by_gap_over_radius_by_sine_of_half_filling_angle_by_cosine_of_combination_4[k]
        = product(of->cosine_of_combination_4,
        s->half_filling_angle_by_gap_over_radius_by_sine_of_half_filling_angle, k);)
    EACH_TERM(s->half_filling_angle_by_gap_over_radius_by_sine_of_combination_4[k] =
        product(of->sine_of_combination_4, s->half_filling_angle_by_gap_over_radius, k);)
    EACH_TERM(s->half_filling_angle_by_gap_over_radius_by_sine_of_combination_4_by_cosine_of_half_filling_angle[k]
        = product(of->cosine_of_half_filling_angle,
        s->half_filling_angle_by_gap_over_radius_by_sine_of_combination_4, k);)
    EACH_TERM(s->inverse_cylinder_reach[k] = reciprocal(of->cylinder_reach, s->inverse_cylinder_reach, k);)
    EACH_TERM(s->cylinder_reach_squared[k] = square(of->cylinder_reach, k);)
    EACH_TERM(s->gap_over_radius_squared_over_cylinder_reach_squared[k] =
        quotient(of->gap_over_radius_squared, s->cylinder_reach_squared,
        s->gap_over_radius_squared_over_cylinder_reach_squared,
        &s->over_gap_over_radius_squared_over_cylinder_reach_squared, k);)
    EACH_TERM(s->gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach[k] =
        quotient(s->gap_over_radius_squared_over_cylinder_reach_squared, of->cylinder_reach,
        s->gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach,
        &s->over_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach, k);)
    EACH_TERM(s->by_gap_over_radius[k] =
        2.0*s->half_filling_angle_by_gap_over_radius_by_sine_of_half_filling_angle_by_cosine_of_combination_4[k]
        +
        2.0*s->half_filling_angle_by_gap_over_radius_by_sine_of_combination_4_by_cosine_of_half_filling_angle[k]
        + c->by_gap_over_radius_per_inverse_cylinder_reach*s->inverse_cylinder_reach[k] +
        c->by_gap_over_radius_per_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach*s->gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach[k];)
    EACH_TERM(s->sine_of_half_filling_angle_by_cosine_of_combination_4[k] =
        product(of->sine_of_half_filling_angle, of->cosine_of_combination_4, k);)
    EACH_TERM(s->sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle[k] =
        product(s->inverse_half_filling_angle, s->sine_of_half_filling_angle_by_cosine_of_combination_4, k);)
    EACH_TERM(s->sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle_over_cylinder_reach[k]
        = quotient(s->sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle,
        of->cylinder_reach,
        s->sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle_over_cylinder_reach,
        &s->over_sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle_over_cylinder_reach,
        k);)
    EACH_TERM(s->sine_of_combination_4_by_cosine_of_half_filling_angle[k] = product(of->sine_of_combination_4,
        of->cosine_of_half_filling_angle, k);)
    EACH_TERM(s->sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle[k] =
        product(s->inverse_half_filling_angle, s->sine_of_combination_4_by_cosine_of_half_filling_angle, k);)
    EACH_TERM(s->sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle_over_cylinder_reach[k]
        = quotient(s->sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle,
        of->cylinder_reach,
        s->sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle_over_cylinder_reach,
        &s->over_sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle_over_cylinder_reach,
        k);)
    EACH_TERM(s->gap_over_radius_over_cylinder_reach_squared[k] = quotient(gap_over_radius,
        s->cylinder_reach_squared, s->gap_over_radius_over_cylinder_reach_squared,
        &s->over_gap_over_radius_over_cylinder_reach_squared, k);)
    EACH_TERM(s->gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach[k] =
        quotient(s->gap_over_radius_over_cylinder_reach_squared, of->cylinder_reach,
        s->gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach,
        &s->over_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach, k);)
    EACH_TERM(s->by_volume[k] =
        0.3183098861837907*s->sine_of_half_filling_angle_by_cosine_of_combination_4_by_inverse_half_filling_angle_over_cylinder_reach[k]
        +
        0.3183098861837907*s->sine_of_combination_4_by_cosine_of_half_filling_angle_by_inverse_half_filling_angle_over_cylinder_reach[k]
        +
        c->by_volume_per_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach*s->gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach[k];)
    EACH_TERM(s->by_contact_angle[k] = k == 0 ?
        2.0*s->sine_of_half_filling_angle_by_cosine_of_combination_4[k] +
        c->by_contact_angle_per_gap_over_radius_over_cylinder_reach*of->gap_over_radius_over_cylinder_reach[k]
        + c->by_contact_angle_offset : 2.0*s->sine_of_half_filling_angle_by_cosine_of_combination_4[k] +
        c->by_contact_angle_per_gap_over_radius_over_cylinder_reach*of->gap_over_radius_over_cylinder_reach[k];)
}
