/* spikes.c -- jumps, kinks and glitches from the maxima of |W| along the shortest scales.
 *
 * Rows of |W|, one a scale, are taken from the shortest scale on.  A maximum along a row that is
 * above the threshold, has one above the threshold beside it in the next row, and lies clear of all
 * spikes found at shorter scales is a spike.  Once a row shows one, the rows of REACH octaves more
 * are looked at: weaker spikes and blunter ones appear there, and what appears only later is no
 * longer sharp.
 *
 * Noise: the rms of |W| in a row, from the median, which spikes do not move: |W|^2 of Gaussian
 * noise is exponential, its median ln 2 of its mean.  Threshold: |W| of Gaussian noise crosses the level u
 * (in units of its rms) upwards u exp(-u^2) / (a sqrt(2 pi)) times a second (Rice 1945, with the
 * spectral width 1/(sqrt(2) a) of the Morlet wavelet); summed over the rows that is to be
 * false_alarms.  Neighbouring rows are not independent, so there are fewer.
 *
 * The record is continued oddly about its end points, so that it goes on with the same value and
 * slope; what is nearer to an end than sqrt(2) a is not used all the same. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "error.h"
#include "features/breakpoint.h"
#include <stickslip/morlet.h>
#include <stickslip/spikes.h>

#define CENTER 6.0
#define VOICES 4
#define HIGHEST 0.6             /* of Nyquist */
#define REACH 2.0               /* octaves looked at from the first row with a spike on */
#define CLEAR 2.0               /* scales that two spikes are apart at least */
#define DRIFT 0.5               /* scales by which a maximum moves from row to row at most */
#define MARGIN 6.0              /* scales by which the record is continued */
#define CONCLUSIVE 6.0          /* dB that the clearest spike is above the threshold at least */
#define QUIET 3.0               /* scales from a spike on that it is not heard */
#define LEAST 0.1               /* part of a row that its noise is read from at least */
#define FIT 2.0                 /* scales on either side that the fit of a break sees */

const ss_spike_opts ss_spike_defaults = { 0, 0.01, 1e-7 };

typedef struct peak {
    double t, level;            /* [s], |W| */
} peak;

typedef struct row {
    double a, f;
    double rms, top;            /* of the noise; the largest peak's level */
    size_t n;
    peak *peak;                 /* all maxima, in time order */
} row;

typedef struct search {
    const double *x;
    size_t n;
    double rate, x_max;
    const ss_spike_opts *opts;
    size_t n_rows;
    row *row;
    double threshold;
    size_t room;
    ss_spikes_found *found;
} search;

const char *
ss_spike_kind_name(ss_spike_kind kind)
{
    static const char *const name[] = { "glitch", "jump", "kink", "bend" };
    return (unsigned)kind <= SS_SPIKE_BEND ? name[kind] : "?";
}

/* --- a row --------------------------------------------------------------------------------- */

/* The record with margin samples more at either end, an odd continuation; past the other end of
 * a record that is too short for that, its last value stays. */
static double *
continued(const double *x, size_t n, size_t margin)
{
    double *y = malloc((n + 2 * margin) * sizeof *y);
    if (y == NULL)
        return NULL;
    for (size_t i = 0; i < n; i++)
        y[margin + i] = x[i];
    for (size_t i = 1; i <= margin; i++) {
        size_t k = i < n ? i : n - 1;
        y[margin - i] = 2 * x[0] - x[k];
        y[margin + n - 1 + i] = 2 * x[n - 1] - x[n - 1 - k];
    }
    return y;
}

static int
by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* The maximum of the parabola through three levels, the middle one the largest. */
static peak
summit(const double *level, double t, double step)
{
    double bend = level[0] - 2 * level[1] + level[2];
    double off = bend < 0 ? 0.5 * (level[0] - level[2]) / bend : 0;
    return (peak){ t + off * step, level[1] - 0.25 * (level[0] - level[2]) * off };
}

/* The rms of |W| in the n levels, which are sorted, one every step from t on, by the median of those
 * that are farther than quiet from all spikes found so far: all that there are, if these are less
 * than LEAST of them. */
static double
noise_of(const ss_spikes_found *found, double *level, size_t n, double t, double step, double quiet)
{
    size_t left = 0, i = 0;
    for (size_t k = 0; k < n; k++) {
        double at = t + (double)k * step;
        while (i < found->n && found->spike[i].t + quiet < at)
            i++;
        if (i < found->n && found->spike[i].t - quiet <= at)
            continue;
        double swap = level[left];
        level[left++] = level[k];
        level[k] = swap;
    }
    if ((double)left < LEAST * (double)n)
        left = n;
    qsort(level, left, sizeof *level, by_value);
    return level[left / 2] / sqrt(M_LN2);
}

