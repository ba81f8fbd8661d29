/* backbone_block.c -- amplitude, phase and their rates in a block of a few periods.
 *
 * About a bend that is nearly right, g = exp(-(s t + ds t^2/2) + i (w t + dw t^2/2)), the signal is
 * Re (C g + D t g), beside a straight line, two harmonics of constant amplitude, as friction makes them, and the
 * lines.  All are linear; D / C is what s and w lack, so repetition is Gauss's and Newton's method.  No taper: with
 * white noise none gives smaller errors. */
#include "fit/backbone.h"

#include <complex.h>
#include <math.h>
#include <string.h>
#include "base/versions.h"

enum { COLUMNS = 16, STEPS = 8 };       /* with x, which comes last */

/* The columns of a block, one after the other, as factors that turn by themselves. */
typedef struct turner {
    double complex now, turn, bend;     /* now *= turn, turn *= bend */
} turner;

static turner
turner_at(bend at, double t)
{
    double complex rate = CMPLX(-at.s, at.w), change = CMPLX(-at.ds, at.dw);
    return (turner){ cexp(rate * t + change * t * t / 2), cexp(rate + change * (t + .5)), cexp(change) };
}

static inline double complex
turned(turner *g)
{
    double complex now = g->now;
    g->now *= g->turn;
    g->turn *= g->bend;
    return now;
}

/* Add the products of the columns of each sample to the normal matrix, of which the lower half is used. */
FAST static size_t
add_up(double sum[COLUMNS + 1][COLUMNS + 1], size_t m, const double *x, size_t first, size_t end, bend at,
       size_t harmonics, const lines *beside)
{
    double middle = (double)(first + end - 1) / 2, half = (double)(end - first) / 2, row[COLUMNS + 1] = { 0 };
    turner g = turner_at(at, (double)first - middle), pure, line[LINES_MAX];
    size_t n = 0;
    at.s = at.ds = 0;
    pure = turner_at(at, (double)first - middle);
    for (size_t i = 0; i < beside->n; i++)
        line[i] = turner_at((bend){ beside->s[i], beside->w[i], 0, 0 }, (double)first - middle);
    for (size_t k = first; k < end; k++) {
        double complex z = turned(&g), h = turned(&pure), power = h;
        double u = ((double)k - middle) / half;
        size_t c = 6;
        row[0] = creal(z), row[1] = -cimag(z), row[2] = u * row[0], row[3] = u * row[1];
        row[4] = 1, row[5] = u;
        for (size_t i = 0; i < harmonics; i++) {
            power *= h;
            row[c++] = creal(power);
            row[c++] = cimag(power);
        }
        for (size_t i = 0; i < beside->n; i++) {
            double complex l = turned(&line[i]);
            row[c++] = creal(l);
            row[c++] = cimag(l);
        }
        if (isnan(x[k]))
            continue;
        row[c] = x[k];
        for (size_t i = 0; i <= m; i++)
            for (size_t j = 0; j <= i; j++)
                sum[i][j] += row[i] * row[j];
        n++;
    }
    return n;
}

/* Gauss's and Jordan's sweep of the first m rows of a symmetric matrix: the inverse there, the coefficients in the
 * last row, and what is left at its end.  A column that the others explain to 1e-10 gets none. */
static void
sweep(double a[COLUMNS + 1][COLUMNS + 1], size_t m)
{
    double whole[COLUMNS + 1];
    for (size_t i = 0; i <= m; i++)
        whole[i] = a[i][i];
    for (size_t i = 0; i <= m; i++)
        for (size_t j = 0; j < i; j++)
            a[j][i] = a[i][j];
    for (size_t k = 0; k < m; k++) {
        double pivot = a[k][k] > 1e-10 * whole[k] ? 1 / a[k][k] : 0;
        for (size_t i = 0; i <= m; i++)
            for (size_t j = 0; j <= m && i != k; j++)
                if (j != k)
                    a[i][j] -= a[i][k] * a[k][j] * pivot;
        for (size_t i = 0; i <= m; i++)
            if (i != k)
                a[i][k] = a[k][i] = a[i][k] * pivot;
        a[k][k] = -pivot;
    }
}

int
ss_block_fit(block *b, const double *x, size_t first, size_t end, bend start, const lines *beside, int is_near)
{
    double a[COLUMNS + 1][COLUMNS + 1], half = (double)(end - first) / 2;
    for (int i = 0; i < STEPS; i++) {
        size_t harmonics = start.w * 3 < 3 ? 2 : start.w * 2 < 3 ? 1 : 0, m = 6 + 2 * (harmonics + beside->n);
        memset(a, 0, sizeof a);
        size_t n = add_up(a, m, x, first, end, start, harmonics, beside);
        if (n < m + 2)
            return 0;
        sweep(a, m);
        double complex c = CMPLX(a[m][0], a[m][1]), step = CMPLX(a[m][2], a[m][3]) / c / half;
        double power = creal(c) * creal(c) + cimag(c) * cimag(c);
        if (!(power > 0) || !isfinite(power))
            return 0;
        /* The error of C times conj C / |C|^2 is that of ln A + i phase; D's in the same way. */
        double re = creal(c) / power, im = cimag(c) / power, far = cabs(step) * half;
        const double way[TRACKS][2] = { { re, im }, { -im, re } };
        *b = (block){ .first = first, .end = end, .t = (double)(first + end - 1) / 2, .left = fmax(a[m][m], 0),
                      .free = (double)(n - m), .y = { log(power) / 2, carg(c) },
                      .rate = { creal(step) - start.s, cimag(step) + start.w }, .at = start };
        for (int k = 0; k < TRACKS; k++)
            for (size_t p = 0; p < 2; p++)
                for (size_t q = 0; q < 2; q++) {
                    double by = -way[k][p] * way[k][q];
                    b->cov[k][0] += by * a[p][q];
                    b->cov[k][1] += by * a[p][q + 2] / half;
                    b->cov[k][2] += by * a[p + 2][q + 2] / half / half;
                }
        if (is_near)
            return 1;
        double ease = far > 1 ? 1 / far : 1;
        start.s -= creal(step) * ease;
        start.w += cimag(step) * ease;
        if (!(start.w > 0) || start.w > 3)
            return 0;
        if (far * far < 1e-4 * b->cov[LEVEL][2] * half * half * b->left / b->free || far < 1e-9)
            return 1;
    }
    return 0;
}
