/* The slow manifold of an opening doublet, and when its film has contracted all memory of how it came.
 *
 * Theory and names: derive/equations/certificates/slow_manifold.py. Trajectory and manifold are enclosed in a tube,
 * followed panel by panel; its coefficients are monotonic in the gap, so that values at the ends of a panel bound them
 * within it. The bound of the logarithmic norm over the tube is integrated.
 */
#pragma once

#include "model.h"
#include "state.h"

#if JUMPS
enum {
    SWEEPS = 8,               /* of the iteration on series in the gap */
    PANELS = 5, BEYOND = 3,   /* before the gap of a jump and beyond it */
    TARGETS = 2,              /* gaps tried */
    BISECTIONS = 5,           /* to find one */
    DEPTHS = 10, STAGES = 6,  /* bisections for the lowest gap of an approach, and panels down to it */
};
STATIC_ASSERT(SWEEPS <= ORDER); /* series are long enough */
static const double FORGOTTEN = 20.0;  /* contraction beyond the tolerance, as a logarithm */
static const double PANEL = 1.3;       /* largest ratio of the gaps at the ends of a panel */
static const double LATER = 1.05;      /* the same beyond the gap of a jump */
static const double LAST = 0.98;       /* largest gap of a jump, over that of the first edge */
static const double SHARE = 0.1;       /* of the tolerance that an error of the slow manifold may take */
static const double COARSEST = 1e-3;   /* largest such error at the gap itself, before it decays */
static const double SEPARATED = 38.0;  /* separation at which the manifold is good to a tolerance of 1e-9 */
static const double MORE[TARGETS] = {1.0, 1.7}; /* times that, tried in turn */
static const double WORTH_IT = 1.5, JUST_AFTER = 1.15; /* times that, at this ratio to the gap of the turn: tried */
static const double INSIDE = 0.62;     /* of the film: the separation there decides on a jump from initial contact */

/* The coefficients at one gap. */
typedef struct {
    vec gap, distance, slowing, relaxation, rigid, centrifugal, attractions;
} place;

static inline void look_at(slow_series *s, const constants *c, vec gap, place *at)
{
    s->gap[0] = gap;
    slow_coefficients(s, c, 0);
    at->gap = gap;
    at->distance = s->distance[0];
    at->slowing = s->slowing[0];
    at->relaxation = s->relaxation[0];
    at->rigid = s->rigid[0];
    at->centrifugal = s->centrifugal[0];
    at->attractions = s->attractions[0];
}

/* Decay times of the faster motions while the film's slowing falls by a factor e, on the slow manifold to leading order;
 * not positive where it does not open. */
static vec separation(slow_series *s, const constants *c, vec gap)
{
    place at;
    look_at(s, c, gap, &at);
    s->gap[1] = splat(1.0);
    slow_coefficients(s, c, 1);
    vec force = at.centrifugal*at.rigid*at.rigid - at.attractions;
    return at.slowing*at.slowing*vec_smaller(at.slowing, at.relaxation)/(force*-s->slowing[1]);
}

/* The iteration gains a factor of the separation with every sweep. */
static double separation_for(double rtol)
{
    return SEPARATED*pow(rtol/1e-9, -1.0/SWEEPS);
}

/* Bounds at a gap: of the normal velocity, of the distance of the orbital momentum from its rigid value, and of the slope
 * of that value from here on (which falls). */
typedef struct {
    vec fastest, slowest, lag, slope;
} tube;

/* Bounds over a panel: terms of the logarithmic norm. */
typedef struct {
    vec width, normal, by_momentum, tangential, by_velocity;
} panel;

/* Least and largest net force over a panel, if the momentum is off its rigid value by at most `off`. */
static inline void forces(const place *a, const place *b, vec off, vec *most, vec *weakest, vec *strongest)
{
    vec least = vec_smaller(vec_abs(a->rigid), vec_abs(b->rigid)) - off;
    *most = vec_larger(vec_abs(a->rigid), vec_abs(b->rigid)) + off;
    *weakest = choose(least > 0.0, b->centrifugal*least*least, splat(0.0)) - a->attractions;
    *strongest = a->centrifugal**most**most - b->attractions;
}

