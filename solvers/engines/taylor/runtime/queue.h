/* Collisions on their way: quantities in, constants and proofs at first touch, lanes filled and emptied, answers out. */

enum { GLASS, ELASTIC, ROUGH, TURNED_KIND, FELL_BACK, FILM_EDGE, TANGENTIAL_EDGE, RESTS, RELEASED, RUPTURE, UNWINDS, HALF_TURN };
enum { STICK, SEPARATES, BOUNCES };
enum { DECIDED, PROVED_AT_TOUCH, NO_BUDGET, NOT_FINITE, CHATTER, TOO_OBLIQUE }; /* CHATTER: no budget, after many phases */
enum { MANY_PHASES = 400, SHOWN = 8 };
static const double SLOW = 0.1; /* of v0: an opening velocity below counts as this for errors, since in a film they die */
static const double SHARP = 2e-13; /* below it nothing tighter can be asked for, and the errors of many steps add up */
static const double REST_SPEED = 1e-9, MOST_OBLIQUE = 1e9, TIGHTEST = 1e-14;

/* Purposes: a whole collision; the approach alone, without the glass criterion and with nothing proved; one that is over
 * when it falls back or rests, and is proved a stick only while it approaches (solvers/boundaries/line.py). */
enum { WHOLE, APPROACH, ESCAPE };

_Static_assert(OUTPUTS <= sizeof(((answer *)0)->shown)/sizeof(double), "all outputs are shown");

/* What is fixed for a flight. */
typedef struct {
    constants c;
    barrier b;
    vec tolerance, rest; /* relative error of a step, and the opening velocity that counts as none */
    vec contact, end, edge;
#if GRADIENTS
    slope_constants slopes;
#if !BACKWARD
    vec one[GROUPS]; /* a derivative's size where its elasticity is one, of a state of one */
#endif
#endif
} fixed;

typedef struct {
    vec y[STATES];
    vec time, smallest, film, shear;
    vec stride; /* the last step */
    mask alive, closing, resting, fresh;
    mask index, steps, phases, reversal, crept; /* crept: steps in a row that only a damped sum could take */
#if GRADIENTS
    carried along;
#endif
} flights;

enum { FIXED = sizeof(fixed)/sizeof(vec), FLIGHT = sizeof(flights)/sizeof(vec) };

typedef struct {
    task *t; /* what was asked; its buffers are as large as they say (solvers/engines/taylor/layout.py) */
    const buffer *columns; /* quantities in SI */
    double rtol;
    answer *answers;
    happening *log; /* `log_room` a collision, whose answer counts those that found none as well */
    long log_room;
#if WITH_LEDGER
    ledger *books; /* one a collision */
#endif
#if WITH_TRAJECTORY
    struct step_row *written; /* `step_room` steps of all collisions; the task counts those that found none as well */
    long step_room;
    double *peaks; /* one a collision; null for none */
#endif
    long count, next;
    int budget;
    long queued, taken; /* collisions that are waiting, of `rows` */
    long waiting[LANES];
    double rows[LANES][FIXED];
    double starts[LANES][STATES];
    int parks, resumes; /* flights that wait for implicit.h, and that come from there */
    double parked[LANES][FIXED + FLIGHT], resumed[LANES][FIXED + FLIGHT];
#if GRADIENTS
    double *by_group, *gradients; /* RESULTS derivatives by each group, by each quantity */
    nearness *near;
    unsigned asked;               /* groups, as bits */
#endif
#if BACKWARD
    struct tape *tape;
#endif
} queue;

#if BACKWARD
static void note_on_tape(const queue *q, int kind, long index, int lane, const vec *y, const fixed *f);
#endif

#if WITH_TRAJECTORY
/* Lanes whose stick may be proved, for the purpose of a flight. */
static mask provable(const queue *q, mask closing)
{
    long purpose = q->t->purpose;
    return purpose == WHOLE ? splat_mask(-1) : purpose == ESCAPE ? closing : splat_mask(0);
}
#endif

/* A quantity of a collision: its own, or the one for all. */
static inline double quantity(const queue *q, int k, long index)
{
    const buffer *column = q->columns + k;
    return ((const double *)column->at)[column->bytes > (int64_t)sizeof(double) ? index : 0];
}

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
    if (a->events < q->log_room)
        q->log[index*q->log_room + a->events] = (happening){kind, time};
    a->events++;
}

/* Tolerances as solvers/engines/casadi/integrators.py has them: near grazing incidence the doublet turns within a tiny part of x0; at
 * very small angles, with nothing that attracts, the doublet is opened by tan^2(theta0) x0/a of v0^2/x0. Returns the
 * lanes that are beyond any tolerance. */
