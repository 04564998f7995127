/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 86292dc2d3ab7eaf695949e7c560a4b034ffe87a63955fef301acdb07da38acb */

/* film law `finite`: Reynolds film of finite thickness, the same on approach and rebound (no cavitation). */

typedef struct {
    dual k0;
    dual k1;
} film_resistance_constants;

typedef struct {
    series inverse_gap;
} film_resistance_series;

static void film_resistance_prepare(film_resistance_constants *c)
{
    (void)c;
    c->k0 = d_ratio(1.0, 1.0);
    c->k1 = d_ratio(-2.0, 1.0);
}

/* Normal film force over 6 pi mu a^2 u/x0, for a gap inside the film (gap < 1). Coefficient k of its series. */
static void film_resistance_next(film_resistance_series *s, series *result, const film_resistance_constants
    *c, const series *gap, int k)
{
    (void)s; (void)c; (void)gap;
    s_reciprocal(&s->inverse_gap, gap, k);
    s_linear(result, 2, (const series *[]){gap, &s->inverse_gap}, (const dual *[]){&c->k0, &c->k0}, &c->k1,
        k);
}
