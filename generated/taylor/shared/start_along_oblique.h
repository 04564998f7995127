/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Derivative of the initial state by a group. */
static inline void start_along(const constants *v, int group, vec *after)
{
    (void)v;
    after[GAP] = splat(0.0);
    after[NORMAL_VELOCITY] = splat(0.0);
    after[ORBITAL_MOMENTUM] = splat(0.0);
    after[SPIN] = splat(0.0);
    switch (group) {
    case BY_ASPECT:
        after[ORBITAL_MOMENTUM] += 2.0*v->initial_turning*(v->aspect + 4.0);
        break;
    case BY_INITIAL_TURNING:
        after[ORBITAL_MOMENTUM] += ((v->aspect + 4.0)*(v->aspect + 4.0));
        break;
    case BY_INITIAL_SPIN:
        after[SPIN] += 1.0;
        break;
    }
}
