#pragma once
/* Values and Taylor series over intervals, each with its derivatives by DIRECTIONS: the states at the start of a step, then
 * the parameters. A derivative that is not in the mask is zero. */
#include "interval.h"

enum { DIRECTIONS = STATES + PARAMETERS };

typedef struct {
    iv v, d[DIRECTIONS];
    unsigned mask;
} dual;

typedef struct {
    iv v[TERMS], d[DIRECTIONS][TERMS];
    unsigned mask;
} series;

static _Thread_local unsigned active; /* directions that are followed */
#define EACH_DIRECTION(j, mask) \
    for (unsigned left_ = (mask), j; left_ && (j = (unsigned)__builtin_ctz(left_), 1); left_ &= left_ - 1)
#define HAS(a, j) ((a)->mask >> (j) & 1)

/* ---- values */

static dual d_value(iv v)
{
    dual result;
    result.v = v;
    result.mask = 0;
    return result;
}
static dual d_ratio(double p, double q) { return d_value(iv_div(iv_point(p), iv_point(q))); }
static dual d_pi(void) { return d_value(PI_ENCLOSED); }
static int d_absent(dual a) { return !(iv_width(a.v) >= 0.0); }

/* A function of two values with its partial derivatives. */
static dual d_chain(iv v, const dual *a, iv by_a, const dual *b, iv by_b)
{
    dual result = d_value(v);
    result.mask = a->mask | (b ? b->mask : 0);
    EACH_DIRECTION(j, result.mask) {
        iv sum = HAS(a, j) ? iv_mul(by_a, a->d[j]) : iv_point(0.0);
        result.d[j] = b && HAS(b, j) ? iv_add(sum, iv_mul(by_b, b->d[j])) : sum;
    }
    return result;
}
static dual d_add(dual a, dual b) { return d_chain(iv_add(a.v, b.v), &a, iv_point(1.0), &b, iv_point(1.0)); }
static dual d_mul(dual a, dual b) { return d_chain(iv_mul(a.v, b.v), &a, b.v, &b, a.v); }
static dual d_div(dual a, dual b)
{
    iv v = iv_div(a.v, b.v), inverse = iv_inverse(b.v);
    return d_chain(v, &a, inverse, &b, iv_neg(iv_mul(v, inverse)));
}
static dual d_power(dual a, int n)
{
    dual result = n & 1 ? a : d_value(iv_point(1.0));
    if (n > 1) {
        dual half = d_power(a, n/2);
        dual square = d_chain(iv_square(half.v), &half, iv_mul(iv_point(2.0), half.v), NULL, half.v);
        result = n & 1 ? d_mul(square, a) : square;
    }
    return result;
}
static dual d_exp(dual a)
{
    iv v = iv_exp(a.v);
    return d_chain(v, &a, v, NULL, v);
}
static dual d_log(dual a) { return d_chain(iv_log(a.v), &a, iv_inverse(a.v), NULL, a.v); }
static dual d_root(dual a)
{
    iv v = iv_root(a.v);
    return d_chain(v, &a, iv_inverse(iv_add(v, v)), NULL, v);
}
static dual d_sin(dual a)
{
    iv s, c;
    iv_circular(a.v, &s, &c);
    return d_chain(s, &a, c, NULL, c);
}
static dual d_cos(dual a)
{
    iv s, c;
    iv_circular(a.v, &s, &c);
    return d_chain(c, &a, iv_neg(s), NULL, c);
}
static dual d_tan(dual a) { return d_div(d_sin(a), d_cos(a)); }

/* The larger of two; where it is open which, derivatives are the hull of both (a mean value theorem holds for it). */
static dual d_larger(dual a, dual b)
{
    if (iv_lo(a.v) >= iv_hi(b.v))
        return a;
    if (iv_lo(b.v) >= iv_hi(a.v))
        return b;
    return d_chain((iv){smaller(a.v[0], b.v[0]), larger(a.v[1], b.v[1])}, &a, iv_of(0.0, 1.0), &b, iv_of(0.0, 1.0));
}
static dual d_negative(dual a) { return d_chain(iv_neg(a.v), &a, iv_point(-1.0), NULL, a.v); }
static dual d_smaller(dual a, dual b) { return d_negative(d_larger(d_negative(a), d_negative(b))); }
static dual d_abs(dual a) { return d_larger(a, d_negative(a)); }

/* ---- series */

/* Sum of a[i] b[-i], 0 <= i < n. As `iv_times`, with two products a register where there are eight doubles in one: a product's
 * ends are the larger of neighbours there. */
