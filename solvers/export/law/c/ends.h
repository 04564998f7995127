/* From the end of the relative motion to both particles in the laboratory: what is conserved stays so to rounding. */
#pragma once

#include "pairs.h"

/* The end of a collision, SI. */
typedef struct {
    int status, outcome, certified;
    double time, gap, opening, slip; /* s, m, normal relative velocity, m/s, and the restitution of slip */
    vector3 normal, turning, spin[2];
    vector3 sliding; /* beside a wall: velocity along it, m/s */
} ending;

/* A stick's end is at initial contact, at time 0: where its integration stops depends on tolerance and rounding. */
static ending as_arrived(const bodies *b, const arrival *a)
{
    ending made;
    made.status = LAW_OK;
    made.outcome = LAW_STICK;
    made.certified = 1;
    made.time = 0.0;
    made.gap = b->film;
    made.opening = -a->speed;
    made.slip = (double)NAN;
    made.normal = a->normal;
    made.turning = a->turning;
    made.sliding = times(-1.0, a->sliding);
    made.spin[0] = a->spin[0];
    made.spin[1] = a->spin[1];
    return made;
}

/* Two spheres. A stick keeps its angular momentum: across the line of centres it turns with the inertia that the doublet
 * has there. Twist has no friction to leading logarithm: along the line each sphere keeps its own spin, and the
 * doublet's angular velocity has their mean by inertia.
 */
static void spheres_after(const bodies *b, const arrival *a, const ending *e, law_pair_after *made)
{
    int sticks = e->outcome == LAW_STICK;
    vector3 n = times(1.0/length(e->normal), e->normal);
    double apart = b->contact + e->gap, m = b->reduced_mass, whole = b->mass[0] + b->mass[1];
    double both = b->inertia[0] + b->inertia[1];
    vector3 relative = plus(a->velocity[1], -1.0, a->velocity[0]), rest, rigid, turning, spin[2];
    vector3 momentum = times(m*(b->contact + b->film), cross(a->normal, relative));
    vector3 centre = times(b->mass[0]/whole, a->velocity[0]);
    centre = plus(centre, b->mass[1]/whole, a->velocity[1]);
    for (int k = 0; k < 2; k++)
        momentum = plus(momentum, b->inertia[k], a->spin[k]);
    rigid = times(1.0/(m*apart*apart + both), across(momentum, n));
    turning = sticks ? rigid : across(e->turning, n);
    rest = plus(momentum, -m*apart*apart, turning);
    for (int k = 0; k < 2; k++) {
        spin[k] = sticks ? plus(rigid, dot(e->spin[k], n), n) : e->spin[k];
        rest = plus(rest, -b->inertia[k], spin[k]);
    }
    int heavy = b->inertia[1] > b->inertia[0]; /* its spin takes what rounding leaves of the angular momentum */
    spin[heavy] = plus(spin[heavy], 1.0/b->inertia[heavy], rest);
    relative = times(apart, cross(turning, n));
    if (!sticks)
        relative = plus(relative, e->opening, n);
    put_vector(made->position, times(apart, n));
    put_vector(made->centre_velocity, centre);
    put_vector(made->velocities[0], plus(centre, -b->mass[1]/whole, relative));
    put_vector(made->velocities[1], plus(centre, b->mass[0]/whole, relative));
    for (int k = 0; k < 2; k++)
        put_vector(made->spins[k], spin[k]);
    if (sticks)
        put_vector(made->angular_velocity, plus(rigid, dot(momentum, n)/both, n));
}

/* A sphere and a wall, whose velocity stays; a stick neither slides nor rolls on. */
static void sphere_after(const bodies *b, const arrival *a, const ending *e, law_pair_after *made)
{
    int sticks = e->outcome == LAW_STICK;
    vector3 n = a->normal, twist = times(dot(e->spin[0], n), n), leaves = a->velocity[1];
    if (!sticks)
        leaves = plus(plus(leaves, 1.0, e->sliding), -e->opening, n);
    put_vector(made->position, times(b->contact + e->gap, n));
    put_vector(made->centre_velocity, a->velocity[1]);
    put_vector(made->velocities[0], leaves);
    put_vector(made->velocities[1], a->velocity[1]);
    put_vector(made->spins[0], sticks ? twist : e->spin[0]);
    if (sticks)
        put_vector(made->angular_velocity, twist);
}

static void unknown(double *numbers, int count)
{
    while (count--)
        *numbers++ = (double)NAN;
}

/* Nothing known but a status. */
static void refuse(int status, law_pair_after *made)
{
    made->status = status;
    made->outcome = LAW_UNDECIDED;
    made->certified = 0;
    made->restitution = made->slip_restitution = made->time = made->gap = (double)NAN;
    unknown(made->position, 3);
    unknown(made->normal, 3);
    for (int k = 0; k < 2; k++) {
        unknown(made->velocities[k], 3);
        unknown(made->spins[k], 3);
    }
    unknown(made->centre_velocity, 3);
    unknown(made->angular_velocity, 3);
}

/* Twice the kinetic energy, relative to the centre of mass or to the wall. */
static double energy_of(const bodies *b, const double (*velocities)[3], const double (*spins)[3])
{
    vector3 relative = plus(vector_of(velocities[1]), -1.0, vector_of(velocities[0]));
    double found = b->reduced_mass*dot(relative, relative);
    for (int k = 0; k < (b->wall ? 1 : 2); k++)
        found += b->inertia[k]*dot(vector_of(spins[k]), vector_of(spins[k]));
    return found;
}

/* Both particles after a collision; a motion that is not finite, or has energy from nowhere, is a failure. */
static void both_after(const bodies *b, const arrival *a, const ending *end, law_pair_after *made)
{
    const ending arrived = as_arrived(b, a), *e = end->outcome == LAW_STICK ? &arrived : end;
    refuse(end->status, made);
    if (end->status != LAW_OK)
        return;
    if (b->wall)
        sphere_after(b, a, e, made);
    else
        spheres_after(b, a, e, made);
    vector3 place = vector_of(made->position);
    double sum = e->gap + e->time + largest(place);
    for (int k = 0; k < 2; k++) {
        sum += largest(vector_of(made->velocities[k]));
        if (!(b->wall && k))
            sum += largest(vector_of(made->spins[k]));
    }
    double before[2][2][3], grown = ENERGY_MAY_GROW ? HUGE_VAL : 1.0 + 1e-3; /* far beyond any tolerance */
    for (int k = 0; k < 2; k++) {
        put_vector(before[0][k], a->velocity[k]);
        put_vector(before[1][k], a->spin[k]);
    }
    grown *= energy_of(b, (const double (*)[3])before[0], (const double (*)[3])before[1]);
    if (!(fabs(sum) < HUGE_VAL
            && energy_of(b, (const double (*)[3])made->velocities, (const double (*)[3])made->spins) <= grown)) {
        refuse(LAW_UNDECIDED_NOT_FINITE, made);
        return;
    }
    made->outcome = e->outcome;
    made->certified = end->certified;
    made->restitution = e->outcome == LAW_STICK ? 0.0 : e->opening/a->speed;
    made->slip_restitution = e->outcome == LAW_STICK ? (double)NAN : e->slip;
    made->time = e->time;
    made->gap = e->gap;
    put_vector(made->normal, times(1.0/length(place), place));
}
