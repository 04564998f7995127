/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Energies of the state over m v0^2. Their sum. */
static inline vec stored_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec energy = 0.5*normal_velocity_squared;
    return energy;
}
