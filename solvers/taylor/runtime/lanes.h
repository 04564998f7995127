/* Collisions in lanes: steps of the Taylor series, events by isolation, a finished lane refilled from the queue.
 *
 * The rules are those of solvers/locate.py. What is too rare to be fast is handed over to it, named by a status.
 */

enum { GLASS, ELASTIC, ROUGH, TURNED_KIND, FELL_BACK, FILM_EDGE, TANGENTIAL_EDGE, RESTS, RELEASED, RUPTURE, UNWINDS, HALF_TURN };
enum { STICK, SEPARATES, BOUNCES };
enum { DECIDED, PROVED_AT_TOUCH, NO_BUDGET, NOT_FINITE, CHATTER, TOO_OBLIQUE };
enum { MOST_PHASES = 400, MOST_EVENTS = 64, SHOWN = 8 };
static const double REST_SPEED = 1e-9, MOST_OBLIQUE = 1e9, TIGHTEST = 1e-14;

/* What comes back of a collision. */
typedef struct {
    double shown[4];    /* restitution, tangential restitution, rotation rate, spin: as far as the model has them */
    double time, smallest_gap, turned, final_gap;
    int32_t outcome, certified, status, steps;
    int32_t reversal; /* the first criterion met; -1 for none */
    int32_t events;
} answer;

typedef struct {
    double kind, time;
} happening;

/* What is fixed for a flight. */
typedef struct {
    constants c;
    barrier b;
    vec tolerance, rest; /* relative error of a step, and the opening velocity that counts as none */
    vec contact, end, edge;
} fixed;

typedef struct {
    vec y[STATES];
    vec time, smallest, film, shear;
    mask alive, closing, resting, fresh;
    mask index, steps, phases, reversal;
} flights;

typedef struct {
    const double *const *quantities; /* columns in SI */
    const unsigned char *varies;     /* a column has a value for each collision, or one for all */
    double rtol;
    answer *answers;
    happening *log;
    long count, next;
    int order, budget;
    long queued, taken; /* collisions that are waiting, of `rows` */
    long waiting[LANES];
    double rows[LANES][sizeof(fixed)/sizeof(vec)];
    double starts[LANES][STATES];
} queue;

enum { FIXED = sizeof(fixed)/sizeof(vec) };

static void put(queue *q, long index, int status, int outcome, int certified)
{
    certified = certified && !SURFACE_ARM; /* angular momentum drifts: no theorem */
    answer *a = &q->answers[index];
    a->status = status;
    a->outcome = outcome;
    a->certified = certified;
    a->reversal = -1;
}

static void note(queue *q, long index, int kind, double time)
{
    answer *a = &q->answers[index];
    if (q->log && a->events < MOST_EVENTS)
        q->log[index*MOST_EVENTS + a->events] = (happening){kind, time};
    a->events++;
}

/* Tolerances as solvers/integrators.py has them: near grazing incidence the doublet turns within a tiny part of x0; at
 * very small angles, with nothing that attracts, the doublet is opened by tan^2(theta0) x0/a of v0^2/x0. Returns the
 * lanes that are beyond any tolerance. */
static unsigned set_tolerance(const queue *q, fixed *f)
{
    unsigned beyond = 0;
    f->tolerance = splat(q->rtol);
    f->rest = splat(1e-3);
#if OBLIQUE
    vec centrifugal = f->c.obliquity*f->c.obliquity*f->c.aspect*(1.0/16.0);
    EACH_LANE(lane)
    {
        double of = centrifugal[lane];
        if (!BRIDGE && !STRINGS && of > 0.0 && of < 1e-6)
            f->rest[lane] = pow(10.0, fmax(4.0*floor(log10(of)/4.0) - 3.0, -200.0));
        if (of > 1.0)
            f->tolerance[lane] = fmax(q->rtol*pow(10.0, -ceil(log10(of))), fmin(q->rtol, TIGHTEST));
        if (of > MOST_OBLIQUE)
            beyond |= 1u << lane;
    }
#endif
    return beyond;
}

