/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`. */
/* Energy lost in a rebound that starts from this state, over m v0^2. */
static inline vec rebound_loss(const constants *c, const vec *y)
{
    (void)c; (void)y;
    vec normal_velocity_squared = y[NORMAL_VELOCITY]*y[NORMAL_VELOCITY];
    vec dry_contact = c->ledger.dry_contact_per_normal_velocity_squared*normal_velocity_squared;
    return dry_contact;
}
