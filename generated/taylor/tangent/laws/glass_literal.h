/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 cbe29fa6b784a9433b151f8a5c6c8a7a624f3bd19d59c86ae0f66c0c4662e956 */

/* Slopes of the glass law `literal`. */

/* Slopes of the limit less the value. */
static inline void glass_pressure_margin_slopes(vec gap, vec approach, vec limit, vec *by_gap, vec
    *by_approach, vec *by_limit)
{
    (void)gap;
    (void)approach;
    (void)limit;
    *by_gap = 2.0*approach/(gap*gap*gap);
    *by_approach = -1.0/(gap*gap);
    *by_limit = splat(1.0);
}