/* Constants, barrier and start of the next collisions; those proved sticks at first touch never take a lane. */
static void fill_queue(queue *q)
{
    fixed f;
    vec y[STATES];
    q->queued = q->taken = 0;
    while (q->queued == 0 && q->next < q->count) {
        long first = q->next;
        int many = q->count - first < LANES ? (int)(q->count - first) : LANES;
        q->next += many;
        vec given[QUANTITIES];
        for (int k = 0; k < QUANTITIES; k++)
            EACH_LANE(lane) given[k][lane] = q->quantities[k][q->varies[k] ? first + (lane < many ? lane : 0) : 0];
        scale(&f.c, given);
        prepare(&f.c);
        unsigned beyond = set_tolerance(q, &f);
        memset(y, 0, sizeof y);
        start(&f.c, y);
        f.contact = vec_max(f.c.elastic_gap, f.c.rough_gap);
#if BRIDGE
        f.end = f.c.rupture_gap;
#else
        f.end = splat(1.0);
#endif
#if OBLIQUE
        f.edge = tangential_edge(&f.c);
#else
        f.edge = splat(INFINITY);
#endif
        unsigned proved = 0;
#if PROOF_BY_ENERGY
        find_barriers(&f.c, y, f.contact, f.end, &f.b);
        f.b.largest = stored_energy(&f.c, y);
#if BRIDGE && !CAPILLARY_STATE
        f.b.touch = capillary_work(&f.c, splat(1.0));
#else
        f.b.touch = splat(0.0);
#endif
        proved = bits(below_barrier(&f.c, y, &f.b, splat_mask(0), q->rtol));
#elif !OBLIQUE
        proved = bits(stopped_by_film(&f.c, y, f.contact, splat_mask(-1), q->rtol));
#endif
        for (int lane = 0; lane < many; lane++) {
            if (beyond >> lane & 1) {
                put(q, first + lane, TOO_OBLIQUE, STICK, 0);
                continue;
            }
            if (proved >> lane & 1) {
                put(q, first + lane, PROVED_AT_TOUCH, STICK, 1);
                continue;
            }
            q->waiting[q->queued] = first + lane;
            for (int field = 0; field < FIXED; field++)
                q->rows[q->queued][field] = ((vec *)&f)[field][lane];
            for (int state = 0; state < STATES; state++)
                q->starts[q->queued][state] = y[state][lane];
            q->queued++;
        }
    }
}

/* Puts the next collision of the queue into a lane; the lane rests if there is none. */
static void refill(queue *q, flights *l, fixed *f, int lane)
{
    if (q->taken == q->queued)
        fill_queue(q);
    if (q->taken == q->queued) {
        l->alive[lane] = 0;
        return;
    }
    long row = q->taken++;
    for (int field = 0; field < FIXED; field++)
        ((double *)&((vec *)f)[field])[lane] = q->rows[row][field];
    for (int state = 0; state < STATES; state++)
        l->y[state][lane] = q->starts[row][state];
    l->index[lane] = q->waiting[row];
    l->time[lane] = 0.0;
    l->smallest[lane] = 1.0;
    l->film[lane] = 1.0;
    l->shear[lane] = f->edge[lane] >= 1.0;
    l->alive[lane] = l->closing[lane] = l->fresh[lane] = -1;
    l->resting[lane] = 0;
    l->steps[lane] = l->phases[lane] = 0;
    l->reversal[lane] = -1;
}

