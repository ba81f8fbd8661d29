/* oscillation.c -- fit the oscillation after transitions that are roughly known, and judge the fit. */
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "find/search.h"
#include "signal/gaps.h"

/* Convert omega and s, per sample, to Hz and damping ratio. */
static void
set_oscillation(const ss_value fit[2], double rate, ss_value *frequency, ss_value *ratio)
{
    double w = fit[0].value, s = fit[1].value, r = hypot(w, s);
    *frequency = (ss_value){ w * rate / (2 * M_PI), fit[0].error * rate / (2 * M_PI) };
    *ratio = (ss_value){ s / r, hypot(w * w * fit[1].error, w * s * fit[0].error) / (r * r * r) };
}

/* --- events and gaps, which end a stick ------------------------------------------------------- */

/* Does the spike end a stick in which f rings?  At scales that see no more than the oscillation itself,
 * its own crests pass for kinks. */
static int
cuts(const ss_spike *spike, double f)
{
    return is_event(spike) && spike->level >= -STRONG && spike->f > LARGER * f;
}

static int
earlier_window(const void *a, const void *b)
{
    const ss_window *p = a, *q = b;
    return (p->first > q->first) - (p->first < q->first);
}

/* Find the bars that no stick crosses: gaps, and the jumps and kinks of f if asked for, whose samples no model
 * describes. */
static ss_status
find_bars(const search *s, int events, double f, ss_window **out, size_t *n_bars)
{
    const ss_spikes *found = s->out->spikes;
    size_t n = 0;
    ss_window *bar = malloc((s->n_gaps + found->n + 1) * sizeof *bar);
    if (bar == NULL)
        return SS_ENOMEM;
    for (; n < s->n_gaps; n++)
        ss_gap_rows(&s->gap[n], s->rate, &bar[n].first, &bar[n].end);
    for (size_t i = 0; i < found->n && events; i++)
        if (cuts(&found->spike[i], f)) {
            size_t at = (size_t)ceil(fmax(found->spike[i].t * s->rate, 0));
            bar[n++] = (ss_window){ at, at };
        }
    qsort(bar, n, sizeof *bar, earlier_window);
    *out = bar;
    *n_bars = n;
    return SS_OK;
}

/* Two periods into the longest stretch without jumps and kinks from sample `anchor` to sample `next`: the stick
 * behind a train of micro-slips. */
static size_t
stick_behind(const search *s, size_t anchor, size_t next, double f)
{
    const ss_spikes *found = s->out->spikes;
    double from = (double)anchor / s->rate - 1 / f, end = (double)next / s->rate - 1 / f, longest = 0;
    double moved = (double)anchor;
    for (size_t k = ss_list_from(found->spike, found->n, sizeof *found->spike, from); from < end; k++) {
        if (k < found->n && !cuts(&found->spike[k], f))
            continue;
        double to = k < found->n ? fmin(found->spike[k].t, end) : end;
        if (to - from > longest) {
            longest = to - from;
            moved = (from + 2 / f) * s->rate;
        }
        from = to;
    }
    return (size_t)moved;
}

/* --- is it one oscillation? -------------------------------------------------------------------- */

/* Is the fit within an octave of the frequency f [Hz] one of a damped oscillation in sticks: the reason why not,
 * or NULL.  cycles: the number of them; an oscillation that fewer than half of the transitions show, and not every
 * cycle, was picked by the fit itself. */
static const char *
judge(const search *s, const ringdown *r, double f, size_t cycles)
{
    size_t used = 0, crossed = 0;
    const ss_value w = r->all[0];
    for (size_t i = 0; i < r->n_anchors; i++) {
        const ss_spikes *found = s->out->spikes;
        const double from = (double)r->window[i].first / s->rate, to = (double)r->window[i].end / s->rate;
        int is_crossed = 0;     /* a jump or kink lies in it, farther from its ends than the scale that shows it */
        for (size_t k = ss_list_from(found->spike, found->n, sizeof *found->spike, from);
             k < found->n && found->spike[k].t < to; k++) {
            const double a = ROW_CENTER / (2 * M_PI * found->spike[k].f), t = found->spike[k].t;
            is_crossed |= cuts(&found->spike[k], f) && t > from + a && t < to - a;
        }
        used += to > from;
        crossed += (size_t)is_crossed;
    }
    if (isnan(w.value) || used < FEW || fabs(log2(w.value * s->rate / (2 * M_PI * f))) > 1)
        return "what recurs lasts under 2 periods or is no damped oscillation";
    if (r->is_train)
        return "what recurs is a train of micro-slips, once a period of the oscillation";
    if (2 * used < r->n_anchors && used < cycles)
        return "fewer than half of the transitions last 2 periods as one oscillation";
    if (2 * crossed > used)
        return "jumps or kinks lie in what was fitted: the sticks last under 2 periods";
    if (!(w.error < w.value / PRECISE))
        return "the transitions do not agree on a frequency";
    return NULL;
}

