/* ringdown.c -- one damped oscillation shared by many short windows of a signal.
 *
 * While the contact sticks, the signal is A exp(-s t) cos(w t) + B exp(-s t) sin(w t) + C + D t: the
 * line stands for the slow response to the base. w and s belong to the contact and are the same in
 * every stick; A to D are not. varpro.c fits that to windows.
 *
 * Where a stick begins and ends is not known. A core shorter than any stick that can be used is put
 * where an oscillation explains most; from there the window grows. With w and s fixed, q more
 * samples raise the sum of squares by the noise's variance times chi-square of q degrees of freedom
 * if they still belong to the stick: growth ends where they raise it by more. Micro-slips too weak
 * to show in one window are looked for in all together, at the same distance from their starts.
 *
 * Errors: by the jackknife over windows, in its linearised form. What it cannot see is a misfit that
 * all windows share, of the slow part or the ends: that moves the fit as the windows change. So all
 * are cut at their starts, or at their ends, and half of what that moves the fit by, noise apart, is
 * added in quadrature.  So is all that the fit moves by, noise apart, when the slow part may bend,
 * see add_slow_part, or beside a steady line, see add_line; and what is left beyond white noise, see
 * add_colour. */
#include "features/ringdown.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "features/varpro.h"

/* In periods of the oscillation. */
#define CORE 1.25               /* fits into a stick of two wherever that lies */
#define LEAST 2.0               /* shorter ones cannot separate oscillation, line and decay */
#define MOST 16.0               /* longer ones know no more, as the oscillation has decayed */
#define BLOCK 0.125             /* a step of growth */
#define TRIM_START 0.1          /* kept off the ends found, where a misfit not yet seen may hide */
#define TRIM_END 0.4

#define GROWTH 1.25             /* of the longest window from one fit to the next */
#define CHANCE 1e-3             /* of ending the growth at a block that belongs to the stick */
#define BREAK 0.05              /* of cutting all windows where there is no micro-slip */
#define BREAK_EARLY 1e-3        /* the same before the least length: of refusing the lot */
#define WHITE 1.2               /* of the white noise's variance: more is coloured */
#define MISFIT 1e-3             /* of the oscillation's amplitude: passes for noise */
#define SEEN 2.0                /* standard deviations: a move that noise does not make */
#define LATEST 32.0             /* behind a window, see rings_on */
#define EXPLAINED 0.9           /* of the sum of squares, to keep a window all the same */
#define LASTS 0.15              /* of its amplitude at its end: with less it rang under 2 periods */
#define APART 3.0               /* periods a transition, or half-cycle of the base: two and a slip */
#define START 0.03              /* s / w that the fit starts from */
#define COARSE 1e-4             /* tolerance of fits while the windows still grow */
#define FINE 1e-8
#define LOWEST_LINE 0.7         /* re the oscillation's frequency, see add_line */
#define HIGHEST_LINE 1.4
enum { LINES = 15 };
enum { FEW = 4 };               /* windows that a jackknife needs */
enum { PLACES = 16 };           /* of the core, a period */

typedef struct fitter {
    varpro fit;
    size_t n;                   /* samples */
    double noise;               /* variance */
    double *limit;              /* see belong; 0: not known yet */
    size_t n_gaps;
    const ss_window *gap;
} fitter;

static const ss_value nothing = { NAN, NAN };

static double
period(const fitter *k)
{
    return 2 * M_PI / k->fit.w;
}

static size_t
periods(const fitter *k, double n)
{
    return (size_t)ceil(n * period(k));
}

/* --- windows ------------------------------------------------------------------------------- */

/* What of the sum of squares the noise makes: its median over the windows, robust to those that
 * hold something else; not less than the misfit allowed for. */
