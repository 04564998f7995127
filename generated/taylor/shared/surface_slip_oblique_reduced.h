/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Relative velocity of the surfaces at the contact, at the lever arm of the shear, over a Omega. */
static inline vec surface_slip(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec spin = -0.15625*y[ORBITAL_MOMENTUM] + c->spin_offset;
    vec slip = orbital_rate - spin;
    vec surface_slip = distance*slip;
    return surface_slip;
}