/* The flight of a lane is over: what came of it, and the next one. */
static void finish(queue *q, flights *l, fixed *f, int lane, int status, int outcome, int certified)
{
    answer *a = &q->answers[l->index[lane]];
    put(q, l->index[lane], status, outcome, certified);
    a->time = l->time[lane];
    a->smallest_gap = l->smallest[lane];
    a->final_gap = l->y[GAP][lane];
    a->steps = l->steps[lane];
    a->reversal = l->reversal[lane];
#if TURNING_STATE
    a->turned = l->y[TURNED][lane];
#elif OBLIQUE && STRINGS
    a->turned = l->y[ROTATION][lane];
#endif
    if (status == DECIDED && outcome != STICK) {
        vec shown[OUTPUTS];
        outputs(&f->c, l->y, shown);
        for (int k = 0; k < OUTPUTS; k++)
            a->shown[k] = shown[k][lane];
    }
    refill(q, l, f, lane);
}

static void separated(queue *q, flights *l, fixed *f, int lane)
{
    note(q, l->index[lane], RUPTURE, l->time[lane]);
    finish(q, l, f, lane, DECIDED, l->reversal[lane] >= 0 ? BOUNCES : SEPARATES, 0);
}

/* The phase that opens from here; from first touch, beyond the film at once. */
static void opens(flights *l, const fixed *f, int lane)
{
    l->closing[lane] = 0;
    l->resting[lane] = 0;
    if (l->y[GAP][lane] == 1.0)
        l->film[lane] = 0.0;
    if (l->y[GAP][lane] == f->edge[lane])
        l->shear[lane] = 0.0;
}

/* Reversal by the solids; a rebound too weak to leave rests, one at first touch without a bridge ruptures. */
static void reverse(queue *q, flights *l, fixed *f, int lane, int kind)
{
    int at_touch = l->time[lane] == 0.0 && l->phases[lane] == 0;
    vec after[STATES];
    memcpy(after, l->y, sizeof after);
    reversal(&f->c, l->y, after);
    l->y[OPENING][lane] = after[OPENING][lane];
    if (l->reversal[lane] < 0)
        l->reversal[lane] = kind;
    l->phases[lane]++;
    l->fresh[lane] = -1;
    note(q, l->index[lane], kind, l->time[lane]);
    if (at_touch && !BRIDGE) {
        separated(q, l, f, lane);
        return;
    }
    double rebound = l->y[OPENING][lane], inward = inward_force(&f->c, l->y)[lane];
    double allowed = q->rtol*l->y[GAP][lane];
    if (inward > 0.0 && (rebound < REST_SPEED || rebound*rebound/(2.0*inward) < allowed)) {
        note(q, l->index[lane], RESTS, l->time[lane]);
        l->y[OPENING][lane] = 0.0;
        l->resting[lane] = -1;
        l->closing[lane] = 0;
        if (!OBLIQUE) /* nothing moves, and the force is inward */
            finish(q, l, f, lane, DECIDED, STICK, 1);
    } else
        opens(l, f, lane);
}

/* A criterion already true where a closing phase starts, by rule: glass, elastic, rough. */
static void criteria_met(queue *q, flights *l, fixed *f)
{
    mask asked = l->fresh & l->alive & l->closing & ~l->resting;
    l->fresh = splat_mask(0);
    if (!bits(asked))
        return;
    unsigned glass = bits(asked & (glass_clearance(&f->c, l->y) <= 0.0));
    unsigned elastic = bits(asked & (l->y[GAP] <= f->c.elastic_gap));
    unsigned rough = bits(asked & (l->y[GAP] <= f->c.rough_gap));
    unsigned any = glass | elastic | rough;
    EACH_LANE(lane)
        if (any >> lane & 1)
            reverse(q, l, f, lane, glass >> lane & 1 ? GLASS : elastic >> lane & 1 ? ELASTIC : ROUGH);
}

