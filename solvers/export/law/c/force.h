/* A contact as a force over the steps of a host: the pair's own motion along its line of centres, which is held for a step,
 * is followed within the step, film and bridge implicitly; what is returned is its impulse over the step's length.
 *
 * Every substep is the exact motion under the means of resistance and attraction over the gaps that it passes, so that the
 * momentum that the film takes and the work of the attractions are those between these gaps, and energy is never created.
 * The centrifugal force is the host's: positions move along straight lines from one step to the next.
 */
#pragma once

#include "ends.h"

enum { SUBSTEPS = 20000, REBOUNDS = 8 }; /* most in a step; more rebounds are rest */
static const double WIDEST = 0.5;       /* change of the gap in a substep, over the gap */
static const double SLACK = 0.25;       /* that the host's gap may differ from the contact's, over the film's thickness */
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
static void meet(line *l, law_history *s, law_force *found, int kind, int *rebounds)
{
    l->velocity = ++*rebounds > REBOUNDS ? 0.0 : space_rebounds_with(&l->h, l->velocity);
    if (s->rebound == LAW_NO_REBOUND)
        s->rebound = kind;
    found->events |= LAW_REBOUNDS;
}

/* What rotates, in axes that turn with the line of centres `n`: the orbital momentum over the reduced mass, spins across the
 * line and along it, and the torques' impulses so far. */
typedef struct {
    vector3 n, moment, spin[2], impulse[2];
    double twist[2];
} whirl;

/* A whirl under the torques of the film, at a gap: the exact motion with constant coefficients. Twist comes across the line
 * as that turns away from it. */
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
        double slow = k ? decayed(least*time) : exp(-least*time), fast = k ? decayed((half + root)*time) : exp(-(half + root)*time);
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
        w->impulse[k] = plus(w->impulse[k], 1.0, given);
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

/* The time from now to when the films touch on straight paths, negative for a pair that is found late; infinite if never. */
static double time_to_touch(const bodies *b, vector3 apart, vector3 moving)
{
    double distance = b->contact + b->film, square = dot(moving, moving), along = dot(apart, moving);
    double beyond = dot(apart, apart) - distance*distance, root = along*along - square*beyond;
    if (!(root >= 0.0 && square > 0.0))
        return INFINITY;
    root = sqrt(root);
    return along < 0.0 ? beyond/(root - along) : (-along - root)/square;
}

static double closing(vector3 apart, vector3 moving)
{
    return -dot(apart, moving)/length(apart);
}

/* The velocity of the gap after a time on a straight line, from a distance, with velocities along and across the line. */
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
static void join(law_history *s, double gap, double speed)
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
static double follow_line(line *l, const bodies *b, double time, law_history *s, whirl *w, law_force *found)
{
    double left = time;
    int rebounds = 0;
    for (int k = 0; left > 0.0; k++) {
        response r, here;
        double gap, velocity, taken = left;
        if (k == SUBSTEPS) {
            found->status = LAW_UNDECIDED_NO_BUDGET;
            return -1.0;
        }
        if (l->velocity < 0.0 && l->gap <= l->h.contact)
            meet(l, s, found, space_solid_kind(&l->h), &rebounds);
        else if (l->velocity < 0.0 && !(space_glass_clears(&l->h, l->gap, l->velocity) > 0.0))
            meet(l, s, found, LAW_GLASS, &rebounds);
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
             press(l, b, &here, taken, *w))
            taken *= 0.5;
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
        if (gap >= l->h.end && velocity > 0.0) {
            s->joined = 0;
            found->events |= LAW_SEPARATES;
            return time - left;
        }
    }
    return -1.0;
}

static void unforced(law_force *found, int status, double value)
{
    memset(found, 0, sizeof *found);
    found->status = status;
    found->outcome = LAW_UNDECIDED;
    found->gap = found->restitution = NAN;
    put_vector(found->force, times(value, vector_of(found->force)));
    for (int k = 0; k < 3; k++)
        found->force[k] = found->torques[0][k] = found->torques[1][k] = value;
}

