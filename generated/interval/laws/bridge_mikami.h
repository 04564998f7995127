/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 9fee44d3c6672156e33ea0709e0006e7a2dff93ee5c70a213376d36faf1bded9 */

/* bridge law `mikami`: regression of Young-Laplace solutions. */

typedef struct {
    dual volume;
    dual contact_angle;
    dual log_volume;
    dual decay;
    dual offset;
    dual tail;
    dual k4;
} bridge_force_constants;

typedef struct {
    series combination;
    series exp_of_combination;
} bridge_force_series;

static void bridge_force_prepare(bridge_force_constants *c, dual volume, dual contact_angle)
{
    (void)c;
    c->volume = volume;
    c->contact_angle = contact_angle;
    c->log_volume = d_log(c->volume);
    c->decay = d_div(d_ratio(-11.0, 1.0), d_mul(d_ratio(10.0, 1.0), d_exp(d_mul(d_ratio(53.0, 100.0),
        d_log(c->volume)))));
    c->offset = d_add(d_add(d_mul(d_power(c->contact_angle, 2), d_add(d_mul(d_mul(d_ratio(-1.0, 1.0),
        d_ratio(17.0, 50.0)), c->log_volume), d_ratio(-24.0, 25.0))), d_mul(d_mul(d_ratio(-1.0, 1.0),
        d_ratio(19.0, 1000.0)), c->log_volume)), d_ratio(12.0, 25.0));
    c->tail = d_add(d_mul(d_ratio(21.0, 5000.0), c->log_volume), d_ratio(39.0, 500.0));
    c->k4 = d_ratio(1.0, 1.0);
}

/* Capillary attraction over pi R sigma. Coefficient k of its series. */
static void bridge_force_next(bridge_force_series *s, series *result, const bridge_force_constants *c, const
    series *gap_over_radius, int k)
{
    (void)s; (void)c; (void)gap_over_radius;
    s_linear(&s->combination, 1, (const series *[]){gap_over_radius}, (const dual *[]){&c->decay}, &c->offset,
        k);
    s_exp(&s->exp_of_combination, &s->combination, k);
    s_linear(result, 1, (const series *[]){&s->exp_of_combination}, (const dual *[]){&c->k4}, &c->tail, k);
}

/* Rupture distance over R that goes with this law.
 *
 * Source: Mikami, Kamiya & Horio, Chem. Eng. Sci. 53, 1927 (1998). */
static dual bridge_rupture_distance(dual volume, dual contact_angle)
{
    return d_mul(d_exp(d_mul(d_ratio(17.0, 50.0), d_log(volume))), d_add(d_mul(d_ratio(31.0, 50.0),
        contact_angle), d_ratio(99.0, 100.0)));
}