static ss_status
find_noise(fitter *k, const ss_window *window, size_t n)
{
    double *variance = malloc(2 * n * sizeof *variance);
    size_t used = 0;
    if (variance == NULL)
        return SS_ENOMEM;
    double *ring = variance + n;
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) <= k->fit.columns)
            continue;
        linear fitted = ss_varpro_project(&k->fit, window[i]);
        double freedom = (double)(ss_window_length(window[i]) - k->fit.columns);
        variance[used] = fitted.rss / gsl_cdf_chisq_Pinv(0.5, freedom);
        ring[used++] = fitted.ring / (double)ss_window_length(window[i]);
    }
    if (used > 0)
        k->noise = fmax(gsl_stats_select(variance, 1, used, used / 2),
                        MISFIT * MISFIT * gsl_stats_select(ring, 1, used, used / 2));
    free(variance);
    return SS_OK;
}

/* How many gaps begin before sample i. */
static size_t
gaps_before(const fitter *k, size_t i)
{
    size_t lo = 0, hi = k->n_gaps;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (k->gap[mid].first < i)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

static int
has_gap(const fitter *k, ss_window win)
{
    size_t g = gaps_before(k, win.end);
    return g > 0 && k->gap[g - 1].end > win.first;
}

/* The window of so many periods about an anchor where the line and the oscillation leave least,
 * among the places where there is at least a quarter of the most oscillation. */
static ss_window
place(fitter *k, size_t anchor, double size_in_periods)
{
    size_t size = periods(k, size_in_periods), step = 1 + periods(k, 1) / PLACES;
    size_t before = periods(k, 2), after = periods(k, 1);
    ss_window best = { 0, 0 };
    size = size > k->fit.columns + 2 ? size : k->fit.columns + 2;
    double most = 0, least = INFINITY;
    for (int pass = 0; pass < 2; pass++)
        for (size_t first = anchor > before ? anchor - before : 0;
             first <= anchor + after && first + size <= k->n; first += step) {
            ss_window here = { first, first + size };
            if (has_gap(k, here))
                continue;
            linear fitted = ss_varpro_project(&k->fit, here);
            if (pass == 0) {
                most = fmax(most, fitted.ring);
            } else if (fitted.ring >= 0.25 * most && fitted.rss < least) {
                least = fitted.rss;
                best = here;
            }
        }
    return best;
}

/* Do the q samples that raise the sum of squares by rise belong to the stick? */
static int
belong(fitter *k, double rise, size_t q)
{
    if (!(k->limit[q] > 0))
        k->limit[q] = gsl_cdf_chisq_Qinv(CHANCE, (double)q);
    return rise <= k->noise * k->limit[q];
}

/* Move one end of the window outwards, in steps down to one sample, at most room samples. */
static ss_window
grow(fitter *k, ss_window win, size_t room, int backwards)
{
    double start = ss_varpro_project(&k->fit, win).rss, rss = start;
    size_t added = 0;
    for (size_t step = periods(k, BLOCK); step > 0; step /= 2)
        while (added + step <= room) {
            ss_window more = win;
            if (backwards)
                more.first -= step;
            else
                more.end += step;
            double now = ss_varpro_project(&k->fit, more).rss;
            if (!belong(k, now - rss, step) || !belong(k, now - start, added + step))
                break;
            win = more;
            rss = now;
            added += step;
        }
    return win;
}

static ss_window
grow_both(fitter *k, ss_window core, size_t low, size_t high, size_t longest)
{
    if (ss_window_length(core) >= longest)
        return core;
    size_t most = longest - ss_window_length(core), left = core.first - low;
    if (ss_window_length(core) == 0 || !belong(k, ss_varpro_project(&k->fit, core).rss, ss_window_length(core) - k->fit.columns))
        return (ss_window){ 0, 0 };
    ss_window win = grow(k, core, left < most ? left : most, 1);
    size_t right = high - win.end;
    most = longest - ss_window_length(win);
    return grow(k, win, right < most ? right : most, 0);
}

/* --- micro-slips too weak for any one window ----------------------------------------------- */

/* A micro-slip changes the oscillation by a complex gain, and about equally in all sticks, at about
 * the same distance from their starts. So at each distance the gain is tried as a third parameter
 * beside w and s, in one linear step from the fit at hand (a score test): H and g gather J'J and J'r
 * over the windows; g' H^-1 g over the noise is chi-square of two degrees of freedom if all is well. */
enum { PARAMETERS = VARPRO_DERIVATIVES };   /* w, s, real and imaginary part of the gain */
typedef struct score {
    double h[PARAMETERS * PARAMETERS], g[PARAMETERS];
} score;

/* Add a window's at the places first, first + step, ... */
static void
add_scores(fitter *k, ss_window win, size_t first, size_t step, size_t n_places, score *to)
{
    size_t n = ss_window_length(win);
    double **j = k->fit.j;
    linear fitted = ss_varpro_derive(&k->fit, win);
    for (size_t l = 0; l < n_places; l++, to++) {
        size_t at = first + l * step;
        int used = at < n ? PARAMETERS : 2;
        if (at < n) {
            for (size_t i = 0; i < n; i++) {
                double c = i < at ? 0 : k->fit.ring.cos[i], s = i < at ? 0 : k->fit.ring.sin[i];
                j[2][i] = fitted.a * c + fitted.b * s;
                j[3][i] = fitted.b * c - fitted.a * s;
            }
            for (int p = 2; p < PARAMETERS; p++)
                ss_varpro_project_out(&k->fit, j[p], n);
        }
        for (int p = 0; p < used; p++) {
            for (int q = 0; q < used; q++)
                to->h[p * PARAMETERS + q] += ss_dot(j[p], j[q], n);
            to->g[p] += ss_dot(j[p], k->fit.r, n);
        }
    }
}

/* g' H^-1 g; destroys H. */
static double
statistic(score *at)
{
    double y[PARAMETERS], sum = 0;
    gsl_matrix_view h = gsl_matrix_view_array(at->h, PARAMETERS, PARAMETERS);
    gsl_vector_view v = gsl_vector_view_array(y, PARAMETERS);
    memcpy(y, at->g, sizeof y);
    if (gsl_linalg_cholesky_decomp1(&h.matrix) != GSL_SUCCESS)
        return 0;                       /* no window reaches there */
    gsl_linalg_cholesky_svx(&h.matrix, &v.vector);
    for (int p = 0; p < PARAMETERS; p++)
        sum += at->g[p] * y[p];
    return sum;
}

/* Where the gain changes most, if it does at all; *at is k->fit.room if not. */
static ss_status
find_break(fitter *k, const ss_window *window, size_t n, size_t *at)
{
    size_t step = periods(k, BLOCK), longest = 0;
    for (size_t i = 0; i < n; i++)
        longest = ss_window_length(window[i]) > longest ? ss_window_length(window[i]) : longest;
    size_t n_places = longest / step;
    score *place = calloc(n_places + 1, sizeof *place);
    if (place == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0)
            add_scores(k, window[i], step, step, n_places, place);
    double most = 1;
    *at = k->fit.room;
    for (size_t l = 0; l < n_places; l++) {
        double chance = (double)((l + 1) * step) < LEAST * period(k) ? BREAK_EARLY : BREAK;
        double limit = k->noise * gsl_cdf_chisq_Qinv(chance / (double)n_places, 2);
        double over = statistic(&place[l]) / limit;
        if (over > most) {
            most = over;
            *at = (l + 1) * step;
        }
    }
    free(place);
    return SS_OK;
}

/* Empty the window whose gain, taken by itself, changes most at a place. */
static void
drop_worst(fitter *k, ss_window *window, size_t n, size_t at)
{
    size_t worst = n;
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        score s = { { 0 }, { 0 } };
        if (ss_window_length(window[i]) <= at)
            continue;
        add_scores(k, window[i], at, 1, 1, &s);
        double found = statistic(&s);
        if (found > most) {
            most = found;
            worst = i;
        }
    }
    if (worst < n)
        window[worst].end = window[worst].first;
}

