/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 cbe29fa6b784a9433b151f8a5c6c8a7a624f3bd19d59c86ae0f66c0c4662e956 */

/* glass law `literal`: 3 mu a |u|/x^2 as published: can fire at initial contact.
 *
 * Source: Donahue et al., J. Fluid Mech. 650, 479 (2010); derived from the film pressure. */

typedef struct { vec limit; } glass_pressure_clearance_constants;

static inline void glass_pressure_clearance_prepare(glass_pressure_clearance_constants *c, vec limit)
{
    c->limit = limit;
}

typedef struct {
    vec gap_squared[TERMS];
    vec result[TERMS];
} glass_pressure_clearance_series;

/* Limit minus value, times the positive denominator: the sign of the event function. Coefficient k of its
 * series; products of series: 0.5. */
INLINE void glass_pressure_clearance_next(glass_pressure_clearance_series *s, const
    glass_pressure_clearance_constants *c, const vec *gap, const vec *approach, int k)
{
    (void)gap; (void)approach; (void)c;
    s->gap_squared[k] = square(gap, k);
    s->result[k] = c->limit*s->gap_squared[k] - approach[k];
}

/* Limit minus value, times the positive denominator: the sign of the event function. */
static inline vec glass_pressure_clearance_value(const glass_pressure_clearance_constants *c, vec gap, vec
    approach)
{
    (void)gap; (void)approach; (void)c;
    vec gap_squared = gap*gap;
    vec result = c->limit*gap_squared - approach;
    return result;
}

#define GLASS_REACH 1
/* Gap at which this approach speed meets the criterion. */
static inline vec glass_reach(vec approach, vec glass_number)
{
    return vec_sqrt(approach)/vec_sqrt(glass_number);
}
