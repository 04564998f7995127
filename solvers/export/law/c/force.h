/* A contact as a force over the steps of a host: the pair's own motion along its line of centres, which is held for a
 * step, is followed within the step, film and bridge implicitly; its impulse over the step's length is returned.
 *
 * Every substep is the exact motion under the means of resistance and attraction over the gaps that it passes, so that
 * the momentum that the film takes and the work of the attractions are those between these gaps.
 * The centrifugal force is the host's: positions move along straight lines from one step to the next.
 */
#pragma once

#include "ends.h"

enum { SUBSTEPS = 2000, REBOUNDS = 8 }; /* most in a step; more rebounds are rest */
static const double WIDEST = 0.5;       /* change of the gap in a substep, over the gap */
static const double SLACK = 0.25;       /* that the host's gap may differ from the contact's, over the film */
static const double RETURN = 0.2;       /* part of what exceeds it that a step takes back */

/* A step along the line of centres: what goes on from substep to substep. */
typedef struct {
    space_held h;
    double mass, others, load; /* reduced, kg; force of all else along the line, N, without and with the centrifugal */
    double gap, velocity, work; /* work against the attractions, J */
} line;

/* (1 - exp(-z))/z, and the mean of it from 0 to z. */
static double decayed(double z)
{
    return z < 1e-5 ? 1.0 - 0.5*z : -expm1(-z)/z;
}

static double decayed_twice(double z)
{
    return z < 1e-3 ? 0.5 - z*(1.0 - 0.25*z)/6.0 : (1.0 - decayed(z))/z;
}

/* Way and velocity after a time with constant coefficients. */
static double way(const line *l, const response *r, double time, double *velocity)
{
    double z = r->resistance/l->mass*time, push = (l->load - r->attraction)/l->mass*time;
    *velocity = l->velocity*exp(-z) + push*decayed(z);
    return time*(l->velocity*decayed(z) + push*decayed_twice(z));
}

/* The substep of a length, with the means over its own way; false if that is too wide, or is not found. */
static int substep(const line *l, const response *here, double time, double *gap, double *velocity, response *r)
{
    double direction = l->velocity != 0.0 ? l->velocity : l->load;
    double before = l->gap, off = 0.0, tried = l->gap + way(l, here, time, velocity);
    if (!(fabs(tried - l->gap) <= WIDEST*l->gap))
        return 0;
    for (int k = 0; k < 30; k++) {
        *r = space_mean_response(&l->h, l->gap, tried, direction);
        double found = l->gap + way(l, r, time, velocity), error = found - tried;
        if (!(fabs(found - l->gap) <= WIDEST*l->gap))
            return 0;
        if (fabs(error) <= 1e-12*l->gap) {
            *gap = found;
            return 1;
        }
        double next = k == 0 || error == off ? found : tried - error*(tried - before)/(error - off);
        if (!(fabs(next - l->gap) <= WIDEST*l->gap))
            next = found;
        before = tried;
        off = error;
        tried = next;
    }
    return 0;
}

/* The time to a gap that a substep passes. */
static double time_to(const line *l, double gap, double most, response *r)
{
    double least = 0.0, velocity, sense = gap > l->gap ? 1.0 : -1.0;
    *r = space_mean_response(&l->h, l->gap, gap, sense);
    for (int k = 0; k < 60; k++) {
        double middle = 0.5*(least + most);
        if (sense*(l->gap + way(l, r, middle, &velocity) - gap) < 0.0)
            least = middle;
        else
            most = middle;
    }
    return most;
}

/* The target among gaps that a substep passes first; its own gap if none. */
static double passed(const line *l, double gap)
{
    const double targets[3] = {l->h.contact, l->h.film, l->h.end};
    double first = gap;
    for (int k = 0; k < 3; k++)
        if ((l->gap - targets[k])*(first - targets[k]) < 0.0)
            first = targets[k];
    return first;
}

/* Whether solids meet, or glass would, at the state or on the way from it to another; never where they open. */
static int glass_may_come(const line *l, double gap, double velocity)
{
    double least = gap < l->gap ? gap : l->gap, fastest = velocity < l->velocity ? velocity : l->velocity;
    return fastest < 0.0 && !(space_glass_clears(&l->h, least, fastest) > 0.0);
}

