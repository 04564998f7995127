/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 932d19c493e9d982f26d99d8f6939d55c88bf99d269728fe7bec067c2c6916ba */

/* film law `infinite`: no film correction: the pressure of an unbounded film, which ends where the surfaces
 * leave it, x = x0.
 *
 * Source: Davis, Rager & Good, J. Fluid Mech. 468, 107 (2002); derived: the limit x0 -> infinity of `finite`. */

typedef struct { vec none; } film_resistance_constants;

static inline void film_resistance_prepare(film_resistance_constants *c)
{
    c->none = splat(0.0);
}

typedef struct {
    vec result[TERMS];
} film_resistance_series;

/* Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1). Coefficient k of its series;
 * products of series: 1. */
INLINE void film_resistance_next(film_resistance_series *s, const film_resistance_constants *c, const vec
    *gap, int k)
{
    (void)gap; (void)c;
    s->result[k] = reciprocal(gap, s->result, k);
}

/* Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1). */
static inline vec film_resistance_value(const film_resistance_constants *c, vec gap)
{
    (void)gap; (void)c;
    vec result = 1.0/gap;
    return result;
}

#define FILM_RESISTANCE_FALLS 1 /* never increases with its first argument */

#define FILM_RESISTANCE_WORK 1
/* Antiderivative, in closed form. */
static inline vec film_resistance_work(const film_resistance_constants *c, vec gap)
{
    (void)c;
    vec work = vec_log(gap);
    return work;
}

#define FILM_STOPPING 1
/* Velocity, over v0/St, that the film takes from a doublet opening from this gap to x0. */
static inline vec film_stopping(vec gap)
{
    return -vec_log(gap);
}

#define FILM_BRAKING 1
/* Velocity, over v0/St, that the film takes from an approach from x0 to this gap. */
static inline vec film_braking(vec gap)
{
    return -vec_log(gap);
}
