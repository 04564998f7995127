/* One proof: the set of all trajectories from a box of inputs, step by step through its events up to the outcome. */
#include "barrier.h"
#include "funnel.h"

enum { UNPROVED, STICK, ROTATE, BOUNCE };
enum reason { PROVED, TOO_MANY_STEPS, STEP_TOO_SMALL, GRAZE, ORDER, START, TOO_WIDE, TOO_MANY_REBOUNDS, CHATTER };
enum event { AT_CONTACT, AT_FILM_IN, AT_FILM_OUT, AT_SHEAR_IN, AT_SHEAR_OUT, AT_RUPTURE, AT_GLASS, EVENTS };
enum { RESULTS = 12, MOST_REBOUNDS = 200 };
#define NO_SPEED 1e-9 /* slower rebounds go on towards rest in contact, which is not enclosed */

typedef struct {
    int order, most_steps, funnels; /* funnels: 0 none, 1 tried along the way */
    double tolerance, widest, panel;
} options;

typedef struct {
    problem p;
    set s;
    region here;
    barrier wall;
    flow centre, box, rest;
    int outcome, why, steps, rebounds, criterion;
    long panels;
    double h, smallest;
    iv speed;
} proof;

/* A guard of an event on a gap: its target, and +1 where the gap falls to it, -1 where it rises. */
static int gap_guard(const proof *w, int event, dual *target, iv *centre)
{
    const int level = event == AT_CONTACT ? CONTACT_GAP : event == AT_RUPTURE ? RUPTURE_GAP : TANGENTIAL_EDGE;
    if (event == AT_FILM_IN || event == AT_FILM_OUT) {
        *target = d_value(iv_point(1.0));
        *centre = iv_point(1.0);
    } else {
        *target = w->p.level[level];
        *centre = w->p.level_centre[level];
    }
    return event == AT_CONTACT || event == AT_FILM_IN || event == AT_SHEAR_IN ? 1 : -1;
}

static int is_present(const proof *w, int event)
{
    const int film = w->here.film, shear = iv_positive(w->here.shear);
    const iv edge = w->p.level[TANGENTIAL_EDGE].v, end = w->p.level[RUPTURE_GAP].v;
    const int edged = OBLIQUE && iv_lo(edge) < iv_hi(end) && !(edge[0] == -1.0 && edge[1] == 1.0);
    switch (event) {
    case AT_FILM_IN: return !film;
    case AT_FILM_OUT: return film && iv_hi(end) > 1.0;
    case AT_SHEAR_IN: return edged && !shear;
    case AT_SHEAR_OUT: return edged && shear;
    case AT_RUPTURE: return !film || iv_hi(end) <= 1.0;
    default: return 1;
    }
}

static void set_region(proof *w, int film, iv shear)
{
    const iv edge = w->p.level[TANGENTIAL_EDGE].v;
    w->here.film = film;
    w->here.shear = edge[0] == -1.0 && edge[1] == 1.0 ? iv_point(film) : shear; /* the edge of the film, too */
    enter_region(&w->p, w->here);
}

/* Expand the states of `x` up to `order`, with derivatives by states and parameters or without. */
static void expand(flow *s, const constants *c, const iv *x, int order, int derivatives)
{
    active = derivatives ? (1u << DIRECTIONS) - 1 : 0;
    for (int i = 0; i < STATES; i++) {
        s->state[i].v[0] = x[i];
        s->state[i].mask = active & ((1u << STATES) - 1);
        EACH_DIRECTION(j, s->state[i].mask) s->state[i].d[j][0] = iv_point(i == (int)j ? 1.0 : 0.0);
    }
    for (int k = 0; k < order; k++)
        advance(s, c, k);
}

/* True if a series is positive over [a, b], by mean values and bisection. */
static int stays_positive(const iv *g, int order, double a, double b, int depth)
{
    const double m = 0.5*a + 0.5*b;
    const iv t = iv_of(a, b), middle = horner(g, order, iv_point(m));
    if (iv_positive(iv_add(middle, iv_mul(horner_slope(g, order, t), iv_sub(t, iv_point(m))))))
        return 1;
    if (depth == 0 || !(b - a > 1e-15) || !iv_positive(middle))
        return 0;
    return stays_positive(g, order, a, m, depth - 1) && stays_positive(g, order, m, b, depth - 1);
}

static double value_at(const double *c, int order, double t)
{
    double sum = c[order];
    for (int k = order - 1; k >= 0; k--)
        sum = c[k] + t*sum;
    return sum;
}

