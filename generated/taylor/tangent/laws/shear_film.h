/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 cd50827de71ee8d5b1944e89ef39cdf4365c92d8da787e6a4b98f2198be4915d */

/* Slopes of the shear law `film`. */

typedef struct { char none[0]; } shear_log_factor_slope_constants;

static inline void shear_log_factor_slope_prepare(shear_log_factor_slope_constants *c, const
    shear_log_factor_constants *v)
{
    (void)c; (void)v;
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
    EACH_TERM(s->by_aspect[k] = k == 0 ? splat(0.0) : splat(0.0);)
}

static inline vec shear_edge_by_aspect(vec aspect)
{
    (void)aspect;
    return splat(0.0);
}