/* Levels of |W| in level, of which those before t = 0 and behind the record are not its own. */
static ss_status
fill_row(row *r, const ss_spikes_found *found, const ss_scale *scale, double *level, double margin,
         double length)
{
    double step = scale->b_num / scale->b_den, cone = sqrt(2) * r->a;
    size_t first = (size_t)ceil((margin + cone) / step);
    size_t last = (size_t)floor((margin + length - cone) / step);
    r->peak = malloc((scale->n / 2 + 1) * sizeof *r->peak);
    if (r->peak == NULL)
        return SS_ENOMEM;
    for (size_t k = first; k <= last; k++)
        if (level[k] > level[k - 1] && level[k] >= level[k + 1])
            r->peak[r->n++] = summit(level + k - 1, ss_scale_b(scale, k) - margin, step);
    for (size_t i = 0; i < r->n; i++)
        r->top = fmax(r->top, r->peak[i].level);
    r->rms = noise_of(found, level + first, last - first + 1, ss_scale_b(scale, first) - margin,
                      step, QUIET * r->a);
    return SS_OK;
}

/* |W| of the whole record at one scale, its maxima and its noise. */
static ss_status
compute_row(row *r, const search *s, double f, ss_error *err)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    ss_morlet *plan = NULL;
    opts.center = CENTER, opts.voices = VOICES, opts.force = 1, opts.accuracy = 1e-10;
    opts.octaves = 1;
    opts.m0 = opts.m1 = round(VOICES * log2(CENTER / (2 * M_PI * f))) / VOICES;
    double a = exp2(opts.m0);
    size_t margin = (size_t)ceil(MARGIN * a * s->rate), n = s->n + 2 * margin;
    double *x = continued(s->x, s->n, margin), *w = NULL;
    ss_status st = x == NULL ? SS_ENOMEM : ss_morlet_new(&plan, n, s->rate, &opts, err);
    if (st == SS_OK && (w = malloc(2 * ss_morlet_total(plan) * sizeof *w)) == NULL)
        st = SS_ENOMEM;
    if (st == SS_OK)
        st = ss_morlet_execute(plan, x, w, err);
    if (st == SS_OK) {
        const ss_scale *scale = ss_morlet_scale(plan, 0);
        for (size_t k = 0; k < scale->n; k++)
            w[k] = hypot(w[2 * k], w[2 * k + 1]);
        *r = (row){ .a = a, .f = scale->f };
        st = fill_row(r, s->found, scale, w, (double)margin / s->rate,
                      (double)(s->n - 1) / s->rate);
        /* what rounding of the samples alone gives, as white noise */
        r->rms = hypot(r->rms, s->opts->precision * s->x_max / sqrt(s->rate));
    }
    ss_morlet_free(plan);
    free(w);
    free(x);
    return st;
}

/* --- from row to row ----------------------------------------------------------------------- */

/* The peak of the row nearest to t, or NULL if it is farther than within. */
static const peak *
nearest(const row *r, double t, double within)
{
    size_t lo = 0, hi = r->n;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (r->peak[mid].t < t)
            lo = mid + 1;
        else
            hi = mid;
    }
    const peak *best = NULL;
    if (lo < r->n && r->peak[lo].t - t <= within)
        best = &r->peak[lo];
    if (lo > 0 && t - r->peak[lo - 1].t <= within
        && (best == NULL || t - r->peak[lo - 1].t < best->t - t))
        best = &r->peak[lo - 1];
    return best;
}

static int
stands_out(const search *s, const row *r, const peak *p)
{
    return p != NULL && p->level > s->threshold * r->rms;
}

/* dB an octave along the line of maxima that begins at peak p of row i, over an octave at most; what
 * it has above the noise where that is most, into *clearest. */
static double
slope_of(const search *s, size_t i, const peak *p, double *clearest)
{
    *clearest = p->level / s->row[i].rms;
    double sum = 0, weight = 0, base = log(p->level);
    size_t last = i;
    double level[VOICES + 1] = { 0 };
    for (size_t k = i + 1; k < s->n_rows && k <= i + VOICES; k++) {
        const peak *next = nearest(&s->row[k], p->t, DRIFT * s->row[k].a);
        if (next == NULL)
            break;
        p = next;
        *clearest = fmax(*clearest, p->level / s->row[k].rms);
        level[k - i] = 20 * (log(p->level) - base) / M_LN10;
        last = k;
    }
    double mid = (double)(last - i) / 2;
    for (size_t k = 0; k <= last - i; k++) {
        sum += ((double)k - mid) * level[k];
        weight += ((double)k - mid) * ((double)k - mid);
    }
    return weight > 0 ? sum / weight * VOICES : 0;
}

