/* loading.c -- how each stick loads a force, and how each slip lets it fall.
 *
 * While the slider sticks, the drive loads the force along a line.  A first line is fitted to the
 * middle half of the rise from one fall to the next.  The median slope of these lines is used to fit
 * slips to the falls (slip.c).  The stick is the part of the rise that is in no slip and within SIGMAS
 * standard deviations of the line, but for two in a row.  The line is then fitted to the whole stick.  A fall that
 * the fit of a slip does not explain has no drop, duration and friction, and a stick beside it has no length.
 * Nor has any fall, unless the falls show the inertia of a mass (slip.c).
 * Samples of a measured force are not independent, so the standard error of the slope counts fewer of
 * them (medians.c).
 *
 * The slope of the force over time is the stiffness times the speed of the drive.  Where there is a
 * column of displacement, the slope against it is the stiffness itself. */
#include "find/search.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "find/medians.h"
#include "find/slip.h"
#include "signal/gaps.h"

#define MOST_DAMPING 0.5        /* of either sign, as friction may fall with speed */

/* A fall, and the rise before it, in samples. */
typedef struct fall {
    size_t high, low;           /* the maximum, and the minimum behind */
    ss_window rise;             /* before the fall, without the part that is known to be slip */
    ss_line line;               /* through its middle half; slope NaN: it is too short */
    ss_slip slip;               /* n 0: it is none */
    double shift[SLIP_NUMBERS]; /* of its numbers by damping */
    ss_window stick;            /* the samples of the rise that stay near the line; empty if there is none */
} fall;

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

/* --- lines and slips ------------------------------------------------------------------------- */

/* Fit lines to the rises and slips to the falls of y, which the drops give.  A line that contains a part of
 * a slip is too steep or too flat.  The slips that are fitted with such lines are wrong, too, but less: three
 * passes are enough.  The damping is one for all slips: the median of what each shows in the second pass.
 * Friction that falls with speed hardly falls along a line: the slips are then fitted undamped.
 * Then forget the slips, unless they explain more of the falls better than relaxations do. */
static ss_status
find_falls(fall *f, const search *s, const double *y, const ss_drop *drop, size_t n, ss_value *v,
           double *scratch, ss_number *damping)
{
    enum { PASSES = 3, FREE = 1, JUDGED = 64 };     /* JUDGED: the most falls, evenly over the record */
    double loading = NAN;
    ss_range used = { 0, 0 };           /* damping */
    int signs = 0, sign;
    ss_status st = SS_OK;
    for (size_t i = 0; i < n; i++) {
        f[i].high = drop[i].high;
        f[i].low = drop[i].low;
        f[i].rise = (ss_window){ i > 0 ? f[i - 1].low : 0, f[i].high + 1 };
        for (size_t k = 0; i == 0 && k < f[i].high; k++)    /* there is no fall before the first */
            f[i].rise.first = y[k] < y[f[i].rise.first] ? k : f[i].rise.first;
    }
    for (int pass = 0; pass < PASSES; pass++) {
        for (size_t i = 0; i < n; i++) {
            ss_window *rise = &f[i].rise;
            if (i > 0 && f[i - 1].slip.n > 0)
                rise->first = (size_t)ceil(f[i - 1].slip.end.value);
            if (f[i].slip.n > 0)
                rise->end = (size_t)f[i].slip.onset.value + 1;
            f[i].line.slope = v[i].value = NAN;
            if (rise->end < rise->first + FEWEST)
                continue;
            size_t quarter = ss_window_length(*rise) / 4;
            f[i].line = ss_line_through(y, NULL, (ss_window){ rise->first + quarter, rise->end - quarter });
            v[i].value = f[i].line.slope > 0 ? f[i].line.slope : NAN;
        }
        loading = ss_median_of(v, n, scratch).value;
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            ss_window room = { f[i].rise.first, i + 1 < n ? f[i + 1].rise.end : s->n };
            st = ss_slip_fit(&f[i].slip, y, room, f[i].high, f[i].low, loading,
                             pass == FREE ? (ss_range){ -MOST_DAMPING, MOST_DAMPING } : used);
            if (pass == FREE) {
                memcpy(f[i].shift, f[i].slip.shift, sizeof f[i].shift);
                v[i] = f[i].slip.damping;
            }
        }
        if (pass == FREE) {
            *damping = ss_median_of(v, n, scratch);
            used.from = used.to = isfinite(damping->value) && !(damping->value < -SIGMAS * damping->error)
                ? damping->value : 0;
        }
    }
    for (size_t i = 0; st == SS_OK && i < n; i += n / JUDGED + 1) {
        ss_window room = { f[i].rise.first, i + 1 < n ? f[i + 1].rise.end : s->n };
        if (f[i].slip.n == 0)
            continue;
        st = ss_inertia_sign(&sign, y, room, &f[i].slip, loading);
        signs += sign;
    }
    for (size_t i = 0; i < n && signs <= 0; i++)
        f[i].slip.n = 0;
    return st;
}

/* --- sticks ---------------------------------------------------------------------------------- */

