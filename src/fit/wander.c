/* wander.c -- coloured noise at uneven times.
 *
 * Residuals of recordings have memory, and loggers change their rate at a step.  So noise is white plus a process
 * of Ornstein and Uhlenbeck, whose memory lasts for a time, or for rows, whichever is likelier.  Kalman's filter
 * predicts each row from those before; what is left is white.  Likelihood of noise beside fitted columns:
 * Patterson and Thompson (1971). */
#include "fit/wander.h"

#include <float.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/gauss.h"
#include "fit/verdict.h"

enum { COLUMNS = 8, STEPS = 60 };

double
ss_wander_whiten(double *white, const wander *w, const double *t, const double *in, size_t n, size_t columns)
{
    double mean[COLUMNS] = { 0 }, variance = w->part, logarithms = 0, product = 1, keep = exp(-1 / w->memory);
    for (size_t i = 0; i < n; i++) {
        if (!w->by_rows)
            keep = i > 0 ? exp((t[i - 1] - t[i]) / w->memory) : 1;
        variance = w->part + keep * keep * (variance - w->part);
        const double sum = variance + 1 - w->part, gain = variance / sum, scale = 1 / sqrt(sum);
        for (size_t k = 0; k < columns; k++) {
            double before = keep * mean[k], off = in[i * columns + k] - before;
            white[i * columns + k] = off * scale;
            mean[k] = before + gain * off;
        }
        variance *= 1 - gain;
        product *= sum;
        if (product < 1e-200 || i == n - 1) {
            logarithms += log(product);
            product = 1;
        }
    }
    return logarithms;
}

typedef struct search {
    const double *t, *in;
    double *white;
    size_t n, columns;
    int by_rows;
} search;

static wander
noise_of(const search *s, const gsl_vector *u)
{
    return (wander){ 1 / (1 + exp(-gsl_vector_get(u, 0))), exp(gsl_vector_get(u, 1)), s->by_rows };
}

/* -2 log of the restricted likelihood. */
static double
unlikely(const gsl_vector *u, void *user)
{
    search *s = user;
    const wander w = noise_of(s, u);
    const size_t m = s->columns;
    double logarithms = ss_wander_whiten(s->white, &w, s->t, s->in, s->n, m), sum[COLUMNS][COLUMNS] = { { 0 } };
    for (size_t i = 0; i < s->n; i++)
        for (size_t k = 0; k < m; k++)
            for (size_t l = 0; l <= k; l++)
                sum[k][l] += s->white[i * m + k] * s->white[i * m + l];
    for (size_t k = 0; k < m; k++) {            /* Cholesky: the last pivot is the noise that is left */
        for (size_t l = 0; l <= k; l++) {
            for (size_t j = 0; j < l; j++)
                sum[k][l] -= sum[k][j] * sum[l][j];
            sum[k][l] = l < k ? sum[k][l] / sum[l][l] : sqrt(sum[k][k]);
        }
        logarithms += 2 * (k < m - 1 ? 1. : (double)(s->n - m + 1)) * log(sum[k][k]);
    }
    return isfinite(logarithms) ? logarithms : DBL_MAX;      /* columns that explain each other, or no noise */
}

ss_status
ss_wander_find(wander *w, const double *t, const double *in, size_t n, size_t columns)
{
    search s = { t, in, malloc(n * columns * sizeof *s.white), n, columns, 1 };
    gsl_multimin_fminimizer *nelder_mead = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, 2);
    double lowest = GSL_POSINF, shortest = INFINITY, longest = 0;
    int is_room = s.white != NULL && nelder_mead != NULL;
    for (size_t i = 1; i < n; i++) {
        shortest = fmin(shortest, t[i] - t[i - 1]);
        longest = fmax(longest, t[i] - t[i - 1]);
    }
    for (s.by_rows = 1; is_room && s.by_rows >= (longest < 1.01 * shortest); s.by_rows--) {
        const double span = s.by_rows ? (double)n : t[n - 1] - t[0], least = log(span / (double)n);
        double u[2], best[2] = { 0, least }, height = GSL_POSINF, width[2] = { 1, 1 };
        gsl_vector_view at = gsl_vector_view_array(u, 2), of = gsl_vector_view_array(best, 2);
        gsl_vector_view step = gsl_vector_view_array(width, 2);
        gsl_multimin_function f = { unlikely, 2, &s };
        for (u[1] = least; u[1] < log(span); u[1] += 2)
            for (u[0] = -4; u[0] <= 4; u[0] += 2) {
                const double here = unlikely(&at.vector, &s);
                if (here < height)
                    memcpy(best, u, sizeof best);
                height = fmin(here, height);
            }
        gsl_multimin_fminimizer_set(nelder_mead, &f, &of.vector, &step.vector);
        for (int i = 0; i < STEPS && gsl_multimin_fminimizer_size(nelder_mead) > FAINT; i++)
            gsl_multimin_fminimizer_iterate(nelder_mead);
        if (nelder_mead->fval < lowest) {
            lowest = nelder_mead->fval;
            *w = noise_of(&s, nelder_mead->x);
        }
    }
    free(s.white);
    if (nelder_mead != NULL)
        gsl_multimin_fminimizer_free(nelder_mead);
    return is_room ? SS_OK : SS_ENOMEM;
}

double
ss_wander_variance(double squares[], size_t n)
{
    gsl_sort(squares, 1, n);
    return gsl_stats_mean(squares, 1, n - n / 10) / GAUSS_NINE_TENTHS;
}
