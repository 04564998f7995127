/* The driver: series, step, first event, what it does; all lanes at once until the queue is empty.
 *
 * What is too rare to be fast is handed over to solvers/engines/casadi/locate.py, named by a status.
 */

/* The bits of a positive double, read as an integer, are nearly its logarithm: lengths only to some percent. */
static const int64_t ONE = 0x3ff0000000000000;

static inline vec power_of(vec logarithm)
{
    logarithm = vec_min(logarithm, splat(60.0*4503599627370496.0));
    return (vec)(__builtin_convertvector(logarithm, mask) + ONE);
}

/* What a share of coefficient k may still grow by in the state that allows least, as a logarithm. */
static inline mask room_of(const mask *scale, const vec (*a)[TERMS], int k, double share, mask least_room)
{
    for (int state = 0; state < STATES; state++)
        least_room = least(scale[state] - (mask)vec_abs(share*a[state][k]), least_room);
    return least_room;
}

#if GRADIENTS && !BACKWARD
#define ALONG , const tangents *along
static inline vec room(const mask *scale, const vec (*a)[TERMS], int k, double share ALONG)
{
    mask found = room_of(scale, a, k, share, splat_mask(INT64_MAX));
    for (unsigned left = along->asked; left; left &= left - 1) {
        int group = __builtin_ctz(left);
        found = room_of(along->scale[group], (const void *)along->t[group], k, share, found);
    }
    return __builtin_convertvector(found, vec);
}
#define ROOM(k, share) room(scale, a, k, share, along)
#else
#define ALONG
#define ROOM(k, share) __builtin_convertvector(room_of(scale, a, k, share, splat_mask(INT64_MAX)), vec)
#endif

/* The step whose last two coefficients are below the tolerance (Jorba & Zou 2005, section 3.2); lanes that a decaying
 * mode holds to it are in `creeps`, and take the step of the damped sum. */
static inline vec step_size(const series *s, const fixed *f, mask *creeps ALONG)
{
    const vec(*a)[TERMS] = (const void *)s;
    mask scale[STATES];
    for (int state = 0; state < STATES; state++) {
        vec size = vec_abs(a[state][0]);
        scale[state] = (mask)(state == OPENING ? size + f->rest : state == GAP ? size : size + 1e-3);
    }
    vec allowed = __builtin_convertvector((mask)f->tolerance - ONE, vec);
    vec last = ROOM(ORDER, 1.0), before = ROOM(ORDER - 1, 1.0);
    vec step = vec_min((allowed + last)*(1.0/ORDER), (allowed + before)*(1.0/(ORDER - 1)));
    /* of a mode exp(-z), z is the order times the last term over the one before */
    *creeps = step + before - last > log2(STIFF_FROM/ORDER)*4503599627370496.0;
    if (bits(*creeps)) {
        vec damped = splat(INFINITY);
        for (int k = EXACT + 1; k <= ORDER; k++) {
            vec own = ROOM(k, STRICTER*(1.0 - damping(k)));
            damped = vec_min(damped, (allowed + own)*(1.0/k));
        }
        step = choose(*creeps, damped, step);
    }
    return power_of(step);
}

#define TERM(k) if (k < ORDER) coefficients(s, c, film, shear, moving, k);
#define GLASS_TERM(k) if (k <= ORDER) glass_coefficients(s, c, k);

static __attribute__((noinline)) void expand(series *s, const constants *c, vec film, vec shear, mask moving)
{
    EVERY(TERM)
    s->acceleration[ORDER] = splat(0.0); /* known to one order less */
}

static __attribute__((noinline)) void expand_glass(series *s, const constants *c)
{
    EVERY(GLASS_TERM)
}