/* Follows the tube from one gap to the next; returns the lanes in which the doublet surely keeps opening. */
static mask follow(tube *t, const place *a, const place *b, panel *p)
{
    vec width = b->gap - a->gap, drift = vec_abs(b->rigid - a->rigid), most, weakest, strongest;
    vec stretch = b->distance/a->distance; /* the relaxation falls, but for a factor that grows slower than the distance */
    vec quick = a->relaxation*stretch, slow = b->relaxation/stretch;
    /* the lag grows by no more than the drift, and not beyond where the relaxation outweighs it */
    vec off = t->lag + drift;
    forces(a, b, off, &most, &weakest, &strongest);
    off = vec_smaller(off, vec_larger(t->lag, t->slope*vec_larger(t->fastest, strongest/b->slowing)/slow));
    forces(a, b, off, &most, &weakest, &strongest);
    vec upper = strongest/b->slowing, lower = weakest/a->slowing; /* beyond these the velocity tends back */
    vec fastest = vec_larger(t->fastest, upper), slowest = vec_smaller(t->slowest, lower);
    p->width = width;
    p->normal = weakest/(fastest*fastest);
    p->by_momentum = 2.0*a->centrifugal*most/slowest;
    p->tangential = slow/fastest;
    p->by_velocity = quick*off/(slowest*slowest);
    vec decays = p->tangential*width;
    t->lag = vec_smaller(off, t->lag*vec_exp(-decays) + vec_smaller(drift, t->slope*fastest/slow));
    t->slope = choose(width > 0.0, drift/width, t->slope);
    /* above twice `upper` the velocity falls at least at half the film's rate; below half of `lower` it rises under at
     * least half the force */
    vec fallen = vec_larger(2.0*upper, t->fastest - 0.5*b->slowing*width);
    t->fastest = choose(t->fastest > 2.0*upper, fallen, fastest);
    t->slowest = vec_larger(slowest, vec_smaller(0.5*lower, vec_sqrt(weakest*width)));
    return (weakest > 0.0) & (b->slowing > 0.0) & (b->relaxation > 0.0);
}

/* Integral of the bound of the logarithmic norm over panels, in the metric max(|e|, |j|/metric). */
static vec contraction(const panel *p, int from, int to, vec metric)
{
    vec sum = splat(0.0);
    for (int k = from; k < to; k++) {
        vec normal = p[k].normal - p[k].by_momentum*metric, tangential = p[k].tangential - p[k].by_velocity/metric;
        sum += choose(p[k].width > 0.0, p[k].width*vec_smaller(normal, tangential), splat(0.0));
    }
    return sum;
}

/* State of the slow manifold at a gap, by iteration of u = (c J^2 - A)/(f + u'), J = J_r - u J'/s on series in the gap.
 * The iteration is asymptotic: the step with the least change is kept, and that change is the estimate of its error. */
static vec on_manifold(slow_series *s, const constants *c, vec gap, vec *normal_velocity, vec *momentum)
{
    vec u[TERMS], j[TERMS], rise[TERMS], turn[TERMS], bent[TERMS], lag[TERMS], square_of_j[TERMS], force[TERMS];
    vec film[TERMS], over, least_change = splat(HUGE_VAL);
    s->gap[0] = gap;
    for (int k = 1; k <= SWEEPS; k++)
        s->gap[k] = splat(k == 1 ? 1.0 : 0.0);
    for (int k = 0; k <= SWEEPS; k++)
        slow_coefficients(s, c, k);
    for (int sweep = 0; sweep <= SWEEPS; sweep++) {
        vec before = sweep ? u[0] : splat(0.0), momentum_before = sweep ? j[0] : splat(0.0);
        for (int k = 0; k <= SWEEPS - sweep; k++) {
            rise[k] = sweep ? (k + 1.0)*u[k + 1] : splat(0.0);
            turn[k] = sweep ? (k + 1.0)*j[k + 1] : splat(0.0);
            film[k] = s->slowing[k] + rise[k];
        }
        for (int k = 0; sweep && k <= SWEEPS - sweep; k++) {
            bent[k] = product(u, turn, k);
            lag[k] = quotient(bent, s->relaxation, lag, &over, k);
        }
        for (int k = 0; k <= SWEEPS - sweep; k++)
            j[k] = sweep ? s->rigid[k] - lag[k] : s->rigid[k];
        for (int k = 0; k <= SWEEPS - sweep; k++) {
            square_of_j[k] = square(j, k);
            force[k] = product(s->centrifugal, square_of_j, k) - s->attractions[k];
            u[k] = quotient(force, film, u, &over, k);
        }
        if (!sweep)
            continue;
        vec change = vec_larger(vec_abs(u[0]/before - 1.0), vec_abs(j[0]/momentum_before - 1.0));
        mask better = (change < least_change) & (u[0] > 0.0);
        least_change = choose(better, change, least_change);
        *normal_velocity = choose(better, u[0], *normal_velocity);
        *momentum = choose(better, j[0], *momentum);
    }
    return least_change;
}

