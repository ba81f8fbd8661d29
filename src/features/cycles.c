/* cycles.c -- whether a signal repeats itself from cycle to cycle, and how regularly.
 *
 * The autocorrelation of the whole record (period.c) proposes a period.  Its error is not known, since
 * it does not see single cycles, and it has peaks also where nothing repeats.  So each cycle is
 * compared with the next: the lag at which they differ least is the period of the cycle (de Cheveigne
 * and Kawahara 2002).  This lag is exact where the signal is periodic, and the length of the window
 * does not bias it, as it biases the peak of a correlation.  The result is the median of the cycles'
 * frequencies, which ramps at the ends of a record do not move.
 *
 * Its standard error is the root of the sum of the squares of five errors:
 * - the scatter of the cycles over the root of the number of independent ones.  The scatter is the
 *   median deviation where there are many cycles; Student's factor is applied where there are few.
 *   Neighbours that are correlated by rho count as (1 - rho) / (1 + rho);
 * - the drift of the waveform.  A change from cycle to cycle that doubles over two cycles is not noise
 *   and may shift the lags of all cycles alike, by its rms over the rms of the derivative;
 * - the difference of the median of the lags from their mean: lags from jump to jump are whole samples;
 * - the largest difference of a half, a quarter or an eighth of the lag over two, four or eight cycles from
 *   the lag over one: a steady hum pulls every lag towards a multiple of its own period;
 * - the error of the interpolation between samples, from the vertices of two parabolas.
 *
 * A signal does not repeat itself
 * - if the median cycle explains less of the variance of the next than is asked for;
 * - if more than BROKEN of the cycles have no best lag within WIDTH of the period, or are not like the
 *   next cycle at that lag.  Such is a signal that rings anew behind each slip;
 * - if it rings once: the effective number of cycles, (sum E)^2 / sum E^2 of their energies E, is less
 *   than LASTING of them, or the energy decays or grows exponentially, by more than FADE in all and
 *   by more than e in QUICK cycles;
 * - if the energies of the cycles repeat: the signal is modulated, and more than a cycle repeats; or if
 *   their means repeat: the cycle is that of a hum or a ringing.
 *
 * Where jumps lie between samples, the peak of the autocorrelation may be at the length of several
 * cycles.  Then a part of that length is the period, if the signal repeats after the part as well as
 * it does after the whole when it is shifted by a sample. */
#include "features/cycles.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/gauss.h"
#include "base/versions.h"
#include "features/period.h"

#define WIDTH 0.2               /* a cycle's period may differ so much from the record's */
#define POINTS 256.0            /* a period while the lag is searched: finer ones are averaged */
#define AGREES 0.5              /* correlation with the next cycle: less is none */
#define SPOILT 2                /* cycles by one gap, which do not agree */
#define BROKEN 0.25             /* of the cycles: more do not agree where it rings anew behind slips */
#define ACTIVE 0.01             /* of the mean energy: weaker cycles are no cycles */
#define LASTING 0.25
#define FADE 10.0               /* in energy, from the first cycle to the last */
#define QUICK 16.0              /* cycles in which the energy falls by e: slower, they are alike */
#define STRAIGHT 0.95           /* r^2 of log energy on time that makes a decay */
#define DEPTH 0.1               /* of the scatter of energies or means: less is no modulation */
#define BETWEEN 0.5             /* correlation with the cycles between two swells: no more */
#define SLOWEST 512             /* cycles in a swell */
#define ROBUST 8                /* cycles, for their scatter to be read by the median deviation */
#define LATER 8.0               /* cycles */
#define PULLED 16               /* a hum pulls the lag by less than such a part of it */
#define PARTS 16                /* cycles that may pass for one */
#define FEWEST 16               /* cycles, for modulation to show */

enum { LATER_LAGS = 3 };        /* over 2, 4 and 8 cycles */

typedef struct cycle {
    unsigned parts;             /* bit p: so many parts of it repeat as well as it does itself, to a sample */
    double lag;                 /* in samples; NaN: no best one */
    double later[LATER_LAGS];   /* half of the lag over two cycles, a quarter of that over four ... */
    double likeness, symmetry;
    double mean;
    double energy, slopes;      /* mean squares of the signal, less its mean, and of its differences */
    double change, twice;       /* mean square differences from the next and from the one after */
    double bend;                /* of the two vertices, in samples */
} cycle;

typedef struct view {           /* the signal, as it is or averaged over q samples */
    const double *x;
    size_t n;
} view;

/* Sums over m samples and those some lag later, and over their products. */
typedef struct sums {
    double p, q, pp, qq, pq;
} sums;