/* Cut the window at a longest length of at least the least, if it is longer, and keep off that end. */
static ss_window
cut(const fitter *k, ss_window win, size_t longest)
{
    size_t least = periods(k, LEAST), end = periods(k, TRIM_END);
    if (ss_window_length(win) <= longest)
        return win;
    win.end = win.first + longest;
    win.end -= end < longest - least ? end : longest - least;
    return win;
}

/* Keep off both ends as growth found them. */
static ss_window
trim(const fitter *k, ss_window win)
{
    size_t least = periods(k, LEAST), start = periods(k, TRIM_START);
    if (ss_window_length(win) < least)
        return (ss_window){ win.first, win.first };
    size_t spare = ss_window_length(win) - least;
    win.first += start < spare ? start : spare;
    return cut(k, win, ss_window_length(win) - 1);
}

/* Windows about the cores, as the w, s and noise at hand show them. */
static void
find_windows(fitter *k, const ss_window *core, ss_window *window, size_t n, size_t limit)
{
    for (size_t i = 0; i < n; i++) {
        size_t low = i > 0 ? core[i - 1].end : 0, high = i + 1 < n ? core[i + 1].first : k->n;
        size_t g = gaps_before(k, core[i].end);
        if (g > 0 && k->gap[g - 1].end > low)
            low = k->gap[g - 1].end;
        if (g < k->n_gaps && k->gap[g].first < high)
            high = k->gap[g].first;
        low = low < core[i].first ? low : core[i].first;
        high = high > core[i].end ? high : core[i].end;
        window[i] = grow_both(k, core[i], low, high, limit);
    }
}

