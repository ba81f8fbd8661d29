/* clock.c -- find the uniform clock of a column of time stamps.
 *
 * Stamps are rounded when they are printed, so the rate is known only as well as their residuals
 * from a straight line allow.  Of all rates within these, the one with the fewest digits is
 * chosen: stamps of 1/1024 s in 7 digits give 1024 Hz, not 1023.9999998. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/list.h"
#include "io/table/sheet.h"
#include "signal/header.h"

#define BY_DIGITS 0.25          /* or by so many if it has no more digits: a missing row is farther off */

int
ss_stamps_next(struct stamps *s)
{
    const double *row;
    do
        row = ss_kept_row(s->rows, s->row++);
    while (row != NULL && isnan(row[s->of.column]));
    if (row == NULL)
        return 0;
    s->before = s->stamp;
    s->stamp = ss_sheet_stamp(&s->of, row);
    s->line = (unsigned long)row[s->rows->width - 1];
    s->n++;
    return 1;
}

ss_status
ss_stamps_check(struct stamps s, ss_error *err)
{
    double first = 0;
    while (ss_stamps_next(&s))
        if (s.n == 1)
            first = s.stamp;
        else if (!(s.stamp > s.before))
            return ss_fail(err, SS_ECLOCK, "%s:%lu: time stamps do not ascend: %s", s.rows->name, s.line,
                           s.stamp < s.before ? "this one is before that of the row above"
                           : "this one is that of the row above");
    if (s.n < 2)
        return ss_fail(err, SS_ECLOCK, "%s: one row has no sample rate", s.rows->name);
    return isfinite(s.stamp - first) ? ss_kept_check(s.rows, err)
        : ss_fail(err, SS_EDATA, "%s: time stamps from %.3g to %.3g s are too far apart", s.rows->name, first,
                  s.stamp);
}

double
ss_usual_step(struct stamps s)
{
    enum { STEPS = 4096 };
    double step[STEPS];
    size_t n = 0, every = 1 + (size_t)(s.rows->n / STEPS);
    while (ss_stamps_next(&s))
        if (s.n > 1 && (s.n - 2) % every == 0)
            step[n++] = s.stamp - s.before;
    qsort(step, n, sizeof *step, ss_ascending);
    return step[(n - 1) / 2];                   /* the lower median, since gaps lengthen steps */
}

size_t
ss_clock_sample(struct sample_count *c, double stamp)
{
    size_t sample = c->next;
    if (c->usual > 0 && sample > 0) {
        double steps = rint((stamp - c->last) / c->usual), room = (double)(SIZE_MAX / 2 - (sample - 1));
        sample += steps < 1 ? 0 : steps < room ? (size_t)steps - 1 : ((size_t)1 << 62) - 1;
    }
    c->last = stamp;
    c->next = sample + 1;
    return sample;
}

/* A stamp that is off by `by`. */
struct off {
    double by, step;            /* step: from the one before */
    unsigned long line;
};

ss_status
ss_clock_refuse(const char *name, unsigned long line, double late, ss_error *err)
{
    double missing = rint(late);
    if (missing > 0 && fabs(late - missing) <= 2 * CLOCK_TOLERANCE)
        return ss_fail(err, SS_EGAPS, "%s:%lu: %.0f sample%s missing before this time stamp", name, line, missing,
                       missing > 1 ? "s are" : " is");
    return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps are not uniform: this one is off by %.3g "
                   "sample periods, %.1f is allowed", name, line, fabs(late), CLOCK_TOLERANCE);
}

/* The error names the row at fault: the one whose step from the row before differs most from the usual step or, if
 * all steps are within the tolerance, the one farthest from the best clock.  A stamp that is off spoils the step
 * to the next row as much, the other way: rounding does not decide which of the two is at fault. */
static ss_status
refuse(struct stamps s, const struct clock *c, double period, struct off worst, ss_error *err)
{
    const char *name = s.rows->name;
    if (period > 0 && c->digit > 2 * BY_DIGITS * period)
        return ss_fail(err, SS_EUNEVEN, "%s: time stamps have too few digits: 1 in the last of them is %.2g "
                       "sample periods, %.1f is allowed", name, c->digit / period, 2 * BY_DIGITS);
    if (c->usual > 0 && period > 0)
        return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps are not uniform, with gaps counted too: "
                       "this one is off by %.3g sample periods, %.1f is allowed", name, worst.line,
                       worst.by / period, CLOCK_TOLERANCE);
    double usual = ss_usual_step(s);
    struct off far = { .by = 0 }, last = far;
    while (ss_stamps_next(&s)) {
        struct off now = { s.n > 1 ? s.stamp - s.before - usual : 0, 0, s.line };
        if (fabs(now.by) > fabs(far.by))
            far = fabs(now.by + last.by) < fabs(now.by) / 2 ? last : now;
        last = now;
    }
    if (fabs(far.by) <= CLOCK_TOLERANCE * usual)
        far = (struct off){ worst.step > usual ? worst.by : -worst.by, 0, worst.line };
    return ss_clock_refuse(name, far.line, far.by / usual, err);
}

/* The decimal number with the fewest digits in [lo, hi]; *digits becomes their number. */
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

int
ss_clock_digits(double x)
{
    int digits;
    roundest(x * (1 - 1e-9), x * (1 + 1e-9), &digits);
    return digits;
}

ss_status
ss_find_clock(struct stamps s, struct clock *c, ss_error *err)
{
    /* the straight line through stamps, by least squares */
    struct sample_count count = { .usual = c->usual };
    double sample = 0, stamp = 0, product = 0, square = 0;      /* means from the first on, sums about them */
    for (struct stamps i = s; ss_stamps_next(&i); c->n = i.n) {
        c->last = (double)ss_clock_sample(&count, i.stamp);
        c->start = i.n == 1 ? i.stamp : c->start;
        double t = i.stamp - c->start, off = c->last - sample;
        sample += off / (double)i.n;
        stamp += (t - stamp) / (double)i.n;
        product += off * (t - stamp);
        square += off * (c->last - sample);
    }
    double period = product / square, at_0 = c->start + (stamp - period * sample);
    /* the stamp that is farthest from it; of several that differ only by rounding, the first */
    struct off worst = { .by = 0 };
    count = (struct sample_count){ .usual = c->usual };
    for (struct stamps i = s; ss_stamps_next(&i);) {
        double off = fabs(i.stamp - at_0 - period * (double)ss_clock_sample(&count, i.stamp));
        if (!(off <= worst.by * (1 + 1e-9)))    /* NaN, too */
            worst = (struct off){ off, i.stamp - i.before, i.line };
    }
    if (!(period > 0 && worst.by <= fmax(period * CLOCK_TOLERANCE, fmin(c->digit, BY_DIGITS * period))))
        return refuse(s, c, period, worst, err);
    /* each stamp is off by at most the deviation, so the period over all of them by at most twice that */
    double end = at_0 + period * c->last;
    double rounding = 2 * DBL_EPSILON * fmax(fabs(c->taken + c->start), fabs(c->taken + end));
    double slack = 2 * (worst.by + rounding) / c->last + 4 * DBL_EPSILON * period;
    int rate_digits, period_digits;
    ss_status st = ss_refuse_range(s.rows->name, 1 / (period - slack), c->start, err);
    if (st != SS_OK)
        return st;
    double by_rate = roundest(1 / (period + slack), 1 / (period - slack), &rate_digits);
    double by_period = roundest(period - slack, period + slack, &period_digits);
    c->rate = rate_digits <= period_digits ? by_rate : 1 / by_period;
    return SS_OK;
}
