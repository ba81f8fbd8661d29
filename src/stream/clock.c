/* clock.c -- find the uniform clock of a column of time stamps.
 *
 * Stamps are rounded when they are printed, so the rate is known only as well as their residuals
 * from a straight line allow.  Of all rates within these, the one with the fewest digits is
 * chosen: stamps of 1/1024 s in 7 digits give 1024 Hz, not 1023.9999998. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/list.h"
#include "base/sort.h"
#include "stream/clock.h"

#define TOLERANCE 0.1           /* sample periods that a stamp may be off */

/* --- the straight line through stamps, by least squares ------------------------------------- */

/* Does the corner b lie within the hull of a and c?  sign: of the side. */
static int
is_within(struct clock_point a, struct clock_point b, struct clock_point c, double sign)
{
    return sign * ((b.sample - a.sample) * (c.stamp - a.stamp)
                   - (b.stamp - a.stamp) * (c.sample - a.sample)) <= 0;
}

/* The point farthest from a line is a corner of the convex hull, which has few of them. */
static int
add_corner(struct clock_side *s, struct clock_point p, double sign)
{
    while (s->n > 1 && is_within(s->corner[s->n - 2], s->corner[s->n - 1], p, sign))
        s->n--;
    struct clock_point *more = ss_list_room(s->corner, &s->room, s->n, sizeof *more);
    if (more == NULL)
        return 0;
    s->corner = more;
    s->corner[s->n++] = p;
    return 1;
}

int
ss_clock_add(clock_fit *f, double sample, double stamp)
{
    f->last = (struct clock_point){ sample, stamp };
    if (f->n++ == 0)
        f->first = f->last;
    double t = stamp - f->first.stamp, off = sample - f->mean.sample;
    f->mean.sample += off / (double)f->n;
    f->mean.stamp += (t - f->mean.stamp) / (double)f->n;
    f->product += off * (t - f->mean.stamp);
    f->square += off * (sample - f->mean.sample);
    return add_corner(&f->side[0], f->last, 1) && add_corner(&f->side[1], f->last, -1);
}

void
ss_clock_free(clock_fit *f)
{
    free(f->side[0].corner);
    free(f->side[1].corner);
}

struct line {
    double period, at_0;
};

static struct line
line_of(const clock_fit *f)
{
    double period = f->product / f->square;
    return (struct line){ period, f->first.stamp + (f->mean.stamp - period * f->mean.sample) };
}

static double
distance(struct line l, struct clock_point p)
{
    return fabs(p.stamp - l.at_0 - l.period * p.sample);
}

static double
largest_distance(const clock_fit *f, struct line l)
{
    double most = 0;
    for (int s = 0; s < 2; s++)
        for (size_t i = 0; i < f->side[s].n; i++) {
            double off = distance(l, f->side[s].corner[i]);
            most = off <= most ? most : off;    /* and NaN */
        }
    return most;
}

/* --- stamps in an array --------------------------------------------------------------------- */

static ss_status
check_stamps(const char *file, const double *t, const unsigned long *line, size_t n, ss_error *err)
{
    if (n < 2)
        return ss_fail(err, SS_ECLOCK, "%s: one row has no sample rate", file);
    for (size_t i = 1; i < n; i++)
        if (!(t[i] > t[i - 1]))
            return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps do not ascend", file, line[i]);
    if (!isfinite(t[n - 1] - t[0]))
        return ss_fail(err, SS_EDATA, "%s: time stamps from %.3g to %.3g s are too far apart", file, t[0],
                       t[n - 1]);
    return SS_OK;
}

ss_status
ss_usual_step(const char *file, const double *t, const unsigned long *line, size_t n, double *usual,
              ss_error *err)
{
    ss_status st = check_stamps(file, t, line, n, err);
    if (st != SS_OK)
        return st;
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

/* The first, where rounding alone tells two apart. */
static size_t
farthest_from(struct line l, const double *t, const size_t *sample, size_t n)
{
    size_t worst = 0;
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        double off = distance(l, (struct clock_point){ (double)sample[i], t[i] });
        if (!(off <= most * (1 + 1e-9))) {
            most = off;
            worst = i;
        }
    }
    return worst;
}

/* Name the row at fault: the one whose step from the row before is farthest from the usual one, or,
 * where no step is out of line, the one farthest from the best clock. */
static ss_status
refuse(const char *file, const double *t, const unsigned long *line, size_t n, const size_t *sample,
       int gaps, struct line l, ss_error *err)
{
    size_t farthest = farthest_from(l, t, sample, n), worst = 1;
    double deviation = distance(l, (struct clock_point){ (double)sample[farthest], t[farthest] });
    if (gaps && l.period > 0)
        return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps are not uniform, with gaps counted too: "
                       "this one is off by %.3g sample periods, %.1f is allowed", file, line[farthest],
                       deviation / l.period, TOLERANCE);
    double off = 0, usual;
    ss_status st = ss_usual_step(file, t, line, n, &usual, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 1; i < n; i++)
        if (fabs(t[i] - t[i - 1] - usual) > off) {
            off = fabs(t[i] - t[i - 1] - usual);
            worst = i;
        }
    if (off <= TOLERANCE * usual) {
        off = deviation;
        worst = farthest;
    }
    double missing = rint(off / usual);
    if (missing > 0 && t[worst] - t[worst - 1] > usual && fabs(off / usual - missing) <= 2 * TOLERANCE)
        return ss_fail(err, SS_EGAPS, "%s:%lu: %.0f sample%s missing before this time stamp", file,
                       line[worst], missing, missing > 1 ? "s are" : " is");
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
ss_clock_rate(const clock_fit *f, const char *file, double *rate, ss_error *err)
{
    if (f->n < 2)
        return SS_EUNEVEN;
    struct line l = line_of(f);
    double deviation = largest_distance(f, l);
    if (!(l.period > 0 && deviation <= TOLERANCE * l.period))
        return SS_EUNEVEN;

    /* Each stamp is off by the deviation at most, so the period over all of them by twice that. */
    double rounding = 2 * DBL_EPSILON * fmax(fabs(f->first.stamp), fabs(f->last.stamp));
    double slack = 2 * (deviation + rounding) / f->last.sample + 4 * DBL_EPSILON * l.period;
    int rate_digits, period_digits;
    ss_status st = ss_refuse_range(file, 1 / (l.period - slack), f->first.stamp, err);
    if (st != SS_OK)
        return st;
    double by_rate = roundest(1 / (l.period + slack), 1 / (l.period - slack), &rate_digits);
    double by_period = roundest(l.period - slack, l.period + slack, &period_digits);
    *rate = rate_digits <= period_digits ? by_rate : 1 / by_period;
    return SS_OK;
}

ss_status
ss_find_clock(const char *file, const double *t, const unsigned long *line, size_t n, int gaps,
              size_t *sample, double *rate, ss_error *err)
{
    double usual;
    clock_fit fit = { 0 };
    ss_status st = check_stamps(file, t, line, n, err);
    if (st == SS_OK && gaps)
        st = ss_usual_step(file, t, line, n, &usual, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < n; i++)
        sample[i] = i;
    if (gaps)
        count_samples(t, n, usual, sample);
    for (size_t i = 0; st == SS_OK && i < n; i++)
        st = ss_clock_add(&fit, (double)sample[i], t[i]) ? SS_OK : ss_fail_memory(err, file);
    if (st == SS_OK)
        st = ss_clock_rate(&fit, file, rate, err);
    if (st == SS_EUNEVEN)
        st = refuse(file, t, line, n, sample, gaps, line_of(&fit), err);
    ss_clock_free(&fit);
    return st;
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
