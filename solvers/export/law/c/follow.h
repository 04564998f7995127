/* An interrupted contact in SI, by the kernel. */
#pragma once

#include "block.h"
#include "driver.h"
#include "in_si.h"
#include "integrate.h"
#include "limit.h"

STATIC_ASSERT(sizeof(struct interrupted) <= sizeof(((law_contact *)0)->memory));

/* Integrates a contact up to its time `t`, s, and says where it is. */
static void follow(law_contact *c, double t)
{
    struct interrupted h;
    buffer columns[QUANTITIES];
    answer answers[1];
    double unit = 0.0;
    block b;
    law_collision shown;
    const double unit_of_time = c->material.film_thickness/c->impact.speed;
    memcpy(&h, c->memory, sizeof h);
    b.count = 0;
    add_impact(&b, &c->impact, 0);
    set_columns(columns, &c->material, &b);
    h.limit = t/unit_of_time;
    integrate(columns, 1, c->rtol, c->budget, answers, &h);
    memcpy(c->memory, &h, sizeof h);
    c->status = answers[0].status;
    if (c->status > LAST_ANSWER || !h.begun) {
        c->motion = LAW_LOST;
        c->outcome = h.stuck ? LAW_STICK : LAW_UNDECIDED;
        c->certified = h.certified;
        return;
    }
    c->status = LAW_OK;
    c->motion = !h.over ? h.resting ? LAW_RESTING : h.closing ? LAW_CLOSING : LAW_OPENING
                : answers[0].outcome == STICK ? LAW_CUT_OFF : LAW_APART;
    c->outcome = h.over ? answers[0].outcome : h.stuck ? LAW_STICK : LAW_UNDECIDED;
    c->certified = h.certified; /* only of a stick */
    c->rebound = h.now.reversal;
    c->wet = h.film;
    c->time = h.over ? h.now.time*unit_of_time : t;
    c->gap = h.now.final_gap*c->material.film_thickness;
    c->smallest_gap = h.now.smallest_gap*c->material.film_thickness;
#if OBLIQUE
    find_rate_scales(columns, 1, &unit);
#endif
    set_unknown(&shown, LAW_OK);
    show(&h.now, unit, &shown);
    c->normal_velocity = shown.restitution*c->impact.speed;
    c->rotation = h.now.turned;
    c->rotation_rate = shown.final_rotation_rate;
    c->spin = shown.final_spin;
    c->partner_spin = shown.final_partner_spin;
#if WITH_LEDGER
    const ledger *book = &h.book;
    const double unit_of_energy = c->material.reduced_mass*c->impact.speed*c->impact.speed;
    c->initial_energy = book->initial*unit_of_energy;
    c->kinetic_energy = book->final*unit_of_energy;
    c->normal_loss = book->normal*unit_of_energy;
    c->tangential_loss = book->tangential*unit_of_energy;
    c->capillary_work = book->capillary*unit_of_energy;
    c->attraction_work = book->attraction*unit_of_energy;
    c->dry_loss = (book->dry + book->friction)*unit_of_energy;
    c->strings_work = book->lifted*unit_of_energy;
#if OWN_EVENTS
    c->own_loss = book->own_events*unit_of_energy;
#else
    c->own_loss = 0.0;
#endif
#endif
}
