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
    vec inward_force = -centrifugal_force;
    return inward_force;
}
