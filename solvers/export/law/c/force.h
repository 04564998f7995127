/* A contact as a force over the steps of a host: the pair's own motion along its line of centres, which is held for a
 * step, is followed within the step, film and bridge implicitly; its impulse over the step's length is returned.
 * The centrifugal force is the host's: positions move along straight lines from one step to the next.
 */

static const double SLACK = 0.25;       /* that the host's gap may differ from the contact's, over the film */
static const double RETURN = 0.2;       /* part of what exceeds it that a step takes back */

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
static void press(line *l, const bodies *b, const space_response *r, double time, whirl w)
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
        space_response r, here;
        double gap, velocity, taken = left;
        if (k == SUBSTEPS || !(fabs(l->velocity) + dot(w->moment, w->moment) < HUGE_VAL)) {
            found->status = k == SUBSTEPS ? LAW_UNDECIDED_NO_BUDGET : LAW_UNDECIDED_NOT_FINITE;
            return -1.0;
        }
        int solid = l->gap <= l->h.contact;
        if (l->velocity < 0.0 && (solid || !(space_glass_clears(&l->h, l->gap, l->velocity) > 0.0))) {
            double before = l->velocity;
            meet(l, s, found, solid ? space_solid_kind(&l->h) : LAW_GLASS, &rebounds);
            if (l->h.friction != 0.0 && (solid || l->h.rubs_glass))
                rub(b, l->gap, l->h.friction*l->mass*(l->velocity - before), l->h.returns, w);
        }
        if (l->velocity > 0.0 && l->gap >= l->h.end) {
            s->joined = 0;
            found->events |= LAW_SEPARATES;
            return time - left;
        }
        here = space_mean_response(&l->h, l->gap, l->gap, l->velocity);
        press(l, b, &here, 0.0, *w);
        if (l->gap <= l->h.contact && l->velocity == 0.0 && l->load <= here.attraction) {
            shear(b, l->gap, &here, left, w); /* at rest in contact */
            if (l->h.friction != 0.0)
                rub(b, l->gap, l->h.friction*(here.attraction - l->load)*left, 0.0, w);
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
    double value = status == LAW_OK ? 0.0 : (double)NAN;
    found->status = status;
    found->events = 0;
    found->outcome = LAW_UNDECIDED;
    found->gap = found->restitution = (double)NAN;
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
    double meeting = time_to_touch(b, apart, moving), gap = length(apart) - b->contact;
    space_held h;
    if (!(meeting <= 0.5*dt))
        return 0.0;
    double speed = -dot(unit(apart), moving);
    if (meeting >= -1.5*dt) {
        speed = -dot(unit(plus(apart, meeting, moving)), moving);
        gap = b->film;
    } else
        meeting = -0.5*dt; /* it cannot have come so far in a step: it is taken as it is */
    if (!(speed > 0.0))
        return 0.0;
    found->status = check_material(material);
    if (found->status != LAW_OK)
        return 0.0;
    speed = known_speed(b, speed) ? speed : 1.0/FURTHEST/b->stokes_per_speed;
    space_hold(&h, material, speed);
    /* others may have pushed the host's spheres into each other: its distance is led back to a contact of solids */
    join(s, fmax(gap, h.contact > 0.0 ? h.contact : 1e-3*b->film), speed);
    found->events = LAW_BEGINS;
    return 0.5*dt - meeting;
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
    if (found->status == LAW_OK && !(b.contact + b.film < HUGE_VAL && b.film > 0.0))
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
            && s.spare + fabs(s.lead) < HUGE_VAL)) {
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
    if (!(largest(vector_of(found->force)) + largest(impulse[0]) + largest(impulse[1]) + s.spare + s.gap < HUGE_VAL)) {
        unforced(found, LAW_UNDECIDED_NOT_FINITE);
        return found->status;
    }
    *history = s;
    return LAW_OK;
}

