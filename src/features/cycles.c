/* cycles.c -- whether a signal repeats itself from cycle to cycle, and how regularly.
 *
 * The autocorrelation of the whole record (period.c) proposes a period; it has no honest error, as
 * it does not see the single cycles, and it also has peaks where nothing repeats.  So each cycle
 * is compared with the next: the lag at which their difference is least (de Cheveigne and Kawahara
 * 2002) is the period of that cycle.  Unlike the peak of a correlation it has no bias from the
 * length of the window, and is exact where the signal is periodic.  The median of the cycles'
 * frequencies is the answer, so that ramps at the ends of a record do not move it.
 *
 * Its standard error is a sum in quadrature of three:
 * - the scatter of the cycles, by its median where they are many, over the root of the number of
 *   independent ones: neighbours that are correlated by rho count (1 - rho) / (1 + rho); Student's
 *   factor is applied where they are few;
 * - the drift of the waveform: a change from cycle to cycle that doubles over two cycles is no noise.
 *   It may shift the lag of every cycle alike, by its rms over the rms of the derivative;
 * - the error of the interpolation between samples, from the vertices of two parabolas.
 *
 * A signal does not repeat itself
 * - if the median cycle explains less of the variance of the next than asked for;
 * - if half of the cycles have no best lag within WIDTH of the period;
 * - if the energy of the cycles has an effective number (sum E)^2 / sum E^2 of less than LASTING of
 *   them, or decays or grows exponentially, by more than FADE and e in QUICK cycles: it rings once;
 * - if the energies of the cycles themselves repeat: it is modulated, and the cycle is not what
 *   repeats. */
#include "features/cycles.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/gauss.h"
#include "features/period.h"

#define WIDTH 0.2               /* a cycle's period may differ so much from the record's */
#define POINTS 256.0            /* a period while the lag is searched: finer ones are averaged */
#define ACTIVE 0.01             /* of the mean energy: weaker cycles are no cycles */
#define LASTING 0.25
#define FADE 10.0               /* in energy, from the first cycle to the last */
#define QUICK 16.0              /* cycles in which the energy falls by e: slower, they are alike */
#define STRAIGHT 0.95           /* r^2 of log energy on time that makes a decay */
#define DEPTH 0.1               /* of the energies' scatter re their mean: less is no modulation */
#define ROBUST 8                /* cycles, for their scatter to be read by the median deviation */
#define FEWEST 16               /* cycles, for modulation to show */

typedef struct cycle {
    double lag;                 /* in samples; NaN: no best one */
    double likeness, symmetry;
    double energy, slopes;      /* mean squares of the signal and of its differences */
    double change, twice;       /* mean square differences from the next and from the one after */
    double bend;                /* of the two vertices, in samples */
} cycle;

typedef struct view {           /* the signal, as it is or averaged over q samples */
    const double *x;
    size_t n;
} view;

/* Mean square difference of the m samples from i on and those lag later, less their means; the mean
 * squares of both, into *a and *b, and the mean product into *ab. */
static double
difference(const view *v, size_t i, size_t lag, size_t m, double *a, double *b, double *ab)
{
    const double *p = v->x + i, *q = p + lag;
    double sp = 0, sq = 0, pp = 0, qq = 0, pq = 0, one = 1 / (double)m;
    for (size_t k = 0; k < m; k++) {
        sp += p[k], sq += q[k];
        pp += p[k] * p[k], qq += q[k] * q[k], pq += p[k] * q[k];
    }
    *a = fmax(0, (pp - sp * sp * one) * one);
    *b = fmax(0, (qq - sq * sq * one) * one);
    *ab = (pq - sp * sq * one) * one;
    return fmax(0, *a + *b - 2 * *ab);
}

static double
relative(const view *v, size_t i, size_t lag, size_t m)
{
    double a, b, ab, d = difference(v, i, lag, m, &a, &b, &ab);
    return a + b > 0 ? d / (a + b) : 1;
}

/* The vertex of the parabola through the values at -step, 0, step. */
static double
vertex(double before, double at, double behind, double step)
{
    double bend = before - 2 * at + behind;
    return bend > 0 ? fmax(-1, fmin(1, 0.5 * (before - behind) / bend)) * step : 0;
}

