/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Change of the angular momentum over that of the orbital one: none with the lever arm at mid-gap. */
static inline vec momentum_share(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec arm_lever_law = arm_lever_value(&c->arm_lever_law, distance);
    vec arm_lever_law_over_distance = arm_lever_law/distance;
    vec share = -2.0*arm_lever_law_over_distance + 1.0;
    return share;
}
