/* features.c -- the maxima of |W| above the noise, and what the transitions have in common. */
#include <stickslip/features.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/options.h"
#include "base/progress.h"
#include "find/maxima.h"
#include "find/numbers.h"
#include "find/events.h"
#include "find/search.h"
#include "signal/gaps.h"

static const ss_features_opts usual = { .size = sizeof usual, .threshold = 80. / 18, .displacement = -1, .force = -1,
                                        .threads = 1 };

void
ss_features_opts_init(ss_features_opts *opts, size_t size)
{
    ss_options_init(opts, size, &usual, sizeof usual);
}

#define SPAN 80.0               /* [dB] of the paper's contours */
#define SIGMAS 3.0              /* of the noise: maxima that rise less above the saddle are left out */
#define SLIGHT 0.5              /* [dB] the least prominence of a maximum that shows an oscillation */

/* --- maxima above the noise ------------------------------------------------------------------ */

/* The rms of a white noise that would make the median of |W| at the shortest scale: |W|^2 is then
 * exponential with mean rms^2 / rate (a^-1/2 norm). */
static ss_status
find_noise(search *s)
{
    size_t shortest = s->map->n_scales - 1, n = 0;
    const ss_scale *last = &s->map->scale[shortest];
    double *level = malloc((last->n + 1) * sizeof *level);
    ss_status st = level == NULL ? SS_ENOMEM
        : ss_map_read(s->map, &(ss_map_part){ shortest, 0, last->n, NULL, level }, 1, NULL);
    for (size_t k = 0; st == SS_OK && k < last->n; k++)
        if (!ss_gaps_near(s->gap, s->n_gaps, ss_scale_b(last, k), ROW_REACH * last->a))
            level[n++] = level[k];
    double scale = s->opts->norm == SS_NORM_L1 ? last->a : 1;
    s->out->noise = n == 0 ? 0
        : ss_levels_middle(level, n) * sqrt(scale * s->rate / M_LN2);
    free(level);
    return st;
}

/* A level that noise exceeds in a tenth of the places: a saddle below it is made by noise. */
static double
noise_floor(const search *s)
{
    double shortest = s->map->scale[s->map->n_scales - 1].a;
    return 1.5 * s->out->noise / sqrt(s->rate) / (s->opts->norm == SS_NORM_L1 ? sqrt(shortest) : 1);
}

/* Leave out maxima that fall to their saddle by less than SIGMAS of the noise, as noise moves |W| by about its
 * rms, and maxima that no contour shows. */
static void
drop_noise(search *s)
{
    double top = s->top, noise = s->out->noise / sqrt(s->rate);
    size_t kept = 0;
    for (size_t i = 0; i < s->n_found; i++) {
        ss_maximum m = s->found[i];
        double scale = s->opts->norm == SS_NORM_L1 ? sqrt(CENTER / (2 * M_PI * m.f)) : 1;
        double fall = top * pow(10, m.level / 20) * (1 - pow(10, -m.prominence / 20));
        if (fall * scale >= SIGMAS * noise && m.level >= -SPAN)
            s->found[kept++] = m;
    }
    s->n_found = kept;
}

/* Report the maxima above the threshold. */
static ss_status
keep_prominent(search *s)
{
    s->out->maximum = malloc((s->n_found + 1) * sizeof *s->out->maximum);
    if (s->out->maximum == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < s->n_found; i++)
        if (s->found[i].prominence >= s->opts->threshold)
            s->out->maximum[s->out->n_maxima++] = s->found[i];
    return SS_OK;
}

/* --- all of it ----------------------------------------------------------------------------- */

/* Parts of the work that are done after each step, roughly. */
#define TRANSFORMED 0.35
#define FLOODED 0.6
#define FITTED 0.9

static ss_status
report_progress(const search *s, double part)
{
    part = s->is_cleaned ? FITTED + (1 - FITTED) * part : part;     /* the second time, without the hum */
    return ss_progress_at(&s->opts->progress, part);
}

static int
report_transform(double done, void *user)
{
    return report_progress(user, TRANSFORMED * done) != SS_OK;
}

