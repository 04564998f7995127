/* Both particles in place: positions, velocities and spins in the laboratory, before a collision and after it. */
#pragma once

#include "in_space.h"

/* Positions after a collision of two spheres: about their centre of mass, which moves on. */
static void move_spheres(const bodies *b, const law_pair_after *after, law_particle *first, law_particle *second)
{
    double whole = b->mass[0] + b->mass[1];
    vector3 apart = vector_of(after->position), centre = times(b->mass[0]/whole, vector_of(first->position));
    centre = plus(centre, b->mass[1]/whole, vector_of(second->position));
    centre = plus(centre, after->time, vector_of(after->centre_velocity));
    put_vector(first->position, plus(centre, -b->mass[1]/whole, apart));
    put_vector(second->position, plus(centre, b->mass[0]/whole, apart));
}

/* Beside a wall: the distance is that of the end; the way along the wall is estimated from the first and last speed. */
static void move_sphere(const law_pair_after *after, law_particle *first, law_particle *wall)
{
    vector3 n = vector_of(after->normal), apart = vector_of(after->position), moving = vector_of(wall->velocity), way;
    way = plus(vector_of(first->velocity), 1.0, vector_of(after->velocities[0]));
    way = times(0.5*after->time, across(plus(way, -2.0, moving), n));
    way = plus(plus(vector_of(wall->position), after->time, moving), 1.0, way);
    put_vector(wall->position, way);
    put_vector(first->position, plus(way, -1.0, apart));
}

int law_collide_particles(
    const law_material *material, law_particle *first, law_particle *second, double rtol, law_pair_after *after)
{
    law_particle *both[2];
    law_pair pair;
    both[0] = first;
    both[1] = second;
    put_vector(pair.normal, plus(vector_of(second->position), -1.0, vector_of(first->position)));
    for (int k = 0; k < 2; k++) {
        memcpy(pair.velocities[k], both[k]->velocity, sizeof pair.velocities[k]);
        memcpy(pair.spins[k], both[k]->spin, sizeof pair.spins[k]);
    }
    if (law_collide_pair(material, &pair, rtol, after) != LAW_OK)
        return after->status;
    bodies b = bodies_of(material);
    if (b.wall)
        move_sphere(after, first, second);
    else
        move_spheres(&b, after, first, second);
    for (int k = 0; k < (b.wall ? 1 : 2); k++) {
        memcpy(both[k]->velocity, after->velocities[k], sizeof both[k]->velocity);
        memcpy(both[k]->spin, after->spins[k], sizeof both[k]->spin);
    }
    return LAW_OK;
}

double law_contact_distance(const law_material *material)
{
    bodies b = bodies_of(material);
    return b.contact + b.film;
}
