/* clock.c -- find the uniform clock of a column of time stamps.
 *
 * Stamps are rounded when they are printed, so the rate is known only as well as their residuals
 * from a straight line allow.  Of all rates within these, the one with the fewest digits is
 * chosen: stamps of 1/1024 s in 7 digits give 1024 Hz, not 1023.9999998. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "io/table/clock.h"

#define BY_DIGITS 0.25          /* or by so many if it has no more digits: a missing row is farther off */
enum { DIGIT = 16 };            /* so many bits of a step are found at a time */

/* --- stamps that are read several times ----------------------------------------------------- */

struct pass {
    const struct stamps *of;
    double first, stamp, before;        /* before: the previous stamp */
    unsigned long line;
    size_t n;                   /* stamps so far */
    ss_status status;
    ss_error *err;
};

static struct pass
start(const struct stamps *s, ss_error *err)
{
    return (struct pass){ .of = s, .status = ss_kept_rewind(&s->t->rows, err), .err = err };
}

/* Go to the next stamp.  Returns 0 if there is none, it cannot be read, or it is no later than the one before. */
static int
step(struct pass *p)
{
    const double *row = NULL;
    p->before = p->stamp;
    if (p->status == SS_OK)
        p->status = ss_sheet_next(&p->of->t->rows, p->of->of.column, &row, p->err);
    if (p->status != SS_OK || row == NULL)
        return 0;
    p->stamp = ss_sheet_stamp(&p->of->of, row);
    p->line = (unsigned long)row[p->of->t->n_columns];
    if (p->n++ == 0)
        p->first = p->stamp;
    else if (!(p->stamp > p->before))
        p->status = ss_fail(p->err, SS_ECLOCK, "%s:%lu: time stamps do not ascend: %s", p->of->t->name, p->line,
                            p->stamp < p->before ? "this one is before that of the row above"
                            : "this one is that of the row above");
    return p->status == SS_OK;
}

/* The status of a pass that has ended: there must be two stamps, at a distance that is a number. */
static ss_status
end(const struct pass *p)
{
    if (p->status == SS_OK && p->n < 2)
        return ss_fail(p->err, SS_ECLOCK, "%s: one row has no sample rate", p->of->t->name);
    if (p->status == SS_OK && !isfinite(p->stamp - p->first))
        return ss_fail(p->err, SS_EDATA, "%s: time stamps from %.3g to %.3g s are too far apart", p->of->t->name,
                       p->first, p->stamp);
    return p->status;
}

/* --- the straight line through stamps, by least squares ------------------------------------- */

struct point {
    double sample, stamp;
};

struct fit {
    size_t n;
    struct point first, last, mean;     /* mean: from the first on */
    double product, square;     /* sums of products of sample and stamp, and of sample, about the mean */
    struct side {               /* corners of the convex hull: below and above all points */
        struct point *corner;
        size_t n, room;
    } side[2];
};

struct line {
    double period, at_0;
};

/* Add a stamp; 0: no memory.  The point farthest from a line is a corner of the hull, which has few. */
static int
add(struct fit *f, double sample, double stamp)
{
    f->last = (struct point){ sample, stamp };
    if (f->n++ == 0)
        f->first = f->last;
    double t = stamp - f->first.stamp, off = sample - f->mean.sample;
    f->mean.sample += off / (double)f->n;
    f->mean.stamp += (t - f->mean.stamp) / (double)f->n;
    f->product += off * (t - f->mean.stamp);
    f->square += off * (sample - f->mean.sample);
    for (int i = 0; i < 2; i++) {
        struct side *s = &f->side[i];
        for (double sign = i == 0 ? 1 : -1; s->n > 1; s->n--) {         /* is the last one still a corner? */
            struct point a = s->corner[s->n - 2], b = s->corner[s->n - 1], c = f->last;
            if (!(sign * ((b.sample - a.sample) * (c.stamp - a.stamp)
                          - (b.stamp - a.stamp) * (c.sample - a.sample)) <= 0))
                break;
        }
        struct point *more = ss_list_room(s->corner, &s->room, s->n, sizeof *more);
        if (more == NULL)
            return 0;
        s->corner = more;
        more[s->n++] = f->last;
    }
    return 1;
}

