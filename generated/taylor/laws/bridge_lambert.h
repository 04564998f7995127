/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 672b476bc6acde06a4ee8a2d6138d5c3c5a2763a679af7727c4a1b86c6e97a88 */

/* bridge law `lambert`: energy approach with a cylindrical bridge, exact at constant volume.
 *
 * Source: Lambert, Chau, Delchambre & Regnier, Langmuir 24, 3157 (2008). */

typedef struct { vec volume, contact_angle, combination_offset, result_per_combination_2, work_per_root_of_combination; } bridge_force_constants;

static inline void bridge_force_prepare(bridge_force_constants *c, vec volume, vec contact_angle)
{
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->combination_offset = 2.0*c->volume/3.141592653589793;
    c->result_per_combination_2 = 2.0*vec_cos(c->contact_angle);
    c->work_per_root_of_combination = -2.0*vec_cos(c->contact_angle);
}

typedef struct {
    vec gap_over_radius_squared[TERMS];
    vec combination[TERMS];
    vec cylinder_reach[TERMS];
    vec over_cylinder_reach;
    vec gap_over_radius_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_over_cylinder_reach;
    vec combination_2[TERMS];
    vec result[TERMS];
} bridge_force_series;

/* Capillary attraction over pi R sigma. Coefficient k of its series; products of series: 2. */
INLINE void bridge_force_next(bridge_force_series *s, const bridge_force_constants *c, const vec
    *gap_over_radius, int k)
{
    (void)gap_over_radius; (void)c;
    s->gap_over_radius_squared[k] = square(gap_over_radius, k);
    s->combination[k] = k == 0 ? s->gap_over_radius_squared[k] + c->combination_offset :
        s->gap_over_radius_squared[k];
    s->cylinder_reach[k] = root(s->combination, s->cylinder_reach, &s->over_cylinder_reach, k);
    s->gap_over_radius_over_cylinder_reach[k] = quotient(gap_over_radius, s->cylinder_reach,
        s->gap_over_radius_over_cylinder_reach, &s->over_gap_over_radius_over_cylinder_reach, k);
    s->combination_2[k] = k == 0 ? -s->gap_over_radius_over_cylinder_reach[k] + 1.0 :
        -s->gap_over_radius_over_cylinder_reach[k];
    s->result[k] = c->result_per_combination_2*s->combination_2[k];
}

/* Capillary attraction over pi R sigma. */
static inline vec bridge_force_value(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)gap_over_radius; (void)c;
    vec gap_over_radius_squared = gap_over_radius*gap_over_radius;
    vec combination = gap_over_radius_squared + c->combination_offset;
    vec cylinder_reach = vec_sqrt(combination);
    vec gap_over_radius_over_cylinder_reach = gap_over_radius/cylinder_reach;
    vec combination_2 = -gap_over_radius_over_cylinder_reach + 1.0;
    vec result = c->result_per_combination_2*combination_2;
    return result;
}

#define BRIDGE_FORCE_FALLS 1 /* never increases with its first argument */

#define BRIDGE_FORCE_WORK 1
/* Antiderivative, in closed form. */
static inline vec bridge_force_work(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)c;
    vec gap_over_radius_squared = gap_over_radius*gap_over_radius;
    vec combination = gap_over_radius_squared + c->combination_offset;
    vec root_of_combination = vec_sqrt(combination);
    vec work = c->result_per_combination_2*gap_over_radius +
        c->work_per_root_of_combination*root_of_combination;
    return work;
}
