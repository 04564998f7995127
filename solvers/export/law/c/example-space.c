/* Pairs of particles that collide in space: their positions, velocities and spins go in, and come out.
 *
 * cc -O2 example.c @{name}.c -lm, or `make example`.
 */
#include "law.h"

#include <math.h>
#include <stdio.h>

enum { PAIRS = 1000 };
static const double RADII[2] = {@{radii | join(", ")}}, MASSES[2] = {@{masses | join(", ")}}; /* m, kg */

/* A number from -1 to 1, always the same sequence. */
static double drawn(void)
{
    static unsigned long state = 1;
    state = (state*69069UL + 1UL) & 0xffffffffUL;
    return (double)state/2147483648.0 - 1.0;
}

/* Two particles whose films touch, with random velocities and spins. */
static void meet(law_particle *first, law_particle *second, double distance)
{
    double speed = @{speed}*pow(10.0, 2.0*drawn()), n[3], length, approach = 0.0;
    for (int k = 0; k < 3; k++) {
        n[k] = drawn();
        first->position[k] = 0.0;
        first->velocity[k] = speed*drawn();
        second->velocity[k] = MASSES[1] > 0.0 ? speed*drawn() : 0.0; /* a wall rests */
        first->spin[k] = 0.3*speed/RADII[0]*drawn();
        second->spin[k] = 0.3*speed/RADII[0]*drawn();
    }
    length = sqrt(n[0]*n[0] + n[1]*n[1] + n[2]*n[2]);
    for (int k = 0; k < 3; k++)
        approach += n[k]*(first->velocity[k] - second->velocity[k]);
    for (int k = 0; k < 3; k++) /* on the side to which the first moves */
        second->position[k] = (approach < 0.0 ? -distance : distance)*n[k]/length;
}

/* The kinetic energy of a particle, J. */
static double energy(const law_particle *p, int one)
{
    double found = 0.0;
    for (int k = 0; k < 3; k++)
        found += p->velocity[k]*p->velocity[k] + 0.4*RADII[one]*RADII[one]*p->spin[k]*p->spin[k];
    return MASSES[one] > 0.0 ? 0.5*MASSES[one]*found : 0.0;
}

int main(void)
{
    law_material material = law_default_material();
    double distance = law_contact_distance(&material), before = 0.0, left = 0.0;
    int counts[3] = {0, 0, 0};
    for (int pair = 0; pair < PAIRS; pair++) {
        law_particle first, second;
        law_pair_after after;
        meet(&first, &second, distance);
        before += energy(&first, 0) + energy(&second, 1);
        if (law_collide_particles(&material, &first, &second, 1e-9, 1e-9, 0, &after) != LAW_OK)
            printf("pair %d: %s\n", pair, law_message(after.status)); /* they are as they were */
        else
            counts[after.outcome]++; /* of a stick: one rigid body from here on, after.angular_velocity */
        left += energy(&first, 0) + energy(&second, 1);
    }
    printf("%d stick, %d bounce, %d stick, rotate and separate\n", counts[LAW_STICK], counts[LAW_BOUNCE],
        counts[LAW_STICK_ROTATE_SEPARATE]);
    printf("%.1f %% of the kinetic energy is left\n", 100.0*left/before);
    return 0;
}
