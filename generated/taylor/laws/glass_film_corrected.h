/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 36672a25b05cedaf9402710ddff628c5d822f6dfebbc6669f339bce1e845eb3b */

/* glass law `film-corrected`: with the film's rim, 1/x^2 - 1/x0^2: zero at initial contact.
 *
 * Source: Donahue et al., J. Fluid Mech. 650, 479 (2010); derived from the film pressure. */

typedef struct { vec limit; } glass_pressure_clearance_constants;

static inline void glass_pressure_clearance_prepare(glass_pressure_clearance_constants *c, vec limit)
{
    c->limit = limit;
}

typedef struct {
    vec gap_squared[TERMS];
    vec combination[TERMS];
    vec approach_by_combination[TERMS];
    vec result[TERMS];
} glass_pressure_clearance_series;

/* Limit minus value, times the positive denominator: the sign of the event function. Coefficient k of its
 * series; products of series: 1.5. */
INLINE void glass_pressure_clearance_next(glass_pressure_clearance_series *s, const
    glass_pressure_clearance_constants *c, const vec *gap, const vec *approach, int k)
{
    (void)gap; (void)approach; (void)c;
    s->gap_squared[k] = square(gap, k);
    s->combination[k] = k == 0 ? s->gap_squared[k] + (-1.0) : s->gap_squared[k];
    s->approach_by_combination[k] = product(approach, s->combination, k);
    s->result[k] = s->approach_by_combination[k] + c->limit*s->gap_squared[k];
}

/* Limit minus value, times the positive denominator: the sign of the event function. */
static inline vec glass_pressure_clearance_value(const glass_pressure_clearance_constants *c, vec gap, vec
    approach)
{
    (void)gap; (void)approach; (void)c;
    vec gap_squared = gap*gap;
    vec combination = gap_squared + (-1.0);
    vec approach_by_combination = approach*combination;
    vec result = approach_by_combination + c->limit*gap_squared;
    return result;
}

#define GLASS_REACH 1
/* Gap at which this approach speed meets the criterion. */
static inline vec glass_reach(vec approach, vec glass_number)
{
    return vec_sqrt(approach)/vec_sqrt(approach + glass_number);
}
