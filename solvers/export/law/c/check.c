/* Test vectors: what this law says beside what wetdoublet computed when it was exported.
 *
 * Prints what differs; the exit status is the number of vectors that do (at most 99).
 */
#include "law.h"
#include "vectors.h"

#include <math.h>
#include <stdio.h>

enum { COUNT = sizeof vectors/sizeof *vectors };

static int differs(int vector, const char *what, double found, double expected, double allowed)
{
    if (isnan(found) && isnan(expected))
        return 0;
    if (fabs(found - expected) <= allowed*fabs(expected))
        return 0;
    printf("vector %d: %s is %.12g, not %.12g\n", vector, what, found, expected);
    return 1;
}

#define CHECK(member) wrong += differs(k, #member, found->member, expected->member, VECTOR_TOLERANCE)

static int is_wrong(int k, const law_collision *found)
{
    const law_collision *expected = &vectors[k].expected;
    int wrong = 0;
    if (found->status != LAW_OK) {
        printf("vector %d: %s\n", k, law_message(found->status));
        return 1;
    }
    CHECK(outcome);
    CHECK(rebound);
    CHECK(restitution);
    CHECK(tangential_restitution);
    CHECK(slip_restitution);
    CHECK(contact_time);
    CHECK(rotation);
    CHECK(smallest_gap);
    CHECK(final_gap);
    CHECK(final_spin);
    CHECK(final_partner_spin);
    CHECK(final_rotation_rate);
    return wrong != 0;
}

/* The same collision in three pieces: it ends alike, and a stick is followed beyond its proof. */
static int is_wrong_in_pieces(int k, const law_material *material, const law_impact *impact, const law_collision *whole)
{
    law_contact c;
    int wrong = 0, sticks = whole->outcome == LAW_STICK;
    double time = sticks ? 3.0*material->film_thickness/impact->speed : whole->contact_time*(1.0 + 1e-9);
    law_begin(material, impact, VECTOR_RTOL, &c);
    for (int piece = 1; piece <= 3 && c.status == LAW_OK; piece++)
        law_advance(&c, time*piece/3.0);
    if (c.status != LAW_OK || (c.motion == LAW_APART) == sticks) {
        printf("vector %d in pieces: %s\n", k, law_message(c.status));
        return 1;
    }
    if (sticks)
        return 0;
    wrong += differs(k, "normal velocity in pieces", c.normal_velocity/impact->speed, whole->restitution, 1e-6);
    wrong += differs(k, "rotation in pieces", c.rotation, whole->rotation, 1e-6);
    wrong += differs(k, "time in pieces", c.time, whole->contact_time, 1e-6);
    return wrong != 0;
}

int main(void)
{
    static law_impact impacts[COUNT];
    static law_collision found[COUNT];
    law_material material = law_default_material();
    int wrong = 0;
    for (int k = 0; k < COUNT; k++)
        impacts[k] = vectors[k].impact;
    law_collide_many(&material, impacts, COUNT, VECTOR_RTOL, found);
    for (int k = 0; k < COUNT; k++) {
        law_collision one;
        law_collide(&material, &impacts[k], VECTOR_RTOL, &one);
        wrong += is_wrong(k, &found[k]) || is_wrong(k, &one) || is_wrong_in_pieces(k, &material, &impacts[k], &one);
    }
    impacts[0].speed = -1.0;
    if (law_collide(&material, &impacts[0], VECTOR_RTOL, &found[0]) != LAW_BAD_SPEED || found[0].outcome != LAW_UNDECIDED) {
        printf("a negative speed is not refused\n");
        wrong++;
    }
    printf("%d of %d vectors differ\n", wrong, (int)COUNT);
    return wrong < 99 ? wrong : 99;
}