/* What a rebound leaves; pairs that rebound again and again rest. */
static void meet(line *l, law_pair_history *s, law_pair_force *found, int kind, int *rebounds)
{
    l->velocity = ++*rebounds > REBOUNDS ? 0.0 : space_rebounds_with(&l->h, l->velocity);
    if (s->rebound == LAW_NO_REBOUND)
        s->rebound = kind;
    found->events |= LAW_REBOUNDS;
}

/* What rotates, in axes that turn with the line of centres `n`: the orbital momentum over the reduced mass, spins across
 * the line and along it. */
typedef struct {
    vector3 n, moment, spin[2];
    double twist[2];
} whirl;

/* A whirl under the torques of the film, at a gap: the exact motion with constant coefficients. Twist comes across the
 * line as that turns away from it. */
static void shear(const bodies *b, double gap, const response *r, double time, whirl *w)
{
    double distance = b->contact + gap;
    double orbital = 1.0/(b->reduced_mass*distance*distance), one = 1.0/b->inertia[0], other = 1.0/b->inertia[1];
    /* rates of both slips over the slips: the inverse inertia, with both spins on one line of centres, times torques */
    double a = (orbital + one)*r->own + orbital*r->mutual, d = orbital*r->mutual + (orbital + other)*r->partner;
    double p = (orbital + one)*r->mutual + orbital*r->partner, q = orbital*r->own + (orbital + other)*r->mutual;
    double half = 0.5*(a + d), root = sqrt(fmax(0.25*(a - d)*(a - d) + p*q, 0.0)), least = fmax(half - root, 0.0);
    double mean[2], by[2], whole = orbital*(one + other) + one*other;
    vector3 turning = times(1.0/(distance*distance), w->moment), aside = cross(turning, w->n), slip[2], lost[2];
    for (int k = 0; k < 2; k++) { /* of exp(-z), and of its mean up to z */
        double slow = k ? decayed(least*time) : exp(-least*time);
        double fast = k ? decayed((half + root)*time) : exp(-(half + root)*time);
        mean[k] = 0.5*(slow + fast);
        by[k] = root > 1e-9*half ? 0.5*(slow - fast)/root : 0.0;
        slip[k] = plus(turning, -1.0, w->spin[k]);
    }
    for (int k = 0; k < 2; k++) {
        double beside = k ? q : p, off = (k ? d : a) - half;
        vector3 drift[2];
        drift[0] = times(w->twist[k]*time, aside);
        drift[1] = times(w->twist[1 - k]*time, aside);
        lost[k] = plus(times(1.0 - mean[0] + by[0]*off, slip[k]), by[0]*beside, slip[1 - k]);
        lost[k] = plus(plus(lost[k], 1.0 - mean[1] + by[1]*off, drift[0]), by[1]*beside, drift[1]);
    }
    for (int k = 0; k < 2; k++) {
        double mine = k ? orbital + one : orbital + other, twisted = w->twist[k];
        vector3 given = times(1.0/whole, plus(times(mine, lost[k]), -orbital, lost[1 - k]));
        w->twist[k] -= time*dot(w->n, cross(turning, plus(w->spin[k], 0.5/b->inertia[k], given)));
        w->spin[k] = plus(plus(w->spin[k], 1.0/b->inertia[k], given), -twisted*time, aside);
        w->moment = plus(w->moment, -1.0/b->reduced_mass, given);
    }
}

/* v, turned as one unit vector is into another. */
static vector3 turned(vector3 v, vector3 from, vector3 to)
{
    vector3 axis = cross(from, to);
    double along = dot(from, to);
    vector3 made = plus(times(along, v), 1.0, cross(axis, v));
    return plus(made, along > -1.0 ? dot(axis, v)/(1.0 + along) : 0.0, axis);
}

static vector3 unit(vector3 v)
{
    return times(1.0/length(v), v);
}