/* What an event does to a lane. */
static void act(queue *q, flights *l, fixed *f, int lane, int event)
{
    long index = l->index[lane];
    double now = l->time[lane];
    if (event == GLASS) {
        reverse(q, l, f, lane, GLASS);
        return;
    }
    if (event == ELASTIC) { /* contact: whichever is met first */
        double elastic = f->c.elastic_gap[lane], rough = f->c.rough_gap[lane];
        l->y[GAP][lane] = f->contact[lane];
        reverse(q, l, f, lane, elastic >= rough && elastic > 0.0 ? ELASTIC : ROUGH);
        return;
    }
    if (event == RUPTURE) {
        l->y[GAP][lane] = f->end[lane];
        separated(q, l, f, lane);
        return;
    }
    l->phases[lane]++;
    l->fresh[lane] = -1;
    if (event == TURNED_KIND) {
        note(q, index, l->closing[lane] ? TURNED_KIND : FELL_BACK, now);
        l->y[OPENING][lane] = 0.0;
        l->closing[lane] = ~l->closing[lane];
    } else if (event == FILM_EDGE) {
        note(q, index, FILM_EDGE, now);
        l->y[GAP][lane] = 1.0;
        l->film[lane] = 1.0 - l->film[lane];
        if (f->edge[lane] == 1.0)
            l->shear[lane] = l->film[lane];
    } else if (event == TANGENTIAL_EDGE) {
        note(q, index, TANGENTIAL_EDGE, now);
        l->y[GAP][lane] = f->edge[lane];
        l->shear[lane] = 1.0 - l->shear[lane];
    } else if (event == RELEASED) {
        note(q, index, RELEASED, now);
        opens(l, f, lane);
    } else { /* the experiment's own cut-offs */
        note(q, index, event, now);
        finish(q, l, f, lane, DECIDED, STICK, 0);
    }
}

/* The event functions of a step, each a series that is positive before its event, and the first to fall. */
typedef struct {
    vec time;              /* of the first event, as a part of the step; beyond 1 if there is none */
    mask event;
} first_event;

/* sum of |a_k| h^k, k = 1..order: what a function can change by within the step */
static inline vec reach(const vec *a, vec h, int order)
{
    vec sum = vec_abs(a[order]);
    for (int k = order - 1; k > 0; k--)
        sum = sum*h + vec_abs(a[k]);
    return sum*h;
}

/* A lower bound of |a(t)| with the sign of its start, 0 <= t <= h: its parabola's minimum less what the rest can do. A
 * decay, whose coefficients alternate, is far from zero by this and not by `reach`.
 */
static inline vec least_of(const vec *a, vec h, int order)
{
    mask sign = (mask)a[0] & splat_mask(INT64_MIN);
    vec rest = vec_abs(a[order]);
    for (int k = order - 1; k > 2; k--)
        rest = rest*h + vec_abs(a[k]);
    vec start = vec_abs(a[0]), slope = (vec)((mask)a[1] ^ sign)*h, bend = (vec)((mask)a[2] ^ sign)*h*h;
    vec end = start + slope + bend;
    mask dips = (slope < 0.0) & (-slope < 2.0*bend);
    vec lowest = choose(dips, start - 0.25*slope*slope/choose(dips, bend, splat(1.0)), vec_min(start, end));
    return lowest - rest*h*h*h;
}

static inline vec sum_at(const vec *a, vec t, int order)
{
    vec sum = a[order];
    for (int k = order - 1; k >= 0; k--)
        sum = sum*t + a[k];
    return sum;
}

/* Looks closer at the lanes of `close` for sign (a(t) - target) falling through zero; an earlier event stays.
 *
 * Bernstein coefficients of all lanes at once: all positive, no root, the usual case; one change of sign, one root, found
 * by Newton's iteration within its bracket; more changes, the lane's first root is isolated.
 */
