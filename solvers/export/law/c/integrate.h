/* From a block of collisions in SI to their results in SI, by the kernel. */
#pragma once

#include "block.h"
#include "driver.h"
#include "in_si.h"
#include "limit.h"

struct interrupted; /* limit.h; a collision in space is not interrupted */

/* Integrates `count` collisions, from columns of quantities in SI to answers in the kernel's units.
 *
 * `contact`: of a single collision that may be interrupted, where it is; else null. */
static void integrate(
    const buffer *columns, long count, double rtol, int budget, answer *answers, struct interrupted *contact)
{
    queue q; /* large: only what counts at the start is set */
    memset(answers, 0, sizeof *answers*(size_t)count);
    q.t = NULL;
    q.columns = columns;
    q.rtol = fmin(rtol, LOOSEST);
    q.answers = answers;
    q.log = NULL;
    q.log_room = 0;
    q.count = count;
    q.next = q.queued = q.taken = 0;
    q.parks = q.resumes = 0;
    q.budget = budget ? budget : MOST_STEPS_TAKEN;
#if WITH_LIMIT
    q.contact = contact;
#if WITH_LEDGER
    q.books = &contact->book; /* such kernels follow contacts only */
#endif
    if (contact)
        q.budget += contact->now.steps < INT32_MAX - q.budget ? contact->now.steps : INT32_MAX - q.budget;
#else
    (void)contact;
#endif
    run(&q);
}

/* Quantities of collisions from the first one on, in lanes; the last collision is repeated. */
static void load(vec *given, const buffer *columns, long first, long count)
{
    for (int k = 0; k < QUANTITIES; k++)
        EACH_LANE(lane) {
            long index = columns[k].bytes == (int64_t)sizeof(double) ? 0 : first + lane < count ? first + lane : count - 1;
            LANE(given[k], lane) = ((const double *)columns[k].at)[index];
        }
}

#if OBLIQUE
/* The unit of angular velocities of each collision, rad/s. */
static void find_rate_scales(const buffer *columns, long count, double *found)
{
    constants c;
    vec given[QUANTITIES];
    for (long first = 0; first < count; first += LANES) {
        load(given, columns, first, count);
        scale(&c, given);
        vec unit = rate_scale(&c, given);
        for (int lane = 0; lane < LANES && first + lane < count; lane++)
            found[first + lane] = LANE(unit, lane);
    }
}
#endif
