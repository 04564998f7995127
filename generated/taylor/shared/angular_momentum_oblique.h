/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* 1 + the change of the angular momentum over its size at initial contact. */
static inline vec angular_momentum(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec momentum = y[ORBITAL_MOMENTUM] + 6.4*y[SPIN];
    vec combination = momentum + c->combination_offset;
    vec angular_momentum = c->angular_momentum_per_combination*combination + 1.0;
    return angular_momentum;
}
