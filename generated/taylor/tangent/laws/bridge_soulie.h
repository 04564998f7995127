/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8ae8f5d0d1f3a56bcd8b692dbaee4bcc8ceb364871fd1fed87a9903744733ff7 */

/* Slopes of the bridge law `soulie`. */

typedef struct { vec offset_by_volume, offset_by_contact_angle, by_volume_per_gap_over_radius_by_exp_of_combination, by_volume_offset; } bridge_force_slope_constants;

static inline void bridge_force_slope_prepare(bridge_force_slope_constants *c, const bridge_force_constants
    *v)
{
    (void)c; (void)v;
    c->offset_by_volume = -0.148*(v->contact_angle*v->contact_angle)/v->volume - 0.0082/v->volume;
    c->offset_by_contact_angle = -0.296*v->contact_angle*v->log_volume - 1.92*v->contact_angle;
    c->by_volume_per_gap_over_radius_by_exp_of_combination = -0.53*v->decay/v->volume;
    c->by_volume_offset = 0.0018/v->volume;
}

typedef struct {
    vec by_gap_over_radius[TERMS];
    vec gap_over_radius_by_exp_of_combination[TERMS];
    vec by_volume[TERMS];
    vec by_contact_angle[TERMS];
} bridge_force_slopes;

/* Derivatives of bridge_force by its arguments; products of series: 1. */
INLINE void bridge_force_slopes_of(bridge_force_slopes *restrict s, const bridge_force_slope_constants *c,
    const bridge_force_series *of, const bridge_force_constants *v, const vec *gap_over_radius)
{
    (void)gap_over_radius; (void)of; (void)c; (void)v;
    EACH_TERM(s->by_gap_over_radius[k] = v->decay*of->exp_of_combination[k];)
    EACH_TERM(s->gap_over_radius_by_exp_of_combination[k] = product(gap_over_radius, of->exp_of_combination,
        k);)
    EACH_TERM(s->by_volume[k] = k == 0 ?
        c->by_volume_per_gap_over_radius_by_exp_of_combination*s->gap_over_radius_by_exp_of_combination[k] +
        c->offset_by_volume*of->exp_of_combination[k] + c->by_volume_offset :
        c->by_volume_per_gap_over_radius_by_exp_of_combination*s->gap_over_radius_by_exp_of_combination[k] +
        c->offset_by_volume*of->exp_of_combination[k];)
    EACH_TERM(s->by_contact_angle[k] = c->offset_by_contact_angle*of->exp_of_combination[k];)
}

static inline vec bridge_rupture_distance_by_volume(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.16666666666666666*(contact_angle + 2.0)*vec_exp(0.6666666666666666*vec_log(1.0/volume));
}

static inline vec bridge_rupture_distance_by_contact_angle(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.5*vec_exp(0.3333333333333333*vec_log(volume));
}
