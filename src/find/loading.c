/* loading.c -- how each stick loads a force, and how each slip lets it fall.
 *
 * While the slider sticks, the drive loads the force along a line.  A first line is fitted to the
 * middle half of the rise from one fall to the next.  The median slope of these lines is used to fit
 * slips to the falls (slip.c).  The stick is the part of the rise that is in no slip and within NEAR
 * standard deviations of the line.  The line is then fitted to the whole stick.  A fall that the fit
 * of a slip does not explain has no drop, duration and friction, and a stick beside it has no length.
 * Nor has any fall, unless the falls show the inertia of a mass (inertia.c).
 * Samples of a measured force are not independent, so the standard error of the slope counts fewer of
 * them (colour.c).
 *
 * The slope of the force over time is the stiffness times the speed of the drive.  Where there is a
 * column of displacement, the slope against it is the stiffness itself. */
#include "find/loading.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include "find/colour.h"
#include "find/drops.h"
#include "find/inertia.h"
#include "find/medians.h"
#include "find/slip.h"
#include "find/window.h"

#define NEAR 3.0                /* standard deviations within which a sample is near the line */
#define AWAY 4                  /* samples in a row that are farther away end the line */
#define MOST_BENT (1 / 3.)      /* see shape: a rise that is bent more, as a recovery is, is no line */

typedef struct line {
    double slope, error;        /* per unit of the abscissa */
    double x, y;                /* a point on it */
    double rms;                 /* about it */
} line;

/* Fit a line to y over x, or over the number of the sample if x is NULL.  Its error is that of white noise. */
static line
through(const double *y, const double *x, ss_window w)
{
    double m = (double)ss_window_length(w), xx = 0, xy = 0, rr = 0;
    line l = { 0, NAN, 0, 0, 0 };
    for (size_t i = w.first; i < w.end; i++) {
        l.x += (x != NULL ? x[i] : (double)i) / m;
        l.y += y[i] / m;
    }
    for (size_t i = w.first; i < w.end; i++) {
        double u = (x != NULL ? x[i] : (double)i) - l.x;
        xx += u * u;
        xy += u * (y[i] - l.y);
    }
    l.slope = xx > 0 ? xy / xx : NAN;
    for (size_t i = w.first; i < w.end; i++) {
        double r = y[i] - l.y - l.slope * ((x != NULL ? x[i] : (double)i) - l.x);
        rr += r * r;
    }
    l.rms = sqrt(rr / (m - 2));
    l.error = l.rms / sqrt(xx);
    return l;
}

static line
fit(const double *y, const double *x, ss_window w)
{
    line l = through(y, x, w);
    l.error *= sqrt(ss_colour(y + w.first, x != NULL ? x + w.first : NULL, ss_window_length(w), l.slope));
    return l;
}

/* The last sample that is near the line, from sample i on towards end. */
static size_t
follow(const double *y, const line *l, size_t i, size_t end)
{
    size_t last = i, away = 0;
    int step = end > i ? 1 : -1;
    while (i != end && away < AWAY) {
        i = step > 0 ? i + 1 : i - 1;
        int near = fabs(y[i] - l->y - l->slope * ((double)i - l->x)) <= NEAR * l->rms;
        last = near ? i : last;
        away = near ? 0 : away + 1;
    }
    return last;
}

/* A fall, and the rise before it, in samples. */
typedef struct fall {
    size_t high, low;           /* the maximum, and the minimum behind */
    ss_window rise;             /* before the fall, without the part that is known to be slip */
    line line;                  /* through its middle half; slope NaN: it is too short */
    ss_slip slip;
    int is_slip;
} fall;

static ss_window
middle_half(ss_window w)
{
    size_t quarter = ss_window_length(w) / 4;
    return (ss_window){ w.first + quarter, w.end - quarter };
}

static line
fit_rise(const double *x, ss_window rise)
{
    enum { FEWEST = 8 };
    if (rise.end < rise.first + FEWEST)
        return (line){ NAN, NAN, 0, 0, 0 };
    return fit(x, NULL, middle_half(rise));
}

static ss_value
times(ss_value v, double factor)
{
    return (ss_value){ v.value * factor, v.error * factor };
}

static ss_value
difference(ss_value a, ss_value b)
{
    return (ss_value){ a.value - b.value, hypot(a.error, b.error) };
}

static void
add_error(ss_value *to, double variance)
{
    to->error = sqrt(to->error * to->error + variance);
}

