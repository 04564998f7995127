/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 b1c085b7f7ff297bcaa3a55727c03de42c344fcd4b502a3e3e517a42df32c334 */

/* bridge law `willett-simple`: closed-form approximation of the full fit, for small bridges.
 *
 * Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000). */

typedef struct { vec volume, contact_angle, scaled_gap_per_gap_over_radius, result_per_inverse_combination; } bridge_force_constants;

static inline void bridge_force_prepare(bridge_force_constants *c, vec volume, vec contact_angle)
{
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->scaled_gap_per_gap_over_radius = vec_exp((-0.5)*vec_log(c->volume));
    c->result_per_inverse_combination = 2.0*vec_cos(c->contact_angle);
}

typedef struct {
    vec scaled_gap[TERMS];
    vec scaled_gap_squared[TERMS];
    vec combination[TERMS];
    vec inverse_combination[TERMS];
    vec result[TERMS];
} bridge_force_series;

/* Capillary attraction over pi R sigma. Coefficient k of its series; products of series: 1.5. */
INLINE void bridge_force_next(bridge_force_series *s, const bridge_force_constants *c, const vec
    *gap_over_radius, int k)
{
    (void)gap_over_radius; (void)c;
    s->scaled_gap[k] = c->scaled_gap_per_gap_over_radius*gap_over_radius[k];
    s->scaled_gap_squared[k] = square(s->scaled_gap, k);
    s->combination[k] = k == 0 ? 2.5*s->scaled_gap_squared[k] + 1.05*s->scaled_gap[k] + 1.0 :
        2.5*s->scaled_gap_squared[k] + 1.05*s->scaled_gap[k];
    s->inverse_combination[k] = reciprocal(s->combination, s->inverse_combination, k);
    s->result[k] = c->result_per_inverse_combination*s->inverse_combination[k];
}

/* Capillary attraction over pi R sigma. */
static inline vec bridge_force_value(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)gap_over_radius; (void)c;
    vec scaled_gap = c->scaled_gap_per_gap_over_radius*gap_over_radius;
    vec scaled_gap_squared = scaled_gap*scaled_gap;
    vec combination = 2.5*scaled_gap_squared + 1.05*scaled_gap + 1.0;
    vec inverse_combination = 1.0/combination;
    vec result = c->result_per_inverse_combination*inverse_combination;
    return result;
}

#define BRIDGE_FORCE_FALLS 1 /* never increases with its first argument */

/* Rupture distance over R that goes with this law.
 *
 * Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000). */
static inline vec bridge_rupture_distance(vec volume, vec contact_angle)
{
    return (0.5*contact_angle + 1.0)*(0.1*vec_exp(0.6666666666666666*vec_log(volume)) +
        vec_exp(0.3333333333333333*vec_log(volume)));
}