static inline iv products(const iv *a, const iv *b, int n)
{
    iv sum = iv_point(0.0);
    int i = 0;
#if defined(__AVX512F__)
    const __m512d minus = _mm512_set1_pd(-0.0);
    const __m512i both = _mm512_setr_epi64(0, 1, 0, 1, 2, 3, 2, 3), crossed = _mm512_setr_epi64(2, 3, 3, 2, 0, 1, 1, 0);
    __m512d all = _mm512_setzero_pd();
    __mmask8 odd = 0;
    for (; i + 1 < n; i += 2) {
        const __m512d left = _mm512_permutexvar_pd(both, _mm512_castpd256_pd512(_mm256_loadu_pd((const double *)(a + i))));
        const __m512d right =
            _mm512_permutexvar_pd(crossed, _mm512_castpd256_pd512(_mm256_loadu_pd((const double *)(b - i - 1))));
        const __m512d one = _mm512_mul_pd(left, right); /* hi hi -lo -lo */
        const __m512d two = _mm512_mul_pd((__m512d)((__m512i)left ^ (__m512i)minus), right); /* -lo -lo hi hi */
        const __m512d most = _mm512_max_pd(one, _mm512_shuffle_f64x2(two, two, 0xb1));
        odd |= _mm512_cmp_pd_mask(one, two, _CMP_UNORD_Q);
        all = _mm512_add_pd(all, _mm512_max_pd(most, _mm512_permute_pd(most, 0x55)));
    }
    if (__builtin_expect(odd, 0))
        i = 0;
    else
        sum = (iv){all[2] + all[6], all[0] + all[4]};
#endif
    for (; i < n; i++)
        sum = iv_add(sum, iv_times(a[i], b[-i]));
    return iv_checked(sum);
}

/* Sum of a[i] b[k - i], first <= i <= last. */
static inline iv convolution(const iv *a, const iv *b, int first, int last, int k)
{
    return products(a + first, b + k - first, last - first + 1);
}
static inline iv square_sum(const iv *a, int k)
{
    const iv half = products(a, a + k, (k + 1)/2), sum = iv_add(half, half);
    return k & 1 ? sum : iv_add(sum, iv_square(a[k/2]));
}

static void s_constant(series *z, const dual *a, int k)
{
    if (k == 0)
        z->mask = active & a->mask;
    z->v[k] = k ? iv_point(0.0) : a->v;
    EACH_DIRECTION(j, z->mask) z->d[j][k] = k ? iv_point(0.0) : a->d[j];
}

static void s_linear(series *z, int n, const series *const *a, const dual *const *factor, const dual *offset, int k)
{
    if (k == 0) {
        unsigned mask = offset ? offset->mask : 0;
        for (int i = 0; i < n; i++)
            mask |= a[i]->mask | factor[i]->mask;
        z->mask = mask & active;
    }
    iv sum = k == 0 && offset ? offset->v : iv_point(0.0);
    for (int i = 0; i < n; i++)
        sum = iv_add(sum, iv_times(factor[i]->v, a[i]->v[k]));
    z->v[k] = iv_checked(sum);
    EACH_DIRECTION(j, z->mask) {
        sum = k == 0 && offset && HAS(offset, j) ? offset->d[j] : iv_point(0.0);
        for (int i = 0; i < n; i++) {
            if (HAS(a[i], j))
                sum = iv_add(sum, iv_times(factor[i]->v, a[i]->d[j][k]));
            if (HAS(factor[i], j))
                sum = iv_add(sum, iv_times(factor[i]->d[j], a[i]->v[k]));
        }
        z->d[j][k] = iv_checked(sum);
    }
}

static void s_scaled(series *z, const series *a, const dual *factor, int k)
{
    s_linear(z, 1, &a, &factor, NULL, k);
}

static void s_product(series *z, const series *a, const series *b, const dual *factor, int k)
{
    if (k == 0)
        z->mask = active & (a->mask | b->mask | (factor ? factor->mask : 0));
    const iv plain = convolution(a->v, b->v, 0, k, k);
    z->v[k] = factor ? iv_mul(factor->v, plain) : plain;
    EACH_DIRECTION(j, z->mask) {
        iv sum = HAS(a, j) ? convolution(a->d[j], b->v, 0, k, k) : iv_point(0.0);
        if (HAS(b, j))
            sum = iv_add(sum, convolution(a->v, b->d[j], 0, k, k));
        if (factor)
            sum = iv_mul(factor->v, sum);
        if (factor && HAS(factor, j))
            sum = iv_add(sum, iv_mul(factor->d[j], plain));
        z->d[j][k] = sum;
    }
}

static void s_square(series *z, const series *a, int k)
{
    if (k == 0)
        z->mask = active & a->mask;
    z->v[k] = square_sum(a->v, k);
    EACH_DIRECTION(j, z->mask) z->d[j][k] = iv_mul(iv_point(2.0), convolution(a->d[j], a->v, 0, k, k));
}

