/* spikes.c -- jumps, kinks and glitches from the maxima of |W| along the shortest scales.
 *
 * Rows of |W|, one a scale, are computed from the shortest scale on.  A maximum along a row that is
 * above the threshold, has one above the threshold beside it in the next row, and lies clear of all
 * spikes found at shorter scales is a spike.  Once a row shows one, the rows of REACH octaves more
 * are searched: weaker spikes and blunter ones appear there; a maximum that appears only later is no
 * longer sharp.
 */
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "base/sort.h"
#include "find/events.h"
#include "find/judgement.h"
#include "signal/gaps.h"

#define DEEPEST 5.0             /* octaves in which the first spike is sought: 100 samples are smooth */
#define REACH 2.0               /* octaves in which spikes are sought from the first row with a spike on */
#define NEAR 2.0                /* scales: the least distance of two spikes, and what the fit of a break sees */
#define DRIFT 0.5               /* the most by which a maximum moves from row to row, in scales */

typedef struct spike_search {
    row_source *source;
    size_t n_rows;
    scale_row *row;
    double threshold;
    size_t room;
    ss_spikes *found;
} spike_search;

const char *
ss_spike_kind_name(ss_spike_kind kind)
{
    static const char *const name[] = { "glitch", "jump", "kink", "bend" };
    return (unsigned)kind <= SS_SPIKE_BEND ? name[kind] : "?";
}

/* --- from row to row ----------------------------------------------------------------------- */

/* The peak of the row nearest to t, or NULL if it is farther than within. */
static const peak *
nearest(const scale_row *r, double t, double within)
{
    size_t lo = ss_list_from(r->peak, r->n, sizeof *r->peak, t);
    const peak *best = NULL;
    if (lo < r->n && r->peak[lo].t - t <= within)
        best = &r->peak[lo];
    if (lo > 0 && t - r->peak[lo - 1].t <= within
        && (best == NULL || t - r->peak[lo - 1].t < best->t - t))
        best = &r->peak[lo - 1];
    return best;
}

/* The slope [dB/octave] along the line of maxima that begins at peak p of row i, over an octave at most.
 * *clearest becomes its largest level above the noise. */
static double
slope_of(const spike_search *s, size_t i, const peak *p, double *clearest)
{
    *clearest = p->level / s->row[i].rms;
    double sum = 0, weight = 0, base = log(p->level);
    size_t last = i;
    double level[ROW_VOICES + 1] = { 0 };
    for (size_t k = i + 1; k < s->n_rows && k <= i + ROW_VOICES; k++) {
        const peak *next = nearest(&s->row[k], p->t, DRIFT * s->row[k].a);
        if (next == NULL)
            break;
        p = next;
        *clearest = fmax(*clearest, p->level / s->row[k].rms);
        level[k - i] = 20 * (log(p->level) - base) / M_LN10;
        last = k;
    }
    double mid = (double)(last - i) / 2;
    for (size_t k = 0; k <= last - i; k++) {
        sum += ((double)k - mid) * level[k];
        weight += ((double)k - mid) * ((double)k - mid);
    }
    return weight > 0 ? sum / weight * ROW_VOICES : 0;
}

static void
sort(ss_spikes *found)
{
    if (found->n > 1)
        qsort(found->spike, found->n, sizeof *found->spike, ss_ascending);
}

/* Add the spikes that no row shorter than row i shows: they are clear of those found so far, and of gaps that
 * reach the rows from which their slopes are found. */
static ss_status
add_row_spikes(spike_search *s, size_t i)
{
    const scale_row *r = &s->row[i], *next = &s->row[i + 1];
    ss_spikes *found = s->found;
    const size_t before = found->n;
    for (size_t k = 0; k < r->n; k++) {
        const peak *p = &r->peak[k], *beside = nearest(next, p->t, DRIFT * next->a);
        const size_t near = ss_list_from(found->spike, before, sizeof *found->spike, p->t);
        if (!(p->level > s->threshold * r->rms) || beside == NULL || !(beside->level > s->threshold * next->rms)
            || ss_gaps_near(s->source->gap, s->source->n_gaps, p->t, 2 * ROW_REACH * r->a)
            || (near < before && found->spike[near].t - p->t < NEAR * r->a)
            || (near > 0 && p->t - found->spike[near - 1].t < NEAR * r->a))
            continue;
        ss_spike *spike = ss_list_room(found->spike, &s->room, found->n, sizeof *spike);
        if (spike == NULL)
            return SS_ENOMEM;
        found->spike = spike;
        found->spike[found->n++] = (ss_spike){
            .t = p->t, .f = r->f, .level = 20 * log10(p->level / r->top), .snr = p->level / r->rms };
    }
    sort(found);
    return SS_OK;
}

