/* ringdown.c -- one damped oscillation shared by many short windows of a signal.
 *
 * While the contact sticks, the signal is A exp(-s t) cos(w t) + B exp(-s t) sin(w t) + C + D t.  The
 * line C + D t stands for the slow response to the base.  The contact sets w and s, which are the same
 * in every stick; A to D differ.  varpro.c fits this to windows.
 *
 * It is not known where a stick begins and ends; sticks.c finds that.  Some micro-slips are too weak to
 * show in one window; slips.c looks for them in all windows together, at the same distance from their
 * starts. */

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "find/fitter.h"
#include "find/judgement.h"

/* Lengths in periods of the oscillation. */
#define CORE 1.25               /* fits into a stick of two wherever that lies */
#define MOST 16.0               /* the longest window: the oscillation has decayed by its end */
#define APART (FIT_LEAST + 1)   /* least periods in a transition or half-cycle of the base: a window and the slip */

#define GROWTH 1.25             /* factor by which the longest window grows from one fit to the next */
#define KEPT 0.6                /* the least part of the windows that is kept without micro-slips: a train
                                   keeps less */
enum { ENOUGH = 256 };          /* the most windows of a fit while they still grow */
#define START 0.03              /* s / w from which the fit starts */

static const ss_value nothing = { NAN, NAN };

void
ss_ringdown_clear(ringdown *r)
{
    r->all[0] = r->all[1] = nothing;
    r->is_train = 0;
    r->slow = 0;
    for (size_t i = 0; i < r->n_anchors; i++) {
        r->window[i] = (ss_window){ r->anchor[i], r->anchor[i] };
        r->each[i][0] = r->each[i][1] = nothing;
    }
}

/* --- standard errors -------------------------------------------------------------------------- */

/* By the jackknife over windows, in its linearised form.  What it cannot see is a misfit that all
 * windows share, of the slow part or the ends: that moves the fit as the windows or the model change.
 * So windows are cut at their starts, or at their ends, and the slow part may bend; what that moves the
 * fit by, beyond what noise does, is added in quadrature.  So is what is left beyond white noise. */
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
static void
errors_by_curvature(const fitter *k, const linear *fit, ss_value value[2])
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
    errors_by_curvature(k, total, value);
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
static ss_status
find_errors(fitter *k, ss_value value[2])
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

/* --- fits --------------------------------------------------------------------------------------- */

/* Fit w and s to one window, and go back to those of all; a window without enough samples, or whose fit does not
 * converge, has no w and s of its own. */
static linear
fit_one(fitter *k, ss_window win, ss_value each[2])
{
    linear fitted = { 0 };
    double w = k->fit.w, s = k->fit.s;
    each[0] = each[1] = nothing;
    if (ss_window_length(win) > ss_varpro_columns(&k->fit) + 2 && ss_varpro_fit(&k->fit, &win, 1, FIT_FINE)) {
        fitted = ss_varpro_project(&k->fit, win);
        each[0].value = k->fit.w;
        each[1].value = k->fit.s;
        errors_by_curvature(k, &fitted, each);
    }
    k->fit.w = w, k->fit.s = s;
    return fitted;
}

/* --- all windows together -------------------------------------------------------------------- */

/* Fit w and s to all windows, and find the noise.  *ok: the fit has converged within an octave of its start: farther
 * off, windows are longer than the table. */
static ss_status
fit_shared(fitter *k, double tol, int *ok)
{
    *ok = ss_varpro_fit(&k->fit, k->window, k->n, tol) && fabs(log(k->fit.w / k->of->w)) < M_LN2;
    return *ok ? ss_sticks_noise(k) : SS_OK;
}

/* Is transition i one of so many, or beside one, up to whose core its window may grow? */
static int
is_beside(size_t i, size_t every)
{
    return i % every <= 1 || i % every + 1 == every;
}

/* Fit windows about some of the cores, longer and longer, as long as the fit converges near its start; then
 * windows about all cores, if some are long enough. */
