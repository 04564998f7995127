/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Derivative of the results for a separated doublet. */
static inline void outputs_along(const constants *v, const vec *y, const vec *t, int group, vec *shown)
{
    (void)v;
    (void)y;
    shown[0] = t[NORMAL_VELOCITY];
    shown[1] = -v->aspect*y[ORBITAL_MOMENTUM]/(v->initial_turning*(v->aspect + 4.0)*((v->aspect*y[GAP] +
        4.0)*(v->aspect*y[GAP] + 4.0)))*t[GAP] + 1.0/(v->initial_turning*(v->aspect + 4.0)*(v->aspect*y[GAP] +
        4.0))*t[ORBITAL_MOMENTUM];
    shown[2] = -2.0*v->aspect*y[ORBITAL_MOMENTUM]/((v->aspect*y[GAP] + 4.0)*(v->aspect*y[GAP] +
        4.0)*(v->aspect*y[GAP] + 4.0))*t[GAP] + 1.0/((v->aspect*y[GAP] + 4.0)*(v->aspect*y[GAP] +
        4.0))*t[ORBITAL_MOMENTUM];
    shown[3] = (-0.15625)*t[ORBITAL_MOMENTUM];
    switch (group) {
    case BY_ASPECT:
        shown[1] += -2.0*y[ORBITAL_MOMENTUM]*(v->aspect*y[GAP] + 2.0*y[GAP] +
        2.0)/(v->initial_turning*((v->aspect + 4.0)*(v->aspect + 4.0))*((v->aspect*y[GAP] +
        4.0)*(v->aspect*y[GAP] + 4.0)));
        shown[2] += -2.0*y[GAP]*y[ORBITAL_MOMENTUM]/((v->aspect*y[GAP] + 4.0)*(v->aspect*y[GAP] +
        4.0)*(v->aspect*y[GAP] + 4.0));
        shown[3] += 0.3125*v->initial_turning*(v->aspect + 4.0);
        break;
    case BY_INITIAL_TURNING:
        shown[1] += -y[ORBITAL_MOMENTUM]/((v->initial_turning*v->initial_turning)*(v->aspect +
        4.0)*(v->aspect*y[GAP] + 4.0));
        shown[3] += 0.15625*((v->aspect + 4.0)*(v->aspect + 4.0));
        break;
    case BY_INITIAL_SPIN:
        shown[3] += 1.0;
        break;
    }
}
