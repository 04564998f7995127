/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Coefficient k + 1 of a derivative of the states, with its source terms. */
INLINE void tangent_coefficients(vec (*t)[TERMS], const slopes *s, const slope_constants *c, const series *of,
    const constants *v, vec film, vec shear, const vec *const *source, int k)
{
    double next = 1.0/(k + 1);
    (void)s; (void)c; (void)of; (void)v; (void)film; (void)shear;
    t[GAP][k + 1] = (t[NORMAL_VELOCITY][k])*next;
    t[NORMAL_VELOCITY][k + 1] = (product(s->normal_velocity_by_gap, t[GAP], k) +
        product(s->normal_velocity_by_normal_velocity, t[NORMAL_VELOCITY], k) +
        product(s->normal_velocity_by_orbital_momentum, t[ORBITAL_MOMENTUM], k) +
        product(s->normal_velocity_by_rotation, t[ROTATION], k) + source[NORMAL_VELOCITY][k])*next;
    t[ORBITAL_MOMENTUM][k + 1] = (product(s->orbital_momentum_by_gap, t[GAP], k) +
        product(s->orbital_momentum_by_orbital_momentum, t[ORBITAL_MOMENTUM], k) +
        product(s->orbital_momentum_by_spin, t[SPIN], k) + product(s->orbital_momentum_by_rotation,
        t[ROTATION], k) + source[ORBITAL_MOMENTUM][k])*next;
    t[SPIN][k + 1] = (product(s->spin_by_gap, t[GAP], k) + product(s->spin_by_orbital_momentum,
        t[ORBITAL_MOMENTUM], k) + product(s->spin_by_spin, t[SPIN], k) + source[SPIN][k])*next;
    t[ROTATION][k + 1] = (product(s->rotation_by_gap, t[GAP], k) + product(s->rotation_by_orbital_momentum,
        t[ORBITAL_MOMENTUM], k) + source[ROTATION][k])*next;
}
