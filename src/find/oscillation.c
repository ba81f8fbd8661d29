/* oscillation.c -- fit the oscillation after transitions that are roughly known, and judge the fit. */
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "find/edge.h"
#include "find/fold.h"
#include "find/hum.h"
#include "find/ringdown.h"
#include "find/scale_rows.h"
#include "find/search.h"
#include "signal/gaps.h"

#define NEAR 1.0                /* [octaves] the largest distance of a fit from the frequency that recurs */
#define SHARPER 1.5             /* times the frequency of the oscillation: an event so sharp lies within it */
#define PRECISE 10.0            /* standard errors that a frequency must be large */
#define POSITIVE 3.0            /* standard errors that a damping ratio must be above 0 */

/* Convert omega and s, per sample, to Hz and damping ratio. */
static void
set_oscillation(const ss_value fit[2], double rate, ss_value *frequency, ss_value *ratio)
{
    double w = fit[0].value, s = fit[1].value, r = hypot(w, s);
    *frequency = (ss_value){ w * rate / (2 * M_PI), fit[0].error * rate / (2 * M_PI) };
    *ratio = (ss_value){ s / r, hypot(w * w * fit[1].error, w * s * fit[0].error) / (r * r * r) };
}

static int
earlier_window(const void *a, const void *b)
{
    const ss_window *p = a, *q = b;
    return (p->first > q->first) - (p->first < q->first);
}

/* Does the spike end a stick in which f rings?  At scales that see no more than the oscillation itself,
 * its own crests pass for kinks. */
static int
cuts(const ss_spike *spike, double f)
{
    return is_event(spike) && spike->level >= -STRONG && spike->f > SHARPER * f;
}

typedef enum bars { BAR_GAPS, BAR_JUMPS, BAR_EVENTS } bars;

/* Find the bars that no stick crosses: gaps, and strong jumps, or jumps and kinks, whose samples no model
 * describes. */
static ss_status
find_bars(const search *s, bars which, double f, ss_window **bar, size_t *n)
{
    const ss_spikes *found = s->out->spikes;
    *bar = malloc((s->n_gaps + found->n + 1) * sizeof **bar);
    if (*bar == NULL)
        return SS_ENOMEM;
    for (*n = 0; *n < s->n_gaps; ++*n)
        ss_gap_rows(&s->gap[*n], s->rate, &(*bar)[*n].first, &(*bar)[*n].end);
    for (size_t i = 0; i < found->n && which != BAR_GAPS; i++)
        if (which == BAR_EVENTS ? cuts(&found->spike[i], f)
            : found->spike[i].kind == SS_SPIKE_JUMP && found->spike[i].level >= -STRONG) {
            size_t at = (size_t)ceil(fmax(found->spike[i].t * s->rate, 0));
            (*bar)[(*n)++] = (ss_window){ at, at };
        }
    qsort(*bar, *n, sizeof **bar, earlier_window);
    return SS_OK;
}

/* Does a jump or kink that ends a stick lie between the two, farther from them than the scale that shows it? */
static int
crosses_event(const ss_spikes *found, double from, double to, double f)
{
    size_t i = ss_list_from(found->spike, found->n, sizeof *found->spike, from);
    for (; i < found->n && found->spike[i].t < to; i++) {
        double a = ROW_CENTER / (2 * M_PI * found->spike[i].f), t = found->spike[i].t;
        if (cuts(&found->spike[i], f) && t > from + a && t < to - a)
            return 1;
    }
    return 0;
}

/* The number of windows that cross an event, of the record or of its mean cycle. */
static ss_status
count_crossings(const search *s, const ss_window *window, size_t n, double f, size_t *used,
                size_t *crossed)
{
    double period;
    ss_spikes *folded = NULL;
    ss_status st = ss_fold_spikes(s, &folded, &period);
    *used = *crossed = 0;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        double from = (double)window[i].first / s->rate, to = (double)window[i].end / s->rate;
        if (from == to)
            continue;
        ++*used;
        if (crosses_event(s->out->spikes, from, to, f)) {
            ++*crossed;
        } else if (folded != NULL) {
            double shift = period * (1 - floor(from / period));
            *crossed += (size_t)crosses_event(folded, from + shift, to + shift, f);
        }
    }
    ss_spikes_free(folded);
    return st;
}

static const char trains[] = "what recurs is a train of micro-slips, once a period of the oscillation";

/* The reason why the fit to `used` of n transitions is no ringing at about omega radians a sample; NULL: it
 * is.  An oscillation that fewer than half of the transitions show, and not every cycle, was picked by the
 * fit itself. */
