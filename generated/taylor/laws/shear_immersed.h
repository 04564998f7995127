/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8ca29c7559078c070dbdd6849e539cc8cbb76262ceafda2504523838994270d9 */

/* shear law `immersed`: leading logarithm of nearly touching, fully immersed spheres: cut off at the sphere
 * radius 2a.
 *
 * Source: O'Neill & Majumdar, ZAMP 21, 164 (1970), without its constant term. */

typedef struct { vec aspect, result_offset; } shear_log_factor_constants;

static inline void shear_log_factor_prepare(shear_log_factor_constants *c, vec aspect)
{
    c->aspect = aspect;
    c->result_offset = 0.6931471805599453 - vec_log(c->aspect);
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
    s->result[k] = k == 0 ? -s->log_of_gap[k] + c->result_offset : -s->log_of_gap[k];
}

/* Tangential force over 8 pi mu a^2 (omega - xi), inside its edge. */
static inline vec shear_log_factor_value(const shear_log_factor_constants *c, vec gap)
{
    (void)gap; (void)c;
    vec log_of_gap = vec_log(gap);
    vec result = -log_of_gap + c->result_offset;
    return result;
}

#define SHEAR_LOG_FACTOR_FALLS 1 /* never increases with its first argument */

/* Gap (in film thicknesses) beyond which there is no tangential force. */
static inline vec shear_edge(vec aspect)
{
    return 2.0/aspect;
}
