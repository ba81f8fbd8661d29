/* column.c -- the samples to which a motion is fitted: their power, their noise, their distance
 * from a sinusoid; and those of a scene's motion.
 *
 * Fourth differences do not contain slow motion, and differences over one cycle do not contain
 * what repeats.  So the median size of either is that of the noise, or more. */
#include "fit/column.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_statistics_double.h>
#include "base/error.h"
#include "base/gauss.h"
#include "base/least.h"
#include "base/options.h"
#include "find/medians.h"
#include "motion/method.h"

const char *const ss_quantity_names[SS_QUANTITIES + 1] = { "x", "v", "a", "f", "s", NULL };

static const ss_rank_opts defaults = { .size = sizeof defaults, .quantity = SS_ACCELERATION,
                                       .spread = RANK_SPREAD, .also = { -1, -1, -1, -1, -1 } };

SS_OPTIONS(ss_rank_opts, defaults)

ss_status
ss_rank_opts_take(ss_rank_opts *own, const ss_rank_opts *given, ss_error *err)
{
    ss_status st = ss_options_take(own, sizeof *own, &defaults, given, err);
    return st == SS_OK && (unsigned)own->quantity >= SS_QUANTITIES
        ? ss_fail(err, SS_EINVAL, "the quantity is no known choice") : st;
}

static int
is_missing(const rank_record *r, size_t i, size_t n)
{
    for (size_t k = 0; r->missing != NULL && k < n; k++)
        if (r->missing[i + k])
            return 1;
    return 0;
}

ss_status
ss_column_check(const ss_signal *signal, size_t column, const ss_rank_opts *opts, ss_error *err)
{
    if (column >= signal->head->n_columns)
        return ss_fail(err, SS_EINVAL, "there is no column %zu", column + 1);
    if (!(opts->forcing_frequency >= 0 && isfinite(opts->forcing_frequency)))
        return ss_fail(err, SS_EINVAL, "forcing frequency %g is out of range", opts->forcing_frequency);
    for (size_t i = 0; i < signal->n; i++)
        if (!isfinite(signal->values[column * signal->n + i]))
            return ss_fail(err, SS_EDATA, "row %zu is not finite", i + 1);
    return SS_OK;
}

ss_status
ss_column_check_unit(const ss_signal *signal, size_t column, ss_quantity quantity, ss_error *err)
{
    static const char *const si_unit[SS_QUANTITIES] = { "m", "m/s", "m/s^2", "N", "N" };
    const ss_column *c = &signal->head->column[column];
    char dimension;
    int per_time;
    const int is_force = quantity >= SS_FORCE;
    if (c->unit[0] == '\0' || (ss_unit_size(c->unit, &dimension, &per_time) == 1
                               && dimension == (is_force ? 'N' : 'm')
                               && per_time == (is_force ? 0 : (int)quantity)))
        return SS_OK;
    return ss_fail(err, SS_EDATA, "column %s is in %s, but a scene is in %s: scale it, and name its unit so",
                   c->name, c->unit, si_unit[quantity]);
}

double
ss_record_power(const rank_record *r)
{
    double mean = 0, sum = 0, n = 0;
    for (size_t i = 0; i < r->n; i++)
        if (!is_missing(r, i, 1))
            mean += r->x[i], n++;
    mean /= fmax(n, 1);
    for (size_t i = 0; i < r->n; i++)
        if (!is_missing(r, i, 1))
            sum += (r->x[i] - mean) * (r->x[i] - mean);
    return sum / fmax(n, 1);
}

/* The variance that n Gaussian numbers with this median size have. */
static double
gaussian_variance(double *d, size_t n)
{
    if (n == 0)
        return INFINITY;
    for (size_t i = 0; i < n; i++)
        d[i] = fabs(d[i]);
    double median = gsl_stats_median(d, 1, n) / GAUSS_MEDIAN;
    return median * median;
}

