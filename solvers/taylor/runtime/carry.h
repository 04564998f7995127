/* Derivatives over a step: matrix and sources once, a linear recurrence for each direction, the saltation at an event. */

#define TANGENT_TERM(k) if (k < ORDER) tangent_coefficients(t, d, c, s, v, film, shear, source, k);

static __attribute__((noinline)) void expand_tangent(vec (*t)[TERMS], const slopes *d, const slope_constants *c,
    const series *s, const constants *v, vec film, vec shear, const vec *const *source)
{
    EVERY(TANGENT_TERM)
}

static const vec NOTHING[TERMS];

/* The derivatives' series, and what each coefficient is measured by: its own size, and what the state would change by if
 * its elasticity were one. A mode that decays fast may be gone from the states and not from these: they share the step. */
static void expand_along(tangents *all, const flights *l, const fixed *f, const series *s, const slopes *d, unsigned asked)
{
    vec own[STATES];
    for (int state = 0; state < STATES; state++)
        own[state] = vec_abs(l->y[state]) + (state == OPENING ? f->rest : state == GAP ? splat(0.0) : splat(1e-3));
    all->asked = 0;
    for (int group = 0; group < GROUPS; group++) {
        if (!(asked >> group & 1) || !bits(l->along.there[group] & l->alive))
            continue;
        all->asked |= 1u << group;
        const vec *source[STATES];
        vec(*t)[TERMS] = all->t[group];
        for (int state = 0; state < STATES; state++) {
            source[state] = NOTHING;
            t[state][0] = l->along.t[group][state];
            all->scale[group][state] = (mask)(DERIVATIVES*vec_abs(t[state][0]) + f->one[group]*own[state]);
        }
        sources(d, s, group, source);
        expand_tangent(t, d, &f->slopes, s, &f->c, acting(l), l->shear, source);
    }
}

/* What an event asks of the states: its function's derivatives by the states, along the flight, and by the groups. */
typedef struct {
    mask gap, turned, glass;   /* lanes by what is zero */
    mask contact, end, edge;   /* of those at a gap, which one */
    vec rate[STATES];          /* of the states as the event is met */
    vec by_gap, by_approach;   /* of the glass criterion */
    vec pace;                  /* of the event's function along the flight */
    vec at[STATES];            /* the states as it is met */
} meeting;

static meeting met(const flights *l, const fixed *f, const vec (*a)[TERMS], vec h, mask falls, mask event)
{
    meeting m;
    memset(&m, 0, sizeof m);
    for (int state = 0; state < STATES; state++) {
        vec rate = ORDER*a[state][ORDER];
        for (int k = ORDER - 1; k > 0; k--)
            rate = rate*h + k*a[state][k];
        m.rate[state] = rate;
        m.at[state] = sum_at(a[state], h);
    }
    m.contact = falls & (event == ELASTIC);
    m.end = falls & (event == RUPTURE);
    m.edge = falls & (event == TANGENTIAL_EDGE);
    m.gap = m.contact | m.end | m.edge | (falls & (event == FILM_EDGE));
    m.turned = falls & (event == TURNED_KIND);
    m.glass = falls & (event == GLASS);
    vec limit;
    glass_pressure_margin_slopes(
        m.at[GAP], -m.at[OPENING], f->c.glass_number, &m.by_gap, &m.by_approach, &limit);
    m.pace = choose(m.gap, m.rate[GAP], choose(m.turned, m.rate[OPENING],
        m.by_gap*m.rate[GAP] - m.by_approach*m.rate[OPENING]));
    (void)l;
    return m;
}

/* The gap at which an event lies, in a direction. */
static inline vec target_along(const fixed *f, const meeting *m, int group)
{
    vec zero = splat(0.0), one = splat(1.0), moved = zero;
    mask elastic = f->c.elastic_gap >= f->c.rough_gap;
    if (group == BY_ELASTIC_GAP)
        moved = choose(m->contact & elastic, one, zero);
    if (group == BY_ROUGH_GAP)
        moved = choose(m->contact & ~elastic, one, zero);
#if BRIDGE
    if (group == BY_RUPTURE_GAP)
        moved = choose(m->end, one, zero);
#endif
#if OBLIQUE
    if (bits(m->edge))
        moved = choose(m->edge, tangential_edge_along(&f->c, group), moved);
#endif
    return moved;
}

/* The derivatives at the end of a step, on the surface of the event that ends it. */
static void carry(flights *l, const fixed *f, const series *s, const tangents *all, vec h, mask falls, mask event,
    unsigned asked)
{
    carried *a = &l->along;
    meeting m;
    falls &= h > 0.0; /* what is true on entry jumps where it is: no surface is met */
    int meets = bits(falls) != 0;
    if (meets)
        m = met(l, f, (const void *)s, h, falls, event);
    for (int group = 0; group < GROUPS; group++) {
        if (!(asked >> group & 1))
            continue;
        if (all->asked >> group & 1)
            for (int state = 0; state < STATES; state++)
                a->t[group][state] = choose(l->alive, sum_at(all->t[group][state], h), a->t[group][state]);
        if (!meets)
            continue;
        vec *here = a->t[group], target = target_along(f, &m, group);
        vec value = choose(m.gap, here[GAP] - target, choose(m.turned, here[OPENING],
            m.by_gap*here[GAP] - m.by_approach*here[OPENING]));
        if (group == BY_GLASS_NUMBER)
            value += only(m.glass, splat(1.0));
        vec later = only(falls, -value/choose(falls, m.pace, splat(1.0)));
        for (int state = 0; state < STATES; state++)
            here[state] += only(falls, m.rate[state]*later);
        here[GAP] = choose(m.gap, target, here[GAP]);
        here[OPENING] = only(~m.turned, here[OPENING]);
        a->time[group] += later;
        a->there[group] |= falls & (later != 0.0);
        a->smallest[group] = choose(falls & (m.at[GAP] < a->least), here[GAP], a->smallest[group]);
    }
    if (meets)
        a->least = choose(falls & (m.at[GAP] < a->least), m.at[GAP], a->least);
}

/* From derivatives by groups to derivatives by quantities in SI, for as many collisions at once as there are lanes. */
static void in_quantities(const queue *q)
{
    fixed f;
    for (long first = 0; first < q->count; first += LANES) {
        int many = q->count - first < LANES ? (int)(q->count - first) : LANES;
        vec given[QUANTITIES], slope[GROUPS];
        for (int k = 0; k < QUANTITIES; k++)
            EACH_LANE(lane) given[k][lane] = q->quantities[k][q->varies[k] ? first + (lane < many ? lane : 0) : 0];
        scale(&f.c, given);
        for (int k = 0; k < QUANTITIES; k++) {
            scale_along(&f.c, given, k, slope);
            for (int lane = 0; lane < many; lane++) {
                double *into = q->gradients + ((first + lane)*QUANTITIES + k)*RESULTS;
                const double(*rows)[RESULTS] = (const void *)(q->by_group + (first + lane)*GROUPS*RESULTS);
                for (int result = 0; result < RESULTS; result++)
                    into[result] = 0.0;
                for (int group = 0; group < GROUPS; group++) {
                    double factor = slope[group][lane];
                    if (factor != 0.0)
                        for (int result = 0; result < RESULTS; result++)
                            into[result] += factor*rows[group][result];
                }
            }
        }
    }
}
