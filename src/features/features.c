/* features.c -- the maxima of |W| above the noise, and what the transitions have in common. */
#include <stickslip/features.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "features/maxima.h"
#include "features/scale_rows.h"
#include "features/search.h"
#include "signal/gaps.h"
#include "features/slope.h"

const ss_features_opts ss_features_defaults = { .threshold = 80. / 18, .displacement = -1,
                                                .force = -1, .threads = 1 };

#define SPAN 80.0               /* [dB] of the paper's contours */
#define SIGMAS 3.0
#define JITTER 0.125            /* of a period, see slips_in_cycle */
#define MOST 0.75
#define ALONE 0.75              /* of a cycle, or of half of one that has two slips */
#define OVERTONES 0.1           /* of the power: less makes no slip in a sinusoid */
#define CONFIRMS 0.15           /* of the slip rate: a period so near to it is that of the slips */
#define SLIGHT 0.5              /* [dB] maxima less prominent show no oscillation */

/* --- maxima above the noise ------------------------------------------------------------------ */

/* The rms of a white noise that would make the median of |W| at the shortest scale: |W|^2 is then
 * exponential with mean rms^2 / rate (a^-1/2 norm). */
static ss_status
find_noise(search *s)
{
    size_t shortest = s->map.grid->n_scales - 1, n = 0;
    const ss_scale *last = &s->map.grid->scale[shortest];
    double *level = malloc((last->n + 1) * sizeof *level);
    ss_status st = level == NULL ? SS_ENOMEM
        : ss_levels_fill(&s->map, &(level_part){ shortest, 0, last->n, level }, 1);
    for (size_t k = 0; st == SS_OK && k < last->n; k++)
        if (!ss_gaps_near(s->gap, s->n_gaps, ss_scale_b(last, k), ROW_REACH * last->a))
            level[n++] = level[k];
    double scale = s->opts->norm == SS_NORM_L1 ? last->a : 1;
    s->out->noise = n == 0 ? 0
        : ss_levels_middle(level, n) * sqrt(scale * s->rate / M_LN2);
    free(level);
    return st;
}

/* Nine tenths of the noise lie below, and a saddle there is made by noise. */
static double
noise_floor(const search *s)
{
    double shortest = s->map.grid->scale[s->map.grid->n_scales - 1].a;
    return 1.5 * s->out->noise / sqrt(s->rate) / (s->opts->norm == SS_NORM_L1 ? sqrt(shortest) : 1);
}

/* Noise moves |W| by about its rms: leave out maxima whose fall to the saddle is not SIGMAS of it,
 * and those that no contour shows. */
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

/* Only maxima above the threshold are reported. */
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

/* --- values that transitions have in common -------------------------------------------------- */

/* How many transitions a second, by the mean of the times between them; a gap between two may hide
 * more. */
static ss_value
mean_rate(const search *s)
{
    const ss_features *out = s->out;
    double sum = 0, squares = 0, m = 0;
    for (size_t i = 1; i < out->n; i++) {
        double from = out->transition[i - 1].onset, interval = out->transition[i].onset - from;
        if (ss_gaps_near(s->gap, s->n_gaps, from + interval / 2, interval / 2))
            continue;
        sum += interval;
        squares += interval * interval;
        m++;
    }
    if (m < 2)
        return unknown;
    double mean = sum / m, scatter = fmax(0, squares / m - mean * mean);
    return (ss_value){ 1 / mean, sqrt(scatter / (m - 1)) / (mean * mean) };
}

/* The frequency of the cycles [Hz]. */
static ss_value
cycle_rate(const search *s)
{
    return (ss_value){ s->rate * s->cycles.frequency.value, s->rate * s->cycles.frequency.error };
}

/* Have so many transitions later a time of passed, for MOST of them, give or take JITTER of it? */
static int
recur(const search *s, size_t step, double time)
{
    const ss_features *out = s->out;
    size_t good = 0, all = 0;
    for (size_t i = 0; i + step < out->n; i++) {
        double from = out->transition[i].onset, passed = out->transition[i + step].onset - from;
        if (ss_gaps_near(s->gap, s->n_gaps, from + passed / 2, passed / 2))
            continue;
        all++;
        good += fabs(passed / time - 1) <= JITTER;
    }
    return all >= 2 && (double)good >= MOST * (double)all;
}

