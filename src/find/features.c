/* features.c -- the features of a column: what repeats, its spikes, the maxima of |W| above the noise, and what
 * the transitions have in common.
 *
 * All of it is found once more if a steady hum was subtracted, as it changes the period and the slips, too. */
#include <stickslip/features.h>

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/options.h"
#include "base/progress.h"
#include "find/maxima.h"
#include "find/numbers.h"
#include "map/map.h"
#include "signal/gaps.h"
#include "signal/header.h"

static const ss_features_opts defaults = { .threshold = 80. / 18, .displacement = -1, .force = -1,
                                           .threads = 1 };

#define FLAT 0.5                /* [dB] the least prominence of a maximum that shows an oscillation */

/* Parts of the work that are done after each step, roughly. */
#define TRANSFORMED 0.35
#define FLOODED 0.6
#define FITTED 0.9

/* Find the maxima of |W| that noise does not make.
 *
 * noise: the rms of a white noise that would make the median of |W| at the shortest scale: |W|^2 is then
 * exponential with mean rms^2 / rate (a^-1/2 norm).  Noise exceeds LARGER times its rms in a tenth of the places:
 * a saddle below that is made by noise.  Maxima that fall to their saddle by less than SIGMAS of the noise are
 * left out, as noise moves |W| by about its rms; so are maxima that no contour shows. */
static ss_status
find_maxima(search *s)
{
    ss_features *out = s->out;
    size_t shortest = s->map->n_scales - 1, n = 0;
    const ss_scale *last = &s->map->scale[shortest];
    int l1 = s->opts->norm == SS_NORM_L1;
    double *level = malloc((last->n + 1) * sizeof *level);
    const stream_lesson *known = s->part->known;
    ss_status st = level == NULL ? SS_ENOMEM : known != NULL ? SS_OK
        : ss_map_read(s->map, &(ss_map_part){ shortest, 0, last->n, NULL, level }, 1, NULL);
    for (size_t k = 0; st == SS_OK && known == NULL && k < last->n; k++)
        if (!ss_gaps_near(s->gap, s->n_gaps, ss_scale_b(last, k), ROW_REACH * last->a))
            level[n++] = level[k];
    double rms = known != NULL ? known->rms
        : n == 0 ? 0 : gsl_stats_select(level, 1, n, n / 2) * sqrt((l1 ? last->a : 1) / M_LN2);
    out->noise = rms * sqrt(s->rate);
    free(level);
    const maxima_kind kind = { fmin(FLAT, s->opts->threshold), INFINITY, LARGER * rms / (l1 ? sqrt(last->a) : 1) };
    if (st == SS_OK)
        st = ss_maxima_of(&s->found, &s->n_found, s->map, &kind, &s->top);
    if (st != SS_OK)
        return st;
    out->maximum = malloc((s->n_found + 1) * sizeof *out->maximum);
    if (out->maximum == NULL)
        return SS_ENOMEM;
    size_t kept = 0;
    for (size_t i = 0; i < s->n_found; i++) {
        ss_maximum m = s->found[i];
        double fall = s->top * pow(10, m.level / 20) * (1 - pow(10, -m.prominence / 20));
        if (fall * (l1 ? sqrt(ROW_CENTER / (2 * M_PI * m.f)) : 1) < SIGMAS * rms || m.level < -SPAN)
            continue;
        s->found[kept++] = m;
        if (m.prominence >= s->opts->threshold)
            out->maximum[out->n_maxima++] = m;
    }
    s->n_found = kept;
    return SS_OK;
}