static __attribute__((noinline)) void look(
    first_event *found, mask close, const vec *a, vec target, vec sign, vec h, int order, mask event)
{
    vec g[TERMS + 1], b[TERMS + 1], power = sign;
    for (int k = 0; k <= order; k++) {
        g[k] = a[k]*power;
        power *= h;
    }
    g[0] = sign*(a[0] - target);
    mask zero = g[0] == 0.0; /* a function that starts on its own zero: that root is divided out */
    if (bits(close & zero)) {
        for (int k = 0; k < order; k++)
            g[k] = choose(zero, g[k + 1], g[k]);
        g[order] = choose(zero, splat(0.0), g[order]);
    }
    for (int k = 0; k <= order; k++)
        b[k] = g[k]*INVERSE_BINOMIAL[order][k];
    for (int k = 1; k <= order; k++)
        for (int j = order; j >= k; j--)
            b[j] += b[j - 1];
    mask falls = g[0] <= 0.0, below = b[0] < 0.0, changes = splat_mask(0);
    for (int k = 1; k <= order; k++) {
        mask here = b[k] < 0.0;
        changes += below ^ here; /* masks are -1 */
        below = here;
    }
    vec time = choose(falls, splat(0.0), splat(NO_ROOT));
    mask one = close & ~falls & (changes == -1), many = close & ~falls & (changes < -1);
    if (bits(one)) {
        vec from = b[0], to = b[order], place = splat(0.0); /* the guess: where the control polygon changes sign */
        for (int k = 1; k <= order; k++) {
            mask change = (b[k - 1] >= 0.0) & (b[k] < 0.0);
            from = choose(change, b[k - 1], from);
            to = choose(change, b[k], to);
            place = choose(change, splat(k - 1.0), place);
        }
        vec low = splat(0.0), high = splat(1.0), t = (place + from/(from - to))*(1.0/order);
        mask moves = one; /* a lane that has arrived stays, whatever its neighbours do */
        for (int count = 0; count < 60 && bits(moves); count++) {
            vec value = g[order], slope = splat(0.0);
            for (int k = order - 1; k >= 0; k--) {
                slope = slope*t + value;
                value = value*t + g[k];
            }
            mask before = value > 0.0;
            low = choose(before, t, low);
            high = choose(before, high, t);
            vec newton = t - value/slope;
            mask inside = (newton >= low) & (newton <= high);
            vec next = choose(inside, newton, 0.5*(low + high));
            /* Newton doubles the digits: a step of 1e-9 leaves an error of 1e-17 or so */
            mask arrived = (inside & (vec_abs(next - t) <= 1e-9*next)) | (high - low <= 4e-16*high);
            t = choose(moves, next, t);
            moves &= ~arrived;
        }
        time = choose(one, t, time);
    }
    for (unsigned left = bits(many); left; left &= left - 1) {
        int lane = __builtin_ctz(left);
        double own[TERMS + 1], bernstein[TERMS + 1];
        for (int k = 0; k <= order; k++) {
            own[k] = g[k][lane];
            bernstein[k] = b[k][lane];
        }
        time[lane] = isolated(own, order, bernstein, 0.0, 1.0, 0);
    }
    mask first = close & (time <= 1.0) & (time < found->time);
    found->time = choose(first, time, found->time);
    found->event = (first & event) | (~first & found->event);
}