/* How many transitions make a cycle: that many later a period has passed.  0: they do not repeat with
 * the cycle. */
static size_t
slips_in_cycle(const search *s)
{
    double period = 1 / s->out->repetition_frequency.value, each = round(mean_rate(s).value * period);
    return each >= 1 && each < (double)s->out->n && recur(s, (size_t)each, period) ? (size_t)each : 0;
}

/* The slips that a cycle has at least: one, but two if its second half mirrors the first. */
static size_t
least_in_cycle(const search *s)
{
    return s->cycles.symmetry < -CYCLES_ALIKE ? 2 : 1;
}

/* A contact rings while it sticks: what does not ring, and stands beside what does, is an end of
 * that stick or a micro-slip. */
static void
keep_ringing(search *s)
{
    ss_features *out = s->out;
    double apart = ALONE / (out->repetition_frequency.value * (double)least_in_cycle(s));
    size_t kept = 0;
    for (size_t i = 0; i < out->n; i++) {
        const ss_transition *tr = &out->transition[i], *last = &out->transition[kept - (kept > 0)];
        size_t next = i;
        while (next < out->n && isnan(out->transition[next].from))
            next++;
        int is_beside = (kept > 0 && tr->onset - last->onset < apart)
            || (next < out->n && out->transition[next].onset - tr->onset < apart);
        if (!isnan(tr->from) || !is_beside)
            out->transition[kept++] = *tr;
    }
    out->n = kept;
}

/* May some of the events be no slips, but ends of sticks, or micro-slips? Those that are as far
 * apart as the next are alike. */
static int
is_doubtful(const search *s, size_t each)
{
    size_t least = least_in_cycle(s);
    return each % least != 0
        || (each > least && !recur(s, 1, 1 / ((double)each * s->out->repetition_frequency.value)));
}

static void
forget_loadings(ss_features *out)
{
    free(out->loading);
    out->loading = NULL;
    out->slope = out->stiffness = out->drop = out->duration = out->recurrence = out->stick
        = out->static_friction = out->friction = out->k_over_m = no_median;
}

static void
forget_slips(ss_features *out, const char *why)
{
    out->slips.value = NAN;
    out->slip_rate = unknown;
    out->why_slips = why;
}

static void
forget_ringing(ss_features *out)
{
    for (size_t i = 0; i < out->n; i++)
        out->transition[i].frequency = out->transition[i].damping_ratio = unknown;
    out->frequency_raw = out->frequency = out->damping_ratio = unknown;
    out->why_ringing = "the slips are not known";
}

/* Sharp events do not repeat with the cycle.  A cycle of dry friction has a slip all the same: one,
 * unless its second half mirrors the first, as then it has as many either way; a sinusoid need not
 * have any. */
static void
count_cycles(search *s)
{
    ss_features *out = s->out;
    int more = (double)out->n > (double)s->cycles.n;
    forget_ringing(out);
    if (s->quantity == QUANTITY_UNKNOWN && s->cycles.symmetry > -CYCLES_ALIKE
        && s->cycles.overtones > OVERTONES) {
        out->n = out->recurring = 0;
        out->slips.value = (double)s->cycles.n;
        out->slip_rate = out->repetition_frequency;
        out->why_slips = "counted as one a cycle, as nothing sharp repeats with it";
    } else
        forget_slips(out, more ? "there are more sharp events than slips that could repeat with the cycle"
            : "there are fewer sharp events than cycles");
}

/* Each slip of a force that falls ends a cycle, so its period needs no other proof. */
static void
confirm_repetition(search *s)
{
    ss_features *out = s->out;
    if (isnan(out->repetition_frequency.value)
        && fabs(out->slip_rate.value / cycle_rate(s).value - 1) <= CONFIRMS) {
        out->repetition_frequency = cycle_rate(s);
        out->why_repetition = NULL;
    }
}

/* What repeats with several falls a cycle, or with none, is a force of one sign only if someone says so. */
static int
has_offset(const search *s)
{
    return s->quantity == QUANTITY_UNKNOWN && s->opts->drop == 0
        && !isnan(s->out->repetition_frequency.value)
        && !(fabs(s->out->slip_rate.value / cycle_rate(s).value - 1) <= CONFIRMS);
}

