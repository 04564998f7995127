#pragma once
/* Bounds of the states over the distance that the gap has passed, opening or closing (Mueller): w = u^2/2 with dw/dx = a,
 * and dy/ds = f/|u| for the others. Each end moves by its own rate on its own face of the box, the other states anywhere
 * within theirs. */
#include "set.h"

enum { OPENING = STATES - 1 }; /* w, then the states behind the normal velocity */

/* Rates over a box, and each rate's derivative by its own state. */
static void field(const problem *p, flow *s, const iv *x, iv *rate, iv *own)
{
    active = own ? (1u << STATES) - 1 : 0;
    for (int i = 0; i < STATES; i++) {
        s->state[i].v[0] = x[i];
        s->state[i].mask = active & 1u << i;
        s->state[i].d[i][0] = iv_point(1.0);
    }
    advance(s, &p->box, 0);
    for (int i = 0; i < STATES; i++) {
        rate[i] = s->state[i].v[1];
        if (own)
            own[i] = HAS(&s->state[i], i) ? s->state[i].d[i][1] : iv_point(0.0);
    }
}

/* A lower bound, after the distance h >= 0, of y with y(0) >= 0, y' = r + g(y), g(0) = 0, where the slope of g is within
 * [steep, flat]: of a falling one the line and the level that it tends to, of a rising one the implicit step. `least` is
 * a bound of the rate over the whole box, for a slope that may be positive (derive/checks/enclosure.py). */
static double lower_change(iv h, double r, iv slope, double least)
{
    const double steep = iv_lo(slope), flat = iv_hi(slope);
    if (!(r <= DBL_MAX) || !(least <= DBL_MAX))
        return -INFINITY;
    if (!(flat <= 0.0))
        return iv_lo(iv_mul(h, iv_point(smaller(least, 0.0))));
    if (r < 0.0) {
        double line = iv_lo(iv_mul(h, iv_point(r)));
        double level = flat < 0.0 ? iv_lo(iv_div(iv_point(r), iv_point(-flat))) : -INFINITY;
        return larger(line, level);
    }
    iv low = iv_point(iv_lo(h));
    return larger(iv_lo(iv_div(iv_mul(low, iv_point(r)), iv_sub(iv_point(1.0), iv_mul(low, iv_point(steep))))), 0.0);
}

static iv speed_of(double low, double high)
{
    return iv_root(iv_mul(iv_point(2.0), iv_of(low, high)));
}

typedef struct {
    double low[OPENING], high[OPENING];
} bounds;

enum direction { APART, TOGETHER };

static iv along(enum direction way, iv x)
{
    return way == TOGETHER ? iv_neg(x) : x;
}

static void box_of(enum direction way, const bounds *b, iv *x)
{
    x[NORMAL_VELOCITY] = along(way, speed_of(b->low[0], b->high[0]));
    for (int i = 1; i < OPENING; i++)
        x[i + 1] = iv_of(b->low[i], b->high[i]);
}

/* Bounds after the panel `gap`, whose trajectories start within it at once or along it; false if the guess was too
 * narrow, which `guess` then is wider. */
static int cross(enum direction way, const problem *p, flow *s, iv gap, iv h, const bounds *now, bounds *guess, bounds *after)
{
    iv x[STATES], rate[STATES], own[STATES], face[STATES];
    if (!(guess->low[0] > 0.0))
        return 0;
    x[GAP] = gap;
    box_of(way, guess, x);
    field(p, s, x, rate, own);
    const iv over = iv_inverse(along(way, x[NORMAL_VELOCITY]));
    int good = 1;
    for (int i = 0; i < OPENING; i++) {
        const iv slope = iv_mul(own[i + 1], over);
        const iv whole = i ? iv_mul(rate[i + 1], over) : along(way, rate[1]);
        for (int up = 0; up < 2; up++) {
            const double from = up ? now->high[i] : now->low[i];
            memcpy(face, x, sizeof face);
            face[i + 1] = i ? iv_point(from) : along(way, speed_of(from, from));
            iv there[STATES];
            field(p, s, face, there, NULL);
            iv r = i ? iv_mul(there[i + 1], iv_inverse(along(way, face[NORMAL_VELOCITY]))) : along(way, there[1]);
            if (up) { /* -y */
                after->high[i] = from - lower_change(h, -iv_hi(r), slope, -iv_hi(whole));
                good &= larger(from, after->high[i]) < guess->high[i];
            } else {
                after->low[i] = -(-from - lower_change(h, iv_lo(r), slope, iv_lo(whole)));
                good &= smaller(from, after->low[i]) > guess->low[i];
            }
            if (!(fabs(up ? after->high[i] : after->low[i]) <= DBL_MAX))
                return 0;
        }
    }
    if (!good)
        for (int i = 0; i < OPENING; i++) {
            double low = smaller(now->low[i], after->low[i]), high = larger(now->high[i], after->high[i]);
            double room = 0.5*(high - low) + 1e-14*fabs(high);
            guess->low[i] = i ? smaller(guess->low[i], low - room) : smaller(guess->low[i], larger(low - room, 0.7*low));
            guess->high[i] = larger(guess->high[i], high + room);
        }
    return good;
}

