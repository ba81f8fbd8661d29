/* ringdown.c -- one damped oscillation shared by many short windows of a signal.
 *
 * While the contact sticks, the signal is A exp(-s t) cos(w t) + B exp(-s t) sin(w t) + C + D t.  The
 * line C + D t stands for the slow response to the base.  The contact sets w and s, which are the same
 * in every stick; A to D differ.  varpro.c fits this to windows.
 *
 * It is not known where a stick begins and ends; sticks.c finds that.  Some micro-slips are too weak to
 * show in one window; slips.c looks for them in all windows together, at the same distance from their
 * starts.  errors.c finds the errors of w and s. */
#include "find/ringdown.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "find/fitter.h"

/* Lengths in periods of the oscillation. */
#define CORE 1.25               /* fits into a stick of two wherever that lies */
#define MOST 16.0               /* the longest window: the oscillation has decayed by its end */
#define APART 3.0               /* least periods in a transition or half-cycle of the base: a window of two,
                                   and the slip */

#define GROWTH 1.25             /* factor by which the longest window grows from one fit to the next */
#define KEPT 0.6                /* the least part of the windows that is kept without micro-slips: a train
                                   keeps less */
#define LASTING 3.0             /* times the decay time 1/s: a longer window shows no more, as 5 % are left
                                   then */
enum { ENOUGH = 256 };          /* the most windows of a fit while they still grow */
#define LASTS 0.15              /* part of the amplitude that is left at the end: with less it rang for under
                                   2 periods */
#define START 0.03              /* s / w from which the fit starts */
#define COARSE 1e-4             /* tolerance of fits while the windows still grow */

static const ss_value nothing = { NAN, NAN };

/* --- each transition by itself ------------------------------------------------------------- */

static linear
fit_one(fitter *k, ss_window win, ss_value each[2])
{
    linear fitted = { 0 };
    double w = k->fit.w, s = k->fit.s;
    if (ss_varpro_fit(&k->fit, &win, 1, FIT_FINE)) {
        fitted = ss_varpro_project(&k->fit, win);
        each[0].value = k->fit.w;
        each[1].value = k->fit.s;
        ss_errors_of_one(k, &fitted, each);
    }
    k->fit.w = w, k->fit.s = s;
    return fitted;
}

static void
fit_each(fitter *k, const ss_window *window, size_t n, ss_value *each)
{
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > ss_varpro_columns(&k->fit) + 2)
            fit_one(k, window[i], each + 2 * i);
}

/* Fit each window of the least length by itself, and keep those that the oscillation explains well. */
static void
fit_rough(fitter *k, const size_t *anchor, size_t n, ss_window *window, ss_value *each)
{
    for (size_t i = 0; i < n; i++) {
        ss_window win = ss_sticks_place(k, anchor[i], FIT_LEAST);
        ss_value own[2] = { nothing, nothing };
        if (ss_window_length(win) <= ss_varpro_columns(&k->fit) + 2)
            continue;
        linear fitted = fit_one(k, win, own);
        if (!(fabs(log(own[0].value / k->fit.w)) < M_LN2 / 2)
            || !(fitted.ring > FIT_EXPLAINED * (fitted.ring + fitted.rss))
            || !(exp(-own[1].value * (double)ss_window_length(win)) > LASTS))
            continue;
        memcpy(each + 2 * i, own, sizeof own);
        window[i] = win;
    }
}

/* The median of the single fits, and its error from their scatter.  The residual of a window may lie in
 * the band of the oscillation, which moves a fit by the root of half the samples of a window more than
 * white noise would.  Where the fits do not scatter by that, they may all be moved alike. */
