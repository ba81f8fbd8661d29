/* errors.c -- standard errors of a fitted oscillation.
 *
 * By the jackknife over windows, in its linearised form.  What it cannot see is a misfit that all
 * windows share, of the slow part or the ends: that moves the fit as the windows or the model change.
 * So windows are cut at their starts, or at their ends, and the slow part may bend; what that moves the
 * fit by, beyond what noise does, is added in quadrature.  So is what is left beyond white noise. */
#include "find/fitter.h"

#include <stdlib.h>
#include "find/judgement.h"

enum { CUTS = 3 };              /* of the start, each by FIT_TRIM_END more */

/* The variance of the samples, from the residuals of a fit. */
static double
variance_of(const fitter *k, const linear *fit)
{
    return fit->rss / (double)(fit->samples - ss_varpro_columns(&k->fit) * fit->windows - 2);
}

static void
errors_of_fit(const normal *h, double variance, ss_value value[2])
{
    double det = h->ww * h->ss - h->ws * h->ws;
    value[0].error = sqrt(variance * h->ss / det);
    value[1].error = sqrt(variance * h->ww / det);
}

/* Nor is a fit finer than its tolerance. */
void
ss_errors_by_curvature(const fitter *k, const linear *fit, ss_value value[2])
{
    errors_of_fit(&fit->normal, variance_of(k, fit), value);
    for (int j = 0; j < 2; j++)
        value[j].error = hypot(value[j].error, FIT_FINE * k->fit.w);
}

/* The jackknife in its linear form: without window i the fit moves by (H - H_i)^-1 g_i.  Of few windows
 * it is uncertain itself, so that the error is no less than by the curvature of the sum of squares. */
static ss_status
jackknife(fitter *k, const linear *total, ss_value value[2])
{
    size_t n = total->windows, used = 0;
    double (*moved)[2] = malloc((n + 1) * sizeof *moved);
    if (moved == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < k->n; i++) {
        if (ss_window_length(k->window[i]) == 0)
            continue;
        normal h = ss_varpro_project(&k->fit, k->window[i]).normal;
        double ww = total->normal.ww - h.ww, ws = total->normal.ws - h.ws, ss = total->normal.ss - h.ss;
        double det = ww * ss - ws * ws;
        moved[used][0] = (ss * h.w - ws * h.s) / det;
        moved[used++][1] = (ww * h.s - ws * h.w) / det;
    }
    ss_errors_by_curvature(k, total, value);
    for (int j = 0; j < 2 && n >= FIT_FEW; j++) {
        double mean = 0, squares = 0;
        for (size_t i = 0; i < n; i++)
            mean += moved[i][j] / (double)n;
        for (size_t i = 0; i < n; i++)
            squares += (moved[i][j] - mean) * (moved[i][j] - mean);
        value[j].error = fmax(value[j].error, sqrt(squares * (double)(n - 1) / (double)n));
    }
    free(moved);
    return SS_OK;
}

/* Fit in another way: with windows cut by a part of a period at one end, or with a slow part that may bend.  What a
 * filter leaves of a slip goes on into every stick, slowly and alike, so that cuts do not show all of it; it may turn
 * meanwhile, so that one cut shows nothing.
 * moved becomes the squares that w and s move by beyond what noise moves them by: its variance is that of the
 * other fit less that of the first (Hausman 1978).  If there is no such fit, moved stays as it is. */
typedef enum other_way { CUT_START, CUT_END, BENT } other_way;

static void
fit_otherwise(fitter *k, other_way how, double by_periods, ss_window *cut, const linear *total, double moved[2])
{
    const double at[2] = { k->fit.w, k->fit.s }, variance = variance_of(k, total);
    size_t off = periods(k, by_periods);
    ss_value first[2], other[2];
    for (size_t i = 0; i < k->n; i++) {
        size_t length = ss_window_length(k->window[i]), part = off < length ? off : length;
        cut[i] = k->window[i];
        cut[i].first += how == CUT_START ? part : 0;
        cut[i].end -= how == CUT_END ? part : 0;
    }
    k->fit.is_bent = how == BENT;
    if (ss_varpro_fit(&k->fit, cut, k->n, FIT_FINE)) {
        linear there = ss_varpro_project_all(&k->fit, cut, k->n);
        errors_of_fit(&total->normal, variance, first);
        errors_of_fit(&there.normal, variance, other);
        const double by[2] = { k->fit.w - at[0], k->fit.s - at[1] };
        for (int j = 0; j < 2; j++) {
            double noise = other[j].error * other[j].error - first[j].error * first[j].error;
            moved[j] = fmax(moved[j], by[j] * by[j] - fmax(noise, 0));
        }
    }
    k->fit.is_bent = 0;
    k->fit.w = at[0], k->fit.s = at[1];
}

/* A residual above the white noise may lie in the band of the oscillation: then all of its energy in a window
 * disturbs the fit, not only the share that white noise has there.  A cut may move the fit by half of what
 * it would take to see all of a misfit at that end. */
ss_status
ss_errors_find(fitter *k, ss_value value[2])
{
    linear total = ss_varpro_project_all(&k->fit, k->window, k->n);
    double cut_moved[2] = { 0, 0 }, bent_moved[2] = { 0, 0 };
    ss_window *cut = malloc((k->n + 1) * sizeof *cut);
    ss_status st = cut != NULL ? jackknife(k, &total, value) : SS_ENOMEM;
    if (st == SS_OK) {
        for (int i = 1; i <= CUTS; i++)
            fit_otherwise(k, CUT_START, i * FIT_TRIM_END, cut, &total, cut_moved);
        fit_otherwise(k, CUT_END, FIT_TRIM_END, cut, &total, cut_moved);
        fit_otherwise(k, BENT, 0, cut, &total, bent_moved);
        /* by chance, the variance differs from that of white noise by the root of 2 over the samples */
        double white = pow(k->of->white, 2) * (1 + SIGMAS * sqrt(2 / (double)total.samples));
        double excess = fmax(0, variance_of(k, &total) - white);
        double in_band = excess * 0.5 * (double)total.samples / (double)total.windows;
        ss_value coloured[2];
        errors_of_fit(&total.normal, in_band, coloured);
        for (int j = 0; j < 2; j++)
            value[j].error = sqrt(value[j].error * value[j].error + 0.25 * cut_moved[j] + bent_moved[j]
                                  + coloured[j].error * coloured[j].error);
    }
    free(cut);
    return st;
}
