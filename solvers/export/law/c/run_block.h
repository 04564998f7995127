/* A block of collisions, from a material and impacts to results, and the rules that a material breaks. */
#pragma once

#include "block.h"
#include "in_si.h"
#include "integrate.h"

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
            c->tangential_restitution = (double)NAN; /* a ratio to nothing */
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
    if (!(end > 1.0 && end < HUGE_VAL))
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
