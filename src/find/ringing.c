/* ringing.c -- find transitions by their oscillation, and the oscillation behind known transitions. */
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "find/maxima.h"
#include "find/search.h"
#include "signal/gaps.h"

#define BAND 0.25               /* [octaves] the largest distance of maxima of one kind */
#define OCTAVES 2               /* a contact may ring faster than the rig by so much, or more */

/* The label of a maximum in terms of the sinusoid that makes it. */
static double
true_frequency(const search *s, double label)
{
    return s->opts->norm == SS_NORM_L1 ? label
        : label * (ROW_CENTER + sqrt(ROW_CENTER * ROW_CENTER + 2)) / (2 * ROW_CENTER);
}

/* --- transitions that are found by their ringing ----------------------------------------------- */

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

/* Give every swell the nearest maximum of the kind that is above the threshold and within reach of the
 * wavelet, if FEW or more are.  Returns the number of swells with a maximum at all. */
static size_t
match_maxima(search *s, const ss_maximum *swell, double f)
{
    ss_features *out = s->out;
    double reach = ROW_CENTER / (M_PI * f);
    size_t ringing = 0, first = 0;
    for (size_t i = 0; i < out->n; i++) {
        const ss_maximum *best = NULL;
        while (first < s->n_found && s->found[first].t < swell[i].t - reach)
            first++;
        for (size_t k = first; k < s->n_found && s->found[k].t <= swell[i].t + reach; k++) {
            const ss_maximum *m = &s->found[k];
            if (fabs(log2(m->f / f)) <= BAND
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
    double *f = malloc((out->recurring + 1) * sizeof *f);
    size_t n = 0;
    if (f == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++)
        if (!isnan(out->transition[i].maximum.f))
            f[n++] = out->transition[i].maximum.f;
    double scatter = n > 1 ? gsl_stats_variance(f, 1, n) / (double)n : 0, median = gsl_stats_median(f, 1, n);
    double step = median * (exp2(1. / ss_morlet_defaults.voices) - 1);
    know(out, SS_TRANSITION_FREQUENCY_RAW, (ss_value){ median, sqrt(step * step / 12 + scatter) });
    free(f);
    return SS_OK;
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
        /* a swell is highest about a period behind its onset, give or take 1.5 */
        double last = swell[i].t + 0.5 / f;
        size_t k = ss_list_from(found->spike, found->n, sizeof *found->spike, last - 3 / f);
        while (k < found->n && found->spike[k].t <= last && !is_event(&found->spike[k]))
            k++;
        sharp += k < found->n && found->spike[k].t <= last;
    }
    return 2 * sharp >= n;
}

/* Move the onset, which the fit or the swell gave, to the nearest jump or kink within half a period.  Move
 * the end to the last jump or kink that follows another within a period: the mass does not stick longer
 * between them. */
static void
snap_to_spikes(const search *s, ss_transition *tr, double period)
{
    const ss_spikes *found = s->out->spikes;
    double nearest = 0.5 * period, from = tr->onset;
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
        if (spike->t > tr->end)
            tr->end = spike->t;
    }
}

/* Refine transitions of which only swells are known: fit their oscillation, then move their ends from the fit, or
 * from the swell, to the jumps and kinks beside them.  What recurs may be the rig's own oscillation, while it
 * slips.  A contact rings faster; it must show that it is one, as nothing else speaks for it. */
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
    if (st == SS_OK && s->rings_as == OF_NOTHING && s->part->known == NULL) {
        const char **why = &out->number[SS_TRANSITION_FREQUENCY].why, *first = *why;
        s->must_show = 1;
        for (int third = 1; st == SS_OK && s->rings_as != OF_CONTACT && third <= 3 * OCTAVES; third++)
            st = ss_oscillation_fit(s, anchor, exp2(third / 3.) * f, 0);
        if (s->rings_as == OF_CONTACT) {
            know(out, SS_TRANSITION_FREQUENCY_RAW, unknown);
            s->label = 0;
        } else
            *why = first;
    }
    free(anchor);
    for (size_t i = 0; st == SS_OK && i < out->n; i++) {
        ss_transition *tr = &out->transition[i];
        tr->onset = isnan(tr->from) ? swell[i].t : tr->from;
        tr->end = isnan(tr->to) ? swell[i].t : tr->to;
        snap_to_spikes(s, tr, 1 / f);
    }
    if (st == SS_OK)
        qsort(out->transition, out->n, sizeof *out->transition, ss_ascending);
    return st;
}

ss_status
ss_ringing_find(search *s, double prominence)
{
    ss_features *out = s->out;
    ss_maximum *swell = NULL;
    size_t n = 0;
    double label = s->part->known != NULL ? s->part->known->label : 0;
    ss_status st = label > 0 ? SS_OK : find_recurrent(s, prominence, &label);
    say(out, SS_TRANSITION_FREQUENCY, "no oscillation swells again and again");
    if (st != SS_OK || label == 0)
        return st;
    const maxima_kind kind = { s->opts->threshold, STRONG, 0 };
    size_t nearest = 0;
    for (size_t i = 1; i < s->map->n_scales; i++)
        if (fabs(log(s->map->scale[i].f / label)) < fabs(log(s->map->scale[nearest].f / label)))
            nearest = i;
    st = ss_maxima_of_row(&swell, &n, s->map, nearest, &kind, s->top);
    if (st == SS_OK)
        st = ss_transitions_new(out, n);
    size_t ringing = st == SS_OK ? match_maxima(s, swell, label) : 0;
    int recurs = ringing >= FEW && 2 * ringing >= out->n;
    if (recurs && isnan(out->number[SS_REPETITION_FREQUENCY].value) && !begin_sharply(s, swell, label)) {
        say(out, SS_TRANSITION_FREQUENCY,
            "what swells again and again neither repeats with a cycle nor begins sharply");
        recurs = 0;
    }
    if (!recurs)
        out->n = out->recurring = 0;
    s->label = recurs ? label : 0;
    if (st == SS_OK && out->recurring > 0)
        st = read_raw(s);
    if (st == SS_OK && recurs)
        st = refine(s, swell, true_frequency(s, label));
    free(swell);
    return st;
}

