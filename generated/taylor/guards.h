/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Automaton sha256 74c3db73d2eb50ddc059f841912c1d34d2b981ebebe0f1c5a6d9d8d7681dd77f
 *
 * The search for the events of a step. Included behind what it calls. */

/* The nearest gap ahead at which an event is watched, and that event; of several the first in the table. */
static inline vec next_gap(const lanes *l, const fixed *f, mask *event)
{
#if BRIDGE && !SPREAD
    const mask inside = l->film != 0.0, beyond = NOT(inside);
#else
    const mask inside = splat_mask(TRUTH), beyond = inside;
#endif
    const vec zero = splat(0.0), one = splat(1.0), away = choose(l->closing, one, -one);
    vec gap = away*-HUGE_VAL;
    mask nearer;
    (void)zero; (void)inside; (void)beyond;
    *event = splat_mask(0);
    nearer = l->closing & (f->contact > gap);
    gap = choose(nearer, f->contact, gap);
    *event = choose_whole(nearer, splat_mask(AT_CONTACT), *event);
    nearer = NOT(l->closing) & beyond & (f->end < gap);
    gap = choose(nearer, f->end, gap);
    *event = choose_whole(nearer, splat_mask(AT_RUPTURE), *event);
#if BRIDGE && !SPREAD
    nearer = (l->closing ^ (l->film != 0.0)) & (away*(one - gap) > 0.0);
    gap = choose(nearer, one, gap);
    *event = choose_whole(nearer, splat_mask(AT_FILM_EDGE), *event);
#endif
#if OBLIQUE
    nearer = (l->closing ^ (l->shear != 0.0)) & (away*(f->edge - gap) > 0.0) & (f->edge != 1.0) & (f->edge <
        f->end) & (f->edge > vec_min(f->contact, one));
    gap = choose(nearer, f->edge, gap);
    *event = choose_whole(nearer, splat_mask(AT_TANGENTIAL_EDGE), *event);
#endif
    return gap;
}

/* The first event of a step in each lane; of coincident ones the first in the table. The turn comes first: up
 * to there the gap is monotonic, and extremal at the end. Under a constant force steps are unlimited, and all
 * events before the turn lie in a tiny part of the step. */
static first_event find_events(const series *s, const lanes *l, const fixed *f, vec h)
{
#if BRIDGE && !SPREAD
    const mask inside = l->film != 0.0, beyond = NOT(inside);
#else
    const mask inside = splat_mask(TRUTH), beyond = inside;
#endif
    const vec zero = splat(0.0), one = splat(1.0), away = choose(l->closing, one, -one);
    const mask moves = l->alive & NOT(l->resting), rests = l->alive & l->resting;
    (void)zero; (void)moves; (void)rests; (void)inside; (void)beyond;
    first_event first;
    first.time = splat(NO_ROOT);
    first.event = splat_mask(0);
    vec part = one;
    mask close, event;
    vec gap = next_gap(l, f, &event);
    close = moves;
    if (bits(close))
        close &= NOT(least_of(s->normal_velocity, h) > 0.0);
    if (bits(close))
        look(&first, close, s->normal_velocity, zero, -away, h, splat_mask(AT_TURNING));
    part = up_to_turn(&first);
    h *= part;
    first.gap = sum_at(s->gap, h);
    close = moves & l->closing;
    if (bits(close))
        close &= NOT((s->glass.result[0] > 0.0) & (least_of(s->glass.result, h) > 0.0));
    if (bits(close))
        look(&first, close, s->glass.result, zero, one, h, splat_mask(AT_GLASS));
    close = moves & NOT(away*(first.gap - gap) > 0.0);
    if (bits(close))
        look(&first, close, s->gap, gap, away, h, event);
#if OBLIQUE && !WALL
    close = rests & DRIVEN(l->shear);
    if (bits(close))
        close &= NOT(-s->acceleration[0] > reach(s->acceleration, h));
    if (bits(close))
        look(&first, close, s->acceleration, zero, -one, h, splat_mask(AT_RELEASE));
#endif
#if OBLIQUE && STRINGS
    close = l->alive;
    if (bits(close))
        close &= NOT(splat(PI) - s->rotation[0] > reach(s->rotation, h));
    if (bits(close))
        look(&first, close, s->rotation, splat(PI), -one, h, splat_mask(AT_HALF_TURN));
#endif
#if OBLIQUE && STRINGS
    close = l->alive;
    if (bits(close))
        close &= NOT(s->orbital_momentum[0] > reach(s->orbital_momentum, h));
    if (bits(close))
        look(&first, close, s->orbital_momentum, zero, one, h, splat_mask(AT_UNWINDING));
#endif
#if OWN_EVENTS
    find_own_events(s, l, f, h, &first);
#endif /* OWN_EVENTS */
    first.time *= part;
    return first;
}