static void find_events(const series *s, const flights *l, const fixed *f, vec h, int order, first_event *found)
{
    const vec zero = splat(0.0), one = splat(1.0);
    found->time = splat(NO_ROOT);
    found->event = splat_mask(0);
    mask closing = l->closing, moves = l->alive & ~l->resting, close;
    vec away = choose(closing, one, -one); /* the gap's event functions rise with this times the gap */
    if (bits(moves & closing)) {
        close = moves & closing & ~((s->glass.result[0] > 0.0) & (least_of(s->glass.result, h, order) > 0.0));
        if (bits(close))
            look(found, close, s->glass.result, zero, one, h, order, splat_mask(GLASS));
    }
    /* the next gap at which something happens: contact or the film from outside, the film's edge or rupture */
#if BRIDGE
    mask inside = l->film != 0.0, edge = closing ^ inside; /* closing from outside, or opening from inside */
    vec target = choose(edge, one, choose(closing, f->contact, f->end));
    mask event = (edge & splat_mask(FILM_EDGE)) |
                 (~edge & ((closing & splat_mask(ELASTIC)) | (~closing & splat_mask(RUPTURE))));
#else
    vec target = choose(closing, f->contact, f->end);
    mask event = (closing & splat_mask(ELASTIC)) | (~closing & splat_mask(RUPTURE));
#endif
    vec wander = reach(s->gap, h, order);
    close = moves & ~(away*(s->gap[0] - target) > wander);
    if (bits(close))
        look(found, close, s->gap, target, away, h, order, event);
    close = moves & ~(least_of(s->opening, h, order) > 0.0);
    if (bits(close))
        look(found, close, s->opening, zero, -away, h, order, splat_mask(TURNED_KIND));
#if OBLIQUE
    mask own = moves & (f->edge != 1.0) & (f->edge < f->end) & (f->edge > vec_min(f->contact, one));
    close = own & (closing ^ (l->shear != 0.0)) & ~(away*(s->gap[0] - f->edge) > wander);
    if (bits(close))
        look(found, close, s->gap, f->edge, away, h, order, splat_mask(TANGENTIAL_EDGE));
#endif
    close = l->alive & l->resting;
    if (bits(close)) {
        close &= ~(-s->acceleration[0] > reach(s->acceleration, h, order - 1));
        if (bits(close))
            look(found, close, s->acceleration, zero, -one, h, order - 1, splat_mask(RELEASED));
    }
#if OBLIQUE && STRINGS
    close = l->alive & ~(s->rotation[0] + reach(s->rotation, h, order) < M_PI);
    if (bits(close))
        look(found, close, s->rotation, splat(M_PI), -one, h, order, splat_mask(HALF_TURN));
    close = l->alive & ~(s->orbit[0] > reach(s->orbit, h, order));
    if (bits(close))
        look(found, close, s->orbit, zero, one, h, order, splat_mask(UNWINDS));
#endif
}

/* The step whose last two coefficients are below the tolerance (Jorba & Zou 2005, section 3.2).
 *
 * Only to some percent: the bits of a positive double, read as an integer, are nearly its logarithm.
 */
static inline vec step_size(const series *s, const fixed *f, int order)
{
    const vec(*a)[TERMS] = (const void *)s;
    mask last = splat_mask(INT64_MAX), before = splat_mask(INT64_MAX);
    for (int state = 0; state < STATES; state++) {
        vec size = vec_abs(a[state][0]);
        vec scale = state == OPENING ? size + f->rest : state == GAP ? size : size + 1e-3;
        mask own = (mask)scale - (mask)vec_abs(a[state][order]);
        mask other = (mask)scale - (mask)vec_abs(a[state][order - 1]);
        last = least(own, last);
        before = least(other, before);
    }
    const int64_t one = 0x3ff0000000000000;
    vec allowed = __builtin_convertvector((mask)f->tolerance - one, vec);
    vec lower = (allowed + __builtin_convertvector(last, vec))*(1.0/order);
    vec other = (allowed + __builtin_convertvector(before, vec))*(1.0/(order - 1));
    vec power = vec_min(vec_min(lower, other), splat(60.0*4503599627370496.0));
    return (vec)(__builtin_convertvector(power, mask) + one);
}

/* Every k a constant, so that sums have no loop and coefficients stay in registers where they can. */
#define TERM(k) if (order == k) return; coefficients(s, c, film, shear, moving, k);
#define GLASS_TERM(k) if (order < k) return; glass_coefficients(s, c, k);
_Static_assert(TERMS == 17, "EVERY names all orders");
#define EVERY(term) term(1) term(2) term(3) term(4) term(5) term(6) term(7) term(8) term(9) term(10) \
    term(11) term(12) term(13) term(14) term(15)

static __attribute__((noinline)) void expand(series *s, const constants *c, vec film, vec shear, mask moving, int order)
{
    coefficients(s, c, film, shear, moving, 0);
    EVERY(TERM)
}

static __attribute__((noinline)) void expand_glass(series *s, const constants *c, int order)
{
    glass_coefficients(s, c, 0);
    EVERY(GLASS_TERM)
    GLASS_TERM(16)
}

