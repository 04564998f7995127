/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Energies of the state over m v0^2. Their sum. */
static inline vec stored_energy(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec gap_squared = y[GAP]*y[GAP];
    vec scaled_rotation = 0.5*y[ROTATION];
    vec sine_of_scaled_rotation = vec_sin(scaled_rotation);
    vec sine_of_scaled_rotation_squared = sine_of_scaled_rotation*sine_of_scaled_rotation;
    vec distance_by_sine_of_scaled_rotation_squared = distance*sine_of_scaled_rotation_squared;
    vec offset_squared = c->offset_squared_per_gap_squared*gap_squared +
        4.0*distance_by_sine_of_scaled_rotation_squared;
    vec orbital_rate_squared = orbital_rate*orbital_rate;
    vec distance_squared_by_orbital_rate_squared = distance_squared*orbital_rate_squared;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec spin_squared = y[SPIN]*y[SPIN];
    vec strings_rise_law = strings_rise_value(&c->strings_rise_law, offset_squared);
    vec energy =
        c->energy_per_distance_squared_by_orbital_rate_squared*distance_squared_by_orbital_rate_squared +
        0.5*normal_velocity_squared + c->energy_per_spin_squared*spin_squared +
        c->energy_per_strings_rise_law*strings_rise_law;
    return energy;
}