static void
find_slip_rate(search *s)
{
    ss_features *out = s->out;
    if (out->why_slips != NULL) {
        out->slips = unknown;
        return;
    }
    out->slips.value = (double)out->n;
    out->slip_rate = mean_rate(s);
    if (out->loading != NULL) {
        if (has_offset(s)) {
            forget_loadings(out);
            out->n = 0;
            forget_slips(out, "it repeats, but not as falls of a force of one sign: it may have an offset");
            return;
        }
        confirm_repetition(s);
        if (out->n > 0 && isnan(out->drop.value))
            out->why_slips = "most falls of the force are no slips of an evenly pulled slider";
        else if (s->has_offset)
            out->why_slips = "they are rises: the zero of the force is not that of friction, which is not known";
        return;
    }
    if (isnan(out->repetition_frequency.value)) {
        if (out->n == 0)
            out->why_slips = "nothing stands out: slips that are smooth or weak are not seen";
        else
            out->why_slips = "counted by what stands out, as nothing repeats that would confirm it";
        return;
    }
    size_t each = slips_in_cycle(s);
    if (each > least_in_cycle(s) && !isnan(out->frequency.value)) {
        keep_ringing(s);
        out->slips.value = (double)out->n;
        each = slips_in_cycle(s);
    }
    if (each == 0)
        count_cycles(s);
    else if (is_doubtful(s, each))
        forget_slips(out, "of several sharp events a cycle some may be no slips of their own");
    else
        out->slip_rate = (ss_value){ (double)each * out->repetition_frequency.value,
                                     (double)each * out->repetition_frequency.error };
}

/* --- stiffness and damping ----------------------------------------------------------------- */

/* With r = hypot(omega, s): K = m r^2, c = 2 m s; their errors from those of frequency and ratio,
 * taken as independent. */
static void
find_stiffness(ss_features *out, double m, double k)
{
    if (!(m > 0))
        return;
    double raw = 2 * M_PI * out->frequency_raw.value, f = out->frequency.value;
    double z = out->damping_ratio.value, dz = out->damping_ratio.error, df = out->frequency.error;
    double q = 1 - z * z, r = 2 * M_PI * f / sqrt(q), total = m * r * r;
    out->total_stiffness_raw = (ss_value){ m * raw * raw, 2 * m * raw * raw
                                         * out->frequency_raw.error / out->frequency_raw.value };
    out->total_stiffness = (ss_value){ total, total * hypot(2 * df / f, 2 * z * dz / q) };
    out->contact_damping = (ss_value){ 2 * m * r * z,
                                       2 * m * r * hypot(z * df / f, dz / q) };
    if (k > 0 && total > k)
        out->contact_stiffness = (ss_value){ total - k, out->total_stiffness.error };
}

/* The contact's stiffness found the other way, over the fitted spans. */
static ss_status
find_slope(search *s)
{
    ss_features *out = s->out;
    const double *values = s->signal->values;
    size_t x = (size_t)s->opts->displacement, f = (size_t)s->opts->force, n = 0;
    if (s->opts->displacement < 0 || s->opts->force < 0)
        return SS_OK;
    if (out->reverses && isfinite(out->friction.value))     /* which has its own stiffness */
        return SS_OK;
    ss_window *span = malloc((out->n + 1) * sizeof *span);
    if (span == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++)
        if (!isnan(out->transition[i].from))
            span[n++] = (ss_window){ (size_t)(out->transition[i].from * s->rate + 0.5),
                                   (size_t)(out->transition[i].to * s->rate + 0.5) };
    ss_status st = ss_slope_find(values + f * s->n, values + x * s->n, s->x, span, n,
                                 &out->contact_slope);
    free(span);
    return st;
}

/* --- all of it ----------------------------------------------------------------------------- */

/* Parts of the work, roughly. */
#define TRANSFORMED 0.35
#define FLOODED 0.6
#define FITTED 0.9

static ss_status
report_progress(const search *s, double part)
{
    part = s->is_cleaned ? FITTED + (1 - FITTED) * part : part;     /* all is done again without the hum */
    return ss_progress_at(&s->opts->progress, part);
}

static int
report_transform(double done, void *user)
{
    return report_progress(user, TRANSFORMED * done) != SS_OK;
}