static void fly(queue *q)
{
    flights l;
    fixed f;
    series s;
    memset(&l, 0, sizeof l);
    memset(&s, 0, sizeof s);
    memset(&f, 0, sizeof f);
    int order = q->order;
    EACH_LANE(lane) refill(q, &l, &f, lane);
    if (!bits(l.alive))
        return;
    int sound = __builtin_ctz(bits(l.alive)); /* idle lanes repeat a live one, so that nothing traps or slows */
    EACH_LANE(lane) if (!l.alive[lane]) {
        for (int field = 0; field < FIXED; field++)
            ((vec *)&f)[field][lane] = ((vec *)&f)[field][sound];
        for (int state = 0; state < STATES; state++)
            l.y[state][lane] = l.y[state][sound];
    }
    vec(*a)[TERMS] = (void *)&s;
    unsigned turn = 0;
    while (bits(l.alive)) {
        /* a stick is as good a step later: the level is looked at in every second turn */
        mask sticks = splat_mask(0);
        if (turn++ % 2 == 0) {
#if PROOF_BY_ENERGY
        sticks = below_barrier(&f.c, l.y, &f.b, l.resting, q->rtol);
#elif !OBLIQUE
        sticks = stopped_by_film(&f.c, l.y, f.contact, l.closing, q->rtol);
#endif
        }
        for (unsigned proved = bits(l.alive & sticks); proved; proved &= proved - 1)
            finish(q, &l, &f, __builtin_ctz(proved), DECIDED, STICK, 1);
        if (!bits(l.alive))
            break;
        criteria_met(q, &l, &f);
        if (!bits(l.alive))
            break;
        for (int state = 0; state < STATES; state++)
            a[state][0] = l.y[state];
        expand(&s, &f.c, l.film, l.shear, ~l.resting, order);
        if (bits(l.alive & l.closing))
            expand_glass(&s, &f.c, order);
        vec h = only(l.alive, step_size(&s, &f, order));
        first_event found;
        find_events(&s, &l, &f, h, order, &found);
        mask falls = l.alive & (found.time <= 1.0);
        h = choose(falls, h*found.time, h);
        for (int state = 0; state < STATES; state++)
            l.y[state] = choose(l.alive, sum_at(a[state], h, order), l.y[state]);
        l.time += h;
        l.smallest = vec_min(l.smallest, l.y[GAP]);
        mask lost = l.alive & ~((vec_abs(l.y[GAP]) < INFINITY) & (vec_abs(l.y[OPENING]) < INFINITY));
        for (unsigned event = bits(falls & ~lost); event; event &= event - 1) {
            int lane = __builtin_ctz(event);
            act(q, &l, &f, lane, (int)found.event[lane]);
        }
        l.steps += 1;
        mask spent = l.alive & (lost | (l.steps > q->budget) | (l.phases > MOST_PHASES));
        for (unsigned failed = bits(spent); failed; failed &= failed - 1) {
            int lane = __builtin_ctz(failed);
            int status = lost[lane] ? NOT_FINITE : l.steps[lane] > q->budget ? NO_BUDGET : CHATTER;
            finish(q, &l, &f, lane, status, STICK, 0);
        }
    }
}

/* Collides `count` collisions; answers come zeroed. Returns the size of an answer, so that the caller can check its own idea of it.
 *
 * quantities: a column of each of `quantity_names`; varies: whether it has `count` values or one.
 * log: MOST_EVENTS happenings a collision, or null.
 */
int collide(long count, const double *const *quantities, const unsigned char *varies, double rtol, int order, int budget,
            answer *answers, happening *log)
{
    queue q;
    memset(&q, 0, sizeof q);
    q.quantities = quantities;
    q.varies = varies;
    q.rtol = rtol;
    q.answers = answers;
    q.log = log;
    q.count = count;
    q.order = order < LARGEST_ORDER ? order : LARGEST_ORDER;
    q.budget = budget;
    fly(&q);
    return (int)sizeof(answer);
}