/* --- fits ---------------------------------------------------------------------------------------- */

/* Fit each stick by itself, as sticks need not be alike, if the transitions are known already. */
static ss_status
fit_singly(search *s, ringdown *r, double f)
{
    ss_window *bar = NULL;
    double scatter = NAN;
    ss_status st = find_bars(s, 1, f, &bar, &r->n_bars);
    r->bar = bar;
    if (st == SS_OK)
        st = ss_ringdown_fit_each(r, &scatter);
    const char *why = judge(s, r, f, 0);
    if (why == NULL && !(scatter < r->all[0].value / PRECISE))
        why = "each transition rings at another frequency";
    if (st == SS_OK && why == NULL)
        st = ss_identity_of(s, r, &why);
    say(s->out, SS_TRANSITION_FREQUENCY, why);
    free(bar);
    return st;
}

/* Fit all sticks together, in the first of these ways that is ringing.  A jump larger than the oscillation
 * passes for the strongest oscillation in a window over it; a smaller one does little harm.  So windows are
 * moved behind what a slip leaves in a filter; kept off jumps and kinks; and moved behind trains of these.  A
 * train of micro-slips stays one, however it is barred: only the stick behind it may ring.  Where a filter rounds all
 * jumps and kinks, a stick lies between slips. */
static ss_status
fit_together(search *s, ringdown *r, double f)
{
    static const struct { int off_events; double behind; } way[] = {    /* behind the anchors, in periods; */
        { 0, 0 }, { 0, 2 }, { 0, 5 }, { 1, 0 }, { 1, 2 }, { 1, 5 },
        { 1, NAN },                                                     /* NAN: in the longest stick there */
        { 0, INFINITY },                                                /* halfway to the next anchor */
    };
    const size_t *anchor = r->anchor, n = r->n_anchors, cycles = r->forcing > 0 ? s->cycles.n : n;
    const char **why = &s->out->number[SS_TRANSITION_FREQUENCY].why;
    size_t *moved = malloc((n + 1) * sizeof *moved);
    ss_window *bar = NULL;
    ss_status st = moved != NULL ? SS_OK : SS_ENOMEM;
    *why = "";
    for (size_t k = 0; k < sizeof way / sizeof *way && st == SS_OK && *why != NULL; k++) {
        int in_stick = isnan(way[k].behind);
        if (k == 0 || way[k].off_events != way[k - 1].off_events) {
            free(bar);
            bar = NULL;
            st = find_bars(s, way[k].off_events, f, &bar, &r->n_bars);
        }
        int is_barred = r->n_bars > s->n_gaps;
        if (st != SS_OK || (way[k].off_events && !is_barred && !in_stick)
            || (r->is_train && !(is_barred && in_stick)))
            continue;
        for (size_t i = 0; i < n; i++) {
            const size_t next = i + 1 < n ? anchor[i + 1] : s->n;
            moved[i] = in_stick ? stick_behind(s, anchor[i], next, f)
                : isinf(way[k].behind) ? anchor[i] + (next - anchor[i]) / 2
                : anchor[i] + (size_t)(way[k].behind / f * s->rate);
            moved[i] = moved[i] < s->n ? moved[i] : s->n - 1;
        }
        r->anchor = moved;
        r->bar = bar;
        st = ss_ringdown_fit(r);
        if (st == SS_OK)
            *why = judge(s, r, f, cycles);
    }
    r->anchor = anchor;
    if (st == SS_OK && *why == NULL)
        st = ss_identity_of(s, r, why);
    free(bar);
    free(moved);
    return st;
}

/* The error of all frequencies by a clock that wanders.  What rings is a clock, too: from one transition to the
 * next it differs by that much, so the lengths of cycles that vary by themselves are no wandering.  It differs by
 * what single frequencies scatter beyond their own errors (DerSimonian and Laird 1986), at least.  Neighbours that
 * are correlated by rho count as (1 - rho) / (1 + rho), as in cycles. */