static void fly(queue *q)
{
    flights l;
    fixed f;
    series s;
#if GRADIENTS && !BACKWARD
    slopes d;
    tangents t;
    memset(&d, 0, sizeof d);
    memset(&t, 0, sizeof t);
#endif
    memset(&l, 0, sizeof l);
    memset(&s, 0, sizeof s);
    memset(&f, 0, sizeof f);
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
    for (;;) {
        if (q->parks && (q->parks == LANES || !bits(l.alive))) {
            crawl(q);
            EACH_LANE(lane) if (!l.alive[lane]) refill(q, &l, &f, lane);
        }
        if (!bits(l.alive))
            break;
        /* a stick is as good a step later: the level is looked at in every second turn */
        mask sticks = held_sticks(&f.c, l.y, l.alive & now_and_then(l.fresh, l.phases, l.steps), q->rtol);
        if (turn++ % 2 == 0)
            sticks |= proved_in_flight(&l, &f, q->rtol);
#if WITH_TRAJECTORY
        sticks &= provable(q, l.closing);
#endif
        for (unsigned proved = bits(l.alive & sticks); proved; proved &= proved - 1)
            finish(q, &l, &f, __builtin_ctz(proved), DECIDED, STICK, 1);
        criteria_met(q, &l, &f);
        if (!bits(l.alive))
            continue;
        for (int state = 0; state < STATES; state++)
            a[state][0] = l.y[state];
        expand(&s, &f.c, acting(&l), l.shear, ~l.resting);
        mask creeps;
#if GRADIENTS && !BACKWARD
        if (q->asked)
            expand_slopes(&d, &f.slopes, &s, &f.c, acting(&l), l.shear, q->asked);
        expand_along(&t, &l, &f, &s, &d, q->asked);
        vec h = only(l.alive, step_size(&s, &f, &creeps, &t));
        for (unsigned left = bits(creeps) ? t.asked : 0; left; left &= left - 1)
            damp(t.t[__builtin_ctz(left)], creeps);
#else
        vec h = only(l.alive, step_size(&s, &f, &creeps));
#endif
#if BACKWARD
        h = held_for_derivatives(&l, &f, &s, h, creeps);
#endif
        if (bits(creeps))
            damp(a, creeps);
        if (bits(l.alive & l.closing))
            expand_glass(&s, &f.c);
#if WITH_TRAJECTORY
        if (q->t->purpose == APPROACH) { /* no glass criterion */
            memset(s.glass.result, 0, sizeof s.glass.result);
            s.glass.result[0] = splat(1.0);
        }
#endif
        first_event found;
        find_events(&s, &l, &f, h, &found);
        mask falls = l.alive & (found.time <= 1.0);
        h = choose(falls, h*found.time, h);
#if GRADIENTS
        measure(&l, &f, &s, h, falls, found.event);
#endif
#if BACKWARD
        keep_on_tape(q, &l, h, creeps, falls, found.event);
#elif GRADIENTS
        if (q->asked)
            carry(&l, &f, &s, &t, h, falls, found.event, q->asked);
#endif
#if WITH_TRAJECTORY
        keep_steps(q, &l, a, h);
#if GLASS_REACH
        if (q->peaks)
            note_peaks(q, &l, &f, &s, h);
#endif
#endif
        if (bits(falls))
            found.gap = sum_at(a[GAP], h);
        l.y[GAP] = choose(l.alive, found.gap, l.y[GAP]);
        for (int state = GAP + 1; state < STATES; state++)
            l.y[state] = choose(l.alive, sum_at(a[state], h), l.y[state]);
        l.time += h;
        l.smallest = vec_min(l.smallest, l.y[GAP]);
        mask lost = l.alive & ~((vec_abs(l.y[GAP]) < INFINITY) & (vec_abs(l.y[OPENING]) < INFINITY));
        for (unsigned event = bits(falls & ~lost); event; event &= event - 1) {
            int lane = __builtin_ctz(event);
#if WITH_TRAJECTORY
            act_for_purpose(q, &l, &f, lane, (int)found.event[lane]);
#else
            act(q, &l, &f, lane, (int)found.event[lane]);
#endif
        }
        l.steps += 1;
        l.crept = (l.crept + 1) & creeps;
        l.stride = h;
        mask spent = l.alive & (lost | (l.steps > q->budget));
        unsigned slow_ones = bits(l.alive & ~falls & ~spent & (l.crept > PATIENCE));
#if BACKWARD
        spent |= only_if_full(q, l.alive);
        slow_ones = 0;
#elif GRADIENTS
        slow_ones = q->asked ? 0 : slow_ones; /* implicit.h knows nothing of derivatives */
#endif
#if WITH_TRAJECTORY
        /* only a series makes a row, and implicit.h knows no purpose */
        slow_ones = q->step_room || q->t->purpose != WHOLE ? 0 : slow_ones;
#endif
        for (; slow_ones; slow_ones &= slow_ones - 1)
            park(q, &l, &f, __builtin_ctz(slow_ones));
        for (unsigned failed = bits(spent); failed; failed &= failed - 1) {
            int lane = __builtin_ctz(failed);
            int status = lost[lane] ? NOT_FINITE : l.phases[lane] > CHATTER_PHASES ? CHATTER : NO_BUDGET;
            finish(q, &l, &f, lane, status, STICK, 0);
        }
    }
}