static ss_status
grow_windows(fitter *k, ss_window *core, int *ok)
{
    const double start = k->fit.w;
    size_t every = 1 + k->n / ENOUGH, longest = periods(k, CORE);
    int is_growing = 1;
    for (size_t i = 0; i < k->n; i++)
        if (is_beside(i, every)) {
            core[i] = ss_sticks_place(k, k->of->anchor[i], CORE);
            k->window[i] = i % every == 0 ? core[i] : k->window[i];
        }
    ss_status st = fit_shared(k, FIT_FINE, ok);
    for (double limit = CORE * GROWTH; is_growing && limit < MOST; limit *= GROWTH) {
        *ok = *ok && fabs(log(k->fit.w / start)) < M_LN2 / 2;
        if (st != SS_OK || !*ok)
            return st;
        longest = periods(k, limit);
        ss_sticks_grow(k, core, every, longest);
        is_growing = 0;
        for (size_t i = 0; i < k->n; i += every)
            is_growing |= ss_window_length(k->window[i]) == longest;
        st = fit_shared(k, FIT_FINE, ok);
    }
    int lasts = 0;              /* else all cores would be placed in vain */
    for (size_t i = 0; i < k->n; i += every)
        lasts |= ss_window_length(ss_sticks_trim(k, k->window[i])) > 0;
    *ok = *ok && lasts;
    if (every == 1 || st != SS_OK || !*ok)
        return st;
    for (size_t i = 0; i < k->n; i++)
        if (!is_beside(i, every))
            core[i] = ss_sticks_place(k, k->of->anchor[i], CORE);
    ss_sticks_grow(k, core, 1, longest);
    return fit_shared(k, FIT_FINE, ok);
}

/* Cut all windows at a place, or empty the worst of them, until no micro-slip shows in them.  In a
 * small part of a train of them none shows, though all of it is one. */
static ss_status
leave_out_slips(fitter *k, int *ok)
{
    for (double grown = 0;;) {
        size_t at = 0, samples = 0;
        for (size_t i = 0; i < k->n; i++)
            samples += ss_window_length(k->window[i]);
        grown = grown > 0 ? grown : (double)samples;
        ss_status st = fit_shared(k, FIT_FINE, ok);
        if (st == SS_OK && *ok)
            st = ss_slips_find(k, &at);
        *ok = *ok && (double)samples >= KEPT * grown;
        if (st == SS_OK && *ok && at > 0 && !ss_sticks_split(k, at))
            st = ss_slips_drop_worst(k, at);
        if (st != SS_OK || !*ok || at == 0)
            return st;
    }
}

/* Fit with a slow part that is a line, or a sinusoid of the forcing. */
static ss_status
fit_all(fitter *k, ringdown *r, double forcing)
{
    int ok = 0, is_on = 0;
    ss_window *core = malloc((k->n + 1) * sizeof *core);
    if (core == NULL)
        return SS_ENOMEM;
    ss_ringdown_clear(r);
    k->window = r->window;
    k->fit.w = r->w, k->fit.s = START * r->w, k->fit.forcing = forcing;
    ss_status st = grow_windows(k, core, &ok);
    free(core);
    for (size_t i = 0; st == SS_OK && ok && i < k->n; i++)
        k->window[i] = ss_sticks_trim(k, k->window[i]);
    if (st == SS_OK && ok)
        st = leave_out_slips(k, &ok);
    if (st == SS_OK && ok)
        st = ss_slips_ring_on(k, &is_on);
    if (st != SS_OK || !ok)
        return st;
    r->is_train = ss_slips_recur(k);
    /* in the mean, the oscillation is larger than what noise alone would give */
    linear found = ss_varpro_project_all(&k->fit, k->window, k->n);
    int stands_out = found.ring > (double)found.windows * k->noise * ss_chisq2(FIT_CHANCE);
    if (is_on || !stands_out) {
        for (size_t i = 0; i < k->n; i++)
            k->window[i].end = k->window[i].first;
        return SS_OK;
    }
    r->all[0].value = k->fit.w;
    r->all[1].value = k->fit.s;
    st = find_errors(k, r->all);
    for (size_t i = 0; i < k->n; i++)
        fit_one(k, k->window[i], r->each[i]);
    return st;
}

