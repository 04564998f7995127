/* One proof: the set of all trajectories from a box of inputs, step by step through its events up to the outcome. */
#include "step.h"

/* The criteria that are met at initial contact. Of a box of which a part meets the glass criterion, the approach is bounded
 * with rebounds from there on. */
static int begin(proof *w, const options *o)
{
    iv x[STATES];
    hull_of(&w->p, &w->s, x);
    expand(&w->box, &w->p.box, x, 0, 0);
    advance_clearance(&w->box, &w->p.box, 0);
    const iv clearance = w->box.clearance.v[0], contact = w->p.level[CONTACT_GAP].v;
    const int glass = iv_hi(clearance) <= 0.0, touches = iv_lo(contact) >= 1.0;
    if (!glass && !touches) {
        if (iv_positive(clearance) && iv_hi(contact) < 1.0)
            return 1;
        end(w, UNPROVED, START);
        if (o->funnels > 1)
            (void)approach(w, o);
        return 0;
    }
    const iv edge = w->p.level[TANGENTIAL_EDGE].v;
    if (OBLIQUE && iv_lo(edge) < 1.0 && iv_hi(edge) > 1.0) /* whether friction acts there is open */
        return end(w, UNPROVED, START);
    if (!bounce(w, glass ? AT_GLASS : AT_CONTACT))
        return 0;
    hull_of(&w->p, &w->s, x);
    if (iv_hi(w->p.level[RUPTURE_GAP].v) <= 1.0)
        return separate(w, x[NORMAL_VELOCITY]);
    set_region(w, 0, w->here.shear);
    return 1;
}

static void prove(proof *w, const options *o)
{
    int since = 1 << 20, wait = 3;
    double slow = 0.2; /* approach at which a turn is looked for */
    if (!begin(w, o) || (o->funnels > 1 && !w->rebounds && approach(w, o)))
        return;
    while (w->steps < o->most_steps) {
        iv x[STATES];
        double width = 0.0;
        if (PARAMETERS && w->rebounds) /* before, bounds over the gap are sharper */
            straighten(w);
        hull_of(&w->p, &w->s, x);
        for (int i = 0; i < STATES; i++) {
            width = larger(width, iv_width(x[i]));
            if (!(iv_width(x[i]) < o->widest)) {
                end(w, UNPROVED, TOO_WIDE);
                return;
            }
        }
        if (!w->wall.known && (w->rebounds || iv_lo(x[NORMAL_VELOCITY]) > -0.1))
            find_barrier(&w->p, &w->rest, &w->wall);
        if (w->wall.known &&
            (below_barrier(&w->p, &w->wall, &w->s) || below_rise(&w->p, &w->rest, x) || stopped(w, x))) {
            end(w, STICK, PROVED);
            return;
        }
        if (PARAMETERS && o->funnels && o->expected != STICK && !w->rebounds && iv_lo(x[NORMAL_VELOCITY]) < 0.0 &&
            -iv_lo(x[NORMAL_VELOCITY]) < slow && in_shear(w)) {
            slow = -0.7*iv_lo(x[NORMAL_VELOCITY]);
            if (turns_apart(w, x, o->panel))
                return;
        }
        if (o->funnels && o->expected != STICK && ++since > wait && iv_positive(x[NORMAL_VELOCITY]) &&
            iv_hi(x[GAP]) < iv_lo(w->p.level[RUPTURE_GAP].v)) {
            since = 0;
            wait = wait < 64 ? 2*wait : 64;
            if (opens(w, x, o->panel))
                return;
        }
        if (!step(w, o, x, width))
            return;
        w->steps++;
    }
    end(w, UNPROVED, TOO_MANY_STEPS);
}

/* `quantities`: low, high of each in SI (NaN if absent); `moving`: for each its column among the parameters, or -1. False if
 * the states at initial contact are not finite. */
static int set_up(proof *w, const double *quantities, const int *moving)
{
    dual box[QUANTITIES], centre[QUANTITIES], y[STATES], first[STATES];
    memset(w, 0, sizeof *w);
    for (int j = 0; j < COLUMNS; j++)
        w->p.rho[j] = iv_point(0.0);
    for (int i = 0; i < QUANTITIES; i++) {
        box[i] = d_value(iv_of(quantities[2*i], quantities[2*i + 1]));
        centre[i] = box[i];
        if (PARAMETERS && moving[i] >= 0) {
            const double middle = iv_middle(box[i].v);
            centre[i].v = iv_point(middle);
            w->p.rho[moving[i]] = iv_sub(box[i].v, iv_point(middle));
            box[i].mask = 1u << (STATES + moving[i]);
            box[i].d[STATES + moving[i]] = iv_point(1.0);
        }
    }
    scale(&w->p.box, box);
    scale(&w->p.centre, centre);
    w->here.film = 1;
    w->here.shear = iv_point(1.0);
    if (PARAMETERS)
        narrow(&w->p, (dual *)&w->p.box, (const dual *)&w->p.centre, sizeof(constants)/sizeof(dual));
    enter_region(&w->p, w->here);
    set_region(w, 1, iv_point(iv_positive(w->p.level[TANGENTIAL_EDGE].v) && iv_lo(w->p.level[TANGENTIAL_EDGE].v) >= 1.0));
    start(&w->p.box, y);
    start(&w->p.centre, first);
    w->smallest = 1.0;
    iv at[STATES], by[STATES][DIRECTIONS];
    for (int i = 0; i < STATES; i++) {
        at[i] = first[i].v;
        w->s.q[i][i] = 1.0;
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = HAS(&y[i], j) ? y[i].d[j] : iv_point(0.0);
    }
    return map_set(&w->p, &w->s, at, by) || end(w, UNPROVED, TOO_WIDE); /* of a point at the origin */
}