static ss_status
median_of_fits(const ss_window *window, size_t n, const ss_value *each, ss_value value[2])
{
    double *v = malloc((n + 1) * sizeof *v);
    if (v == NULL)
        return SS_ENOMEM;
    for (int j = 0; j < 2; j++) {
        double mean = 0, scatter = 0;
        size_t used = 0;
        for (size_t i = 0; i < n; i++)
            if (ss_window_length(window[i]) > 0 && !isnan(each[2 * i + j].value))
                v[used++] = each[2 * i + j].error * sqrt(0.5 * (double)ss_window_length(window[i]));
        if (used < FIT_FEW)
            break;
        double moved = gsl_stats_median(v, 1, used);
        used = 0;
        for (size_t i = 0; i < n; i++)
            if (ss_window_length(window[i]) > 0 && !isnan(each[2 * i + j].value))
                v[used++] = each[2 * i + j].value;
        for (size_t i = 0; i < used; i++)
            mean += v[i] / (double)used;
        for (size_t i = 0; i < used; i++)
            scatter += (v[i] - mean) * (v[i] - mean) / (double)(used - 1);
        value[j].value = gsl_stats_median(v, 1, used);
        value[j].error = sqrt(M_PI / 2 * scatter / (double)used         /* of a Gaussian's median */
                              + fmax(0, moved * moved - scatter));
    }
    free(v);
    return SS_OK;
}

/* --- all of it ----------------------------------------------------------------------------- */

/* Fit w and s to all windows, and find the noise.  *ok: the fit has converged. */
static ss_status
fit_shared(fitter *k, const ss_window *window, size_t n, double tol, int *ok)
{
    *ok = ss_varpro_fit(&k->fit, window, n, tol);
    return *ok ? ss_sticks_noise(k, window, n) : SS_OK;
}

/* Is the oscillation in the windows, in the mean, larger than what noise alone would give there? */
static int
stands_out(fitter *k, const ss_window *window, size_t n)
{
    linear all = ss_varpro_project_all(&k->fit, window, n);
    return all.ring > (double)all.windows * k->noise * ss_chisq2(FIT_CHANCE);
}

/* Cores to fit: one of so many; the cores beside them, up to which they may grow; or all others. */
typedef enum cores { SOME, BESIDE, OTHERS } cores;

static cores
cores_of(size_t i, size_t every)
{
    size_t phase = i % every;
    return phase == 0 ? SOME : phase == 1 || phase + 1 == every ? BESIDE : OTHERS;
}

/* Place cores about their anchors, for an oscillation of w and s. */
static void
place_cores(fitter *k, const double at[2], const size_t *anchor, ss_window *core, size_t n, size_t every,
            cores which)
{
    const double found[2] = { k->fit.w, k->fit.s };
    k->fit.w = at[0], k->fit.s = at[1];
    for (size_t i = 0; i < n; i++)
        if (cores_of(i, every) == which)
            core[i] = ss_sticks_place(k, anchor[i], CORE);
    k->fit.w = found[0], k->fit.s = found[1];
}

/* Does one of every so many windows have the least length? */
static int
lasts(const fitter *k, const ss_window *window, size_t n, size_t every)
{
    for (size_t i = 0; i < n; i += every)
        if (ss_window_length(ss_sticks_trim(k, window[i])) > 0)
            return 1;
    return 0;
}

/* Fit windows about some of the cores, longer and longer, as long as the fit converges near its start; then
 * windows about all cores, if some are long enough. */
static ss_status
grow_windows(fitter *k, const size_t *anchor, ss_window *core, ss_window *window, size_t n, int *ok)
{
    const double start[2] = { k->fit.w, k->fit.s };
    size_t every = 1 + n / ENOUGH, longest = 0;
    int more = 1;
    place_cores(k, start, anchor, core, n, every, SOME);
    for (size_t i = 0; i < n; i++)
        window[i] = i % every == 0 ? core[i] : (ss_window){ anchor[i], anchor[i] };
    ss_status st = fit_shared(k, window, n, COARSE, ok);
    for (double limit = CORE * GROWTH; more && limit < MOST; limit *= GROWTH) {
        *ok = *ok && fabs(log(k->fit.w / start[0])) < M_LN2 / 2;    /* else it is another oscillation */
        if (st != SS_OK || !*ok)
            return st;
        if (longest == 0)
            place_cores(k, start, anchor, core, n, every, BESIDE);
        longest = periods(k, limit);
        ss_sticks_find(k, core, window, n, every, longest);
        more = 0;
        for (size_t i = 0; i < n; i += every)
            more |= ss_window_length(window[i]) == longest;
        st = fit_shared(k, window, n, COARSE, ok);
    }
    *ok = *ok && lasts(k, window, n, every);
    if (every == 1 || st != SS_OK || !*ok)
        return st;
    place_cores(k, start, anchor, core, n, every, OTHERS);
    ss_sticks_find(k, core, window, n, 1, longest);
    return fit_shared(k, window, n, COARSE, ok);
}