/* --- oscillations that go on behind the windows -------------------------------------------- */

typedef struct tail {           /* behind a window */
    double left;                /* mean square that the ringing leaves there */
    ss_window at;
} tail;

/* So many periods behind the window, in a window of the least length and before limit; empty: that
 * cannot be looked at. */
static tail
tail_of(fitter *k, ss_window win, double late_by, size_t limit)
{
    size_t first = win.end + periods(k, late_by);
    ss_window late = { first, first + periods(k, LEAST) };
    if (ss_window_length(win) == 0 || late.end > limit || has_gap(k, (ss_window){ win.end, late.end }))
        return (tail){ 0, { 0, 0 } };
    double mean = ss_varpro_project(&k->fit, win).ring / (double)ss_window_length(win);
    double apart = (double)(late.first + late.end - win.first - win.end) / 2;
    return (tail){ mean * exp(-2 * k->fit.s * apart), late };
}

/* Is there an oscillation, as k->fit has it, of more than twice the amplitude that is left? */
static int
rings_there(fitter *k, tail behind)
{
    linear fitted = ss_varpro_project(&k->fit, behind.at);
    double m = (double)ss_window_length(behind.at);
    int is_one = fitted.ring > EXPLAINED * (fitted.ring + fitted.rss)
        || belong(k, fitted.rss, ss_window_length(behind.at) - k->fit.columns);
    return is_one && fitted.ring > 4 * m * behind.left + k->noise * gsl_cdf_chisq_Qinv(CHANCE, 2);
}

/* Does it ring, or hum at a frequency near, behind more than half of the windows? */
static int
rings_behind(fitter *k, const tail *behind, size_t n)
{
    static const double tone[] = { 0, 0.7, 0.85, 1, 1.15, 1.3 };   /* re w; 0: it itself */
    const double w = k->fit.w, s = k->fit.s;
    size_t seen = 0, most = 0;
    for (size_t t = 0; t < sizeof tone / sizeof *tone; t++) {
        size_t on = seen = 0;
        if (tone[t] > 0)
            k->fit.w = tone[t] * w, k->fit.s = 0;
        for (size_t i = 0; i < n; i++)
            if (ss_window_length(behind[i].at) > 0) {
                seen++;
                on += (size_t)rings_there(k, behind[i]);
            }
        most = on > most ? on : most;
    }
    k->fit.w = w, k->fit.s = s;
    return seen >= FEW && 2 * most > seen;
}