/* About where the middle of a series falls to zero within [0, h]: between samples, or in a dip; -1 if nowhere. */
static double first_zero(const iv *g, int order, double h)
{
    double c[TERMS], slope[TERMS], last = 0.0;
    for (int k = 0; k <= order; k++)
        c[k] = iv_middle(g[k]);
    for (int k = 0; k < order; k++)
        slope[k] = (k + 1)*c[k + 1];
    for (int i = 1; i <= 32; i++) {
        double from = last, to = h*i/32;
        if (value_at(c, order, to) > 0.0 && value_at(slope, order - 1, from) < 0.0 && value_at(slope, order - 1, to) > 0.0) {
            double a = from, b = to;
            for (int n = 0; n < 60; n++) {
                double m = 0.5*(a + b);
                *(value_at(slope, order - 1, m) < 0.0 ? &a : &b) = m;
            }
            to = value_at(c, order, a) <= 0.0 ? a : to;
        }
        last = h*i/32;
        if (value_at(c, order, to) > 0.0)
            continue;
        for (int n = 0; n < 60; n++) {
            double m = 0.5*(from + to);
            *(value_at(c, order, m) > 0.0 ? &from : &to) = m;
        }
        return 0.5*(from + to);
    }
    return -1.0;
}

static int end(proof *w, int outcome, int why)
{
    w->outcome = outcome;
    w->why = why;
    return 0;
}

/* The set onto the surface of an event, whose crossing states lie in `x`; the set is at one time near them. */
static int onto_surface(proof *w, int event, iv *x)
{
    iv hull[STATES], at[STATES], by[STATES][DIRECTIONS], z[STATES], value, along = iv_point(0.0), f[STATES], gradient[DIRECTIONS];
    hull_of(&w->p, &w->s, hull);
    for (int i = 0; i < STATES; i++) {
        hull[i] = iv_hull(hull[i], x[i]);
        z[i] = iv_point(w->s.z[i]);
    }
    dual target;
    iv centre;
    const int sign = gap_guard(w, event, &target, &centre);
    expand(&w->box, &w->p.box, hull, 1, 1);
    for (int j = 0; j < DIRECTIONS; j++)
        gradient[j] = iv_point(0.0);
    for (int i = 0; i < STATES; i++)
        f[i] = w->box.state[i].v[1];
    if (event == AT_GLASS) {
        advance_clearance(&w->box, &w->p.box, 0);
        EACH_DIRECTION(j, w->box.clearance.mask) gradient[j] = w->box.clearance.d[j][0];
        expand(&w->centre, &w->p.centre, z, 0, 0);
        advance_clearance(&w->centre, &w->p.centre, 0);
        value = w->centre.clearance.v[0];
    } else {
        gradient[GAP] = iv_point(sign);
        EACH_DIRECTION(j, target.mask) gradient[j] = iv_mul(iv_point(-sign), target.d[j]);
        value = iv_mul(iv_point(sign), iv_sub(z[GAP], centre));
    }
    for (int i = 0; i < STATES; i++)
        along = iv_add(along, iv_mul(gradient[i], f[i]));
    if (!iv_negative(along))
        return end(w, UNPROVED, GRAZE);
    for (int i = 0; i < STATES; i++) {
        const iv part = iv_div(f[i], along);
        at[i] = iv_sub(z[i], iv_mul(part, value));
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = iv_sub(iv_point(i == j ? 1.0 : 0.0), iv_mul(part, gradient[j]));
    }
    if (event != AT_GLASS) { /* known exactly */
        at[GAP] = centre;
        for (int j = 0; j < DIRECTIONS; j++)
            by[GAP][j] = HAS(&target, j) ? target.d[j] : iv_point(0.0);
    }
    return map_set(&w->p, &w->s, at, by) || end(w, UNPROVED, TOO_WIDE);
}

