/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 65965dd50dc370d4842c75fd5a6ccbc44f4efc56a9a0e6d664ea511b5dbe2c49 */

/* attraction law `van-der-waals`: van der Waals attraction of nearly touching spheres, neither retarded nor
 * cut off.
 *
 * Source: Hamaker, Physica 4, 1058 (1937); Derjaguin, Kolloid-Z. 69, 155 (1934). */

typedef struct { vec none; } attraction_force_constants;

static inline void attraction_force_prepare(attraction_force_constants *c)
{
    c->none = splat(0.0);
}

typedef struct {
    vec gap_squared[TERMS];
    vec result[TERMS];
} attraction_force_series;

/* Attraction over A a/(6 x0^2). Coefficient k of its series; products of series: 1.5. */
INLINE void attraction_force_next(attraction_force_series *s, const attraction_force_constants *c, const vec
    *gap, int k)
{
    (void)gap; (void)c;
    s->gap_squared[k] = square(gap, k);
    s->result[k] = reciprocal(s->gap_squared, s->result, k);
}

/* Attraction over A a/(6 x0^2). */
static inline vec attraction_force_value(const attraction_force_constants *c, vec gap)
{
    (void)gap; (void)c;
    vec gap_squared = gap*gap;
    vec result = 1.0/gap_squared;
    return result;
}

#define ATTRACTION_FORCE_FALLS 1 /* never increases with its first argument */

#define ATTRACTION_FORCE_WORK 1
/* Antiderivative, in closed form. */
static inline vec attraction_force_work(const attraction_force_constants *c, vec gap)
{
    (void)c;
    vec inverse_gap = 1.0/gap;
    vec work = -inverse_gap;
    return work;
}
