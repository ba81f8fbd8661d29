/* clock.c -- from a column of time stamps to a uniform clock.
 *
 * Stamps are rounded when they are printed, so the rate is known only to within their residuals
 * from a straight line; of all rates that these allow the roundest is taken: stamps of 1/1024 s
 * in 7 digits give 1024 Hz, not 1023.9999998. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/sort.h"
#include "stream/clock.h"

#define TOLERANCE 0.1           /* sample periods that a stamp may be off */

/* The straight line through the stamps over their samples' numbers (least squares) and the stamp
 * farthest from it. */
struct line {
    double period, at_0;
    double deviation;           /* the largest, [s] */
    size_t worst;
};

static struct line
fit(const double *t, const size_t *sample, size_t n)
{
    struct line l = { 0, 0, 0, 0 };
    double middle = 0, mean = 0, tx = 0, xx = 0;
    for (size_t i = 0; i < n; i++) {
        middle += (double)sample[i] / (double)n;
        mean += (t[i] - t[0]) / (double)n;
    }
    for (size_t i = 0; i < n; i++) {
        double x = (double)sample[i] - middle;
        tx += x * (t[i] - t[0] - mean);
        xx += x * x;
    }
    l.period = tx / xx;
    l.at_0 = t[0] + (mean - l.period * middle);
    for (size_t i = 0; i < n; i++) {
        double off = fabs(t[i] - l.at_0 - l.period * (double)sample[i]);
        if (!(off <= l.deviation)) {
            l.deviation = off;
            l.worst = i;
        }
    }
    return l;
}

ss_status
ss_usual_step(const char *file, const double *t, const unsigned long *line, size_t n, double *usual,
              ss_error *err)
{
    if (n < 2)
        return ss_fail(err, SS_ECLOCK, "%s: one row has no sample rate", file);
    for (size_t i = 1; i < n; i++)
        if (!(t[i] > t[i - 1]))
            return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps do not ascend", file, line[i]);
    if (!isfinite(t[n - 1] - t[0]))
        return ss_fail(err, SS_EDATA, "%s: time stamps from %.3g to %.3g s are too far apart", file, t[0],
                       t[n - 1]);
    double *step = malloc(n * sizeof *step);
    if (step == NULL)
        return ss_fail_memory(err, file);
    for (size_t i = 1; i < n; i++)
        step[i - 1] = t[i] - t[i - 1];
    qsort(step, n - 1, sizeof *step, ss_ascending);
    *usual = step[(n - 2) / 2];                 /* the lower median: gaps lengthen steps */
    free(step);
    return SS_OK;
}

/* Name the row at fault: the one whose step from the row before is farthest from the usual one, or,
 * where no step is out of line, the one farthest from the best clock. */
static ss_status
refuse(const char *file, const double *t, const unsigned long *line, size_t n, double usual,
       int gaps, struct line l, ss_error *err)
{
    if (gaps && l.period > 0)
        return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps are not uniform, with gaps counted too: "
                       "this one is off by %.3g sample periods, %.1f is allowed", file, line[l.worst],
                       l.deviation / l.period, TOLERANCE);
    double off = 0;
    size_t worst = 1;
    for (size_t i = 1; i < n; i++)
        if (fabs(t[i] - t[i - 1] - usual) > off) {
            off = fabs(t[i] - t[i - 1] - usual);
            worst = i;
        }
    if (off <= TOLERANCE * usual) {
        off = l.deviation;
        worst = l.worst;
    }
    double missing = rint(off / usual);
    if (missing > 0 && t[worst] - t[worst - 1] > usual && fabs(off / usual - missing) <= 2 * TOLERANCE)
        return ss_fail(err, SS_EGAPS, "%s:%lu: %.0f sample%s missing before this time stamp", file, line[worst], missing,
                       missing > 1 ? "s are" : " is");
    return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps are not uniform: this one is off by %.3g "
                   "sample periods, %.1f is allowed", file, line[worst], off / usual, TOLERANCE);
}

/* The samples' numbers, where some may be missing. */
static void
count_samples(const double *t, size_t n, double usual, size_t *sample)
{
    for (size_t i = 1; i < n; i++) {
        double step = rint((t[i] - t[i - 1]) / usual);
        double room = (double)(SIZE_MAX / 2 - sample[i - 1]);
        sample[i] = sample[i - 1] + (step < 1 ? 1 : step < room ? (size_t)step : (size_t)1 << 62);
    }
}

ss_status
ss_refuse_range(const char *name, double rate, double start, ss_error *err)
{
    if (rate >= 1e-300 && rate <= 1e300 && fabs(start) <= 1e300)
        return SS_OK;
    return ss_fail(err, SS_EDATA, "%s: a clock of %.3g Hz that starts at %.3g s is out of range: 1e-300 "
                   "... 1e300 Hz, -1e300 ... 1e300 s", name, rate, start);
}

/* The decimal of fewest digits in [lo, hi]; *digits is how many that are. */
static double
roundest(double lo, double hi, int *digits)
{
    double middle = lo + (hi - lo) / 2;
    int top = (int)floor(log10(middle));
    for (*digits = 1; *digits < 17; ++*digits) {
        char text[64];
        int exponent = top - *digits + 1;
        snprintf(text, sizeof text, "%.0fe%d", rint(middle * pow(10, -exponent)), exponent);
        double x = ss_number_parse(text, NULL);
        if (x >= lo && x <= hi)
            return x;
    }
    return middle;
}

ss_status
ss_find_clock(const char *file, const double *t, const unsigned long *line, size_t n, int gaps,
              size_t *sample, double *rate, ss_error *err)
{
    double usual;
    ss_status st = ss_usual_step(file, t, line, n, &usual, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < n; i++)
        sample[i] = i;
    if (gaps)
        count_samples(t, n, usual, sample);
    struct line l = fit(t, sample, n);
    if (!(l.period > 0 && l.deviation <= TOLERANCE * l.period))
        return refuse(file, t, line, n, usual, gaps, l, err);

    /* Each stamp is off by the deviation at most, so the period over all of them by twice that. */
    double rounding = 2 * DBL_EPSILON * fmax(fabs(t[0]), fabs(t[n - 1]));
    double slack = 2 * (l.deviation + rounding) / (double)sample[n - 1] + 4 * DBL_EPSILON * l.period;
    int rate_digits, period_digits;
    st = ss_refuse_range(file, 1 / (l.period - slack), t[0], err);
    if (st != SS_OK)
        return st;
    double by_rate = roundest(1 / (l.period + slack), 1 / (l.period - slack), &rate_digits);
    double by_period = roundest(l.period - slack, l.period + slack, &period_digits);
    *rate = rate_digits <= period_digits ? by_rate : 1 / by_period;
    return SS_OK;
}

ss_status
ss_refuse_clock(const char *name, double own, const ss_read_opts *opts, ss_error *err)
{
    char rate[SS_NUMBER_MAX];
    ss_number_format(rate, own);
    if (opts->time != NULL || (opts->rate > 0 && (opts->rate < own || opts->rate > own)))
        return ss_fail(err, SS_EDATA, "%s: has a clock of its own, %s Hz: no column of time or rate "
                       "can be chosen", name, rate);
    return SS_OK;
}