/* z b = a, or z b = 1 without a. */
static void s_ratio(series *z, const series *a, const series *b, int k)
{
    if (k == 0)
        z->mask = active & ((a ? a->mask : 0) | b->mask);
    const iv first = iv_inverse(b->v[0]);
    iv known = a ? a->v[k] : iv_point(k ? 0.0 : 1.0);
    z->v[k] = iv_mul(first, iv_sub(known, convolution(z->v, b->v, 0, k - 1, k)));
    EACH_DIRECTION(j, z->mask) {
        known = a && HAS(a, j) ? a->d[j][k] : iv_point(0.0);
        if (HAS(b, j))
            known = iv_sub(known, convolution(z->v, b->d[j], 0, k, k));
        z->d[j][k] = iv_mul(first, iv_sub(known, convolution(z->d[j], b->v, 0, k - 1, k)));
    }
}
static void s_quotient(series *z, const series *a, const series *b, int k) { s_ratio(z, a, b, k); }
static void s_reciprocal(series *z, const series *a, int k) { s_ratio(z, NULL, a, k); }

static void s_root(series *z, const series *a, int k)
{
    if (k == 0) {
        z->mask = active & a->mask;
        z->v[0] = iv_root(a->v[0]);
    }
    const iv first = iv_inverse(z->v[0]), half = iv_mul(iv_point(0.5), first);
    if (k)
        z->v[k] = iv_mul(half, iv_sub(a->v[k], convolution(z->v, z->v, 1, k - 1, k)));
    EACH_DIRECTION(j, z->mask)
        z->d[j][k] = iv_mul(first, iv_sub(iv_mul(iv_point(0.5), a->d[j][k]), convolution(z->d[j], z->v, 0, k - 1, k)));
}

/* Sum of i a[i] b[k - i] over 0 < i <= last, over k. */
static iv slope_sum(const iv *a, const iv *b, int last, int k)
{
    iv sum = iv_point(0.0);
    for (int i = 1; i <= last; i++)
        sum = iv_add(sum, iv_times((iv){i, i}*a[i], b[k - i]));
    return iv_mul(RECIPROCAL[k], sum);
}

static void s_exp(series *z, const series *a, int k)
{
    if (k == 0)
        z->mask = active & a->mask;
    z->v[k] = k ? slope_sum(a->v, z->v, k, k) : iv_exp(a->v[0]);
    EACH_DIRECTION(j, z->mask) z->d[j][k] = convolution(a->d[j], z->v, 0, k, k);
}

static void s_log(series *z, const series *a, int k)
{
    if (k == 0)
        z->mask = active & a->mask;
    const iv first = iv_inverse(a->v[0]);
    z->v[k] = k ? iv_mul(first, iv_sub(a->v[k], slope_sum(z->v, a->v, k - 1, k))) : iv_log(a->v[0]);
    EACH_DIRECTION(j, z->mask)
        z->d[j][k] = iv_mul(first, iv_sub(a->d[j][k], convolution(z->d[j], a->v, 0, k - 1, k)));
}

static void s_circular(series *sine, series *cosine, const series *a, int k)
{
    if (k == 0) {
        sine->mask = cosine->mask = active & a->mask;
        iv_circular(a->v[0], &sine->v[0], &cosine->v[0]);
    } else {
        sine->v[k] = slope_sum(a->v, cosine->v, k, k);
        cosine->v[k] = iv_neg(slope_sum(a->v, sine->v, k, k));
    }
    EACH_DIRECTION(j, a->mask & active) {
        sine->d[j][k] = convolution(a->d[j], cosine->v, 0, k, k);
        cosine->d[j][k] = iv_neg(convolution(a->d[j], sine->v, 0, k, k));
    }
}

/* Coefficient k + 1 of a state from coefficient k of its rate, a series or a constant. */
static void s_advance(series *state, const series *rate, const dual *constant, int k)
{
    const unsigned mask = rate ? rate->mask : constant->mask & active;
    const iv zero = iv_point(0.0);
    if (k == 0) { /* a direction that the rate brings in was zero at order 0 */
        EACH_DIRECTION(j, mask & ~state->mask) state->d[j][0] = zero;
        state->mask |= mask;
    }
    state->v[k + 1] = iv_mul(RECIPROCAL[k + 1], rate ? rate->v[k] : k ? zero : constant->v);
    EACH_DIRECTION(j, state->mask) {
        iv slope = !(mask >> j & 1) ? zero : rate ? rate->d[j][k] : k ? zero : constant->d[j];
        state->d[j][k + 1] = iv_mul(RECIPROCAL[k + 1], slope);
    }
}

static iv horner(const iv *c, int order, iv t)
{
    iv sum = c[order];
    for (int k = order - 1; k >= 0; k--)
        sum = iv_add(c[k], iv_mul(t, sum));
    return sum;
}
static iv horner_slope(const iv *c, int order, iv t)
{
    iv sum = iv_mul(iv_point(order), c[order]);
    for (int k = order - 1; k > 0; k--)
        sum = iv_add(iv_mul(iv_point(k), c[k]), iv_mul(t, sum));
    return sum;
}
