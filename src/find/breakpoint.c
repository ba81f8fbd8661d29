/* breakpoint.c -- a two-sided fit with a free break.
 *
 * A cubic is fitted to the samples on each side of the break.  At a jump the two cubics are free;
 * at a kink they must meet.  Let free cubics leave the sum of squares r.  If they differ by d at
 * the break, where their variances are u and v, cubics that meet leave d^2 / (u + v) more.  The
 * break is where the sum is least.  All places of a jump between two samples give the same
 * samples, so the middle is chosen. */
#include "find/events.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include "find/judgement.h"

enum { DEGREE = BREAKPOINT_DEGREE, SAMPLES = 128 };

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

double
ss_breakpoint(const double *x, size_t first, size_t last, double at, double reach)
{
    double lo = fmax(at - reach, (double)first + BREAKPOINT_SIDE - 0.5), kink, jump, low, high;
    double hi = fmin(at + reach, (double)last - BREAKPOINT_SIDE + 0.5);
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