/* The number of samples in all windows; in each at most those for which an oscillation lasts. */
static double
samples_in(const ss_window *window, size_t n, double lasting)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += fmin((double)ss_window_length(window[i]), lasting);
    return sum;
}

/* Cut all windows at a place, or empty the worst of them, until no micro-slip shows in them.  In a
 * small part of a train of them none shows, though all of it is one. */
static ss_status
leave_out_slips(fitter *k, ss_window *window, size_t n, int *ok)
{
    const double lasting = k->fit.s > 0 ? LASTING / k->fit.s : INFINITY;
    const double grown = samples_in(window, n, lasting);
    ss_status st = SS_OK;
    for (;;) {
        size_t at = 0;
        int from_end = 0;
        if (st == SS_OK)
            st = fit_shared(k, window, n, FIT_FINE, ok);
        for (; st == SS_OK && *ok && at == 0 && from_end < 2; from_end++)
            st = ss_slips_find(k, window, n, from_end, &at);
        *ok = *ok && samples_in(window, n, lasting) >= KEPT * grown;
        if (at == 0 || !*ok || st != SS_OK)
            return st;
        if (!ss_sticks_split(k, window, n, at, --from_end))
            st = ss_slips_drop_worst(k, window, n, at, from_end);
    }
}

/* Does every window have enough samples for all columns?  A window with fewer is not tested. */
static int
are_long(const ss_window *window, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0 && ss_window_length(window[i]) <= VARPRO_MOST + 2)
            return 0;
    return 1;
}

static ss_status
fit_all(fitter *k, const size_t *anchor, size_t n, double white, ss_window *core, ss_window *window,
        ss_value value[2], ss_value *each)
{
    int ok = 0, is_on;
    ss_status st = grow_windows(k, anchor, core, window, n, &ok);
    if (st != SS_OK || !ok)
        return st;
    for (size_t i = 0; i < n; i++)
        window[i] = ss_sticks_trim(k, window[i]);
    st = leave_out_slips(k, window, n, &ok);
    if (st != SS_OK || !ok)
        return st;
    st = ss_slips_ring_on(k, window, n, &is_on);
    k->is_train = ss_slips_recur(k, window, n);
    if (st == SS_OK && (is_on || !are_long(window, n) || !stands_out(k, window, n))) {
        for (size_t i = 0; i < n; i++)
            window[i].end = window[i].first;
        return SS_OK;
    }
    value[0].value = k->fit.w;
    value[1].value = k->fit.s;
    if (st == SS_OK)
        st = ss_errors_find(k, window, n, white, value);
    fit_each(k, window, n, each);
    return st;
}

void
ss_ringdown_clear(const size_t *anchor, size_t n, ss_window *window, ss_value value[2], ss_value *each)
{
    value[0] = value[1] = nothing;
    for (size_t i = 0; i < n; i++) {
        window[i] = (ss_window){ anchor[i], anchor[i] };
        each[2 * i] = each[2 * i + 1] = nothing;
    }
}

