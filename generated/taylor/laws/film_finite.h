/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 86292dc2d3ab7eaf695949e7c560a4b034ffe87a63955fef301acdb07da38acb */

/* film law `finite`: Reynolds film of finite thickness, the same on approach and rebound (no cavitation).
 *
 * Source: Kantak & Davis, Powder Technol. 168, 42 (2006); derived: pressure integrated over the disc h < x0. */

typedef struct { vec none; } film_resistance_constants;

static inline void film_resistance_prepare(film_resistance_constants *c)
{
    c->none = splat(0.0);
}

typedef struct {
    vec inverse_gap[TERMS];
    vec result[TERMS];
} film_resistance_series;

/* Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1). Coefficient k of its series;
 * products of series: 1. */
INLINE void film_resistance_next(film_resistance_series *s, const film_resistance_constants *c, const vec
    *gap, int k)
{
    (void)gap; (void)c;
    s->inverse_gap[k] = reciprocal(gap, s->inverse_gap, k);
    s->result[k] = k == 0 ? gap[k] + s->inverse_gap[k] + (-2.0) : gap[k] + s->inverse_gap[k];
}

/* Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1). */
static inline vec film_resistance_value(const film_resistance_constants *c, vec gap)
{
    (void)gap; (void)c;
    vec inverse_gap = 1.0/gap;
    vec result = gap + inverse_gap + (-2.0);
    return result;
}

#define FILM_RESISTANCE_FALLS 1 /* never increases with its first argument */

#define FILM_RESISTANCE_WORK 1
/* Antiderivative, in closed form. */
static inline vec film_resistance_work(const film_resistance_constants *c, vec gap)
{
    (void)c;
    vec gap_squared = gap*gap;
    vec log_of_gap = vec_log(gap);
    vec work = 0.5*gap_squared + log_of_gap - 2.0*gap;
    return work;
}

#define FILM_STOPPING 1
/* Velocity, over v0/St, that the film takes from a doublet opening from this gap to x0. */
static inline vec film_stopping(vec gap)
{
    return 2.0*gap - 0.5*(gap*gap) - vec_log(gap) - 1.5;
}

#define FILM_BRAKING 1
/* Velocity, over v0/St, that the film takes from an approach from x0 to this gap. */
static inline vec film_braking(vec gap)
{
    return 2.0*gap - 0.5*(gap*gap) - vec_log(gap) - 1.5;
}
