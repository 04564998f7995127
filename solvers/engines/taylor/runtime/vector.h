/* Lanes: several doubles side by side, with the functions that recurrences start from.
 *
 * LANES is 8, 4 or 2 with the vector extensions of gcc and clang; 1 is plain C99 (and C++). Compiled without -ffast-math:
 * comparisons with NaN are false, infinities are respected, and loops treat a comparison that is not true as a case to
 * examine.
 */
#pragma once

#include "settings.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Two instructions of x86, under the compiler's own names: <immintrin.h> is eight times as much text as the kernel.
   GCC before version 10 cannot be asked, and has them. */
#if defined(__has_builtin)
#define HAS_BUILTIN(name) __has_builtin(name)
#else
#define HAS_BUILTIN(name) 1
#endif

#if defined(__cplusplus)
#define RESTRICT
#else
#define RESTRICT restrict
#endif

#if defined(__GNUC__)
#define INLINE static inline __attribute__((always_inline))
#define OUTLINE static __attribute__((noinline))
#define UNROLL _Pragma("GCC unroll 32")
#else
#define INLINE static inline
#define OUTLINE static
#define UNROLL
#endif
/* Long code without branches: gcc arranges it before registers are assigned, which x86 has too few of by default. */
#if defined(__GNUC__) && !defined(__clang__)
#define SCHEDULED __attribute__((optimize("schedule-insns", "sched-pressure")))
#else
#define SCHEDULED
#endif
/* True or no program; C99 has no static assertions. */
#define STATIC_ASSERT(condition) extern char static_assertion[(condition) ? 1 : -1]

/* A lane of a vec or mask; a mask's lane is TRUTH or 0. `pattern` has the bits of doubles, `to_vec` converts. */
#if LANES > 1
typedef double vec __attribute__((vector_size(8*LANES)));
typedef int64_t mask __attribute__((vector_size(8*LANES)));
typedef uint64_t word __attribute__((vector_size(8*LANES))); /* bits of a double, with defined overflow */

#define LANE(x, lane) ((x)[lane])
#define NOT(m) (~(m))
enum { TRUTH = -1 };

INLINE vec splat(double x)
{
    const vec zero = {0.0};
    return x - zero;
}

INLINE mask splat_mask(int64_t x)
{
    const mask zero = {0};
    return x - zero;
}

INLINE word pattern(vec x)
{
    return (word)x;
}

INLINE vec from_pattern(word x)
{
    return (vec)x;
}

INLINE vec only(mask m, vec x)
{
    return (vec)((mask)x & m);
}

INLINE vec choose(mask m, vec a, vec b)
{
    return (vec)(((mask)a & m) | ((mask)b & ~m));
}

/* `only` for integers. */
INLINE mask only_whole(mask m, mask x)
{
    return x & m;
}

INLINE mask choose_whole(mask m, mask a, mask b)
{
    return (a & m) | (b & ~m);
}

INLINE vec to_vec(mask x)
{
    return __builtin_convertvector(x, vec);
}

INLINE mask to_whole(vec x)
{
    return __builtin_convertvector(x, mask);
}
#else
typedef double vec;
typedef int64_t mask;
typedef uint64_t word;

#define LANE(x, lane) (*((void)(lane), &(x)))
#define NOT(m) (!(m))
enum { TRUTH = 1 };

INLINE vec splat(double x)
{
    return x;
}

INLINE mask splat_mask(int64_t x)
{
    return x;
}

INLINE word pattern(vec x)
{
    word result;
    memcpy(&result, &x, sizeof result);
    return result;
}

INLINE vec from_pattern(word x)
{
    vec result;
    memcpy(&result, &x, sizeof result);
    return result;
}

INLINE vec only(mask m, vec x)
{
    return m ? x : 0.0;
}

INLINE vec choose(mask m, vec a, vec b)
{
    return m ? a : b;
}

/* `only` for integers. */
INLINE mask only_whole(mask m, mask x)
{
    return m ? x : 0;
}

INLINE mask choose_whole(mask m, mask a, mask b)
{
    return m ? a : b;
}

INLINE vec to_vec(mask x)
{
    return (double)x;
}

INLINE mask to_whole(vec x)
{
    return (int64_t)x;
}
#endif

