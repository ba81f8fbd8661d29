/* ringing.c -- find transitions by their oscillation, and the oscillation behind known transitions. */
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "base/sort.h"
#include "find/maxima.h"
#include "find/scale_rows.h"
#include "find/search.h"

#define BAND 0.25               /* [octaves] the largest distance of maxima of one kind */
#define RANGE 20.0              /* [dB] range of the swells in the row of the oscillation */

static size_t
row_of(const ss_coefficients *coef, double f)
{
    size_t best = 0;
    for (size_t i = 1; i < coef->n_scales; i++)
        if (fabs(log(coef->scale[i].f / f)) < fabs(log(coef->scale[best].f / f)))
            best = i;
    return best;
}

static int
same_kind(const ss_maximum *m, double f)
{
    return fabs(log2(m->f / f)) <= BAND;
}

typedef struct gathered {
    double octave, level;       /* of a maximum */
} gathered;

/* The frequency about which most maxima gather, the strongest of equals; 0: fewer than FEW gather.  An
 * oscillation within a transition is faster than the cycles. */
static ss_status
find_recurrent(const search *s, double prominence, double *f)
{
    double best_level = 0, slowest = s->out->number[SS_REPETITION_FREQUENCY].value;
    size_t most = FEW - 1, n = 0;
    gathered *list = malloc((s->n_found + 1) * sizeof *list);
    *f = 0;
    if (list == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < s->n_found; i++)
        if (s->found[i].prominence >= prominence)
            list[n++] = (gathered){ log2(s->found[i].f), s->found[i].level };
    if (n > 1)
        qsort(list, n, sizeof *list, ss_ascending);
    for (size_t i = 0; i < s->n_found; i++) {
        double octave = log2(s->found[i].f), level = 0;
        size_t from = ss_list_from(list, n, sizeof *list, octave - BAND);
        size_t end = ss_list_from(list, n, sizeof *list, octave + BAND);
        if (end - from < FEW || end - from < most || s->found[i].f <= slowest)
            continue;           /* it is NaN if nothing repeats */
        for (size_t k = from; k < end; k++)
            level += list[k].level;
        if (end - from > most || level > best_level) {
            most = end - from;
            *f = s->found[i].f;
            best_level = level;
        }
    }
    free(list);
    return SS_OK;
}

/* The label of a maximum in terms of the sinusoid that makes it. */
static double
true_frequency(const search *s, double label)
{
    return s->opts->norm == SS_NORM_L1 ? label
        : label * (CENTER + sqrt(CENTER * CENTER + 2)) / (2 * CENTER);
}

/* Give every swell the nearest maximum of the kind that is above the threshold and within reach of the
 * wavelet, if FEW or more are.  Returns the number of swells with a maximum at all. */
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
    for (size_t i = 0; out->recurring < FEW && i < out->n; i++)
        out->transition[i].maximum = no_maximum;
    out->recurring = out->recurring < FEW ? 0 : out->recurring;
    return ringing;
}

/* The median of the labels.  Its error contains the step of the grid and their scatter. */
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
    out->number[SS_TRANSITION_FREQUENCY_RAW].value = gsl_stats_median(f, 1, n);
    step = gsl_stats_select(f, 1, n, n / 2) * (exp2(1. / ss_morlet_defaults.voices) - 1);
    out->number[SS_TRANSITION_FREQUENCY_RAW].error = sqrt(step * step / 12
                                    + (n > 1 ? scatter / (double)(n - 1) / (double)n : 0));
    free(f);
    return SS_OK;
}

/* Move the onset, which the fit or the swell gave, to the nearest jump or kink within half a period.  Move
 * the end to the last jump or kink that follows another within a period: the mass does not stick longer
 * between them. */