/* Bounds after a panel, by a few guesses of those within it: from how fast the bounds change, if that is known. */
static int crosses(enum direction way, const problem *p, flow *s, iv gap, iv h, double panel, const double *rates, const bounds *now,
    bounds *after)
{
    bounds guess;
    for (int i = 0; i < OPENING; i++) {
        const double size = larger(fabs(now->high[i]), fabs(now->low[i]));
        double room = 0.3*(now->high[i] - now->low[i]) + (rates ? 2.0*iv_hi(h)*rates[i] + 1e-14*size :
            (i ? 0.02 : 0.1)*(panel/0.01 + 0.1)*size);
        guess.low[i] = i ? now->low[i] - room : larger(now->low[i] - room, 0.7*now->low[i]);
        guess.high[i] = now->high[i] + room;
    }
    for (int trial = 0; trial < 4; trial++)
        if (cross(way, p, s, gap, h, now, &guess, after))
            return 1;
    return 0;
}

/* About how fast the bounds change over the gap, from their middle. */
static void first_rates(const problem *p, flow *s, double gap, const bounds *now, double *rates)
{
    const double speed = sqrt(now->low[0] + now->high[0]);
    iv x[STATES] = {iv_point(gap), iv_point(speed)}, rate[STATES];
    for (int i = 1; i < OPENING; i++)
        x[i + 1] = iv_point(0.5*now->low[i] + 0.5*now->high[i]);
    field(p, s, x, rate, NULL);
    for (int i = 0; i < OPENING; i++)
        rates[i] = iv_magnitude(rate[i + 1])/(i ? speed : 1.0);
}

/* True if every trajectory from the box opens up to the rupture gap; `speed` encloses u there: between the bounds at the
 * ends of panels from the low end of that gap on (derive/checks/enclosure.py). The region is left as it is at the end. Panels are
 * so short that w changes by less than a third: beside a saddle the pair opens so slowly that its distance from the saddle is
 * what they must resolve. */
static int funnel(problem *p, flow *s, const iv *x, region at_start, double panel, iv *speed, long *panels)
{
    bounds now, after;
    const iv w = iv_mul(iv_point(0.5), iv_square(x[NORMAL_VELOCITY])), edge = p->level[TANGENTIAL_EDGE].v;
    const double first = iv_lo(p->level[RUPTURE_GAP].v), last = iv_hi(p->level[RUPTURE_GAP].v), width = panel;
    region here = at_start;
    double at = iv_lo(x[GAP]), least = 0.0, rates[OPENING] = {0.0};
    int start = 1;
    iv ruptured = {-INFINITY, -INFINITY}; /* w of those that have */
    now.low[0] = iv_lo(w);
    now.high[0] = iv_hi(w);
    for (int i = 1; i < OPENING; i++) {
        now.low[i] = iv_lo(x[i + 1]);
        now.high[i] = iv_hi(x[i + 1]);
    }
    if (!iv_positive(x[NORMAL_VELOCITY]) || !iv_positive(x[GAP]))
        return 0;
    const double most = (12.0 + 2.0*log(last/at))/width; /* panels */
    for (long n = 0; n < most && now.low[0] > 0.0; n++) {
        if (!start) {
            if (!least)
                first_rates(p, s, at, &now, rates);
            panel = smaller(panel, 0.3*now.high[0]/(at*rates[0] + 1e-300));
            least = least ? least : 1e-3*panel;
            if (!(panel > least))
                return 0;
        }
        double to = start ? iv_hi(x[GAP]) : at*(1.0 + panel);
        const double film_end = here.film ? 1.0 : INFINITY;
        const double shear_end = iv_hi(here.shear) > 0.0 ? iv_lo(here.shear) > 0.0 ? iv_lo(edge) : iv_hi(edge) : INFINITY;
        if (at >= film_end || at >= shear_end) { /* across an uncertain edge the force is there or not */
            if (at >= film_end)
                here.film = 0;
            if (at >= shear_end)
                here.shear = at < iv_hi(edge) ? iv_of(0.0, 1.0) : iv_point(0.0);
            enter_region(p, here);
            continue;
        }
        const double end = smaller(at < first ? first : last, smaller(film_end, shear_end));
        if (start && to > end)
            return 0;
        to = start ? to : smaller(to, end);
        const iv gap = iv_of(at, to), length = iv_sub(iv_point(to), iv_point(at));
        const iv h = start ? iv_of(0.0, iv_hi(length)) : length;
        ++*panels;
        if (!crosses(APART, p, s, gap, h, panel, rates, &now, &after)) {
            panel *= 0.5;
            if (start)
                return 0;
            continue;
        }
        if (start) /* trajectories start anywhere within this panel */
            for (int i = 0; i < OPENING; i++) {
                after.low[i] = smaller(now.low[i], after.low[i]);
                after.high[i] = larger(now.high[i], after.high[i]);
            }
        for (int i = 0; i < OPENING; i++)
            rates[i] = larger(fabs(after.low[i] - now.low[i]), fabs(after.high[i] - now.high[i]))/iv_hi(h);
        now = after;
        if (to >= first)
            ruptured = iv_hull(ruptured, iv_of(now.low[0], now.high[0]));
        if (to >= last) {
            *speed = speed_of(iv_lo(ruptured), iv_hi(ruptured));
            return iv_positive(*speed);
        }
        at = to;
        start = 0;
        panel = smaller(width, 1.5*panel);
    }
    return 0;
}
