/* features.c -- the transitions of a signal and what they have in common. */
#include <stickslip/features.h>

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "error.h"
#include "list.h"
#include "maxima.h"
#include "period.h"
#include "rows.h"
#include "ringdown.h"
#include "signal/gaps.h"
#include "slope.h"

const ss_features_opts ss_features_defaults = { .threshold = 80. / 18, .displacement = -1,
                                                .force = -1, .threads = 1 };

static const ss_value unknown = { NAN, NAN };
static const ss_maximum no_maximum = { NAN, NAN, NAN, NAN };

#define CENTER 6.0
#define SPAN 80.0               /* [dB] of the paper's contours */
#define SIGMAS 3.0
#define SLIGHT 0.5              /* [dB] maxima less prominent show no oscillation */
#define BAND 0.25               /* [octaves] maxima this near in frequency are of one kind */
#define STRONG 20.0             /* [dB] below the strongest: spikes that begin a transition */
#define SPIKES 60.0             /* [dB] below the strongest: spikes counted in a transition */
#define CLEAR 15.0              /* [dB] below the strongest: single events */
enum { FEW = 3 };               /* maxima of a kind: fewer do not recur */
#define RANGE 20.0              /* [dB] along the row of the oscillation: weaker swells are none */

typedef struct search {
    const ss_signal *signal;
    double *x;                  /* the column over largest, so that squares stay in range */
    double largest;
    size_t n;
    double rate;
    size_t n_gaps;
    ss_span *gap;               /* [s] from the first sample */
    const ss_features_opts *opts;
    ss_coefficients *coef;
    ss_maximum *found;          /* maxima, slight ones too */
    size_t n_found;
    int spiked;                 /* transitions end with their last spike, anywhere before the next */
    ss_features *out;
} search;

/* The rms of a white noise that would make the median of |W| at the shortest scale: |W|^2 is then
 * exponential with mean rms^2 / rate (a^-1/2 norm). */
static ss_status
find_noise(search *s)
{
    const ss_scale *last = &s->coef->scale[s->coef->n_scales - 1];
    double *level = malloc((last->n + 1) * sizeof *level);
    size_t n = 0;
    if (level == NULL)
        return SS_ENOMEM;
    for (size_t k = 0; k < last->n; k++) {
        const double *w = s->coef->w + 2 * (last->offset + k);
        if (!ss_near_gap(s->gap, s->n_gaps, ss_scale_b(last, k), ROW_REACH * last->a))
            level[n++] = hypot(w[0], w[1]);
    }
    double scale = s->opts->norm == SS_NORM_L1 ? last->a : 1;
    s->out->noise = n == 0 ? 0
        : gsl_stats_select(level, 1, n, n / 2) * sqrt(scale * s->rate / M_LN2);
    free(level);
    return SS_OK;
}

/* Nine tenths of the noise lie below, and a saddle there is made by noise. */
static double
noise_floor(const search *s)
{
    double shortest = s->coef->scale[s->coef->n_scales - 1].a;
    return 1.5 * s->out->noise / sqrt(s->rate) / (s->opts->norm == SS_NORM_L1 ? sqrt(shortest) : 1);
}

static size_t
row_of(const ss_coefficients *coef, double f)
{
    size_t best = 0;
    for (size_t i = 1; i < coef->n_scales; i++)
        if (fabs(log(coef->scale[i].f / f)) < fabs(log(coef->scale[best].f / f)))
            best = i;
    return best;
}

/* Noise moves |W| by about its rms: leave out maxima whose fall to the saddle is not SIGMAS of it,
 * and those that no contour shows. */
