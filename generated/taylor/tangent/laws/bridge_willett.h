/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 78bfb53e20678b26d8151529924a920f90ec47b44fc2119f83e152eb709d0cb4 */

/* Slopes of the bridge law `willett`. */

typedef struct { vec f1_by_volume, f2_by_volume, f3_by_volume, f4_by_volume, f1_by_contact_angle, f2_by_contact_angle, f3_by_contact_angle, f4_by_contact_angle, by_gap_over_radius_per_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius, by_gap_over_radius_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius, by_volume_per_exp_of_combination_2, by_volume_per_exp_of_combination_2_by_exp_of_combination, by_volume_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination, by_volume_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_2, by_volume_per_log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination, by_volume_per_exp_of_combination_2_by_exp_of_combination_2, by_contact_angle_per_exp_of_combination_2, by_contact_angle_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination, by_contact_angle_per_log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination, by_contact_angle_per_exp_of_combination_2_by_exp_of_combination; } bridge_force_slope_constants;

static inline void bridge_force_slope_prepare(bridge_force_slope_constants *c, const bridge_force_constants
    *v)
{
    (void)c; (void)v;
    c->f1_by_volume = -0.00087228*(v->contact_angle*v->contact_angle)*(v->log_volume*v->log_volume)/v->volume
        - 0.0251*(v->contact_angle*v->contact_angle)*v->log_volume/v->volume -
        0.149*(v->contact_angle*v->contact_angle)/v->volume -
        0.0010515*v->contact_angle*(v->log_volume*v->log_volume)/v->volume -
        0.0072912*v->contact_angle*v->log_volume/v->volume - 0.000411*v->contact_angle/v->volume -
        0.0015*(v->log_volume*v->log_volume)/v->volume - 0.024202*v->log_volume/v->volume - 0.1119/v->volume;
    c->f2_by_volume = -0.02274*(v->contact_angle*v->contact_angle)*v->log_volume/v->volume -
        0.22574*(v->contact_angle*v->contact_angle)/v->volume -
        0.0137976*v->contact_angle*v->log_volume/v->volume - 0.1201*v->contact_angle/v->volume -
        0.002675*v->log_volume/v->volume - 0.0668/v->volume;
    c->f3_by_volume = 0.003954*v->contact_angle*(v->log_volume*v->log_volume)/v->volume +
        0.04476*v->contact_angle*v->log_volume/v->volume + 0.092*v->contact_angle/v->volume +
        0.0025755*(v->log_volume*v->log_volume)/v->volume + 0.04464*v->log_volume/v->volume + 0.198/v->volume
        - 0.00159*(v->contact_angle*v->contact_angle)*(v->log_volume*v->log_volume)/v->volume -
        0.019706*(v->contact_angle*v->contact_angle)*v->log_volume/v->volume -
        0.06418*(v->contact_angle*v->contact_angle)/v->volume;
    c->f4_by_volume = 0.008912*v->contact_angle*v->log_volume/v->volume + 0.04543*v->contact_angle/v->volume +
        0.0037148*v->log_volume/v->volume + 0.03345/v->volume -
        0.012514*(v->contact_angle*v->contact_angle)*v->log_volume/v->volume -
        0.09056*(v->contact_angle*v->contact_angle)/v->volume;
    c->f1_by_contact_angle = 0.050832 -
        0.00058152*v->contact_angle*(v->log_volume*v->log_volume*v->log_volume) -
        0.0251*v->contact_angle*(v->log_volume*v->log_volume) - 0.298*v->contact_angle*v->log_volume -
        2.2932*v->contact_angle - 0.0003505*(v->log_volume*v->log_volume*v->log_volume) -
        0.0036456*(v->log_volume*v->log_volume) - 0.000411*v->log_volume;
    c->f2_by_contact_angle = -0.02274*v->contact_angle*(v->log_volume*v->log_volume) -
        0.45148*v->contact_angle*v->log_volume - 2.5836*v->contact_angle -
        0.0068988*(v->log_volume*v->log_volume) - 0.1201*v->log_volume - 0.57473;
    c->f3_by_contact_angle = 0.001318*(v->log_volume*v->log_volume*v->log_volume) +
        0.02238*(v->log_volume*v->log_volume) + 0.092*v->log_volume -
        0.00106*v->contact_angle*(v->log_volume*v->log_volume*v->log_volume) -
        0.019706*v->contact_angle*(v->log_volume*v->log_volume) - 0.12836*v->contact_angle*v->log_volume -
        0.47132*v->contact_angle - 0.01396;
    c->f4_by_contact_angle = 0.004456*(v->log_volume*v->log_volume) + 0.04543*v->log_volume + 0.073776 -
        0.012514*v->contact_angle*(v->log_volume*v->log_volume) - 0.18112*v->contact_angle*v->log_volume -
        0.69484*v->contact_angle;
    c->by_gap_over_radius_per_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius =
        -2.0*v->f2*v->f3;
    c->by_gap_over_radius_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius
        = -4.0*v->f2*v->f4;
    c->by_volume_per_exp_of_combination_2 = 2.0*c->f1_by_volume;
    c->by_volume_per_exp_of_combination_2_by_exp_of_combination = v->f2*v->f3/v->volume;
    c->by_volume_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination =
        -2.0*v->f2*c->f3_by_volume;
    c->by_volume_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_2 =
        2.0*v->f2*v->f4/v->volume;
    c->by_volume_per_log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination =
        -2.0*v->f2*c->f4_by_volume;
    c->by_volume_per_exp_of_combination_2_by_exp_of_combination_2 = -2.0*c->f2_by_volume;
    c->by_contact_angle_per_exp_of_combination_2 = 2.0*c->f1_by_contact_angle;
    c->by_contact_angle_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination =
        -2.0*v->f2*c->f3_by_contact_angle;
    c->by_contact_angle_per_log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination =
        -2.0*v->f2*c->f4_by_contact_angle;
    c->by_contact_angle_per_exp_of_combination_2_by_exp_of_combination = -2.0*c->f2_by_contact_angle;
}

