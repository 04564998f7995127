/* Sums that stand long steps where a mode decays fast and all else creeps.
 *
 * A truncated series amplifies a mode exp(-z), z its rate times the step, beyond z of 4 or 5: a creeping trajectory is held to
 * that step though nothing happens in it. With the last three coefficients times factors below one, the amplification
 *     R(z) = sum of w_k (-z)^k/k!,  w_k = 1 up to ORDER - 3,
 * stays below 0.75 up to z = 13: the mode dies within some steps and no longer shows in the coefficients, so the step grows
 * until the creeping itself limits it, or that z. It costs three orders of accuracy, which the step allows for. The idea is
 * that of Chebyshev methods (Abdulle, SIAM J. Sci. Comput. 23, 2041 (2002)), applied to a series.
 *
 * tests/solvers/engines/taylor/test_damped_sum.py holds the table to what it is said to do; tests/benchmarks/damping.py makes it.
 */
#pragma once

#include "model.h"

enum { EXACT = ORDER - 3 };
static const double STIFF_FROM = 3.5; /* z at the step that the whole series allows: 4 to 6 where it is held, else 1 or 2 */
static const double STRICTER = 4.0;   /* since an error here does not die with the next coefficient */

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
_Static_assert(ORDER >= 8 && ORDER <= 16, "DAMPING has these orders");

static inline double damping(int k)
{
    return DAMPING[ORDER - 8][k - EXACT - 1];
}

/* The series of creeping lanes as the damped sum has them, so that events see what the states become. */
static inline void damp(vec (*a)[TERMS], mask creeps)
{
    for (int state = 0; state < STATES; state++)
        for (int k = EXACT + 1; k <= ORDER; k++)
            a[state][k] = choose(creeps, damping(k)*a[state][k], a[state][k]);
}
