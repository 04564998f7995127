/* In space: axes that turn along with a rigid doublet, in which one that tumbles is nearly at rest.
 *
 * They turn along the angular momentum, which is constant in them as well. A step in them is as long as what changes
 * permits, and neither damping (damped_sum.h) nor truncation acts on the turning itself: a bias of the vectors' lengths
 * by 1e-12 in a step adds up over thousands of turns.
 */
#pragma once

#include "model.h"

#if SPACE
typedef struct {
    vec velocity[3], rate; /* angular velocity of the axes, and its size */
} axes;

/* The axes of some lanes; those of the others do not turn. */
static void begin_turning(axes *w, const constants *c, const vec *y, mask turns)
{
    vec momentum[4], square = splat(0.0);
    precession(c, y, momentum);
    for (int k = 0; k < 3; k++) {
        w->velocity[k] = only(turns, momentum[3]*momentum[k]);
        square += w->velocity[k]*w->velocity[k];
    }
    w->rate = vec_sqrt(square);
}

/* Component k of (angular velocity) x v, of a vector whose components are `stride` numbers apart. */
static inline vec swept(const axes *w, const vec *v, int stride, int k)
{
    int next = (k + 1)%3, last = (k + 2)%3;
    return w->velocity[next]*v[last*stride] - w->velocity[last]*v[next*stride];
}

/* Subtracts from coefficient k + 1 of the states what the axes turn. */
static inline void turn_along(vec (*a)[TERMS], const axes *w, int k)
{
    for (int first = FIRST_VECTOR; first < END_OF_VECTORS; first += 3)
        for (int part = 0; part < 3; part++)
            a[first + part][k + 1] -= swept(w, &a[first][k], TERMS, part)*(1.0/(k + 1));
}
#define TURN(states, k) if (turning) turn_along((vec (*)[TERMS])(states), turning, k);

/* The states after a step, from these axes into the laboratory's. */
static void turn_back(const axes *w, vec h, vec *y)
{
    vec sine, cosine, over = choose(w->rate > 0.0, 1.0/w->rate, splat(0.0));
    const vec magic = splat(6755399441055744.0); /* adding it rounds to an integer */
    vec turns = w->rate*h*(0.5/PI);
    vec_sin_cos((turns - ((turns + magic) - magic))*(2.0*PI), &sine, &cosine);
    for (int first = FIRST_VECTOR; first < END_OF_VECTORS; first += 3) {
        vec v[3], along = splat(0.0);
        for (int k = 0; k < 3; k++) {
            v[k] = y[first + k];
            along += over*w->velocity[k]*v[k];
        }
        for (int k = 0; k < 3; k++)
            y[first + k] = cosine*v[k] + sine*over*swept(w, v, 1, k) + (1.0 - cosine)*along*over*w->velocity[k];
    }
}
#else
#define TURN(states, k)
#endif
