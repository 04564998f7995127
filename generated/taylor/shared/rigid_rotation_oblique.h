/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* The state with this least energy: no normal velocity, rigid rotation. */
static inline void rigid_rotation(const constants *c, const vec *y, vec *rigid)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec momentum = y[ORBITAL_MOMENTUM] + 6.4*y[SPIN];
    vec distance_squared = distance*distance;
    vec inertia_ratio = distance_squared + 6.4;
    vec distance_squared_by_momentum = distance_squared*momentum;
    vec orbital_momentum_2 = distance_squared_by_momentum/inertia_ratio;
    vec spin_2 = momentum/inertia_ratio;
    rigid[ORBITAL_MOMENTUM] = orbital_momentum_2;
    rigid[SPIN] = spin_2;
}