static void
drop_noise(search *s)
{
    double top = ss_coefficients_max(s->coef), noise = s->out->noise / sqrt(s->rate);
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

/* Those above the threshold are what is reported. */
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

static int
same_kind(const ss_maximum *m, double f)
{
    return fabs(log2(m->f / f)) <= BAND;
}

/* The frequency about which most maxima gather, the strongest of equals; 0 where fewer than FEW do.
 * An oscillation within a transition is faster than what repeats. */
static double
find_recurrent(const search *s, double prominence)
{
    double best = 0, best_level = 0, slowest = s->out->forcing_frequency.value;
    size_t most = FEW - 1;
    for (size_t i = 0; i < s->n_found; i++) {
        double level = 0;
        size_t count = 0;
        if (s->found[i].f <= slowest)           /* not a number: nothing repeats */
            continue;
        for (size_t k = 0; k < s->n_found; k++)
            if (s->found[k].prominence >= prominence && same_kind(&s->found[k], s->found[i].f)) {
                count++;
                level += s->found[k].level;
            }
        if (count > most || (count == most && most >= FEW && level > best_level)) {
            most = count;
            best = s->found[i].f;
            best_level = level;
        }
    }
    return best;
}

/* The label of a maximum in terms of the sinusoid that makes it. */
static double
true_frequency(const search *s, double label)
{
    return s->opts->norm == SS_NORM_L1 ? label
        : label * (CENTER + sqrt(CENTER * CENTER + 2)) / (2 * CENTER);
}

static int
is_event(const ss_spike *spike)
{
    return spike->kind == SS_SPIKE_JUMP || spike->kind == SS_SPIKE_KINK;
}

/* --- transitions --------------------------------------------------------------------------- */

static int
earlier(const void *a, const void *b)
{
    const ss_transition *p = a, *q = b;
    return (p->onset > q->onset) - (p->onset < q->onset);
}

static ss_status
new_transitions(ss_features *out, size_t n)
{
    free(out->transition);
    out->n = 0;
    out->transition = calloc(n + 1, sizeof *out->transition);
    if (out->transition == NULL)
        return SS_ENOMEM;
    out->n = n;
    for (size_t i = 0; i < n; i++)
        out->transition[i] = (ss_transition){ .maximum = no_maximum, .frequency = unknown,
                                              .damping_ratio = unknown, .from = NAN, .to = NAN };
    return SS_OK;
}

/* Give every swell the nearest maximum of the kind, not further than the wavelet reaches, where it
 * is above the threshold; how many have one at all. */
static size_t
match_maxima(search *s, const ss_maximum *swell, double f)
{
    ss_features *out = s->out;
    double reach = CENTER / (M_PI * f);
    size_t ringing = 0, first = 0;
    for (size_t i = 0; i < out->n; i++) {
        const ss_maximum *best = NULL;
        while (first < s->n_found && s->found[first].t < swell[i].t - reach)
            first++;
        for (size_t k = first; k < s->n_found && s->found[k].t <= swell[i].t + reach; k++) {
            const ss_maximum *m = &s->found[k];
            if (same_kind(m, f)
                && (best == NULL || fabs(m->t - swell[i].t) < fabs(best->t - swell[i].t)))
                best = m;
        }
        ringing += best != NULL;
        if (best == NULL || best->prominence < s->opts->threshold)
            continue;
        out->transition[i].maximum = *best;
        out->recurring++;
    }
    return ringing;
}

/* The median of the labels; its error has the step of the grid in it, and their scatter. */
static ss_status
read_raw(search *s)
{
    ss_features *out = s->out;
    double *f = malloc((out->recurring + 1) * sizeof *f), mean = 0, scatter = 0, step;
    size_t n = 0;
    if (f == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++)
        if (!isnan(out->transition[i].maximum.f))
            f[n++] = out->transition[i].maximum.f;
    for (size_t i = 0; i < n; i++)
        mean += f[i] / (double)n;
    for (size_t i = 0; i < n; i++)
        scatter += (f[i] - mean) * (f[i] - mean);
    out->frequency_raw.value = gsl_stats_median(f, 1, n);
    step = gsl_stats_select(f, 1, n, n / 2) * (exp2(1. / ss_morlet_defaults.voices) - 1);
    out->frequency_raw.error = sqrt(step * step / 12
                                    + (n > 1 ? scatter / (double)(n - 1) / (double)n : 0));
    free(f);
    return SS_OK;
}

/* omega and s per sample into Hz and damping ratio. */
static void
set_oscillation(const ss_value fit[2], double rate, ss_value *frequency, ss_value *ratio)
{
    double w = fit[0].value, s = fit[1].value, r = hypot(w, s);
    *frequency = (ss_value){ w * rate / (2 * M_PI), fit[0].error * rate / (2 * M_PI) };
    *ratio = (ss_value){ s / r, hypot(w * w * fit[1].error, w * s * fit[0].error) / (r * r * r) };
}

/* Move the onset to the nearest jump or kink of the spikes found, within half a period; the end to
 * the last one that comes within a period of another: what is released again sticks no longer than
 * that. */
static void
snap_to_spikes(const search *s, ss_transition *tr, double period)
{
    const ss_spikes_found *found = s->out->spikes;
    double nearest = 0.5 * period;
    size_t i = ss_list_from(found->spike, found->n, sizeof *found->spike, tr->from - nearest);
    for (; i < found->n && found->spike[i].t <= tr->end + period; i++) {
        const ss_spike *spike = &found->spike[i];
        double distance = fabs(spike->t - tr->from);
        if (!is_event(spike))
            continue;
        if (distance < nearest) {
            nearest = distance;
            tr->onset = spike->t;
        }
        if (spike->t > tr->end && spike->t <= tr->end + period)
            tr->end = spike->t;
    }
}

static ss_status
refine(search *s, const ss_maximum *swell, double f)
{
    ss_features *out = s->out;
    size_t n = out->n;
    size_t *anchor = malloc((n + 1) * sizeof *anchor);
    ss_window *window = malloc((n + 1) * sizeof *window);
    ss_window *gap = malloc((s->n_gaps + 1) * sizeof *gap);
    ss_value *each = malloc(2 * (n + 1) * sizeof *each), all[2];
    ss_status st = SS_ENOMEM;
    if (anchor != NULL && window != NULL && gap != NULL && each != NULL) {
        for (size_t i = 0; i < n; i++)
            anchor[i] = (size_t)(swell[i].t * s->rate);
        for (size_t i = 0; i < s->n_gaps; i++)
            ss_gap_rows(&s->gap[i], s->rate, &gap[i].first, &gap[i].end);
        double forcing = isnan(out->forcing_frequency.value) ? 0
            : 2 * M_PI * out->forcing_frequency.value / s->rate;
        st = ss_ringdown_fit(s->x, s->n, anchor, n, 2 * M_PI * f / s->rate, forcing,
                             s->out->noise, gap, s->n_gaps, window, all, each);
    }
    if (st == SS_OK) {
        set_oscillation(all, s->rate, &out->frequency, &out->damping_ratio);
        for (size_t i = 0; i < n; i++) {
            ss_transition *tr = &out->transition[i];
            tr->onset = tr->end = swell[i].t;
            set_oscillation(each + 2 * i, s->rate, &tr->frequency, &tr->damping_ratio);
            if (window[i].end <= window[i].first)
                continue;
            tr->onset = tr->from = (double)window[i].first / s->rate;
            tr->end = tr->to = (double)window[i].end / s->rate;
            snap_to_spikes(s, tr, 1 / f);
        }
    }
    free(anchor);
    free(window);
    free(gap);
    free(each);
    return st;
}

/* Transitions that ring: at each swell of |W| along the row of the frequency that recurs. */
static ss_status
find_ringing(search *s, double label)
{
    ss_features *out = s->out;
    ss_maximum *swell = NULL;
    size_t n = 0;
    ss_status st = ss_spikes(&swell, &n, s->coef, row_of(s->coef, label), RANGE,
                             s->opts->threshold);
    if (st == SS_OK)
        st = new_transitions(out, n);
    size_t ringing = st == SS_OK ? match_maxima(s, swell, label) : 0;
    if (ringing < FEW || 2 * ringing < out->n) {        /* that is chance */
        free(out->transition);
        out->transition = NULL;
        out->n = out->recurring = 0;
    }
    if (st == SS_OK && out->recurring > 0)
        st = read_raw(s);
    if (st == SS_OK && out->n > 0)
        st = refine(s, swell, true_frequency(s, label));
    if (out->n > 0)
        qsort(out->transition, out->n, sizeof *out->transition, earlier);
    free(swell);
    return st;
}

/* Transitions that do not ring: each strong spike begins one, and the weaker ones up to the next
 * strong one belong to it.  Strong ones nearer than an eighth of what repeats are one. */
static ss_status
find_spiked(search *s)
{
    ss_features *out = s->out;
    const ss_spikes_found *found = out->spikes;
    double apart = isnan(out->forcing_frequency.value) ? 0 : 0.125 / out->forcing_frequency.value;
    ss_status st = new_transitions(out, found->n);
    if (st != SS_OK)
        return st;
    out->n = 0;
    s->spiked = 1;
    for (size_t i = 0; i < found->n; i++) {
        const ss_spike *spike = &found->spike[i];
        ss_transition *last = out->n > 0 ? &out->transition[out->n - 1] : NULL;
        if (!is_event(spike))
            continue;
        if (spike->level >= -STRONG && (last == NULL || spike->t > last->onset + apart)) {
            last = &out->transition[out->n++];
            last->onset = spike->t;
        }
        if (last != NULL)
            last->end = spike->t;
    }
    return SS_OK;
}

/* Single events in a record that is quiet else. */
static ss_status
find_single(search *s)
{
    ss_bursts *found = NULL;
    ss_status st = ss_find_bursts(&found, s->x, s->n, s->rate, CLEAR, s->gap, s->n_gaps, NULL);
    if (st == SS_OK && (st = new_transitions(s->out, found->n)) == SS_OK)
        for (size_t i = 0; i < found->n; i++)
            s->out->transition[i].onset = s->out->transition[i].end = found->burst[i].t;
    ss_bursts_free(found);
    return st;
}

static ss_status
find_dropped(search *s)
{
    ss_drop *drop = NULL;
    size_t n = 0;
    ss_status st = ss_find_drops(&drop, &n, s->x, s->n, s->rate, s->opts->drop / s->largest,
                                 s->gap, s->n_gaps, NULL);
    if (st == SS_OK && (st = new_transitions(s->out, n)) == SS_OK)
        for (size_t i = 0; i < n; i++) {
            s->out->transition[i].onset = drop[i].t;
            s->out->transition[i].end = drop[i].end;
        }
    free(drop);
    return st;
}

/* How far gaps reach for spikes as blunt as those found. */
static double
spike_reach(const ss_spikes_found *found)
{
    double f = INFINITY;
    for (size_t i = 0; i < found->n; i++)
        f = is_event(&found->spike[i]) ? fmin(f, found->spike[i].f) : f;
    return 2 * ROW_REACH * ROW_CENTER / (2 * M_PI * f);
}

/* Spikes that begin and end a transition may be half a period before and a period behind what was
 * fitted. */
static void
count_spikes(const search *s)
{
    ss_features *out = s->out;
    double period = isnan(out->frequency.value) ? 0 : 1 / out->frequency.value;
    double reach = spike_reach(out->spikes);
    for (size_t i = 0; i < out->n; i++) {
        ss_transition *tr = &out->transition[i];
        double next = i + 1 < out->n ? tr[1].onset : (double)s->n / s->rate;
        double from = tr->onset - period / 2, to = s->spiked ? next : tr->end + period;
        tr->spikes = ss_spikes_within(out->spikes, tr->onset, tr->end, SPIKES).n;
        tr->gap = ss_near_gap(s->gap, s->n_gaps, 0.5 * (from + to), 0.5 * (to - from) + reach);
    }
}

/* From the times between the transitions; where the signal repeats itself, from how many of them
 * there are in a repetition, which leaves out none that is too weak to be seen.  Drops are counted as
 * they are: those below the height asked for are none.  Where a gap lies between two of them, there
 * may be more. */
static void
find_slip_rate(search *s)
{
    ss_features *out = s->out;
    size_t n = out->n;
    double sum = 0, squares = 0, duration = (double)s->n / s->rate, m = 0;
    out->slips = n;
    for (size_t i = 0; i < s->n_gaps; i++)
        duration -= s->gap[i].to - s->gap[i].from;
    for (size_t i = 1; i < n; i++) {
        double from = out->transition[i - 1].onset, interval = out->transition[i].onset - from;
        if (ss_near_gap(s->gap, s->n_gaps, from + interval / 2, interval / 2))
            continue;
        sum += interval;
        squares += interval * interval;
        m++;
    }
    if (m < 2)
        return;
    double mean = sum / m, scatter = fmax(0, squares / m - mean * mean);
    double each = round((double)n / duration / out->forcing_frequency.value);
    out->slip_rate = (ss_value){ 1 / mean, sqrt(scatter / (m - 1)) / (mean * mean) };
    if (!(s->opts->drop > 0) && each >= 1 && fabs(1 / mean / out->forcing_frequency.value - each) < 0.25)
        out->slip_rate = (ss_value){ each * out->forcing_frequency.value,
                                     each * out->forcing_frequency.error };
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

/* The other route to the contact's stiffness, over what was fitted. */
static ss_status
find_slope(search *s)
{
    ss_features *out = s->out;
    const double *values = s->signal->values;
    size_t x = (size_t)s->opts->displacement, f = (size_t)s->opts->force, n = 0;
    if (s->opts->displacement < 0 || s->opts->force < 0)
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
come_to(const search *s, double part)
{
    return s->opts->progress != NULL && s->opts->progress(part, s->opts->user) != 0 ? SS_STOP : SS_OK;
}

static int
transformed(double done, void *user)
{
    return come_to(user, TRANSFORMED * done) != SS_OK;
}

/* From the lowest usable frequency on; SS_ESCALE where there is none. */
static ss_status
transform(search *s, size_t column, ss_error *err)
{
    ss_morlet_opts opts = ss_morlet_defaults;
    double lowest = CENTER * sqrt(2) * s->rate / (M_PI * (double)s->n);
    opts.center = CENTER;
    opts.norm = s->opts->norm;
    opts.threads = s->opts->threads;
    opts.fmin = s->opts->fmin > 0 ? s->opts->fmin : lowest * (1 + 1e-9);
    opts.progress = transformed;
    opts.user = s;
    if (s->n_gaps == 0)
        return ss_transform(&s->coef, s->signal, column, &opts, err);
    ss_signal *bridged = NULL;          /* zeros in a gap are steep */
    ss_status st = ss_signal_select(&bridged, s->signal, &column, 1, 0, s->n);
    if (st != SS_OK)
        return ss_fail(err, st, "%s", ss_strerror(st));
    ss_gaps_bridge(bridged->values, s->n, s->rate, s->gap, s->n_gaps);
    st = ss_transform(&s->coef, bridged, 0, &opts, err);
    ss_signal_free(bridged);
    return st;
}

static ss_status
find_maxima(search *s)
{
    ss_status st = find_noise(s);
    if (st == SS_OK)
        st = ss_maxima_above(&s->found, &s->n_found, s->coef,
                             fmin(SLIGHT, s->opts->threshold), noise_floor(s));
    if (st != SS_OK)
        return st;
    drop_noise(s);
    return keep_prominent(s);
}

/* By what rings, prominently or slightly; else by spikes where the signal repeats itself, which tells
 * how far apart those that begin transitions are; else as single events, each of which may have many
 * spikes. */
static ss_status
find_transitions(search *s)
{
    ss_features *out = s->out;
    ss_status st = SS_OK;
    for (int slight = 0; slight < 2 && st == SS_OK && out->n == 0; slight++) {
        double f = find_recurrent(s, slight ? 0 : s->opts->threshold);
        if (f > 0)
            st = find_ringing(s, f);
    }
    if (st == SS_OK && out->n == 0 && out->spikes->conclusive && !isnan(out->forcing_frequency.value))
        st = find_spiked(s);
    if (st == SS_OK && out->n == 0)
        st = find_single(s);
    if (st == SS_OK && out->n == 0 && out->spikes->conclusive)
        st = find_spiked(s);            /* too short for the others */
    return st;
}

static ss_status
find_all(search *s)
{
    ss_value period;
    ss_status st = ss_period_find(s->x, s->n, &period);
    if (st != SS_OK)
        return st;
    if (!isnan(period.value))
        s->out->forcing_frequency = (ss_value){ s->rate / period.value, s->rate * period.error
                                                / (period.value * period.value) };
    ss_spike_opts sharp = ss_spike_defaults;
    sharp.gap = s->gap;
    sharp.n_gaps = s->n_gaps;
    if ((st = ss_find_spikes(&s->out->spikes, s->x, s->n, s->rate, &sharp, NULL)) != SS_OK
        || (st = find_maxima(s)) != SS_OK || (st = come_to(s, FLOODED)) != SS_OK)
        return st;
    st = s->opts->drop > 0 ? find_dropped(s) : find_transitions(s);
    if (st != SS_OK || (st = come_to(s, FITTED)) != SS_OK)
        return st;
    count_spikes(s);
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

ss_status
ss_features_find(ss_features **out, const ss_signal *signal, size_t column,
                 const ss_features_opts *opts, ss_error *err)
{
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    search s = { .signal = signal, .opts = opts != NULL ? opts : &ss_features_defaults };
    ss_status st = check(signal, column, s.opts, err);
    if (st != SS_OK)
        return st;
    s.n = signal->n;
    s.rate = signal->head->rate;
    s.x = normalised(signal->values + column * s.n, s.n, &s.largest);
    s.out = calloc(1, sizeof *s.out);
    if (s.out == NULL || s.x == NULL
        || ss_gaps_of(&s.gap, &s.n_gaps, signal->head, s.n) != SS_OK) {
        free(s.x);
        free(s.out);
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    }
    ss_gaps_bridge(s.x, s.n, s.rate, s.gap, s.n_gaps);
    s.out->slip_rate = s.out->forcing_frequency = s.out->frequency_raw = s.out->frequency
        = s.out->damping_ratio = s.out->total_stiffness_raw = s.out->total_stiffness
        = s.out->contact_stiffness = s.out->contact_damping = s.out->contact_slope = unknown;
    st = s.n > 0 ? transform(&s, column, err) : SS_ESCALE;
    if (st == SS_OK && (st = find_all(&s)) != SS_OK)
        ss_fail(err, st, "%s", ss_strerror(st));
    ss_coefficients_free(s.coef);
    free(s.x);
    free(s.gap);
    free(s.found);
    if (st == SS_ESCALE && !(s.opts->fmin > 0))         /* too short for anything to be in it */
        st = SS_OK;
    if (st == SS_OK && s.out->spikes == NULL
        && (s.out->spikes = calloc(1, sizeof *s.out->spikes)) == NULL)
        st = ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    if (st == SS_OK)
        *out = s.out;
    else
        ss_features_free(s.out);
    return st;
}

void
ss_features_free(ss_features *features)
{
    if (features == NULL)
        return;
    free(features->transition);
    free(features->maximum);
    ss_spikes_free(features->spikes);
    free(features);
}