/* Where an opening phase may begin: at rest between two gaps, and how far the momentum is off its rigid value. */
typedef struct {
    vec lowest, highest, lag;
} opening;

/* Lanes in which all memory of the opening's beginning is lost at the gap `to`, and an error of `wrong` there soon
 * after: `reached` is the state there, `last` the largest gap that is looked at. */
static mask forgets(
    slow_series *s, const constants *c, const opening *from, vec to, vec wrong, const vec *reached, vec rtol, vec last)
{
    place at[2];
    panel entry, panels[PANELS + BEYOND];
    vec gap = vec_larger(to*pow(PANEL, -PANELS), from->highest);
    look_at(s, c, from->lowest, &at[0]);
    s->gap[1] = splat(1.0);
    slow_coefficients(s, c, 1);
    tube t = {splat(0.0), splat(0.0), from->lag, vec_abs(s->rigid[1])};
    look_at(s, c, gap, &at[1]);
    mask sound = (gap == from->lowest) | follow(&t, &at[0], &at[1], &entry);
    mask late = from->lowest < from->highest; /* it may have begun as late as at the end of this panel */
    t.slowest = choose(late | (gap == from->lowest), splat(0.0), t.slowest);
    t.lag = choose(late, from->lag + vec_abs(at[1].rigid - at[0].rigid), t.lag);
    vec ratio = vec_exp(vec_log(to/gap)*(1.0/PANELS)), low = splat(0.0), high = splat(HUGE_VAL);
    tube first = t;
    for (int k = 0; k < PANELS + BEYOND; k++) {
        at[0] = at[1];
        gap = k == PANELS - 1 ? to : k < PANELS ? gap*ratio : vec_smaller(gap*LATER, last);
        look_at(s, c, gap, &at[1]);
        mask opens = follow(&t, &at[0], &at[1], &panels[k]);
        if (k < PANELS)
            sound &= opens;
        else
            panels[k].width = only(opens, panels[k].width); /* nothing is known where it may not open */
        if (k == 0)
            first = t;
        if (k > 0 && k < PANELS) {
            high = vec_smaller(high, 0.5*panels[k].normal/panels[k].by_momentum);
            low = vec_larger(low, 2.0*panels[k].by_velocity/panels[k].tangential);
        }
    }
    vec metric = vec_sqrt(high*vec_larger(low, 1e-12*high));
    vec spread = vec_larger(first.fastest, 2.0*first.lag/metric);
    vec allowed = vec_smaller(reached[0], vec_abs(reached[1])/metric);
    sound &= contraction(panels, 1, PANELS, metric) >= FORGOTTEN + vec_log(spread/(allowed*rtol));
    vec later = vec_larger(contraction(panels, PANELS, PANELS + BEYOND, metric), splat(0.0));
    return sound & (wrong <= COARSEST) & (vec_log(wrong/(SHARE*rtol)) <= later);
}

#if LEAPS
/* Velocity that the film takes from initial contact to a gap. */
static inline vec taken(const constants *c, vec gap)
{
    vec y[STATES], taken;
    y[GAP] = gap;
    film_taken(c, y, &taken);
    return taken;
}