/* The rebound, by the emitted jump of the state; its words are those of the automaton. */
static int bounce(proof *w, int criterion)
{
    dual y[STATES], z[STATES], after[STATES], at_centre[STATES];
    iv x[STATES], at[STATES], by[STATES][DIRECTIONS];
    hull_of(&w->p, &w->s, x);
    for (int i = 0; i < STATES; i++) {
        y[i] = d_value(x[i]);
        y[i].mask = 1u << i;
        y[i].d[i] = iv_point(1.0);
        z[i] = d_value(iv_point(w->s.z[i]));
    }
    rebound(&w->p.box, y, after);
    rebound(&w->p.centre, z, at_centre);
    for (int i = 0; i < STATES; i++) {
        at[i] = at_centre[i].v;
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = HAS(&after[i], j) ? after[i].d[j] : iv_point(0.0);
    }
    if (!map_set(&w->p, &w->s, at, by))
        return end(w, UNPROVED, TOO_WIDE);
    hull_of(&w->p, &w->s, x);
    if (!w->rebounds)
        w->criterion = criterion;
    if (++w->rebounds > MOST_REBOUNDS)
        return end(w, UNPROVED, TOO_MANY_REBOUNDS);
    return iv_lo(x[NORMAL_VELOCITY]) > NO_SPEED || end(w, UNPROVED, CHATTER);
}

static int separate(proof *w, iv speed)
{
    w->speed = speed;
    return end(w, w->rebounds ? BOUNCE : ROTATE, PROVED);
}

/* A box that the motion does not leave within a step, and the length of that step; K terms are known over `x`. */
static int a_priori(proof *w, const options *o, const iv *x, double width, iv *box, iv *power)
{
    const double want = larger(o->tolerance, 2e-3*width);
    int contained = 0;
    dual target;
    iv centre;
    for (int trial = 0; trial < 60 && !contained; trial++) {
        if (!(w->h > 1e-14))
            return end(w, UNPROVED, STEP_TOO_SMALL);
        const iv t = iv_of(0.0, w->h);
        iv first[STATES];
        int leaves = 1;
        for (int i = 0; i < STATES; i++) {
            first[i] = horner(w->box.state[i].v, o->order, t);
            box[i] = iv_add(first[i], iv_ball(4.0*want + 1e-14*iv_magnitude(first[i])));
        }
        for (int event = 0; event < AT_GLASS; event++) { /* from a surface the motion must lead away */
            const int sign = gap_guard(w, event, &target, &centre);
            if (is_present(w, event) && !iv_positive(iv_mul(iv_point(sign), iv_sub(x[GAP], target.v))))
                leaves &= iv_positive(iv_mul(iv_point(sign), box[NORMAL_VELOCITY]));
        }
        if (!leaves || !iv_positive(box[GAP])) {
            w->h *= 0.5;
            continue;
        }
        expand(&w->rest, &w->p.box, box, o->order + 1, 0);
        *power = iv_point(1.0);
        for (int k = 0; k <= o->order; k++)
            *power = iv_mul(*power, iv_point(w->h));
        double most = 0.0;
        contained = 1;
        for (int i = 0; i < STATES; i++) {
            iv rest = iv_mul(w->rest.state[i].v[o->order + 1], iv_of(0.0, iv_hi(*power)));
            iv whole = iv_add(first[i], rest);
            contained &= whole[0] < box[i][0] && whole[1] < box[i][1];
            most = larger(most, iv_magnitude(rest));
        }
        contained &= most <= want;
        if (!contained) {
            double factor = pow(0.5*want/(most + 1e-300), 1.0/(o->order + 1));
            w->h *= factor > 0.3 ? smaller(factor, 0.9) : 0.3;
        }
    }
    return contained || end(w, UNPROVED, STEP_TOO_SMALL);
}

