/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Sum of the normal forces except the film's, over m v0^2/x0: positive inward. */
static inline vec inward_force(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec distance = c->aspect*y[GAP] + 4.0;
    vec distance_squared = distance*distance;
    vec orbital_rate = y[ORBITAL_MOMENTUM]/distance_squared;
    vec orbital_rate_squared = orbital_rate*orbital_rate;
    vec centrifugal_force = c->centrifugal_force_factor*distance*orbital_rate_squared;
    vec scaled_gap = c->scaled_gap_per_gap*y[GAP];
    vec bridge_force_law = bridge_force_value(&c->bridge_force_law, scaled_gap);
    vec bridge_force = c->bridge_force_per_bridge_force_law*bridge_force_law;
    vec inward_force = bridge_force - centrifugal_force;
    return inward_force;
}
