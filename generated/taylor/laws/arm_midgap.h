/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 404c66e8ca8e03f9871f28116257f38724bd193d38f93f8376c5aef4a0297ee7 */

/* arm law `midgap`: the tangential force acts at mid-gap, arm = r/2: conserves angular momentum identically.
 *
 * Source: torque balance of the film about the centre of mass. */

typedef struct { vec none; } arm_lever_constants;

static inline void arm_lever_prepare(arm_lever_constants *c)
{
    c->none = splat(0.0);
}

typedef struct {
    vec result[TERMS];
} arm_lever_series;

/* Arm over a, from the centre distance r/a. Coefficient k of its series; products of series: 0. */
INLINE void arm_lever_next(arm_lever_series *s, const arm_lever_constants *c, const vec *distance, int k)
{
    (void)distance; (void)c;
    s->result[k] = 0.5*distance[k];
}

/* Arm over a, from the centre distance r/a. */
static inline vec arm_lever_value(const arm_lever_constants *c, vec distance)
{
    (void)distance; (void)c;
    vec result = 0.5*distance;
    return result;
}
