/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 65965dd50dc370d4842c75fd5a6ccbc44f4efc56a9a0e6d664ea511b5dbe2c49 */

/* Slopes of the attraction law `van-der-waals`. */

typedef struct { char none[0]; } attraction_force_slope_constants;

static inline void attraction_force_slope_prepare(attraction_force_slope_constants *c, const
    attraction_force_constants *v)
{
    (void)c; (void)v;
}

typedef struct {
    vec gap_squared_by_gap[TERMS];
    vec inverse_gap_squared_by_gap[TERMS];
    vec by_gap[TERMS];
} attraction_force_slopes;

/* Derivatives of attraction_force by its arguments; products of series: 2. */
INLINE void attraction_force_slopes_of(attraction_force_slopes *restrict s, const
    attraction_force_slope_constants *c, const attraction_force_series *of, const attraction_force_constants
    *v, const vec *gap)
{
    (void)gap; (void)of; (void)c; (void)v;
    EACH_TERM(s->gap_squared_by_gap[k] = product(of->gap_squared, gap, k);)
    EACH_TERM(s->inverse_gap_squared_by_gap[k] = reciprocal(s->gap_squared_by_gap,
        s->inverse_gap_squared_by_gap, k);)
    EACH_TERM(s->by_gap[k] = -2.0*s->inverse_gap_squared_by_gap[k];)
}
