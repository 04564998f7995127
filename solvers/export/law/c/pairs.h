/* Pairs at initial contact: what is refused, the relative motion, and whether all of it lies in one plane. */
#pragma once

#include "automaton.h"
#include "vector3.h"

enum { PAIRS = 64 }; /* of a batch, that are on the stack together */
static const double FURTHEST = 1e100; /* products and quotients of groups stay within a double's range */

/* Two spheres, or a sphere and a wall, whose index is 1. */
typedef struct {
    double mass[2], radius[2], inertia[2]; /* kg, m, kg m^2 about a diameter; unused of a wall */
    double reduced_mass, film, contact;    /* kg, thickness of the film and distance of the centres at zero gap, m */
    double stokes_per_speed;               /* s/m */
    int wall;
} bodies;

static bodies bodies_with(double a, double m, double size, double weight, double film, double viscosity, int wall)
{
    bodies made;
    made.wall = wall;
    made.reduced_mass = m;
    made.film = film;
    made.stokes_per_speed = m/(6.0*3.141592653589793*a*a*viscosity);
    made.mass[0] = wall ? m : m*(1.0 + weight)/weight;
    made.mass[1] = m*(1.0 + weight);
    made.radius[0] = wall ? a : a*(1.0 + size)/size;
    made.radius[1] = a*(1.0 + size);
    made.contact = wall ? a : made.radius[0] + made.radius[1];
    for (int k = 0; k < 2; k++)
        made.inertia[k] = 0.4*made.mass[k]*made.radius[k]*made.radius[k];
    return made;
}

/* A pair at initial contact, in the laboratory's axes. */
typedef struct {
    vector3 normal; /* unit vector from the first to the second */
    vector3 velocity[2], spin[2];
    vector3 sliding; /* velocity of the second against the first, across the normal, m/s */
    vector3 turning; /* angular velocity of the line of centres, rad/s */
    double speed;    /* at which the gap closes, m/s */
} arrival;

static double larger(double p, double q)
{
    return p > q ? p : q;
}

/* The arrival of a pair; a status, LAW_OK if it can collide. */
static int arrives(const bodies *b, const law_pair *given, arrival *a)
{
    vector3 n = vector_of(given->normal);
    double size = largest(n), fastest, spinning = 0.0;
    if (!(size > 0.0 && size < HUGE_VAL))
        return LAW_NO_DIRECTION;
    n.x /= size; /* no square overflows */
    n.y /= size;
    n.z /= size;
    a->normal = times(1.0/length(n), n);
    for (int k = 0; k < 2; k++) {
        a->velocity[k] = vector_of(given->velocities[k]);
        a->spin[k] = vector_of(given->spins[k]);
    }
    if (b->wall)
        a->spin[1] = times(0.0, a->normal);
    for (int k = 0; k < 2; k++) {
        double spins = largest(a->spin[k]);
        if (!(largest(a->velocity[k]) < HUGE_VAL && spins < HUGE_VAL))
            return LAW_NOT_A_NUMBER;
        spinning = larger(spinning, spins*b->radius[k]);
    }
    fastest = larger(largest(a->velocity[0]), largest(a->velocity[1]));
    if (fastest > 1e150) /* its square is no number */
        return LAW_OUT_OF_RANGE;
    vector3 relative = plus(a->velocity[1], -1.0, a->velocity[0]);
    a->speed = -dot(a->normal, relative);
    if (!(a->speed > 0.0))
        return LAW_NOT_APPROACHING;
    double stokes = a->speed*b->stokes_per_speed;
    if (!(stokes >= 1.0/FURTHEST && stokes <= FURTHEST && spinning <= FURTHEST*a->speed))
        return LAW_OUT_OF_RANGE;
    a->sliding = plus(relative, a->speed, a->normal);
    if (!(length(a->sliding) > TURNLESS*fastest)) /* a head-on collision is one in every direction */
        a->sliding = times(0.0, a->normal);
    if (!(length(a->sliding) <= FURTHEST*a->speed))
        return LAW_OUT_OF_RANGE;
    a->turning = times(1.0/(b->contact + b->film), cross(a->normal, a->sliding));
    return LAW_OK;
}

/* Where all rotation is along one direction across the line of centres, motion stays in a plane. */
typedef struct {
    int is_plane;
    vector3 axis;            /* of all rotation; zero if nothing rotates */
    double turning, spin[2]; /* components along it, rad/s */
} plane;

static plane plane_of(const bodies *b, const arrival *a)
{
    plane made;
    vector3 chosen = a->turning;
    double size[3], most, given, aside;
    size[0] = length(a->sliding);
    for (int k = 0; k < 2; k++)
        size[1 + k] = b->radius[k]*length(a->spin[k]);
    most = larger(size[0], larger(size[1], size[2]));
    aside = size[0];
    for (int k = 0; k < 2; k++)
        aside = larger(aside, b->radius[k]*length(across(a->spin[k], a->normal)));
    made.is_plane = aside <= TURNLESS*most;
    made.axis = times(0.0, a->normal);
    made.turning = made.spin[0] = made.spin[1] = 0.0;
    if (made.is_plane) /* nothing turns the line of centres: no torque acts on twist */
        return made;
    if (!(size[0] > TURNLESS*most))
        chosen = a->spin[size[2] > size[1]];
    chosen = across(chosen, a->normal);
    given = length(chosen);
    if (!(given > 0.0)) /* the faster spin is twist alone */
        return made;
    made.axis = times(1.0/given, chosen);
    made.turning = dot(a->turning, made.axis);
    given = larger(most, larger(largest(a->velocity[0]), largest(a->velocity[1])));
    most = (b->contact + b->film)*length(plus(a->turning, -made.turning, made.axis));
    for (int k = 0; k < 2; k++) {
        made.spin[k] = dot(a->spin[k], made.axis);
        most = larger(most, b->radius[k]*length(plus(a->spin[k], -made.spin[k], made.axis)));
    }
    made.is_plane = most <= TURNLESS*given;
    return made;
}
