/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8d9c64ecb385998c2c8e00fa79beaf31b68745051a17bab0aeff4e213f05290a */

/* film law `constant-volume`: the rim follows the bridge's liquid, H = sqrt(x^2 + V_b/(pi a)) in place of x0,
 * at any gap.
 *
 * Source: Pitois, Moucheront & Chateau, J. Colloid Interface Sci. 231, 26 (2000); derived: a disc of that
 * volume. */

typedef struct { vec aspect, volume, combination_offset; } film_resistance_constants;

static inline void film_resistance_prepare(film_resistance_constants *c, vec aspect, vec volume)
{
    c->aspect = aspect;
    c->volume = volume;
    c->combination_offset = 8.0*c->volume/(3.141592653589793*(c->aspect*c->aspect));
}

typedef struct {
    vec gap_squared[TERMS];
    vec combination[TERMS];
    vec rim[TERMS];
    vec over_rim;
    vec combination_2[TERMS];
    vec combination_2_squared[TERMS];
    vec combination_2_squared_over_gap[TERMS];
    vec over_combination_2_squared_over_gap;
    vec rim_squared[TERMS];
    vec result[TERMS];
    vec over_result;
} film_resistance_series;

/* Normal film force over 6 pi mu a^2 u/x0. Coefficient k of its series; products of series: 4. */
INLINE void film_resistance_next(film_resistance_series *s, const film_resistance_constants *c, const vec
    *gap, int k)
{
    (void)gap; (void)c;
    s->gap_squared[k] = square(gap, k);
    s->combination[k] = k == 0 ? s->gap_squared[k] + c->combination_offset : s->gap_squared[k];
    s->rim[k] = root(s->combination, s->rim, &s->over_rim, k);
    s->combination_2[k] = gap[k] - s->rim[k];
    s->combination_2_squared[k] = square(s->combination_2, k);
    s->combination_2_squared_over_gap[k] = quotient(s->combination_2_squared, gap,
        s->combination_2_squared_over_gap, &s->over_combination_2_squared_over_gap, k);
    s->rim_squared[k] = square(s->rim, k);
    s->result[k] = quotient(s->combination_2_squared_over_gap, s->rim_squared, s->result, &s->over_result, k);
}

/* Normal film force over 6 pi mu a^2 u/x0. */
static inline vec film_resistance_value(const film_resistance_constants *c, vec gap)
{
    (void)gap; (void)c;
    vec gap_squared = gap*gap;
    vec combination = gap_squared + c->combination_offset;
    vec rim = vec_sqrt(combination);
    vec combination_2 = gap - rim;
    vec combination_2_squared = combination_2*combination_2;
    vec combination_2_squared_over_gap = combination_2_squared/gap;
    vec rim_squared = rim*rim;
    vec result = combination_2_squared_over_gap/rim_squared;
    return result;
}

#define FILM_RESISTANCE_FALLS 1 /* never increases with its first argument */

#define FILM_BRAKING 1
/* Velocity, over v0/St, that the film takes from an approach from x0 to this gap. */
static inline vec film_braking(vec gap, vec aspect, vec volume)
{
    vec rim = vec_sqrt((gap*gap) + 8.0*volume/(3.141592653589793*(aspect*aspect)));
    return vec_log(vec_sqrt(1.0 + 8.0*volume/(3.141592653589793*(aspect*aspect)))) + 2.0*vec_log(gap + rim) -
        vec_log(gap) - vec_log(rim) - 2.0*vec_log(vec_sqrt(1.0 +
        8.0*volume/(3.141592653589793*(aspect*aspect))) + 1.0);
}