static int bad_motion(const law_motion *given, double dt)
{
    double most = largest(vector_of(given->position));
    if (!(most > 0.0 && most < 1e150))
        return LAW_NO_DIRECTION;
    most = largest(vector_of(given->velocity));
    for (int k = 0; k < 2; k++)
        most = larger(most, larger(largest(vector_of(given->spins[k])),
            larger(largest(vector_of(given->forces[k])), largest(vector_of(given->torques[k])))));
    if (!(most < 1e100))
        return LAW_NOT_A_NUMBER;
    for (int k = 0; k < 2; k++)
        if (!(largest(vector_of(given->spins[k])) + largest(vector_of(given->forces[k])) + largest(vector_of(given->torques[k])) < INFINITY))
            return LAW_NOT_A_NUMBER;
    return dt > 0.0 && dt < INFINITY ? LAW_OK : LAW_BAD_STEP;
}

int law_contact_join(const law_material *material, double gap, double speed, law_history *history)
{
    space_held h;
    int status = check_material(material);
    if (status != LAW_OK)
        return status;
    if (!(speed*bodies_of(material).stokes_per_speed >= 1.0/FURTHEST && speed*bodies_of(material).stokes_per_speed <= FURTHEST))
        return LAW_OUT_OF_RANGE;
    space_hold(&h, material, speed);
    if (!(gap >= h.contact && gap < h.end))
        return LAW_NOT_IN_CONTACT;
    join(history, gap, speed);
    return LAW_OK;
}

/* Begins the contact of a pair whose films touch before the middle of the coming step; returns for how long it acts. */
static double begins(const law_material *material, const bodies *b, vector3 apart, vector3 moving, double dt,
                     law_history *s, law_force *found)
{
    double touch = time_to_touch(b, apart, moving), gap = length(apart) - b->contact, slowest = 1e-90/b->stokes_per_speed;
    double speed = closing(apart, moving);
    if (!(touch <= 0.5*dt) || (gap < b->film && !(speed > 0.0)))
        return 0.0;
    if (touch >= -1.5*dt) {
        gap = b->film;
        speed = closing(plus(apart, touch, moving), moving);
    } else
        touch = -0.5*dt; /* found where it cannot have come to in a step: it is taken as it is */
    if (!(speed > 0.0))
        return 0.0;
    found->status = check_material(material);
    if (found->status != LAW_OK)
        return 0.0;
    join(s, gap, larger(speed, slowest));
    found->events |= LAW_BEGINS;
    return 0.5*dt - touch;
}

