#pragma once
/* Contact for good: rebounds that never rise above the first one. */
#include "funnel.h"

/* True if no trajectory that rebounds from a box of states comes back above its first maximum of the gap. Below that the
 * momenta stay in a box whose faces they do not cross, and the force inward is positive. A rise from the speed u ends
 * within u^2/2 over the least force. A fall by g brings at most g times its largest force, of which a rebound leaves e^2, for
 * a rise by this over the least force then: by less than g, if forces change so little in a fall and a rise. They take
 * the time t at most, as the film's coefficient k is bounded, too (derive/checks/enclosure.py). */
static int stays_in_contact(const problem *p, flow *s, region here, const iv *from)
{
    iv x[STATES], face[STATES], rate[STATES], own[STATES], there[STATES];
    const iv edge = p->level[TANGENTIAL_EDGE].v;
    const double lowest = iv_lo(p->level[CONTACT_GAP].v), end = smaller(1.0, iv_lo(p->level[RUPTURE_GAP].v));
    const double e = iv_hi(p->box.dry_restitution.v), u = larger(iv_hi(from[NORMAL_VELOCITY]), 0.0); /* not closing */
    double rise = 0.0;
    memcpy(x, from, sizeof x);
    x[NORMAL_VELOCITY] = iv_point(0.0);
    for (int trial = 0, inside = 0; trial < 20 && here.film; trial++) {
        x[GAP] = iv_of(lowest, iv_hi(from[GAP]) + rise);
        field(p, s, x, rate, own);
        const double least = -iv_hi(rate[NORMAL_VELOCITY]), most = -iv_lo(rate[NORMAL_VELOCITY]);
        const int same = iv_positive(here.shear) ? iv_hi(x[GAP]) < iv_lo(edge) : lowest > iv_hi(edge);
        if (!(least > 0.0) || !(iv_hi(own[NORMAL_VELOCITY]) <= 0.0) || !same || !(iv_hi(x[GAP]) < end))
            return 0;
        if (inside) {
            const double g = iv_width(x[GAP]), k = -iv_lo(own[NORMAL_VELOCITY]);
            const double t = 2.0*g*k/least + sqrt(2.0*g/least) + sqrt(2.0*g*most)/least;
            const series *force = &s->state[NORMAL_VELOCITY];
            double change = HAS(force, GAP) ? g*iv_magnitude(force->d[GAP][1]) : 0.0;
            for (int i = NORMAL_VELOCITY + 1; i < STATES; i++)
                change += HAS(force, i) ? t*iv_magnitude(iv_mul(force->d[i][1], rate[i])) : 0.0;
            return e*e*(least + change) < least;
        }
        inside = u*u/(2.0*least) <= rise;
        rise = inside ? rise : 1.2*(u*u/(2.0*least));
        for (int i = NORMAL_VELOCITY + 1; i < STATES; i++)
            for (int up = 0; up < 2; up++) { /* a face is moved as far as its rate reaches while it falls with its state */
                memcpy(face, x, sizeof face);
                face[i] = iv_point(up ? iv_hi(x[i]) : iv_lo(x[i]));
                field(p, s, face, there, NULL);
                const double out = up ? iv_hi(there[i]) : -iv_lo(there[i]), way = out > 0.0 ? -1.1*out/iv_hi(own[i]) : 0.0;
                if (!(way >= 0.0 && way <= DBL_MAX))
                    return 0;
                inside &= out <= 0.0;
                x[i] = iv_add(x[i], up ? iv_of(0.0, way) : iv_of(-way, 0.0));
            }
    }
    return 0;
}