/* Plan the map from the lowest usable frequency on; SS_ESCALE: no frequency is usable. */
static ss_status
plan_map(search *s, size_t column, ss_error *err)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    double lowest = CENTER * sqrt(2) * s->rate / (M_PI * (double)s->n);
    opts.center = CENTER;
    opts.norm = s->opts->norm;
    opts.threads = s->opts->threads;
    opts.fmin = s->opts->fmin > 0 ? s->opts->fmin : lowest * (1 + 1e-9);
    opts.progress = (ss_progress){ report_transform, s };
    return ss_map_plan(&s->map, s->signal, column, &opts, err);
}

static ss_status
read_map(search *s, const double *x, ss_error *err)
{
    if (s->n_gaps == 0)
        return ss_map_begin(s->map, x, err);
    double *bridged = malloc(s->n * sizeof *bridged);   /* zeros in a gap are steep */
    if (bridged == NULL)
        return SS_ENOMEM;
    memcpy(bridged, x, s->n * sizeof *x);
    ss_gaps_bridge(bridged, s->n, s->rate, s->gap, s->n_gaps);
    ss_status st = ss_map_begin(s->map, bridged, err);
    free(bridged);
    return st;
}

static ss_status
find_maxima(search *s)
{
    ss_status st = find_noise(s);
    if (st == SS_OK)
        st = ss_maxima_above(&s->found, &s->n_found, s->map, fmin(SLIGHT, s->opts->threshold),
                             noise_floor(s), &s->top);
    if (st != SS_OK)
        return st;
    drop_noise(s);
    return keep_prominent(s);
}

static ss_status
find_repetition(search *s)
{
    ss_features *out = s->out;
    ss_status st = ss_cycles_find(s->x, s->n, &s->cycles);
    out->number[SS_REPETITION_FREQUENCY].why = s->cycles.why;
    if (st != SS_OK || s->cycles.why != NULL)
        return st;
    if (!(s->cycles.likeness >= CYCLES_LIKE))
        say(out, SS_REPETITION_FREQUENCY, "a cycle does not resemble the next one enough");
    else if (!(s->cycles.lasting >= CYCLES_LAST))
        say(out, SS_REPETITION_FREQUENCY, "cycles resemble the next one, but not those some cycles later");
    else
        know(out, SS_REPETITION_FREQUENCY, cycle_rate(s));
    return SS_OK;
}

/* Find what needs no map before the map takes its memory. */
static ss_status
find_before_map(search *s)
{
    ss_status st = find_repetition(s);
    if (st != SS_OK)
        return st;
    st = ss_row_source_init(s->rows, s->x, s->n, s->rate, s->gap, s->n_gaps, NULL);
    s->rows->keeps_heads =
        isnan(s->out->number[SS_REPETITION_FREQUENCY].value);   /* single events may be sought */
    return st == SS_OK ? ss_spikes_find(&s->out->spikes, s->rows, NULL) : st;
}

static ss_status
find_with_map(search *s)
{
    ss_status st = find_maxima(s);
    if (st != SS_OK || (st = report_progress(s, FLOODED)) != SS_OK)
        return st;
    if ((st = ss_transitions_find(s)) != SS_OK || (st = report_progress(s, FITTED)) != SS_OK)
        return st;
    ss_slip_rate_find(s);
    return ss_numbers_find(s);
}

static ss_status
check(const ss_signal *signal, size_t column, const ss_features_opts *opts, ss_error *err)
{
    if (column >= signal->head->n_columns)
        return ss_fail(err, SS_EINVAL, "no column %zu", column + 1);
    if (!(opts->threshold > 0 && opts->mass >= 0 && opts->stiffness >= 0 && opts->fmin >= 0
          && opts->drop >= 0 && isfinite(opts->drop + opts->threshold + opts->mass)
          && isfinite(opts->stiffness + opts->fmin)))
        return ss_fail(err, SS_EINVAL, "threshold, mass, stiffness or fmin out of range");
    if (opts->displacement >= (int)signal->head->n_columns
        || opts->force >= (int)signal->head->n_columns)
        return ss_fail(err, SS_EINVAL, "no such column of displacement or force");
    if (opts->threads < 1 || opts->threads > SS_THREADS_MAX)
        return ss_fail(err, SS_EINVAL, "threads out of range");
    for (size_t i = 0; i < signal->n; i++)
        if (!isfinite(signal->values[column * signal->n + i]))
            return ss_fail(err, SS_EDATA, "sample %zu is not a finite number", i + 1);
    return SS_OK;
}

