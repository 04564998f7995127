/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 b1c085b7f7ff297bcaa3a55727c03de42c344fcd4b502a3e3e517a42df32c334 */

/* Slopes of the bridge law `willett-simple`. */

typedef struct { vec by_gap_over_radius_per_combination_2_over_combination_3_squared, by_volume_per_scaled_gap_by_combination_2_over_combination_3_squared, by_contact_angle_per_inverse_combination; } bridge_force_slope_constants;

static inline void bridge_force_slope_prepare(bridge_force_slope_constants *c, const bridge_force_constants
    *v)
{
    (void)c; (void)v;
    c->by_gap_over_radius_per_combination_2_over_combination_3_squared =
        -40.0*vec_cos(v->contact_angle)/vec_sqrt(v->volume);
    c->by_volume_per_scaled_gap_by_combination_2_over_combination_3_squared =
        20.0*vec_cos(v->contact_angle)/v->volume;
    c->by_contact_angle_per_inverse_combination = -2.0*vec_sin(v->contact_angle);
}

typedef struct {
    vec combination_2[TERMS];
    vec combination_3[TERMS];
    vec combination_3_squared[TERMS];
    vec combination_2_over_combination_3_squared[TERMS];
    vec over_combination_2_over_combination_3_squared;
    vec by_gap_over_radius[TERMS];
    vec scaled_gap_by_combination_2[TERMS];
    vec scaled_gap_by_combination_2_over_combination_3_squared[TERMS];
    vec over_scaled_gap_by_combination_2_over_combination_3_squared;
    vec by_volume[TERMS];
    vec by_contact_angle[TERMS];
} bridge_force_slopes;

/* Derivatives of bridge_force by its arguments; products of series: 3.5. */
INLINE void bridge_force_slopes_of(bridge_force_slopes *restrict s, const bridge_force_slope_constants *c,
    const bridge_force_series *of, const bridge_force_constants *v, const vec *gap_over_radius)
{
    (void)gap_over_radius; (void)of; (void)c; (void)v;
    EACH_TERM(s->combination_2[k] = k == 0 ? 100.0*of->scaled_gap[k] + 21.0 : 100.0*of->scaled_gap[k];)
    EACH_TERM(s->combination_3[k] = k == 0 ? 50.0*of->scaled_gap_squared[k] + 21.0*of->scaled_gap[k] + 20.0 :
        50.0*of->scaled_gap_squared[k] + 21.0*of->scaled_gap[k];)
    EACH_TERM(s->combination_3_squared[k] = square(s->combination_3, k);)
    EACH_TERM(s->combination_2_over_combination_3_squared[k] = quotient(s->combination_2,
        s->combination_3_squared, s->combination_2_over_combination_3_squared,
        &s->over_combination_2_over_combination_3_squared, k);)
    EACH_TERM(s->by_gap_over_radius[k] =
        c->by_gap_over_radius_per_combination_2_over_combination_3_squared*s->combination_2_over_combination_3_squared[k];)
    EACH_TERM(s->scaled_gap_by_combination_2[k] = product(of->scaled_gap, s->combination_2, k);)
    EACH_TERM(s->scaled_gap_by_combination_2_over_combination_3_squared[k] =
        quotient(s->scaled_gap_by_combination_2, s->combination_3_squared,
        s->scaled_gap_by_combination_2_over_combination_3_squared,
        &s->over_scaled_gap_by_combination_2_over_combination_3_squared, k);)
    EACH_TERM(s->by_volume[k] =
        c->by_volume_per_scaled_gap_by_combination_2_over_combination_3_squared*s->scaled_gap_by_combination_2_over_combination_3_squared[k];)
    EACH_TERM(s->by_contact_angle[k] =
        c->by_contact_angle_per_inverse_combination*of->inverse_combination[k];)
}

static inline vec bridge_rupture_distance_by_volume(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.03333333333333333*(contact_angle + 2.0)*(vec_exp(0.3333333333333333*vec_log(volume)) +
        5.0)*vec_exp(0.6666666666666666*vec_log(1.0/volume));
}

static inline vec bridge_rupture_distance_by_contact_angle(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.05*(vec_exp(0.3333333333333333*vec_log(volume)) +
        10.0)*vec_exp(0.3333333333333333*vec_log(volume));
}