#define EACH_LANE(lane) for (int lane = 0; lane < LANES; lane++)
/* Each lane of a set of bits, in ascending order. */
#define EACH_OF(lane, set) \
    for (unsigned left_of_##lane = (set); left_of_##lane; left_of_##lane &= left_of_##lane - 1) \
        for (int lane = first_of(left_of_##lane), once_##lane = 1; once_##lane; once_##lane = 0)

static const uint64_t SIGN = 0x8000000000000000; /* of a double */
static const double PI = 3.14159265358979323846;

static inline vec vec_abs(vec x)
{
    return from_pattern(pattern(x) & ~SIGN);
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
    return choose_whole(less, a, b);
}

/* The lanes of a mask as bits. */
static inline unsigned bits(mask m)
{
#if LANES >= 8 && defined(__AVX512DQ__) && HAS_BUILTIN(__builtin_ia32_cvtq2mask512)
    typedef long long eight __attribute__((vector_size(64)));
    eight part[LANES/8];
    unsigned result = 0;
    memcpy(part, &m, sizeof m);
    for (int k = 0; k < LANES/8; k++) result |= (unsigned)__builtin_ia32_cvtq2mask512(part[k]) << (8*k);
    return result;
#elif LANES == 4 && defined(__AVX2__) && HAS_BUILTIN(__builtin_ia32_movmskpd256)
    return (unsigned)__builtin_ia32_movmskpd256((vec)m);
#else
    unsigned result = 0;
    EACH_LANE(lane) result |= (unsigned)(LANE(m, lane) != 0) << lane;
    return result;
#endif
}

static inline double in_lane(vec x, int lane)
{
    return LANE(x, lane);
}

/* The first lane of some, as bits. */
static inline int first_of(unsigned lanes)
{
#if defined(__GNUC__)
    return __builtin_ctz(lanes);
#else
    int lane = 0;
    while (!(lanes >> lane & 1))
        lane++;
    return lane;
#endif
}

static inline vec vec_sqrt(vec x)
{
    vec root = x;
    EACH_LANE(lane) LANE(root, lane) = sqrt(LANE(x, lane));
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
    vec power = from_pattern((pattern(shifted) - pattern(magic) + 1023) << 52);
    return only(NOT(dead), p*power + power);
}

/* log: x = 2^n (1 + f), after fdlibm's e_log.c; below one unit in the last place. NaN unless x > 0 and finite. */
static inline vec vec_log(vec x)
{
    mask sound = (x > 0.0) & (x < HUGE_VAL);
    mask small = x < 2.2250738585072014e-308;
    x = choose(small, x*18014398509481984.0, x);
    mask high = (mask)(pattern(x) + (0x3ff0000000000000 - 0x3fe6a09e667f3bcd));
    mask n = (high >> 52) - 1023;
    vec m = from_pattern((word)((high & 0x000fffffffffffff) + 0x3fe6a09e667f3bcd));
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
    vec exponent = to_vec(n) - only(small, splat(54.0));
    vec result = exponent*6.93147180369123816490e-01 - ((half - (s*(half + r) + exponent*1.90821492927058770002e-10)) - f);
    return choose(sound, result, splat((double)NAN));
}

/* sin and cos: argument minus a multiple of pi/2 in three parts (|x| < 1e5), then fdlibm's polynomials. */
static inline void vec_sin_cos(vec x, vec *sine, vec *cosine)
{
    const vec magic = splat(6755399441055744.0);
    vec shifted = x*0.63661977236758134308 + magic;
    vec n = shifted - magic;
    word quarter = pattern(shifted) - pattern(magic);
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
    *sine = from_pattern(pattern(a) ^ ((quarter & 2) << 62));
    *cosine = from_pattern(pattern(b) ^ (((quarter + 1) & 2) << 62));
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

/* atan: reduced to |r| <= 7/16 by atan x = atan c + atan((x - c)/(1 + c x)), after fdlibm's s_atan.c. */
static inline vec vec_atan(vec x)
{
    vec size = vec_abs(x), over = size, under = splat(1.0), high = splat(0.0), low = splat(0.0);
    mask far = size > 0.4375;
    over = choose(far, 2.0*size - 1.0, over);
    under = choose(far, 2.0 + size, under);
    high = choose(far, splat(4.63647609000806093515e-01), high);
    low = choose(far, splat(2.26987774529616870924e-17), low);
    far = size > 0.6875;
    over = choose(far, size - 1.0, over);
    under = choose(far, size + 1.0, under);
    high = choose(far, splat(7.85398163397448278999e-01), high);
    low = choose(far, splat(3.06161699786838301793e-17), low);
    far = size > 1.1875;
    over = choose(far, size - 1.5, over);
    under = choose(far, 1.0 + 1.5*size, under);
    high = choose(far, splat(9.82793723247329054082e-01), high);
    low = choose(far, splat(1.39033110312309984516e-17), low);
    far = size > 2.4375;
    over = choose(far, splat(-1.0), over);
    under = choose(far, size, under);
    high = choose(far, splat(1.57079632679489655800e+00), high);
    low = choose(far, splat(6.12323399573676603587e-17), low);
    vec r = over/under, z = r*r, s = splat(1.62858201153657823623e-02);
    s = s*z - 3.65315727442169155270e-02;
    s = s*z + 4.97687799461593236017e-02;
    s = s*z - 5.83357013379057348645e-02;
    s = s*z + 6.66107313738753120669e-02;
    s = s*z - 7.69187620504482999495e-02;
    s = s*z + 9.09088713343650656196e-02;
    s = s*z - 1.11111104054623557880e-01;
    s = s*z + 1.42857142725034663711e-01;
    s = s*z - 1.99999999998764832476e-01;
    s = s*z + 3.33333333333329318027e-01;
    vec result = high - ((r*z*s - low) - r);
    return from_pattern(pattern(result) | (pattern(x) & SIGN));
}
