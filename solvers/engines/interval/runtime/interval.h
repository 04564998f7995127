#pragma once
/* Intervals of doubles as (-lo, hi), so that rounding upward rounds both ends outward. The rounding mode is upward
 * wherever these functions run. An unbounded end is an infinity; what cannot be enclosed is the whole line. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>
#if defined(__AVX__)
#include <immintrin.h>
#endif

typedef double iv __attribute__((vector_size(16)));

static inline iv iv_of(double lo, double hi) { return (iv){-lo, hi}; }
static inline iv iv_point(double x) { return (iv){-x, x}; }
static inline double iv_lo(iv a) { return -a[0]; }
static inline double iv_hi(iv a) { return a[1]; }
static inline iv iv_swap(iv a) { return (iv){a[1], a[0]}; }
static inline iv iv_line(void) { return (iv){INFINITY, INFINITY}; }
static inline iv iv_ball(double radius) { return (iv){radius, radius}; }
static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double smaller(double a, double b) { return a < b ? a : b; }
static inline iv iv_add(iv a, iv b) { return a + b; }
static inline iv iv_neg(iv a) { return iv_swap(a); }
static inline iv iv_sub(iv a, iv b) { return a + iv_swap(b); }
static inline double iv_width(iv a) { return a[0] + a[1]; }
static inline double iv_magnitude(iv a) { return larger(fabs(a[0]), fabs(a[1])); }
static inline iv iv_hull(iv a, iv b) { return (iv){larger(a[0], b[0]), larger(a[1], b[1])}; }
static inline iv iv_meet(iv a, iv b) { return (iv){smaller(a[0], b[0]), smaller(a[1], b[1])}; }
static inline int iv_within(iv a, iv b) { return a[0] <= b[0] && a[1] <= b[1]; }
static inline int iv_finite(iv a) { return fabs(a[0]) <= DBL_MAX && fabs(a[1]) <= DBL_MAX; }
static inline int iv_positive(iv a) { return a[0] < 0.0; }
static inline int iv_negative(iv a) { return a[1] < 0.0; }

static inline double iv_middle(iv a)
{
    double middle = 0.5*iv_lo(a) + 0.5*iv_hi(a);
    return smaller(larger(middle, iv_lo(a)), iv_hi(a));
}

/* A product with an infinite end: times zero it is zero, as the end is no member. NaN makes it the whole line. */
static iv unbounded_product(iv a, iv b)
{
    const double left[2] = {-a[0], a[1]}, right[2] = {-b[0], b[1]};
    iv all = {-INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) {
        const double x = left[i & 1], y = right[i >> 1];
        if (x != x || y != y)
            return iv_line();
        all = iv_hull(all, x == 0.0 || y == 0.0 ? iv_point(0.0) : (iv){-x*y, x*y});
    }
    return all;
}

/* `iv_checked` makes a sum of products with an end that is NaN the whole line. */
static inline iv iv_times(iv a, iv b)
{
#if defined(__AVX__)
    const __m256d left = _mm256_broadcast_pd((const __m128d *)&a), minus = _mm256_set1_pd(-0.0);
    const __m256d right = _mm256_set_m128d((__m128d)iv_swap(b), (__m128d)b);
    __m256d one = _mm256_mul_pd(left, right); /* hi hi -lo -lo */
    __m256d two = _mm256_mul_pd(_mm256_xor_pd(left, minus), right); /* -lo -lo hi hi */
    if (__builtin_expect(_mm256_movemask_pd(_mm256_cmp_pd(one, two, _CMP_UNORD_Q)), 0))
        return unbounded_product(a, b);
    one = _mm256_max_pd(one, _mm256_permute2f128_pd(two, two, 1));
    const __m128d low = _mm256_castpd256_pd128(one), high = _mm256_extractf128_pd(one, 1);
    return (iv)_mm_max_pd(_mm_unpacklo_pd(high, low), _mm_unpackhi_pd(high, low));
#else
    if (__builtin_expect(!(iv_finite(a) && iv_finite(b)), 0))
        return unbounded_product(a, b);
    return (iv){larger(larger(a[0]*b[1], a[1]*b[0]), larger(-a[0]*b[0], -a[1]*b[1])),
        larger(larger(a[0]*b[0], a[1]*b[1]), larger(-a[0]*b[1], -a[1]*b[0]))};
#endif
}
static inline iv iv_checked(iv a) { return a[0] + a[1] >= 0.0 ? a : iv_line(); }
static inline iv iv_mul(iv a, iv b) { return iv_checked(iv_times(a, b)); }

static inline iv iv_inverse(iv b)
{
    if (!(iv_positive(b) || iv_negative(b)))
        return iv_line();
    return iv_swap((iv){-1.0, -1.0}/b);
}

static inline iv iv_div(iv a, iv b)
{
    if (a[0] == -a[1] && b[0] == -b[1] && b[1] != 0.0) { /* points: rounded once */
        double up = a[1]/b[1], down = -a[1]/b[1];
        return up + down >= 0.0 ? (iv){down, up} : iv_line();
    }
    return iv_mul(a, iv_inverse(b));
}

static inline iv iv_square(iv a)
{
    double far = iv_magnitude(a), near = iv_positive(a) ? iv_lo(a) : iv_negative(a) ? -iv_hi(a) : 0.0;
    return iv_finite(a) ? (iv){-near*near, far*far} : (iv){0.0, INFINITY};
}