static unsigned set_tolerance(const queue *q, fixed *f)
{
    unsigned beyond = 0;
    double rtol = q->rtol < SHARP ? 0.5*q->rtol : q->rtol;
    f->tolerance = splat(rtol);
    f->rest = splat(SLOW);
#if OBLIQUE
    vec centrifugal = f->c.obliquity*f->c.obliquity*f->c.aspect*(1.0/16.0), net = centrifugal;
#if STRINGS
    net -= f->c.weight*f->c.aspect/f->c.string_ratio;
#endif
    EACH_LANE(lane)
    {
        double of = centrifugal[lane];
        if (!BRIDGE && !STRINGS && of > 0.0 && of < 1e-6)
            f->rest[lane] = pow(10.0, fmax(4.0*floor(log10(of)/4.0) - 3.0, -200.0));
        if (net[lane] > 1.0)
            f->tolerance[lane] = fmax(rtol*pow(10.0, -ceil(log10(net[lane]))), fmin(rtol, TIGHTEST));
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
            EACH_LANE(lane) given[k][lane] = quantity(q, k, first + (lane < many ? lane : 0));
        scale(&f.c, given);
        prepare(&f.c);
#if GRADIENTS
        prepare_slopes(&f.slopes, &f.c);
#if !BACKWARD
        for (int group = 0; group < GROUPS; group++) {
            vec size = vec_abs(((const vec *)&f.c)[group]);
            f.one[group] = DERIVATIVES/choose(size > 0.0, size, splat(1.0));
        }
#endif
#endif
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
#if PROOF_BY_ENERGY
        find_barriers(&f.c, y, f.contact, f.end, &f.b);
        f.b.largest = stored_energy(&f.c, y);
#if ATTRACTS && !CAPILLARY_STATE
        f.b.touch = capillary_work(&f.c, splat(1.0));
#else
        f.b.touch = splat(0.0);
#endif
#endif
        mask all = splat_mask(-1), none = splat_mask(0);
        unsigned proved = bits(proved_sticks(&f.c, y, &f.b, f.contact, all, none, q->rtol)) |
                          bits(held_sticks(&f.c, y, all, q->rtol));
#if WITH_TRAJECTORY
        proved &= bits(provable(q, splat_mask(-1)));
#endif
        for (int lane = 0; lane < many; lane++) {
            if (beyond >> lane & 1) {
                put(q, first + lane, TOO_OBLIQUE, STICK, 0);
                continue;
            }
            if (proved >> lane & 1) {
                put(q, first + lane, PROVED_AT_TOUCH, STICK, 1);
#if WITH_LEDGER
                close_book(q->books + first + lane, &f.c, y, lane);
#endif
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

/* A lane's flight to a row, and back. */
static void pack(double *row, const flights *l, const fixed *f, int lane)
{
    for (int field = 0; field < FIXED; field++)
        row[field] = ((const vec *)f)[field][lane];
    for (int field = 0; field < FLIGHT; field++)
        row[FIXED + field] = ((const vec *)l)[field][lane];
}

static void unpack(const double *row, flights *l, fixed *f, int lane)
{
    for (int field = 0; field < FIXED; field++)
        ((double *)&((vec *)f)[field])[lane] = row[field];
    for (int field = 0; field < FLIGHT; field++)
        ((double *)&((vec *)l)[field])[lane] = row[FIXED + field];
}

static void refill(queue *q, flights *l, fixed *f, int lane);

/* A lane's flight waits for others that creep; it flies on if enough wait. */
static void park(queue *q, flights *l, fixed *f, int lane)
{
    if (q->parks == LANES)
        return;
    pack(q->parked[q->parks++], l, f, lane);
    refill(q, l, f, lane);
}

/* Puts the next collision of the queue into a lane; the lane rests if there is none. */
static void refill(queue *q, flights *l, fixed *f, int lane)
{
    if (q->resumes) {
        unpack(q->resumed[--q->resumes], l, f, lane);
        return;
    }
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
    l->steps[lane] = l->phases[lane] = l->crept[lane] = 0;
    l->reversal[lane] = -1;
#if BACKWARD
    along_start(&l->along, lane);
    note_on_tape(q, BEGUN, l->index[lane], lane, l->y, f);
#elif GRADIENTS
    along_start(&l->along, &f->c, lane);
#endif
}

_Static_assert(MODEL_STATES - OPENING <= sizeof ((answer *)0)->shown/sizeof(double), "shown");

/* What came of a flight. */
static void settle(queue *q, const flights *l, const fixed *f, int lane, int status, int outcome, int certified)
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
    if (status > PROVED_AT_TOUCH) /* handed over: where it has come to */
        for (int state = OPENING; state < MODEL_STATES; state++)
            a->shown[state - OPENING] = l->y[state][lane];
    if (status == DECIDED && outcome != STICK) {
        vec shown[OUTPUTS];
        outputs(&f->c, l->y, shown);
        for (int k = 0; k < OUTPUTS; k++)
            a->shown[k] = shown[k][lane];
#if GRADIENTS
        nearness *near = q->near + l->index[lane];
        near->least = l->along.near[lane];
        near->boundary = l->along.boundary[lane];
        near->hint = l->along.hint[lane];
#if BACKWARD
        note_on_tape(q, ENDED, l->index[lane], lane, l->y, f);
#else
        along_finished(&l->along, &f->c, l->y, lane, (void *)(q->by_group + l->index[lane]*GROUPS*RESULTS));
#endif
#endif
    }
#if WITH_LEDGER
    close_book(q->books + l->index[lane], &f->c, l->y, lane);
#endif
}

/* The flight of a lane is over: what came of it, and the next one. */
static void finish(queue *q, flights *l, fixed *f, int lane, int status, int outcome, int certified)
{
    settle(q, l, f, lane, status, outcome, certified);
    refill(q, l, f, lane);
}

/* Lanes that are proved to stick as they are. */
static mask proved_in_flight(const flights *l, const fixed *f, double tolerance)
{
    return proved_sticks(&f->c, l->y, &f->b, f->contact, l->closing, l->resting, tolerance);
}

/* Where the film acts: a liquid that cavitates does not while it is opened. */
static inline vec acting(const flights *l)
{
#if defined(FILM_CAVITATES)
    return only(l->closing, l->film);
#else
    return l->film;
#endif
}