static double
clock_error(const search *s, const ringdown *r)
{
    double squares = 0, products = 0, before = 0, n = 0, weights = 0, their_squares = 0, chi2 = 0;
    /* behind the reversals of a force the windows, each by itself, scatter by it already */
    double wander = s->out->reverses ? 0 : s->cycles.wander * r->all[0].value;
    for (size_t i = 0; i < s->out->n; i++)
        if (isfinite(r->each[i][0].value)) {
            double differs = r->each[i][0].value - r->all[0].value, weight = pow(r->each[i][0].error, -2);
            squares += differs * differs, products += differs * before, n++;
            weights += weight, their_squares += weight * weight, chi2 += weight * differs * differs;
            before = differs;
        }
    if (n < 3 || s->out->reverses)
        return wander;
    double rho = fmax(0, fmin(1, products / squares)), correlated = fmin(n, (1 + rho) / (1 - rho));
    double beyond = fmax(0, chi2 - (n - 1)) / (weights - their_squares / weights);
    if (n > MOSTLY * (double)s->out->n)         /* else the others may be those that differ */
        wander = fmin(wander, sqrt(squares / (n - 1) / n * correlated));
    return fmax(wander, sqrt(beyond * their_squares * correlated) / weights);
}

/* Write the fits to the transitions; what rings behind the next transition belongs to that. */
static void
report(search *s, const ringdown *r)
{
    ss_features *out = s->out;
    ss_value frequency, ratio, all[2] = { r->all[0], r->all[1] };
    double wander = clock_error(s, r);
    for (int j = 0; j < 2; j++)
        all[j].error = hypot(all[j].error, wander);
    set_oscillation(all, s->rate, &frequency, &ratio);
    know(out, SS_TRANSITION_FREQUENCY, frequency);
    know(out, SS_DAMPING_RATIO, ratio);
    if (!isnan(frequency.value) && !(ratio.value > SIGMAS * ratio.error)) {
        know(out, SS_DAMPING_RATIO, unknown);
        say(out, SS_TRANSITION_FREQUENCY, "the damping ratio is less than three of its standard errors");
    }
    if (!isnan(frequency.value) && wander > r->all[0].error)
        say(out, SS_TRANSITION_FREQUENCY,
            "the sticks scatter in frequency by more than noise, as by a clock that wanders: errors allow for it");
    for (size_t i = 0; i < out->n; i++) {
        ss_transition *tr = &out->transition[i];
        ss_window win = r->window[i];
        if (i + 1 < out->n && tr[1].onset > tr->onset && (double)win.first >= tr[1].onset * s->rate)
            continue;
        set_oscillation(r->each[i], s->rate, &tr->frequency, &tr->damping_ratio);
        if (ss_window_length(win) > 0) {
            tr->from = (double)win.first / s->rate;
            tr->to = (double)win.end / s->rate;
        }
    }
}

ss_status
ss_oscillation_fit(search *s, const size_t *anchor, double f, int singly)
{
    ss_features *out = s->out;
    const double turn = 2 * M_PI / s->rate, forcing = out->number[SS_REPETITION_FREQUENCY].value;
    ringdown r = { .x = s->x, .n = s->n, .anchor = anchor, .n_anchors = out->n, .w = turn * f,
                   .forcing = isnan(forcing) ? 0 : turn * forcing, .white = out->noise / s->largest,
                   .is = s->part->known != NULL ? s->part->known->slow : SLOW_EITHER };
    r.window = malloc((out->n + 1) * sizeof *r.window);
    r.each = malloc((out->n + 1) * sizeof *r.each);
    ss_status st = r.window != NULL && r.each != NULL ? SS_OK : SS_ENOMEM;
    ss_hum hum = SS_HUM_NONE;
    if (st == SS_OK && !singly && !isnan(forcing))
        st = ss_hum_subtract(s->x, s->n, f / s->rate, s->rate / forcing, &hum);
    if (st == SS_OK)
        st = singly ? fit_singly(s, &r, f) : fit_together(s, &r, f);
    s->is_cleaned |= hum == SS_HUM_SUBTRACTED;
    if (hum == SS_HUM_HIDDEN)
        say(out, SS_TRANSITION_FREQUENCY, "a steady hum beside a harmonic of what repeats is in its band");
    if (st == SS_OK) {
        if (out->number[SS_TRANSITION_FREQUENCY].why != NULL)
            ss_ringdown_clear(&r);
        else if (s->is_cleaned)
            say(out, SS_TRANSITION_FREQUENCY, "fitted to what is left when a steady hum near it is subtracted");
        report(s, &r);
        s->slow = r.slow > 0 ? SLOW_FORCED : SLOW_LINE;
    }
    free(r.window);
    free(r.each);
    return st;
}
