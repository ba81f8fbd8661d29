/* scale_rows.c -- |W| along single scales.
 *
 * Noise: the rms of |W| in a row, from the median, which events do not move: |W|^2 of Gaussian
 * noise is exponential, its median ln 2 of its mean.  Not less than what rounding of the samples
 * makes: of a converter's step, or of the last digit that numbers are trusted to have.
 *
 * Threshold: |W| of Gaussian noise crosses the level u (in units of its rms) upwards u exp(-u^2) /
 * (a sqrt(2 pi)) times a second (Rice 1945, with the spectral width 1 / (sqrt(2) a) of the Morlet
 * wavelet); summed over the rows that is to be FALSE_ALARMS.  Neighbouring rows are not
 * independent, so there are fewer.
 *
 * The record is continued oddly about its end points, so that it goes on with the same value and
 * slope; what is nearer to an end than sqrt(2) a is not used all the same. Nor is what lies within
 * the reach of a gap, where something of another value and slope may stand. */
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "find/judgement.h"
#include "find/scale_rows.h"
#include "map/map.h"
#include "signal/gaps.h"
#include <stickslip/morlet.h>

#define ACCURACY 1e-10          /* of W: 200 dB */
#define TOGETHER 6.0            /* octaves above an octave that share its spectra */
#define MARGIN 0.25             /* part of the record: octaves with longer margins share nothing */

/* Does sample i stand in a gap? */
static int
missing(const row_source *source, size_t i)
{
    return source->n_gaps > 0
        && ss_gaps_near(source->gap, source->n_gaps, ((double)i + 0.5) / source->rate, 0);
}

/* The step of the converter from which the samples come; 0: none is seen.  It is the smallest change, if
 * nearly all others are multiples of it.  So a signal of few levels that changes seldom counts as one of
 * steps. */
static double
converter_step(const row_source *source)
{
    const double *x = source->x;
    size_t n = source->n, changes = 0, fit = 0;
    double step = INFINITY, lo = INFINITY, hi = -INFINITY;
    for (size_t i = 1; i < n; i++)
        if (x[i] != x[i - 1] && !missing(source, i) && !missing(source, i - 1))
            step = fmin(step, fabs(x[i] - x[i - 1]));
    for (size_t i = 1; i < n; i++) {
        if (missing(source, i) || missing(source, i - 1))
            continue;
        double steps = fabs(x[i] - x[i - 1]) / step;
        lo = fmin(lo, fmin(x[i], x[i - 1]));
        hi = fmax(hi, fmax(x[i], x[i - 1]));
        changes += steps > 0;
        fit += steps > 0 && fabs(steps - round(steps)) < 0.1;   /* a fifth of them fits by chance */
        if (changes - fit > n / 10)
            return 0;
    }
    int seldom = changes < n / 20, few = hi - lo < 64 * step;
    if (!(hi - lo >= 8 * step) || (seldom && few) || changes - fit > changes / 10)
        return 0;
    return step;
}

void
ss_row_source_init(row_source *source, const double *x, size_t n, double rate, const ss_span *gap, size_t n_gaps)
{
    double lo = INFINITY, hi = -INFINITY;
    *source = (row_source){ .x = x, .n = n, .rate = rate, .gap = gap, .n_gaps = n_gaps };
    for (size_t i = 0; i < n; i++) {
        if (missing(source, i))
            continue;
        lo = fmin(lo, x[i]);
        hi = fmax(hi, x[i]);
    }
    source->constant = !(hi > lo);
    if (hi > lo)
        source->rounding = fmax(PRECISION * (hi - lo), converter_step(source) / sqrt(12))
            / sqrt(rate);
}

/* The record less its first value, with margin samples more at either end: an odd continuation.  Beyond the
 * far end of a record that is too short for this, its last value continues. */
static double *
continued(const double *x, size_t n, size_t margin)
{
    double *y = malloc((n + 2 * margin) * sizeof *y);
    if (y == NULL)
        return NULL;
    double start = x[0], end = x[n - 1] - start;
    for (size_t i = 0; i < n; i++)
        y[margin + i] = x[i] - start;
    for (size_t i = 1; i <= margin; i++) {
        size_t k = i < n ? i : n - 1;
        y[margin - i] = start - x[k];
        y[margin + n - 1 + i] = 2 * end - (x[n - 1 - k] - start);
    }
    return y;
}

/* The rms of |W| in the n levels, of which one comes every step from t on, and which change places.  It is
 * found from the median of the levels that are farther than half a wavelet's reach from all spikes found so far and
 * out of the reach of gaps, or of all levels if there are none. */