/* The time from now to when the films touch on straight paths, negative for a pair that is found late; else infinite. */
static double time_to_touch(const bodies *b, vector3 apart, vector3 moving)
{
    double distance = b->contact + b->film, square = dot(moving, moving), along = dot(apart, moving);
    double beyond = dot(apart, apart) - distance*distance, root = along*along - square*beyond;
    if (!(root >= 0.0 && square > 0.0))
        return INFINITY;
    root = sqrt(root);
    return along < 0.0 ? beyond/(root - along) : (-along - root)/square;
}

/* The velocity of the gap after a time on a straight line, from a distance and velocities along and across the line. */
static double opening(double distance, double along, double sideways, double time)
{
    double square = along*along + sideways*sideways;
    return (distance*along + time*square)/hypot(distance + time*along, time*sideways);
}

/* The velocity along the line now with which it is `wanted` after a time. */
static double held_velocity(double distance, double wanted, double sideways, double time)
{
    double found = wanted - time*sideways*sideways/distance;
    for (int k = 0; k < 4; k++)
        found += wanted - opening(distance, found, sideways, time);
    return found;
}

/* The velocity along the line after an impulse, or the next to it that costs no more energy than there is to `spare`;
 * `pushed` is what all else adds to it. */
static double afforded(double mass, double before, double after, double pushed, double spare)
{
    if (0.5*mass*(after - before - pushed)*(after + before) <= spare)
        return after;
    double square = 0.25*pushed*pushed + before*before + pushed*before + 2.0*spare/mass;
    return 0.5*pushed + (after < 0.5*pushed ? -1.0 : 1.0)*sqrt(fmax(square, 0.0));
}

/* Puts a contact in place. */
static void join(law_pair_history *s, double gap, double speed)
{
    memset(s, 0, sizeof *s);
    s->joined = 1;
    s->rebound = LAW_NO_REBOUND;
    s->gap = s->smallest_gap = gap;
    s->speed = speed;
}

/* The load of a substep: all else, and the centrifugal force in its middle. */
static void press(line *l, const bodies *b, const response *r, double time, whirl w)
{
    double distance = b->contact + l->gap + 0.5*time*l->velocity;
    shear(b, l->gap, r, 0.5*time, &w);
    l->load = l->others + l->mass*dot(w.moment, w.moment)/(distance*distance*distance);
}

/* Follows the motion along the line for a time, and what rotates with it; returns the time of separation, or -1. */
static double follow_line(line *l, const bodies *b, double time, law_pair_history *s, whirl *w, law_pair_force *found)
{
    double left = time;
    int rebounds = 0;
    for (int k = 0; left > 0.0; k++) {
        response r, here;
        double gap, velocity, taken = left;
        if (k == SUBSTEPS || !(fabs(l->velocity) + dot(w->moment, w->moment) < INFINITY)) {
            found->status = k == SUBSTEPS ? LAW_UNDECIDED_NO_BUDGET : LAW_UNDECIDED_NOT_FINITE;
            return -1.0;
        }
        if (l->velocity < 0.0 && l->gap <= l->h.contact)
            meet(l, s, found, space_solid_kind(&l->h), &rebounds);
        else if (l->velocity < 0.0 && !(space_glass_clears(&l->h, l->gap, l->velocity) > 0.0))
            meet(l, s, found, LAW_GLASS, &rebounds);
        if (l->velocity > 0.0 && l->gap >= l->h.end) {
            s->joined = 0;
            found->events |= LAW_SEPARATES;
            return time - left;
        }
        here = space_mean_response(&l->h, l->gap, l->gap, l->velocity);
        press(l, b, &here, 0.0, *w);
        if (l->gap <= l->h.contact && l->velocity == 0.0 && l->load <= here.attraction) {
            shear(b, l->gap, &here, left, w); /* at rest in contact */
            found->events |= LAW_RESTS;
            break;
        }
        double wide = fabs(way(l, &here, taken, &velocity))/(WIDEST*l->gap);
        taken = wide > 1.0 ? 0.8*taken/wide : taken;
        for (press(l, b, &here, taken, *w);
             !substep(l, &here, taken, &gap, &velocity, &r)
             || (glass_may_come(l, gap, velocity) && fabs(gap - l->gap) > 1e-9*l->gap);
             press(l, b, &here, taken, *w)) {
            taken *= 0.5;
            if (!(taken > 0.0)) {
                found->status = LAW_UNDECIDED_NOT_FINITE;
                return -1.0;
            }
        }
        double target = passed(l, gap);
        if (target != gap) {
            taken = time_to(l, target, taken, &r);
            press(l, b, &here, taken, *w);
            taken = time_to(l, target, 1.1*taken, &r);
            way(l, &r, taken, &velocity);
            gap = target;
        }
        l->work += r.attraction*(gap - l->gap);
        shear(b, 0.5*(l->gap + gap), &r, taken, w);
        if (l->gap < l->h.film && gap == l->h.film && velocity > 0.0)
            found->events |= LAW_LEAVES_FILM;
        l->gap = gap;
        l->velocity = velocity;
        s->smallest_gap = gap < s->smallest_gap ? gap : s->smallest_gap;
        left -= taken;
    }
    return -1.0;
}