/* The lag of least difference in [lo, hi], 0 where that is at an end. */
static size_t
best_lag(const view *v, size_t i, size_t m, size_t lo, size_t hi)
{
    size_t best = lo;
    double least = INFINITY;
    for (size_t lag = lo; lag <= hi; lag++) {
        double d = relative(v, i, lag, m);
        if (d < least) {
            least = d;
            best = lag;
        }
    }
    return best > lo && best < hi ? best : 0;
}

/* The lag of least difference near one that is known to within reach, by halving steps. */
static size_t
refine(const view *v, size_t i, size_t m, size_t lag, size_t reach)
{
    double least = relative(v, i, lag, m);
    for (size_t step = reach; step > 0; step /= 2)
        for (int sign = -1; sign <= 1; sign += 2)
            for (;;) {
                size_t next = sign < 0 ? lag - step : lag + step;
                if (next < 2 || i + next + m + 2 > v->n)
                    break;
                double d = relative(v, i, next, m);
                if (!(d < least))
                    break;
                least = d;
                lag = next;
            }
    return lag;
}

/* Correlation of the m samples from i on with those lag later. */
static double
correlation(const view *v, size_t i, size_t lag, size_t m)
{
    double a, b, ab;
    difference(v, i, lag, m, &a, &b, &ab);
    return a > 0 && b > 0 ? ab / sqrt(a * b) : 0;
}

/* The correlation at the vertex about a lag of an averaged view. */
static double
peak_correlation(const view *v, size_t i, size_t lag, size_t m)
{
    double before = correlation(v, i, lag - 1, m), at = correlation(v, i, lag, m);
    double behind = correlation(v, i, lag + 1, m);
    double s = vertex(-before, -at, -behind, 1);
    return fmin(1, at - 0.25 * (before - behind) * s);
}

static cycle
measure(const view *fine, const view *coarse, size_t q, size_t first, double period)
{
    cycle c = { .lag = NAN };
    size_t i = first / q, m = (size_t)(period / (double)q), whole = (size_t)period;
    size_t lo = (size_t)(period * (1 - WIDTH) / (double)q);
    size_t hi = (size_t)(period * (1 + WIDTH) / (double)q) + 1;
    double a, b, ab, unit;
    difference(fine, first, whole, whole, &c.energy, &b, &ab);
    size_t rough = best_lag(coarse, i, m, lo > 2 ? lo : 2, hi);
    if (rough == 0)
        return c;
    c.likeness = peak_correlation(coarse, i, rough, m);
    c.symmetry = correlation(coarse, i, rough / 2, m);
    size_t lag = refine(fine, first, whole, rough * q, q), likely = (size_t)(period + 0.5);
    if (first + likely + whole + 2 <= fine->n) {        /* averages do not see what rings in them */
        likely = refine(fine, first, whole, likely, q);
        if (relative(fine, first, likely, whole) < relative(fine, first, lag, whole))
            lag = likely;
    }
    if (lag < 3 || first + lag + whole + 2 > fine->n)
        return c;
    double d[5];
    for (size_t k = 0; k < 5; k++)
        d[k] = relative(fine, first, lag + k - 2, whole);
    double near = vertex(d[1], d[2], d[3], 1), far = vertex(d[0], d[2], d[4], 2);
    c.lag = (double)lag + near;
    c.bend = fabs(near - far) / 3;
    c.change = difference(fine, first, lag, whole, &a, &b, &ab);
    c.slopes = difference(fine, first, 1, whole, &a, &b, &unit);
    c.twice = first + 2 * lag + whole < fine->n ? difference(fine, first, 2 * lag, whole, &a, &b, &ab)
        : NAN;
    return c;
}

/* --- what all cycles say ------------------------------------------------------------------- */

static double
median_of(double *v, size_t n)
{
    return gsl_stats_select(v, 1, n, n / 2);
}

/* The effective share of the cycles. */
static double
lasting(const cycle *c, size_t n)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < n; i++) {
        sum += c[i].energy;
        squares += c[i].energy * c[i].energy;
    }
    return sum * sum / (squares * (double)n);
}