static ss_status
find_repetition(search *s)
{
    const stream_lesson *known = s->part->known;
    if (known != NULL) {
        s->cycles = known->cycles;
        s->cycles.n = (size_t)((double)s->cycles.n * (double)s->n / known->length);
        s->out->number[SS_REPETITION_FREQUENCY] = known->repetition;
        return SS_OK;
    }
    ss_hum hum = SS_HUM_NONE;
    ss_status st = ss_cycles_find(s->x, s->n, s->part->period * s->rate, &s->cycles);
    if (st == SS_OK && s->cycles.hum > 0)       /* it pulls the lags */
        st = ss_hum_subtract(s->x, s->n, s->cycles.hum, s->cycles.period.value, &hum);
    s->is_cleaned |= hum == SS_HUM_SUBTRACTED;
    if (st == SS_OK && hum == SS_HUM_SUBTRACTED)
        st = ss_cycles_find(s->x, s->n, 0, &s->cycles);
    say(s->out, SS_REPETITION_FREQUENCY, s->cycles.why);
    if (st != SS_OK || s->cycles.why != NULL)
        return st;
    if (!(s->cycles.likeness >= CYCLES_LIKE))
        say(s->out, SS_REPETITION_FREQUENCY, "a cycle does not resemble the next one enough");
    else if (!(s->cycles.lasting >= CYCLES_UNLIKE))
        say(s->out, SS_REPETITION_FREQUENCY, "cycles resemble the next one, but not those some cycles later");
    else
        know(s->out, SS_REPETITION_FREQUENCY, cycle_rate(s));
    return SS_OK;
}

static ss_status
report_progress(const search *s, double part)
{
    return ss_progress_at(&s->opts->progress, s->is_second ? FITTED + (1 - FITTED) * part : part);
}

static int
report_transform(double done, void *user)
{
    const search *s = user;
    return s->found == NULL && report_progress(s, TRANSFORMED * done) != SS_OK;     /* a row is read again later */
}

/* Find the features of the samples x of a column; x loses its hum, if s->is_cleaned becomes 1.  SS_ESCALE: it is
 * too short to have any. */
static ss_status
find(search *s, double *x, size_t column, ss_error *err)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    opts.center = ROW_CENTER;
    opts.norm = s->opts->norm;
    opts.threads = s->opts->threads;
    opts.fmin = s->opts->fmin > 0 ? s->opts->fmin       /* the lowest usable frequency */
        : ROW_CENTER * sqrt(2) * s->rate / (M_PI * (double)s->n) * (1 + 1e-9);
    opts.progress = (ss_progress){ report_transform, s };
    const stream_lesson *known = s->part->known;
    if (known != NULL)              /* ground below the oscillation joins its maxima */
        opts.fmax = fmin(known->highest, known->label * 2);
    ss_range flat = { 0, s->rate };             /* what a filter has changed is no contact */
    ss_header_flat(s->signal->head, &flat);
    opts.fmin = fmax(opts.fmin, flat.from);
    ss_status st = ss_map_plan(&s->map, s->signal, column, s->n, s->rate, &opts, err);
    if (st == SS_OK && s->map->scale[s->map->n_scales - 1].f > flat.to) {
        ss_coefficients_free(s->map);
        s->map = NULL;
        opts.fmax = flat.to;
        st = ss_map_plan(&s->map, s->signal, column, s->n, s->rate, &opts, err);
    }
    if (st != SS_OK)
        return st;

    const double highest = s->map->scale[s->map->n_scales - 1].f;
    ss_gaps_bridge(x, s->n, s->rate, s->gap, s->n_gaps);        /* zeros in a gap are steep */
    for (size_t i = 0; i < s->n; i++)
        s->largest = fmax(s->largest, fabs(x[i]));
    for (size_t i = 0; i < s->n; i++)
        s->x[i] = s->largest > 0 ? x[i] / s->largest : 0;

    /* what needs no map comes before the map takes its memory */
    st = find_repetition(s);
    ss_row_source_init(s->rows, s->x, s->n, s->rate, s->gap, s->n_gaps);
    if (st == SS_OK)
        st = ss_spikes_find(&s->out->spikes, s->rows);
    if (st == SS_OK)
        st = ss_map_begin(s->map, x, NULL);
    if (st == SS_OK)
        st = find_maxima(s);
    if (st == SS_OK)
        st = report_progress(s, FLOODED);
    if (st == SS_OK)
        st = ss_transitions_find(s);
    if (st == SS_OK)
        st = report_progress(s, FITTED);
    if (st == SS_OK && s->part->period == 0)
        st = ss_slip_rate_find(s);
    if (st == SS_OK && s->part->period == 0)
        st = ss_numbers_find(s);
    if (s->part->learnt != NULL)
        *s->part->learnt = (stream_lesson){
            .label = s->is_cleaned ? 0 : s->label, .rms = s->out->noise / sqrt(s->rate), .largest = s->largest,
            .highest = highest, .length = (double)s->n, .slow = s->slow, .cycles = s->cycles,
            .repetition = s->out->number[SS_REPETITION_FREQUENCY] };
    for (size_t i = 0; i < s->n && s->is_cleaned; i++)
        x[i] = s->x[i] * s->largest;
    return st == SS_OK ? st : ss_fail(err, st, "%s", ss_strerror(st));
}