/* Two thirds that meet three halves, and so on: true if the machine and the compiler round upward here, and keep numbers near
 * zero. */
static int rounds_upward(void)
{
    volatile double one = 1.0, three = 3.0, tiny = 0x1p-80, big = DBL_MAX, ten = 10.0, least = 0x1p-1074;
    const iv third = iv_div(iv_point(one), iv_point(three)), sum = iv_add(iv_point(one), iv_point(tiny));
    const iv tenth = iv_div(iv_point(one), iv_point(ten)), square = iv_mul(tenth, iv_neg(tenth));
    const iv same = iv_square(tenth), low = iv_sub(iv_point(one), iv_point(tiny)), root = iv_root(iv_point(three - one));
    return iv_lo(third) < iv_hi(third) && iv_lo(sum) == 1.0 && iv_hi(sum) > 1.0 && iv_lo(low) < 1.0 && iv_hi(low) == 1.0 &&
        iv_lo(tenth) < iv_hi(tenth) && iv_lo(square) < iv_hi(square) && iv_lo(same) < iv_hi(same) &&
        iv_lo(same) == -iv_hi(square) && iv_hi(iv_add(iv_point(big), iv_point(big))) == INFINITY &&
        iv_lo(iv_add(iv_point(big), iv_point(big))) == big && iv_lo(root) < iv_hi(root) &&
        iv_lo(root)*iv_lo(root) > 1.99 && one + tiny > one && -((-one) - tiny) == one &&
        iv_hi(iv_square(iv_point(least))) > 0.0;
}

#define EXPORTED __attribute__((visibility("default"), noinline))

/* Run with rounding upward and small numbers that are not flushed to zero, as another library may have set it; all is as before
 * afterwards. A call by pointer, so that nothing is moved across. */
typedef void body(void *);
static void rounded(body *run, void *argument)
{
    body *volatile called = run;
    fenv_t before;
    fegetenv(&before);
    fesetenv(FE_DFL_ENV);
    fesetround(FE_UPWARD);
    called(argument);
    fesetenv(&before);
}

typedef struct {
    const double *quantities, *settings;
    const int *moving;
    proof *w;
    double *result;
} request;

/* The parameter that spreads gaps and velocities the most; -1 where none has yet. */
static int most_spread(const proof *w)
{
    double most = 0.0;
    int column = -1;
    for (int j = 0; j < PARAMETERS; j++) {
        double spread = iv_magnitude(w->p.rho[j])*(fabs(w->s.parameter[GAP][j]) + fabs(w->s.parameter[NORMAL_VELOCITY][j]));
        if (spread > most) {
            most = spread;
            column = j;
        }
    }
    return column;
}

static void run_proof(void *argument)
{
    request *r = argument;
    proof *w = r->w;
    const double *s = r->settings;
    const options o = {(int)s[0], (int)s[1], (int)s[2], s[3], s[4], s[5], (int)s[6]};
    if (set_up(w, r->quantities, r->moving))
        prove(w, &o);
    const double result[RESULTS] = {w->outcome, w->why, w->steps, w->rebounds, w->criterion, iv_lo(w->speed), iv_hi(w->speed),
        w->smallest, (double)w->panels, most_spread(w)};
    memcpy(r->result, result, sizeof result);
}

static void run_start(void *argument)
{
    set_tables();
    *(int *)argument = rounds_upward();
}

/* Prepares the tables; 0 if rounding does not work here. To be called once, before any proof. */
EXPORTED int interval_start(void)
{
    int good = 0;
    rounded(run_start, &good);
    return good;
}

EXPORTED const char *interval_quantities(void) { return quantity_names; }

EXPORTED size_t interval_room(void) { return sizeof(proof); }

/* One proof, in `room` of that size. */
EXPORTED void interval_prove(const double *quantities, const int *moving, const double *settings, void *room, double *result)
{
    request r = {quantities, settings, moving, room, result};
    rounded(run_proof, &r);
}
