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
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/gauss.h"
#include "base/list.h"
#include "signal/gaps.h"

#define ERROR 0.03

#define TYPICAL 4.0             /* M / h, see above */
#define NARROWEST 5             /* samples: two wrong ones in a row do no harm */
#define STANDS_OUT 5.0          /* standard deviations of the noise, and */
#define GLITCH 0.05             /* part of the median drop, by both of which a wrong sample differs from its
                                   neighbours */

typedef struct drop_list {
    size_t n, room;
    ss_drop *drop;
} drop_list;

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

static ss_status
append(drop_list *list, const double *y, size_t high, size_t low, double rate)
{
    ss_drop *drop = ss_list_room(list->drop, &list->room, list->n, sizeof *drop);
    if (drop == NULL)
        return SS_ENOMEM;
    list->drop = drop;
    list->drop[list->n++] = (ss_drop){ (double)high / rate, (double)low / rate, y[high] - y[low] };
    return SS_OK;
}

static ss_status
read_turning_points(drop_list *list, const double *y, size_t n, double rate, double height,
                    double reload)
{
    size_t high = 0, low = 0;
    int falls = 0;
    ss_status st = SS_OK;
    list->n = 0;
    for (size_t i = 0; i < n && st == SS_OK; i++) {
        if (!falls && y[i] >= y[high])
            high = i;
        if (falls && y[i] < y[low])
            low = i;
        if (!falls && y[high] - y[i] > reload) {
            falls = 1;
            low = i;
        } else if (falls && y[i] - y[low] > reload) {
            if (y[high] - y[low] > height)
                st = append(list, y, high, low, rate);
            falls = 0;
            high = i;
        }
    }
    if (st == SS_OK && falls && y[high] - y[low] > height)
        st = append(list, y, high, low, rate);
    return st;
}

/* Samples from turning point to turning point, the median over all drops; scratch holds n. */
static double
fall_length(const drop_list *list, double rate, double *scratch)
{
    for (size_t i = 0; i < list->n; i++)
        scratch[i] = (list->drop[i].end - list->drop[i].t) * rate;
    return gsl_stats_select(scratch, 1, list->n, list->n / 2);
}

static ss_status
find(drop_list *list, const double *x, size_t n, double rate, double height, double reload,
     double *scratch)
{
    double *y = scratch, *window = scratch + n;
    size_t half = NARROWEST / 2;
    running_median(y, x, n, half, window);
    ss_status st = read_turning_points(list, y, n, rate, height, reload);
    if (st != SS_OK || list->n == 0)
        return st;
    /* the median of m Gaussians has pi/2 the variance of their mean */
    double left = ERROR * height / 6, noise = noise_rms(x, n, window);
    double wide = M_PI / 2 * noise * noise / (left * left);
    wide = fmin(wide, fall_length(list, rate, window) / 2);
    if (wide <= NARROWEST)
        return SS_OK;
    half = (size_t)(wide / 2);
    running_median(y, x, n, half, window);
    return read_turning_points(list, y, n, rate, height, reload);
}

/* Leave out falls over a gap, as a part of them is not known. */
static void
leave_out(drop_list *list, const ss_span *gap, size_t n_gaps)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->n; i++) {
        ss_drop d = list->drop[i];
        if (!ss_gaps_near(gap, n_gaps, 0.5 * (d.t + d.end), 0.5 * (d.end - d.t)))
            list->drop[kept++] = d;
    }
    list->n = kept;
}

/* --- the height that falls have ------------------------------------------------------------- */

/* Find the turning points of y, in place; returns their number. */
static size_t
keep_turning_points(double *y, size_t n)
{
    size_t kept = 1;
    for (size_t i = 1; i < n; i++)
        if (i + 1 == n || (y[i] - y[kept - 1]) * (y[i + 1] - y[i]) < 0)
            y[kept++] = y[i];
    return kept;
}

/* The number of falls that leave a turning point by more than h, and their median; fall has room for as
 * many. */
