/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 e2728e7698e6b442818266f09dd85d527a7cc4866ffddb7228c9011a4043ab76 */

/* Slopes of the bridge law `mikami-log10`. */

typedef struct { vec offset_by_volume, offset_by_contact_angle, by_volume_per_gap_over_radius_by_exp_of_combination, by_volume_offset; } bridge_force_slope_constants;

static inline void bridge_force_slope_prepare(bridge_force_slope_constants *c, const bridge_force_constants
    *v)
{
    (void)c; (void)v;
    c->offset_by_volume = -0.34*(v->contact_angle*v->contact_angle)/(v->volume*2.302585092994046) -
        0.019/(v->volume*2.302585092994046);
    c->offset_by_contact_angle = -0.68*v->contact_angle*v->log_volume - 1.92*v->contact_angle;
    c->by_volume_per_gap_over_radius_by_exp_of_combination = -0.53*v->decay/v->volume;
    c->by_volume_offset = 0.0042/(v->volume*2.302585092994046);
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
    return 0.0034*(62.0*contact_angle + 99.0)*vec_exp(0.66*vec_log(1.0/volume));
}

static inline vec bridge_rupture_distance_by_contact_angle(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.62*vec_exp(0.34*vec_log(volume));
}