/* --- ringing behind transitions that are known ----------------------------------------------- */

/* Where ringing is sought behind transitions that end with their last spike, and behind the reversals of a
 * force, in periods: from `settled` behind the end, or the onset, which shows its own jump, to `looked`, if
 * the next transition, or the end, is `left` away or more. */
typedef struct span {
    double settled, looked, left;
} span;
static const span behind_spikes = { 0.5, 2.5, 0.5 };
static const span behind_reversals = { 1, 5, 2 }, before_reversals = { -5, -1, 2 };

enum { HEARD = 1024 };          /* transitions, the first, behind which the band is sought */

/* The end of a transition that is known by its spikes, or the onset of a reversal. */
static double
begin_of(const search *s, size_t i)
{
    return s->spiked ? s->out->transition[i].end : s->out->transition[i].onset;
}

static size_t
point_at(const ss_scale *scale, double t)
{
    return (size_t)ceil(t / (scale->b_num / scale->b_den));
}

/* The mean square of |W| at a scale so far behind the transitions, over the root of the scale, which is that of the
 * amplitude; 0: fewer than half of the transitions last so long.  level has room for the scale. */
static ss_status
power_behind(const search *s, span in, size_t index, double *level, double *power)
{
    const ss_features *out = s->out;
    const ss_scale *scale = &s->map->scale[index];
    const double period = 1 / scale->f, reach = ROW_REACH * scale->a;
    const size_t n = out->n < HEARD ? out->n : HEARD;
    const size_t first = point_at(scale, fmax(0, begin_of(s, 0) + in.settled * period));
    size_t end = point_at(scale, fmax(0, begin_of(s, n - 1) + in.looked * period)) + 1, used = 0;
    double sum = 0;
    end = end < scale->n ? end : scale->n;
    const ss_map_part part = { index, first, end > first ? end - first : 0, NULL, level + first };
    ss_status st = end > first ? ss_map_read(s->map, &part, 1, NULL) : SS_OK;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        double from = begin_of(s, i) + in.settled * period, to = begin_of(s, i) + in.looked * period;
        double next = i + 1 < out->n ? out->transition[i + 1].onset : (double)s->n / s->rate, squares = 0;
        const size_t start = point_at(scale, fmax(0, from));
        size_t b = start;
        if (from < 0 || to > (s->spiked ? next : out->transition[i].end) - in.left * period
            || ss_gaps_near(s->gap, s->n_gaps, 0.5 * (from + to), 0.5 * (to - from) + reach))
            continue;
        for (; b < end && ss_scale_b(scale, b) <= to; b++)
            squares += level[b] * level[b];
        sum += squares > 0 ? squares / (double)(b - start) : 0;
        used += squares > 0;
    }
    *power = 2 * used > n ? sum / (double)used / (s->opts->norm == SS_NORM_L1 ? 1 : scale->a) : 0;
    return st;
}

/* The label of the strongest band that has less power on either side, both known, and behind reversals more than
 * before them, where a hum is as strong.  0: there is none. */
static ss_status
strongest_band(const search *s, double *f)
{
    const span in = s->spiked ? behind_spikes : behind_reversals;
    const ss_coefficients *grid = s->map;
    const size_t n = grid->n_scales;
    double *power = malloc(n * sizeof *power), *level = malloc((grid->scale[n - 1].n + 1) * sizeof *level);
    double best = 0, calm = 0;
    size_t top = 0;
    ss_status st = power != NULL && level != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++)
        st = power_behind(s, in, i, level, &power[i]);
    for (size_t i = 1; st == SS_OK && i + 1 < n; i++) {
        double before = power[i - 1], at = power[i], next = power[i + 1];
        if (before > 0 && at > before && at > next && next > 0 && at > best) {
            best = at;
            top = i;
        }
    }
    if (st == SS_OK && top > 0 && !s->spiked)
        st = power_behind(s, before_reversals, top, level, &calm);
    *f = top > 0 && best > TWICE * calm ? grid->scale[top].f : 0;
    free(level);
    free(power);
    return st;
}

/* Fit the oscillation of the strongest band about two periods behind the transitions.  Weaker bands with a
 * finer resolution do not count. */
ss_status
ss_ringing_behind(search *s)
{
    const size_t n = s->out->n;
    double label = 0;
    ss_status st = n < FEW ? SS_OK : strongest_band(s, &label);
    say(s->out, SS_TRANSITION_FREQUENCY, "no band of frequencies stands out behind the transitions");
    if (st != SS_OK || label == 0)
        return st;
    double f = true_frequency(s, label);
    size_t *anchor = malloc((n + 1) * sizeof *anchor);
    if (anchor == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        anchor[i] = (size_t)(fmin(begin_of(s, i) + 2 / f, (double)(s->n - 1) / s->rate) * s->rate);
    st = ss_oscillation_fit(s, anchor, f, !s->spiked);
    free(anchor);
    return st;
}
