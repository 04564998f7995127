/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 7edea584b84bd0542e44786e4e9d8fab3b1b90daa8d4e420aeab9cddab86c0bc */

/* Slopes of the strings law `exact`. */

typedef struct { vec combination_3_per_offset_squared, combination_3_per_root_of_combination, combination_3_offset, combination_4_per_root_of_combination, by_string_ratio_per_offset_squared_over_combination_3, combination_5_per_offset_squared, combination_5_per_root_of_combination, combination_5_offset; } strings_rise_slope_constants;

static inline void strings_rise_slope_prepare(strings_rise_slope_constants *c, const strings_rise_constants
    *v)
{
    (void)c; (void)v;
    c->combination_3_per_offset_squared = -2.0*v->string_ratio;
    c->combination_3_per_root_of_combination = 2.0*(v->string_ratio*v->string_ratio);
    c->combination_3_offset = 2.0*(v->string_ratio*v->string_ratio*v->string_ratio);
    c->combination_4_per_root_of_combination = 2.0*v->string_ratio;
    c->by_string_ratio_per_offset_squared_over_combination_3 = -v->string_ratio;
    c->combination_5_per_offset_squared = -4.0*v->string_ratio;
    c->combination_5_per_root_of_combination = 4.0*(v->string_ratio*v->string_ratio);
    c->combination_5_offset = 4.0*(v->string_ratio*v->string_ratio*v->string_ratio);
}

typedef struct {
    vec offset_squared_by_root_of_combination[TERMS];
    vec combination_3[TERMS];
    vec offset_squared_over_combination_3[TERMS];
    vec over_offset_squared_over_combination_3;
    vec combination_4[TERMS];
    vec offset_squared_over_combination_4[TERMS];
    vec over_offset_squared_over_combination_4;
    vec by_string_ratio[TERMS];
    vec combination_5[TERMS];
    vec offset_squared_over_combination_5[TERMS];
    vec over_offset_squared_over_combination_5;
    vec inverse_combination_2[TERMS];
    vec by_offset_squared[TERMS];
} strings_rise_slopes;

/* Derivatives of strings_rise by its arguments; products of series: 5. */
INLINE void strings_rise_slopes_of(strings_rise_slopes *restrict s, const strings_rise_slope_constants *c,
    const strings_rise_series *of, const strings_rise_constants *v, const vec *offset_squared)
{
    (void)offset_squared; (void)of; (void)c; (void)v;
    EACH_TERM(s->offset_squared_by_root_of_combination[k] = product(offset_squared, of->root_of_combination,
        k);)
    EACH_TERM(s->combination_3[k] = k == 0 ? c->combination_3_per_offset_squared*offset_squared[k] +
        c->combination_3_per_root_of_combination*of->root_of_combination[k] -
        s->offset_squared_by_root_of_combination[k] + c->combination_3_offset :
        c->combination_3_per_offset_squared*offset_squared[k] +
        c->combination_3_per_root_of_combination*of->root_of_combination[k] -
        s->offset_squared_by_root_of_combination[k];)
    EACH_TERM(s->offset_squared_over_combination_3[k] = quotient(offset_squared, s->combination_3,
        s->offset_squared_over_combination_3, &s->over_offset_squared_over_combination_3, k);)
    EACH_TERM(s->combination_4[k] = k == 0 ?
        c->combination_4_per_root_of_combination*of->root_of_combination[k] - offset_squared[k] +
        c->combination_3_per_root_of_combination :
        c->combination_4_per_root_of_combination*of->root_of_combination[k] - offset_squared[k];)
    EACH_TERM(s->offset_squared_over_combination_4[k] = quotient(offset_squared, s->combination_4,
        s->offset_squared_over_combination_4, &s->over_offset_squared_over_combination_4, k);)
    EACH_TERM(s->by_string_ratio[k] =
        c->by_string_ratio_per_offset_squared_over_combination_3*s->offset_squared_over_combination_3[k] -
        s->offset_squared_over_combination_4[k];)
    EACH_TERM(s->combination_5[k] = k == 0 ? c->combination_5_per_offset_squared*offset_squared[k] +
        c->combination_5_per_root_of_combination*of->root_of_combination[k] -
        2.0*s->offset_squared_by_root_of_combination[k] + c->combination_5_offset :
        c->combination_5_per_offset_squared*offset_squared[k] +
        c->combination_5_per_root_of_combination*of->root_of_combination[k] -
        2.0*s->offset_squared_by_root_of_combination[k];)
    EACH_TERM(s->offset_squared_over_combination_5[k] = quotient(offset_squared, s->combination_5,
        s->offset_squared_over_combination_5, &s->over_offset_squared_over_combination_5, k);)
    EACH_TERM(s->inverse_combination_2[k] = reciprocal(of->combination_2, s->inverse_combination_2, k);)
    EACH_TERM(s->by_offset_squared[k] = s->offset_squared_over_combination_5[k] +
        s->inverse_combination_2[k];)
}

typedef struct { vec combination_2_per_root_of_combination, by_string_ratio_per_inverse_combination_2, combination_3_per_root_of_combination; } strings_stiffness_slope_constants;

static inline void strings_stiffness_slope_prepare(strings_stiffness_slope_constants *c, const
    strings_stiffness_constants *v)
{
    (void)c; (void)v;
    c->combination_2_per_root_of_combination = (v->string_ratio*v->string_ratio);
    c->by_string_ratio_per_inverse_combination_2 = -v->string_ratio;
    c->combination_3_per_root_of_combination = 2.0*(v->string_ratio*v->string_ratio);
}

typedef struct {
    vec offset_squared_by_root_of_combination[TERMS];
    vec combination_2[TERMS];
    vec inverse_combination_2[TERMS];
    vec by_string_ratio[TERMS];
    vec combination_3[TERMS];
    vec by_offset_squared[TERMS];
} strings_stiffness_slopes;

/* Derivatives of strings_stiffness by its arguments; products of series: 3. */
INLINE void strings_stiffness_slopes_of(strings_stiffness_slopes *restrict s, const
    strings_stiffness_slope_constants *c, const strings_stiffness_series *of, const
    strings_stiffness_constants *v, const vec *offset_squared)
{
    (void)offset_squared; (void)of; (void)c; (void)v;
    EACH_TERM(s->offset_squared_by_root_of_combination[k] = product(offset_squared, of->root_of_combination,
        k);)
    EACH_TERM(s->combination_2[k] = c->combination_2_per_root_of_combination*of->root_of_combination[k] -
        s->offset_squared_by_root_of_combination[k];)
    EACH_TERM(s->inverse_combination_2[k] = reciprocal(s->combination_2, s->inverse_combination_2, k);)
    EACH_TERM(s->by_string_ratio[k] =
        c->by_string_ratio_per_inverse_combination_2*s->inverse_combination_2[k];)
    EACH_TERM(s->combination_3[k] = c->combination_3_per_root_of_combination*of->root_of_combination[k] -
        2.0*s->offset_squared_by_root_of_combination[k];)
    EACH_TERM(s->by_offset_squared[k] = reciprocal(s->combination_3, s->by_offset_squared, k);)
}
