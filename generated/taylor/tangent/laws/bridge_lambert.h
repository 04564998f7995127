/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 672b476bc6acde06a4ee8a2d6138d5c3c5a2763a679af7727c4a1b86c6e97a88 */

/* Slopes of the bridge law `lambert`. */

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
    vec inverse_cylinder_reach[TERMS];
    vec cylinder_reach_squared[TERMS];
    vec gap_over_radius_squared_over_cylinder_reach_squared[TERMS];
    vec over_gap_over_radius_squared_over_cylinder_reach_squared;
    vec gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach;
    vec by_gap_over_radius[TERMS];
    vec gap_over_radius_over_cylinder_reach_squared[TERMS];
    vec over_gap_over_radius_over_cylinder_reach_squared;
    vec gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach;
    vec by_volume[TERMS];
    vec by_contact_angle[TERMS];
} bridge_force_slopes;

/* Derivatives of bridge_force by its arguments; products of series: 5.5. */
INLINE void bridge_force_slopes_of(bridge_force_slopes *restrict s, const bridge_force_slope_constants *c,
    const bridge_force_series *of, const bridge_force_constants *v, const vec *gap_over_radius)
{
    (void)gap_over_radius; (void)of; (void)c; (void)v;
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
        c->by_gap_over_radius_per_inverse_cylinder_reach*s->inverse_cylinder_reach[k] +
        c->by_gap_over_radius_per_gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach*s->gap_over_radius_squared_over_cylinder_reach_squared_over_cylinder_reach[k];)
    EACH_TERM(s->gap_over_radius_over_cylinder_reach_squared[k] = quotient(gap_over_radius,
        s->cylinder_reach_squared, s->gap_over_radius_over_cylinder_reach_squared,
        &s->over_gap_over_radius_over_cylinder_reach_squared, k);)
    EACH_TERM(s->gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach[k] =
        quotient(s->gap_over_radius_over_cylinder_reach_squared, of->cylinder_reach,
        s->gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach,
        &s->over_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach, k);)
    EACH_TERM(s->by_volume[k] =
        c->by_volume_per_gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach*s->gap_over_radius_over_cylinder_reach_squared_over_cylinder_reach[k];)
    EACH_TERM(s->by_contact_angle[k] = k == 0 ?
        c->by_contact_angle_per_gap_over_radius_over_cylinder_reach*of->gap_over_radius_over_cylinder_reach[k]
        + c->by_contact_angle_offset :
        c->by_contact_angle_per_gap_over_radius_over_cylinder_reach*of->gap_over_radius_over_cylinder_reach[k];)
}