/* A train of micro-slips looks like a strongly damped oscillation, though the contact rings on behind
 * it; a hum goes on, too.  So all windows are looked behind at growing distances. */
static ss_status
rings_on(fitter *k, const ss_window *window, size_t n, int *is)
{
    tail *behind = malloc((n + 1) * sizeof *behind);
    if (behind == NULL)
        return SS_ENOMEM;
    *is = 0;
    for (double late_by = 2; late_by <= LATEST && !*is; late_by *= 2) {
        size_t limit = k->n;
        for (size_t i = n; i-- > 0;) {
            behind[i] = tail_of(k, window[i], late_by, limit);
            limit = ss_window_length(window[i]) > 0 ? window[i].first : limit;
        }
        *is = rings_behind(k, behind, n);
    }
    free(behind);
    return SS_OK;
}

/* --- standard errors ----------------------------------------------------------------------- */

/* Of one window: H = J'J and g = J'r, and the sum of squares. */
typedef struct normal {
    double ww, ws, ss, w, s, rss;
} normal;

static normal
normal_of(fitter *k, ss_window win)
{
    size_t n = ss_window_length(win);
    const double *j_w = k->fit.j[0], *j_s = k->fit.j[1], *r = k->fit.r;
    linear fitted = ss_varpro_derive(&k->fit, win);
    return (normal){ ss_dot(j_w, j_w, n), ss_dot(j_w, j_s, n), ss_dot(j_s, j_s, n),
                     ss_dot(j_w, r, n), ss_dot(j_s, r, n), fitted.rss };
}

/* The variances from the curvature of the sum of squares. */
static void
errors_of_fit(const normal *h, double variance, ss_value value[2])
{
    double det = h->ww * h->ss - h->ws * h->ws;
    value[0].error = sqrt(variance * h->ss / det);
    value[1].error = sqrt(variance * h->ww / det);
}

/* The jackknife in its linear form: without window i the fit moves by (H - H_i)^-1 g_i. */
static ss_status
jackknife(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    normal *each = malloc(n * sizeof *each), all = { 0 };
    double moved[2] = { 0, 0 }, mean[2] = { 0, 0 };
    size_t used = 0, samples = ss_window_total(window, n);
    if (each == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) == 0)
            continue;
        normal h = each[used++] = normal_of(k, window[i]);
        all.ww += h.ww, all.ws += h.ws, all.ss += h.ss;
        all.rss += h.rss;
    }
    errors_of_fit(&all, all.rss / (double)(samples - k->fit.columns * used - 2), value);
    for (int pass = 0; pass < 2 && used >= FEW; pass++)
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
    for (int j = 0; j < 2 && used >= FEW; j++)
        value[j].error = sqrt(moved[j] * (double)(used - 1) / (double)used);
    free(each);
    return SS_OK;
}

/* The variances of w and s from the curvature of the sum of squares of all windows; *variance: of
 * the samples, found if it is not known (negative). */
static void
variances(fitter *k, const ss_window *window, size_t n, double *variance, double of[2])
{
    normal all = { 0 };
    ss_value value[2];
    size_t used = 0;
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) == 0)
            continue;
        normal h = normal_of(k, window[i]);
        all.ww += h.ww, all.ws += h.ws, all.ss += h.ss;
        all.rss += h.rss;
        used++;
    }
    if (*variance < 0)
        *variance = all.rss / (double)(ss_window_total(window, n) - k->fit.columns * used - 2);
    errors_of_fit(&all, *variance, value);
    of[0] = value[0].error * value[0].error;
    of[1] = value[1].error * value[1].error;
}

/* Half of what w and s move by when all windows are cut by TRIM_END, at one end or the other, beyond
 * what noise moves them by: its variance is that of the cut fit less that of the whole (Hausman
 * 1978). */
