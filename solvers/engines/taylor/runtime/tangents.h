/* Derivatives along a trajectory, one direction for each requested group.
 *
 * A phase starts on an event, so derivatives of its start are those of the state on a surface that moves with the
 * groups. Time is not a state; it is a sum of durations, whose derivatives follow from the events (saltation).
 */
#pragma once

#include "friction.h"
#include "model.h"

#if GRADIENTS
/* Columns of a collision's derivatives: the outputs, then these; the adjoint sweep computes those of the restitution
 * only. */
enum { BY_TIME = SHOWN, BY_SMALLEST, BY_TURNED };
STATIC_ASSERT(BACKWARD || RESULTS == BY_TURNED + 1); /* a column each */

/* Boundaries between outcomes, by the measures of distance to them (solvers/sensitivity/boundary_distance.py).
 */
enum { FAR, GLASS_GRAZE, CONTACT_GRAZE, PASSAGE, RIM, CHATTERS, TIE, TOUCH, HALF_TURNED, UNWOUND, GRIPS };

/* Relative margin of the glass criterion: 1 - p/p_gt. The clearance without motion is the limit itself. */
static inline vec pressure_margin(const constants *c, const vec *y)
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
    mask there[GROUPS]; /* lanes in which the derivative by the group can be nonzero */
    vec least; /* smallest gap at an end of a phase */
#endif
    vec near;  /* least measure so far, and its boundary */
    vec hint;  /* least of the measures that are not distances, but indicate that one should be computed */
    mask boundary;
} carried;

static void along_near(carried *a, int lane, double measure, int boundary)
{
    measure = measure == measure ? measure : 0.0; /* NaN counts as zero distance */
    if (measure < LANE(a->near, lane)) {
        LANE(a->near, lane) = measure;
        LANE(a->boundary, lane) = boundary;
    }
    if (boundary < TIE || boundary == UNWOUND)
        LANE(a->hint, lane) = fmin(LANE(a->hint, lane), measure);
}

#if BACKWARD
static void along_start(carried *a, int lane)
{
    LANE(a->near, lane) = LANE(a->hint, lane) = HUGE_VAL;
    LANE(a->boundary, lane) = FAR;
}
#else
/* Series of a step for each requested group, and the scales of their errors. */
typedef struct {
    vec t[GROUPS][STATES][TERMS];
    mask scale[GROUPS][STATES];
    unsigned requested;
} tangents;

static const double DERIVATIVES = 4.0; /* tolerance of derivatives relative to that of states */

static void along_start(carried *a, const constants *v, int lane)
{
    vec at[STATES];
    for (int group = 0; group < GROUPS; group++) {
        memset(at, 0, sizeof at);
        start_along(v, group, at);
        LANE(a->there[group], lane) = FLOWS[group] ? TRUTH : 0;
        for (int state = 0; state < STATES; state++) {
            LANE(a->t[group][state], lane) = LANE(at[state], lane);
            LANE(a->there[group], lane) |= LANE(at[state], lane) != 0.0 ? TRUTH : 0;
        }
        LANE(a->time[group], lane) = LANE(a->smallest[group], lane) = 0.0;
    }
    LANE(a->least, lane) = 1.0;
    LANE(a->near, lane) = LANE(a->hint, lane) = HUGE_VAL;
    LANE(a->boundary, lane) = FAR;
}

#if FRICTION
/* The friction of a rebound, before it is applied to the states. */
static void along_friction(carried *a, const constants *v, const vec *y, const touch *o, int lane)
{
    vec after[STATES];
    for (int group = 0; group < GROUPS; group++) {
        memcpy(after, a->t[group], sizeof after);
        friction_along(v, y, a->t[group], group, o, lane, after);
        for (int state = 0; state < MODEL_STATES; state++) {
            LANE(a->t[group][state], lane) = LANE(after[state], lane);
            LANE(a->there[group], lane) |= LANE(after[state], lane) != 0.0 ? TRUTH : 0;
        }
    }
}
#endif

/* The jump at a rebound, before it is applied to the states. */
static void along_rebound(carried *a, const constants *v, const vec *y, int lane)
{
    vec after[STATES];
    for (int group = 0; group < GROUPS; group++) {
        memcpy(after, a->t[group], sizeof after);
        rebound_along(v, y, a->t[group], group, after);
        for (int state = 0; state < STATES; state++) {
            LANE(a->t[group][state], lane) = LANE(after[state], lane);
            LANE(a->there[group], lane) |= LANE(after[state], lane) != 0.0 ? TRUTH : 0;
        }
    }
}

/* Derivatives of the results for a separated doublet, one row per group. */
static void along_finished(const carried *a, const constants *v, const vec *y, int lane, double (*rows)[RESULTS])
{
    for (int group = 0; group < GROUPS; group++) {
        vec shown[RESULTS];
        outputs_along(v, y, a->t[group], group, shown);
        for (int k = 0; k < OUTPUTS; k++)
            rows[group][k] = LANE(shown[k], lane);
        rows[group][BY_TIME] = LANE(a->time[group], lane);
        rows[group][BY_SMALLEST] = LANE(a->smallest[group], lane);
#if TURNING_STATE
        rows[group][BY_TURNED] = LANE(a->t[group][TURNED], lane);
#elif OBLIQUE && STRINGS
        rows[group][BY_TURNED] = LANE(a->t[group][ROTATION], lane);
#endif
    }
}
#endif
#endif