typedef struct {
    vec exp_of_combination_2_by_exp_of_combination[TERMS];
    vec exp_of_combination_2_by_exp_of_combination_over_gap_over_radius[TERMS];
    vec over_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius;
    vec log_scaled_gap_by_exp_of_combination_2[TERMS];
    vec log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination[TERMS];
    vec log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius[TERMS];
    vec over_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius;
    vec by_gap_over_radius[TERMS];
    vec log_scaled_gap_squared_by_exp_of_combination_2[TERMS];
    vec log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination[TERMS];
    vec by_volume[TERMS];
    vec by_contact_angle[TERMS];
} bridge_force_slopes;

/* Derivatives of bridge_force by its arguments; products of series: 7. */
INLINE void bridge_force_slopes_of(bridge_force_slopes *restrict s, const bridge_force_slope_constants *c,
    const bridge_force_series *of, const bridge_force_constants *v, const vec *gap_over_radius)
{
    (void)gap_over_radius; (void)of; (void)c; (void)v;
    EACH_TERM(s->exp_of_combination_2_by_exp_of_combination[k] = product(of->exp_of_combination_2,
        of->exp_of_combination, k);)
    EACH_TERM(s->exp_of_combination_2_by_exp_of_combination_over_gap_over_radius[k] =
        quotient(s->exp_of_combination_2_by_exp_of_combination, gap_over_radius,
        s->exp_of_combination_2_by_exp_of_combination_over_gap_over_radius,
        &s->over_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius, k);)
    EACH_TERM(s->log_scaled_gap_by_exp_of_combination_2[k] = product(of->log_scaled_gap,
        of->exp_of_combination_2, k);)
    EACH_TERM(s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination[k] =
        product(of->exp_of_combination, s->log_scaled_gap_by_exp_of_combination_2, k);)
    EACH_TERM(s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius[k] =
        quotient(s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination, gap_over_radius,
        s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius,
        &s->over_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius, k);)
    EACH_TERM(s->by_gap_over_radius[k] =
        c->by_gap_over_radius_per_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius*s->exp_of_combination_2_by_exp_of_combination_over_gap_over_radius[k]
        +
        c->by_gap_over_radius_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius*s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_over_gap_over_radius[k];)
    EACH_TERM(s->log_scaled_gap_squared_by_exp_of_combination_2[k] = product(of->log_scaled_gap_squared,
        of->exp_of_combination_2, k);)
    EACH_TERM(s->log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination[k] =
        product(of->exp_of_combination, s->log_scaled_gap_squared_by_exp_of_combination_2, k);)
    EACH_TERM(s->by_volume[k] = c->by_volume_per_exp_of_combination_2*of->exp_of_combination_2[k] +
        c->by_volume_per_exp_of_combination_2_by_exp_of_combination*s->exp_of_combination_2_by_exp_of_combination[k]
        +
        c->by_volume_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination*s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination[k]
        +
        c->by_volume_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination_2*s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination[k]
        +
        c->by_volume_per_log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination*s->log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination[k]
        +
        c->by_volume_per_exp_of_combination_2_by_exp_of_combination_2*s->exp_of_combination_2_by_exp_of_combination[k];)
    EACH_TERM(s->by_contact_angle[k] =
        c->by_contact_angle_per_exp_of_combination_2*of->exp_of_combination_2[k] +
        c->by_contact_angle_per_log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination*s->log_scaled_gap_by_exp_of_combination_2_by_exp_of_combination[k]
        +
        c->by_contact_angle_per_log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination*s->log_scaled_gap_squared_by_exp_of_combination_2_by_exp_of_combination[k]
        +
        c->by_contact_angle_per_exp_of_combination_2_by_exp_of_combination*s->exp_of_combination_2_by_exp_of_combination[k];)
}

static inline vec bridge_rupture_distance_by_volume(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.03333333333333333*(contact_angle + 2.0)*(vec_exp(0.3333333333333333*vec_log(volume)) +
        5.0)*vec_exp(0.6666666666666666*vec_log(1.0/volume));
}

static inline vec bridge_rupture_distance_by_contact_angle(vec volume, vec contact_angle)
{
    (void)volume;
    (void)contact_angle;
    return 0.05*(vec_exp(0.3333333333333333*vec_log(volume)) +
        10.0)*vec_exp(0.3333333333333333*vec_log(volume));
}