static ss_status
add_misfit(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    const double at[2] = { k->fit.w, k->fit.s };
    double most[2] = { 0, 0 }, whole[2], less[2], variance = -1;
    size_t off = periods(k, TRIM_END);
    ss_window *cut_off = malloc(n * sizeof *cut_off);
    ss_status st = cut_off != NULL ? SS_OK : SS_ENOMEM;
    int ok;
    if (st == SS_OK)
        variances(k, window, n, &variance, whole);
    for (int end = 0; end < 2 && st == SS_OK; end++) {
        for (size_t i = 0; i < n; i++) {
            size_t part = off < ss_window_length(window[i]) ? off : ss_window_length(window[i]);
            cut_off[i] = window[i];
            if (end)
                cut_off[i].end -= part;
            else
                cut_off[i].first += part;
        }
        st = ss_varpro_fit(&k->fit, cut_off, n, FINE, &ok);
        if (st == SS_OK && ok) {
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
    return st;
}

/* What a filter leaves of a slip goes on into every stick, slowly and alike: neither the jackknife nor
 * shorter windows see all of it.  If the fit moves by more than SEEN standard deviations of what noise
 * moves it by (Hausman again) where the slow part may bend as a cubic, it is off by as much. */
static ss_status
add_slow_part(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    const double at[2] = { k->fit.w, k->fit.s };
    double whole[2], bent[2], variance = -1;
    int ok;
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0 && ss_window_length(window[i]) <= VARPRO_COLUMNS + 2)
            return SS_OK;
    variances(k, window, n, &variance, whole);
    ss_varpro_bend(&k->fit, 1);
    ss_status st = ss_varpro_fit(&k->fit, window, n, FINE, &ok);
    if (st == SS_OK && ok) {
        variances(k, window, n, &variance, bent);
        const double moved[2] = { k->fit.w - at[0], k->fit.s - at[1] };
        for (int j = 0; j < 2; j++)
            if (moved[j] * moved[j] > SEEN * SEEN * fmax(bent[j] - whole[j], 0))
                value[j].error = hypot(value[j].error, moved[j]);
    }
    ss_varpro_bend(&k->fit, 0);
    k->fit.w = at[0], k->fit.s = at[1];
    return st;
}

/* The sum of squares that all windows leave, with a steady line of frequency line in each. */
static double
rss_with_line(fitter *k, const ss_window *window, size_t n, double line)
{
    double sum = 0;
    ss_varpro_add_line(&k->fit, line);
    for (size_t i = 0; i < n; i++)
        if (ss_window_length(window[i]) > 0)
            sum += ss_varpro_project(&k->fit, window[i]).rss;
    return sum;
}

/* A line in every window that explains more than chance is no part of the model, of which the fit
 * may have taken it for one: it is off by what it moves by beside the line. */
static ss_status
add_line(fitter *k, const ss_window *window, size_t n, ss_value value[2])
{
    const double at[2] = { k->fit.w, k->fit.s };
    double least = INFINITY, best = 0, ring = 0;
    size_t used = 0, samples = ss_window_total(window, n);
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) == 0)
            continue;
        if (ss_window_length(window[i]) <= VARPRO_COLUMNS + 2)
            return SS_OK;
        ring += ss_varpro_project(&k->fit, window[i]).ring;
        used++;
    }
    double plain = rss_with_line(k, window, n, 0);
    for (int l = 0; l < LINES; l++) {
        double line = at[0] * (LOWEST_LINE + l * (HIGHEST_LINE - LOWEST_LINE) / (LINES - 1));
        double rss = rss_with_line(k, window, n, line);
        if (rss < least) {
            least = rss;
            best = line;
        }
    }
    double more = 2 * (double)used, left = (double)(samples - (k->fit.columns + 2) * used);
    double noise = fmax(least / left, MISFIT * MISFIT * ring / (double)samples);
    double F = (plain - least) / more / noise;
    ss_status st = SS_OK;
    if (F > gsl_cdf_fdist_Qinv(CHANCE / LINES, more, left)) {
        int ok;
        double variance = -1, with[2];
        ss_varpro_add_line(&k->fit, best);
        st = ss_varpro_fit(&k->fit, window, n, FINE, &ok);
        if (st == SS_OK && ok) {
            variances(k, window, n, &variance, with);
            const double moved[2] = { k->fit.w - at[0], k->fit.s - at[1] };
            for (int j = 0; j < 2; j++)
                value[j].error = sqrt(value[j].error * value[j].error + moved[j] * moved[j] + with[j]);
        } else
            value[0].error = value[1].error = INFINITY;
    }
    ss_varpro_add_line(&k->fit, 0);
    k->fit.w = at[0], k->fit.s = at[1];
    return st;
}