/* In lanes, which do not wait for each other: of 8, gcc makes none. */
enum { LANES = 16 };

VERSIONS static sums
sums_of(const double *p, const double *q, size_t m)
{
    sums s = { 0, 0, 0, 0, 0 };
    double lane[5][LANES] = { { 0 } };
    size_t k = 0;
    for (; k + LANES <= m; k += LANES)
        for (size_t l = 0; l < LANES; l++) {
            double a = p[k + l], b = q[k + l];
            lane[0][l] += a, lane[1][l] += b;
            lane[2][l] += a * a, lane[3][l] += b * b, lane[4][l] += a * b;
        }
    for (size_t l = 0; l < LANES; l++) {
        s.p += lane[0][l], s.q += lane[1][l];
        s.pp += lane[2][l], s.qq += lane[3][l], s.pq += lane[4][l];
    }
    for (; k < m; k++) {
        s.p += p[k], s.q += q[k];
        s.pp += p[k] * p[k], s.qq += q[k] * q[k], s.pq += p[k] * q[k];
    }
    return s;
}

/* Their sum of products alone. */
VERSIONS static double
product(const double *p, const double *q, size_t m)
{
    double lane[LANES] = { 0 }, sum = 0;
    size_t k = 0;
    for (; k + LANES <= m; k += LANES)
        for (size_t l = 0; l < LANES; l++)
            lane[l] += p[k + l] * q[k + l];
    for (; k < m; k++)
        sum += p[k] * q[k];
    for (size_t l = 0; l < LANES && m >= LANES; l++)
        sum += lane[l];
    return sum;
}

/* Mean square difference of both less their means; their mean squares, into *a and *b, and the mean
 * product into *ab. */
static double
difference_of(const sums *s, size_t m, double *a, double *b, double *ab)
{
    double one = 1 / (double)m;
    *a = fmax(0, (s->pp - s->p * s->p * one) * one);
    *b = fmax(0, (s->qq - s->q * s->q * one) * one);
    *ab = (s->pq - s->p * s->q * one) * one;
    return fmax(0, *a + *b - 2 * *ab);
}

/* The same of the m samples from i on and those lag later. */
static double
difference(const view *v, size_t i, size_t lag, size_t m, double *a, double *b, double *ab)
{
    sums s = sums_of(v->x + i, v->x + i + lag, m);
    return difference_of(&s, m, a, b, ab);
}

static double
relative_of(const sums *s, size_t m)
{
    double a, b, ab, d = difference_of(s, m, &a, &b, &ab);
    return a + b > 0 ? d / (a + b) : 1;
}