int law_contact_force(const law_material *material, const law_motion *given, double dt, law_history *history,
                      law_force *found)
{
    bodies b = bodies_of(material);
    law_history s = *history;
    int wrong = bad_motion(given, dt);
    unforced(found, wrong, wrong == LAW_OK ? 0.0 : NAN);
    if (wrong == LAW_OK && !(b.contact + b.film < INFINITY && b.film > 0.0))
        unforced(found, check_material(material), NAN);
    if (found->status != LAW_OK)
        return found->status;
    vector3 apart = vector_of(given->position), moving = vector_of(given->velocity);
    double distance = length(apart), acts = dt;
    vector3 n = times(1.0/distance, apart);
    if (!s.joined) {
        acts = begins(material, &b, apart, moving, dt, &s, found);
        if (!s.joined) {
            if (found->status != LAW_OK)
                unforced(found, found->status, NAN);
            found->gap = distance - b.contact;
            return found->status;
        }
    }
    line l;
    space_hold(&l.h, material, s.speed);
    if (!(s.gap > 0.0 && s.gap <= l.h.end && s.speed > 0.0 && s.spare >= 0.0 && fabs(s.lead) < INFINITY)) {
        unforced(found, LAW_BAD_HISTORY, NAN);
        return found->status;
    }
    /* all else, as a load of the relative motion */
    vector3 load = times(b.reduced_mass/b.mass[1], vector_of(given->forces[1]));
    load = plus(load, -b.reduced_mass/b.mass[0], vector_of(given->forces[0]));
    double before = dot(n, moving), sideways = length(cross(n, moving)), start = 0.5*dt - acts;
    double lag = length(plus(apart, -0.5*dt, moving)) - b.contact - s.gap;
    l.mass = b.reduced_mass;
    l.others = dot(n, load);
    l.gap = s.gap > l.h.contact ? s.gap : l.h.contact;
    l.velocity = opening(distance, before, sideways, start) - s.lead + l.others/l.mass*(dt - acts);
    l.work = 0.0;
    whirl w;
    w.n = n;
    w.moment = times(distance, cross(n, plus(moving, 0.5*acts/l.mass, load)));
    for (int k = 0; k < 2; k++) {
        w.impulse[k] = times(0.0, n);
        vector3 given_spin = plus(vector_of(given->spins[k]), 0.5*acts/b.inertia[k], vector_of(given->torques[k]));
        given_spin = turned(given_spin, unit(plus(apart, start, moving)), n);
        w.twist[k] = dot(n, given_spin);
        w.spin[k] = across(given_spin, n);
    }
    double until = follow_line(&l, &b, acts, &s, &w, found);
    if (found->status != LAW_OK) {
        unforced(found, found->status, NAN);
        return found->status;
    }
    double end = s.joined ? 0.5*dt : start + until, wanted = l.velocity, after, rubbed = 0.0;
    vector3 across_line = cross(w.moment, n), carried, momentum = times(distance, cross(n, plus(moving, dt/l.mass, load))), sum = times(0.0, n);
    sideways = length(across_line)/distance;
    carried = plus(times(distance + end*held_velocity(distance, wanted, sideways, end), n), end/distance, across_line);
    carried = unit(carried);
    for (int k = 0; k < 2; k++) { /* torques across the line that is given, which leave the spins as they are now across it then */
        vector3 free = plus(vector_of(given->spins[k]), acts/b.inertia[k], vector_of(given->torques[k]));
        vector3 back = turned(w.spin[k], n, carried);
        back = plus(back, (dot(n, free) - dot(n, back))/fmax(dot(n, carried), 0.1), carried);
        w.impulse[k] = times(b.inertia[k], across(plus(back, -1.0, free), n));
        sum = plus(sum, 1.0, w.impulse[k]);
    }
    double gain = 0.0, cost = 0.5*dot(sum, sum)/(l.mass*distance*distance), most = fmax(s.spare - l.work, 0.0), part = 1.0;
    for (int k = 0; k < 2; k++) { /* energy that the torques add to the host's motion, below zero but for large steps */
        vector3 slip = plus(vector_of(given->spins[k]), 0.5*dt/b.inertia[k], vector_of(given->torques[k]));
        gain += dot(w.impulse[k], plus(slip, -0.5/distance, plus(cross(n, moving), 1.0, cross(n, plus(moving, dt/l.mass, load)))));
        cost += 0.5*dot(w.impulse[k], w.impulse[k])/b.inertia[k];
    }
    if (gain + cost > most)
        part = 0.5*(sqrt(gain*gain + 4.0*cost*most) - gain)/cost;
    rubbed = part*(gain + part*cost);
    momentum = plus(momentum, -part/l.mass, sum);
    for (int k = 0; k < 2; k++)
        w.impulse[k] = times(part, w.impulse[k]);
    sideways = length(momentum)/distance;
    if (s.joined && fabs(lag) > SLACK*b.film && acts == dt)
        wanted -= RETURN*(lag - (lag > 0.0 ? SLACK : -SLACK)*b.film)/dt;
    after = held_velocity(distance, wanted, sideways, end);
    if (!s.joined) { /* as energy has it at the host's distance */
        double there = hypot(distance + end*after, end*sideways), ends = b.contact + l.gap, moment = distance*sideways;
        double square = wanted*wanted + moment*moment*(1.0/(ends*ends) - 1.0/(there*there));
        after = held_velocity(distance, sqrt(fmax(square, 0.0)), sideways, end) + l.others/l.mass*(0.5*dt - end);
    }
    after = afforded(l.mass, before, after, l.others/l.mass*dt, s.spare - l.work - rubbed);
    double along = l.mass*(after - before) - l.others*dt;
    s.spare = larger(s.spare - l.work - rubbed - 0.5*along*(after + before), 0.0);
    s.gap = l.gap;
    s.time += s.joined ? acts : until;
    s.lead = s.joined ? opening(distance, after, sideways, 0.5*dt) - l.velocity : 0.0;
    vector3 force = times(along/dt, n);
    force = plus(force, -1.0/(distance*dt), cross(plus(w.impulse[0], 1.0, w.impulse[1]), n));
    put_vector(found->force, force);
    for (int k = 0; k < 2; k++)
        put_vector(found->torques[k], times(1.0/dt, w.impulse[k]));
    found->gap = s.gap;
    if (!s.joined) {
        found->restitution = l.velocity/s.speed;
        found->outcome = s.rebound == LAW_NO_REBOUND ? LAW_STICK_ROTATE_SEPARATE : LAW_BOUNCE;
    }
    if (!(largest(force) + largest(w.impulse[0]) + largest(w.impulse[1]) + s.spare < INFINITY)) {
        unforced(found, LAW_UNDECIDED_NOT_FINITE, NAN);
        return found->status;
    }
    *history = s;
    return LAW_OK;
}
