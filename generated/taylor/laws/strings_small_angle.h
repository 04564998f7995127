/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 729e9598df0ad609d580de2d389e5c61e218978839e940d03b65919437c8936c */

/* strings law `small-angle`: linearised in the swing: sqrt(l^2 - d^2) -> l.
 *
 * Source: Donahue, Brewer, Davis & Hrenya, J. Fluid Mech. 708, 128 (2012): vertical tension balances the
 * weight. */

typedef struct { vec string_ratio, result_per_offset_squared; } strings_rise_constants;

static inline void strings_rise_prepare(strings_rise_constants *c, vec string_ratio)
{
    c->string_ratio = string_ratio;
    c->result_per_offset_squared = 0.5/c->string_ratio;
}

typedef struct {
    vec result[TERMS];
} strings_rise_series;

/* Height gained by each sphere over a. Coefficient k of its series; products of series: 0. */
INLINE void strings_rise_next(strings_rise_series *s, const strings_rise_constants *c, const vec
    *offset_squared, int k)
{
    (void)offset_squared; (void)c;
    s->result[k] = c->result_per_offset_squared*offset_squared[k];
}

/* Height gained by each sphere over a. */
static inline vec strings_rise_value(const strings_rise_constants *c, vec offset_squared)
{
    (void)offset_squared; (void)c;
    vec result = c->result_per_offset_squared*offset_squared;
    return result;
}

typedef struct { vec string_ratio, level; } strings_stiffness_constants;

static inline void strings_stiffness_prepare(strings_stiffness_constants *c, vec string_ratio)
{
    c->string_ratio = string_ratio;
    c->level = 1.0/c->string_ratio;
}

typedef struct {
    vec result[TERMS];
} strings_stiffness_series;

/* Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2). Coefficient k of its series;
 * products of series: 0. */
INLINE void strings_stiffness_next(strings_stiffness_series *s, const strings_stiffness_constants *c, const
    vec *offset_squared, int k)
{
    (void)offset_squared; (void)c;
    s->result[k] = k == 0 ? c->level : splat(0.0);
}

/* Horizontal restoring force over weight and swing d/a: a/sqrt(l^2 - d^2). */
static inline vec strings_stiffness_value(const strings_stiffness_constants *c, vec offset_squared)
{
    (void)offset_squared; (void)c;
    return c->level;
}
