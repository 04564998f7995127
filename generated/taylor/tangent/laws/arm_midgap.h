/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 404c66e8ca8e03f9871f28116257f38724bd193d38f93f8376c5aef4a0297ee7 */

/* Slopes of the arm law `midgap`. */

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
    EACH_TERM(s->by_distance[k] = k == 0 ? splat(0.5) : splat(0.0);)
}
