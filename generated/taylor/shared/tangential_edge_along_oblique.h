/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Derivative of the gap beyond which there is no tangential force. */
static inline vec tangential_edge_along(const constants *v, int group)
{
    (void)v;
    switch (group) {
    case BY_ASPECT:
        return shear_edge_by_aspect(v->aspect);
    default:
        return splat(0.0);
    }
}
