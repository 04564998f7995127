/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 ebf75598b18a84fc77c8ba09a4de9b0ef0b2694ece643689dca90dfdec62f8a8 */

/* Slopes of the arm law `surface`. */

typedef struct { char none[0]; } arm_lever_slope_constants;

static inline void arm_lever_slope_prepare(arm_lever_slope_constants *c, const arm_lever_constants *v)
{
    (void)c; (void)v;
}

typedef struct {
    vec by_distance[TERMS];
} arm_lever_slopes;

/* Derivatives of arm_lever by its arguments; products of series: 0. */
INLINE void arm_lever_slopes_of(arm_lever_slopes *restrict s, const arm_lever_slope_constants *c, const
    arm_lever_series *of, const arm_lever_constants *v, const vec *distance)
{
    (void)distance; (void)of; (void)c; (void)v;
    EACH_TERM(s->by_distance[k] = k == 0 ? splat(0.0) : splat(0.0);)
}