/* One step, or up to the next event and across it. False at the end. */
static int step(proof *w, const options *o, const iv *x, double width)
{
    const int order = o->order, terms = order + 1;
    iv box[STATES], power, z[STATES], guard[EVENTS][TERMS];
    int watched[EVENTS] = {0}, met = -1;
    for (int i = 0; i < STATES; i++)
        z[i] = iv_point(w->s.z[i]);
    expand(&w->centre, &w->p.centre, z, order, 0);
    expand(&w->box, &w->p.box, x, order, 1);
    double size = 0.0;
    for (int i = 0; i < STATES; i++)
        size = larger(size, iv_magnitude(w->centre.state[i].v[order])*(i > NORMAL_VELOCITY ? 0.05 : 1.0));
    const double reach = 1.6*pow(o->tolerance/(size + 1e-300), 1.0/order);
    w->h = smaller(w->steps ? 2.5*w->h : 1e-2, reach);
    if (!a_priori(w, o, x, width, box, &power))
        return 0;
    for (int i = 0; i < STATES; i++)
        w->box.state[i].v[terms] = w->centre.state[i].v[terms] = w->rest.state[i].v[terms];
    w->smallest = smaller(w->smallest, iv_lo(box[GAP]));
    /* events within the step */
    const int closes = !iv_positive(box[NORMAL_VELOCITY]), opens = !iv_negative(box[NORMAL_VELOCITY]);
    double h = w->h, when = 0.0;
    for (int event = 0; event < EVENTS; event++) {
        dual target;
        iv centre;
        if (event == AT_GLASS) {
            if (!closes)
                continue;
            for (int k = 0; k <= terms; k++)
                advance_clearance(&w->rest, &w->p.box, k);
            active = 0;
            for (int k = 0; k <= order; k++)
                advance_clearance(&w->box, &w->p.box, k);
            memcpy(guard[event], w->box.clearance.v, sizeof(iv)*terms);
            guard[event][terms] = w->rest.clearance.v[terms];
        } else {
            const int sign = gap_guard(w, event, &target, &centre);
            if (!is_present(w, event) || !(sign > 0 ? closes : opens) ||
                iv_positive(iv_mul(iv_point(sign), iv_sub(box[GAP], target.v))))
                continue;
            for (int k = 0; k <= terms; k++)
                guard[event][k] = iv_mul(iv_point(sign), k ? w->box.state[GAP].v[k] : iv_sub(w->box.state[GAP].v[0], target.v));
        }
        if (stays_positive(guard[event], terms, 0.0, h, 40))
            continue;
        watched[event] = 1;
        double zero = first_zero(guard[event], terms, h);
        if (zero < 0.0) { /* near the end, or a graze, which a shorter step shows */
            zero = 1.0000001*h;
        }
        if (met < 0 || zero < when) {
            met = event;
            when = zero;
        }
    }
    double early = 0.0, late = 0.0;
    if (met >= 0) {
        const iv *g = guard[met];
        const double error = iv_magnitude(horner(g, terms, iv_point(smaller(when, h))));
        const double slope = iv_magnitude(horner_slope(g, terms, iv_point(smaller(when, h))));
        const double half = 1.5*(error + 1e-300)/(slope + 1e-300) + 1e-15*when;
        early = when - half;
        late = when + half;
        if (late > h) { /* the event belongs to the next step */
            h *= when > h && early > 0.0 ? 0.8 : 0.5;
            for (int event = 0; event < EVENTS; event++)
                while (watched[event] && h > 1e-13 && !stays_positive(guard[event], terms, 0.0, h, 40))
                    h *= 0.5;
            if (!(h > 1e-13))
                return end(w, UNPROVED, GRAZE);
            met = -1;
        } else {
            if (!(early > 0.0))
                return end(w, UNPROVED, width > 1e-6 ? TOO_WIDE : GRAZE);
            for (int event = 0; event < EVENTS; event++)
                if (watched[event] && !stays_positive(guard[event], terms, 0.0, event == met ? early : late, 40))
                    return end(w, UNPROVED, event == met ? GRAZE : ORDER);
            if (!iv_negative(horner_slope(g, terms, iv_of(early, late))) || !iv_negative(horner(g, terms, iv_point(late))))
                return end(w, UNPROVED, GRAZE);
            h = when;
        }
    }
    iv at[STATES], by[STATES][DIRECTIONS], crossing[STATES];
    const iv t = iv_point(h), event_time = iv_of(early, late);
    for (int i = 0; i < STATES; i++) {
        series *state = &w->box.state[i];
        at[i] = horner(w->centre.state[i].v, terms, t);
        crossing[i] = iv_meet(horner(state->v, terms, event_time), box[i]);
        for (int j = 0; j < DIRECTIONS; j++)
            by[i][j] = HAS(state, j) ? horner(state->d[j], order, t) : iv_point(0.0);
    }
    if (!map_set(&w->p, &w->s, at, by))
        return end(w, UNPROVED, TOO_WIDE);
    w->h = h;
    if (met < 0)
        return 1;
    if (!onto_surface(w, met, crossing))
        return 0;
    w->h *= 0.5;
    iv now[STATES];
    hull_of(&w->p, &w->s, now);
    switch (met) {
    case AT_RUPTURE: return separate(w, now[NORMAL_VELOCITY]);
    case AT_FILM_IN: case AT_FILM_OUT: set_region(w, met == AT_FILM_IN, w->here.shear); return 1;
    case AT_SHEAR_IN: case AT_SHEAR_OUT: set_region(w, w->here.film, iv_point(met == AT_SHEAR_IN)); return 1;
    default: return bounce(w, met);
    }
}