static size_t
count_falls(const double *y, size_t n, double h, double *fall, double *median)
{
    size_t count = 0;
    double high = y[0], low = y[0];
    int falls = 0;
    for (size_t i = 0; i < n; i++) {
        high = falls ? high : fmax(high, y[i]);
        low = falls ? fmin(low, y[i]) : y[i];
        if (!falls && high - y[i] > h) {
            falls = 1;
            low = y[i];
        } else if (falls && y[i] - low > h) {
            fall[count++] = high - low;
            falls = 0;
            high = y[i];
        }
    }
    *median = count > 0 ? gsl_stats_select(fall, 1, count, count / 2) : 0;
    return count;
}

ss_status
ss_drops_typical(const double *x, size_t n, ss_typical *out)
{
    enum { FEW = 3, STEPS = 4, OCTAVES = 16 };
    *out = (ss_typical){ .height = 0 };
    if (n < NARROWEST)
        return SS_OK;
    double *y = malloc((2 * n + NARROWEST) * sizeof *y), low, high, median;
    if (y == NULL)
        return SS_ENOMEM;
    double *fall = y + n;
    double noise = noise_rms(x, n, fall);
    running_median(y, x, n, NARROWEST / 2, fall);
    low = high = y[0];
    for (size_t i = 0; i < n; i++)
        low = fmin(low, y[i]), high = fmax(high, y[i]);
    size_t turns = keep_turning_points(y, n);
    double least = 6 * noise * sqrt(M_PI / 2 / NARROWEST), step = exp2(-1. / STEPS);
    double h = 0.5 * (high - low);
    for (int i = 0; i < STEPS * OCTAVES && h > least && out->height == 0; i++, h *= step) {
        size_t count = count_falls(y, turns, h, fall, &median);
        if (count >= FEW && median >= TYPICAL * h) {
            out->height = h;
            out->more = count_falls(y, turns, fmax(h / 2, least), fall, &median);
            out->less = count_falls(y, turns, 2 * h, fall, &median);
        }
    }
    free(y);
    return SS_OK;
}

ss_status
ss_drops_without_glitches(double *y, const double *x, size_t n, const ss_drop *drop, size_t n_drops)
{
    double *scratch = malloc((n + n_drops + NARROWEST + 1) * sizeof *scratch);
    if (scratch == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n_drops; i++)
        scratch[i] = drop[i].height;
    double height = n_drops > 0 ? gsl_stats_median(scratch, 1, n_drops) : 0;
    double most = STANDS_OUT * noise_rms(x, n, scratch) + GLITCH * height;
    running_median(y, x, n, NARROWEST / 2, scratch);
    for (size_t i = 0; i < n; i++)
        y[i] = fabs(x[i] - y[i]) > most ? y[i] : x[i];
    free(scratch);
    return SS_OK;
}

ss_status
ss_drops_find(ss_drop **out, size_t *n_drops, const double *x, size_t n, double rate,
              const ss_drop_opts *opts, ss_error *err)
{
    if (out == NULL || n_drops == NULL || x == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    drop_list list = { 0, 0, NULL };
    double height = opts->height, reload = opts->reload > 0 ? opts->reload : DROPS_RELOAD * height;
    if (n == 0 || n > SIZE_MAX / 64)
        return ss_fail(err, SS_EINVAL, "a record of %zu samples is out of range 1 ... %zu", n, SIZE_MAX / 64);
    if (!(rate >= 1e-100 && rate <= 1e100))
        return ss_fail(err, SS_EINVAL, "rate %g Hz is out of range 1e-100 ... 1e100", rate);
    if (!(height > 0 && isfinite(height)))
        return ss_fail(err, SS_EINVAL, "the height of a drop must be more than 0");
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EINVAL, "sample %zu is not a finite number", i + 1);
    double *scratch = malloc((3 * n + NARROWEST + 1) * sizeof *scratch);
    list.drop = malloc(sizeof *list.drop);
    list.room = 1;
    ss_status st = scratch != NULL && list.drop != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK) {
        double *bridged = scratch + 2 * n + NARROWEST + 1;
        memcpy(bridged, x, n * sizeof *x);
        ss_gaps_bridge(bridged, n, rate, opts->gap, opts->n_gaps);
        st = find(&list, bridged, n, rate, height, reload, scratch);
    }
    free(scratch);
    if (st == SS_OK)
        leave_out(&list, opts->gap, opts->n_gaps);
    if (st != SS_OK) {
        free(list.drop);
        return st;
    }
    *out = list.drop;
    *n_drops = list.n;
    return SS_OK;
}