static ss_spike_kind
kind_of(double slope)
{
    return slope < -1.5 ? SS_SPIKE_GLITCH : slope < 4 ? SS_SPIKE_JUMP
        : slope < 22 ? SS_SPIKE_KINK : SS_SPIKE_BEND;
}

static ss_status
add_spike(search *s, size_t i, const peak *p)
{
    ss_spikes_found *found = s->found;
    const row *r = &s->row[i];
    if (found->n == s->room) {
        size_t room = 2 * s->room + 64;
        ss_spike *more = realloc(found->spike, room * sizeof *more);
        if (more == NULL)
            return SS_ENOMEM;
        found->spike = more;
        s->room = room;
    }
    found->spike[found->n++] = (ss_spike){
        .t = p->t, .f = r->f, .level = 20 * log10(p->level / r->top), .snr = p->level / r->rms };
    return SS_OK;
}

static int
earlier_first(const void *a, const void *b)
{
    const ss_spike *p = a, *q = b;
    return (p->t > q->t) - (p->t < q->t);
}

/* Is t clear of the n spikes found at shorter scales, which are in time order? */
static int
is_clear(const ss_spikes_found *found, size_t n, double t, double distance)
{
    size_t lo = 0, hi = n;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (found->spike[mid].t < t)
            lo = mid + 1;
        else
            hi = mid;
    }
    return !(lo < n && found->spike[lo].t - t < distance)
        && !(lo > 0 && t - found->spike[lo - 1].t < distance);
}

/* The spikes that row i is the shortest to show. */
static ss_status
take_row(search *s, size_t i)
{
    const row *r = &s->row[i], *next = &s->row[i + 1];
    size_t before = s->found->n;
    for (size_t k = 0; k < r->n; k++) {
        const peak *p = &r->peak[k];
        if (!stands_out(s, r, p) || !is_clear(s->found, before, p->t, CLEAR * r->a)
            || !stands_out(s, next, nearest(next, p->t, DRIFT * next->a)))
            continue;
        ss_status st = add_spike(s, i, p);
        if (st != SS_OK)
            return st;
    }
    qsort(s->found->spike, s->found->n, sizeof *s->found->spike, earlier_first);
    return SS_OK;
}

/* u for which Gaussian noise crosses it false_alarms times: u exp(-u^2) sum_rows T / (a sqrt(2 pi)),
 * by u^2 = log(...) repeated, which contracts. */
static double
find_threshold(double length, double shortest, size_t rows, double false_alarms)
{
    double count = 0, u = 4;
    for (size_t i = 0; i < rows; i++)
        count += length / (shortest * exp2((double)i / VOICES) * sqrt(2 * M_PI));
    for (int pass = 0; pass < 30; pass++)
        u = sqrt(fmax(log(u * count / false_alarms), 1));
    return u;
}

static ss_status
search_rows(search *s, double f, ss_error *err)
{
    double length = (double)(s->n - 1) / s->rate, shortest = CENTER / (2 * M_PI * f);
    double octaves = log2(length / (2 * (sqrt(2) + CLEAR) * shortest));
    if (!(octaves > 0))
        return SS_OK;           /* too short for any */
    size_t rows = (size_t)(octaves * VOICES) + 1, last = rows - 1;
    s->threshold = find_threshold(length, shortest, rows, s->opts->false_alarms);
    s->row = calloc(rows, sizeof *s->row);
    if (s->row == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i <= last; i++) {
        ss_status st = compute_row(&s->row[i], s, f * exp2(-(double)i / VOICES), err);
        if (st != SS_OK)
            return st;
        s->n_rows = i + 1;
        if (s->row[i].top > s->threshold * s->row[i].rms && last == rows - 1)
            last = i + (size_t)(REACH * VOICES) < last ? i + (size_t)(REACH * VOICES) : last;
        if (i > 0 && (st = take_row(s, i - 1)) != SS_OK)
            return st;
    }
    return SS_OK;
}

/* --- times and the whole ------------------------------------------------------------------- */