static const char *
judge_fit(const ss_value all[2], double omega, size_t n, size_t cycles, size_t used, size_t crossed)
{
    if (isnan(all[0].value) || used < FEW || fabs(log2(all[0].value / omega)) > NEAR)
        return "what recurs lasts under 2 periods or is no damped oscillation";
    if (isinf(all[0].error))
        return trains;
    if (2 * used < n && used < cycles)
        return "fewer than half of the transitions last 2 periods as one oscillation";
    if (2 * crossed > used)
        return "jumps or kinks lie in what was fitted: the sticks last under 2 periods";
    if (!(all[1].value > 0))
        return "what recurs does not decay";
    if (!(all[0].error < all[0].value / PRECISE))
        return "the transitions do not agree on a frequency";
    return NULL;
}

/* The standard deviation of n fits, from the error of their median, all. */
static double
scatter_of(ss_value all, const ss_value *each, size_t n)
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++)
        used += isfinite(each[2 * i].value);
    return all.error * sqrt(2 * (double)used / M_PI);
}

/* Fit each stick by itself, as sticks need not be alike, if the transitions are known already. */
static ss_status
fit_singly(search *s, const size_t *anchor, double f, ss_window *window, ss_value all[2], ss_value *each)
{
    ss_window *bar = NULL;
    size_t n_bars = 0, n = s->out->n;
    const double w = 2 * M_PI / s->rate * f;
    ss_status st = find_bars(s, BAR_EVENTS, f, &bar, &n_bars);
    if (st == SS_OK)
        st = ss_ringdown_fit_each(s->x, s->n, anchor, n, w, bar, n_bars, window, all, each);
    if (st == SS_OK && (s->out->number[SS_TRANSITION_FREQUENCY].why = judge_fit(all, w, n, n, n, 0)) == NULL
        && !(scatter_of(all[0], each, n) < all[0].value / PRECISE))
        say(s->out, SS_TRANSITION_FREQUENCY, "each transition rings at another frequency");
    free(bar);
    return st;
}

/* Fit once about the anchors, away from bars, and judge the fit.  *why becomes the reason why it is no
 * ringing. */
static ss_status
fit_once(const search *s, const size_t *anchor, size_t n, double f, const ss_window *bar, size_t n_bars,
         ss_window *window, ss_value all[2], ss_value *each, const char **why)
{
    double turn = 2 * M_PI / s->rate, forcing = s->out->number[SS_REPETITION_FREQUENCY].value;
    size_t used = 0, crossed = 0;
    ss_status st = ss_ringdown_fit(s->x, s->n, anchor, n, turn * f, isnan(forcing) ? 0 : turn * forcing,
                                   s->out->noise / s->largest, bar, n_bars, window, all, each);
    if (st == SS_OK && !isnan(all[0].value))
        st = count_crossings(s, window, n, f, &used, &crossed);
    if (st == SS_OK)
        *why = judge_fit(all, turn * f, n, isnan(forcing) ? n : s->cycles.n, used, crossed);
    return st;
}

/* Two periods into the longest stretch without jumps and kinks between each anchor and the next: the
 * stick behind a train of micro-slips. */
static void
move_to_sticks(const search *s, const size_t *anchor, size_t n, double f, size_t *moved)
{
    const ss_spikes *found = s->out->spikes;
    for (size_t i = 0; i < n; i++) {
        double from = (double)anchor[i] / s->rate - 1 / f, longest = 0;
        double to = (i + 1 < n ? (double)anchor[i + 1] / s->rate : (double)s->n / s->rate) - 1 / f;
        size_t k = ss_list_from(found->spike, found->n, sizeof *found->spike, from);
        moved[i] = anchor[i];
        for (; from < to; k++) {
            if (k < found->n && !cuts(&found->spike[k], f))
                continue;
            double next = k < found->n ? fmin(found->spike[k].t, to) : to;
            if (next - from > longest) {
                longest = next - from;
                moved[i] = (size_t)((from + 2 / f) * s->rate);
            }
            from = next;
        }
        moved[i] = moved[i] < s->n ? moved[i] : s->n - 1;
    }
}

static void
move_behind(const search *s, const size_t *anchor, size_t n, double by, size_t *moved)
{
    for (size_t i = 0; i < n; i++)
        moved[i] = (size_t)fmin((double)anchor[i] + by * s->rate, (double)s->n - 1);
}

static int
same_bars(const ss_window *a, size_t n, const ss_window *b, size_t n_others)
{
    size_t i = 0;
    while (n == n_others && i < n && a[i].first == b[i].first && a[i].end == b[i].end)
        i++;
    return n == n_others && i == n;
}

/* A jump larger than the oscillation passes for the strongest oscillation in a window over it; a
 * smaller one does little harm, so that windows are kept off jumps, and then off kinks, and then
 * moved behind trains of these, only where nothing can be fitted else that deserves it; so are windows
 * moved behind what a slip leaves in a filter.  *why: it is no ringing.  A train of micro-slips stays
 * one, however it is barred: only what is behind may ring. */