SS_OPTIONS(ss_features_opts, defaults)

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

ss_status
ss_features_of_part(ss_features **out, const ss_signal *signal, size_t column, const ss_features_opts *given,
                    const stream_part *part, ss_error *err)
{
    ss_features_opts opts;
    ss_span *gap = NULL;
    size_t n_gaps = 0;
    ss_status st = ss_options_take(&opts, sizeof opts, &defaults, given, err);
    if (st == SS_OK)
        st = check(signal, column, &opts, err);
    if (st != SS_OK)
        return st;
    const size_t n = signal->n;
    double *x = malloc((2 * n + 1) * sizeof *x);
    st = x != NULL ? ss_gaps_of(&gap, &n_gaps, signal->head, n) : SS_ENOMEM;
    if (st != SS_OK) {
        free(x);
        return ss_fail(err, st, "%s", ss_strerror(st));
    }
    memcpy(x, signal->values + column * n, n * sizeof *x);
    ss_features *found = NULL;
    for (int pass = 0, again = 1; again && st == SS_OK; pass++) {
        search s = { .signal = signal, .opts = &opts, .n = n, .rate = signal->head->rate, .part = part, .x = x + n,
                     .gap = gap, .n_gaps = n_gaps, .rows = &(row_source){ 0 }, .is_second = pass > 0,
                     .is_cleaned = pass > 0, .quantity = ss_column_quantity(&signal->head->column[column]) };
        ss_features_free(found);
        s.out = found = calloc(1, sizeof *found);
        for (int k = 0; found != NULL && k < SS_FEATURE_NUMBERS; k++)
            found->number[k] = no_number;
        if (found != NULL)
            found->number[SS_SLIPS].value = 0;
        st = found == NULL ? ss_fail_memory(err, NULL) : n > 0 ? find(&s, x, column, err) : SS_ESCALE;
        again = s.is_cleaned && !s.is_second;
        ss_coefficients_free(s.map);
        free(s.found);
    }
    if (st == SS_ESCALE && !(opts.fmin > 0)) {
        found->number[SS_SLIPS].why = found->number[SS_REPETITION_FREQUENCY].why
            = found->number[SS_TRANSITION_FREQUENCY].why = "the recording is too short";
        st = SS_OK;
    }
    if (st == SS_OK && found->spikes == NULL && (found->spikes = calloc(1, sizeof *found->spikes)) == NULL)
        st = ss_fail_memory(err, NULL);
    if (st == SS_OK && found->spikes->verdict == NULL)
        found->spikes->verdict = "none, the recording is too short";
    free(gap);
    free(x);
    if (st != SS_OK) {
        ss_features_free(found);
        return st;
    }
    found->number[SS_TRANSITIONS].value = (double)found->n;
    *out = found;
    return SS_OK;
}

ss_status
ss_features_find(ss_features **out, const ss_signal *signal, size_t column, const ss_features_opts *opts,
                 ss_error *err)
{
    return out != NULL && signal != NULL ? ss_features_of_part(out, signal, column, opts, &(stream_part){ 0 }, err)
        : SS_FAIL_NULL(err);
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
