/* errors.c -- standard errors of a fitted oscillation.
 *
 * By the jackknife over windows, in its linearised form.  What it cannot see is a misfit that all
 * windows share, of the slow part or the ends: that moves the fit as the windows change.  So all
 * are cut at their starts, or at their ends, and half of what that moves the fit by, noise apart, is
 * added in quadrature.  So is all that the fit moves by, noise apart, when the slow part may bend,
 * see add_slow_part, or beside a steady line, see add_line; and what is left beyond white noise, see
 * add_colour. */
#include "find/fitter.h"

#include <gsl/gsl_cdf.h>
#include <stdlib.h>

#define WHITE 1.2               /* times the variance of white noise: more is coloured */
#define LOWEST_LINE 0.7         /* of the oscillation's frequency, see add_line */
#define HIGHEST_LINE 1.4
enum { LINES = 15 };

/* The variances from the curvature of the sum of squares. */
static void
errors_of_fit(const normal *h, double variance, ss_value value[2])
{
    double det = h->ww * h->ss - h->ws * h->ws;
    value[0].error = sqrt(variance * h->ss / det);
    value[1].error = sqrt(variance * h->ww / det);
}

/* The variance of the samples, from the residuals of a fit. */
static double
variance_of(const fitter *k, const linear *fit)
{
    return fit->rss / (double)(fit->samples - ss_varpro_columns(&k->fit) * fit->windows - 2);
}

/* The jackknife in its linear form: without window i the fit moves by (H - H_i)^-1 g_i.  Of few windows
 * it is uncertain itself, so that the error is no less than by the curvature of the sum of squares. */
static ss_status
jackknife(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    double moved[2] = { 0, 0 }, mean[2] = { 0, 0 };
    linear total = ss_varpro_project_all(&k->fit, window, n);
    size_t used = total.windows;
    normal all = total.normal, *each = malloc((used + 1) * sizeof *each);
    if (each == NULL)
        return SS_ENOMEM;
    for (size_t i = 0, to = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0)
            each[to++] = ss_varpro_project(&k->fit, window[i]).normal;
    errors_of_fit(&all, variance_of(k, &total), value);
    for (int pass = 0; pass < 2 && used >= FIT_FEW; pass++)
        for (size_t i = 0; i < used; i++) {
            normal h = each[i];
            double ww = all.ww - h.ww, ws = all.ws - h.ws, ss = all.ss - h.ss;
            double det = ww * ss - ws * ws, d[2];
            d[0] = (ss * h.w - ws * h.s) / det;
            d[1] = (ww * h.s - ws * h.w) / det;
            for (int j = 0; j < 2; j++) {
                if (pass == 0)
                    mean[j] += d[j] / (double)used;
                else
                    moved[j] += (d[j] - mean[j]) * (d[j] - mean[j]);
            }
        }
    for (int j = 0; j < 2 && used >= FIT_FEW; j++)
        value[j].error = fmax(value[j].error, sqrt(moved[j] * (double)(used - 1) / (double)used));
    free(each);
    return SS_OK;
}

/* The variances of w and s from the curvature of the sum of squares of all windows; *variance is that
 * of the samples, and is found if it is negative. */
static void
variances(fitter *k, const ss_window *window, size_t n, double *variance, double of[2])
{
    ss_value value[2];
    linear all = ss_varpro_project_all(&k->fit, window, n);
    if (*variance < 0)
        *variance = variance_of(k, &all);
    errors_of_fit(&all.normal, *variance, value);
    of[0] = value[0].error * value[0].error;
    of[1] = value[1].error * value[1].error;
}

/* Cut all windows by FIT_TRIM_END, at one end or the other, and add half of what w and s move by beyond
 * what noise moves them by: its variance is that of the cut fit less that of the whole (Hausman
 * 1978). */
static ss_status
add_misfit(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    const double at[2] = { k->fit.w, k->fit.s };
    double most[2] = { 0, 0 }, whole[2], less[2], variance = -1;
    size_t off = periods(k, FIT_TRIM_END);
    ss_window *cut_off = malloc(n * sizeof *cut_off);
    if (cut_off == NULL)
        return SS_ENOMEM;
    variances(k, window, n, &variance, whole);
    for (int end = 0; end < 2; end++) {
        for (size_t i = 0; i < n; i++) {
            size_t part = off < ss_window_length(window[i]) ? off : ss_window_length(window[i]);
            cut_off[i] = window[i];
            if (end)
                cut_off[i].end -= part;
            else
                cut_off[i].first += part;
        }
        if (ss_varpro_fit(&k->fit, cut_off, n, FIT_FINE)) {
            variances(k, cut_off, n, &variance, less);
            const double moved[2] = { k->fit.w - at[0], k->fit.s - at[1] };
            for (int j = 0; j < 2; j++)
                most[j] = fmax(most[j], moved[j] * moved[j] - fmax(less[j] - whole[j], 0));
        }
        k->fit.w = at[0], k->fit.s = at[1];
    }
    for (int j = 0; j < 2; j++)
        value[j].error = sqrt(value[j].error * value[j].error + 0.25 * most[j]);
    free(cut_off);
    return SS_OK;
}