#if ROLLS
/* The same in resting contact with friction; an earlier event is kept. */
OUTLINE void find_events_at_rest(const rubbing *r, const lanes *l, vec h, first_event *first)
{
    const vec zero = splat(0.0), one = splat(1.0);
    const mask rests = l->alive & l->resting;
    mask close;
    close = rests & (l->rolling == 0.0) & (l->sliding != 0.0);
    if (bits(close))
        close &= NOT(least_of(r->rest_slip, h) > 0.0);
    if (bits(close))
        look(first, close, r->rest_slip, only(l->sliding*r->rest_slip[0] < NO_SLIP, -NO_SLIP*l->sliding),
        l->sliding, h, splat_mask(AT_SLIPPING));
    close = rests & (l->rolling != 0.0);
    if (bits(close))
        close &= NOT((r->rest_grip_backward[0] > 0.0) & (least_of(r->rest_grip_backward, h) > 0.0));
    if (bits(close))
        look(first, close, r->rest_grip_backward, zero, one, h, splat_mask(AT_ROLLING));
    close = rests & (l->rolling != 0.0);
    if (bits(close))
        close &= NOT((r->rest_grip_forward[0] > 0.0) & (least_of(r->rest_grip_forward, h) > 0.0));
    if (bits(close))
        look(first, close, r->rest_grip_forward, zero, one, h, splat_mask(AT_ROLLING));
}
#endif

/* Lanes in which no event lies between two states, as far as shows: each guard keeps half its value. Turns
 * and resting contact with friction are left to the caller. */
static mask guards_kept(const lanes *l, const fixed *f, const vec *from, const vec *to)
{
#if BRIDGE && !SPREAD
    const mask inside = l->film != 0.0, beyond = NOT(inside);
#else
    const mask inside = splat_mask(TRUTH), beyond = inside;
#endif
    const vec zero = splat(0.0), one = splat(1.0), away = choose(l->closing, one, -one);
    const mask moves = NOT(l->resting), rests = l->resting;
    (void)zero; (void)moves; (void)rests; (void)inside; (void)beyond;
    mask event, far;
    vec gap = next_gap(l, f, &event);
    mask kept = rests | (2.0*away*(to[GAP] - gap) > away*(from[GAP] - gap));
    far = 2.0*(glass_clearance(&f->c, to)) > vec_max(glass_clearance(&f->c, from), zero);
    kept &= NOT(moves & l->closing) | far;
#if OBLIQUE && !WALL
    far = 2.0*(inward_force(&f->c, to)) > vec_max(inward_force(&f->c, from), zero);
    kept &= NOT(rests & DRIVEN(l->shear)) | far;
#endif
#if OBLIQUE && STRINGS
    far = 2.0*(splat(PI) - to[ROTATION]) > vec_max(splat(PI) - from[ROTATION], zero);
    kept &= far;
#endif
#if OBLIQUE && STRINGS
    far = 2.0*(to[ORBITAL_MOMENTUM]) > vec_max(from[ORBITAL_MOMENTUM], zero);
    kept &= far;
#endif
    return kept;
}

#if GRADIENTS
/* Gaps of events that move with a group, and their events. */
enum { GAP_OF_CONTACT, GAP_OF_RUPTURE, GAP_OF_TANGENTIAL_EDGE, MOVING_GAPS };
static const int EVENT_AT[MOVING_GAPS] = {AT_CONTACT, AT_RUPTURE, AT_TANGENTIAL_EDGE};

/* Derivative of such a gap by a group. */
static inline vec moving_gap_along(const fixed *f, int which, int group)
{
    (void)f; (void)group;
    switch (which) {
    case GAP_OF_CONTACT:
        return choose(contact_moves_with(&f->c, group), splat(1.0), splat(0.0));
#if BRIDGE
    case GAP_OF_RUPTURE:
        return group == BY_RUPTURE_GAP ? splat(1.0) : splat(0.0);
#endif
#if OBLIQUE
    case GAP_OF_TANGENTIAL_EDGE:
        return tangential_edge_along(&f->c, group);
#endif
    default:
        return splat(0.0);
    }
}

static inline mask is_on_gap(mask event)
{
    return (event == AT_CONTACT) | (event == AT_RUPTURE) | (event == AT_FILM_EDGE) | (event ==
        AT_TANGENTIAL_EDGE);
}

static inline mask is_on_normal_velocity(mask event)
{
    return (event == AT_TURNING);
}

static inline mask is_on_glass_clearance(mask event)
{
    return (event == AT_GLASS);
}
#endif