/* Spike i's time from the fit, which sees no farther than its neighbours. */
static double
refined(const search *s, size_t i)
{
    const ss_spikes_found *found = s->found;
    const ss_spike *spike = &found->spike[i];
    double a = CENTER / (2 * M_PI * spike->f) * s->rate, at = spike->t * s->rate;
    double lo = fmax(at - FIT * a, 0), hi = fmin(at + FIT * a, (double)(s->n - 1));
    if (spike->kind == SS_SPIKE_BEND || spike->kind == SS_SPIKE_GLITCH)
        return spike->t;
    if (i > 0)
        lo = fmax(lo, found->spike[i - 1].t * s->rate + 1);
    if (i + 1 < found->n)
        hi = fmin(hi, found->spike[i + 1].t * s->rate - 1);
    return ss_breakpoint(s->x, (size_t)ceil(lo), (size_t)floor(hi), at, 0.75 * a) / s->rate;
}

static void
classify(search *s, ss_spike *spike)
{
    double clearest = 0;
    for (size_t i = 0; i < s->n_rows; i++)
        if (s->row[i].f == spike->f)
            spike->slope = slope_of(s, i, nearest(&s->row[i], spike->t, INFINITY), &clearest);
    spike->kind = kind_of(spike->slope);
    if (spike->kind != SS_SPIKE_BEND || spike->f == s->row[0].f)
        s->found->floor = fmin(s->found->floor, 20 * log10(s->threshold / clearest));
}

static void
finish(search *s)
{
    ss_spikes_found *found = s->found;
    found->threshold = s->threshold;
    for (size_t i = 0; i < found->n; i++)
        classify(s, &found->spike[i]);
    for (size_t i = 0; i < found->n; i++)
        found->spike[i].t = refined(s, i);
    qsort(found->spike, found->n, sizeof *found->spike, earlier_first);
    for (size_t i = 0; i < found->n; i++)
        found->f = fmax(found->f, found->spike[i].f);
    found->conclusive = found->floor <= -CONCLUSIVE;
}

static ss_status
check(const double *x, size_t n, double rate, const ss_spike_opts *opts, double *x_max,
      ss_error *err)
{
    *x_max = 0;
    if (n == 0 || n > SIZE_MAX / 64)
        return ss_fail(err, SS_EINVAL, "a record of %zu samples", n);
    if (!(rate >= 1e-100 && rate <= 1e100))
        return ss_fail(err, SS_EINVAL, "rate %g Hz is out of range 1e-100 ... 1e100", rate);
    if (!(opts->fmax >= 0 && opts->fmax <= HIGHEST * rate / 2 * (1 + 1e-12)))
        return ss_fail(err, SS_EINVAL, "fmax %g Hz is not at most %g of Nyquist", opts->fmax,
                       HIGHEST);
    if (!(opts->false_alarms > 0 && opts->false_alarms <= 1))
        return ss_fail(err, SS_EINVAL, "false alarms: %g is not in (0, 1]", opts->false_alarms);
    if (!(opts->precision >= 0 && opts->precision <= 1))
        return ss_fail(err, SS_EINVAL, "precision: %g is not in [0, 1]", opts->precision);
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EINVAL, "sample %zu is not a finite number", i + 1);
        *x_max = fmax(*x_max, fabs(x[i] - x[0]));
    }
    return SS_OK;
}

ss_status
ss_find_spikes(ss_spikes_found **out, const double *x, size_t n, double rate,
               const ss_spike_opts *opts, ss_error *err)
{
    search s = { .x = x, .n = n, .rate = rate, .opts = opts };
    ss_status st = check(x, n, rate, opts, &s.x_max, err);
    if (st != SS_OK)
        return st;
    s.found = calloc(1, sizeof *s.found);
    if (s.found == NULL)
        return SS_ENOMEM;
    if (s.x_max > 0)
        st = search_rows(&s, opts->fmax > 0 ? opts->fmax : HIGHEST * rate / 2, err);
    if (st == SS_OK)
        finish(&s);
    for (size_t i = 0; i < s.n_rows; i++)
        free(s.row[i].peak);
    free(s.row);
    if (st != SS_OK) {
        ss_spikes_free(s.found);
        return st;
    }
    *out = s.found;
    return SS_OK;
}

ss_spike_group
ss_spikes_within(const ss_spikes_found *found, double onset, double end, double range)
{
    ss_spike_group group = { 0, 0 };
    for (size_t i = 0; i < found->n; i++) {
        const ss_spike *spike = &found->spike[i];
        double a = CENTER / (2 * M_PI * spike->f);
        if (spike->kind == SS_SPIKE_GLITCH || spike->kind == SS_SPIKE_BEND
            || spike->level < -range || spike->t < onset - a || spike->t > end + a)
            continue;
        group.n++;
        group.inside += spike->t > onset + a && spike->t < end - a;
    }
    return group;
}

void
ss_spikes_free(ss_spikes_found *found)
{
    if (found == NULL)
        return;
    free(found->spike);
    free(found);
}
