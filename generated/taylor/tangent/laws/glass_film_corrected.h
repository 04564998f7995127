/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Equations sha256 36672a25b05cedaf9402710ddff628c5d822f6dfebbc6669f339bce1e845eb3b */

/* Slopes of the glass law `film-corrected`. */

/* Slopes of the limit less the value. */
static inline void glass_pressure_margin_slopes(vec gap, vec approach, vec limit, vec *by_gap, vec
    *by_approach, vec *by_limit)
{
    (void)gap;
    (void)approach;
    (void)limit;
    *by_gap = 2.0*approach/(gap*gap*gap);
    *by_approach = 1.0 - 1.0/(gap*gap);
    *by_limit = splat(1.0);
}