static struct line
line_of(const struct fit *f)
{
    double period = f->product / f->square;
    return (struct line){ period, f->first.stamp + (f->mean.stamp - period * f->mean.sample) };
}

static double
distance(struct line l, struct point p)
{
    return fabs(p.stamp - l.at_0 - l.period * p.sample);
}

static double
largest_distance(const struct fit *f, struct line l)
{
    double most = 0;
    for (int s = 0; s < 2; s++)
        for (size_t i = 0; i < f->side[s].n; i++) {
            double off = distance(l, f->side[s].corner[i]);
            most = off <= most ? most : off;    /* NaN stays */
        }
    return most;
}

/* --- the usual step ------------------------------------------------------------------------ */

/* The bits of a double >= 0 as an integer: integers made in this way are in the order of the doubles. */
static uint64_t
bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Find the next DIGIT bits of a step whose highest bits are *known and whose rank among the steps with
 * these highest bits is *rank.  *known gains the new bits; *rank becomes the rank among the steps that
 * have these, too. */
static ss_status
next_digit(const struct stamps *s, size_t *count, int below, uint64_t *known, size_t *rank, ss_error *err)
{
    memset(count, 0, ((size_t)1 << DIGIT) * sizeof *count);
    struct pass p = start(s, err);
    while (step(&p)) {
        uint64_t bits = bits_of(p.stamp - p.before) >> below;
        if (p.n > 1 && bits >> DIGIT == *known)
            count[bits & ((1 << DIGIT) - 1)]++;
    }
    uint64_t digit = 0;
    for (; digit < (1 << DIGIT) - 1 && *rank >= count[digit]; digit++)
        *rank -= count[digit];
    *known = *known << DIGIT | digit;
    return p.status;
}

