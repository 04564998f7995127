/* Derivatives carried along a trajectory, a direction for each group that was asked for.
 *
 * A phase starts on its event, so a derivative of its start is one of the state on a surface that moves with the groups;
 * time is no variable of it, only a sum whose parts change with the events that end them (saltation).
 */
#pragma once

#include "model.h"

#if GRADIENTS
/* Columns of a collision's derivatives: the outputs, then these; only the restitution's are taken backwards. */
enum { BY_TIME = 5, BY_SMALLEST, BY_TURNED };
_Static_assert(BACKWARD || RESULTS == BY_TURNED + 1, "a column each");

/* How near a trajectory comes to a boundary between outcomes, by its own measures (solvers/sensitivity/boundary_distance.py). */
enum { FAR, GLASS_GRAZE, CONTACT_GRAZE, PASSAGE, RIM, CHATTERS, TIE, TOUCH, HALF_TURNED, UNWOUND };

/* What the glass criterion's clearance is of that without motion: one less the pressure over its limit. */
static inline vec spare(const constants *c, const vec *y)
{
    vec still[STATES];
    memcpy(still, y, sizeof still);
    still[NORMAL_VELOCITY] = splat(0.0);
    return glass_clearance(c, y)/glass_clearance(c, still);
}

typedef struct {
#if !BACKWARD
    vec t[GROUPS][STATES];
    vec time[GROUPS], smallest[GROUPS];
    mask there[GROUPS]; /* the group has changed something by now */
    vec least; /* smallest gap at an end of a phase */
#endif
    vec near;  /* least measure so far, and of which boundary */
    vec hint;  /* least of those that are no distances, but say that one should be measured */
    mask boundary;
} carried;

static void along_near(carried *a, int lane, double measure, int boundary)
{
    measure = measure == measure ? measure : 0.0; /* NaN is near */
    if (measure < a->near[lane]) {
        a->near[lane] = measure;
        a->boundary[lane] = boundary;
    }
    if (boundary < TIE || boundary == UNWOUND)
        a->hint[lane] = fmin(a->hint[lane], measure);
}

#if BACKWARD
enum { BEGUN, REBOUND, ENDED }; /* what a tape notes of a lane between steps */

static void along_start(carried *a, int lane)
{
    a->near[lane] = a->hint[lane] = INFINITY;
    a->boundary[lane] = FAR;
}
#else
/* The series of a step: of each group that is carried, and by what they are measured. */
typedef struct {
    vec t[GROUPS][STATES][TERMS];
    mask scale[GROUPS][STATES];
    unsigned asked;
} tangents;

static const double DERIVATIVES = 4.0; /* of a derivative's error, to that of a state */

static void along_start(carried *a, const constants *v, int lane)
{
    vec at[STATES];
    for (int group = 0; group < GROUPS; group++) {
        memset(at, 0, sizeof at);
        start_along(v, group, at);
        for (int state = 0; state < STATES; state++)
            a->t[group][state][lane] = at[state][lane];
        a->time[group][lane] = a->smallest[group][lane] = 0.0;
        a->there[group][lane] = FLOWS[group] ? -1 : 0;
    }
    a->least[lane] = 1.0;
    a->near[lane] = a->hint[lane] = INFINITY;
    a->boundary[lane] = FAR;
}

/* The jump at a rebound, before it is applied to the states. */
static void along_rebound(carried *a, const constants *v, const vec *y, int lane)
{
    vec after[STATES];
    for (int group = 0; group < GROUPS; group++) {
        memcpy(after, a->t[group], sizeof after);
        rebound_along(v, y, a->t[group], group, after);
        for (int state = 0; state < STATES; state++) {
            a->t[group][state][lane] = after[state][lane];
            a->there[group][lane] |= after[state][lane] != 0.0 ? -1 : 0;
        }
    }
}

/* The derivatives of what a separated doublet shows, a row a group. */
static void along_finished(const carried *a, const constants *v, const vec *y, int lane, double (*rows)[RESULTS])
{
    for (int group = 0; group < GROUPS; group++) {
        vec shown[RESULTS];
        outputs_along(v, y, a->t[group], group, shown);
        for (int k = 0; k < OUTPUTS; k++)
            rows[group][k] = shown[k][lane];
        rows[group][BY_TIME] = a->time[group][lane];
        rows[group][BY_SMALLEST] = a->smallest[group][lane];
#if TURNING_STATE
        rows[group][BY_TURNED] = a->t[group][TURNED][lane];
#elif OBLIQUE && STRINGS
        rows[group][BY_TURNED] = a->t[group][ROTATION][lane];
#endif
    }
}
#endif
#endif
