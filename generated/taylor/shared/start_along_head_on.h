/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Derivative of the initial state by a group. */
static inline void start_along(const constants *v, int group, vec *after)
{
    (void)v;
    after[GAP] = splat(0.0);
    after[NORMAL_VELOCITY] = splat(0.0);
    (void)group;
}
