/* record.c -- the samples as both engines take them: checked, detrended and of a size that neither
 * overflows nor underflows. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "error.h"
#include "morlet/plan.h"

static void
normalise(record *rec)
{
    double most = 0;
    int e;
    for (size_t i = 0; i < rec->n; i++)
        most = fmax(most, fabs(rec->x[i]));
    rec->x_max = frexp(most, &e);
    for (size_t i = 0; i < rec->n; i++)
        rec->x[i] = ldexp(rec->x[i], -e);
    rec->exponent += e;
}

/* Subtract the mean, or the line of least squares.  Sums are of differences to the first sample:
 * what is constant leaves exactly nothing. */
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

ss_status
ss_morlet_record(record *rec, const double *x, size_t n, ss_detrend detrend, ss_error *err)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EINVAL, "sample %zu is %s, not a finite number", i + 1,
                           isnan(x[i]) ? "NaN" : "infinite");
    *rec = (record){ .n = n, .x = n <= SIZE_MAX / sizeof *x ? malloc(n * sizeof *x) : NULL };
    if (rec->x == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        rec->x[i] = x[i];
    normalise(rec);
    if (detrend != SS_DETREND_NONE) {
        subtract(rec, detrend);
        normalise(rec);
    }
    return SS_OK;
}