/* Noise of 1/f has as much in each octave.  What is slower than an event, down to the whole record of n
 * samples, is not in the residual of its fit, but in the levels of the force; in their difference is that of
 * an octave, with either sign at the two ends.  It moves the times, too, at which the force passes 10 and
 * 90 % of the fall at 0.6 D w. */
static void
add_wander(ss_slip *slip, size_t n, double octave)
{
    double slower = octave * fmax(0, log2((double)n / slip->n));
    double speed = 0.3 * slip->drop.value * sqrt(slip->k_over_m.value), time = 2 * octave / (speed * speed);
    add_error(&slip->top, slower);
    add_error(&slip->middle, slower);
    add_error(&slip->drop, 4 * octave);
    add_error(&slip->onset, time);
    add_error(&slip->end, time);
    add_error(&slip->duration, time);
    add_error(&slip->k_over_m, time * pow(2 * slip->k_over_m.value / slip->duration.value, 2));
}

/* What a slow sensor or another law of friction does to a slip it does to all, so that it may be far
 * below the noise of one slip and still be in the median.  The mean residual of all slips has it, beyond
 * what their scatter makes of such a mean.  A smooth misfit hides in the parameters: twice as much of it
 * is taken to lie along each of them as is seen.  The result is the variance of a number by this, over
 * that by noise. */
static double
common_misfit(const fall *f, size_t n)
{
    const double hidden = 2;
    double power = 0, samples = 0, slips = 0;
    for (size_t k = 0; k < SLIP_PARTS; k++) {
        double m = 0, sum = 0, squares = 0;
        for (size_t i = 0; i < n; i++) {
            if (!f[i].is_slip || !isfinite(f[i].slip.residual[k]))
                continue;
            m++;
            sum += f[i].slip.residual[k];
            squares += pow(f[i].slip.residual[k], 2);
        }
        if (m > 1)
            power += (pow(sum / m, 2) - (squares / m - pow(sum / m, 2)) / (m - 1)) / SLIP_PARTS;
    }
    for (size_t i = 0; i < n; i++) {
        if (!f[i].is_slip)
            continue;
        slips++;
        samples += f[i].slip.n * pow(f[i].slip.drop.value, 2) / f[i].slip.variance;
    }
    return power > 0 ? hidden * hidden * power * samples / slips : 0;
}

/* Add so much more variance.  A shift of all onsets does not change the times between two of them, but it
 * changes the sticks: there it is counted with the ends. */
static void
add_common(ss_slip *slip, double more)
{
    ss_value *const v[] = { &slip->end, &slip->drop, &slip->duration, &slip->top, &slip->middle,
                            &slip->k_over_m };
    for (size_t i = 0; i < sizeof v / sizeof *v; i++)
        v[i]->error *= sqrt(1 + more);
    add_error(&slip->end, more * pow(slip->onset.error, 2));
}

static void
read_slip(ss_loading *l, const search *s, const ss_slip *slip)
{
    l->drop = times(slip->drop, s->largest);
    l->duration = times(slip->duration, 1 / s->rate);
    if (!s->has_offset) {
        l->static_friction = times(slip->top, s->largest);
        l->friction = times(slip->middle, s->largest);
    }
    l->k_over_m = times(slip->k_over_m, s->rate * s->rate);
    l->left = slip->left * s->largest * s->largest;
    l->power = slip->power * s->largest * s->largest;
    l->n = slip->n;
}

/* An end of a stick, moved to where its line puts it.  The slip beside it may put it elsewhere, by creep or by
 * noise that wanders: their difference is an error. */
static ss_value
moved_to(ss_value end, double to)
{
    return (ss_value){ to, hypot(end.error, to - end.value) };
}

/* The samples of the rise that stay near the line. */
static ss_window
find_stick(const double *x, const fall *f, const fall *before, ss_value *length)
{
    ss_window half = middle_half(f->rise);
    ss_window stick = { follow(x, &f->line, half.first, f->rise.first),
                        follow(x, &f->line, half.end - 1, f->rise.end - 1) + 1 };
    *length = unknown;
    if (before == NULL || !before->is_slip || !f->is_slip)
        return stick;
    ss_value begin = before->slip.end, end = f->slip.onset;
    if (stick.first > f->rise.first + AWAY)
        begin = moved_to(begin, (double)stick.first);
    if (stick.end + AWAY < f->rise.end)
        end = moved_to(end, (double)stick.end);
    *length = difference(end, begin);
    return stick;
}

