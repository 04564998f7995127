/* Both particles in place: positions, velocities and spins in the laboratory, before a collision and after it. */

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

/* Moves two approaching particles along their straight paths to where their films touch. Returns the time that this takes,
 * negative for a pair that is found late; NaN where they do not get there. */
static double brought_together(const bodies *b, law_particle *first, law_particle *second)
{
    double distance = b->contact + b->film;
    vector3 apart = plus(vector_of(second->position), -1.0, vector_of(first->position));
    vector3 moving = plus(vector_of(second->velocity), -1.0, vector_of(first->velocity));
    if (b->wall)
        moving = times(dot(moving, apart)/dot(apart, apart), apart);
    double closing = -dot(apart, moving), beyond = dot(apart, apart) - distance*distance;
    if (!(closing > 0.0))
        return 0.0; /* is refused as not approaching */
    double time = beyond/(closing + sqrt(closing*closing - dot(moving, moving)*beyond));
    put_vector(first->position, plus(vector_of(first->position), time, vector_of(first->velocity)));
    apart = b->wall ? times(distance/length(apart), apart) : plus(apart, time, moving);
    put_vector(second->position, plus(vector_of(first->position), 1.0, apart));
    return time;
}

int law_collide_particles(const law_material *material, law_particle *first, law_particle *second, double tolerance,
                          double rtol, int budget, law_pair_after *after)
{
    law_particle both[2];
    law_pair pair;
    bodies b = bodies_of(material);
    double distance = b.contact + b.film;
    double off = fabs(length(plus(vector_of(second->position), -1.0, vector_of(first->position))) - distance);
    both[0] = *first;
    both[1] = *second;
    double time = brought_together(&b, both, both + 1);
    if (!(tolerance >= 0.0) || off > tolerance*distance || isnan(time)) {
        refuse(tolerance >= 0.0 ? LAW_NOT_IN_CONTACT : LAW_BAD_TOLERANCE, after);
        return after->status;
    }
    put_vector(pair.normal, plus(vector_of(both[1].position), -1.0, vector_of(both[0].position)));
    for (int k = 0; k < 2; k++) {
        memcpy(pair.velocities[k], both[k].velocity, sizeof pair.velocities[k]);
        memcpy(pair.spins[k], both[k].spin, sizeof pair.spins[k]);
    }
    if (law_collide_pair(material, &pair, rtol, budget, after) != LAW_OK)
        return after->status;
    if (b.wall)
        move_sphere(after, both, both + 1);
    else
        move_spheres(&b, after, both, both + 1);
    for (int k = 0; k < (b.wall ? 1 : 2); k++) {
        memcpy(both[k].velocity, after->velocities[k], sizeof both[k].velocity);
        memcpy(both[k].spin, after->spins[k], sizeof both[k].spin);
    }
    *first = both[0];
    *second = both[1];
    after->time += time;
    return LAW_OK;
}

double law_contact_distance(const law_material *material)
{
    bodies b = bodies_of(material);
    return b.contact + b.film;
}

