/* Recurrences whose operands are all known, unrolled, so that factors stay in registers. */
#pragma once

#include "series.h"

#define TERM_AT(number, ...) { enum { k = number }; if (k < ORDER) { __VA_ARGS__ } }
/* A statement for each coefficient k except the last, which no rate uses. */
#define EACH_TERM(...) TERM_AT(0, __VA_ARGS__) TERM_AT(1, __VA_ARGS__) TERM_AT(2, __VA_ARGS__) TERM_AT(3, __VA_ARGS__) \
    TERM_AT(4, __VA_ARGS__) TERM_AT(5, __VA_ARGS__) TERM_AT(6, __VA_ARGS__) TERM_AT(7, __VA_ARGS__) \
    TERM_AT(8, __VA_ARGS__) TERM_AT(9, __VA_ARGS__) TERM_AT(10, __VA_ARGS__) TERM_AT(11, __VA_ARGS__) \
    TERM_AT(12, __VA_ARGS__) TERM_AT(13, __VA_ARGS__) TERM_AT(14, __VA_ARGS__) TERM_AT(15, __VA_ARGS__)

/* Of two sums the terms a_(m-k) b_m and a_(m-k+1) b_m, m = from..ORDER-1: they share their operands, which then are
 * loaded once. */
INLINE vec two_correlations(const vec *a, const vec *b, vec *ahead, int k, int from)
{
    vec sum = a[ORDER - 1 - k]*b[ORDER - 1], next = a[ORDER - k]*b[ORDER - 1];
    UNROLL
    for (int m = ORDER - 2; m >= from; m--) {
        sum += a[m - k]*b[m];
        next += a[m - k + 1]*b[m];
    }
    *ahead = next;
    return sum;
}

/* sum of a_(m-k) b_m, m = k..ORDER-1: derivatives b by a product's coefficients, propagated to those of a factor. */
INLINE vec correlated(const vec *a, const vec *b, vec *ahead, int k)
{
    if (k == ORDER - 1)
        return a[0]*b[k];
    return (ORDER - k) % 2 ? a[0]*b[k] + *ahead : two_correlations(a, b, ahead, k, k);
}

/* The same without its first term: sum of a_(m-k) b_m, m = k+1..ORDER-1. */
INLINE vec beyond(const vec *a, const vec *b, vec *ahead, int k)
{
    if (k >= ORDER - 1)
        return splat(0.0);
    return (ORDER - k) % 2 ? a[1]*b[k + 1] + *ahead : two_correlations(a, b, ahead, k, k + 1);
}
