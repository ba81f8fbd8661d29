/* backbone_block.c -- amplitude, phase and their rates in a block of a few periods.
 *
 * About a bend that is nearly right, g = exp of its ln A + i phase, the signal is Re (C g + D t
 * g), beside a straight line, two harmonics of constant amplitude, as friction makes them, and the lines.  All are
 * linear; D / C is what s and w lack, so repetition is Gauss's and Newton's method.  No taper: with white noise
 * none gives smaller errors. */
#include "fit/backbone.h"

#include <complex.h>
#include <math.h>
#include <string.h>
#include "base/versions.h"

enum { ROOM = 17, AT_ONCE = 64, LANES = 8, STEPS = 8 };         /* ROOM: columns, with x, which comes last */

/* The columns of a block, one after the other, as factors that turn by themselves. */
typedef struct turner {
    double complex now, turn, bend, twist;      /* now *= turn, turn *= bend, bend *= twist */
} turner;

/* ln A and i times the phase grow by (-s + i w) t + (-ds + i dw) t^2/2 + (-dds + i ddw) t^3/6. */
static turner
turner_at(bend at, double t)
{
    double complex rate = -at.s + at.w * I, more = -at.ds + at.dw * I, twist = -at.dds + at.ddw * I;
    return (turner){ cexp(t * (rate + t / 2 * (more + t / 3 * twist))),
                     cexp(rate + more * (t + .5) + twist * (t * t + t + 1 / 3.) / 2), cexp(more + twist * (t + 1)),
                     cexp(twist) };
}

/* Finite factors need not ask for the infinities that C's own product looks after. */
static inline double complex
times(double complex a, double complex b)
{
    return creal(a) * creal(b) - cimag(a) * cimag(b) + (creal(a) * cimag(b) + cimag(a) * creal(b)) * I;
}

static inline double complex
turned(turner *g)
{
    double complex now = g->now;
    g->now = times(g->now, g->turn);
    g->turn = times(g->turn, g->bend);
    g->bend = times(g->bend, g->twist);
    return now;
}

/* The same of a real factor. */
static inline double
fallen(turner *g)
{
    double now = creal(g->now);
    g->now = now * creal(g->turn);
    g->turn = creal(g->turn) * creal(g->bend);
    g->bend = creal(g->bend) * creal(g->twist);
    return now;
}

void
ss_block_leave(const block *b, const double *x, double *left)
{
    turner g = turner_at(b->at, (double)b->first - b->t);
    g.now *= cexp(b->level + b->phase * I);
    for (size_t k = b->first; k < b->end; k++) {
        double of = creal(turned(&g));
        *left++ = isnan(x[k]) ? 0 : x[k] - of;
    }
}

/* Add the products of AT_ONCE samples of the columns to the lower half of the normal matrix.  Lanes let the
 * machine multiply several at a time. */
VERSIONS static void
add_products(double sum[ROOM][ROOM], double column[ROOM][AT_ONCE], size_t m)
{
    for (size_t i = 0; i <= m; i++)
        for (size_t j = 0; j <= i; j++) {
            double lane[LANES] = { 0 };
            for (size_t k = 0; k < AT_ONCE; k += LANES)
                for (size_t l = 0; l < LANES; l++)
                    lane[l] += column[i][k + l] * column[j][k + l];
            for (size_t l = 0; l < LANES; l++)
                sum[i][j] += lane[l];
        }
}