/* The last sample that is near the line, from sample i on towards end. */
static size_t
follow(const double *y, const ss_line *l, size_t i, size_t end)
{
    size_t last = i, away = 0;
    int step = end > i ? 1 : -1;
    while (i != end && away < FEW) {
        i = step > 0 ? i + 1 : i - 1;
        int near = fabs(ss_line_off(l, y, i)) <= SIGMAS * l->rms;
        last = near ? i : last;
        away = near ? 0 : away + 1;
    }
    return last;
}

/* How the rises differ from lines.  octave is the variance of noise in the octave of a stick's length: by how
 * much the residual of lines through whole sticks is larger than that of lines through their halves.
 * bend is the difference between the slopes of the halves, relative to the slope, where it is more than
 * two standard errors, else 0.  By so much do the slopes at the ends differ from their mean. */
typedef struct shape {
    double octave, bend;
} shape;

static shape
shape_of(const double *y, const fall *f, size_t n)
{
    double whole = 0, halves = 0, samples = 0, sticks = 0, bend = 0, squares = 0;
    for (size_t i = 0; i < n; i++) {
        ss_window stick = f[i].stick;
        size_t m = ss_window_length(stick), middle = stick.first + m / 2;
        if (m < 2 * FEWEST)
            continue;
        ss_line all = ss_line_through(y, NULL, stick);
        ss_line first = ss_line_through(y, NULL, (ss_window){ stick.first, middle });
        ss_line last = ss_line_through(y, NULL, (ss_window){ middle, stick.end });
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

/* --- errors ---------------------------------------------------------------------------------- */

/* What a slow sensor or another law of friction does to a slip it does to all, so that it may be far
 * below the noise of one slip and still be in the median.  The mean residual of all slips has it, beyond
 * what their scatter makes of such a mean.  A smooth misfit hides in the parameters: twice as much of it
 * is taken to lie along each of them as is seen.  The result is the variance of a number by this, over
 * that by noise. */
static double
common_misfit(const fall *f, size_t n)
{
    double power = 0, samples = 0, slips = 0;
    for (size_t k = 0; k < SLIP_PARTS; k++) {
        double m = 0, sum = 0, squares = 0;
        for (size_t i = 0; i < n; i++) {
            double left = f[i].slip.n > 0 ? f[i].slip.residual[k] : NAN;
            if (!isfinite(left))
                continue;
            m++;
            sum += left;
            squares += left * left;
        }
        if (m > 1)
            power += (pow(sum / m, 2) - (squares / m - pow(sum / m, 2)) / (m - 1)) / SLIP_PARTS;
    }
    for (size_t i = 0; i < n; i++) {
        if (f[i].slip.n == 0)
            continue;
        slips++;
        samples += f[i].slip.n * pow(f[i].slip.drop.value, 2) / f[i].slip.variance;
    }
    return power > 0 ? 4 * power * samples / slips : 0;
}

/* Widen the errors of a slip by what its fit does not see; add to shared and all, of each number, the variance
 * that all slips share and the whole.
 *
 * What all slips share is `common` times the variance by noise, and the error of the damping, in which is a
 * negative one that was not used.  A shift of all onsets
 * does not change the times between two of them, but it changes the sticks: there it is counted with the ends.
 *
 * Noise of 1/f has as much in each octave.  What is slower than an event, down to the whole record of n
 * samples, is not in the residual of its fit, but in the levels of the force; in their difference is that of
 * an octave, with either sign at the two ends.  It moves the times, too, at which the force passes 10 and
 * 90 % of the fall at 0.6 D w. */
static void
widen_errors(fall *f, double common, double damping_error, double octave, size_t n, double shared[], double all[])
{
    ss_slip *slip = &f->slip;
    double slower = octave * fmax(0, log2((double)n / slip->n)), k_over_m = slip->k_over_m.value;
    double speed = 0.3 * slip->drop.value * sqrt(k_over_m), time = 2 * octave / (speed * speed);
    double onset = pow(slip->onset.error, 2);
    ss_value *const of[SLIP_NUMBERS] = { &slip->onset, &slip->end, &slip->drop, &slip->duration, &slip->top,
                                         &slip->middle, &slip->k_over_m };
    const double more[SLIP_NUMBERS] = { time, time, 4 * octave, time, slower, slower,
                                        time * pow(2 * k_over_m / slip->duration.value, 2) };
    for (size_t i = 0; i < SLIP_NUMBERS; i++) {
        double shift = i == SLIP_END ? f->shift[i] - f->shift[SLIP_ONSET] : f->shift[i];
        double noise = pow(of[i]->error, 2), alike = i == SLIP_ONSET ? 0
            : common * (noise + (i == SLIP_END ? onset : 0)) + pow(shift * damping_error, 2);
        of[i]->error = sqrt(noise + alike + more[i]);
        shared[i] += alike;
        all[i] += noise + alike;
    }
}

/* --- all of it ------------------------------------------------------------------------------- */

/* The slope of y over x in a stick, if y rises over time.  Noise of variance v in the octave of its m samples has
 * a slope of variance 12 v / m^2, about. */
static ss_value
slope_of(const double *y, const double *x, const fall *f, shape rises)
{
    size_t first = f->stick.first, m = ss_window_length(f->stick);
    double steep = ss_line_through(y, NULL, f->stick).slope;
    double tilt = hypot(sqrt(12 * rises.octave) / ((double)m * steep), rises.bend);
    ss_line l = ss_line_through(y, x, f->stick);
    l.error *= sqrt(ss_colour(y + first, x != NULL ? x + first : NULL, m, l.slope));
    return steep > 0 ? (ss_value){ fabs(l.slope), hypot(l.error, tilt * l.slope) } : unknown;
}

static ss_loading
read_loading(const search *s, const double *y, const fall *f, int is_first, shape rises)
{
    const ss_slip *slip = &f->slip;
    const double t = (double)f->high / s->rate, before = is_first ? t : (double)f[-1].high / s->rate;
    int is_between = !is_first && f[-1].slip.n > 0 && slip->n > 0;
    ss_loading l = { t, unknown, unknown, unknown, unknown, unknown, unknown, unknown, unknown,
                     unknown, 0, 0, 0 };
    if (slip->n > 0) {
        l.drop = times(slip->drop, s->largest);
        l.duration = times(slip->duration, 1 / s->rate);
        l.static_friction = s->has_offset ? unknown : times(slip->top, s->largest);
        l.friction = s->has_offset ? unknown : times(slip->middle, s->largest);
        l.k_over_m = times(slip->k_over_m, s->rate * s->rate);
        l.left = slip->left * s->largest * s->largest;
        l.power = slip->power * s->largest * s->largest;
        l.n = slip->n;
    }
    if (!is_first && ss_gaps_near(s->gap, s->n_gaps, 0.5 * (t + before), 0.5 * (t - before)))
        return l;
    if (ss_window_length(f->stick) > 0 && rises.bend <= 1 / SIGMAS) {
        l.slope = times(slope_of(y, NULL, f, rises), s->rate * s->largest);
        if (l.slope.value > 0 && s->opts->displacement >= 0)
            l.stiffness = times(slope_of(y, s->signal->values + (size_t)s->opts->displacement * s->n, f, rises),
                                s->largest);
        if (!(l.stiffness.value > SIGMAS * l.stiffness.error))          /* the displacement hardly moves */
            l.stiffness = unknown;
        if (l.slope.value > 0 && is_between)
            l.stick = times(difference(slip->onset, f[-1].slip.end), 1 / s->rate);
    }
    if (is_between)
        l.recurrence = times(difference(slip->onset, f[-1].slip.onset), 1 / s->rate);
    return l;
}

ss_status
ss_loading_find(search *s, const double *y, const ss_drop *drop, size_t n)
{
    ss_features *out = s->out;
    double *scratch = malloc((n + 1) * sizeof *scratch);
    ss_value *v = calloc(n + 1, sizeof *v);
    fall *f = calloc(n + 1, sizeof *f);
    out->loading = calloc(n + 1, sizeof *out->loading);
    ss_number damping = no_number;
    ss_status st = out->loading != NULL && scratch != NULL && v != NULL && f != NULL ? ss_transitions_new(out, n)
        : SS_ENOMEM;
    if (st == SS_OK)
        st = find_falls(f, s, y, drop, n, v, scratch, &damping);
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        const ss_window rise = f[i].rise;
        size_t quarter = ss_window_length(rise) / 4;
        if (f[i].line.slope > 0)
            f[i].stick = (ss_window){ follow(y, &f[i].line, rise.first + quarter, rise.first),
                                      follow(y, &f[i].line, rise.end - quarter - 1, rise.end - 1) + 1 };
    }
    if (st == SS_OK) {
        shape rises = shape_of(y, f, n);
        double common = common_misfit(f, n), shared[SLIP_NUMBERS] = { 0 }, all[SLIP_NUMBERS] = { 0 };
        double unused = damping.value < -SIGMAS * damping.error ? damping.value : 0;
        double damping_error = isfinite(damping.error) ? hypot(damping.error, unused) : 0;
        for (size_t i = 0; i < n; i++) {
            const int is_slip = f[i].slip.n > 0;
            if (is_slip)
                widen_errors(&f[i], common, damping_error, rises.octave, s->n, shared, all);
            out->transition[i].onset = (is_slip ? f[i].slip.onset.value : (double)f[i].high) / s->rate;
            out->transition[i].end = (is_slip ? f[i].slip.end.value : (double)f[i].low) / s->rate;
            out->loading[i] = read_loading(s, y, &f[i], i == 0, rises);
        }
        for (size_t i = 0; i < SLIP_NUMBERS; i++)
            shared[i] = all[i] > 0 ? shared[i] / all[i] : 0;
        if (fabs(damping.value) >= MOST_DAMPING)
            damping = (ss_number){ NAN, NAN, NAN, "friction is not constant in slip" };
        ss_loading_medians(out, drop, shared, &damping, v, scratch);
    }
    free(f);
    free(v);
    free(scratch);
    return st;
}