static double
noise_of(const row_source *source, const ss_spikes *loud, double *level, size_t n, double t,
         double step, double a)
{
    double quiet = ROW_REACH / 2 * a;
    size_t left = 0, i = 0;
    int all = source->n_gaps == 0 && (loud == NULL || loud->n == 0);
    for (size_t k = 0; k < n && !all; k++) {
        double at = t + (double)k * step;
        while (loud != NULL && i < loud->n && loud->spike[i].t + quiet < at)
            i++;
        if ((loud != NULL && i < loud->n && loud->spike[i].t - quiet <= at)
            || (source->n_gaps > 0 && ss_gaps_near(source->gap, source->n_gaps, at, ROW_REACH * a)))
            continue;
        double swap = level[left];
        level[left++] = level[k];
        level[k] = swap;
    }
    if (all || left == 0)
        left = n;
    return hypot(gsl_stats_select(level, 1, left, left / 2) / sqrt(M_LN2), source->rounding);
}

/* Find the peaks of a row and its noise.  Levels before t = 0 and behind the record are not the record's own. */
static ss_status
fill_row(scale_row *r, row_source *source, const ss_spikes *loud, size_t index)
{
    const ss_scale *scale = &source->rows->scale[index];
    const double margin = (double)source->margin / source->rate, step = scale->b_num / scale->b_den;
    const double from = sqrt(2) * scale->a, to = (double)(source->n - 1) / source->rate - from;
    const size_t first = (size_t)ceil((margin + from) / step);  /* of those outside the cone of influence */
    const size_t n = (size_t)fmax(floor((margin + to) / step) + 1 - (double)first, 0);
    double *more = malloc((n + 2) * sizeof *more), *level = more + 1;   /* more: one on either side */
    r->peak = malloc((n / 2 + 1) * sizeof *r->peak);
    ss_status st = more == NULL || r->peak == NULL ? SS_ENOMEM
        : ss_map_read(source->rows, &(ss_map_part){ index, first - 1, n + 2, NULL, more }, 1, NULL);
    for (size_t k = 0; st == SS_OK && k < n; k++) {
        if (!((level[k] > more[k]) & (level[k] >= level[k + 1])))       /* one branch, which is seldom taken */
            continue;
        double t = ss_scale_b(scale, first + k) - margin;
        if (ss_gaps_near(source->gap, source->n_gaps, t, ROW_REACH * r->a))
            continue;
        /* the vertex of the parabola through it and its neighbours */
        const double bend = more[k] - 2 * level[k] + level[k + 1], lean = more[k] - level[k + 1];
        const double off = bend < 0 ? 0.5 * lean / bend : 0;
        r->peak[r->n] = (peak){ t + off * step, level[k] - 0.25 * lean * off };
        r->top = fmax(r->top, r->peak[r->n++].level);
    }
    if (st == SS_OK)
        r->rms = noise_of(source, loud, level, n, ss_scale_b(scale, first) - margin, step, r->a);
    if (st != SS_OK)
        free(r->peak);
    free(more);
    return st;
}

/* Prepare the rows of an octave and of those above it. */
static ss_status
open_octaves(row_source *source, double octave)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    double longest = log2(MARGIN * (double)source->n / (ROW_REACH * source->rate));
    ss_coefficients_free(source->rows);
    source->rows = NULL;
    source->octave = octave;
    source->end = octave + fmax(1, fmin(TOGETHER, floor(longest - octave)));
    opts.center = ROW_CENTER, opts.voices = ROW_VOICES, opts.force = 1, opts.accuracy = ACCURACY;
    opts.octaves = 1;
    opts.m0 = octave, opts.m1 = source->end - 1. / ROW_VOICES;
    source->margin = (size_t)ceil(ROW_REACH * exp2(opts.m1) * source->rate);
    double *x = continued(source->x, source->n, source->margin);
    ss_status st = x == NULL ? SS_ENOMEM
        : ss_map_of_samples(&source->rows, x, source->n + 2 * source->margin, source->rate, &opts, NULL);
    free(x);
    return st;
}

ss_status
ss_row_new(scale_row *r, row_source *source, double f, const ss_spikes *loud)
{
    double j = round(ROW_VOICES * log2(ROW_CENTER / (2 * M_PI * f))), octave = floor(j / ROW_VOICES);
    ss_status st = SS_OK;
    if (source->rows == NULL || octave < source->octave || octave >= source->end)
        st = open_octaves(source, octave);
    if (st != SS_OK)
        return st;
    size_t index = (size_t)(source->end * ROW_VOICES - 1 - j);          /* long to short */
    *r = (scale_row){ .a = source->rows->scale[index].a, .f = source->rows->scale[index].f };
    return fill_row(r, source, loud, index);
}

void
ss_row_source_free(row_source *source)
{
    ss_coefficients_free(source->rows);
    source->rows = NULL;
}

double
ss_row_threshold(double length, double shortest, size_t rows)
{
    double count = 0, u = 4;
    for (size_t i = 0; i < rows; i++)
        count += length / (shortest * exp2((double)i / ROW_VOICES) * sqrt(2 * M_PI));
    for (int pass = 0; pass < 30; pass++)
        u = sqrt(fmax(log(u * count / FALSE_ALARMS), 1));
    return u;
}