static void unforced(law_pair_force *found, int status)
{
    double value = status == LAW_OK ? 0.0 : NAN;
    found->status = status;
    found->events = 0;
    found->outcome = LAW_UNDECIDED;
    found->gap = found->restitution = NAN;
    for (int k = 0; k < 3; k++)
        found->force[k] = found->torques[0][k] = found->torques[1][k] = value;
}

static int bad_motion(const law_pair_motion *given, double dt)
{
    const double most = 1e100; /* squares and products of numbers below it are numbers */
    double distance = largest(vector_of(given->position)), sum = largest(vector_of(given->velocity));
    if (!(distance >= 1.0/most && distance <= most))
        return LAW_NO_DIRECTION;
    for (int k = 0; k < 2; k++) {
        sum += largest(vector_of(given->spins[k]));
        sum += largest(vector_of(given->forces[k])) + largest(vector_of(given->torques[k]));
    }
    if (!(sum < most))
        return LAW_NOT_A_NUMBER;
    return dt >= 1.0/most && dt <= most ? LAW_OK : LAW_BAD_STEP;
}

static int known_speed(const bodies *b, double speed)
{
    return speed*b->stokes_per_speed >= 1.0/FURTHEST && speed*b->stokes_per_speed <= FURTHEST;
}

int law_contact_join(const law_material *material, double gap, double speed, law_pair_history *history)
{
    space_held h;
    bodies b = bodies_of(material);
    int status = check_material(material);
    if (status == LAW_OK && !known_speed(&b, speed))
        status = LAW_OUT_OF_RANGE;
    if (status != LAW_OK)
        return status;
    space_hold(&h, material, speed);
    if (!(gap >= h.contact && gap < h.end))
        return LAW_NOT_IN_CONTACT;
    join(history, gap, speed);
    return LAW_OK;
}

/* Begins the contact of a pair whose films touch before the end of the step. Returns for how long it acts, 0 if there is
 * none. */
static double begins(const law_material *material, const bodies *b, vector3 apart, vector3 moving, double dt,
                     law_pair_history *s, law_pair_force *found)
{
    double touch = time_to_touch(b, apart, moving), gap = length(apart) - b->contact;
    if (!(touch <= 0.5*dt))
        return 0.0;
    double speed = -dot(unit(apart), moving);
    if (touch >= -1.5*dt) {
        speed = -dot(unit(plus(apart, touch, moving)), moving);
        gap = b->film;
    } else
        touch = -0.5*dt; /* it cannot have come so far in a step: it is taken as it is */
    if (!(speed > 0.0))
        return 0.0;
    found->status = check_material(material);
    if (found->status != LAW_OK)
        return 0.0;
    join(s, gap, known_speed(b, speed) ? speed : 1.0/FURTHEST/b->stokes_per_speed);
    found->events = LAW_BEGINS;
    return 0.5*dt - touch;
}

/* A step of the host: what it gives, SI, and from when to when the contact acts, beside the time of the positions. */
typedef struct {
    vector3 n, moving, load, spin[2], torque[2]; /* `load`: of all else on the relative motion */
    double distance, along, dt, start, end;
} span;

