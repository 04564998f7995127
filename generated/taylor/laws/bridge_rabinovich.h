/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 36e46923a94b238902fde09d8f0a84cd7caa23f0ba2ee09a4e8f1a196b537dce */

/* bridge law `rabinovich`: lambert's pressure term and the surface tension along the contact line at the
 * half-filling angle.
 *
 * Source: Rabinovich, Esayanur & Moudgil, Langmuir 21, 10992 (2005). */

typedef struct { vec volume, contact_angle, combination_offset, result_per_combination_3; } bridge_force_constants;

static inline void bridge_force_prepare(bridge_force_constants *c, vec volume, vec contact_angle)
{
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->combination_offset = 2.0*c->volume/3.141592653589793;
    c->result_per_combination_3 = 2.0*vec_cos(c->contact_angle);
}

typedef struct {
    vec gap_over_radius_squared[TERMS];
    vec combination[TERMS];
    vec cylinder_reach[TERMS];
    vec over_cylinder_reach;
    vec combination_2[TERMS];
    vec half_filling_angle[TERMS];
    vec over_half_filling_angle;
    vec gap_over_radius_over_cylinder_reach[TERMS];
    vec over_gap_over_radius_over_cylinder_reach;
    vec combination_3[TERMS];
    vec sine_of_half_filling_angle[TERMS], slope_of_half_filling_angle[TERMS];
    vec cosine_of_half_filling_angle[TERMS];
    vec combination_4[TERMS];
    vec sine_of_combination_4[TERMS], slope_of_combination_4[TERMS];
    vec cosine_of_combination_4[TERMS];
    vec sine_of_half_filling_angle_by_sine_of_combination_4[TERMS];
    vec result[TERMS];
} bridge_force_series;

/* Capillary attraction over pi R sigma. Coefficient k of its series; products of series: 7.5. */
INLINE void bridge_force_next(bridge_force_series *s, const bridge_force_constants *c, const vec
    *gap_over_radius, int k)
{
    (void)gap_over_radius; (void)c;
    s->gap_over_radius_squared[k] = square(gap_over_radius, k);
    s->combination[k] = k == 0 ? s->gap_over_radius_squared[k] + c->combination_offset :
        s->gap_over_radius_squared[k];
    s->cylinder_reach[k] = root(s->combination, s->cylinder_reach, &s->over_cylinder_reach, k);
    s->combination_2[k] = s->cylinder_reach[k] - gap_over_radius[k];
    s->half_filling_angle[k] = root(s->combination_2, s->half_filling_angle, &s->over_half_filling_angle, k);
    s->gap_over_radius_over_cylinder_reach[k] = quotient(gap_over_radius, s->cylinder_reach,
        s->gap_over_radius_over_cylinder_reach, &s->over_gap_over_radius_over_cylinder_reach, k);
    s->combination_3[k] = k == 0 ? -s->gap_over_radius_over_cylinder_reach[k] + 1.0 :
        -s->gap_over_radius_over_cylinder_reach[k];
    circular(s->half_filling_angle, s->slope_of_half_filling_angle, s->sine_of_half_filling_angle,
        s->cosine_of_half_filling_angle, k);
    /* cosine_of_half_filling_angle comes with its sine */
    s->combination_4[k] = k == 0 ? s->half_filling_angle[k] + c->contact_angle : s->half_filling_angle[k];
    circular(s->combination_4, s->slope_of_combination_4, s->sine_of_combination_4,
        s->cosine_of_combination_4, k);
    /* cosine_of_combination_4 comes with its sine */
    s->sine_of_half_filling_angle_by_sine_of_combination_4[k] = product(s->sine_of_half_filling_angle,
        s->sine_of_combination_4, k);
    s->result[k] = c->result_per_combination_3*s->combination_3[k] +
        2.0*s->sine_of_half_filling_angle_by_sine_of_combination_4[k];
}

/* Capillary attraction over pi R sigma. */
static inline vec bridge_force_value(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)gap_over_radius; (void)c;
    vec gap_over_radius_squared = gap_over_radius*gap_over_radius;
    vec combination = gap_over_radius_squared + c->combination_offset;
    vec cylinder_reach = vec_sqrt(combination);
    vec combination_2 = cylinder_reach - gap_over_radius;
    vec half_filling_angle = vec_sqrt(combination_2);
    vec gap_over_radius_over_cylinder_reach = gap_over_radius/cylinder_reach;
    vec combination_3 = -gap_over_radius_over_cylinder_reach + 1.0;
    vec sine_of_half_filling_angle = vec_sin(half_filling_angle);
    vec combination_4 = half_filling_angle + c->contact_angle;
    vec sine_of_combination_4 = vec_sin(combination_4);
    vec sine_of_half_filling_angle_by_sine_of_combination_4 =
        sine_of_half_filling_angle*sine_of_combination_4;
    vec result = c->result_per_combination_3*combination_3 +
        2.0*sine_of_half_filling_angle_by_sine_of_combination_4;
    return result;
}
