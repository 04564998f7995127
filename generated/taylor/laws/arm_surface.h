/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 ebf75598b18a84fc77c8ba09a4de9b0ef0b2694ece643689dca90dfdec62f8a8 */

/* arm law `surface`: leading-order arm R = 2a: conserves angular momentum only to O(x/4a).
 *
 * Source: Donahue, Davis, Kantak & Hrenya, Phys. Rev. E 86, 021303 (2012): leading order in the gap. */

typedef struct { vec none; } arm_lever_constants;

static inline void arm_lever_prepare(arm_lever_constants *c)
{
    c->none = splat(0.0);
}

typedef struct {
    vec result[TERMS];
} arm_lever_series;

/* Arm over a: the sphere radius. Coefficient k of its series; products of series: 0. */
INLINE void arm_lever_next(arm_lever_series *s, const arm_lever_constants *c, const vec *distance, int k)
{
    (void)distance; (void)c;
    s->result[k] = k == 0 ? splat(2.0) : splat(0.0);
}

/* Arm over a: the sphere radius. */
static inline vec arm_lever_value(const arm_lever_constants *c, vec distance)
{
    (void)distance; (void)c;
    return splat(2.0);
}