/* The criteria that are met at initial contact. */
static int begin(proof *w)
{
    iv x[STATES];
    hull_of(&w->p, &w->s, x);
    expand(&w->box, &w->p.box, x, 0, 0);
    advance_clearance(&w->box, &w->p.box, 0);
    const iv clearance = w->box.clearance.v[0], contact = w->p.level[CONTACT_GAP].v;
    const int glass = iv_hi(clearance) <= 0.0, touches = iv_lo(contact) >= 1.0;
    if (!glass && !touches)
        return (iv_positive(clearance) && iv_hi(contact) < 1.0) || end(w, UNPROVED, START);
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
    if (!begin(w))
        return;
    while (w->steps < o->most_steps) {
        iv x[STATES], speed;
        double width = 0.0;
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
        if (w->wall.known && below_barrier(&w->p, &w->wall, x)) {
            end(w, STICK, PROVED);
            return;
        }
        if (o->funnels && ++since > wait && iv_positive(x[NORMAL_VELOCITY]) &&
            iv_hi(x[GAP]) < iv_lo(w->p.level[RUPTURE_GAP].v)) {
            const region here = w->here;
            since = 0;
            wait = wait < 64 ? 2*wait : 64;
            if (funnel(&w->p, &w->rest, x, here, o->panel, &speed, &w->panels)) {
                separate(w, speed);
                return;
            }
            w->here = here;
            enter_region(&w->p, here);
        }
        if (!step(w, o, x, width))
            return;
        w->steps++;
    }
    end(w, UNPROVED, TOO_MANY_STEPS);
}

/* `quantities`: low, high of each in SI (NaN if absent); `moving`: for each its column among the parameters, or -1. */
static void set_up(proof *w, const double *quantities, const int *moving)
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
    map_set(&w->p, &w->s, at, by); /* of a point at the origin */
}

/* Two thirds that meet three halves, and so on: true if the machine and the compiler round upward here. */
static int rounds_upward(void)
{
    volatile double one = 1.0, three = 3.0, tiny = 0x1p-80, big = DBL_MAX, ten = 10.0;
    const iv third = iv_div(iv_point(one), iv_point(three)), sum = iv_add(iv_point(one), iv_point(tiny));
    const iv tenth = iv_div(iv_point(one), iv_point(ten)), square = iv_mul(tenth, iv_neg(tenth));
    const iv same = iv_square(tenth), low = iv_sub(iv_point(one), iv_point(tiny)), root = iv_root(iv_point(three - one));
    return iv_lo(third) < iv_hi(third) && iv_lo(sum) == 1.0 && iv_hi(sum) > 1.0 && iv_lo(low) < 1.0 && iv_hi(low) == 1.0 &&
        iv_lo(tenth) < iv_hi(tenth) && iv_lo(square) < iv_hi(square) && iv_lo(same) < iv_hi(same) &&
        iv_lo(same) == -iv_hi(square) && iv_hi(iv_add(iv_point(big), iv_point(big))) == INFINITY &&
        iv_lo(iv_add(iv_point(big), iv_point(big))) == big && iv_lo(root) < iv_hi(root) &&
        iv_lo(root)*iv_lo(root) > 1.99 && one + tiny > one && -((-one) - tiny) == one;
}

#define EXPORTED __attribute__((visibility("default"), noinline))

/* Run with rounding upward, which is restored. A call by pointer, so that nothing is moved across. */
typedef void body(void *);
static void rounded(body *run, void *argument)
{
    body *volatile called = run;
    const int mode = fegetround();
    fesetround(FE_UPWARD);
    called(argument);
    fesetround(mode);
}

typedef struct {
    const double *quantities, *settings;
    const int *moving;
    proof *w;
    double *result;
} request;

static void run_proof(void *argument)
{
    request *r = argument;
    proof *w = r->w;
    const options o = {(int)r->settings[0], (int)r->settings[1], (int)r->settings[2], r->settings[3], r->settings[4], r->settings[5]};
    set_up(w, r->quantities, r->moving);
    prove(w, &o);
    const double result[RESULTS] = {w->outcome, w->why, w->steps, w->rebounds, w->criterion, iv_lo(w->speed), iv_hi(w->speed),
        w->smallest, (double)w->panels, w->s.z[GAP], w->s.z[NORMAL_VELOCITY], w->here.film};
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
