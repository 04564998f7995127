/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Energies of the state over m v0^2. Their sum. */
static inline vec stored_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec gap_squared = y[GAP]*y[GAP];
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec energy = 0.5*normal_velocity_squared + c->energy_per_strings_rise_law*strings_rise_law;
    return energy;
}
