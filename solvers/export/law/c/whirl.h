/* What rotates with a contact, and straight paths before it. */

/* What rotates, in axes that turn with the line of centres `n`: the orbital momentum over the reduced mass, spins across
 * the line and along it. */
typedef struct {
    vector3 n, moment, spin[2];
    double twist[2];
} whirl;

/* A whirl under the torques of the film, at a gap: the exact motion with constant coefficients. Twist comes across the
 * line as that turns away from it. */
static void shear(const bodies *b, double gap, const space_response *r, double time, whirl *w)
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

/* Friction of the dry contact: an impulse against the slip of the surfaces, at mid-gap, that turns a part of it around, or
 * the largest that there is. */
static void rub(const bodies *b, double gap, double most, double returns, whirl *w)
{
    double distance = b->contact + gap, compliance = 1.0/b->reduced_mass;
    vector3 turning = times(1.0/(distance*distance), w->moment), slip = times(0.0, w->n), impulse;
    for (int k = 0; k < 2; k++) {
        double arm = distance*b->radius[k]/b->contact;
        compliance += arm*arm/b->inertia[k];
        slip = plus(slip, arm, plus(turning, -1.0, w->spin[k]));
    }
    double sticking = (1.0 + returns)/compliance*length(slip);
    impulse = times((1.0 + returns)/compliance*(sticking <= most ? 1.0 : most/sticking), slip);
    for (int k = 0; k < 2; k++)
        w->spin[k] = plus(w->spin[k], distance*b->radius[k]/(b->contact*b->inertia[k]), impulse);
    w->moment = plus(w->moment, -distance/b->reduced_mass, impulse);
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
        return HUGE_VAL;
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

