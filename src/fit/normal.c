/* normal.c -- solve the normal equations for a step of least squares, damped and within ranges. */
#include "fit/normal.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define RIDGE 1e-12                     /* of a diagonal: directions that the record does not show */

typedef double triangle[NORMAL_MOST][NORMAL_MOST];

/* Cholesky's factor of a, its diagonal raised by the part ridge; rows and columns that are held are
 * those of the unit matrix. */
static void
factor(const normal *e, const int *held, double ridge, triangle l)
{
    for (size_t i = 0; i < e->n; i++)
        for (size_t j = 0; j <= i; j++) {
            double s = held[i] || held[j] ? i == j : e->a[i][j];
            if (i == j && !held[i])
                s += fmax(ridge * s, DBL_MIN);
            for (size_t k = 0; k < j; k++)
                s -= l[i][k] * l[j][k];
            /* rounding may leave less than nothing: a direction that is not seen does not move */
            l[i][j] = i != j ? s / l[j][j] : s > RIDGE / 2 * e->a[i][i] || held[i] ? sqrt(s) : INFINITY;
        }
}

static void
substitute(const normal *e, triangle l, double *b)
{
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < i; k++)
            b[i] -= l[i][k] * b[k];
        b[i] /= l[i][i];
    }
    for (size_t i = e->n; i-- > 0;) {
        for (size_t k = i + 1; k < e->n; k++)
            b[i] -= l[k][i] * b[k];
        b[i] /= l[i][i];
    }
}

void
ss_normal_step(const normal *e, double damping, const double lo[], const double hi[], double step[])
{
    int held[NORMAL_MOST] = { 0 }, again = 1;
    triangle l;
    memset(step, 0, e->n * sizeof *step);
    while (again) {
        double b[NORMAL_MOST];
        for (size_t i = 0; i < e->n; i++) {
            b[i] = held[i] ? step[i] : -e->g[i];
            for (size_t k = 0; k < e->n && !held[i]; k++)
                b[i] -= held[k] ? e->a[i][k] * step[k] : 0;
        }
        factor(e, held, fmax(damping, RIDGE), l);
        substitute(e, l, b);
        again = 0;
        for (size_t i = 0; i < e->n; i++) {
            if (!held[i])
                step[i] = lo != NULL ? fmin(fmax(b[i], lo[i]), hi[i]) : b[i];
            if (!held[i] && step[i] != b[i])
                held[i] = again = 1;
        }
    }
}

double
ss_normal_gain(const normal *e, const double step[])
{
    double gain = 0;
    for (size_t k = 0; k < e->n; k++)
        gain -= e->g[k] * step[k];
    return gain;
}

void
ss_normal_invert(const normal *e, double inverse[NORMAL_MOST][NORMAL_MOST])
{
    const int held[NORMAL_MOST] = { 0 };
    triangle l;
    factor(e, held, RIDGE, l);
    memset(inverse, 0, NORMAL_MOST * sizeof *inverse);
    for (size_t k = 0; k < e->n; k++) {         /* symmetric: rows are columns */
        inverse[k][k] = 1;
        substitute(e, l, inverse[k]);
    }
}
