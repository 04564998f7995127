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
    law_begin(material, impact, VECTOR_RTOL, 0, &c);
    for (int piece = 1; piece <= 3 && c.status == LAW_OK; piece++)
        law_advance(&c, time*piece/3.0);
    if (sticks && c.motion == LAW_LOST && c.outcome == LAW_STICK)
        return 0; /* proved, and then it rebounds without end: law.h says that it cannot be followed */
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

#if LAW_IN_SPACE
enum { PAIR_COUNT = sizeof pair_vectors/sizeof *pair_vectors };

/* Vectors are compared by their length, and by that of a scale. */
static int differ(int vector, const char *what, const double *found, const double *expected, const double *scale)
{
    double apart = 0.0, length = 0.0;
    for (int k = 0; k < 3; k++) {
        if (isnan(found[k]) && isnan(expected[k]))
            continue;
        apart += (found[k] - expected[k])*(found[k] - expected[k]);
        length += expected[k]*expected[k] + scale[k]*scale[k];
    }
    if (sqrt(apart) <= VECTOR_TOLERANCE*sqrt(length))
        return 0;
    printf("pair %d: %s is off by %.3g of %.3g\n", vector, what, sqrt(apart), sqrt(length));
    return 1;
}

static int pair_is_wrong(int k, const law_pair_after *found)
{
    const law_pair_after *expected = &pair_vectors[k].expected;
    const law_pair *before = &pair_vectors[k].pair;
    int wrong = 0;
    if (found->status != LAW_OK) {
        printf("pair %d: %s\n", k, law_message(found->status));
        return 1;
    }
    CHECK(outcome);
    CHECK(restitution);
    CHECK(slip_restitution);
    for (int one = 0; one < 2; one++) {
        wrong += differ(k, "a velocity", found->velocities[one], expected->velocities[one], before->velocities[one]);
        wrong += differ(k, "a spin", found->spins[one], expected->spins[one], before->spins[one]);
    }
    wrong += differ(k, "centre_velocity", found->centre_velocity, expected->centre_velocity, before->velocities[0]);
    CHECK(time);
    CHECK(gap);
    wrong += differ(k, "position", found->position, expected->position, expected->position);
    return wrong != 0;
}

static int wrong_pairs(const law_material *material)
{
    static law_pair pairs[PAIR_COUNT];
    static law_pair_after after[PAIR_COUNT];
    int wrong = 0;
    for (int k = 0; k < PAIR_COUNT; k++)
        pairs[k] = pair_vectors[k].pair;
    law_collide_pair_many(material, pairs, PAIR_COUNT, VECTOR_RTOL, 0, after);
    for (int k = 0; k < PAIR_COUNT; k++) {
        law_pair_after one;
        law_collide_pair(material, &pairs[k], VECTOR_RTOL, 0, &one);
        wrong += pair_is_wrong(k, &after[k]) || pair_is_wrong(k, &one);
    }
    printf("%d of %d pairs in space differ\n", wrong, (int)PAIR_COUNT);
    return wrong;
}
#endif

int main(void)
{
    static law_impact impacts[COUNT];
    static law_collision found[COUNT];
    law_material material = law_default_material();
    int wrong = 0;
    for (int k = 0; k < COUNT; k++)
        impacts[k] = vectors[k].impact;
    law_collide_many(&material, impacts, COUNT, VECTOR_RTOL, 0, found);
    for (int k = 0; k < COUNT; k++) {
        law_collision one;
        law_collide(&material, &impacts[k], VECTOR_RTOL, 0, &one);
        wrong += is_wrong(k, &found[k]) || is_wrong(k, &one) || is_wrong_in_pieces(k, &material, &impacts[k], &one);
    }
    impacts[0].speed = -1.0;
    if (law_collide(&material, &impacts[0], VECTOR_RTOL, 0, &found[0]) != LAW_BAD_SPEED
            || found[0].outcome != LAW_UNDECIDED) {
        printf("a negative speed is not refused\n");
        wrong++;
    }
    printf("%d of %d vectors differ\n", wrong, (int)COUNT);
#if LAW_IN_SPACE
    wrong += wrong_pairs(&material);
#endif
    return wrong < 99 ? wrong : 99;
}
