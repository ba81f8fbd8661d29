/* spikes.c -- jumps, kinks and glitches from the maxima of |W| along the shortest scales.
 *
 * Rows of |W|, one a scale, are computed from the shortest scale on.  A maximum along a row that is
 * above the threshold, has one above the threshold beside it in the next row, and lies clear of all
 * spikes found at shorter scales is a spike.  Once a row shows one, the rows of REACH octaves more
 * are searched: weaker spikes and blunter ones appear there; a maximum that appears only later is no
 * longer sharp.
 */
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
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

/* --- a two-sided fit with a free break -------------------------------------------------------- */

/* A cubic is fitted to the samples on each side of the break.  At a jump the two cubics are free;
 * at a kink they must meet.  Let free cubics leave the sum of squares r.  If they differ by d at
 * the break, where their variances are u and v, cubics that meet leave d^2 / (u + v) more.  The
 * break is where the sum is least.  All places of a jump between two samples give the same
 * samples, so the middle is chosen. */
enum { DEGREE = 3, SIDE = DEGREE + 2, SAMPLES = 128 };    /* SIDE: the fewest samples on either side */

/* A cubic through samples of one side, in the monic polynomials that are orthogonal over them. */
typedef struct side {
    double middle;              /* of the samples, from the first sample of the piece on */
    size_t n;
    double c[DEGREE + 1], norm[DEGREE + 1];     /* coefficients; sums of squares */
    double left;                /* sum of squares of its residuals */
} side;

typedef struct piece {
    double x[SAMPLES];          /* samples first ... first + n - 1, brought into [0, 1] */
    size_t n;
    double first;
    side side[SAMPLES][2];      /* of each number of samples left of the break; n: 0 if not fitted yet */
} piece;

/* The polynomials at s from the middle of n equidistant points (Gram's). */
static void
polynomials(size_t n, double s, double p[DEGREE + 1])
{
    double nn = (double)n * (double)n;
    p[0] = 1;
    p[1] = s;
    p[2] = s * p[1] - (nn - 1) / 12 * p[0];
    p[3] = s * p[2] - (nn - 4) / 15 * p[1];
}

/* The cubic through n samples, more than DEGREE + 1, from first on. */
static side
fit_side(const double *x, size_t first, size_t n)
{
    side f = { .middle = (double)first + 0.5 * (double)(n - 1), .n = n };
    double p[DEGREE + 1], nn = (double)n * (double)n, norm = (double)n;
    for (size_t i = first; i < first + n; i++) {
        polynomials(n, (double)i - f.middle, p);
        for (size_t k = 0; k <= DEGREE; k++)
            f.c[k] += p[k] * x[i];
    }
    for (int k = 0; k <= DEGREE; k++) {
        norm *= k > 0 ? k * k * (nn - k * k) / (4 * (4 * k * k - 1)) : 1;
        f.norm[k] = norm;
        f.c[k] /= norm;
    }
    for (size_t i = first; i < first + n; i++) {
        polynomials(n, (double)i - f.middle, p);
        double r = x[i] - f.c[0] - f.c[1] * p[1] - f.c[2] * p[2] - f.c[3] * p[3];
        f.left += r * r;
    }
    return f;
}

/* The value of the cubic at t, and the variance of that for samples of variance 1. */
static double
value_at(const side *f, double t, double *variance)
{
    double p[DEGREE + 1], value = 0;
    polynomials(f->n, t - f->middle, p);
    *variance = 0;
    for (size_t k = 0; k <= DEGREE; k++) {
        value += f->c[k] * p[k];
        *variance += p[k] * p[k] / f->norm[k];
    }
    return value;
}

/* The sum of squares that a kink or a jump at a place leaves. */
static double
residual(piece *p, double at, int is_kink)
{
    double u, v;
    size_t split = (size_t)ceil(at - p->first);
    side *before = &p->side[split][0], *behind = &p->side[split][1];
    if (before->n == 0) {
        *before = fit_side(p->x, 0, split);
        *behind = fit_side(p->x, split, p->n - split);
    }
    double sum = before->left + behind->left;
    if (!is_kink)
        return sum;
    double d = value_at(before, at - p->first, &u) - value_at(behind, at - p->first, &v);
    return sum + d * d / (u + v);
}

/* The place in [lo, hi] where the residual is least: of a kink by scans of finer and finer steps, from a quarter
 * of a sample on; of a jump, whose place is half way between two samples, by one scan. */
static double
least(piece *p, int is_kink, double lo, double hi, double *sum)
{
    double best = is_kink ? lo : floor(lo) + 0.5, from = best, to = hi;
    *sum = INFINITY;
    for (double step = is_kink ? 0.25 : 1; step > 1e-6; step = is_kink ? step / 4 : 0) {
        for (double t = from; t <= to; t += step) {
            double s = residual(p, t, is_kink);
            if (s < *sum) {
                *sum = s;
                best = t;
            }
        }
        from = fmax(lo, best - step), to = fmin(hi, best + step);
    }
    return best;
}

/* The time, in samples, at which x is best explained by two cubics that meet there, in the samples
 * [first, last]; at is where it is thought to be, and reach how far it may be from there.  The
 * cubics may differ in value (a jump) where that explains so much more that it is worth its
 * parameter.  Where SIDE samples on either side are not there, at is the answer. */
static double
breakpoint(const double *x, size_t first, size_t last, double at, double reach)
{
    double lo = fmax(at - reach, (double)first + SIDE - 0.5), kink, jump, low, high;
    double hi = fmin(at + reach, (double)last - SIDE + 0.5);
    piece p = { .n = last - first + 1, .first = (double)first };
    if (p.n > SAMPLES || !(lo <= hi))
        return at;
    gsl_stats_minmax(&low, &high, x + first, 1, p.n);
    if (!(high > low))
        return at;
    for (size_t i = 0; i < p.n; i++)
        p.x[i] = (x[first + i] - low) / (high - low);
    double at_kink = least(&p, 1, lo, hi, &kink), at_jump = least(&p, 0, lo, hi, &jump);
    double rounding = (double)p.n * PRECISION * PRECISION;
    return (double)p.n * log((kink + rounding) / (jump + rounding)) > log((double)p.n) ? at_jump : at_kink;
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
        spike->t = breakpoint(s->source->x, (size_t)ceil(lo), (size_t)floor(hi), at, MOSTLY * a) / rate;
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

size_t
ss_spikes_within(const ss_spikes *found, double onset, double end, double range)
{
    size_t n = 0;
    if (found == NULL || found->n == 0)
        return 0;
    /* the largest error of the bluntest spike */
    double reach = ROW_CENTER / (2 * M_PI * found->f) * exp2(DEEPEST + 1);
    size_t i = ss_list_from(found->spike, found->n, sizeof *found->spike, onset - reach);
    for (; i < found->n && found->spike[i].t <= end + reach; i++) {
        const ss_spike *spike = &found->spike[i];
        double a = ROW_CENTER / (2 * M_PI * spike->f);
        n += is_event(spike) && spike->level >= -range && spike->t >= onset - a && spike->t <= end + a;
    }
    return n;
}

void
ss_spikes_free(ss_spikes *found)
{
    if (found == NULL)
        return;
    free(found->spike);
    free(found);
}
