/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8d9c64ecb385998c2c8e00fa79beaf31b68745051a17bab0aeff4e213f05290a */

/* Slopes of the film law `constant-volume`. */

typedef struct { vec combination_3_per_gap_squared, combination_3_offset, by_aspect_per_combination_2_over_rim_squared_by_rim_over_root_of_combination_3, by_volume_per_combination_2_over_rim_squared_by_rim_over_root_of_combination_3; } film_resistance_slope_constants;

static inline void film_resistance_slope_prepare(film_resistance_slope_constants *c, const
    film_resistance_constants *v)
{
    (void)c; (void)v;
    c->combination_3_per_gap_squared = 3.141592653589793*(v->aspect*v->aspect);
    c->combination_3_offset = 8.0*v->volume;
    c->by_aspect_per_combination_2_over_rim_squared_by_rim_over_root_of_combination_3 =
        16.0*v->volume/(1.772453850905516*(v->aspect*v->aspect));
    c->by_volume_per_combination_2_over_rim_squared_by_rim_over_root_of_combination_3 =
        -8.0/(1.772453850905516*v->aspect);
}

typedef struct {
    vec rim_squared_by_rim[TERMS];
    vec gap_squared_over_rim_squared_by_rim[TERMS];
    vec over_gap_squared_over_rim_squared_by_rim;
    vec gap_squared_over_rim_squared_by_rim_over_rim[TERMS];
    vec over_gap_squared_over_rim_squared_by_rim_over_rim;
    vec gap_over_rim_squared[TERMS];
    vec over_gap_over_rim_squared;
    vec gap_over_rim_squared_over_rim[TERMS];
    vec over_gap_over_rim_squared_over_rim;
    vec inverse_rim_squared[TERMS];
    vec inverse_gap_squared[TERMS];
    vec by_gap[TERMS];
    vec combination_2_over_rim_squared_by_rim[TERMS];
    vec over_combination_2_over_rim_squared_by_rim;
    vec combination_3[TERMS];
    vec root_of_combination_3[TERMS];
    vec over_root_of_combination_3;
    vec combination_2_over_rim_squared_by_rim_over_root_of_combination_3[TERMS];
    vec over_combination_2_over_rim_squared_by_rim_over_root_of_combination_3;
    vec by_aspect[TERMS];
    vec by_volume[TERMS];
} film_resistance_slopes;

/* Derivatives of film_resistance by its arguments; products of series: 9.5. */
INLINE void film_resistance_slopes_of(film_resistance_slopes *restrict s, const
    film_resistance_slope_constants *c, const film_resistance_series *of, const film_resistance_constants *v,
    const vec *gap)
{
    (void)gap; (void)of; (void)c; (void)v;
    EACH_TERM(s->rim_squared_by_rim[k] = product(of->rim_squared, of->rim, k);)
    EACH_TERM(s->gap_squared_over_rim_squared_by_rim[k] = quotient(of->gap_squared, s->rim_squared_by_rim,
        s->gap_squared_over_rim_squared_by_rim, &s->over_gap_squared_over_rim_squared_by_rim, k);)
    EACH_TERM(s->gap_squared_over_rim_squared_by_rim_over_rim[k] =
        quotient(s->gap_squared_over_rim_squared_by_rim, of->rim,
        s->gap_squared_over_rim_squared_by_rim_over_rim,
        &s->over_gap_squared_over_rim_squared_by_rim_over_rim, k);)
    EACH_TERM(s->gap_over_rim_squared[k] = quotient(gap, of->rim_squared, s->gap_over_rim_squared,
        &s->over_gap_over_rim_squared, k);)
    EACH_TERM(s->gap_over_rim_squared_over_rim[k] = quotient(s->gap_over_rim_squared, of->rim,
        s->gap_over_rim_squared_over_rim, &s->over_gap_over_rim_squared_over_rim, k);)
    EACH_TERM(s->inverse_rim_squared[k] = reciprocal(of->rim_squared, s->inverse_rim_squared, k);)
    EACH_TERM(s->inverse_gap_squared[k] = reciprocal(of->gap_squared, s->inverse_gap_squared, k);)
    EACH_TERM(s->by_gap[k] = 2.0*s->gap_over_rim_squared_over_rim[k] + s->inverse_rim_squared[k] -
        2.0*s->gap_squared_over_rim_squared_by_rim_over_rim[k] - s->inverse_gap_squared[k];)
    EACH_TERM(s->combination_2_over_rim_squared_by_rim[k] = quotient(of->combination_2, s->rim_squared_by_rim,
        s->combination_2_over_rim_squared_by_rim, &s->over_combination_2_over_rim_squared_by_rim, k);)
    EACH_TERM(s->combination_3[k] = k == 0 ? c->combination_3_per_gap_squared*of->gap_squared[k] +
        c->combination_3_offset : c->combination_3_per_gap_squared*of->gap_squared[k];)
    EACH_TERM(s->root_of_combination_3[k] = root(s->combination_3, s->root_of_combination_3,
        &s->over_root_of_combination_3, k);)
    EACH_TERM(s->combination_2_over_rim_squared_by_rim_over_root_of_combination_3[k] =
        quotient(s->combination_2_over_rim_squared_by_rim, s->root_of_combination_3,
        s->combination_2_over_rim_squared_by_rim_over_root_of_combination_3,
        &s->over_combination_2_over_rim_squared_by_rim_over_root_of_combination_3, k);)
    EACH_TERM(s->by_aspect[k] =
        c->by_aspect_per_combination_2_over_rim_squared_by_rim_over_root_of_combination_3*s->combination_2_over_rim_squared_by_rim_over_root_of_combination_3[k];)
    EACH_TERM(s->by_volume[k] =
        c->by_volume_per_combination_2_over_rim_squared_by_rim_over_root_of_combination_3*s->combination_2_over_rim_squared_by_rim_over_root_of_combination_3[k];)
}