/* A residual above the white noise is no part of the model.  It may lie in the band of the oscillation:
 * then all of its energy in a window disturbs the fit, not only the share that white noise has there.
 * Nor is the fit finer than its tolerance. */
static void
add_colour(fitter *k, const ss_window *window, size_t n, double white, ss_value value[2])
{
    double variance = -1, unused[2];
    size_t used = 0, samples = ss_window_total(window, n);
    ss_value more[2];
    normal all = { 0 };
    variances(k, window, n, &variance, unused);
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) == 0)
            continue;
        normal h = normal_of(k, window[i]);
        all.ww += h.ww, all.ws += h.ws, all.ss += h.ss;
        used++;
    }
    double excess = fmax(0, variance - WHITE * white * white);
    errors_of_fit(&all, excess * 0.5 * (double)samples / (double)used, more);
    for (int j = 0; j < 2; j++)
        value[j].error = sqrt(value[j].error * value[j].error + more[j].error * more[j].error
                              + FINE * FINE * k->fit.w * k->fit.w);
}

/* --- each transition by itself ------------------------------------------------------------- */

static ss_status
fit_one(fitter *k, ss_window win, ss_value each[2], linear *fitted)
{
    int ok;
    double w = k->fit.w, s = k->fit.s;
    ss_status st = ss_varpro_fit(&k->fit, &win, 1, FINE, &ok);
    if (st == SS_OK && ok) {
        *fitted = ss_varpro_project(&k->fit, win);
        normal h = normal_of(k, win);
        each[0].value = k->fit.w;
        each[1].value = k->fit.s;
        errors_of_fit(&h, h.rss / (double)(ss_window_length(win) - k->fit.columns - 2), each);
    }
    k->fit.w = w, k->fit.s = s;
    return st;
}

static ss_status
fit_each(fitter *k, const ss_window *window, size_t n, ss_value *each)
{
    linear fitted;
    ss_status st = SS_OK;
    for (size_t i = 0; i < n && st == SS_OK; i++)
        if (ss_window_length(window[i]) > k->fit.columns + 2)
            st = fit_one(k, window[i], each + 2 * i, &fitted);
    return st;
}

