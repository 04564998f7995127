/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Automaton sha256 74c3db73d2eb50ddc059f841912c1d34d2b981ebebe0f1c5a6d9d8d7681dd77f
 *
 * Rebound criteria that are met at a gap. Included where `constants` is known. */

/* The gap at which the solids meet: the largest at which a criterion is met. */
static inline vec contact_gap(const constants *c)
{
    return vec_max(c->elastic_gap, c->rough_gap);
}

/* What is reported of contact: the first whose gap is largest and positive, else the last. */
static inline int contact_kind(const constants *c, int lane)
{
    double contact = in_lane(contact_gap(c), lane);
    if (LANE(c->elastic_gap, lane) == contact && contact > 0.0)
        return KIND_ELASTIC;
    return KIND_ROUGH;
}

/* The first criterion that holds at a gap where one does. */
static inline int kind_at_gap(const constants *c, double gap, int lane)
{
    if (gap <= LANE(c->elastic_gap, lane))
        return KIND_ELASTIC;
    return KIND_ROUGH;
}

/* The second largest of the gaps; 0 if there is none. */
static inline double second_gap(const constants *c, int lane)
{
    double gaps[] = {LANE(c->elastic_gap, lane), LANE(c->rough_gap, lane)};
    double largest = 0.0, second = 0.0;
    for (int k = 0; k < 2; k++)
        if (gaps[k] > largest) {
            second = largest;
            largest = gaps[k];
        } else if (gaps[k] > second)
            second = gaps[k];
    return second;
}

#if GRADIENTS
/* Lanes whose contact gap is this group. */
static inline mask contact_moves_with(const constants *c, int group)
{
    vec contact = contact_gap(c);
    mask before = splat_mask(0);
    if (group == BY_ELASTIC_GAP)
        return (c->elastic_gap == contact) & NOT(before);
    before |= c->elastic_gap == contact;
    return group == BY_ROUGH_GAP ? NOT(before) : splat_mask(0);
}
#endif