static ss_status
fit(const search *s, const size_t *anchor, size_t n, double f, ss_window *window, ss_value all[2],
    ss_value *each, const char **why)
{
    enum { STICKS = 3 };
    static const double behind[STICKS] = { 0, 2, 5 };   /* periods */
    size_t *moved = malloc((n + 1) * sizeof *moved), n_before = 0;
    ss_window *before = NULL;
    ss_status st = moved != NULL ? SS_OK : SS_ENOMEM;
    *why = "";
    for (bars which = BAR_GAPS; which <= BAR_EVENTS && st == SS_OK && *why != NULL; which++) {
        ss_window *bar = NULL;
        size_t n_bars = 0;
        st = find_bars(s, which, f, &bar, &n_bars);
        int barred = n_bars > s->n_gaps;
        int is_new = which == BAR_GAPS || (barred && !same_bars(bar, n_bars, before, n_before));
        for (int k = is_new ? 0 : STICKS; k <= STICKS && st == SS_OK && *why != NULL; k++) {
            if (k == STICKS ? which != BAR_EVENTS || (!barred && *why == trains) : *why == trains)
                continue;
            if (k == STICKS)
                move_to_sticks(s, anchor, n, f, moved);
            else
                move_behind(s, anchor, n, behind[k] / f, moved);
            st = fit_once(s, moved, n, f, bar, n_bars, window, all, each, why);
        }
        free(before);
        before = bar;
        n_before = n_bars;
    }
    free(before);
    free(moved);
    return st;
}

/* Write the fits to the transitions; what rings behind the next transition belongs to that. */
static void
report(search *s, const ss_window *window, const ss_value all[2], const ss_value *each)
{
    ss_features *out = s->out;
    ss_value frequency, ratio;
    set_oscillation(all, s->rate, &frequency, &ratio);
    know(out, SS_TRANSITION_FREQUENCY, frequency);
    know(out, SS_DAMPING_RATIO, ratio);
    if (!isnan(frequency.value) && !(ratio.value > POSITIVE * ratio.error)) {
        know(out, SS_DAMPING_RATIO, unknown);
        say(out, SS_TRANSITION_FREQUENCY, "the damping ratio is less than three of its standard errors");
    }
    for (size_t i = 0; i < out->n; i++) {
        ss_transition *tr = &out->transition[i];
        if (i + 1 < out->n && tr[1].onset > tr->onset
            && (double)window[i].first >= tr[1].onset * s->rate)
            continue;
        set_oscillation(each + 2 * i, s->rate, &tr->frequency, &tr->damping_ratio);
        if (window[i].end > window[i].first) {
            tr->from = (double)window[i].first / s->rate;
            tr->to = (double)window[i].end / s->rate;
        }
    }
}

/* Fit all transitions together, after a hum beside the oscillation is subtracted. */
static ss_status
fit_shared(search *s, const size_t *anchor, double f, ss_window *window, ss_value all[2], ss_value *each)
{
    ss_hum hum = SS_HUM_NONE;
    int is_edge = 0;
    double repeats = s->out->number[SS_REPETITION_FREQUENCY].value;
    ss_status st = isnan(repeats) ? SS_OK
        : ss_hum_subtract(s->x, s->n, f / s->rate, s->rate / repeats, &hum);
    if (st == SS_OK)
        st = fit(s, anchor, s->out->n, f, window, all, each, &s->out->number[SS_TRANSITION_FREQUENCY].why);
    if (st == SS_OK && s->out->number[SS_TRANSITION_FREQUENCY].why == NULL)
        st = ss_edge_find(s->x, s->n, all[0].value / (2 * M_PI), &is_edge);
    if (is_edge)
        say(s->out, SS_TRANSITION_FREQUENCY,
            "it rings where the spectrum ends without a peak, as a filter does");
    s->is_cleaned |= hum == SS_HUM_SUBTRACTED;
    if (hum == SS_HUM_HIDDEN)
        say(s->out, SS_TRANSITION_FREQUENCY, "a steady hum beside a harmonic of what repeats is in its band");
    return st;
}

ss_status
ss_oscillation_fit(search *s, const size_t *anchor, double f, int singly)
{
    ss_features *out = s->out;
    ss_window *window = malloc((out->n + 1) * sizeof *window);
    ss_value *each = malloc(2 * (out->n + 1) * sizeof *each), all[2];
    ss_status st = SS_ENOMEM;
    if (window != NULL && each != NULL)
        st = singly ? fit_singly(s, anchor, f, window, all, each)
            : fit_shared(s, anchor, f, window, all, each);
    if (st == SS_OK) {
        if (out->number[SS_TRANSITION_FREQUENCY].why != NULL)
            ss_ringdown_clear(anchor, out->n, window, all, each);
        else if (s->is_cleaned)
            say(out, SS_TRANSITION_FREQUENCY, "fitted to what is left when a steady hum near it is subtracted");
        report(s, window, all, each);
    }
    free(window);
    free(each);
    return st;
}