/* Do the cycles that hold energy decay, or grow, along a straight line in log energy? */
static int
fades(const cycle *c, size_t n, double least)
{
    double m = 0, t = 0, y = 0, tt = 0, yy = 0, ty = 0;
    for (size_t i = 0; i < n; i++) {
        if (!(c[i].energy > least))
            continue;
        double e = log(c[i].energy), at = (double)i;
        m++, t += at, y += e, tt += at * at, yy += e * e, ty += at * e;
    }
    double vt = tt - t * t / m, vy = yy - y * y / m, cov = ty - t * y / m;
    double rate = vt > 0 ? fabs(cov / vt) : 0;
    return m >= 4 && rate * QUICK > 1 && rate * m > log(FADE) && cov * cov > STRAIGHT * vt * vy;
}

/* Do the energies of the cycles repeat, from one swell to the next? */
static ss_status
modulated(const cycle *c, size_t n, double *v, int *is)
{
    double mean = 0, scatter = 0;
    ss_value swell;
    *is = 0;
    for (size_t i = 0; i < n; i++)
        mean += (v[i] = c[i].energy) / (double)n;
    for (size_t i = 0; i < n; i++)
        scatter += (v[i] - mean) * (v[i] - mean) / (double)n;
    if (n < FEWEST || !(sqrt(scatter) > DEPTH * mean))
        return SS_OK;
    ss_status st = ss_period_find(v, n, &swell);
    if (st != SS_OK || isnan(swell.value) || 3 * swell.value > (double)n)
        return st;
    const view energies = { v, n };
    size_t lag = (size_t)(swell.value + 0.5), used = 0;
    double *r = malloc(n * sizeof *r);
    if (r == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i + 2 * lag <= n; i += lag)
        r[used++] = correlation(&energies, i, lag, lag);
    *is = lag >= 4 && used >= 2 && median_of(r, used) > CYCLES_LIKE;
    free(r);
    return SS_OK;
}

/* The share of the variance of a period that a sinusoid of that period leaves. */
static double
overtones(const double *x, size_t n, double period)
{
    double c = 0, s = 0, mean = 0, power = 0;
    for (size_t i = 0; i < n; i++)
        mean += x[i] / (double)n;
    for (size_t i = 0; i < n; i++) {
        double turn = 2 * M_PI * (double)i / period;
        c += (x[i] - mean) * cos(turn), s += (x[i] - mean) * sin(turn);
        power += (x[i] - mean) * (x[i] - mean);
    }
    return power > 0 ? fmax(0, 1 - 2 * (c * c + s * s) / ((double)n * power)) : 0;
}

/* Correlation of neighbours; 0 where there are too few of them. */
static double
neighbours(const double *v, size_t n, double mean, double variance)
{
    double sum = 0;
    for (size_t i = 1; i < n; i++)
        sum += (v[i] - mean) * (v[i - 1] - mean);
    return n < 5 || !(variance > 0) ? 0
        : fmax(0, fmin(0.9, sum / ((double)(n - 1) * variance)));
}

/* Has the cycle energy, and a lag? */
static int
is_known(const cycle *c, double least)
{
    return c->energy > least && !isnan(c->lag);
}

/* Median and standard error of the frequencies of the cycles with energy. */
static void
summarise(const cycle *c, size_t n, double least, double *v, ss_cycles *out)
{
    size_t used = 0, drifting = 0;
    double mean = 0, variance = 0, drift = 0, bend = 0;
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least)) {
            mean += v[used++] = 1 / c[i].lag;
            bend += c[i].bend;
        }
    mean /= (double)used, bend /= (double)used;
    for (size_t i = 0; i < used; i++)
        variance += (v[i] - mean) * (v[i] - mean) / (double)(used - 1);
    double rho = neighbours(v, used, mean, variance), f = gsl_stats_median(v, 1, used);
    double free_ones = fmax(1, (double)used * (1 - rho) / (1 + rho));
    double student = gsl_cdf_tdist_Pinv(0.8413, fmax(1, fmin((double)used - 1, free_ones)));
    if (used >= ROBUST) {
        for (size_t i = 0; i < used; i++)
            v[i] = fabs(v[i] - f);
        variance = pow(median_of(v, used) / GAUSS_MEDIAN, 2);
    }
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least) && !isnan(c[i].twice) && c[i].slopes > 0)
            v[drifting++] = (c[i].twice - c[i].change) / 3 / c[i].slopes;
    if (drifting > 0)
        drift = sqrt(fmax(0, median_of(v, drifting)));
    double scatter = student * sqrt(M_PI / 2 * variance / free_ones);
    out->frequency = (ss_value){ f, hypot(scatter, hypot(drift, bend) * f * f) };
    out->period = (ss_value){ 1 / f, out->frequency.error / (f * f) };
}