/* Bounds the opening of doublets at initial contact; returns the lanes that surely turn in the film without meeting a
 * rebound criterion. Momenta are taken in the sense of rigid rotation, in which they have to stay positive.
 *
 * While the net force is outward, the closing speed is at most what the film alone leaves of it, a closed form, which
 * gives the lowest gap. It is less by the impulse of that force, which bounds the time, and with it the highest gap.
 */
static mask descends(slow_series *s, const fixed *f, const vec *y, opening *o)
{
    const constants *c = &f->c;
    vec speed = -y[NORMAL_VELOCITY], low = f->contact, high = y[GAP];
    for (int k = 0; k < DEPTHS; k++) {
        vec middle = 0.5*(low + high);
        mask stopped = taken(c, middle) > speed;
        low = choose(stopped, middle, low);
        high = choose(stopped, high, middle);
    }
    mask sound = (y[NORMAL_VELOCITY] < 0.0) & (low > f->contact), closes = splat_mask(TRUTH);
    place at[2];
    look_at(s, c, y[GAP], &at[0]);
    vec off = (y[ORBITAL_MOMENTUM] - at[0].rigid)*choose(at[0].rigid < 0.0, splat(-1.0), splat(1.0));
    at[0].rigid = vec_abs(at[0].rigid);
    vec span = y[GAP] - low, most = speed, least = speed;
    vec below = vec_larger(-off, splat(0.0)), above = vec_larger(off, splat(0.0)), there_rigid = at[0].rigid;
    o->lowest = low;
    o->highest = y[GAP];
    o->lag = vec_larger(above, below);
    for (int k = 1; k <= STAGES; k++) {
        vec gap = k < STAGES ? low + span*ldexp(1.0, -k) : low;
        look_at(s, c, gap, &at[1]);
        at[1].rigid = vec_abs(at[1].rigid);
        const place *a = &at[1], *b = &at[0];
        vec width = b->gap - a->gap, film_leaves = speed - taken(c, gap), slowest = a->rigid - below;
        vec closest[STATES];
        memcpy(closest, y, sizeof closest);
        closest[GAP] = gap;
        closest[NORMAL_VELOCITY] = -most;
        sound &= glass_clearance(c, closest) > 0.0;
        sound &= (slowest > 0.0) & (b->centrifugal*slowest*slowest > a->attractions); /* outward all the way */
        vec strongest = a->centrifugal*(b->rigid + above)*(b->rigid + above) - b->attractions;
        /* least - loss in the film - strongest*width/(what is left) */
        vec left = least - (most - film_leaves), under = left*left - 4.0*strongest*width;
        closes &= (left > 0.0) & (under > 0.0);
        least = choose(closes, 0.5*(left + vec_sqrt(under)), least);
        vec slow = b->relaxation*a->distance/b->distance;
        above = above*vec_exp(-slow*width/most) + (b->rigid - a->rigid);
        o->highest = choose(closes, gap, o->highest);
        o->lag = choose(closes, vec_larger(above, below), o->lag);
        there_rigid = choose(closes, a->rigid, there_rigid);
        most = film_leaves;
        at[0] = at[1];
    }
    o->lag += there_rigid - at[0].rigid; /* on the way from the highest gap to the lowest */
    return sound & (o->lag < HUGE_VAL);
}

/* Lanes at initial contact that may jump from there: shear acts from there on, and the manifold is reached well inside
 * the film. */
static mask may_leap(const constants *c, vec edge, double rtol)
{
    slow_series s;
    return (edge >= 1.0) & (separation(&s, c, splat(INSIDE)) > separation_for(rtol));
}
#endif

/* Lanes that have turned so deep in the film that a jump may be worth while. */
static mask may_jump(const lanes *l, const fixed *f, double rtol)
{
    slow_series s;
    vec last = LAST*vec_smaller(splat(1.0), f->edge), after = JUST_AFTER*l->y[GAP];
    mask strong = separation(&s, &f->c, after) > WORTH_IT*separation_for(rtol);
    return (after < last) & strong & (acting(l) == 1.0) & (l->shear == 1.0);
}
#endif
