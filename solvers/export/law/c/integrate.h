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

/* Integrates a block; the results of collision k go to found[b->which[k]]. */
static void run_block(const law_material *m, const block *b, double rtol, int budget, law_collision *found)
{
    buffer columns[QUANTITIES];
    answer answers[BLOCK];
    double unit[BLOCK];
    set_columns(columns, m, b);
    integrate(columns, b->count, rtol, budget, answers, NULL);
#if OBLIQUE
    find_rate_scales(columns, b->count, unit);
#else
    memset(unit, 0, sizeof unit);
#endif
    for (long k = 0; k < b->count; k++) {
        const answer *a = answers + k;
        law_collision *c = found + b->which[k];
        set_unknown(c, a->status);
        if (a->status > LAST_ANSWER)
            continue;
        c->status = LAW_OK;
        c->outcome = a->outcome;
        c->certified = a->certified;
        c->rebound = a->reversal;
        c->contact_time = a->time*(m->film_thickness/b->speed[k]);
        c->rotation = a->turned;
        c->smallest_gap = a->smallest_gap*m->film_thickness;
        c->final_gap = (a->status == PROVED_AT_TOUCH ? 1.0 : a->final_gap)*m->film_thickness;
        show(a, unit[k], c);
        if (b->angle[k] == 0.0)
            c->tangential_restitution = NAN; /* a ratio to nothing */
    }
}

/* The first rule that the material's numbers break together; LAW_OK if none. */
static int inconsistent(const law_material *m)
{
    const law_impact impact = {1.0, 0.0, 0.0, 0.0}; /* the rules do not depend on it */
    block b;
    buffer columns[QUANTITIES];
    constants c;
    vec given[QUANTITIES];
    b.count = 0;
    add_impact(&b, &impact, 0);
    set_columns(columns, m, &b);
    load(given, columns, 0, 1);
    scale(&c, given);
    if (!(LANE(c.rough_gap, 0) < 1.0))
        return LAW_ROUGHNESS_BEYOND_FILM;
#if BRIDGE
    double end = LANE(c.rupture_gap, 0);
    if (!(end > 1.0 && end < INFINITY))
        return LAW_RUPTURE_WITHIN_FILM;
#else
    double end = 1.0;
#endif
#if STRINGS
    if (!(LANE(c.string_ratio, 0) > 4.0 + 0.5*end*LANE(c.aspect, 0)))
        return LAW_STRINGS_TOO_SHORT;
#endif
    (void)end;
    return LAW_OK;
}