/* How the rises differ from lines.  octave is the variance of noise in the octave of a stick's length: by how
 * much the residual of lines through whole sticks is larger than that of lines through their halves.
 * bend is the difference between the slopes of the halves, relative to the slope, where it is more than
 * two standard errors, else 0.  By so much do the slopes at the ends differ from their mean. */
typedef struct shape {
    double octave, bend;
} shape;

/* Read the stick of a rise.  Noise of variance v in the octave of its m samples has a slope of variance
 * 12 v / m^2, about. */
static void
read_stick(ss_loading *l, const search *s, const double *x, const fall *f, const fall *before, shape rises)
{
    ss_value length;
    ss_window stick = find_stick(x, f, before, &length);
    line found = fit(x, NULL, stick);
    if (!(found.slope > 0) || rises.bend > MOST_BENT)
        return;
    double m = (double)ss_window_length(stick), tilt = hypot(sqrt(12 * rises.octave) / (m * found.slope), rises.bend);
    l->slope = times((ss_value){ found.slope, hypot(found.error, tilt * found.slope) },
                     s->rate * s->largest);
    l->stick = times(length, 1 / s->rate);
    if (s->opts->displacement < 0)
        return;
    found = fit(x, s->signal->values + (size_t)s->opts->displacement * s->n, stick);
    l->stiffness = times((ss_value){ fabs(found.slope), hypot(found.error, tilt * found.slope) },
                         s->largest);
}

/* Add the error of the median of sticks that is common to all: sticks that end before the slip do so in all
 * cycles. */
static void
add_creep(ss_features *out, const search *s, const fall *f, ss_value *v, double *scratch)
{
    for (size_t i = 0; i < out->n; i++) {
        v[i] = unknown;
        if (isfinite(out->loading[i].stick.value))
            v[i] = times(difference(f[i].slip.onset, f[i - 1].slip.end), 1 / s->rate);
    }
    out->stick.error = hypot(out->stick.error, ss_median_of(v, out->n, scratch).value - out->stick.value);
}

/* Fit lines to the rises, and slips to the falls between them, with *loading, the median slope of the lines. */
static ss_status
fit_falls(fall *f, const search *s, const double *x, size_t n, ss_value *v, double *scratch,
          double *loading)
{
    ss_status st = SS_OK;
    for (size_t i = 0; i < n; i++) {
        f[i].line = fit_rise(x, f[i].rise);
        v[i] = (ss_value){ f[i].line.slope > 0 ? f[i].line.slope : NAN, NAN };
    }
    *loading = ss_median_of(v, n, scratch).value;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        const ss_window room = { f[i].rise.first, i + 1 < n ? f[i + 1].rise.end : s->n };
        st = ss_slip_fit(&f[i].slip, &f[i].is_slip, x, room, f[i].high, f[i].low, *loading);
    }
    return st;
}

/* Let rises begin and end where the slips do. */
static void
leave_out_slips(fall *f, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (i > 0 && f[i - 1].is_slip)
            f[i].rise.first = (size_t)ceil(f[i - 1].slip.end.value);
        if (f[i].is_slip)
            f[i].rise.end = (size_t)f[i].slip.onset.value + 1;
    }
}

/* Forget the slips, unless they explain more of the falls better than relaxations do. */
static ss_status
judge_inertia(fall *f, const search *s, const double *x, size_t n, double loading)
{
    enum { MOST = 64 };         /* the most falls that are judged, evenly over the record */
    int signs = 0, sign;
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < n; i += n / MOST + 1) {
        const ss_window room = { f[i].rise.first, i + 1 < n ? f[i + 1].rise.end : s->n };
        if (!f[i].is_slip)
            continue;
        st = ss_inertia_sign(&sign, x, room, &f[i].slip, loading);
        signs += sign;
    }
    for (size_t i = 0; i < n && signs <= 0; i++)
        f[i].is_slip = 0;
    return st;
}

/* Fit lines and slips to the rises and falls of x, which the drops give.  A line that contains a part of a
 * slip is too steep or too flat.  The slips that are fitted with such lines are wrong, too, but less: three
 * passes are enough. */
