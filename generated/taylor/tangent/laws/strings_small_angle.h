/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 729e9598df0ad609d580de2d389e5c61e218978839e940d03b65919437c8936c */

/* Slopes of the strings law `small-angle`. */

typedef struct { vec by_string_ratio_per_offset_squared, level_by_offset_squared; } strings_rise_slope_constants;

static inline void strings_rise_slope_prepare(strings_rise_slope_constants *c, const strings_rise_constants
    *v)
{
    (void)c; (void)v;
    c->by_string_ratio_per_offset_squared = -0.5/(v->string_ratio*v->string_ratio);
    c->level_by_offset_squared = 0.5/v->string_ratio;
}

typedef struct {
    vec by_string_ratio[TERMS];
    vec by_offset_squared[TERMS];
} strings_rise_slopes;

/* Derivatives of strings_rise by its arguments; products of series: 0. */
INLINE void strings_rise_slopes_of(strings_rise_slopes *restrict s, const strings_rise_slope_constants *c,
    const strings_rise_series *of, const strings_rise_constants *v, const vec *offset_squared)
{
    (void)offset_squared; (void)of; (void)c; (void)v;
    EACH_TERM(s->by_string_ratio[k] = c->by_string_ratio_per_offset_squared*offset_squared[k];)
    EACH_TERM(s->by_offset_squared[k] = k == 0 ? c->level_by_offset_squared : splat(0.0);)
}

typedef struct { vec level_by_string_ratio; } strings_stiffness_slope_constants;

static inline void strings_stiffness_slope_prepare(strings_stiffness_slope_constants *c, const
    strings_stiffness_constants *v)
{
    (void)c; (void)v;
    c->level_by_string_ratio = -1.0/(v->string_ratio*v->string_ratio);
}

typedef struct {
    vec by_string_ratio[TERMS];
    vec by_offset_squared[TERMS];
} strings_stiffness_slopes;

/* Derivatives of strings_stiffness by its arguments; products of series: 0. */
INLINE void strings_stiffness_slopes_of(strings_stiffness_slopes *restrict s, const
    strings_stiffness_slope_constants *c, const strings_stiffness_series *of, const
    strings_stiffness_constants *v, const vec *offset_squared)
{
    (void)offset_squared; (void)of; (void)c; (void)v;
    EACH_TERM(s->by_string_ratio[k] = k == 0 ? c->level_by_string_ratio : splat(0.0);)
    EACH_TERM(s->by_offset_squared[k] = k == 0 ? splat(0.0) : splat(0.0);)
}
