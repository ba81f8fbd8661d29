/* ringdown.c -- one damped oscillation shared by many short windows of a signal.
 *
 * While the contact sticks, the signal is A exp(-s t) cos(w t) + B exp(-s t) sin(w t) + C + D t: the
 * line stands for the slow response to the base.  w and s belong to the contact and are the same in
 * every stick; A to D are not.  So A to D are projected out of each window (variable projection,
 * Golub and Pereyra 1973, with Kaufman's Jacobian), and two numbers are left to fit to all windows at
 * once, by GSL's Levenberg-Marquardt.
 *
 * Where a stick begins and ends is not known.  A core shorter than any stick that can be used is put
 * where an oscillation explains most; from there the window grows.  With w and s fixed, q more
 * samples raise the sum of squares by the noise's variance times chi-square of q degrees of freedom
 * if they still belong to the stick: growth ends where they raise it by more.  Micro-slips too weak
 * to show in one window are looked for in all together, at the same distance from their starts.
 *
 * Errors: by the jackknife over windows, in its linearised form.  What it cannot see is a misfit that
 * all windows share. */
#include "ringdown.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In periods of the oscillation. */
#define CORE 1.25               /* longer ones would not fit into a stick of two, wherever they lie */
#define LEAST 2.0               /* shorter windows cannot tell the oscillation from line and decay */
#define MOST 32.0               /* longer ones know no more, as the oscillation has decayed */
#define BLOCK 0.125             /* a step of growth */
#define TRIM_START 0.1          /* kept off the ends found, where a misfit not yet seen may hide */
#define TRIM_END 0.4

#define GROWTH 1.25             /* of the longest window from one fit to the next */
#define CHANCE 1e-3             /* of ending the growth at a block that belongs to the stick */
#define MISFIT 1e-3             /* of the oscillation's amplitude: the line's own error is taken for noise */
#define START 0.03              /* s / w that the fit starts from */
enum { FEW = 4 };               /* windows that a jackknife needs */
enum { COLUMNS = 4, PLACES = 16 };  /* PLACES: of the core, a period */

typedef struct work {
    const double *x;
    size_t n;
    double w, s;                /* per sample */
    double noise;               /* variance */
    size_t room;                /* samples of the longest window */
    double *q[COLUMNS];         /* orthonormal: 1, t, cos, sin */
    double *r;                  /* the residual */
    double *j;                  /* its derivatives by w and by s */
    size_t n_windows;
    const ss_window *window;
} work;

typedef struct linear {         /* what projecting a window gave */
    double rss;                 /* sum of squares left */
    double ring;                /* sum of squares that the oscillation explains */
    double a, b;                /* of cos and sin */
} linear;

static const ss_value nothing = { NAN, NAN };