static ss_status
search_rows(spike_search *s, double f)
{
    row_source *src = s->source;
    double length = (double)(src->n - 1) / src->rate, shortest = ROW_CENTER / (2 * M_PI * f);
    double octaves = log2(length / (2 * (sqrt(2) + NEAR) * shortest));
    if (!(octaves > 0))
        return SS_OK;           /* it is too short to have spikes */
    size_t rows = (size_t)(fmin(octaves, DEEPEST) * ROW_VOICES) + 1, last = rows - 1;
    const size_t reach = (size_t)(REACH * ROW_VOICES);
    s->threshold = ss_row_threshold(length, shortest, rows);
    s->row = calloc(rows, sizeof *s->row);
    if (s->row == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i <= last; i++) {
        double label = f * exp2(-(double)i / ROW_VOICES);
        ss_status st = ss_row_new(&s->row[i], src, label, s->found);
        if (st != SS_OK)
            return st;
        s->n_rows = i + 1;
        if (s->row[i].top > s->threshold * s->row[i].rms && last == rows - 1)
            last = i + reach < last ? i + reach : last;
        if (i > 0 && (st = add_row_spikes(s, i - 1)) != SS_OK)
            return st;
    }
    return SS_OK;
}

/* --- times and the whole ------------------------------------------------------------------- */

/* Their kinds by their slopes, and then their times, by a fit which sees no farther than the neighbours.  A pulse
 * of some length falls towards longer scales, but does not stand out at the shortest ones: it is smooth. */
static void
finish(spike_search *s)
{
    ss_spikes *found = s->found;
    found->threshold = s->threshold;
    for (size_t k = 0; k < found->n; k++) {
        ss_spike *spike = &found->spike[k];
        double clearest;
        size_t i = 0;
        while (s->row[i].f != spike->f)
            i++;
        const double slope = spike->slope = slope_of(s, i, nearest(&s->row[i], spike->t, INFINITY), &clearest);
        spike->kind = slope < -1.5 && i < ROW_VOICES ? SS_SPIKE_GLITCH
            : slope < -1.5 || slope >= 22 ? SS_SPIKE_BEND : slope < 4 ? SS_SPIKE_JUMP : SS_SPIKE_KINK;
        if (spike->kind != SS_SPIKE_BEND || i == 0)
            found->floor = fmin(found->floor, 20 * log10(s->threshold / clearest));
        found->f = fmax(found->f, spike->f);
    }
    for (size_t i = 0; i < found->n; i++) {
        ss_spike *spike = &found->spike[i];
        double rate = s->source->rate, a = ROW_CENTER / (2 * M_PI * spike->f) * rate, at = spike->t * rate;
        double lo = fmax(at - NEAR * a, 0), hi = fmin(at + NEAR * a, (double)(s->source->n - 1));
        if (!is_event(spike))
            continue;
        if (i > 0)
            lo = fmax(lo, found->spike[i - 1].t * rate + 1);
        if (i + 1 < found->n)
            hi = fmin(hi, found->spike[i + 1].t * rate - 1);
        spike->t = ss_breakpoint(s->source->x, (size_t)ceil(lo), (size_t)floor(hi), at, MOSTLY * a) / rate;
    }
    sort(found);
    found->conclusive = found->floor <= -EVENT_CLEAR;
    size_t bends = 0;
    for (size_t i = 0; i < found->n; i++)
        bends += found->spike[i].kind == SS_SPIKE_BEND;
    found->verdict = found->conclusive ? "counted"
        : found->n > 0 && bends == found->n ? "none to count, the signal is smooth" : "too much noise to count them";
}

ss_status
ss_spikes_find(ss_spikes **out, row_source *source)
{
    spike_search s = { .source = source };
    s.found = calloc(1, sizeof *s.found);
    if (s.found == NULL)
        return SS_ENOMEM;
    ss_status st = SS_OK;
    if (!source->constant)
        st = search_rows(&s, ROW_HIGHEST * source->rate / 2);
    ss_row_source_free(source);
    if (st == SS_OK)
        finish(&s);
    for (size_t i = 0; i < s.n_rows; i++)
        free(s.row[i].peak);
    free(s.row);
    if (st != SS_OK) {
        ss_spikes_free(s.found);
        return st;
    }
    *out = s.found;
    return SS_OK;
}

ss_spike_group
ss_spikes_within(const ss_spikes *found, double onset, double end, double range)
{
    ss_spike_group group = { 0, 0 };
    if (found == NULL || found->n == 0)
        return group;
    /* the largest error of the bluntest spike */
    double reach = ROW_CENTER / (2 * M_PI * found->f) * exp2(DEEPEST + 1);
    size_t i = ss_list_from(found->spike, found->n, sizeof *found->spike, onset - reach);
    for (; i < found->n && found->spike[i].t <= end + reach; i++) {
        const ss_spike *spike = &found->spike[i];
        double a = ROW_CENTER / (2 * M_PI * spike->f);
        if (!is_event(spike) || spike->level < -range || spike->t < onset - a || spike->t > end + a)
            continue;
        group.n++;
        group.inside += spike->t > onset + a && spike->t < end - a;
    }
    return group;
}

void
ss_spikes_free(ss_spikes *found)
{
    if (found == NULL)
        return;
    free(found->spike);
    free(found);
}
