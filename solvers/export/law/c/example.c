/* Impacts of many speeds and angles: `make example`, or cc -O2 example.c @{name}.c -lm. */
#include "law.h"

#include <math.h>
#include <stdio.h>

enum { IMPACTS = 1000 };

/* A contact that is interrupted: where it is at some times. */
static void follow_one(const law_material *material)
{
    const law_impact impact = {@{speed}, 0.5, 0.0, 0.0};
    law_contact c;
    law_begin(material, &impact, 1e-9, 0, &c);
    for (int k = 1; k <= 4 && c.motion <= LAW_RESTING; k++) {
        law_advance(&c, k*0.5*material->film_thickness/impact.speed);
        printf("after %.3e s: gap %.3e m, its rate %.3e m/s\n", c.time, c.gap, c.normal_velocity);
    }
}

int main(void)
{
    law_material material = law_default_material();
    int sticks = 0, bounces = 0, others = 0;
    for (int k = 0; k < IMPACTS; k++) {
        law_impact impact;
        law_collision c;
        impact.speed = @{speed}*pow(1e4, k%32/31.0 - 0.5); /* m/s */
        impact.angle = k/32*0.04;                              /* rad */
        impact.spin = 0.0;                                     /* rad/s */
        impact.partner_spin = 0.0;
        if (law_collide(&material, &impact, 1e-9, 0, &c) != LAW_OK) {
            printf("impact %d: %s\n", k, law_message(c.status));
            continue;
        }
        if (c.outcome == LAW_STICK)
            sticks++;
        else if (c.outcome == LAW_BOUNCE)
            bounces++; /* their normal velocity: c.restitution*impact.speed */
        else
            others++;
    }
    printf("%d stick, %d bounce, %d part without a rebound\n", sticks, bounces, others);
    follow_one(&material);
    return 0;
}
