/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* State at initial contact. */
static inline void start(const constants *c, vec *y)
{
    (void)c; (void)y;
    y[GAP] = splat(1.0);
    y[NORMAL_VELOCITY] = splat((-1.0));
    y[ORBITAL_MOMENTUM] = c->initial_turning*((c->aspect + 4.0)*(c->aspect + 4.0));
    y[SPIN] = c->initial_spin;
    y[ROTATION] = splat(0.0);
}
