/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8ca29c7559078c070dbdd6849e539cc8cbb76262ceafda2504523838994270d9 */

/* Slopes of the shear law `immersed`. */

typedef struct { vec level_by_aspect; } shear_log_factor_slope_constants;

static inline void shear_log_factor_slope_prepare(shear_log_factor_slope_constants *c, const
    shear_log_factor_constants *v)
{
    (void)c; (void)v;
    c->level_by_aspect = -1.0/v->aspect;
}

typedef struct {
    vec inverse_gap[TERMS];
    vec by_gap[TERMS];
    vec by_aspect[TERMS];
} shear_log_factor_slopes;

/* Derivatives of shear_log_factor by its arguments; products of series: 1. */
INLINE void shear_log_factor_slopes_of(shear_log_factor_slopes *restrict s, const
    shear_log_factor_slope_constants *c, const shear_log_factor_series *of, const shear_log_factor_constants
    *v, const vec *gap)
{
    (void)gap; (void)of; (void)c; (void)v;
    EACH_TERM(s->inverse_gap[k] = reciprocal(gap, s->inverse_gap, k);)
    EACH_TERM(s->by_gap[k] = -s->inverse_gap[k];)
    EACH_TERM(s->by_aspect[k] = k == 0 ? c->level_by_aspect : splat(0.0);)
}

static inline vec shear_edge_by_aspect(vec aspect)
{
    (void)aspect;
    return -2.0/(aspect*aspect);
}
