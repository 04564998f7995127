/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 988fad14ceb4ba2b64e33003ca6e9c5bdce6a9c48e4b863af76eba9f944427a2 */

/* Slopes of the bridge law `constant`. */

typedef struct { vec level_by_contact_angle; } bridge_force_slope_constants;

static inline void bridge_force_slope_prepare(bridge_force_slope_constants *c, const bridge_force_constants
    *v)
{
    (void)c; (void)v;
    c->level_by_contact_angle = -2.0*vec_sin(v->contact_angle);
}

typedef struct {
    vec by_gap_over_radius[TERMS];
    vec by_volume[TERMS];
    vec by_contact_angle[TERMS];
} bridge_force_slopes;

/* Derivatives of bridge_force by its arguments; products of series: 0. */
INLINE void bridge_force_slopes_of(bridge_force_slopes *restrict s, const bridge_force_slope_constants *c,
    const bridge_force_series *of, const bridge_force_constants *v, const vec *gap_over_radius)
{
    (void)gap_over_radius; (void)of; (void)c; (void)v;
    EACH_TERM(s->by_gap_over_radius[k] = k == 0 ? splat(0.0) : splat(0.0);)
    EACH_TERM(s->by_volume[k] = k == 0 ? splat(0.0) : splat(0.0);)
    EACH_TERM(s->by_contact_angle[k] = k == 0 ? c->level_by_contact_angle : splat(0.0);)
}
