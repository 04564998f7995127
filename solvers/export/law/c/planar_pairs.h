/* Pairs by planar collisions: two spheres whose motion lies in a plane, and every sphere beside a wall. */
#pragma once

#include "ends.h"

/* The planar collision of a pair in a plane; an angle is not negative, so that the axis may have to be turned over. */
static law_impact in_plane(const bodies *b, const arrival *a, const plane *p)
{
    law_impact made;
    double sense = p->turning < 0.0 ? -1.0 : 1.0;
    made.speed = a->speed;
    made.angle = atan2(b->contact*fabs(p->turning), a->speed);
    made.spin = sense*p->spin[0];
    made.partner_spin = sense*p->spin[1];
    return made;
}

/* What a planar collision says of the end in any direction. */
static ending planar_end(const bodies *b, const arrival *a, const law_collision *found)
{
    ending made = as_arrived(b, a);
    made.status = found->status;
    made.outcome = found->outcome;
    made.certified = found->certified;
    made.time = found->contact_time;
    made.gap = found->final_gap;
    if (found->outcome != LAW_STICK)
        made.opening = a->speed*found->restitution;
    return made;
}

/* What rounding leaves of the spins out of the plane stays as it is. */
static ending out_of_plane(const bodies *b, const arrival *a, const plane *p, const law_collision *found)
{
    ending made = planar_end(b, a, found);
    vector3 axis = times(p->turning < 0.0 ? -1.0 : 1.0, p->axis);
    made.normal = plus(times(cos(found->rotation), a->normal), sin(found->rotation), cross(axis, a->normal));
    if (found->outcome == LAW_STICK)
        return made;
    made.slip = found->slip_restitution;
    made.turning = times(found->final_rotation_rate, axis);
    for (int k = 0; k < 2; k++) {
        made.spin[k] = plus(a->spin[k], -p->spin[k], p->axis);
        made.spin[k] = plus(made.spin[k], k ? found->final_partner_spin : found->final_spin, axis);
    }
    return made;
}
