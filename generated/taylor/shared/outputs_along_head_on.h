/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Derivative of the results for a separated doublet. */
static inline void outputs_along(const constants *v, const vec *y, const vec *t, int group, vec *shown)
{
    (void)v;
    (void)y;
    shown[0] = t[NORMAL_VELOCITY];
    (void)group;
}