static int
by_size(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static double
period(const work *k)
{
    return 2 * M_PI / k->w;
}

static size_t
periods(const work *k, double n)
{
    return (size_t)ceil(n * period(k));
}

static size_t
length(ss_window win)
{
    return win.end - win.first;
}

static double
dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Take its part along the unit vector q out of v; the part. */
static double
take_out(double *v, const double *q, size_t n)
{
    double part = dot(q, v, n);
    for (size_t i = 0; i < n; i++)
        v[i] -= part * q[i];
    return part;
}

static double
normalise(double *v, size_t n)
{
    double norm = sqrt(dot(v, v, n));
    for (size_t i = 0; i < n; i++)
        v[i] /= norm;
    return norm;
}

/* The columns exp(-s t) cos(w t) and exp(-s t) sin(w t), by rotation. */
static void
ring_columns(const work *k, double *c, double *s, size_t n)
{
    double step = exp(-k->s), turn_c = step * cos(k->w), turn_s = step * sin(k->w);
    c[0] = 1;
    s[0] = 0;
    for (size_t i = 1; i < n; i++) {
        c[i] = c[i - 1] * turn_c - s[i - 1] * turn_s;
        s[i] = c[i - 1] * turn_s + s[i - 1] * turn_c;
    }
}

/* Fill q and r for a window of at least COLUMNS samples, by modified Gram-Schmidt. */
static linear
project(work *k, ss_window win)
{
    size_t n = length(win);
    double z[COLUMNS], norm[COLUMNS], cross;
    for (size_t i = 0; i < n; i++) {
        k->q[0][i] = 1;
        k->q[1][i] = (double)i - 0.5 * (double)(n - 1);
    }
    ring_columns(k, k->q[2], k->q[3], n);
    normalise(k->q[0], n);
    normalise(k->q[1], n);
    for (int j = 2; j < COLUMNS; j++) {
        take_out(k->q[j], k->q[0], n);
        take_out(k->q[j], k->q[1], n);
    }
    norm[2] = normalise(k->q[2], n);
    cross = take_out(k->q[3], k->q[2], n);
    norm[3] = normalise(k->q[3], n);
    memcpy(k->r, k->x + win.first, n * sizeof *k->r);
    for (int j = 0; j < COLUMNS; j++)
        z[j] = take_out(k->r, k->q[j], n);
    double b = z[3] / norm[3];
    return (linear){ dot(k->r, k->r, n), z[2] * z[2] + z[3] * z[3], (z[2] - cross * b) / norm[2], b };
}

/* --- the fit of w and s -------------------------------------------------------------------- */

static int
residuals(const gsl_vector *at, void *user, gsl_vector *f)
{
    work *k = user;
    double *to = f->data;
    k->w = gsl_vector_get(at, 0);
    k->s = gsl_vector_get(at, 1);
    for (size_t i = 0; i < k->n_windows; i++) {
        size_t n = length(k->window[i]);
        if (n == 0)
            continue;
        project(k, k->window[i]);
        memcpy(to, k->r, n * sizeof *to);
        to += n;
    }
    return GSL_SUCCESS;
}

/* Kaufman: d r = -P (d Phi) c, Phi c the oscillation fitted and P what projects it out. */
static void
window_jacobian(work *k, ss_window win, double *j_w, double *j_s)
{
    size_t n = length(win);
    linear fit = project(k, win);
    ring_columns(k, j_w, j_s, n);
    for (size_t i = 0; i < n; i++) {
        double c = (double)i * j_w[i], s = (double)i * j_s[i];
        j_w[i] = fit.a * s - fit.b * c;
        j_s[i] = fit.a * c + fit.b * s;
    }
    for (int j = 0; j < COLUMNS; j++) {
        take_out(j_w, k->q[j], n);
        take_out(j_s, k->q[j], n);
    }
}

static int
jacobian(const gsl_vector *at, void *user, gsl_matrix *to)
{
    work *k = user;
    k->w = gsl_vector_get(at, 0);
    k->s = gsl_vector_get(at, 1);
    for (size_t i = 0, row = 0; i < k->n_windows; i++) {
        size_t n = length(k->window[i]);
        double *j_w = k->j, *j_s = k->j + k->room;
        if (n == 0)
            continue;
        window_jacobian(k, k->window[i], j_w, j_s);
        for (size_t l = 0; l < n; l++, row++) {
            gsl_matrix_set(to, row, 0, j_w[l]);
            gsl_matrix_set(to, row, 1, j_s[l]);
        }
    }
    return GSL_SUCCESS;
}

static size_t
total(const ss_window *window, size_t n)
{
    size_t sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += length(window[i]);
    return sum;
}

/* Fit k->w and k->s to n windows, from where they stand.  *ok: they have converged. */
static ss_status
fit(work *k, const ss_window *window, size_t n, int *ok)
{
    enum { STEPS = 50 };
    double w = k->w, s = k->s;
    size_t samples = total(window, n);
    int info;
    *ok = 0;
    if (samples == 0)
        return SS_OK;
    k->window = window;
    k->n_windows = n;
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf problem = { .f = residuals, .df = jacobian, .n = samples, .p = 2,
                                         .params = k };
    gsl_multifit_nlinear_workspace *space =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, samples, 2);
    if (space == NULL)
        return SS_ENOMEM;
    double start[2] = { w, s };
    gsl_vector_view at = gsl_vector_view_array(start, 2);
    if (gsl_multifit_nlinear_init(&at.vector, &problem, space) == GSL_SUCCESS) {
        int how_it_ended = gsl_multifit_nlinear_driver(STEPS, 1e-8, 0, 0, NULL, NULL, &info, space);
        w = gsl_vector_get(space->x, 0);
        s = gsl_vector_get(space->x, 1);
        /* no progress: it stands at the minimum already */
        *ok = (how_it_ended == GSL_SUCCESS || info == GSL_ENOPROG) && w > 0 && w < M_PI
            && isfinite(s);
    }
    k->w = w;
    k->s = s;
    gsl_multifit_nlinear_free(space);
    return SS_OK;
}

/* --- windows ------------------------------------------------------------------------------- */

/* What of the sum of squares the noise makes: its median over the windows, robust to those that
 * hold something else; not less than the misfit allowed for. */
