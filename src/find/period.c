/* period.c -- the time after which a signal repeats itself.
 *
 * The largest line of a spectrum may be any harmonic, and the fundamental may be missing; what all
 * of them share is the period. It is the lag of the first peak of the autocorrelation that is nearly
 * as high as the highest. The autocorrelation is that of the spectrum's magnitude instead of its
 * square (Tolonen and Karjalainen 2000, "compressed"): else one strong line makes peaks of its own
 * and a slow drift hides them all. Peaks at the multiples of the lag then refine it, and their
 * scatter is its error. */
#include "find/cycles.h"

#include <math.h>
#include "base/fft.h"
#include "find/judgement.h"
#include "map/map.h"

/* The least correlation that counts, unless white noise, of standard deviation n^-1/2, reaches more at some of n
 * lags. Irregular slips reach 0.05, drifting ones that still repeat 0.3. */
#define LEAST 0.15
enum { MULTIPLES = 32 };        /* of a lag, at which a signal must still be like itself */

/* The autocorrelation of n samples, compressed, at lags 0 ... n - 1, 1 at 0: r->x, to be freed with r. */
static ss_status
autocorrelation(real_fft *r, const double *x, size_t n)
{
    double mean = 0, largest = 0;
    size_t rest = 0, size = 2 * (n + n / 8) - 2;    /* a circle, whose ends do not meet */
    while (rest != 1) {                 /* without a prime factor above 5 the FFT is fast */
        rest = size += 2;
        for (size_t prime = 2; prime <= 5; prime++)
            while (rest % prime == 0)
                rest /= prime;
    }
    if (ss_real_fft_new(r, size, 0) != SS_OK)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        mean += x[i] / (double)n;
        largest = fmax(largest, fabs(x[i]));
    }
    for (size_t i = 0; i < size; i++)
        r->x[i] = i < n && largest > 0 ? (x[i] - mean) / largest : 0;
    ss_real_fft_run(r);
    for (size_t i = 0; i < size + 2; i += 2) {
        r->x[i] = magnitude_of(r->x + i);
        r->x[i + 1] = 0;
    }
    if (ss_real_fft_turn(r, size) != SS_OK)
        return SS_ENOMEM;
    ss_real_fft_run(r);
    double factor = r->x[0] > 0 ? (double)n / r->x[0] : 0;
    for (size_t i = 0; i < n; i++)
        r->x[i] *= factor / (double)(n - i);
    return SS_OK;
}

static int
is_peak(const double *r, size_t i)
{
    return r[i] >= r[i - 1] && r[i] > r[i + 1];
}

/* The period that the peaks at the multiples of a lag have in common, up to last and as many as
 * most, and the height of the last of them. In *error its standard error: alone, a peak is known to
 * the sample. */
static double
follow(const double *r, size_t lag, double last, double most, double *height, double *error)
{
    double period = (double)lag, mm = 0, ml = 0, ll = 0, count = 0;
    for (double m = 1; m <= most && (m + 0.25) * period < last; m++) {
        const double reach = fmax(1, JITTER * period / sqrt(m));
        size_t best = (size_t)ceil(m * period - reach);
        for (size_t i = best; (double)i <= m * period + reach; i++)
            best = r[i] > r[best] ? i : best;
        /* the vertex of the parabola through the highest there and its neighbours */
        double bend = r[best - 1] - 2 * r[best] + r[best + 1];
        double shift = bend < 0 ? 0.5 * (r[best - 1] - r[best + 1]) / bend : 0;
        double at = (double)best + fmax(-0.5, fmin(0.5, shift));
        mm += m * m, ml += m * at, ll += at * at, count++;
        period = ml / mm;
        *height = r[(size_t)(at + 0.5)];
    }
    double scatter = count > 1 ? fmax(0, ll - ml * ml / mm) / (count - 1) : 1. / 12;
    *error = sqrt(scatter / mm);
    return period;
}

/* The first peak behind the main one that is nearly the highest up to last and, if any peak lasts, lasts: an
 * oscillation that decays repeats itself, too, but not for long.  0: none. */
static size_t
first_peak(const double *r, size_t last, double least)
{
    size_t from = 1;
    double highest = 0;
    while (from < last && r[from] > 0)
        from++;
    for (size_t i = from; i < last; i++)
        highest = is_peak(r, i) ? fmax(highest, r[i]) : highest;
    if (highest < least)
        return 0;
    size_t first = 0;
    for (size_t i = from; i < last; i++)
        if (is_peak(r, i) && r[i] >= NEARLY * highest) {
            double height = r[i], error;
            follow(r, i, (double)last, MULTIPLES, &height, &error);
            if (height >= 0.5 * r[i])
                return i;
            first = first > 0 ? first : i;
        }
    return first;
}

ss_status
ss_period_find(const double *x, size_t n, ss_value *period)
{
    real_fft r = { 0 };
    double height;
    *period = (ss_value){ NAN, NAN };
    if (n < 8)
        return SS_OK;
    ss_status st = autocorrelation(&r, x, n);
    const double least = fmax(LEAST, sqrt(2 * log((double)n / FALSE_ALARMS) / (double)n));
    size_t peak = st == SS_OK ? first_peak(r.x, n / 2, least) : 0;
    if (peak > 0)
        period->value = follow(r.x, peak, MOSTLY * (double)n, INFINITY, &height, &period->error);
    ss_real_fft_free(&r);
    return st;
}