ss_status
ss_ringdown_fit(ringdown *r)
{
    const double turn = 2 * M_PI / r->w;
    const size_t n = r->n_anchors;
    fitter k = { .of = r, .n = n };
    ss_ringdown_clear(r);
    double apart = n < 2 ? 0 : (double)(r->anchor[n - 1] - r->anchor[0]) / (double)(n - 1);
    if (!(apart >= APART * turn) || (r->forcing > 0 && M_PI / r->forcing < APART * turn))
        return SS_OK;
    size_t room = (size_t)ceil(4 * MOST * turn) + 2 * VARPRO_COLUMNS;
    room = room < r->n + 1 ? room : r->n + 1;           /* longer than any window */
    ringdown other = *r;
    double differ[2] = { 0, 0 };
    other.window = malloc((n + 1) * sizeof *other.window);
    other.each = malloc((n + 1) * sizeof *other.each);
    ss_status st = ss_varpro_init(&k.fit, r->x, room);
    if (other.window == NULL || other.each == NULL)
        st = SS_ENOMEM;
    if (st == SS_OK && r->is != SLOW_FORCED)
        st = fit_all(&k, r, 0);
    if (st == SS_OK && r->forcing > 0 && r->is != SLOW_LINE) {
        st = fit_all(&k, &other, r->forcing);
        for (int j = 0; j < 2; j++) {       /* where both explain it, what they differ by is an error, but for noise */
            double by = pow(r->all[j].value - other.all[j].value, 2), noise = pow(SIGMAS * r->all[j].error, 2)
                + pow(SIGMAS * other.all[j].error, 2);
            differ[j] = by > noise ? by - noise : 0;
        }
        if (!isnan(other.all[0].error) && !(other.all[0].error >= r->all[0].error)) {
            memcpy(r->window, other.window, n * sizeof *r->window);
            memcpy(r->each, other.each, n * sizeof *r->each);
            memcpy(r->all, other.all, sizeof r->all);
            r->is_train = other.is_train;
            r->slow = r->forcing;
        }
        for (int j = 0; j < 2; j++)
            r->all[j].error = hypot(r->all[j].error, sqrt(differ[j]));
    }
    ss_varpro_free(&k.fit);
    free(other.window);
    free(other.each);
    return st;
}

/* --- each window by itself ------------------------------------------------------------------- */

/* Fit each window of the least length by itself, and keep those that the oscillation explains well.  The residual
 * of a window may lie in the band of the oscillation, which moves a fit by the root of half the samples of a
 * window more than white noise would; where the fits do not scatter by that, they may all be moved alike. */
ss_status
ss_ringdown_fit_each(ringdown *r, double *scatter)
{
    fitter k = { .of = r, .n = r->n_anchors };
    size_t room = (size_t)ceil(4 * FIT_LEAST * M_PI / r->w) + 2 * VARPRO_COLUMNS;
    double *v = malloc(2 * (k.n + 1) * sizeof *v), *error = v + k.n + 1;
    ss_ringdown_clear(r);
    ss_status st = ss_varpro_init(&k.fit, r->x, room);
    if (v == NULL)
        st = SS_ENOMEM;
    k.fit.w = r->w, k.fit.s = START * r->w;
    for (size_t i = 0; st == SS_OK && i < k.n; i++) {
        ss_window win = ss_sticks_place(&k, r->anchor[i], FIT_LEAST);
        linear fitted = fit_one(&k, win, r->each[i]);
        if (fabs(log(r->each[i][0].value / r->w)) < M_LN2 / 2
            && fitted.ring > NEARLY * (fitted.ring + fitted.rss))
            r->window[i] = win;
        else
            r->each[i][0] = r->each[i][1] = nothing;
    }
    for (int j = 1; st == SS_OK && j >= 0; j--) {
        size_t used = 0;
        for (size_t i = 0; i < k.n; i++)
            if (!isnan(r->each[i][j].value)) {
                v[used] = r->each[i][j].value;
                error[used++] = r->each[i][j].error * sqrt(0.5 * (double)ss_window_length(r->window[i]));
            }
        if (used < FIT_FEW)
            break;
        *scatter = gsl_stats_sd(v, 1, used);
        double moved = gsl_stats_median(error, 1, used), shared = fmax(0, moved * moved - *scatter * *scatter);
        r->all[j].value = gsl_stats_median(v, 1, used);
        r->all[j].error = sqrt(M_PI / 2 * *scatter * *scatter / (double)used + shared);
    }
    ss_varpro_free(&k.fit);
    free(v);
    return st;
}