static ss_status
find_noise(work *k, const ss_window *window, size_t n)
{
    double *variance = malloc(2 * n * sizeof *variance), *ring = variance + n;
    size_t used = 0;
    if (variance == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        if (length(window[i]) <= COLUMNS)
            continue;
        linear fitted = project(k, window[i]);
        double freedom = (double)(length(window[i]) - COLUMNS);
        variance[used] = fitted.rss / gsl_cdf_chisq_Pinv(0.5, freedom);
        ring[used++] = fitted.ring / (double)length(window[i]);
    }
    if (used > 0) {
        qsort(variance, used, sizeof *variance, by_size);
        qsort(ring, used, sizeof *ring, by_size);
        k->noise = fmax(variance[used / 2], MISFIT * MISFIT * ring[used / 2]);
    }
    free(variance);
    return SS_OK;
}

/* The core about an anchor: where the line and the oscillation leave least, among the places where
 * there is at least a quarter of the most oscillation. */
static ss_window
place_core(work *k, size_t anchor)
{
    size_t size = periods(k, CORE), step = 1 + periods(k, 1) / PLACES;
    size_t before = periods(k, 2), after = periods(k, 1);
    ss_window best = { 0, 0 };
    size = size > COLUMNS + 2 ? size : COLUMNS + 2;
    double most = 0, least = INFINITY;
    for (int pass = 0; pass < 2; pass++)
        for (size_t first = anchor > before ? anchor - before : 0;
             first <= anchor + after && first + size <= k->n; first += step) {
            ss_window here = { first, first + size };
            linear fitted = project(k, here);
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
belong(const work *k, double rise, size_t q)
{
    return rise <= k->noise * gsl_cdf_chisq_Qinv(CHANCE, (double)q);
}

/* Move one end of the window outwards, in steps down to one sample, at most room samples. */
static ss_window
grow(work *k, ss_window win, size_t room, int backwards)
{
    double start = project(k, win).rss, rss = start;
    size_t added = 0;
    for (size_t step = periods(k, BLOCK); step > 0; step /= 2)
        while (added + step <= room) {
            ss_window more = { win.first - (backwards ? step : 0), win.end + (backwards ? 0 : step) };
            double now = project(k, more).rss;
            if (!belong(k, now - rss, step) || !belong(k, now - start, added + step))
                break;
            win = more;
            rss = now;
            added += step;
        }
    return win;
}

static ss_window
grow_both(work *k, ss_window core, size_t low, size_t high, size_t longest)
{
    size_t most = longest - length(core), left = core.first - low;
    if (length(core) == 0 || project(k, core).rss > k->noise
                             * gsl_cdf_chisq_Qinv(CHANCE, (double)(length(core) - COLUMNS)))
        return (ss_window){ 0, 0 };
    ss_window win = grow(k, core, left < most ? left : most, 1);
    size_t right = high - win.end;
    most = longest - length(win);
    return grow(k, win, right < most ? right : most, 0);
}

/* The length at which all windows together show what does not belong to the stick, each not. */
static size_t
common_length(work *k, const ss_window *window, size_t n)
{
    size_t step = periods(k, BLOCK), at = periods(k, CORE);
    for (;; at += step) {
        double rise = 0;
        size_t q = 0;
        for (size_t i = 0; i < n; i++) {
            ss_window win = window[i];
            if (length(win) < at + step)
                continue;
            win.end = win.first + at;
            double rss = project(k, win).rss;
            win.end += step;
            rise += project(k, win).rss - rss;
            q += step;
        }
        if (q == 0 || !belong(k, rise, q))
            return q == 0 ? k->room : at;
    }
}

/* Keep off both ends, but not below the least length; empty if the window has not got it. */
static ss_window
trim(const work *k, ss_window win, size_t longest)
{
    size_t least = periods(k, LEAST);
    if (length(win) > longest)
        win.end = win.first + longest;
    if (length(win) < least)
        return (ss_window){ win.first, win.first };
    size_t spare = length(win) - least, start = periods(k, TRIM_START), end = periods(k, TRIM_END);
    start = start < spare ? start : spare;
    spare -= start;
    end = end < spare ? end : spare;
    return (ss_window){ win.first + start, win.end - end };
}

/* Windows about the cores, as the w, s and noise at hand show them. */
static void
find_windows(work *k, const ss_window *core, ss_window *window, size_t n, size_t limit)
{
    for (size_t i = 0; i < n; i++) {
        size_t low = i > 0 ? core[i - 1].end : 0, high = i + 1 < n ? core[i + 1].first : k->n;
        low = low < core[i].first ? low : core[i].first;
        high = high > core[i].end ? high : core[i].end;
        window[i] = grow_both(k, core[i], low, high, limit);
    }
}

/* --- standard errors ----------------------------------------------------------------------- */

/* Of one window: H = J'J and g = J'r, and the sum of squares. */
typedef struct normal {
    double ww, ws, ss, w, s, rss;
} normal;

static normal
normal_of(work *k, ss_window win)
{
    size_t n = length(win);
    double *j_w = k->j, *j_s = k->j + k->room;
    window_jacobian(k, win, j_w, j_s);
    return (normal){ dot(j_w, j_w, n), dot(j_w, j_s, n), dot(j_s, j_s, n), dot(j_w, k->r, n),
                     dot(j_s, k->r, n), dot(k->r, k->r, n) };
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
jackknife(work *k, const ss_window *window, size_t n, ss_value value[2])
{
    normal *each = malloc(n * sizeof *each), all = { 0 };
    double moved[2] = { 0, 0 }, mean[2] = { 0, 0 };
    size_t used = 0, samples = total(window, n);
    if (each == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        if (length(window[i]) == 0)
            continue;
        normal h = each[used++] = normal_of(k, window[i]);
        all.ww += h.ww, all.ws += h.ws, all.ss += h.ss;
        all.rss += h.rss;
    }
    errors_of_fit(&all, all.rss / (double)(samples - COLUMNS * used - 2), value);
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

/* --- all of it ----------------------------------------------------------------------------- */

static ss_status
fit_each(work *k, const ss_window *window, size_t n, ss_value *each)
{
    double w = k->w, s = k->s;
    ss_status st = SS_OK;
    int ok;
    for (size_t i = 0; i < n && st == SS_OK; i++) {
        if (length(window[i]) <= COLUMNS + 2)
            continue;
        k->w = w, k->s = s;
        st = fit(k, &window[i], 1, &ok);
        if (st != SS_OK || !ok)
            continue;
        normal h = normal_of(k, window[i]);
        each[2 * i].value = k->w;
        each[2 * i + 1].value = k->s;
        errors_of_fit(&h, h.rss / (double)(length(window[i]) - COLUMNS - 2), each + 2 * i);
    }
    k->w = w, k->s = s;
    return st;
}

static ss_status
fit_all(work *k, const size_t *anchor, size_t n, ss_window *core, ss_window *window,
        ss_value value[2], ss_value *each)
{
    double start = k->w;
    int ok = 0, more = 1;
    for (size_t i = 0; i < n; i++)
        core[i] = window[i] = place_core(k, anchor[i]);
    ss_status st = fit(k, core, n, &ok);
    if (st == SS_OK && ok)
        st = find_noise(k, core, n);
    for (double limit = CORE * GROWTH; more && limit < MOST; limit *= GROWTH) {
        if (st != SS_OK || !ok || !(fabs(log(k->w / start)) < M_LN2 / 2))   /* it is something else */
            return st;
        size_t longest = periods(k, limit);
        find_windows(k, core, window, n, longest);
        more = 0;
        for (size_t i = 0; i < n; i++)
            more |= length(window[i]) == longest;
        st = fit(k, window, n, &ok);
        if (st == SS_OK && ok)
            st = find_noise(k, window, n);
    }
    if (st != SS_OK || !ok)
        return st;
    size_t longest = common_length(k, window, n);
    for (size_t i = 0; i < n; i++)
        window[i] = trim(k, window[i], longest);
    st = fit(k, window, n, &ok);
    if (st != SS_OK || !ok)
        return st;
    value[0].value = k->w;
    value[1].value = k->s;
    st = jackknife(k, window, n, value);
    return st == SS_OK ? fit_each(k, window, n, each) : st;
}

ss_status
ss_ringdown_fit(const double *x, size_t n, const size_t *anchor, size_t n_anchors, double w,
                ss_window *window, ss_value value[2], ss_value *each)
{
    work k = { .x = x, .n = n, .w = w, .s = START * w };
    k.room = periods(&k, 2 * MOST) + 2 * COLUMNS;
    double *memory = malloc((COLUMNS + 3) * k.room * sizeof *memory);
    ss_window *core = malloc((n_anchors + 1) * sizeof *core);
    ss_status st = SS_ENOMEM;
    value[0] = value[1] = nothing;
    for (size_t i = 0; i < n_anchors; i++) {
        window[i] = (ss_window){ anchor[i], anchor[i] };
        each[2 * i] = each[2 * i + 1] = nothing;
    }
    if (memory != NULL && core != NULL) {
        for (int j = 0; j < COLUMNS; j++)
            k.q[j] = memory + (size_t)j * k.room;
        k.r = memory + COLUMNS * k.room;
        k.j = memory + (COLUMNS + 1) * k.room;
        st = fit_all(&k, anchor, n_anchors, core, window, value, each);
    }
    free(memory);
    free(core);
    return st;
}
