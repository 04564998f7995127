/* Pairs that collide in a plane: from the vectors of two particles to an impact, and back to vectors.
 *
 * cc -O2 example.c @NAME@.c -lm, or `make example`.
 */
#include "law.h"

#include <math.h>
#include <stdio.h>

enum { PAIRS = 1000 };
static const double RADII[2] = {@RADII@}, MASSES[2] = {@MASSES@}; /* m, kg */

typedef struct {
    double x[2], v[2], spin; /* m, m/s, rad/s: anticlockwise is positive */
} particle;

/* A number from 0 to 1, always the same sequence. */
static double drawn(void)
{
    static unsigned long state = 1;
    state = (state*69069UL + 1UL) & 0xffffffffUL;
    return (double)state/4294967296.0;
}

/* The impact of two particles whose films touch. `turn` is the sense in which the line of centres turns: 1 anticlockwise. */
static law_impact impact_of(const particle *p, double film, double n[2], double *turn)
{
    law_impact found;
    double d[2], v[2], distance, normal, across, arm = RADII[0] + RADII[1];
    for (int k = 0; k < 2; k++) {
        d[k] = p[1].x[k] - p[0].x[k];
        v[k] = p[1].v[k] - p[0].v[k];
    }
    distance = sqrt(d[0]*d[0] + d[1]*d[1]);
    for (int k = 0; k < 2; k++)
        n[k] = d[k]/distance;
    normal = v[0]*n[0] + v[1]*n[1];
    across = n[0]*v[1] - n[1]*v[0]; /* of the partner, anticlockwise about the sphere */
    *turn = across < 0.0 ? -1.0 : 1.0;
    found.speed = -normal;
    found.angle = atan2(fabs(across)*arm/(arm + film), found.speed);
    found.spin = *turn*p[0].spin;
    found.partner_spin = *turn*p[1].spin;
    return found;
}

/* The particles at separation: the pair has turned about its centre of mass, which moves on. */
static void separate(particle *p, const law_impact *impact, const law_collision *c, const double n[2], double turn)
{
    double angle = turn*c->rotation, distance = RADII[0] + RADII[1] + c->final_gap, whole = MASSES[0] + MASSES[1];
    double m[2], along, across, share[2];
    m[0] = n[0]*cos(angle) - n[1]*sin(angle);
    m[1] = n[0]*sin(angle) + n[1]*cos(angle);
    along = c->restitution*impact->speed;
    across = turn*c->final_rotation_rate*distance;
    share[0] = -MASSES[1]/whole;
    share[1] = MASSES[0]/whole;
    for (int k = 0; k < 2; k++) {
        double side = k == 0 ? -m[1] : m[0];
        double centre = (MASSES[0]*p[0].x[k] + MASSES[1]*p[1].x[k])/whole;
        double drift = (MASSES[0]*p[0].v[k] + MASSES[1]*p[1].v[k])/whole;
        for (int one = 0; one < 2; one++) {
            p[one].x[k] = centre + drift*c->contact_time + share[one]*distance*m[k];
            p[one].v[k] = drift + share[one]*(along*m[k] + across*side);
        }
    }
    p[0].spin = turn*c->final_spin;
    p[1].spin = turn*c->final_partner_spin;
}

/* A contact that is interrupted: where it is at some times. */
static void follow_one(const law_material *material)
{
    const law_impact impact = {@SPEED@, 0.5, 0.0, 0.0};
    law_contact c;
    law_begin(material, &impact, 1e-9, &c);
    for (int k = 1; k <= 4 && c.motion <= LAW_RESTING; k++) {
        law_advance(&c, k*0.5*material->film_thickness/impact.speed);
        printf("after %.3e s: gap %.3e m, its rate %.3e m/s\n", c.time, c.gap, c.normal_velocity);
    }
}

int main(void)
{
    law_material material = law_default_material();
    double before = 0.0, after = 0.0;
    int sticks = 0, bounces = 0, others = 0;
    for (int pair = 0; pair < PAIRS; pair++) {
        particle p[2] = {{{0.0, 0.0}, {0.0, 0.0}, 0.0}, {{0.0, 0.0}, {0.0, 0.0}, 0.0}};
        double place = 6.28*drawn(), way = 6.28*drawn(), speed = @SPEED@*pow(1e4, drawn() - 0.5), n[2], turn;
        double distance = RADII[0] + RADII[1] + material.film_thickness;
        law_impact impact;
        law_collision c;
        p[1].x[0] = distance*cos(place);
        p[1].x[1] = distance*sin(place);
        p[0].v[0] = speed*cos(way);
        p[0].v[1] = speed*sin(way);
        impact = impact_of(p, material.film_thickness, n, &turn);
        if (impact.speed <= 0.0)
            continue; /* they do not approach */
        if (law_collide(&material, &impact, 1e-9, &c) != LAW_OK) {
            printf("pair %d: %s\n", pair, law_message(c.status));
            continue;
        }
        if (c.outcome == LAW_STICK) {
            sticks++; /* one rigid body from here on, with the pair's momentum and angular momentum */
            continue;
        }
        separate(p, &impact, &c, n, turn);
        before += 0.5*MASSES[0]*speed*speed;
        for (int one = 0; one < 2; one++)
            after += 0.5*MASSES[one]*(p[one].v[0]*p[one].v[0] + p[one].v[1]*p[one].v[1]
                + 0.4*RADII[one]*RADII[one]*p[one].spin*p[one].spin);
        if (c.outcome == LAW_BOUNCE)
            bounces++;
        else
            others++;
    }
    printf("%d stick, %d bounce, %d stick, rotate and separate\n", sticks, bounces, others);
    if (before > 0.0)
        printf("those that separate keep %.1f %% of their kinetic energy\n", 100.0*after/before);
    follow_one(&material);
    return 0;
}