static ss_status
fit_with(fitter *k, const size_t *anchor, size_t n, double white, ss_window *window,
         ss_value value[2], ss_value *each)
{
    ss_window *core = malloc((n + 1) * sizeof *core);
    if (core == NULL)
        return SS_ENOMEM;
    ss_ringdown_clear(anchor, n, window, value, each);
    k->is_train = 0;
    ss_status st = fit_all(k, anchor, n, white, core, window, value, each);
    free(core);
    return st;
}

/* Fit with either slow part, and keep the fit whose w is known better. */
static ss_status
fit_both(fitter *k, const size_t *anchor, size_t n, double white, ss_window *window,
         ss_value value[2], ss_value *each, double forcing)
{
    double w = k->fit.w;
    ss_status st = fit_with(k, anchor, n, white, window, value, each);
    int is_train = k->is_train;
    if (st != SS_OK || !(forcing > 0))
        return st;
    ss_window *other = malloc((n + 1) * sizeof *other);
    ss_value *other_each = malloc(2 * (n + 1) * sizeof *other_each), other_value[2];
    st = SS_ENOMEM;
    if (other != NULL && other_each != NULL) {
        ss_varpro_start(&k->fit, w, START * w, forcing);
        st = fit_with(k, anchor, n, white, other, other_value, other_each);
        if (st == SS_OK && !(other_value[0].error >= value[0].error)
            && !isnan(other_value[0].error)) {
            memcpy(window, other, n * sizeof *window);
            memcpy(each, other_each, 2 * n * sizeof *each);
            memcpy(value, other_value, sizeof other_value);
        } else
            k->is_train = is_train;
    }
    free(other);
    free(other_each);
    return st;
}

ss_status
ss_ringdown_fit_each(const double *x, size_t n, const size_t *anchor, size_t n_anchors, double w,
                     const ss_window *gap, size_t n_gaps, ss_window *window, ss_value value[2],
                     ss_value *each)
{
    fitter k = { .n = n, .n_gaps = n_gaps, .gap = gap };
    ss_ringdown_clear(anchor, n_anchors, window, value, each);
    ss_status st = ss_varpro_init(&k.fit, x, (size_t)ceil(4 * FIT_LEAST * M_PI / w) + 2 * VARPRO_COLUMNS);
    ss_varpro_start(&k.fit, w, START * w, 0);
    if (st == SS_OK)
        fit_rough(&k, anchor, n_anchors, window, each);
    if (st == SS_OK)
        st = median_of_fits(window, n_anchors, each, value);
    ss_varpro_free(&k.fit);
    return st;
}

ss_status
ss_ringdown_fit(const double *x, size_t n, const size_t *anchor, size_t n_anchors, double w,
                double forcing, double white, const ss_window *gap, size_t n_gaps,
                ss_window *window, ss_value value[2], ss_value *each)
{
    fitter k = { .n = n, .n_gaps = n_gaps, .gap = gap };
    const double turn = 2 * M_PI / w;
    ss_ringdown_clear(anchor, n_anchors, window, value, each);
    double apart = n_anchors < 2 ? 0
        : (double)(anchor[n_anchors - 1] - anchor[0]) / (double)(n_anchors - 1);
    if (!(apart >= APART * turn) || (forcing > 0 && M_PI / forcing < APART * turn))
        return SS_OK;
    size_t room = (size_t)ceil(4 * MOST * turn) + 2 * VARPRO_COLUMNS;
    room = room < n + 1 ? room : n + 1;         /* longer than any window */
    ss_status st = ss_varpro_init(&k.fit, x, room);
    if (st == SS_OK && (k.limit = calloc(2 * room, sizeof *k.limit)) == NULL)
        st = SS_ENOMEM;
    k.median = k.limit != NULL ? k.limit + room : NULL;
    ss_varpro_start(&k.fit, w, START * w, 0);
    if (st == SS_OK)
        st = fit_both(&k, anchor, n_anchors, white, window, value, each, forcing);
    if (k.is_train)
        value[0].error = value[1].error = INFINITY;
    ss_varpro_free(&k.fit);
    free(k.limit);
    return st;
}