/* A copy of x over its largest |value|; NULL: no memory. */
static double *
normalised(const double *x, size_t n, double *largest)
{
    double *copy = malloc((n + 1) * sizeof *copy);
    *largest = 0;
    if (copy == NULL)
        return NULL;
    for (size_t i = 0; i < n; i++)
        *largest = fmax(*largest, fabs(x[i]));
    for (size_t i = 0; i < n; i++)
        copy[i] = *largest > 0 ? x[i] / *largest : 0;
    return copy;
}

/* The features of a recording that is too short to have any. */
static void
forget_all(ss_features *out)
{
    for (int k = 0; k < SS_FEATURE_NUMBERS; k++)
        out->number[k] = no_number;
    out->number[SS_SLIPS].value = 0;
    say(out, SS_TRANSITION_FREQUENCY, "the recording is too short");
}

/* Find the features of the samples x of a column.  *cleaned, unless cleaned is NULL, becomes these samples
 * without their hum, if they have one. */
static ss_status
find(ss_features **out, const ss_signal *signal, size_t column, const double *x,
     const ss_features_opts *opts, double **cleaned, ss_error *err)
{
    search s = { .signal = signal, .opts = opts, .n = signal->n, .rate = signal->head->rate,
                 .rows = &(row_source){ 0 }, .is_cleaned = cleaned == NULL };
    s.x = normalised(x, s.n, &s.largest);
    s.out = calloc(1, sizeof *s.out);
    if (s.out == NULL || s.x == NULL
        || ss_gaps_of(&s.gap, &s.n_gaps, signal->head, s.n) != SS_OK) {
        free(s.x);
        free(s.out);
        return ss_fail_memory(err, NULL);
    }
    ss_gaps_bridge(s.x, s.n, s.rate, s.gap, s.n_gaps);
    s.quantity = ss_column_quantity(&signal->head->column[column]);
    forget_all(s.out);
    ss_status st = s.n > 0 ? plan_map(&s, column, err) : SS_ESCALE;
    if (st == SS_OK && (st = find_before_map(&s)) != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    if (st == SS_OK)
        st = read_map(&s, x, err);
    if (st == SS_OK && (st = find_with_map(&s)) != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    ss_coefficients_free(s.map);
    free(s.gap);
    free(s.found);
    if (st == SS_ESCALE && !(s.opts->fmin > 0))         /* it is too short to have features */
        st = SS_OK;
    if (st == SS_OK && s.out->spikes == NULL
        && (s.out->spikes = calloc(1, sizeof *s.out->spikes)) == NULL)
        st = ss_fail_memory(err, NULL);
    int hums = st == SS_OK && cleaned != NULL && s.is_cleaned;
    for (size_t i = 0; hums && i < s.n; i++)
        s.x[i] *= s.largest;
    if (hums)
        *cleaned = s.x;
    else
        free(s.x);
    if (st == SS_OK)
        *out = s.out;
    else
        ss_features_free(s.out);
    return st;
}

ss_status
ss_features_find(ss_features **out, const ss_signal *signal, size_t column,
                 const ss_features_opts *given, ss_error *err)
{
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    ss_features_opts own;
    ss_features *found = NULL;
    double *cleaned = NULL;
    ss_status st = ss_options_take(&own, sizeof own, &usual, given, err);
    const ss_features_opts *opts = &own;
    if (st == SS_OK)
        st = check(signal, column, opts, err);
    if (st == SS_OK)
        st = find(&found, signal, column, signal->values + column * signal->n, opts, &cleaned, err);
    if (cleaned != NULL) {              /* the hum has changed the period and the slips, too */
        ss_features_free(found);
        st = find(&found, signal, column, cleaned, opts, NULL, err);
        free(cleaned);
    }
    if (st == SS_OK) {
        found->number[SS_TRANSITIONS].value = (double)found->n;
        *out = found;
    }
    return st;
}

void
ss_features_free(ss_features *features)
{
    if (features == NULL)
        return;
    free(features->transition);
    free(features->loading);
    free(features->maximum);
    ss_spikes_free(features->spikes);
    free(features);
}
