/* breakpoint.c -- a two-sided fit with a free break.
 *
 * Left of the break a cubic, right of it the same plus truncated powers 1 to 3 (a kink), or 0 to 3 (a
 * jump).  All but the place of the break is linear: the residual is what an orthogonal projection
 * leaves, and the place is where it is least, by a scan and then by golden section.  Between two
 * samples a jump has no place (any gives the same samples), so it is put half way. */
#include "features/breakpoint.h"

#include <math.h>
#include <string.h>

enum { DEGREE = 3, TERMS = 2 * DEGREE + 2, SAMPLES = 128 };

typedef struct piece {
    const double *x;            /* samples first ... first + n - 1 */
    size_t n;
    double first, unit;         /* of the time axis: half the length, so that powers stay near 1 */
} piece;

/* Sum of squares that the terms 0 ... DEGREE and the truncated powers lowest ... DEGREE leave. */
static double
residual(const piece *p, double at, int lowest)
{
    double q[TERMS][SAMPLES], left[SAMPLES], sum = 0;
    int terms = 0;
    memcpy(left, p->x, p->n * sizeof *left);
    for (int side = 0; side < 2; side++)
        for (int power = side == 0 ? 0 : lowest; power <= DEGREE; power++, terms++) {
            double *u = q[terms], norm = 0, along = 0, before = 0;
            for (size_t i = 0; i < p->n; i++) {
                double s = (p->first + (double)i - at) / p->unit;
                u[i] = side == 1 && s < 0 ? 0 : pow(s, power);
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

/* Where in [lo, hi] the residual is least, as far as steps of a quarter of a sample tell, and then
 * to a hundredth. */
static double
least(const piece *p, double lo, double hi, int lowest, double *sum)
{
    const double step = lowest == 0 ? 1 : 0.25, golden = (sqrt(5) - 1) / 2;
    double best = lo, at[2];
    *sum = INFINITY;
    for (double t = lo; t <= hi; t += step) {
        double s = residual(p, t, lowest);
        if (s < *sum) {
            *sum = s;
            best = t;
        }
    }
    if (lowest == 0)
        return best;
    lo = fmax(lo, best - step), hi = fmin(hi, best + step);
    while (hi - lo > 0.01) {
        at[0] = hi - golden * (hi - lo), at[1] = lo + golden * (hi - lo);
        if (residual(p, at[0], lowest) < residual(p, at[1], lowest))
            hi = at[1];
        else
            lo = at[0];
    }
    *sum = residual(p, (lo + hi) / 2, lowest);
    return (lo + hi) / 2;
}

double
ss_breakpoint(const double *x, size_t first, size_t last, double at, double reach)
{
    double lo = fmax(at - reach, (double)first + BREAKPOINT_SIDE - 0.5), kink, jump;
    double hi = fmin(at + reach, (double)last - BREAKPOINT_SIDE + 0.5);
    if (last - first + 1 > SAMPLES || !(lo <= hi))
        return at;
    piece p = { x + first, last - first + 1, (double)first, (double)(last - first + 1) / 2 };
    double at_kink = least(&p, lo, hi, 1, &kink);
    double at_jump = least(&p, floor(lo) + 0.5, hi, 0, &jump);
    return (double)p.n * log(kink / jump) > log((double)p.n) ? at_jump : at_kink;
}
