/* drops.c -- how often and how far a force drops, for a sawtooth of stick and slip.
 *
 * A turning point is an extreme that the signal leaves by DROPS_RELOAD of the height that is asked for.
 * A drop is a fall from one turning point to the next that is higher than this height, so that no slow
 * drift adds up to a drop.  The signal is first smoothed by a running median, which removes single
 * wrong samples and keeps edges.  The noise sets its width: extremes of the noise that it leaves, 3
 * standard deviations at either end, may change a height by ERROR of that asked for.  It is no wider
 * than half a fall, so that it does not flatten the turning points.
 *
 * If no height is asked for, it is found where the falls have a typical height.  The falls above h,
 * between turning points for h, have a median M(h).  A signal without a scale of its own has M = c h at
 * all h: c is 1.7 for a random walk (falls beyond h are exponential with mean h) and less for white
 * noise.  A sawtooth has falls of some size, and none between that size and the noise, so M / h rises
 * as h is lowered.  The height is the largest h with M = TYPICAL h: exponentially distributed falls
 * lose ln 2 / 3 of their mean there, a quarter of a median.  It must be above the noise that the median
 * of NARROWEST samples leaves, 3 standard deviations at either end; otherwise there is none. */
#include "find/drops.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/gauss.h"
#include "base/list.h"
#include "find/judgement.h"

#define ERROR 0.03

#define TYPICAL 4.0             /* M / h, see above */
#define NARROWEST 5             /* samples: two wrong ones in a row do no harm */

/* The standard deviation of white noise whose second differences are those of x, by their median;
 * scratch holds n. */
static double
noise_rms(const double *x, size_t n, double *scratch)
{
    if (n < 3)
        return 0;
    for (size_t i = 1; i + 1 < n; i++)
        scratch[i - 1] = fabs(x[i - 1] - 2 * x[i] + x[i + 1]);
    return gsl_stats_select(scratch, 1, n - 2, (n - 2) / 2) / (GAUSS_MEDIAN * sqrt(6));
}

/* y[i] is the median of the samples i - half ... i + half, fewer at the ends, but as many on either
 * side.  window holds 2 half + 1. */
static void
running_median(double *y, const double *x, size_t n, size_t half, double *window)
{
    size_t first = 0, end = 0, filled = 0;      /* the window has the samples [first, end) */
    for (size_t i = 0; i < n; i++) {
        size_t reach = half < i ? half : i;
        reach = reach < n - 1 - i ? reach : n - 1 - i;
        for (; end <= i + reach; end++, filled++) {
            size_t k = ss_list_from(window, filled, sizeof *window, x[end]);
            memmove(window + k + 1, window + k, (filled - k) * sizeof *window);
            window[k] = x[end];
        }
        for (; first < i - reach; first++, filled--) {
            size_t k = ss_list_from(window, filled, sizeof *window, x[first]);
            memmove(window + k, window + k + 1, (filled - k - 1) * sizeof *window);
        }
        y[i] = window[filled / 2];
    }
}

/* Find the falls of y by more than height from one turning point to the next, which y leaves by reload; at the
 * end, if to_end, what has not been left yet counts.  fall has room for n / 2 + 1; returns their number. */
static size_t
find_falls(ss_drop *out, const double *y, size_t n, double height, double reload, int to_end)
{
    size_t high = 0, low = 0, count = 0;
    int falls = 0;
    for (size_t i = 0; i < n; i++) {
        if (!falls && y[i] >= y[high])
            high = i;
        if (falls && y[i] < y[low])
            low = i;
        if (!falls && y[high] - y[i] > reload) {
            falls = 1;
            low = i;
        } else if (falls && y[i] - y[low] > reload) {
            if (y[high] - y[low] > height)
                out[count++] = (ss_drop){ high, low };
            falls = 0;
            high = i;
        }
    }
    if (to_end && falls && y[high] - y[low] > height)
        out[count++] = (ss_drop){ high, low };
    return count;
}