static ss_status
find_falls(fall *f, const search *s, const double *x, const ss_drop *drop, size_t n, ss_value *v,
           double *scratch)
{
    enum { PASSES = 3 };
    double loading = NAN;
    ss_status st = SS_OK;
    for (size_t i = 0; i < n; i++) {
        f[i].high = (size_t)(drop[i].t * s->rate + 0.5);
        f[i].low = (size_t)(drop[i].end * s->rate + 0.5);
        f[i].rise = (ss_window){ i > 0 ? f[i - 1].low : 0, f[i].high + 1 };
        for (size_t k = 0; i == 0 && k < f[i].high; k++)    /* there is no fall before the first */
            f[i].rise.first = x[k] < x[f[i].rise.first] ? k : f[i].rise.first;
    }
    for (int pass = 0; st == SS_OK && pass < PASSES; pass++) {
        if (pass > 0)
            leave_out_slips(f, n);
        st = fit_falls(f, s, x, n, v, scratch, &loading);
    }
    return st == SS_OK ? judge_inertia(f, s, x, n, loading) : st;
}

static ss_loading
read_loading(const search *s, const double *x, const ss_drop *drop, const fall *f, int is_first,
             shape rises)
{
    const fall *before = is_first ? NULL : f - 1;
    ss_loading l = { drop->t, unknown, unknown, unknown, unknown, unknown, unknown, unknown, unknown,
                     unknown, 0, 0, 0 };
    if (f->is_slip)
        read_slip(&l, s, &f->slip);
    if (before != NULL && ss_gaps_near(s->gap, s->n_gaps, 0.5 * (drop->t + drop[-1].t),
                                       0.5 * (drop->t - drop[-1].t)))
        return l;
    if (f->line.slope > 0)
        read_stick(&l, s, x, f, before, rises);
    if (before != NULL && before->is_slip && f->is_slip)
        l.recurrence = times(difference(f->slip.onset, before->slip.onset), 1 / s->rate);
    return l;
}

static shape
shape_of(const double *x, const fall *f, size_t n)
{
    enum { FEWEST = 16 };
    double whole = 0, halves = 0, samples = 0, sticks = 0, bend = 0, squares = 0;
    for (size_t i = 0; i < n; i++) {
        ss_value length;
        if (!(f[i].line.slope > 0))
            continue;
        ss_window stick = find_stick(x, &f[i], i > 0 ? &f[i - 1] : NULL, &length);
        size_t m = ss_window_length(stick), middle = stick.first + m / 2;
        if (m < FEWEST)
            continue;
        line all = through(x, NULL, stick), first = through(x, NULL, (ss_window){ stick.first, middle });
        line last = through(x, NULL, (ss_window){ middle, stick.end });
        double bent = (last.slope - first.slope) / all.slope;
        whole += pow(all.rms, 2) * (double)(m - 2);
        halves += pow(first.rms, 2) * ((double)(m / 2) - 2) + pow(last.rms, 2) * ((double)(m - m / 2) - 2);
        samples += (double)m;
        bend += bent;
        squares += bent * bent;
        sticks++;
    }
    if (sticks == 0)
        return (shape){ 0, 0 };
    bend /= sticks;
    double error = sqrt(fmax(0, squares / sticks - bend * bend) / (sticks - 1));
    return (shape){ fmax(0, whole / (samples - 2 * sticks) - halves / (samples - 4 * sticks)),
                    fabs(bend) > 2 * error ? fabs(bend) : 0 };
}

ss_status
ss_loading_find(search *s, const double *x, const ss_drop *drop, size_t n)
{
    ss_features *out = s->out;
    double *y = malloc((s->n + n + 1) * sizeof *y), *scratch = y + s->n;
    ss_value *v = calloc(n + 1, sizeof *v);
    fall *f = calloc(n + 1, sizeof *f);
    out->loading = calloc(n + 1, sizeof *out->loading);
    ss_status st = out->loading != NULL && y != NULL && v != NULL && f != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_drops_without_glitches(y, x, s->n, drop, n);
    if (st == SS_OK)
        st = find_falls(f, s, y, drop, n, v, scratch);
    shape rises = st == SS_OK ? shape_of(y, f, n) : (shape){ 0, 0 };
    double more = st == SS_OK ? common_misfit(f, n) : 0;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        if (f[i].is_slip) {
            add_common(&f[i].slip, more);
            add_wander(&f[i].slip, s->n, rises.octave);
            out->transition[i].onset = f[i].slip.onset.value / s->rate;
            out->transition[i].end = f[i].slip.end.value / s->rate;
        }
        out->loading[i] = read_loading(s, y, &drop[i], &f[i], i == 0, rises);
    }
    if (st == SS_OK) {
        ss_loading_medians(out, drop, more / (1 + more), v, scratch);
        add_creep(out, s, f, v, scratch);
    }
    free(f);
    free(v);
    free(y);
    return st;
}
