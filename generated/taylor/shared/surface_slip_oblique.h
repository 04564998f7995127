/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega. */
static inline vec surface_slip(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec arm_lever_law = arm_lever_value(&c->arm_lever_law, distance);
    vec distance_by_orbital_rate = distance*orbital_rate;
    vec arm_lever_law_by_spin = arm_lever_law*y[SPIN];
    vec surface_slip = distance_by_orbital_rate - 2.0*arm_lever_law_by_spin;
    return surface_slip;
}
