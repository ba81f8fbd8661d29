/* transitions.c -- where the transitions of a signal begin and end. */
#include <math.h>
#include <stdlib.h>
#include "find/search.h"
#include "signal/gaps.h"

#define SPIKES 60.0             /* [dB] range of the spikes that are counted in a transition */

/* Find transitions that do not ring.  Each strong spike begins one; the weaker spikes up to the next strong
 * one belong to it.  Strong spikes nearer than an eighth of the cycle are one. */
static ss_status
find_spiked(search *s)
{
    ss_features *out = s->out;
    const ss_spikes *found = out->spikes;
    double apart = isnan(out->number[SS_REPETITION_FREQUENCY].value) ? 0 : JITTER
        / out->number[SS_REPETITION_FREQUENCY].value;
    ss_status st = ss_transitions_new(out, found->n);
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

/* Find single events in a record that is quiet elsewhere.  Several stand apart from the next weaker one, or from
 * the noise: swells of noise have all strengths.  The map is not needed any more. */
static ss_status
find_single(search *s)
{
    ss_bursts found;
    ss_coefficients_free(s->map);
    s->map = NULL;
    ss_status st = ss_bursts_find(&found, s->rows, STRONG);
    double weakest = 0;
    for (size_t i = 0; i < found.n; i++)
        weakest = fmin(weakest, found.burst[i].level);
    const double reach = ROW_REACH * ROW_CENTER / (2 * M_PI * found.f);
    const int apart = found.n < 2 || weakest - fmax(found.next, found.floor) >= EVENT_CLEAR;
    if (st == SS_OK && apart && (st = ss_transitions_new(s->out, found.n)) == SS_OK)
        for (size_t i = 0; i < found.n; i++) {
            ss_transition *tr = &s->out->transition[i];
            size_t at = (size_t)round(found.burst[i].t * s->rate);
            double from = 0, to = (double)s->n / s->rate, t = found.burst[i].t;     /* up to the next event or gap */
            if (i > 0)
                from = fmin(found.burst[i - 1].t + reach, t);
            if (i + 1 < found.n)
                to = fmax(found.burst[i + 1].t - reach, t);
            for (size_t k = 0; k < s->n_gaps; k++)
                if (s->gap[k].to <= t)
                    from = fmax(from, s->gap[k].to);
                else if (s->gap[k].from >= t)
                    to = fmin(to, s->gap[k].from);
            const ss_window room = { (size_t)ceil(from * s->rate), (size_t)floor(to * s->rate) };
            tr->onset = tr->end = found.burst[i].t;
            if (room.first >= at || room.end <= at)
                continue;
            ss_window event = ss_extent(s->x, room, at, s->rate / found.f);
            if (event.first < at)
                tr->onset = (double)event.first / s->rate;
            if (event.end > at)
                tr->end = (double)event.end / s->rate;
        }
    free(found.burst);
    return st;
}

/* The first spike of a transition may lie half a period before the fitted window, and the last one a
 * period behind it. */
static void
count_spikes(const search *s)
{
    ss_features *out = s->out;
    double period = isnan(out->number[SS_TRANSITION_FREQUENCY].value) ? 0 : 1
        / out->number[SS_TRANSITION_FREQUENCY].value;
    double f = INFINITY;
    for (size_t i = 0; i < out->spikes->n; i++)
        f = is_event(&out->spikes->spike[i]) ? fmin(f, out->spikes->spike[i].f) : f;
    const double reach = 2 * ROW_REACH * ROW_CENTER / (2 * M_PI * f);     /* of gaps, for spikes as blunt */
    for (size_t i = 0; i < out->n; i++) {
        ss_transition *tr = &out->transition[i];
        double next = i + 1 < out->n ? tr[1].onset : (double)s->n / s->rate;
        double from = tr->onset - period / 2, to = s->spiked ? next : tr->end + period;
        tr->spikes = ss_spikes_within(out->spikes, tr->onset, tr->end, SPIKES);
        tr->gap = ss_gaps_near(s->gap, s->n_gaps, 0.5 * (from + to), 0.5 * (to - from) + reach);
    }
}

/* Find transitions by their ringing, prominent or slight.  If none rings and the signal repeats itself,
 * find them by their spikes: the period says how far apart the first spikes of two transitions are.
 * Else find single events, each of which may have many spikes. */
static ss_status
find_transitions(search *s)
{
    ss_features *out = s->out;
    size_t strong = 0;
    for (size_t i = 0; i < out->spikes->n; i++)
        strong += is_event(&out->spikes->spike[i]) && out->spikes->spike[i].level >= -STRONG;
    int spiked = out->spikes->conclusive && !isnan(out->number[SS_REPETITION_FREQUENCY].value) && strong > 0;
    ss_status st = SS_OK;
    for (int slight = 0; slight < 2 && st == SS_OK && out->n == 0; slight++) {
        st = ss_ringing_find(s, slight ? 0 : s->opts->threshold);
        if (slight && spiked && out->recurring == 0 && isnan(out->number[SS_TRANSITION_FREQUENCY].value))
            out->n = 0;                 /* the times of spikes are better */
    }
    if (st == SS_OK && out->n == 0 && spiked) {
        st = find_spiked(s);
        if (st == SS_OK)
            st = ss_ringing_behind(s);
    }
    if (st == SS_OK && out->n == 0 && !s->cycles.modulated)
        st = find_single(s);
    return st;
}

ss_status
ss_transitions_find(search *s)
{
    int decided = 0;
    ss_status st = s->part->known != NULL ? ss_ringing_find(s, 0) : ss_force_find(s, &decided);
    if (st == SS_OK && !decided && s->part->known == NULL)
        st = find_transitions(s);
    else if (st == SS_OK && decided && s->out->loading != NULL)
        say(s->out, SS_TRANSITION_FREQUENCY, "it is not looked for behind the falls of a force");
    else if (st == SS_OK && decided)
        st = ss_ringing_behind(s);
    if (st == SS_OK)
        count_spikes(s);
    return st;
}
