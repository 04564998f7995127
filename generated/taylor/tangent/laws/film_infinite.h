/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 932d19c493e9d982f26d99d8f6939d55c88bf99d269728fe7bec067c2c6916ba */

/* Slopes of the film law `infinite`. */

typedef struct { char none[0]; } film_resistance_slope_constants;

static inline void film_resistance_slope_prepare(film_resistance_slope_constants *c, const
    film_resistance_constants *v)
{
    (void)c; (void)v;
}

typedef struct {
    vec result_squared[TERMS];
    vec by_gap[TERMS];
} film_resistance_slopes;

/* Derivatives of film_resistance by its arguments; products of series: 0.5. */
INLINE void film_resistance_slopes_of(film_resistance_slopes *restrict s, const
    film_resistance_slope_constants *c, const film_resistance_series *of, const film_resistance_constants *v,
    const vec *gap)
{
    (void)gap; (void)of; (void)c; (void)v;
    EACH_TERM(s->result_squared[k] = square(of->result, k);)
    EACH_TERM(s->by_gap[k] = -s->result_squared[k];)
}