/* Add samples first ... end - 1; returns how many are there. */
static size_t
add_up(double sum[ROOM][ROOM], size_t m, const double *x, size_t first, size_t end, bend at, size_t harmonics,
       const lines *beside)
{
    double middle = (double)(first + end - 1) / 2, by_half = 2 / (double)(end - first), column[ROOM][AT_ONCE];
    double start = (double)first - middle;
    turner size = turner_at((bend){ .s = at.s, .ds = at.ds, .dds = at.dds }, start), line[LINES_MAX];
    turner pure = turner_at((bend){ .w = at.w, .dw = at.dw, .ddw = at.ddw }, start);
    size_t n = 0, kept = 0;
    for (size_t i = 0; i < beside->n; i++)
        line[i] = turner_at((bend){ .s = beside->s[i], .w = beside->w[i] }, start);
    for (size_t k = first; k < end; k++) {
        double complex h = turned(&pure), z = fallen(&size) * h, power = h;
        double u = ((double)k - middle) * by_half;
        size_t c = 4;
        column[0][kept] = creal(z), column[1][kept] = -cimag(z);
        column[2][kept] = u * creal(z), column[3][kept] = -u * cimag(z);
        column[c++][kept] = 1, column[c++][kept] = u;
        for (size_t i = 0; i < harmonics; i++) {
            power = times(power, h);
            column[c++][kept] = creal(power), column[c++][kept] = cimag(power);
        }
        for (size_t i = 0; i < beside->n; i++) {
            double complex l = turned(&line[i]);
            column[c++][kept] = creal(l), column[c++][kept] = cimag(l);
        }
        column[c][kept] = x[k];
        kept += !isnan(x[k]);
        n += !isnan(x[k]);
        if (k + 1 == end)
            for (size_t i = 0; i <= m; i++)
                memset(&column[i][kept], 0, (AT_ONCE - kept) * sizeof **column);
        if (k + 1 == end || kept == AT_ONCE) {
            add_products(sum, column, m);
            kept = 0;
        }
    }
    return n;
}

/* Gauss's and Jordan's sweep of the first m rows of a symmetric matrix: the inverse there, the coefficients in the
 * last row, and what is left at its end.  A column that the others explain to 1e-10 gets none. */
static void
sweep(double a[ROOM][ROOM], size_t m)
{
    double whole[ROOM];
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
ss_block_fit(block *b, const double *x, size_t first, size_t end, bend start, const lines *beside, int steps)
{
    double a[ROOM][ROOM], half = (double)(end - first) / 2;
    const bend about = start;
    for (int i = 0; i < STEPS; i++) {
        size_t harmonics = start.w * 3 < 3 ? 2 : start.w * 2 < 3 ? 1 : 0, m = 6 + 2 * (harmonics + beside->n);
        memset(a, 0, sizeof a);
        size_t n = add_up(a, m, x, first, end, start, harmonics, beside);
        if (n < m + 2)
            return 0;
        sweep(a, m);
        double complex c = a[m][0] + a[m][1] * I, step = (a[m][2] + a[m][3] * I) / c / half;
        double power = creal(c) * creal(c) + cimag(c) * cimag(c);
        if (!(power > 0) || !isfinite(power))
            return 0;
        /* The error of C times conj C / |C|^2 is that of ln A + i phase; D's in the same way. */
        double re = creal(c) / power, im = cimag(c) / power, far = cabs(step) * half;
        const double way[TRACKS][2] = { { re, im }, { -im, re } };
        *b = (block){ .first = first, .end = end, .t = (double)(first + end - 1) / 2, .left = fmax(a[m][m], 0),
                      .free = (double)(n - m), .y = { log(power) / 2, carg(c) },
                      .rate = { creal(step) - start.s, cimag(step) + start.w },
                      .about = about, .steps = i + 1, .at = start };
        for (int k = 0; k < TRACKS; k++)
            for (size_t p = 0; p < 2; p++)
                for (size_t q = 0; q < 2; q++) {
                    double by = -way[k][p] * way[k][q];
                    b->cov[k][0] += by * a[p][q];
                    b->cov[k][1] += by * a[p][q + 2] / half;
                    b->cov[k][2] += by * a[p + 2][q + 2] / half / half;
                }
        if (i + 1 == steps)
            return 1;
        double ease = far > 1 ? 1 / far : 1;
        start.s -= creal(step) * ease;
        start.w += cimag(step) * ease;
        if (!(start.w > 0) || start.w > 3)
            return 0;
        if (steps == 0 && (pow(far, 4) < FAINT * b->cov[LEVEL][2] * half * half * b->left / b->free || far < 1e-6))
            return 1;
    }
    return 0;
}