/* Windows of the least length, each fitted by itself and kept if the oscillation explains it well. */
static ss_status
fit_rough(fitter *k, const size_t *anchor, size_t n, ss_window *window, ss_value *each)
{
    ss_status st = SS_OK;
    for (size_t i = 0; i < n && st == SS_OK; i++) {
        ss_window win = place(k, anchor[i], LEAST);
        ss_value own[2] = { nothing, nothing };
        linear fitted;
        if (ss_window_length(win) <= k->fit.columns + 2)
            continue;
        st = fit_one(k, win, own, &fitted);
        if (st != SS_OK || !(fabs(log(own[0].value / k->fit.w)) < M_LN2 / 2)
            || !(fitted.ring > EXPLAINED * (fitted.ring + fitted.rss))
            || !(exp(-own[1].value * (double)ss_window_length(win)) > LASTS))
            continue;
        memcpy(each + 2 * i, own, sizeof own);
        window[i] = win;
    }
    return st;
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
        if (used < FEW)
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

static ss_status
fit_all(fitter *k, const size_t *anchor, size_t n, double white, ss_window *core, ss_window *window,
        ss_value value[2], ss_value *each)
{
    double start = k->fit.w;
    int ok = 0, more = 1;
    for (size_t i = 0; i < n; i++)
        core[i] = window[i] = place(k, anchor[i], CORE);
    ss_status st = ss_varpro_fit(&k->fit, core, n, COARSE, &ok);
    if (st == SS_OK && ok)
        st = find_noise(k, core, n);
    for (double limit = CORE * GROWTH; more && limit < MOST; limit *= GROWTH) {
        if (st != SS_OK || !ok || !(fabs(log(k->fit.w / start)) < M_LN2 / 2))
            return st;                  /* or it is something else */
        size_t longest = periods(k, limit);
        find_windows(k, core, window, n, longest);
        more = 0;
        for (size_t i = 0; i < n; i++)
            more |= ss_window_length(window[i]) == longest;
        st = ss_varpro_fit(&k->fit, window, n, COARSE, &ok);
        if (st == SS_OK && ok)
            st = find_noise(k, window, n);
    }
    if (st != SS_OK || !ok)
        return st;
    for (size_t i = 0; i < n; i++)
        window[i] = trim(k, window[i]);
    size_t longest;
    do {
        st = ss_varpro_fit(&k->fit, window, n, FINE, &ok);
        if (st == SS_OK && ok)
            st = find_noise(k, window, n);
        if (st == SS_OK && ok)
            st = find_break(k, window, n, &longest);
        if (st != SS_OK || !ok)
            return st;
        if (longest < periods(k, LEAST))
            drop_worst(k, window, n, longest);
        else
            for (size_t i = 0; i < n; i++)
                window[i] = cut(k, window[i], longest);
    } while (longest < k->fit.room);
    int is_on;
    st = rings_on(k, window, n, &is_on);
    if (st == SS_OK && is_on) {
        for (size_t i = 0; i < n; i++)
            window[i].end = window[i].first;
        return SS_OK;
    }
    value[0].value = k->fit.w;
    value[1].value = k->fit.s;
    if (st == SS_OK)
        st = jackknife(k, window, n, value);
    if (st == SS_OK)
        st = add_misfit(k, window, n, value);
    if (st == SS_OK)
        st = add_slow_part(k, window, n, value);
    if (st == SS_OK)
        st = add_line(k, window, n, value);
    if (st == SS_OK)
        add_colour(k, window, n, white, value);
    return st == SS_OK ? fit_each(k, window, n, each) : st;
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
    ss_status st = fit_all(k, anchor, n, white, core, window, value, each);
    free(core);
    return st;
}

/* With either slow part; the one whose w is known better is kept. */
static ss_status
fit_both(fitter *k, const size_t *anchor, size_t n, double white, ss_window *window,
         ss_value value[2], ss_value *each, double forcing)
{
    double w = k->fit.w;
    ss_status st = fit_with(k, anchor, n, white, window, value, each);
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
        }
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
    ss_status st = ss_varpro_init(&k.fit, x, (size_t)ceil(4 * LEAST * M_PI / w) + 2 * VARPRO_COLUMNS);
    ss_varpro_start(&k.fit, w, START * w, 0);
    if (st == SS_OK)
        st = fit_rough(&k, anchor, n_anchors, window, each);
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
    size_t room = (size_t)ceil(2 * MOST * turn) + 2 * VARPRO_COLUMNS;
    ss_status st = ss_varpro_init(&k.fit, x, room);
    if (st == SS_OK && (k.limit = calloc(room, sizeof *k.limit)) == NULL)
        st = SS_ENOMEM;
    ss_varpro_start(&k.fit, w, START * w, 0);
    if (st == SS_OK)
        st = fit_both(&k, anchor, n_anchors, white, window, value, each, forcing);
    ss_varpro_free(&k.fit);
    free(k.limit);
    return st;
}
