/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* The state with this least energy: no normal velocity, rigid rotation. */
static inline vec rigid_momentum(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec inertia_ratio = distance_squared + 6.4;
    vec distance_squared_over_inertia_ratio = distance_squared/inertia_ratio;
    vec orbital_momentum_2 = c->momentum*distance_squared_over_inertia_ratio;
    return orbital_momentum_2;
}
