/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 cd50827de71ee8d5b1944e89ef39cdf4365c92d8da787e6a4b98f2198be4915d */

/* shear law `film`: leading logarithm cut off at the rim of the film, x0.
 *
 * Source: Couette shear integrated over the wetted disc. */

typedef struct { vec aspect; } shear_log_factor_constants;

static inline void shear_log_factor_prepare(shear_log_factor_constants *c, vec aspect)
{
    c->aspect = aspect;
}

typedef struct {
    vec log_of_gap[TERMS], slope_of_log_of_gap[TERMS];
    vec over_log_of_gap;
    vec result[TERMS];
} shear_log_factor_series;

/* Tangential force over 8 pi mu a^2 (omega - xi), inside its edge. Coefficient k of its series; products of
 * series: 1. */
INLINE void shear_log_factor_next(shear_log_factor_series *s, const shear_log_factor_constants *c, const vec
    *gap, int k)
{
    (void)gap; (void)c;
    s->log_of_gap[k] = logarithm(gap, s->log_of_gap, s->slope_of_log_of_gap, &s->over_log_of_gap, k);
    s->result[k] = -s->log_of_gap[k];
}

/* Tangential force over 8 pi mu a^2 (omega - xi), inside its edge. */
static inline vec shear_log_factor_value(const shear_log_factor_constants *c, vec gap)
{
    (void)gap; (void)c;
    vec log_of_gap = vec_log(gap);
    vec result = -log_of_gap;
    return result;
}

#define SHEAR_LOG_FACTOR_FALLS 1 /* never increases with its first argument */

/* Gap (in film thicknesses) beyond which there is no tangential force. */
static inline vec shear_edge(vec aspect)
{
    (void)aspect;
    return splat(1.0);
}