ss_status
ss_usual_step(const struct stamps *s, double *usual, ss_error *err)
{
    size_t *count;
    uint64_t known = 0;
    struct pass p = start(s, err);
    while (step(&p))
        ;
    ss_status st = end(&p);
    if (st != SS_OK)
        return st;
    if ((count = malloc(((size_t)1 << DIGIT) * sizeof *count)) == NULL)
        return ss_fail_memory(err, s->t->name);
    size_t rank = (p.n - 2) / 2;                  /* the lower median, since gaps lengthen steps */
    for (int below = 64 - DIGIT; st == SS_OK && below >= 0; below -= DIGIT)
        st = next_digit(s, count, below, &known, &rank, err);
    memcpy(usual, &known, sizeof *usual);
    free(count);
    return st;
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

/* --- stamps that are not uniform ----------------------------------------------------------- */

/* A stamp that is off by `by`. */
struct off {
    double by, stamp, before;
    unsigned long line;
};

/* Find the stamp that is farthest from the line; of several that differ only by rounding, the first. */
static ss_status
farthest_from(struct line l, const struct stamps *s, double usual, struct off *worst, ss_error *err)
{
    struct sample_count count = { .usual = usual };
    double most = 0;
    *worst = (struct off){ .by = NAN };
    struct pass p = start(s, err);
    while (step(&p)) {
        double off = distance(l, (struct point){ (double)ss_clock_sample(&count, p.stamp), p.stamp });
        if (p.n > 1 && off <= most * (1 + 1e-9))
            continue;
        most = off;
        *worst = (struct off){ off, p.stamp, p.before, p.line };
    }
    return p.status;
}

/* Find the stamp whose step from the one before differs most from the usual step.  A stamp that is off spoils the step
 * to the next row as much, the other way: rounding does not decide which of the two is at fault. */
static ss_status
farthest_step(const struct stamps *s, double usual, struct off *worst, ss_error *err)
{
    struct pass p = start(s, err);
    struct off last = { .by = 0 };
    *worst = last;
    while (step(&p)) {
        struct off now = { p.n > 1 ? p.stamp - p.before - usual : 0, p.stamp, p.before, p.line };
        if (fabs(now.by) > fabs(worst->by))
            *worst = fabs(now.by + last.by) < fabs(now.by) / 2 ? last : now;
        last = now;
    }
    return p.status;
}

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

/* The error names the row at fault: the one whose step from the row before differs most from the usual
 * step or, if all steps are within the tolerance, the one farthest from the best clock. */
static ss_status
refuse(const struct stamps *s, double usual, struct line l, ss_error *err)
{
    struct off worst, from_line;
    ss_status st = farthest_from(l, s, usual, &from_line, err);
    if (st == SS_OK && usual > 0 && l.period > 0)
        return ss_fail(err, SS_EUNEVEN, "%s:%lu: time stamps are not uniform, with gaps counted too: "
                       "this one is off by %.3g sample periods, %.1f is allowed", s->t->name, from_line.line,
                       from_line.by / l.period, CLOCK_TOLERANCE);
    if (st == SS_OK)
        st = ss_usual_step(s, &usual, err);
    if (st == SS_OK)
        st = farthest_step(s, usual, &worst, err);
    if (st != SS_OK)
        return st;
    if (fabs(worst.by) <= CLOCK_TOLERANCE * usual) {
        worst = from_line;
        worst.by = worst.stamp - worst.before > usual ? worst.by : -worst.by;
    }
    return ss_clock_refuse(s->t->name, worst.line, worst.by / usual, err);
}

/* --- the clock ----------------------------------------------------------------------------- */

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

/* Find the rate; SS_EUNEVEN, without a text, if the stamps are not uniform. */
static ss_status
find_rate(const struct fit *f, const char *file, struct clock *c, ss_error *err)
{
    struct line l = line_of(f);
    double deviation = largest_distance(f, l), allowed = CLOCK_TOLERANCE * l.period;
    if (!(l.period > 0 && deviation <= fmax(allowed, fmin(c->digit, BY_DIGITS * l.period))))
        return SS_EUNEVEN;

    /* each stamp is off by at most the deviation, so the period over all of them by at most twice that */
    double rounding = 2 * DBL_EPSILON * fmax(fabs(c->taken + f->first.stamp), fabs(c->taken + f->last.stamp));
    double slack = 2 * (deviation + rounding) / f->last.sample + 4 * DBL_EPSILON * l.period;
    int rate_digits, period_digits;
    ss_status st = ss_refuse_range(file, 1 / (l.period - slack), f->first.stamp, err);
    if (st != SS_OK)
        return st;
    double by_rate = roundest(1 / (l.period + slack), 1 / (l.period - slack), &rate_digits);
    double by_period = roundest(l.period - slack, l.period + slack, &period_digits);
    c->rate = rate_digits <= period_digits ? by_rate : 1 / by_period;
    return SS_OK;
}

ss_status
ss_find_clock(const struct stamps *s, struct clock *c, ss_error *err)
{
    struct fit f = { .n = 0 };
    struct sample_count count = { .usual = c->usual };
    struct pass p = start(s, err);
    while (step(&p))
        if (!add(&f, (double)ss_clock_sample(&count, p.stamp), p.stamp))
            p.status = ss_fail_memory(err, s->t->name);
    ss_status st = end(&p);
    struct line l = line_of(&f);
    if (st == SS_OK)
        st = find_rate(&f, s->t->name, c, err);
    c->start = f.first.stamp;
    c->n = f.n;
    c->last = f.last.sample;
    free(f.side[0].corner);
    free(f.side[1].corner);
    if (st != SS_EUNEVEN)
        return st;
    if (l.period > 0 && c->digit > 2 * BY_DIGITS * l.period)
        return ss_fail(err, st, "%s: time stamps have too few digits: 1 in the last of them is %.2g sample periods, "
                       "%.1f is allowed", s->t->name, c->digit / l.period, 2 * BY_DIGITS);
    return refuse(s, c->usual, l, err);
}