/* The square root of a double, rounded down; the machine rounds it up. */
static inline double root_below(double x)
{
    double root = sqrt(x);
    if (!(root > 0.0) || root*root <= x)
        return larger(root, 0.0);
    return nextafter(root, 0.0);
}

static inline iv iv_root(iv a)
{
    if (!(iv_lo(a) >= 0.0))
        return iv_line();
    return iv_of(root_below(iv_lo(a)), sqrt(iv_hi(a)));
}

/* ---- exponential, logarithm, circular functions: series with their remainder */

static iv RECIPROCAL[64]; /* 1/k, set by `interval_start` */

static const iv PI_ENCLOSED = {-0x1.921fb54442d18p+1, 0x1.921fb54442d19p+1};
static const double LN2_HIGH = 0x1.62e42feep-1; /* its product with an exponent is exact */
static const iv LN2_LOW = {-0x1.a39ef35793c75p-33, 0x1.a39ef35793c77p-33};

/* The lower end of exp(low) and the upper end of exp(high) at once, within -700..709. What is left of an exponent without a
 * multiple of log 2 is no less than 0, so that rounding goes one way throughout. The terms from the sixteenth on sum to 1 to
 * 1.05 times that one (derive/checks/enclosure.py). */
static iv exp_of_ends(double low, double high)
{
    const iv x = {-low, high}, sign = {-1.0, 1.0};
    iv sum = {-1.0, 1.05}, rest, scale;
    for (int i = 0; i < 2; i++) {
        double n = floor(sign[i]*x[i]*1.4426950408889634) + 1.0;
        do {
            n -= 1.0;
            rest[i] = x[i] - sign[i]*n*LN2_HIGH + iv_mul(iv_point(-n), LN2_LOW)[i];
        } while (sign[i]*rest[i] < 0.0);
        scale[i] = ldexp(1.0, (int)n);
    }
    for (int k = 16; k > 0; k--)
        sum = sign + sum*(sign*(rest*(sign*RECIPROCAL[k])));
    return sum*scale;
}

static iv iv_exp(iv a)
{
    const double low = iv_lo(a), high = iv_hi(a);
    if (!(a[0] + a[1] >= 0.0))
        return iv_line();
    const iv ends = exp_of_ends(smaller(larger(low, -700.0), 709.0), smaller(larger(high, -700.0), 709.0));
    return iv_of(low < -700.0 ? 0.0 : iv_lo(ends), high > 709.0 ? INFINITY : iv_hi(ends));
}

/* By one correction of an approximation y: log x = y + log(1 + d), d = x exp(-y) - 1, d - d^2 <= log(1 + d) <= d. */
static iv iv_log(iv a)
{
    if (!(iv_lo(a) >= 0.0) || !(iv_hi(a) > 0.0))
        return iv_line();
    const double x[2] = {smaller(larger(iv_lo(a), DBL_TRUE_MIN), DBL_MAX), smaller(iv_hi(a), DBL_MAX)};
    double part[2], y[2];
    iv of_power;
    for (int i = 0; i < 2; i++) {
        int exponent;
        part[i] = frexp(x[i], &exponent);
        if (part[i] < 0.75) {
            part[i] *= 2.0;
            exponent -= 1;
        }
        y[i] = log(part[i]);
        of_power[i] = iv_add(iv_point(exponent*LN2_HIGH), iv_mul(iv_point(exponent), LN2_LOW))[i];
    }
    iv d = exp_of_ends(-y[0], -y[1])*(iv){part[0], part[1]} + (iv){1.0, -1.0};
    if (!(iv_magnitude(d) < 0.5))
        return iv_line();
    d[0] += d[0]*d[0];
    d += (iv){-y[0], y[1]} + of_power;
    return iv_of(iv_lo(a) > 0.0 ? iv_lo(d) : -INFINITY, iv_hi(a) <= DBL_MAX ? iv_hi(d) : INFINITY);
}

/* Sine and cosine about the middle of an interval; of more than one turn they are only bounded. */
static void iv_circular(iv a, iv *sine, iv *cosine)
{
    const iv unit = iv_of(-1.0, 1.0);
    double x = iv_middle(a);
    *sine = *cosine = unit;
    if (!iv_finite(a) || !(fabs(x) < 3.3) || !(iv_width(a) < 1.0))
        return;
    iv away = iv_sub(a, iv_point(x)), power = iv_point(1.0), sums[2] = {iv_point(0.0), iv_point(0.0)};
    for (int k = 0; k < 36; k++) { /* 3.3^36/36! < 2e-23, and the rest is less than as much again */
        sums[k & 1] = k & 2 ? iv_sub(sums[k & 1], power) : iv_add(sums[k & 1], power);
        power = iv_mul(iv_mul(power, iv_point(x)), RECIPROCAL[k + 1]);
    }
    iv c = iv_add(sums[0], iv_ball(1e-22)), s = iv_add(sums[1], iv_ball(1e-22));
    iv spread = iv_ball(iv_magnitude(away));
    iv slope = iv_meet(iv_add(c, spread), unit), fall = iv_meet(iv_add(s, spread), unit);
    *sine = iv_meet(iv_add(s, iv_mul(slope, away)), unit);
    *cosine = iv_meet(iv_sub(c, iv_mul(fall, away)), unit);
}

static void set_tables(void)
{
    for (int k = 1; k < 64; k++)
        RECIPROCAL[k] = iv_div(iv_point(1.0), iv_point(k));
}
