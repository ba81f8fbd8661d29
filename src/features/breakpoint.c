/* breakpoint.c -- a two-sided fit with a free break.
 *
 * Left of the break a cubic, right of it the same plus truncated powers 1 to 3 (a kink), or 0 to 3
 * (a jump).  All but the place of the break is linear: the residual is what an orthogonal
 * projection leaves, and the place is where it is least.  Between two samples a jump has no place
 * (any gives the same samples), so it is put half way. */
#include "features/breakpoint.h"

#include <math.h>
#include <string.h>

enum { DEGREE = 3, TERMS = 2 * DEGREE + 2, SAMPLES = 128 };

#define ROUNDING 1e-6           /* re the range of the samples: better no fit needs to be */

typedef struct piece {
    double x[SAMPLES];          /* samples first ... first + n - 1, brought into [0, 1] */
    size_t n;
    double first, unit;         /* of the time axis: half the length, so that powers stay near 1 */
} piece;

/* Sum of squares that the terms 0 ... DEGREE and the truncated powers lowest ... DEGREE leave. */
static double
residual(const piece *p, double at, int lowest)
{
    double q[TERMS][SAMPLES], left[SAMPLES], sum = 0;
    int terms = 0;
    size_t right = 0;                   /* samples left of the break */
    while (right < p->n && p->first + (double)right < at)
        right++;
    memcpy(left, p->x, p->n * sizeof *left);
    for (int side = 0; side < 2; side++)
        for (int power = side == 0 ? 0 : lowest; power <= DEGREE; power++, terms++) {
            double *u = q[terms], norm = 0, along = 0, before = 0;
            for (size_t i = 0; i < p->n; i++) {
                double s = (p->first + (double)i - at) / p->unit, s2 = s * s;
                u[i] = side == 1 && i < right ? 0
                    : power == 0 ? 1 : power == 1 ? s : power == 2 ? s2 : s2 * s;
                before += u[i] * u[i];
            }
            for (int pass = 0; pass < 2; pass++)        /* twice is enough (Kahan, Parlett) */
                for (int k = 0; k < terms; k++) {
                    double dot = 0;
                    for (size_t i = 0; i < p->n; i++)
                        dot += q[k][i] * u[i];
                    for (size_t i = 0; i < p->n; i++)
                        u[i] -= dot * q[k][i];
                }
            for (size_t i = 0; i < p->n; i++)
                norm += u[i] * u[i];
            double scale = norm > 1e-24 * before ? 1 / sqrt(norm) : 0;      /* 0: nothing new */
            for (size_t i = 0; i < p->n; i++) {
                u[i] *= scale;
                along += u[i] * left[i];
            }
            for (size_t i = 0; i < p->n; i++)
                left[i] -= along * u[i];
        }
    for (size_t i = 0; i < p->n; i++)
        sum += left[i] * left[i];
    return sum;
}

/* Where in [lo, hi] the residual of a kink is least: scanned in steps of a quarter of a sample,
 * then by golden section, then by the parabola through the last three. */
static double
least_kink(const piece *p, double lo, double hi, double *sum)
{
    const double step = 0.25, golden = (sqrt(5) - 1) / 2;
    double best = lo;
    *sum = INFINITY;
    for (double t = lo; t <= hi; t += step) {
        double s = residual(p, t, 1);
        if (s < *sum) {
            *sum = s;
            best = t;
        }
    }
    lo = fmax(lo, best - step), hi = fmin(hi, best + step);
    double t0 = hi - golden * (hi - lo), t1 = lo + golden * (hi - lo);
    double s0 = residual(p, t0, 1), s1 = residual(p, t1, 1), s_lo = INFINITY, s_hi = INFINITY;
    while (hi - lo > 0.01)
        if (s0 < s1) {
            hi = t1, s_hi = s1, t1 = t0, s1 = s0;
            s0 = residual(p, t0 = hi - golden * (hi - lo), 1);
        } else {
            lo = t0, s_lo = s0, t0 = t1, s0 = s1;
            s1 = residual(p, t1 = lo + golden * (hi - lo), 1);
        }
    best = s0 < s1 ? t0 : t1;
    *sum = fmin(s0, s1);
    double other = s0 < s1 ? t1 : t0, s_other = fmax(s0, s1), end = s0 < s1 ? lo : hi;
    double s_end = s0 < s1 ? s_lo : s_hi;
    double u = (best - other) * (*sum - s_end), v = (best - end) * (*sum - s_other);
    double t = best - 0.5 * ((best - other) * u - (best - end) * v) / (u - v);
    if (t > lo && t < hi) {
        double s = residual(p, t, 1);
        if (s < *sum) {
            *sum = s;
            best = t;
        }
    }
    return best;
}

/* The same of a jump, which has its place half way between two samples. */
static double
least_jump(const piece *p, double lo, double hi, double *sum)
{
    double best = lo;
    *sum = INFINITY;
    for (double t = floor(lo) + 0.5; t <= hi; t++) {
        double s = residual(p, t, 0);
        if (s < *sum) {
            *sum = s;
            best = t;
        }
    }
    return best;
}

/* 0: all samples are the same. */
static int
fill(piece *p, const double *x)
{
    double lo = x[0], hi = x[0];
    for (size_t i = 0; i < p->n; i++) {
        lo = fmin(lo, x[i]);
        hi = fmax(hi, x[i]);
    }
    for (size_t i = 0; i < p->n && hi > lo; i++)
        p->x[i] = (x[i] - lo) / (hi - lo);
    return hi > lo;
}

double
ss_breakpoint(const double *x, size_t first, size_t last, double at, double reach)
{
    double lo = fmax(at - reach, (double)first + BREAKPOINT_SIDE - 0.5), kink, jump;
    double hi = fmin(at + reach, (double)last - BREAKPOINT_SIDE + 0.5);
    if (last - first + 1 > SAMPLES || !(lo <= hi))
        return at;
    piece p = { .n = last - first + 1, .first = (double)first };
    p.unit = (double)p.n / 2;
    if (!fill(&p, x + first))
        return at;
    double at_kink = least_kink(&p, lo, hi, &kink);
    double at_jump = least_jump(&p, lo, hi, &jump);
    double rounding = (double)p.n * ROUNDING * ROUNDING;
    kink += rounding;
    jump += rounding;
    return (double)p.n * log(kink / jump) > log((double)p.n) ? at_jump : at_kink;
}
