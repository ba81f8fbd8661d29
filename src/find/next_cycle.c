/* next_cycle.c -- how a cycle of a signal differs from the next one, and at which lag it differs least.
 *
 * The lag is searched in averaged samples first, then refined in all of them.  A parabola finds it between
 * samples. */
#include "find/next_cycle.h"

#include <math.h>
#include "base/versions.h"

#define PULLED 16               /* a hum pulls the lag by less than one part in so many */

/* Sums over m samples p, over those some lag later, q, and over their products. */
typedef struct sums {
    double p, q, pp, qq, pq;
} sums;

/* Sums are made in lanes, which do not wait for each other.  (gcc uses no vectors for 8 lanes.) */
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

/* The sum of products alone. */
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

/* See ss_view_difference. */
static double
difference_of(const sums *s, size_t m, double *a, double *b, double *ab)
{
    double one = 1 / (double)m;
    *a = fmax(0, (s->pp - s->p * s->p * one) * one);
    *b = fmax(0, (s->qq - s->q * s->q * one) * one);
    *ab = (s->pq - s->p * s->q * one) * one;
    return fmax(0, *a + *b - 2 * *ab);
}

double
ss_view_difference(const view *v, size_t i, size_t lag, size_t m, double *a, double *b, double *ab)
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

/* The lag of least difference in [lo, hi]; 0: it is at an end. */
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

/* The lag of least difference near one that is known to within reach, found with steps that are halved. */
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

double
ss_view_correlation(const view *v, size_t i, size_t lag, size_t m)
{
    double a, b, ab;
    ss_view_difference(v, i, lag, m, &a, &b, &ab);
    return a > 0 && b > 0 ? ab / sqrt(a * b) : 0;
}

/* The correlation at the vertex about a lag of an averaged view. */
static double
peak_correlation(const view *v, size_t i, size_t lag, size_t m)
{
    double before = ss_view_correlation(v, i, lag - 1, m), at = ss_view_correlation(v, i, lag, m);
    double behind = ss_view_correlation(v, i, lag + 1, m);
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

/* The lag of least difference over twice as many cycles.  A hum may pull it from twice the lag by up to
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

/* Find the lags over more cycles, as far as the record has these cycles. */
static void
find_later(next_cycle *c, const view *v, size_t i, size_t m, size_t lag)
{
    size_t reach = lag / PULLED;
    for (int k = 0; k < CYCLE_LAGS && i + 2 * lag + m + 4 < v->n; k++) {
        lag = lag_over_twice(v, i, m, lag, reach);
        c->later[k] = lag_of_least(v, i, m, lag) / (2 << k);
    }
}

next_cycle
ss_next_cycle(const view *fine, const view *coarse, size_t q, size_t first, double period)
{
    next_cycle c = { .lag = NAN, .later = { NAN, NAN, NAN } };
    size_t i = first / q, m = (size_t)(period / (double)q), whole = (size_t)period;
    size_t lo = (size_t)(period * (1 - CYCLE_WIDTH) / (double)q);
    size_t hi = (size_t)(period * (1 + CYCLE_WIDTH) / (double)q) + 1;
    double a, b, ab, unit;
    ss_view_difference(fine, first, whole, whole, &c.energy, &b, &ab);
    for (size_t k = first; k < first + whole; k++)
        c.mean += fine->x[k] / (double)whole;
    size_t rough = best_lag(coarse, i, m, lo > 2 ? lo : 2, hi);
    if (rough == 0)
        return c;
    c.likeness = peak_correlation(coarse, i, rough, m);
    c.symmetry = ss_view_correlation(coarse, i, rough / 2, m);
    size_t lag = refine(fine, first, whole, rough * q, q), likely = (size_t)(period + 0.5);
    if (first + likely + whole + 2 <= fine->n) {        /* averages hide what rings within them */
        likely = refine(fine, first, whole, likely, q);
        if (relative(fine, first, likely, whole) < relative(fine, first, lag, whole))
            lag = likely;
    }
    if (lag < 3 || first + lag + whole + 2 > fine->n)
        return c;
    double d[5];
    for (size_t k = 0; k < 5; k++)
        d[k] = relative(fine, first, lag + k - 2, whole);
    for (size_t p = 2; p <= CYCLE_PARTS && lag >= 4 * p; p++)
        if (fmin(relative(fine, first, lag / p, whole), relative(fine, first, lag / p + 1, whole))
            <= fmin(d[1], d[3]))
            c.parts |= 1u << p;
    double near = vertex(d[1], d[2], d[3], 1), far = vertex(d[0], d[2], d[4], 2);
    c.lag = (double)lag + near;
    find_later(&c, fine, first, whole, lag);
    c.bend = fabs(near - far) / 3;
    c.change = ss_view_difference(fine, first, lag, whole, &a, &b, &ab);
    c.slopes = ss_view_difference(fine, first, 1, whole, &a, &b, &unit);
    c.twice = first + 2 * lag + whole < fine->n ? ss_view_difference(fine, first, 2 * lag, whole, &a, &b, &ab)
        : NAN;
    return c;
}
