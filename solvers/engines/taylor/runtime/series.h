/* Coefficient k of elementary functions of Taylor series (Jorba & Zou, Exp. Math. 14, 99 (2005)).
 *
 * Divisors are inverted once, at order zero.
 */
#pragma once

#include "vector.h"

/* sum of a_j b_(k-j), j = from..to, from the middle outwards in two sums: the newest coefficients are used last, so
 * that the processor can start before they are available.
 */
INLINE vec between(const vec *a, const vec *b, int k, int from, int to)
{
    int middle = (from + to)/2;
    vec low = a[middle]*b[k - middle];
    UNROLL
    for (int j = middle - 1; j >= from; j--)
        low += a[j]*b[k - j];
    if (middle == to)
        return low;
    vec high = a[middle + 1]*b[k - middle - 1];
    UNROLL
    for (int j = middle + 2; j <= to; j++)
        high += a[j]*b[k - j];
    return low + high;
}

/* b is the newer series, so its last coefficient is used last */
INLINE vec product(const vec *a, const vec *b, int k)
{
    if (k == 0)
        return a[0]*b[0];
    vec sum = a[k]*b[0];
    if (k > 1)
        sum += between(a, b, k, 1, k - 1);
    return sum + a[0]*b[k];
}

/* Twice the sum of q_j q_(k-j) over from <= j < k/2, plus the middle term if there is one. */
INLINE vec paired(const vec *q, int k, int from)
{
    int middle = (k - 1)/2;
    vec half = k % 2 ? splat(0.0) : q[k/2]*(0.5*q[k/2]);
    UNROLL
    for (int j = middle; j >= from; j--)
        half += q[j]*q[k - j];
    return half + half;
}

INLINE vec square(const vec *a, int k)
{
    return k == 0 ? a[0]*a[0] : paired(a, k, 0);
}

/* sum of b_j q_(k-j), j = 1..k */
INLINE vec rest(const vec *b, const vec *q, int k)
{
    if (k == 1)
        return b[1]*q[0];
    vec sum = b[k]*q[0];
    if (k > 2)
        sum += between(b, q, k, 2, k - 1);
    return sum + b[1]*q[k - 1];
}

INLINE vec reciprocal(const vec *a, const vec *q, int k)
{
    return k == 0 ? 1.0/a[0] : -q[0]*rest(a, q, k);
}

INLINE vec quotient(const vec *a, const vec *b, const vec *q, vec *over, int k)
{
    if (k == 0) {
        *over = 1.0/b[0];
        return a[0]**over;
    }
    return (a[k] - rest(b, q, k))**over;
}

INLINE vec root(const vec *a, const vec *q, vec *over, int k)
{
    if (k == 0) {
        vec root = vec_sqrt(a[0]);
        *over = 0.5/root;
        return root;
    }
    if (k == 1)
        return a[1]**over;
    return (a[k] - paired(q, k, 1))**over;
}

/* q = exp(a): k q_k = sum of j a_j q_(k-j); `slope` keeps j a_j */
INLINE vec exponential(const vec *a, vec *slope, const vec *q, int k)
{
    slope[k] = (double)k*a[k];
    return k == 0 ? vec_exp(a[0]) : rest(slope, q, k)*(1.0/k);
}

/* q = log(a): k a_0 q_k = k a_k - sum of j q_j a_(k-j); `slope` keeps j q_j */
INLINE vec logarithm(const vec *a, const vec *q, vec *slope, vec *over, int k)
{
    (void)q;
    if (k == 0) {
        *over = 1.0/a[0];
        slope[0] = splat(0.0);
        return vec_log(a[0]);
    }
    vec sum = (double)k*a[k];
    if (k > 1)
        sum -= between(slope, a, k, 1, k - 1);
    slope[k] = sum**over;
    return slope[k]*(1.0/k);
}

/* s = sin(a), c = cos(a) together; `slope` keeps j a_j */
INLINE void circular(const vec *a, vec *slope, vec *s, vec *c, int k)
{
    slope[k] = (double)k*a[k];
    if (k == 0) {
        vec_sin_cos(a[0], &s[0], &c[0]);
        return;
    }
    s[k] = rest(slope, c, k)*(1.0/k);
    c[k] = -rest(slope, s, k)*(1.0/k);
}

/* q = arctan(a): k q_k = sum of j a_j w_(k-j), w = 1/(1 + a^2); `slope` keeps j a_j */
INLINE vec arctangent(const vec *a, vec *slope, const vec *w, int k)
{
    slope[k] = (double)k*a[k];
    return k == 0 ? vec_atan(a[0]) : rest(slope, w, k)*(1.0/k);
}

/* q = a^r: k a_0 q_k = sum of (j r - (k - j)) a_j q_(k-j) */
INLINE vec power(const vec *a, const vec *q, vec r, vec *over, int k)
{
    if (k == 0) {
        *over = 1.0/a[0];
        return vec_exp(r*vec_log(a[0]));
    }
    vec sum = splat(0.0);
    UNROLL
    for (int j = 1; j <= k; j++)
        sum += (r*(double)j - (double)(k - j))*(a[j]*q[k - j]);
    return sum*(1.0/k)**over;
}

/* Unrolled over k as a constant, so that sums have no loops and coefficients can stay in registers. */
#define EVERY(term) term(0) term(1) term(2) term(3) term(4) term(5) term(6) term(7) term(8) term(9) term(10) \
    term(11) term(12) term(13) term(14) term(15) term(16)
STATIC_ASSERT(ORDER <= 16); /* EVERY names all orders */