static double
relative(const view *v, size_t i, size_t lag, size_t m)
{
    sums s = sums_of(v->x + i, v->x + i + lag, m);
    return relative_of(&s, m);
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
    const double *p = v->x + i, *q = p + lo;
    sums s = sums_of(p, q, m);
    for (size_t lag = lo;; lag++, q++) {
        double d = relative_of(&s, m);
        if (d < least) {
            least = d;
            best = lag;
        }
        if (lag == hi)
            break;
        s.q += q[m] - q[0], s.qq += q[m] * q[m] - q[0] * q[0];
        s.pq = product(p, q + 1, m);
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

/* The vertex about a lag of least difference. */
static double
lag_of_least(const view *v, size_t i, size_t m, size_t lag)
{
    return (double)lag + vertex(relative(v, i, lag - 1, m), relative(v, i, lag, m),
                                relative(v, i, lag + 1, m), 1);
}

/* The lag of least difference over twice as many cycles.  That of a hum may lie beside twice the lag, by up to
 * reach. */
static size_t
lag_over_twice(const view *v, size_t i, size_t m, size_t lag, size_t reach)
{
    size_t step = reach / 8 + 1, best = 2 * lag;
    double least = relative(v, i, best, m);
    for (size_t at = 2 * lag - reach; at <= 2 * lag + reach && i + at + m + 4 < v->n; at += step) {
        double d = relative(v, i, at, m);
        if (d < least) {
            least = d;
            best = at;
        }
    }
    return refine(v, i, m, best, step);
}

/* Lags over more cycles, as far as the record has them. */
static void
find_later(cycle *c, const view *v, size_t i, size_t m, size_t lag)
{
    size_t reach = lag / PULLED;
    for (int k = 0; k < LATER_LAGS && i + 2 * lag + m + 4 < v->n; k++) {
        lag = lag_over_twice(v, i, m, lag, reach);
        c->later[k] = lag_of_least(v, i, m, lag) / (2 << k);
    }
}

static cycle
measure(const view *fine, const view *coarse, size_t q, size_t first, double period)
{
    cycle c = { .lag = NAN, .later = { NAN, NAN, NAN } };
    size_t i = first / q, m = (size_t)(period / (double)q), whole = (size_t)period;
    size_t lo = (size_t)(period * (1 - WIDTH) / (double)q);
    size_t hi = (size_t)(period * (1 + WIDTH) / (double)q) + 1;
    double a, b, ab, unit;
    difference(fine, first, whole, whole, &c.energy, &b, &ab);
    for (size_t k = first; k < first + whole; k++)
        c.mean += fine->x[k] / (double)whole;
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
    for (size_t p = 2; p <= PARTS && lag >= 4 * p; p++)
        if (fmin(relative(fine, first, lag / p, whole), relative(fine, first, lag / p + 1, whole))
            <= fmin(d[1], d[3]))
            c.parts |= 1u << p;
    double near = vertex(d[1], d[2], d[3], 1), far = vertex(d[0], d[2], d[4], 2);
    c.lag = (double)lag + near;
    find_later(&c, fine, first, whole, lag);
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

/* Has the cycle energy, and a lag? */
static int
is_known(const cycle *c, double least)
{
    return c->energy > least && !isnan(c->lag);
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

/* Does a number of theirs, v, repeat itself some cycles later, when it has been otherwise in between, by a
 * correlation of more than like?  Not if its scatter is under DEPTH of a scale. */
static int
repeats(const double *v, size_t n, double scale, double like)
{
    const view of = { v, n };
    double power, other, product, least = 1;
    difference(&of, 0, 0, n, &power, &other, &product);
    if (n < FEWEST || !(sqrt(power) > DEPTH * scale))
        return 0;
    for (size_t lag = 1; lag <= n / 2 && lag <= SLOWEST; lag++) {
        double r = correlation(&of, 0, lag, n - lag);
        if (least < BETWEEN && r > like)
            return 1;
        least = fmin(least, r);
    }
    return 0;
}

/* Do the energies of the cycles repeat, from one swell to the next? */
static int
is_modulated(const cycle *c, size_t n, double *v)
{
    double mean = 0;
    for (size_t i = 0; i < n; i++)
        mean += (v[i] = c[i].energy) / (double)n;
    return repeats(v, n, mean, CYCLES_LIKE);
}

/* Do their means repeat?  Then they are cycles of a hum, or of ringing, in a longer one. */
static int
is_in_longer(const cycle *c, size_t n, double *v)
{
    double power = 0;
    for (size_t i = 0; i < n; i++) {
        v[i] = c[i].mean;
        power += c[i].energy / (double)n;
    }
    return repeats(v, n, sqrt(power), CYCLES_ALIKE);
}

/* Into how many parts that repeat as well as it does itself, if that is shifted by a sample, a cycle
 * falls. */
static size_t
parts_of(const cycle *c, size_t n, double least)
{
    for (size_t p = PARTS; p > 1; p--) {
        size_t so = 0, all = 0;
        for (size_t i = 0; i < n; i++)
            if (is_known(&c[i], least)) {
                all++;
                so += c[i].parts >> p & 1;
            }
        if (all > 0 && 4 * so >= 3 * all)
            return p;
    }
    return 1;
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

/* By how much the lag over one cycle and those over more disagree, if half of the cycles have these. */
static double
pull_of(const cycle *c, size_t n, double least, double *v)
{
    double most = 0;
    for (int k = 0; k < LATER_LAGS; k++) {
        size_t used = 0, known = 0;
        for (size_t i = 0; i < n; i++) {
            known += (size_t)is_known(&c[i], least);
            if (is_known(&c[i], least) && !isnan(c[i].later[k]))
                v[used++] = c[i].later[k] - c[i].lag;
        }
        if (used > 0 && 2 * used >= known)
            most = fmax(most, fabs(gsl_stats_median(v, 1, used)));
    }
    return most;
}

/* Median and standard error of the frequencies of the cycles with energy. */
static void
summarise(const cycle *c, size_t n, double least, double *v, ss_cycles *out)
{
    size_t used = 0, drifting = 0;
    double mean = 0, variance = 0, drift = 0, bend = 0, lags = 0;
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least)) {
            mean += v[used++] = 1 / c[i].lag;
            bend += c[i].bend, lags += c[i].lag;
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
    double pull = pull_of(c, n, least, v), skew = fabs(lags / (double)used - 1 / f);
    double scatter = student * sqrt(M_PI / 2 * variance / free_ones);
    out->frequency = (ss_value){ f, hypot(scatter, hypot(hypot(pull, skew), hypot(drift, bend)) * f * f) };
    out->period = (ss_value){ 1 / f, out->frequency.error / (f * f) };
}

/* How many cycles there are, how alike they are, and the reason if they are none. */
static void
judge(const cycle *c, size_t n, double least, double *v, ss_cycles *out)
{
    size_t used = 0, alike = 0;
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least))
            v[used++] = c[i].symmetry;
    out->symmetry = used > 0 ? median_of(v, used) : 0;
    used = 0;
    for (size_t i = 0; i < n; i++) {
        out->n += c[i].energy > least;
        alike += is_known(&c[i], least) && c[i].likeness > AGREES;
        if (is_known(&c[i], least))
            v[used++] = c[i].likeness;
    }
    out->likeness = used > 0 ? median_of(v, used) : 0;
    if (out->n < 2)
        out->why = "under three cycles of what may repeat are in the record";
    else if ((double)(out->n - alike) > fmax(SPOILT, BROKEN * (double)out->n) || used < 2
             || !(out->likeness >= CYCLES_ALIKE))
        out->why = "no cycle resembles the next one";
    else if (lasting(c, n) < LASTING || fades(c, n, least))
        out->why = "it rings once, or sounds in a small part of the record only";
    else if (is_in_longer(c, n, v))
        out->why = "what hums or rings repeats sooner than the rest";
    else if ((out->modulated = is_modulated(c, n, v)) != 0)
        out->why = "its cycles swell and fade in turn: it is modulated";
}

/* What the n cycles of x have in common, which begin step samples apart. */
static void
describe(const cycle *c, size_t n, const double *x, size_t step, double least, double *v, ss_cycles *out)
{
    judge(c, n, least, v, out);
    if (out->why != NULL)
        return;
    summarise(c, n, least, v, out);
    size_t first = 0, last = n - 1;
    while (!(c[first].energy > least))
        first++;
    while (!(c[last].energy > least))
        last--;
    out->overtones = overtones(x + (first + last) / 2 * step, step, out->period.value);
}

/* *parts: the cycles are so many, of that part of the period. */
static ss_status
find_at(const double *x, size_t n, double period, ss_cycles *out, size_t *parts)
{
    size_t q = period > POINTS ? (size_t)(period / POINTS) : 1, step = (size_t)period, found = 0;
    size_t reach = step + (size_t)(period * (1 + WIDTH)) + 2 * q + 4, most = n / step + 1;
    double *averaged = calloc(n / q + 1, sizeof *averaged), *v = malloc(most * sizeof *v);
    cycle *c = malloc(most * sizeof *c);
    *out = (ss_cycles){ .period = { NAN, NAN }, .frequency = { NAN, NAN } };
    if (averaged != NULL && v != NULL && c != NULL) {
        const view fine = { x, n }, coarse = { averaged, n / q };
        double least = 0;
        for (size_t i = 0; i < n / q * q; i++)
            averaged[i / q] += x[i] / (double)q;
        for (size_t i = 0; i + reach < n; i += step) {
            c[found] = measure(&fine, &coarse, q, i, period);
            least += c[found++].energy;
        }
        least *= ACTIVE / (double)found;
        *parts = parts_of(c, found, least);
        describe(c, found, x, step, least, v, out);
    }
    free(averaged);
    free(v);
    free(c);
    return averaged != NULL && v != NULL && c != NULL ? SS_OK : SS_ENOMEM;
}

/* The correlation of the record with itself LATER cycles later, or the most in a quarter of it. */
static double
lasting_of(const double *x, size_t n, double period)
{
    const view of = { x, n };
    double cycles = fmax(1, fmin(LATER, floor(0.25 * (double)n / period)));
    size_t lag = (size_t)(cycles * period + 0.5);
    return lag < n ? correlation(&of, 0, lag, n - lag) : 0;
}

ss_status
ss_cycles_find(const double *x, size_t n, ss_cycles *out)
{
    ss_value start;
    size_t parts = 1;
    *out = (ss_cycles){ .period = { NAN, NAN }, .frequency = { NAN, NAN } };
    ss_status st = ss_period_find(x, n, &start);
    if (st != SS_OK)
        return st;
    if (isnan(start.value) || start.value < 4) {
        out->why = "no cycle resembles the next one";
        return SS_OK;
    }
    do {
        start.value /= (double)parts;
        st = find_at(x, n, start.value, out, &parts);
    } while (st == SS_OK && parts > 1);
    if (!isnan(out->period.value))
        out->lasting = lasting_of(x, n, out->period.value);
    return st;
}
