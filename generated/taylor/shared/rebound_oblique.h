/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* State just after a rebound: u -> -e_dry u; the other states are continuous. */
static inline void rebound(const constants *c, const vec *y, vec *after)
{
    (void)c; (void)y;
    vec normal_velocity_2 = c->normal_velocity_2_per_normal_velocity*y[NORMAL_VELOCITY];
    after[GAP] = y[GAP];
    after[NORMAL_VELOCITY] = normal_velocity_2;
    after[ORBITAL_MOMENTUM] = y[ORBITAL_MOMENTUM];
    after[SPIN] = y[SPIN];
}
