/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 78bfb53e20678b26d8151529924a920f90ec47b44fc2119f83e152eb709d0cb4 */

/* bridge law `willett`: fit to Young-Laplace solutions over h/(2 sqrt V), full form.
 *
 * Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000). */

typedef struct { vec volume, contact_angle, log_volume, f1, f2, f3, f4, scaled_gap_over_radius_per_gap_over_radius, combination_2_per_exp_of_combination; } bridge_force_constants;

static inline void bridge_force_prepare(bridge_force_constants *c, vec volume, vec contact_angle)
{
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->log_volume = vec_log(c->volume);
    c->f1 = 0.050832*c->contact_angle +
        (c->log_volume*c->log_volume*c->log_volume)*(-0.00029076*(c->contact_angle*c->contact_angle) -
        0.0003505*c->contact_angle - 0.0005) +
        (c->log_volume*c->log_volume)*(-0.01255*(c->contact_angle*c->contact_angle) -
        0.0036456*c->contact_angle - 0.012101) + c->log_volume*(-0.149*(c->contact_angle*c->contact_angle) -
        0.000411*c->contact_angle - 0.1119) - 1.1466*(c->contact_angle*c->contact_angle) - 0.44507;
    c->f2 = (c->log_volume*c->log_volume)*(-0.01137*(c->contact_angle*c->contact_angle) -
        0.0068988*c->contact_angle - 0.0013375) + c->log_volume*(-0.22574*(c->contact_angle*c->contact_angle)
        - 0.1201*c->contact_angle - 0.0668) + 1.9222 - 1.2918*(c->contact_angle*c->contact_angle) -
        0.57473*c->contact_angle;
    c->f3 = (c->log_volume*c->log_volume*c->log_volume)*(0.001318*c->contact_angle + 0.0008585 -
        0.00053*(c->contact_angle*c->contact_angle)) + (c->log_volume*c->log_volume)*(0.02238*c->contact_angle
        + 0.02232 - 0.009853*(c->contact_angle*c->contact_angle)) + c->log_volume*(0.092*c->contact_angle +
        0.198 - 0.06418*(c->contact_angle*c->contact_angle)) + 1.268 -
        0.23566*(c->contact_angle*c->contact_angle) - 0.01396*c->contact_angle;
    c->f4 = 0.073776*c->contact_angle + (c->log_volume*c->log_volume)*(0.004456*c->contact_angle + 0.0018574 -
        0.006257*(c->contact_angle*c->contact_angle)) + c->log_volume*(0.04543*c->contact_angle + 0.03345 -
        0.09056*(c->contact_angle*c->contact_angle)) - 0.34742*(c->contact_angle*c->contact_angle) - 0.010703;
    c->scaled_gap_over_radius_per_gap_over_radius = 0.5/vec_sqrt(c->volume);
    c->combination_2_per_exp_of_combination = -c->f2;
}

typedef struct {
    vec scaled_gap_over_radius[TERMS];
    vec log_scaled_gap[TERMS], slope_of_log_scaled_gap[TERMS];
    vec over_log_scaled_gap;
    vec log_scaled_gap_squared[TERMS];
    vec combination[TERMS];
    vec exp_of_combination[TERMS], slope_of_combination[TERMS];
    vec combination_2[TERMS];
    vec exp_of_combination_2[TERMS], slope_of_combination_2[TERMS];
    vec result[TERMS];
} bridge_force_series;

/* Capillary attraction over pi R sigma. Coefficient k of its series; products of series: 3.5. */
INLINE void bridge_force_next(bridge_force_series *s, const bridge_force_constants *c, const vec
    *gap_over_radius, int k)
{
    (void)gap_over_radius; (void)c;
    s->scaled_gap_over_radius[k] = c->scaled_gap_over_radius_per_gap_over_radius*gap_over_radius[k];
    s->log_scaled_gap[k] = logarithm(s->scaled_gap_over_radius, s->log_scaled_gap, s->slope_of_log_scaled_gap,
        &s->over_log_scaled_gap, k);
    s->log_scaled_gap_squared[k] = square(s->log_scaled_gap, k);
    s->combination[k] = c->f3*s->log_scaled_gap[k] + c->f4*s->log_scaled_gap_squared[k];
    s->exp_of_combination[k] = exponential(s->combination, s->slope_of_combination, s->exp_of_combination, k);
    s->combination_2[k] = k == 0 ? c->combination_2_per_exp_of_combination*s->exp_of_combination[k] + c->f1 :
        c->combination_2_per_exp_of_combination*s->exp_of_combination[k];
    s->exp_of_combination_2[k] = exponential(s->combination_2, s->slope_of_combination_2,
        s->exp_of_combination_2, k);
    s->result[k] = 2.0*s->exp_of_combination_2[k];
}

/* Capillary attraction over pi R sigma. */
static inline vec bridge_force_value(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)gap_over_radius; (void)c;
    vec scaled_gap_over_radius = c->scaled_gap_over_radius_per_gap_over_radius*gap_over_radius;
    vec log_scaled_gap = vec_log(scaled_gap_over_radius);
    vec log_scaled_gap_squared = log_scaled_gap*log_scaled_gap;
    vec combination = c->f3*log_scaled_gap + c->f4*log_scaled_gap_squared;
    vec exp_of_combination = vec_exp(combination);
    vec combination_2 = c->combination_2_per_exp_of_combination*exp_of_combination + c->f1;
    vec exp_of_combination_2 = vec_exp(combination_2);
    vec result = 2.0*exp_of_combination_2;
    return result;
}

/* Rupture distance over R that goes with this law.
 *
 * Source: Willett, Adams, Johnson & Seville, Langmuir 16, 9396 (2000). */
static inline vec bridge_rupture_distance(vec volume, vec contact_angle)
{
    return (0.5*contact_angle + 1.0)*(0.1*vec_exp(0.6666666666666666*vec_log(volume)) +
        vec_exp(0.3333333333333333*vec_log(volume)));
}