/* What a filter leaves of a slip goes on into every stick, slowly and alike: neither the jackknife nor
 * shorter windows see all of it.  The fit is off by what it moves by beyond what noise moves it by
 * (Hausman again) where the slow part may bend as a cubic. */
static void
add_slow_part(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    const double at[2] = { k->fit.w, k->fit.s };
    double whole[2], bent[2], variance = -1;
    variances(k, window, n, &variance, whole);
    k->fit.is_bent = 1;
    if (ss_varpro_fit(&k->fit, window, n, FIT_FINE)) {
        variances(k, window, n, &variance, bent);
        const double moved[2] = { k->fit.w - at[0], k->fit.s - at[1] };
        for (int j = 0; j < 2; j++)
            value[j].error = sqrt(value[j].error * value[j].error
                                  + fmax(0, moved[j] * moved[j] - fmax(bent[j] - whole[j], 0)));
    }
    k->fit.is_bent = 0;
    k->fit.w = at[0], k->fit.s = at[1];
}

/* The sum of squares that all windows leave, with a steady line of frequency line in each. */
static double
rss_with_line(fitter *k, const ss_window *window, size_t n, double line)
{
    k->fit.line = line;
    return ss_varpro_project_all(&k->fit, window, n).rss;
}

/* A line in every window that explains more than chance is no part of the model, of which the fit
 * may have taken it for one: it is off by what it moves by beside the line. */
static void
add_line(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    const double at[2] = { k->fit.w, k->fit.s };
    double least = INFINITY, best = 0;
    linear plain = ss_varpro_project_all(&k->fit, window, n);
    size_t used = plain.windows, samples = plain.samples;
    for (int l = 0; l < LINES; l++) {
        double line = at[0] * (LOWEST_LINE + l * (HIGHEST_LINE - LOWEST_LINE) / (LINES - 1));
        double rss = rss_with_line(k, window, n, line);
        if (rss < least) {
            least = rss;
            best = line;
        }
    }
    double more = 2 * (double)used;
    double left = (double)(samples - (ss_varpro_columns(&k->fit) + 2) * used);
    double noise = fmax(least / left, FIT_MISFIT * FIT_MISFIT * plain.ring / (double)samples);
    double F = (plain.rss - least) / more / noise;
    if (gsl_cdf_fdist_Q(F, more, left) < FIT_CHANCE / LINES) {
        double variance = -1, with[2];
        k->fit.line = best;
        if (ss_varpro_fit(&k->fit, window, n, FIT_FINE)) {
            variances(k, window, n, &variance, with);
            const double moved[2] = { k->fit.w - at[0], k->fit.s - at[1] };
            for (int j = 0; j < 2; j++)
                value[j].error = sqrt(value[j].error * value[j].error + moved[j] * moved[j] + with[j]);
        } else
            value[0].error = value[1].error = INFINITY;
    }
    k->fit.line = 0;
    k->fit.w = at[0], k->fit.s = at[1];
}

/* A residual above the white noise is no part of the model.  It may lie in the band of the oscillation:
 * then all of its energy in a window disturbs the fit, not only the share that white noise has there.
 * Nor is the fit finer than its tolerance. */
static void
add_colour(fitter *k, const ss_window *window, size_t n, double white, ss_value value[2])
{
    ss_value more[2];
    linear all = ss_varpro_project_all(&k->fit, window, n);
    double excess = fmax(0, variance_of(k, &all) - WHITE * white * white);
    errors_of_fit(&all.normal, excess * 0.5 * (double)all.samples / (double)all.windows, more);
    for (int j = 0; j < 2; j++)
        value[j].error = sqrt(value[j].error * value[j].error + more[j].error * more[j].error
                              + FIT_FINE * FIT_FINE * k->fit.w * k->fit.w);
}

/* --- all of it ----------------------------------------------------------------------------- */

void
ss_errors_of_one(const fitter *k, const linear *fit, ss_value value[2])
{
    errors_of_fit(&fit->normal, variance_of(k, fit), value);
}

ss_status
ss_errors_find(fitter *k, const ss_window *window, size_t n, double white, ss_value value[2])
{
    ss_status st = jackknife(k, window, n, value);
    if (st == SS_OK)
        st = add_misfit(k, window, n, value);
    if (st != SS_OK)
        return st;
    add_slow_part(k, window, n, value);
    add_line(k, window, n, value);
    add_colour(k, window, n, white, value);
    return SS_OK;
}