/* Of the map from the lowest usable frequency on; SS_ESCALE where there is none. */
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
    return ss_levels_new(&s->map, s->signal, column, &opts, err);
}

static ss_status
read_map(search *s, const double *x, ss_error *err)
{
    if (s->n_gaps == 0)
        return ss_levels_read(&s->map, x, err);
    double *bridged = malloc(s->n * sizeof *bridged);   /* zeros in a gap are steep */
    if (bridged == NULL)
        return SS_ENOMEM;
    memcpy(bridged, x, s->n * sizeof *x);
    ss_gaps_bridge(bridged, s->n, s->rate, s->gap, s->n_gaps);
    ss_status st = ss_levels_read(&s->map, bridged, err);
    free(bridged);
    return st;
}

static ss_status
find_maxima(search *s)
{
    ss_status st = find_noise(s);
    if (st == SS_OK)
        st = ss_maxima_above(&s->found, &s->n_found, &s->map, fmin(SLIGHT, s->opts->threshold),
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
    out->why_repetition = s->cycles.why;
    if (st != SS_OK || s->cycles.why != NULL)
        return st;
    if (!(s->cycles.likeness >= CYCLES_LIKE))
        out->why_repetition = "a cycle does not resemble the next one enough";
    else if (!(s->cycles.lasting >= CYCLES_LAST))
        out->why_repetition = "cycles resemble the next one, but not those some cycles later";
    else
        out->repetition_frequency = cycle_rate(s);
    return SS_OK;
}

/* What needs no map, so that its memory is not taken yet. */
static ss_status
find_before_map(search *s)
{
    ss_status st = find_repetition(s);
    if (st != SS_OK)
        return st;
    st = ss_row_source_init(s->rows, s->x, s->n, s->rate, ss_spike_defaults.precision, s->gap, s->n_gaps,
                            NULL);
    s->rows->keeps_heads = isnan(s->out->repetition_frequency.value);   /* single events may be sought */
    return st == SS_OK ? ss_spikes_in(&s->out->spikes, s->rows, &ss_spike_defaults, NULL) : st;
}

static ss_status
find_with_map(search *s)
{
    ss_status st = find_maxima(s);
    if (st != SS_OK || (st = report_progress(s, FLOODED)) != SS_OK)
        return st;
    if ((st = ss_transitions_find(s)) != SS_OK || (st = report_progress(s, FITTED)) != SS_OK)
        return st;
    find_slip_rate(s);
    find_stiffness(s->out, s->opts->mass, s->opts->stiffness);
    return find_slope(s);
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

/* What is in the samples x of a column.  *cleaned, if it is not NULL: these without the hum that was
 * subtracted from them; NULL: none was. */
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
    s.out->slips = (ss_value){ 0, NAN };
    s.out->slip_rate = s.out->repetition_frequency = s.out->frequency_raw = s.out->frequency
        = s.out->damping_ratio = s.out->total_stiffness_raw = s.out->total_stiffness
        = s.out->contact_stiffness = s.out->contact_damping = s.out->contact_slope = unknown;
    forget_loadings(s.out);
    s.out->why_ringing = "the recording is too short";
    ss_status st = s.n > 0 ? plan_map(&s, column, err) : SS_ESCALE;
    if (st == SS_OK && (st = find_before_map(&s)) != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    if (st == SS_OK)
        st = read_map(&s, x, err);
    if (st == SS_OK && (st = find_with_map(&s)) != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    ss_levels_free(&s.map);
    free(s.gap);
    free(s.found);
    if (st == SS_ESCALE && !(s.opts->fmin > 0))         /* too short for anything to be in it */
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
                 const ss_features_opts *opts, ss_error *err)
{
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    opts = opts != NULL ? opts : &ss_features_defaults;
    ss_features *found = NULL;
    double *cleaned = NULL;
    ss_status st = check(signal, column, opts, err);
    if (st == SS_OK)
        st = find(&found, signal, column, signal->values + column * signal->n, opts, &cleaned, err);
    if (cleaned != NULL) {              /* the hum was in the period and the slips, too */
        ss_features_free(found);
        st = find(&found, signal, column, cleaned, opts, NULL, err);
        free(cleaned);
    }
    if (st == SS_OK)
        *out = found;
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
