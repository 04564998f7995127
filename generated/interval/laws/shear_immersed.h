/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 8ca29c7559078c070dbdd6849e539cc8cbb76262ceafda2504523838994270d9 */

/* shear law `immersed`: leading logarithm of nearly touching, fully immersed spheres: cut off at the sphere
 * radius 2a. */

typedef struct {
    dual aspect;
    dual k0;
    dual k1;
} shear_log_factor_constants;

typedef struct {
    series log_of_gap;
} shear_log_factor_series;

static void shear_log_factor_prepare(shear_log_factor_constants *c, dual aspect)
{
    (void)c;
    c->aspect = aspect;
    c->k0 = d_ratio(-1.0, 1.0);
    c->k1 = d_add(d_mul(d_ratio(-1.0, 1.0), d_log(c->aspect)), d_log(d_ratio(2.0, 1.0)));
}

/* Tangential force over 8 pi mu a^2 (omega - xi), inside its edge. Coefficient k of its series. */
static void shear_log_factor_next(shear_log_factor_series *s, series *result, const shear_log_factor_constants
    *c, const series *gap, int k)
{
    (void)s; (void)c; (void)gap;
    s_log(&s->log_of_gap, gap, k);
    s_linear(result, 1, (const series *[]){&s->log_of_gap}, (const dual *[]){&c->k0}, &c->k1, k);
}

/* Gap (in film thicknesses) beyond which there is no tangential force. */
static dual shear_edge(dual aspect)
{
    return d_div(d_ratio(2.0, 1.0), aspect);
}
