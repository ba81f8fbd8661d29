/* record.c -- prepare the input of both engines: check the samples, subtract their trend, and scale
 * them so that nothing overflows or underflows. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/versions.h"
#include "map/plan.h"

enum { LANES = 8 };

/* max|x|; infinity if x contains NaN or infinity. */
VERSIONS static double
largest(const double *x, size_t n)
{
    double most[LANES] = { 0 };
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            most[l] = fabs(x[i + l]) <= most[l] ? most[l]
                : fabs(x[i + l]) <= DBL_MAX ? fabs(x[i + l]) : INFINITY;
    for (; i < n; i++)
        most[0] = fabs(x[i]) <= most[0] ? most[0] : fabs(x[i]) <= DBL_MAX ? fabs(x[i]) : INFINITY;
    for (size_t l = 1; l < LANES; l++)
        most[0] = fmax(most[0], most[l]);
    return most[0];
}

VERSIONS static void
multiply(double *x, size_t n, double factor, double least)
{
    for (size_t i = 0; i < n; i++) {
        double kept = fabs(x[i]) < least ? 0 : x[i];
        x[i] = kept * factor;
    }
}

void
ss_morlet_divide(double *x, size_t n, int exponent, double most)
{
    double least = ldexp(most, -900);
    int left = -exponent;
    do {                                    /* 2^-exponent may be too large for a double */
        int step = left > 1000 ? 1000 : left < -1000 ? -1000 : left;
        multiply(x, n, ldexp(1, step), least);
        least = 0;
        left -= step;
    } while (left != 0);
}

static void
normalise(record *rec, double most)
{
    int e;
    frexp(most, &e);
    ss_morlet_divide(rec->x, rec->n, e, most);
    rec->exponent += e;
}

/* Subtract the mean, or the line of least squares.  The sums are over differences from the first sample,
 * so that a constant record becomes exactly 0. */
static void
subtract(record *rec, ss_detrend detrend)
{
    long double mean = 0, slope = 0, mid = (long double)(rec->n - 1) / 2, n = rec->n;
    double x0 = rec->x[0];
    for (size_t i = 0; i < rec->n; i++)
        mean += (long double)rec->x[i] - x0;
    mean /= n;
    if (detrend == SS_DETREND_LINEAR && rec->n > 1) {
        for (size_t i = 0; i < rec->n; i++)
            slope += (i - mid) * ((long double)rec->x[i] - x0 - mean);
        slope /= n * (n * n - 1) / 12;
    }
    for (size_t i = 0; i < rec->n; i++)
        rec->x[i] = (double)((long double)rec->x[i] - x0 - mean - slope * (i - mid));
}

size_t
ss_morlet_finite(const double *x, size_t n, double *most)
{
    *most = largest(x, n);
    if (*most <= DBL_MAX)
        return n;
    for (n = 0; isfinite(x[n]); n++)
        ;
    *most = largest(x, n);
    return n;
}

ss_status
ss_morlet_not_finite(ss_error *err, size_t number, double x)
{
    return ss_fail(err, SS_EINVAL, "sample %zu is %s, not a finite number", number, isnan(x) ? "NaN" : "infinite");
}

ss_status
ss_morlet_record(record *rec, const double *x, size_t n, ss_detrend detrend, ss_error *err)
{
    double most;
    size_t good = ss_morlet_finite(x, n, &most);
    if (good < n)
        return ss_morlet_not_finite(err, good + 1, x[good]);
    *rec = (record){ .n = n, .x = n <= SIZE_MAX / sizeof *x ? malloc(n * sizeof *x) : NULL };
    if (rec->x == NULL)
        return SS_ENOMEM;
    memcpy(rec->x, x, n * sizeof *x);
    normalise(rec, most);
    if (detrend != SS_DETREND_NONE) {
        subtract(rec, detrend);
        normalise(rec, largest(rec->x, n));
    }
    return SS_OK;
}

/* x 2^exponent, rounded as ldexp does.  A subnormal number is made from its bits, which count units of 2^-1074,
 * since some processors take 100 times as long to compute one.  all is 2^exponent in these units, or infinity. */
static double
move_exponent(double x, int exponent, double all)
{
    double units = fabs(x) * all, y;
    if (!(units < 0x1p52))
        return ldexp(x, exponent);
    uint64_t bits = (uint64_t)rint(units);
    memcpy(&y, &bits, sizeof y);
    return copysign(y, x);
}

ss_status
ss_morlet_finish(double *w, size_t n, double a, ss_norm norm, int exponent, ss_error *err)
{
    double factor = norm == SS_NORM_L1 ? 1 : sqrt(a);
    double all = exponent < -500 ? ldexp(1, exponent + 1074) : INFINITY;
    for (size_t i = 0; i < 2 * n; i++) {
        w[i] = move_exponent(w[i] * factor, exponent, all);
        if (!isfinite(w[i]))
            return ss_fail(err, SS_EINVAL, "coefficients at scale %g s exceed what a double holds", a);
    }
    return SS_OK;
}
