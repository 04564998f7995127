/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 7edea584b84bd0542e44786e4e9d8fab3b1b90daa8d4e420aeab9cddab86c0bc */

/* strings law `exact`: strings of length l, exact geometry.
 *
 * Source: Donahue, Brewer, Davis & Hrenya, J. Fluid Mech. 708, 128 (2012): vertical tension balances the
 * weight. */

typedef struct { vec string_ratio, combination_offset; } strings_rise_constants;

static inline void strings_rise_prepare(strings_rise_constants *c, vec string_ratio)
{
    c->string_ratio = string_ratio;
    c->combination_offset = (c->string_ratio*c->string_ratio);
}

typedef struct {
    vec combination[TERMS];
    vec root_of_combination[TERMS];
    vec over_root_of_combination;
    vec combination_2[TERMS];
    vec result[TERMS];
    vec over_result;
} strings_rise_series;

/* Height gained by each sphere over a. Coefficient k of its series; products of series: 1.5. */
INLINE void strings_rise_next(strings_rise_series *s, const strings_rise_constants *c, const vec
    *offset_squared, int k)
{
    (void)offset_squared; (void)c;
    s->combination[k] = k == 0 ? -offset_squared[k] + c->combination_offset : -offset_squared[k];
    s->root_of_combination[k] = root(s->combination, s->root_of_combination, &s->over_root_of_combination, k);
    s->combination_2[k] = k == 0 ? s->root_of_combination[k] + c->string_ratio : s->root_of_combination[k];
    s->result[k] = quotient(offset_squared, s->combination_2, s->result, &s->over_result, k);
}

/* Height gained by each sphere over a. */
static inline vec strings_rise_value(const strings_rise_constants *c, vec offset_squared)
{
    (void)offset_squared; (void)c;
    vec combination = -offset_squared + c->combination_offset;
    vec root_of_combination = vec_sqrt(combination);
    vec combination_2 = root_of_combination + c->string_ratio;
    vec result = offset_squared/combination_2;
    return result;
}

typedef struct { vec string_ratio, combination_offset; } strings_stiffness_constants;

static inline void strings_stiffness_prepare(strings_stiffness_constants *c, vec string_ratio)
{
    c->string_ratio = string_ratio;
    c->combination_offset = (c->string_ratio*c->string_ratio);
}

typedef struct {
    vec combination[TERMS];
    vec root_of_combination[TERMS];
    vec over_root_of_combination;
    vec result[TERMS];
} strings_stiffness_series;

/* Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2). Coefficient k of its series;
 * products of series: 1.5. */
INLINE void strings_stiffness_next(strings_stiffness_series *s, const strings_stiffness_constants *c, const
    vec *offset_squared, int k)
{
    (void)offset_squared; (void)c;
    s->combination[k] = k == 0 ? -offset_squared[k] + c->combination_offset : -offset_squared[k];
    s->root_of_combination[k] = root(s->combination, s->root_of_combination, &s->over_root_of_combination, k);
    s->result[k] = reciprocal(s->root_of_combination, s->result, k);
}

/* Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2). */
static inline vec strings_stiffness_value(const strings_stiffness_constants *c, vec offset_squared)
{
    (void)offset_squared; (void)c;
    vec combination = -offset_squared + c->combination_offset;
    vec root_of_combination = vec_sqrt(combination);
    vec result = 1.0/root_of_combination;
    return result;
}