static span span_of(const bodies *b, const law_pair_motion *given, double dt, double acts)
{
    span made;
    vector3 apart = vector_of(given->position);
    made.distance = length(apart);
    made.n = times(1.0/made.distance, apart);
    made.moving = vector_of(given->velocity);
    made.along = dot(made.n, made.moving);
    made.load = times(b->reduced_mass/b->mass[1], vector_of(given->forces[1]));
    made.load = plus(made.load, -b->reduced_mass/b->mass[0], vector_of(given->forces[0]));
    for (int k = 0; k < 2; k++) {
        made.spin[k] = vector_of(given->spins[k]);
        made.torque[k] = times(1.0/b->inertia[k], vector_of(given->torques[k]));
    }
    made.dt = dt;
    made.start = 0.5*dt - acts;
    made.end = 0.5*dt;
    return made;
}

/* The relative velocity across the line, times the distance, after a part of the step's load. */
static vector3 moment_of(const bodies *b, const span *h, double time)
{
    return times(h->distance, cross(h->n, plus(h->moving, time/b->reduced_mass, h->load)));
}

/* What rotates as the contact begins to act: half the load is on it, and the axes are those of the line then. */
static whirl whirl_of(const bodies *b, const span *h)
{
    whirl made;
    double half = 0.5*(0.5*h->dt - h->start);
    vector3 then = unit(plus(times(h->distance, h->n), h->start, h->moving));
    made.n = h->n;
    made.moment = moment_of(b, h, half);
    for (int k = 0; k < 2; k++) {
        vector3 spin = turned(plus(h->spin[k], half, h->torque[k]), then, h->n);
        made.twist[k] = dot(h->n, spin);
        made.spin[k] = across(spin, h->n);
    }
    return made;
}

/* The impulses of the torques, across the line of the host's positions, that leave the spins across the line at the end
 * as they are there, as far as energy is lost or there is `spare`. Returns the energy that they add, below zero but in
 * large steps. */
static double torque_impulses(const bodies *b, const span *h, const whirl *w, double opens, double spare,
                              vector3 impulse[2])
{
    vector3 aside = cross(w->moment, h->n), then, sum = times(0.0, h->n), slip;
    double apart = 1.0/h->distance, gain = 0.0, part = 1.0;
    then = unit(plus(times(h->distance + h->end*opens, h->n), h->end*apart, aside));
    for (int k = 0; k < 2; k++) {
        vector3 free = plus(h->spin[k], h->end - h->start, h->torque[k]), back = turned(w->spin[k], h->n, then);
        back = plus(back, dot(h->n, plus(free, -1.0, back))/fmax(dot(h->n, then), 0.1), then);
        impulse[k] = times(b->inertia[k], across(plus(back, -1.0, free), h->n));
        sum = plus(sum, 1.0, impulse[k]);
    }
    double cost = 0.5*apart*apart/b->reduced_mass*dot(sum, sum);
    for (int k = 0; k < 2; k++) {
        slip = plus(plus(h->spin[k], 0.5*h->dt, h->torque[k]), -apart*apart, moment_of(b, h, 0.5*h->dt));
        gain += dot(impulse[k], slip);
        cost += 0.5*dot(impulse[k], impulse[k])/b->inertia[k];
    }
    spare = fmax(spare, 0.0);
    if (gain + cost > spare)
        part = 0.5*(sqrt(gain*gain + 4.0*cost*spare) - gain)/cost;
    for (int k = 0; k < 2; k++)
        impulse[k] = times(part, impulse[k]);
    return part*(gain + part*cost);
}

/* The velocity along the line that the host is to have after the step. */
static double velocity_after(const bodies *b, const span *h, const line *l, const law_pair_history *s, double sideways)
{
    double wanted = l->velocity, lag, after;
    if (s->joined) {
        lag = length(plus(times(h->distance, h->n), -0.5*h->dt, h->moving)) - b->contact - s->gap;
        if (fabs(lag) > SLACK*b->film && h->start == -0.5*h->dt)
            wanted -= RETURN*(lag - (lag > 0.0 ? SLACK : -SLACK)*b->film)/h->dt;
        return held_velocity(h->distance, wanted, sideways, h->end);
    }
    /* as energy has it at the host's distance, which may be another than the contact's */
    after = held_velocity(h->distance, wanted, sideways, h->end);
    double there = hypot(h->distance + h->end*after, h->end*sideways), then = b->contact + l->gap;
    double moment = h->distance*sideways, square = wanted*wanted + moment*moment*(1.0/(then*then) - 1.0/(there*there));
    after = held_velocity(h->distance, sqrt(fmax(square, 0.0)), sideways, h->end);
    return after + l->others/l->mass*(0.5*h->dt - h->end);
}

