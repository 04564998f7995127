/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Energies of the state over m v0^2. Their sum. */
static inline vec stored_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec orbital_rate_squared = orbital_rate*orbital_rate;
    vec distance_squared_by_orbital_rate_squared = distance_squared*orbital_rate_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec spin_squared = y[SPIN]*y[SPIN];
    vec energy =
        c->energy_per_distance_squared_by_orbital_rate_squared*distance_squared_by_orbital_rate_squared +
        0.5*normal_velocity_squared + c->energy_per_spin_squared*spin_squared;
    return energy;
}