/* The number of falls by more than h, and their median; scratch has room for n / 2 + 1, as fall has. */
static size_t
count_falls(const double *y, size_t n, double h, ss_drop *of, double *scratch, double *median)
{
    size_t count = find_falls(of, y, n, h, h, 0);
    for (size_t i = 0; i < count; i++)
        scratch[i] = y[of[i].high] - y[of[i].low];
    *median = count > 0 ? gsl_stats_select(scratch, 1, count, count / 2) : 0;
    return count;
}

ss_status
ss_drops_typical(const double *x, size_t n, ss_typical *out)
{
    enum { STEPS = 4, OCTAVES = 16 };
    *out = (ss_typical){ .height = 0 };
    if (n < NARROWEST)
        return SS_OK;
    double *y = malloc((2 * n + NARROWEST) * sizeof *y), *scratch = y + n, low, high, median;
    ss_drop *of = malloc((n / 2 + 1) * sizeof *of);
    ss_status st = y != NULL && of != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK) {
        double noise = noise_rms(x, n, scratch);
        double least = 2 * SIGMAS * noise * sqrt(M_PI / 2 / NARROWEST), step = exp2(-1. / STEPS);
        running_median(y, x, n, NARROWEST / 2, scratch);
        gsl_stats_minmax(&low, &high, y, 1, n);
        double h = 0.5 * (high - low);
        for (int i = 0; i < STEPS * OCTAVES && h > least && out->height == 0; i++, h *= step) {
            size_t count = count_falls(y, n, h, of, scratch, &median);
            if (count < FEW || median < TYPICAL * h)
                continue;
            out->height = h;
            out->more = count_falls(y, n, fmax(h / 2, least), of, scratch, &median);
            out->less = count_falls(y, n, 2 * h, of, scratch, &median);
        }
    }
    free(of);
    free(y);
    return st;
}

ss_status
ss_drops_without_glitches(double *y, const double *x, size_t n, const ss_drop *drop, size_t n_drops)
{
    double *scratch = malloc((n + n_drops + NARROWEST + 1) * sizeof *scratch);
    if (scratch == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n_drops; i++)
        scratch[i] = x[drop[i].high] - x[drop[i].low];
    double height = n_drops > 0 ? gsl_stats_median(scratch, 1, n_drops) : 0;
    double most = SURELY * noise_rms(x, n, scratch) + SLIGHT * height;
    running_median(y, x, n, NARROWEST / 2, scratch);
    for (size_t i = 0; i < n; i++)
        y[i] = fabs(x[i] - y[i]) > most ? y[i] : x[i];
    free(scratch);
    return SS_OK;
}

ss_status
ss_drops_find(ss_drop **out, size_t *n_drops, const double *x, size_t n, double height, double reload)
{
    double *y = malloc((2 * n + NARROWEST) * sizeof *y), *window = y + n;
    ss_drop *of = *out = malloc((n / 2 + 1) * sizeof *of);
    if (y == NULL || of == NULL) {
        free(y);
        return SS_ENOMEM;
    }
    running_median(y, x, n, NARROWEST / 2, window);
    size_t count = find_falls(of, y, n, height, reload, 1);
    for (size_t i = 0; i < count; i++)
        window[i] = (double)(of[i].low - of[i].high);
    double length = count > 0 ? gsl_stats_select(window, 1, count, count / 2) : 0;
    /* the median of m Gaussians has pi/2 the variance of their mean */
    double left = ERROR * height / (2 * SIGMAS), noise = noise_rms(x, n, window);
    double wide = fmin(M_PI / 2 * noise * noise / (left * left), length / 2);
    if (wide > NARROWEST) {
        running_median(y, x, n, (size_t)(wide / 2), window);
        count = find_falls(of, y, n, height, reload, 1);
    }
    free(y);
    *n_drops = count;
    return SS_OK;
}