int law_contact_force(const law_material *material, const law_pair_motion *motion, double dt, law_pair_history *history,
                      law_pair_force *found)
{
    bodies b = bodies_of(material);
    law_pair_history s = *history;
    double acts = dt;
    unforced(found, bad_motion(motion, dt));
    if (found->status == LAW_OK && !(b.contact + b.film < INFINITY && b.film > 0.0))
        unforced(found, check_material(material));
    if (found->status != LAW_OK)
        return found->status;
    if (!s.joined) {
        acts = begins(material, &b, vector_of(motion->position), vector_of(motion->velocity), dt, &s, found);
        if (!s.joined) {
            unforced(found, found->status);
            found->gap = length(vector_of(motion->position)) - b.contact;
            return found->status;
        }
    }
    if (!(s.joined == 1 && s.gap > 0.0 && known_speed(&b, s.speed) && s.spare >= 0.0
            && s.spare + fabs(s.lead) < INFINITY)) {
        unforced(found, LAW_BAD_HISTORY);
        return found->status;
    }
    span h = span_of(&b, motion, dt, acts);
    whirl w = whirl_of(&b, &h);
    line l;
    space_hold(&l.h, material, s.speed);
    l.mass = b.reduced_mass;
    l.others = dot(h.n, h.load);
    l.work = 0.0;
    l.gap = s.gap > l.h.contact ? s.gap : l.h.contact;
    l.velocity = opening(h.distance, h.along, length(cross(h.n, h.moving)), h.start);
    l.velocity += l.others/l.mass*(dt - acts) - s.lead;
    double until = follow_line(&l, &b, acts, &s, &w, found);
    if (found->status != LAW_OK) {
        unforced(found, found->status);
        return found->status;
    }
    vector3 impulse[2];
    h.end = s.joined ? 0.5*dt : h.start + until;
    w.moment = plus(w.moment, 1.0, plus(moment_of(&b, &h, dt), -1.0, moment_of(&b, &h, 0.5*acts)));
    double sideways = length(w.moment)/h.distance, opens = held_velocity(h.distance, l.velocity, sideways, h.end);
    s.spare -= l.work;
    s.spare -= torque_impulses(&b, &h, &w, opens, s.spare, impulse);
    vector3 whole = plus(impulse[0], 1.0, impulse[1]);
    sideways = length(plus(moment_of(&b, &h, dt), -1.0/l.mass, whole))/h.distance;
    double after = velocity_after(&b, &h, &l, &s, sideways);
    after = afforded(l.mass, h.along, after, l.others/l.mass*dt, s.spare);
    double pushed = l.mass*(after - h.along) - l.others*dt;
    s.spare = fmax(s.spare - 0.5*pushed*(after + h.along), 0.0);
    s.lead = s.joined ? opening(h.distance, after, sideways, 0.5*dt) - l.velocity : 0.0;
    s.gap = l.gap;
    s.time += s.joined ? acts : until;
    put_vector(found->force, times(1.0/dt, plus(times(pushed, h.n), -1.0/h.distance, cross(whole, h.n))));
    for (int k = 0; k < 2; k++)
        put_vector(found->torques[k], times(1.0/dt, impulse[k]));
    found->gap = s.gap;
    if (!s.joined) {
        found->restitution = l.velocity/s.speed;
        found->outcome = s.rebound == LAW_NO_REBOUND ? LAW_STICK_ROTATE_SEPARATE : LAW_BOUNCE;
    }
    if (!(largest(vector_of(found->force)) + largest(impulse[0]) + largest(impulse[1]) + s.spare + s.gap < INFINITY)) {
        unforced(found, LAW_UNDECIDED_NOT_FINITE);
        return found->status;
    }
    *history = s;
    return LAW_OK;
}
