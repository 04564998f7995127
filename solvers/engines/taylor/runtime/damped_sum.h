/* Damped sums of the series, which permit long steps when a fast mode decays and everything else creeps.
 *
 * A truncated series amplifies a mode exp(-z), z being its rate times the step, for z beyond 4 or 5, so a creeping
 * trajectory is limited to that step. With the last three coefficients multiplied by factors below one, the
 * amplification
 *     R(z) = sum of w_k (-z)^k/k!,  w_k = 1 up to ORDER - 3,
 * stays below 0.75 up to z = 13. The mode then dies out within some steps and vanishes from the coefficients, so the
 * step grows until it is limited by the creeping itself or by that z. The damped sum loses three orders of accuracy,
 * which the step control accounts for. The idea is that of Chebyshev methods (Abdulle, SIAM J. Sci. Comput. 23, 2041
 * (2002)), applied to a series.
 *
 * tests/solvers/engines/taylor/test_damped_sum.py checks the table.
 */
#pragma once

#include "model.h"

enum { EXACT = ORDER - 3 };
static const double STIFF_FROM = 3.5; /* z of the full series: 4 to 6 if a mode limits the step, else 1 or 2 */
static const double STRICTER = 4.0;   /* these errors do not decrease with the next coefficient */

static const double DAMPING[9][3] = { /* order: largest z */
    {0.7765296, 0.3646531, 0.07577656}, /* 8: 12.9 */
    {0.8092817, 0.4081615, 0.0920717}, /* 9: 12.7 */
    {0.8335612, 0.4441378, 0.1069132}, /* 10: 12.7 */
    {0.8523201, 0.4745784, 0.120525}, /* 11: 12.8 */
    {0.8670825, 0.5004522, 0.1329152}, /* 12: 13.0 */
    {0.8789887, 0.5227513, 0.144244}, /* 13: 13.2 */
    {0.8887403, 0.542102, 0.1545962}, /* 14: 13.4 */
    {0.8968664, 0.5590702, 0.1640978}, /* 15: 13.7 */
    {0.9037251, 0.5740561, 0.1728381}, /* 16: 14.0 */
};
STATIC_ASSERT(ORDER >= 8 && ORDER <= 16); /* DAMPING has these orders */

static inline double damping(int k)
{
    return DAMPING[ORDER - 8][k - EXACT - 1];
}

/* Replaces the series of creeping lanes by the damped ones, so that events see the states that the step produces. */
static inline void damp(vec (*a)[TERMS], mask creeps)
{
    for (int state = 0; state < STATES; state++)
        for (int k = EXACT + 1; k <= ORDER; k++)
            a[state][k] = choose(creeps, damping(k)*a[state][k], a[state][k]);
}
