/* The first root of a polynomial on (0, 1], by isolation: Descartes' rule on Bernstein coefficients.
 *
 * Without sign variation there is no root. With one there is exactly one root, found by bracketed Newton iteration.
 * With more the interval is halved. So double crossings are found and grazes decided without sampling.
 */
#pragma once

#include "settings.h"
#include <math.h>
#include <string.h>

enum { DEEPEST = 200 };
static const double NARROWEST = 4e-15; /* interval, relative to its end: a step may be much longer than the time to a root */
static const double NO_ROOT = 2.0;

/* The single root in [low, high]; the polynomial has opposite signs at the ends. */
static double refined(const double *a, int order, double low, double high, int low_positive)
{
    double t = 0.5*(low + high);
    for (int count = 0; count < 100; count++) {
        double value = a[order], slope = 0.0;
        for (int k = order - 1; k >= 0; k--) {
            slope = slope*t + value;
            value = value*t + a[k];
        }
        if (value == 0.0)
            return t;
        if ((value > 0.0) == low_positive)
            low = t;
        else
            high = t;
        double newton = t - value/slope;
        double next = newton > low && newton < high ? newton : 0.5*(low + high);
        if (fabs(next - t) <= 4e-16*next || high - low <= 4e-16*high)
            return next;
        t = next;
    }
    return 0.5*(low + high);
}

static double isolated(const double *a, int order, const double *b, double low, double high, int depth)
{
    int variations = 0, sign = 0;
    for (int k = 0; k <= order; k++) {
        int here = (b[k] > 0.0) - (b[k] < 0.0);
        if (here && sign && here != sign)
            variations++;
        if (here)
            sign = here;
    }
    if (variations == 0)
        return NO_ROOT;
    if (variations == 1)
        return refined(a, order, low, high, b[0] > 0.0 || (b[0] == 0.0 && sign < 0));
    if (depth == DEEPEST || high - low <= NARROWEST*high)
        return NO_ROOT; /* touches zero to rounding: not counted as a root */
    double left[TERMS + 1], right[TERMS + 1];
    memcpy(right, b, sizeof(double)*(size_t)(order + 1));
    for (int k = 0; k <= order; k++) {
        left[k] = right[0];
        for (int j = 0; j < order - k; j++)
            right[j] = 0.5*(right[j] + right[j + 1]);
    }
    double middle = 0.5*(low + high);
    double first = isolated(a, order, left, low, middle, depth + 1);
    /* after the halving, right[] holds the coefficients of the second half */
    return first < NO_ROOT ? first : isolated(a, order, right, middle, high, depth + 1);
}