static void
snap_to_spikes(const search *s, ss_transition *tr, double period)
{
    const ss_spikes *found = s->out->spikes;
    double nearest = 0.5 * period;
    double from = tr->onset;
    size_t i = ss_list_from(found->spike, found->n, sizeof *found->spike, from - nearest);
    for (; i < found->n && found->spike[i].t <= tr->end + period; i++) {
        const ss_spike *spike = &found->spike[i];
        double distance = fabs(spike->t - from);
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

/* Refine a transition of which only a swell is known: fit its oscillation, then move its ends from the
 * fit, or from the swell, to the jumps and kinks beside them. */
static ss_status
refine(search *s, const ss_maximum *swell, double f)
{
    ss_features *out = s->out;
    size_t *anchor = malloc((out->n + 1) * sizeof *anchor);
    if (anchor == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++)
        anchor[i] = (size_t)(swell[i].t * s->rate);
    ss_status st = ss_oscillation_fit(s, anchor, f, 0);
    free(anchor);
    for (size_t i = 0; st == SS_OK && i < out->n; i++) {
        ss_transition *tr = &out->transition[i];
        tr->onset = isnan(tr->from) ? swell[i].t : tr->from;
        tr->end = isnan(tr->to) ? swell[i].t : tr->to;
        snap_to_spikes(s, tr, 1 / f);
    }
    return st;
}

static void
forget_transitions(ss_features *out)
{
    free(out->transition);
    out->transition = NULL;
    out->n = out->recurring = 0;
}

/* Are these swells transitions?  Noise in a band swells, too, but slowly, while a slip makes its ringing
 * begin at once.  So swells of a signal that does not repeat itself are transitions only if half of them
 * begin with a jump or kink. */
static int
begin_sharply(const search *s, const ss_maximum *swell, double f)
{
    const ss_spikes *found = s->out->spikes;
    size_t sharp = 0, n = s->out->n;
    for (size_t i = 0; i < n; i++) {
        double t = swell[i].t - 1 / f;          /* a swell is highest about a period behind its onset */
        size_t k = ss_list_from(found->spike, found->n, sizeof *found->spike, t - 1.5 / f);
        while (k < found->n && found->spike[k].t <= t + 1.5 / f && !is_event(&found->spike[k]))
            k++;
        sharp += k < found->n && found->spike[k].t <= t + 1.5 / f;
    }
    return 2 * sharp >= n;
}

ss_status
ss_ringing_find(search *s, double prominence)
{
    ss_features *out = s->out;
    ss_maximum *swell = NULL;
    size_t n = 0;
    double label;
    ss_status st = find_recurrent(s, prominence, &label);
    say(out, SS_TRANSITION_FREQUENCY, "no oscillation swells again and again");
    if (st != SS_OK || label == 0)
        return st;
    st = ss_maxima_of_row(&swell, &n, s->map, row_of(s->map, label), s->top, RANGE,
                          s->opts->threshold);
    if (st == SS_OK)
        st = ss_transitions_new(out, n);
    size_t ringing = st == SS_OK ? match_maxima(s, swell, label) : 0;
    int is_none = ringing < FEW || 2 * ringing < out->n;
    if (!is_none && isnan(out->number[SS_REPETITION_FREQUENCY].value) && !begin_sharply(s, swell, label)) {
        say(out, SS_TRANSITION_FREQUENCY,
            "what swells again and again neither repeats with a cycle nor begins sharply");
        is_none = 1;
    }
    if (is_none)
        forget_transitions(out);
    if (st == SS_OK && out->recurring > 0)
        st = read_raw(s);
    if (st == SS_OK && out->n > 0)
        st = refine(s, swell, true_frequency(s, label));
    if (out->n > 0)
        qsort(out->transition, out->n, sizeof *out->transition, ss_ascending);
    free(swell);
    return st;
}

/* --- ringing behind transitions that are known ----------------------------------------------- */

#define SETTLED 1.0             /* periods behind the onset that are left out: they show its own jump */
#define LOOKED 5.0              /* periods behind the onset up to which the band is sought */
#define LEFT 2.0                /* periods before the end that are left out */
/* The band is sought behind so many transitions in a row, at so many places of the record. */
enum { STRETCH = 64, STRETCHES = 16 };

/* The span behind a transition in which it may ring [s]: behind its last spike, if it is known by spikes. */
static void
span_behind(const search *s, size_t i, double period, double *from, double *to, double *last)
{
    const ss_transition *tr = &s->out->transition[i];
    double next = i + 1 < s->out->n ? tr[1].onset : (double)s->n / s->rate;
    *from = s->spiked ? tr->end + SETTLED / 2 * period : tr->onset + SETTLED * period;
    *to = s->spiked ? tr->end + LOOKED / 2 * period : tr->onset + LOOKED * period;
    *last = s->spiked ? next - LEFT / 4 * period : tr->end - LEFT * period;
}

static size_t
stretch_first(const search *s, size_t stretch)
{
    return s->out->n * stretch / STRETCHES;
}

static size_t
stretch_end(const search *s, size_t stretch)
{
    size_t next = stretch_first(s, stretch + 1), end = stretch_first(s, stretch) + STRETCH;
    return end < next ? end : next;
}

static size_t
point_at(const ss_scale *scale, double t)
{
    return (size_t)ceil(t / (scale->b_num / scale->b_den));
}

/* The levels of a scale at the stretches. */
static ss_status
fill_behind(const search *s, size_t index, double *level)
{
    const ss_scale *scale = &s->map->scale[index];
    ss_map_part part[STRETCHES];
    size_t n = 0, end = 0;
    double from, to, ignored;
    for (size_t i = 0; i < STRETCHES; i++) {
        if (stretch_first(s, i) == stretch_end(s, i))
            continue;
        span_behind(s, stretch_end(s, i) - 1, 1 / scale->f, &from, &to, &ignored);
        size_t behind = (size_t)fmin(point_at(scale, to) + 1., (double)scale->n);
        span_behind(s, stretch_first(s, i), 1 / scale->f, &from, &to, &ignored);
        size_t first = point_at(scale, from) > end ? point_at(scale, from) : end;
        if (first >= behind)
            continue;
        part[n++] = (ss_map_part){ index, first, behind - first, NULL, level + first };
        end = behind;
    }
    return ss_map_read(s->map, part, n, NULL);
}

/* The mean square of |W| behind a transition; 0: the transition does not last so long. */
static double
power_of(const search *s, size_t transition, const ss_scale *scale, const double *level)
{
    double from, to, last, sum = 0;
    span_behind(s, transition, 1 / scale->f, &from, &to, &last);
    size_t first = point_at(scale, from), k = first;
    if (to > last || ss_gaps_near(s->gap, s->n_gaps, 0.5 * (from + to),
                                  0.5 * (to - from) + ROW_REACH * scale->a))
        return 0;
    for (; k < scale->n && ss_scale_b(scale, k) <= to; k++)
        sum += level[k] * level[k];
    return k > first ? sum / (double)(k - first) : 0;
}

/* The mean square of |W| over the root of the scale, which is that of the amplitude, over LOOKED less
 * SETTLED periods behind the onsets; 0: fewer than half of the transitions last so long. */
static double
power_behind(const search *s, const ss_scale *scale, const double *level)
{
    double sum = 0;
    size_t used = 0, all = 0;
    for (size_t stretch = 0; stretch < STRETCHES; stretch++)
        for (size_t i = stretch_first(s, stretch); i < stretch_end(s, stretch); i++) {
            double one = power_of(s, i, scale, level);
            sum += one;
            used += one > 0;
            all++;
        }
    return 2 * used > all ? sum / (double)used / (s->opts->norm == SS_NORM_L1 ? 1 : scale->a) : 0;
}

/* Scales that are so many apart differ by a quarter of an octave.  The band of a sinusoid is wider: the
 * nearest of these scales has at least three quarters of its power. */
enum { EVERY = 4 };
#define SEEN 0.7

/* Is the power above 0, and no less than at the scales EVERY before and behind, if there are any? */
static int
is_peak(const double *power, size_t n, size_t i)
{
    return power[i] > 0 && !(i >= EVERY && power[i - EVERY] > power[i])
        && !(i + EVERY < n && power[i + EVERY] > power[i]);
}

/* Is scale i beside a peak of at least this power? */
static int
is_beside(const double *power, size_t n, size_t i, double least)
{
    size_t before = i - i % EVERY, next = before + EVERY;
    return (is_peak(power, n, before) && power[before] >= least)
        || (next < n && is_peak(power, n, next) && power[next] >= least);
}

/* Find the power behind the transitions at n scales: at some of them, and at those beside peaks that may be
 * the strongest band.  (A peak at the end of the known scales is none.)  0: it is not known. */
static ss_status
powers_behind(const search *s, double *power, size_t n)
{
    const ss_scale *scale = s->map->scale;
    double *level = malloc((scale[n - 1].n + 1) * sizeof *level), most = 0;
    ss_status st = level != NULL ? SS_OK : SS_ENOMEM;
    for (int fine = 0; fine < 2; fine++) {
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            if (fine == (i % EVERY == 0))
                continue;
            power[i] = 0;
            if (fine && !is_beside(power, n, i, SEEN * most))
                continue;
            st = fill_behind(s, i, level);
            power[i] = st == SS_OK ? power_behind(s, &scale[i], level) : 0;
        }
        for (size_t i = EVERY; st == SS_OK && i + EVERY < n; i += EVERY)
            if (is_peak(power, n, i) && power[i - EVERY] > 0 && power[i + EVERY] > 0)
                most = fmax(most, power[i]);
    }
    free(level);
    return st;
}

/* The label of the strongest band that has less power on either side.  0: there is none. */
static ss_status
strongest_band(const search *s, double *f)
{
    const ss_coefficients *grid = s->map;
    double *power = malloc(grid->n_scales * sizeof *power), best = 0;
    ss_status st = power != NULL ? powers_behind(s, power, grid->n_scales) : SS_ENOMEM;
    *f = 0;
    for (size_t i = 1; st == SS_OK && i + 1 < grid->n_scales; i++) {
        double before = power[i - 1], at = power[i], next = power[i + 1];
        if (before > 0 && at > before && at > next && next > 0 && at > best) {
            best = at;
            *f = grid->scale[i].f;
        }
    }
    free(power);
    return st;
}

/* Fit an oscillation about two periods behind the transitions. */
static ss_status
fit_behind(search *s, double f)
{
    const ss_features *out = s->out;
    size_t *anchor = malloc((out->n + 1) * sizeof *anchor);
    if (anchor == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++) {
        const ss_transition *tr = &out->transition[i];
        double t = (s->spiked ? tr->end : tr->onset) + 2 / f;
        anchor[i] = (size_t)(fmin(t, (double)(s->n - 1) / s->rate) * s->rate);
    }
    ss_status st = ss_oscillation_fit(s, anchor, f, !s->spiked);
    free(anchor);
    return st;
}

/* Fit the oscillation of the strongest band.  Weaker bands with a finer resolution do not count. */
ss_status
ss_ringing_behind(search *s)
{
    double label = 0;
    ss_status st = s->out->n < FEW ? SS_OK : strongest_band(s, &label);
    say(s->out, SS_TRANSITION_FREQUENCY, "no band of frequencies stands out behind the transitions");
    return st == SS_OK && label > 0 ? fit_behind(s, true_frequency(s, label)) : st;
}
