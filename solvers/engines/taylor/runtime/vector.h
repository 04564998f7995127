/* Lanes: several doubles side by side, with the functions that recurrences start from.
 *
 * Vector extensions of gcc and clang; LANES is 8, 4, 2 or 1. Compiled without -ffast-math: comparisons with NaN are
 * false, infinities are respected, and loops treat a comparison that is not true as a case to examine.
 */
#pragma once

#include "settings.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

typedef double vec __attribute__((vector_size(8*LANES)));
typedef int64_t mask __attribute__((vector_size(8*LANES)));
typedef uint64_t word __attribute__((vector_size(8*LANES))); /* bits of a double, with defined overflow */

#define EACH_LANE(lane) for (int lane = 0; lane < LANES; lane++)

static inline vec splat(double x)
{
    return x - (vec){0};
}

static inline mask splat_mask(int64_t x)
{
    return x - (mask){0};
}

static inline vec only(mask m, vec x)
{
    return (vec)((mask)x & m);
}

static inline vec choose(mask m, vec a, vec b)
{
    return (vec)(((mask)a & m) | ((mask)b & ~m));
}

static inline vec vec_abs(vec x)
{
    return (vec)((mask)x & splat_mask(INT64_MAX));
}

static inline vec vec_max(vec a, vec b)
{
    return choose(a > b, a, b);
}

static inline vec vec_min(vec a, vec b)
{
    return choose(a < b, a, b);
}

/* The same for use in certificates: NaN if either operand is NaN. */
static inline vec vec_larger(vec a, vec b)
{
    return choose((a > b) | (a != a), a, b);
}

static inline vec vec_smaller(vec a, vec b)
{
    return choose((a < b) | (a != a), a, b);
}

static inline mask least(mask a, mask b)
{
    mask less = a < b;
    return (a & less) | (b & ~less);
}

/* The lanes of a mask as bits. */
static inline unsigned bits(mask m)
{
#if LANES == 8 && defined(__AVX512DQ__)
    return _mm512_movepi64_mask((__m512i)m);
#elif LANES == 16 && defined(__AVX512DQ__)
    __m512i half[2];
    memcpy(half, &m, sizeof m);
    return _mm512_movepi64_mask(half[0]) | (unsigned)_mm512_movepi64_mask(half[1]) << 8;
#elif LANES == 4 && defined(__AVX2__)
    return (unsigned)_mm256_movemask_pd((__m256d)m);
#else
    unsigned found = 0;
    EACH_LANE(lane) found |= (unsigned)(m[lane] != 0) << lane;
    return found;
#endif
}

static inline vec vec_sqrt(vec x)
{
    vec root;
    EACH_LANE(lane) root[lane] = sqrt(x[lane]);
    return root;
}

/* exp: x = n ln 2 + r, |r| <= ln(2)/2, Taylor to r^13; accurate to about one unit in the last place. Clamped to the
 * range of doubles above, 0 below it.
 */
static inline vec vec_exp(vec x)
{
    mask dead = x < -708.0;
    x = choose(x > 708.0, splat(708.0), choose(dead, splat(-708.0), x));
    const vec magic = splat(6755399441055744.0); /* 1.5 2^52: adding it rounds to an integer */
    vec shifted = x*1.4426950408889634 + magic;
    vec n = shifted - magic;
    vec r = (x - n*6.93147180369123816490e-01) - n*1.90821492927058770002e-10;
    vec p = splat(1.0/6227020800.0);
    p = p*r + 1.0/479001600.0;
    p = p*r + 1.0/39916800.0;
    p = p*r + 1.0/3628800.0;
    p = p*r + 1.0/362880.0;
    p = p*r + 1.0/40320.0;
    p = p*r + 1.0/5040.0;
    p = p*r + 1.0/720.0;
    p = p*r + 1.0/120.0;
    p = p*r + 1.0/24.0;
    p = p*r + 1.0/6.0;
    p = p*r + 0.5;
    p = p*r*r + r;
    word power = ((word)shifted - (word)magic + 1023) << 52;
    return only(~dead, p*(vec)power + (vec)power);
}

/* log: x = 2^n (1 + f), after fdlibm's e_log.c; below one unit in the last place. NaN unless x > 0 and finite. */
static inline vec vec_log(vec x)
{
    mask sound = (x > 0.0) & (x < INFINITY);
    mask small = x < 2.2250738585072014e-308;
    x = choose(small, x*18014398509481984.0, x);
    mask high = (mask)((word)x + (0x3ff0000000000000 - 0x3fe6a09e667f3bcd));
    mask n = (high >> 52) - 1023;
    vec m = (vec)((high & 0x000fffffffffffff) + 0x3fe6a09e667f3bcd);
    vec f = m - 1.0;
    vec s = f/(2.0 + f);
    vec z = s*s;
    vec r = splat(1.479819860511658591e-01);
    r = r*z + 1.531383769920937332e-01;
    r = r*z + 1.818357216161805012e-01;
    r = r*z + 2.222219843214978396e-01;
    r = r*z + 2.857142874366239149e-01;
    r = r*z + 3.999999999940941908e-01;
    r = r*z + 6.666666666666735130e-01;
    r = r*z;
    vec half = 0.5*f*f;
    vec exponent = __builtin_convertvector(n, vec) - only(small, splat(54.0));
    vec result = exponent*6.93147180369123816490e-01 - ((half - (s*(half + r) + exponent*1.90821492927058770002e-10)) - f);
    return choose(sound, result, splat(NAN));
}

/* sin and cos: argument minus a multiple of pi/2 in three parts (|x| < 1e5), then fdlibm's polynomials. */
static inline void vec_sin_cos(vec x, vec *sine, vec *cosine)
{
    const vec magic = splat(6755399441055744.0);
    vec shifted = x*0.63661977236758134308 + magic;
    vec n = shifted - magic;
    word quarter = (word)shifted - (word)magic;
    vec r = ((x - n*1.57079632673412561417) - n*6.07710050630396597660e-11) - n*2.02226624879595063154e-21;
    vec z = r*r;
    vec s = splat(1.58969099521155010221e-10);
    s = s*z - 2.50507602534068634195e-08;
    s = s*z + 2.75573137070700676789e-06;
    s = s*z - 1.98412698298579493134e-04;
    s = s*z + 8.33333333332248946124e-03;
    s = s*z - 1.66666666666666324348e-01;
    s = r + r*z*s;
    vec c = splat(-1.13596475577881948265e-11);
    c = c*z + 2.08757232129817482790e-09;
    c = c*z - 2.75573143513906633035e-07;
    c = c*z + 2.48015872894767294178e-05;
    c = c*z - 1.38888888888741095749e-03;
    c = c*z + 4.16666666666666019037e-02;
    c = 1.0 - (0.5*z - z*z*c);
    mask odd = (quarter & 1) != 0;
    vec a = choose(odd, c, s), b = choose(odd, s, c);
    *sine = (vec)((word)a ^ ((quarter & 2) << 62));
    *cosine = (vec)((word)b ^ (((quarter + 1) & 2) << 62));
}

static inline vec vec_sin(vec x)
{
    vec sine, cosine;
    vec_sin_cos(x, &sine, &cosine);
    return sine;
}

static inline vec vec_cos(vec x)
{
    vec sine, cosine;
    vec_sin_cos(x, &sine, &cosine);
    return cosine;
}

static inline vec vec_tan(vec x)
{
    vec sine, cosine;
    vec_sin_cos(x, &sine, &cosine);
    return sine/cosine;
}
