/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8ae8f5d0d1f3a56bcd8b692dbaee4bcc8ceb364871fd1fed87a9903744733ff7 */

/* bridge law `soulie`: mikami's form refitted for polydisperse spheres.
 *
 * Source: Soulie, Cherblanc, El Youssoufi & Saix, Int. J. Numer. Anal. Meth. Geomech. 30, 213 (2006). */

typedef struct { vec volume, contact_angle, log_volume, decay, offset, tail, work_per_exp_of_combination; } bridge_force_constants;

static inline void bridge_force_prepare(bridge_force_constants *c, vec volume, vec contact_angle)
{
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->log_volume = vec_log(c->volume);
    c->decay = -1.1*vec_exp(0.53*vec_log(1.0/c->volume));
    c->offset = (c->contact_angle*c->contact_angle)*(-0.148*c->log_volume - 0.96) + 0.48 -
        0.0082*c->log_volume;
    c->tail = 0.0018*c->log_volume + 0.078;
    c->work_per_exp_of_combination = 1.0/c->decay;
}

typedef struct {
    vec combination[TERMS];
    vec exp_of_combination[TERMS], slope_of_combination[TERMS];
    vec result[TERMS];
} bridge_force_series;

/* Capillary attraction over pi R sigma. Coefficient k of its series; products of series: 1. */
INLINE void bridge_force_next(bridge_force_series *s, const bridge_force_constants *c, const vec
    *gap_over_radius, int k)
{
    (void)gap_over_radius; (void)c;
    s->combination[k] = k == 0 ? c->decay*gap_over_radius[k] + c->offset : c->decay*gap_over_radius[k];
    s->exp_of_combination[k] = exponential(s->combination, s->slope_of_combination, s->exp_of_combination, k);
    s->result[k] = k == 0 ? s->exp_of_combination[k] + c->tail : s->exp_of_combination[k];
}

/* Capillary attraction over pi R sigma. */
static inline vec bridge_force_value(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)gap_over_radius; (void)c;
    vec combination = c->decay*gap_over_radius + c->offset;
    vec exp_of_combination = vec_exp(combination);
    vec result = exp_of_combination + c->tail;
    return result;
}

#define BRIDGE_FORCE_FALLS 1 /* never increases with its first argument */

#define BRIDGE_FORCE_WORK 1
/* Antiderivative, in closed form. */
static inline vec bridge_force_work(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)c;
    vec combination = c->decay*gap_over_radius + c->offset;
    vec exp_of_combination = vec_exp(combination);
    vec work = c->tail*gap_over_radius + c->work_per_exp_of_combination*exp_of_combination;
    return work;
}

/* Rupture distance over R that goes with this law.
 *
 * Source: Lian, Thornton & Adams, J. Colloid Interface Sci. 161, 138 (1993), which Soulie et al. (2006) use. */
static inline vec bridge_rupture_distance(vec volume, vec contact_angle)
{
    return (0.5*contact_angle + 1.0)*vec_exp(0.3333333333333333*vec_log(volume));
}