/* Whether a buffer has room for so many rows. */
static int holds(buffer b, int64_t rows, size_t row)
{
    return rows <= b.bytes/(int64_t)row;
}

/* The buffer of a task that is smaller than what is read from it or written to it; null if none is. */
static const char *misfit(const task *t)
{
    if (!holds(t->quantities, QUANTITIES, sizeof(buffer)))
        return "quantities: too small";
    for (int k = 0; k < QUANTITIES; k++) {
        const buffer *column = (const buffer *)t->quantities.at + k;
        if (column->bytes != sizeof(double) && !holds(*column, t->count, sizeof(double)))
            return "a quantity: too small";
    }
    if (!holds(t->answers, t->count, sizeof(answer)))
        return "answers: too small";
#if WITH_LEDGER
    if (!holds(t->books, t->count, sizeof(ledger)))
        return "books: too small";
#endif
#if WITH_TRAJECTORY
    if (t->peaks.bytes && !holds(t->peaks, t->count, sizeof(double)))
        return "peaks: too small";
#endif
#if GRADIENTS
    if (!holds(t->by_group, t->count, GROUPS*RESULTS*sizeof(double)))
        return "by_group: too small";
    if (!holds(t->gradients, t->count, QUANTITIES*RESULTS*sizeof(double)))
        return "gradients: too small";
    if (!holds(t->near, t->count, sizeof(nearness)))
        return "near: too small";
#endif
    return 0;
}

#if GRADIENTS
#if PROOF_BY_ENERGY
const int proved_by_energy = 1;
#else
const int proved_by_energy = 0;
#endif
#endif

/* Collides `count` collisions, with derivatives by the quantities if the kernel has them; what it writes to comes zeroed.
 * Returns null, or why nothing was done.
 */
const char *collide(task *t)
{
    const char *why = misfit(t);
    if (why || t->count < 1)
        return why;
    queue q;
    memset(&q, 0, sizeof q);
    q.t = t;
    q.columns = t->quantities.at;
    q.rtol = t->rtol;
    q.answers = t->answers.at;
    q.count = t->count;
    q.budget = (int)t->budget;
    q.log = t->log.at;
    q.log_room = t->log.bytes/(t->count*(long)sizeof(happening));
#if WITH_LEDGER
    q.books = t->books.at;
#endif
#if WITH_TRAJECTORY
    q.written = t->rows.at;
    q.peaks = t->peaks.bytes ? t->peaks.at : 0;
    q.step_room = t->rows.bytes/(long)sizeof(step_row);
#endif
#if GRADIENTS
    q.asked = (unsigned)t->asked;
    q.by_group = t->by_group.at;
    q.gradients = t->gradients.at;
    q.near = t->near.at;
#endif
#if BACKWARD
    if (!there_and_back(&q))
        return "no memory for its tape";
#else
    fly(&q);
#if GRADIENTS
    in_quantities(&q, 0);
#endif
#endif
    return 0;
}
