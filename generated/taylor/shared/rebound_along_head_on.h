/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Derivative of the state just after a rebound. */
static inline void rebound_along(const constants *v, const vec *y, const vec *t, int group, vec *after)
{
    (void)v;
    (void)y;
    after[GAP] = t[GAP];
    after[NORMAL_VELOCITY] = -v->dry_restitution*t[NORMAL_VELOCITY];
    switch (group) {
    case BY_DRY_RESTITUTION:
        after[NORMAL_VELOCITY] += -y[NORMAL_VELOCITY];
        break;
    }
}