/* How many cycles there are, how alike they are, and the reason if they are none. */
static ss_status
judge(const cycle *c, size_t n, double least, double *v, ss_cycles *out)
{
    size_t used = 0;
    ss_status st = SS_OK;
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least))
            v[used++] = c[i].symmetry;
    out->symmetry = used > 0 ? median_of(v, used) : 0;
    used = 0;
    for (size_t i = 0; i < n; i++) {
        out->n += c[i].energy > least;
        if (is_known(&c[i], least))
            v[used++] = c[i].likeness;
    }
    out->likeness = used > 0 ? median_of(v, used) : 0;
    if (out->n < 2)
        out->why = "under three cycles of what may repeat are in the record";
    else if (2 * used < out->n || used < 2 || !(out->likeness >= CYCLES_ALIKE))
        out->why = "no cycle resembles the next one";
    else if (lasting(c, n) < LASTING || fades(c, n, least))
        out->why = "it rings once, or sounds in a small part of the record only";
    else if ((st = modulated(c, n, v, &out->modulated)) == SS_OK && out->modulated)
        out->why = "its cycles swell and fade in turn: it is modulated";
    return st;
}

/* What the n cycles of x have in common, which begin step samples apart. */
static ss_status
describe(const cycle *c, size_t n, const double *x, size_t step, double *v, ss_cycles *out)
{
    double mean = 0;
    for (size_t i = 0; i < n; i++)
        mean += c[i].energy / (double)n;
    const double least = ACTIVE * mean;
    ss_status st = judge(c, n, least, v, out);
    if (st != SS_OK || out->why != NULL)
        return st;
    summarise(c, n, least, v, out);
    size_t first = 0, last = n - 1;
    while (!(c[first].energy > least))
        first++;
    while (!(c[last].energy > least))
        last--;
    out->overtones = overtones(x + (first + last) / 2 * step, step, out->period.value);
    return SS_OK;
}

static ss_status
find_at(const double *x, size_t n, double period, ss_cycles *out)
{
    size_t q = period > POINTS ? (size_t)(period / POINTS) : 1, step = (size_t)period, found = 0;
    size_t reach = step + (size_t)(period * (1 + WIDTH)) + 2 * q + 4, most = n / step + 1;
    double *averaged = calloc(n / q + 1, sizeof *averaged), *v = malloc(most * sizeof *v);
    cycle *c = malloc(most * sizeof *c);
    ss_status st = SS_ENOMEM;
    if (averaged != NULL && v != NULL && c != NULL) {
        const view fine = { x, n }, coarse = { averaged, n / q };
        for (size_t i = 0; i < n / q * q; i++)
            averaged[i / q] += x[i] / (double)q;
        for (size_t i = 0; i + reach < n; i += step)
            c[found++] = measure(&fine, &coarse, q, i, period);
        st = describe(c, found, x, step, v, out);
    }
    free(averaged);
    free(v);
    free(c);
    return st;
}

ss_status
ss_cycles_find(const double *x, size_t n, ss_cycles *out)
{
    ss_value start;
    *out = (ss_cycles){ .period = { NAN, NAN }, .frequency = { NAN, NAN } };
    ss_status st = ss_period_find(x, n, &start);
    if (st != SS_OK)
        return st;
    if (isnan(start.value) || start.value < 4) {
        out->why = "no cycle resembles the next one";
        return SS_OK;
    }
    return find_at(x, n, start.value, out);
}
