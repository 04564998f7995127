/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 cbe29fa6b784a9433b151f8a5c6c8a7a624f3bd19d59c86ae0f66c0c4662e956 */

/* glass law `literal`: 3 mu a |u|/x^2 as published: can fire at initial contact. */

typedef struct {
    dual limit;
    dual k0;
} glass_pressure_constants;

typedef struct {
    series gap_squared;
} glass_pressure_series;

static void glass_pressure_prepare(glass_pressure_constants *c, dual limit)
{
    (void)c;
    c->limit = limit;
    c->k0 = d_ratio(-1.0, 1.0);
}

/* Film pressure on the axis over 3 mu a v0/x0^2. Coefficient k of its series. */
static void glass_pressure_next(glass_pressure_series *s, series *result, const glass_pressure_constants *c,
    const series *gap, const series *approach, int k)
{
    (void)s; (void)c; (void)gap; (void)approach;
    s_square(&s->gap_squared, gap, k);
    s_linear(result, 2, (const series *[]){approach, &s->gap_squared}, (const dual *[]){&c->k0, &c->limit},
        NULL, k);
}