ss_status
ss_record_noise(rank_record *r, double samples)
{
    double *d = malloc((r->n + 1) * sizeof *d);
    size_t count = 0;
    if (d == NULL)
        return SS_ENOMEM;
    /* by fourth differences, which have (1 + 16 + 36 + 16 + 1) times as much: their median contains neither slow
     * motion nor what happens seldom */
    for (size_t i = 0; i + 5 <= r->n; i++)
        if (!is_missing(r, i, 5)) {
            const double *x = r->x + i;
            d[count++] = (x[0] - 4 * x[1] + 6 * x[2] - 4 * x[3] + x[4]) / sqrt(70);
        }
    double smallest = gaussian_variance(d, count);
    /* by the differences from one cycle to the next, interpolated between two samples: they contain no periodic
     * motion, however fast */
    const size_t lag = samples > 0 && samples < (double)r->n ? (size_t)samples : r->n;
    const double part = samples - floor(samples);
    count = 0;
    for (size_t i = 0; i + lag + 2 <= r->n; i++)
        if (!is_missing(r, i, 1) && !is_missing(r, i + lag, 2)) {
            double later = (1 - part) * r->x[i + lag] + part * r->x[i + lag + 1];
            d[count++] = (r->x[i] - later) / sqrt(1 + (1 - part) * (1 - part) + part * part);
        }
    smallest = fmin(smallest, gaussian_variance(d, count));
    /* a converter's steps have a twelfth of the square of the smallest, and a ninth for noise of a third of a
     * step: medians do not see such noise, as most samples do not leave their step */
    const double step = ss_smallest_change(r->x, r->n);
    r->steps = isfinite(step) ? step * step * (1. / 12 + 1. / 9) : 0;
    r->noise = fmax(isfinite(smallest) ? smallest : 0, r->steps);
    free(d);
    return SS_OK;
}

ss_status
ss_record_sinusoid(const rank_record *r, double frequency, double *left)
{
    enum { COLUMNS = 3 };       /* cosine, sine and offset */
    double *x = malloc((r->n + 1) * (COLUMNS + 1) * sizeof *x), *y = x + COLUMNS * r->n, c[COLUMNS], squares;
    size_t n = 0;
    if (x == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < r->n; i++) {
        double phase = 2 * M_PI * frequency * (double)i / r->rate;
        if (is_missing(r, i, 1))
            continue;
        memcpy(x + COLUMNS * n, (double[COLUMNS]){ cos(phase), sin(phase), 1 }, COLUMNS * sizeof *x);
        y[n++] = r->x[i];
    }
    ss_status st = ss_least_linear(x, y, n, COLUMNS, c, &squares, NULL);
    *left = squares / fmax((double)n, 1);
    free(x);
    return st;
}

/* --- the motion of a scene ------------------------------------------------------------------ */

enum { STEPS_MOST = 1000000 };          /* of one run */

typedef struct sampled {
    int pick;
    size_t n, room;
    double *value, *clear, rate;
} sampled;

static int
append_samples(const ss_sample *s, size_t n, void *user)
{
    sampled *t = user;
    const ss_sim_columns picked = { 0, 1, { t->pick } };
    n = n < t->room - t->n ? n : t->room - t->n;
    ss_sim_rows(&picked, s, n, &(double *){ t->value + t->n });
    t->n += n;
    return 0;
}

static int
clear_event(const ss_event *e, void *user)
{
    sampled *t = user;
    double at = e->t * t->rate, first = fmax(ceil(at - SAMPLES_REACH), 0);
    for (double i = first; i < (double)t->room && i <= at + SAMPLES_REACH; i++)
        t->clear[(size_t)i] = fmin(t->clear[(size_t)i], fabs(i - at));
    return 0;
}

ss_sim_opts
ss_samples_opts(const ss_scene *scene, double tol)
{
    return (ss_sim_opts){ .size = sizeof(ss_sim_opts), .method = ss_method_for(scene, BEST)->name, .tol = tol,
                          .max_steps = STEPS_MOST };
}

ss_status
ss_samples_run(const ss_scene *scene, int pick, double tol, double *value, double *clear, size_t n,
               double *steps)
{
    sampled t = { pick, 0, n, value, clear, scene->rate };
    ss_sim_opts opts = ss_samples_opts(scene, tol);
    ss_sim_stats stats = { .steps = 0 };
    for (size_t i = 0; clear != NULL && i < n; i++)
        clear[i] = INFINITY;
    opts.samples = append_samples;
    opts.events = clear != NULL ? clear_event : NULL;
    opts.user = &t;
    ss_status st = ss_sim_run(scene, &opts, &stats, NULL);
    *steps += (st == SS_EBUDGET ? STEPS_MOST : (double)stats.steps) + (double)t.n / SAMPLES_A_STEP;
    return st == SS_OK && t.n != n ? SS_EDATA : st;
}
