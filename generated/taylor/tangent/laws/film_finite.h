/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 86292dc2d3ab7eaf695949e7c560a4b034ffe87a63955fef301acdb07da38acb */

/* Slopes of the film law `finite`. */

typedef struct { char none[0]; } film_resistance_slope_constants;

static inline void film_resistance_slope_prepare(film_resistance_slope_constants *c, const
    film_resistance_constants *v)
{
    (void)c; (void)v;
}

typedef struct {
    vec inverse_gap_squared[TERMS];
    vec by_gap[TERMS];
} film_resistance_slopes;

/* Derivatives of film_resistance by its arguments; products of series: 0.5. */
INLINE void film_resistance_slopes_of(film_resistance_slopes *restrict s, const
    film_resistance_slope_constants *c, const film_resistance_series *of, const film_resistance_constants *v,
    const vec *gap)
{
    (void)gap; (void)of; (void)c; (void)v;
    EACH_TERM(s->inverse_gap_squared[k] = square(of->inverse_gap, k);)
    EACH_TERM(s->by_gap[k] = k == 0 ? -s->inverse_gap_squared[k] + 1.0 : -s->inverse_gap_squared[k];)
}
