/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 988fad14ceb4ba2b64e33003ca6e9c5bdce6a9c48e4b863af76eba9f944427a2 */

/* bridge law `constant`: gap-independent upper bound, the force at contact.
 *
 * Source: Derjaguin, Kolloid-Z. 69, 155 (1934): 2 cos(phi), the limit at h = 0. */

typedef struct { vec volume, contact_angle, level; } bridge_force_constants;

static inline void bridge_force_prepare(bridge_force_constants *c, vec volume, vec contact_angle)
{
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->level = 2.0*vec_cos(c->contact_angle);
}

typedef struct {
    vec result[TERMS];
} bridge_force_series;

/* Capillary attraction over pi R sigma. Coefficient k of its series; products of series: 0. */
INLINE void bridge_force_next(bridge_force_series *s, const bridge_force_constants *c, const vec
    *gap_over_radius, int k)
{
    (void)gap_over_radius; (void)c;
    s->result[k] = k == 0 ? c->level : splat(0.0);
}

/* Capillary attraction over pi R sigma. */
static inline vec bridge_force_value(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)gap_over_radius; (void)c;
    return c->level;
}

#define BRIDGE_FORCE_FALLS 1 /* never increases with its first argument */

#define BRIDGE_FORCE_WORK 1
/* Antiderivative, in closed form. */
static inline vec bridge_force_work(const bridge_force_constants *c, vec gap_over_radius)
{
    (void)c;
    vec work = c->level*gap_over_radius;
    return work;
}
