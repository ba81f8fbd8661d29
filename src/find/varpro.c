/* varpro.c -- a damped oscillation fitted to windows of a signal; its linear parameters are
 * projected out.
 *
 * The signal of a window is A exp(-s t) cos(w t) + B exp(-s t) sin(w t), a slow part of two to
 * four columns, and a steady line if asked for.  The amplitudes are its own; w and s are those of all
 * windows.  So the amplitudes are projected out of each window (variable projection, Golub and Pereyra
 * 1973, with Kaufman's Jacobian), and two numbers are left to fit to all windows at once, by
 * Levenberg-Marquardt.
 *
 * The fit of a window needs only the products of its samples with the columns: all windows of one
 * length share g, the products of the columns with each other.  The last two columns are the
 * derivatives t exp(-s t) cos(w t) and t exp(-s t) sin(w t).  With g = l l' (Cholesky) and y = l^-1 x',
 * x' the products with the samples, the other columns explain their |y|^2, and J and J'r lie along the
 * last two.  The sum of squares that is left is known to some 1e-15 of the whole, so that its root is
 * known to 3e-8 of the signal: misfits that pass for noise are far larger. */
#include "find/varpro.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/versions.h"

enum { COLUMNS = VARPRO_COLUMNS, OFTEN = 16, STEPS = 50 };
#define DEPENDENT 1e-13         /* part of a column's square: less is rounding */
#define FIRST_DAMPING 1e-3
#define ROUNDING 1e-14          /* part of the sum of squares by which it may rise at its minimum */

ss_status
ss_varpro_init(varpro *v, const double *x, size_t room)
{
    *v = (varpro){ .x = x, .room = room };
    v->table.row = malloc(room * sizeof *v->table.row);
    v->table.sum = malloc((room / OFTEN + 1) * sizeof *v->table.sum);
    return v->table.row != NULL && v->table.sum != NULL ? SS_OK : SS_ENOMEM;
}

void
ss_varpro_free(varpro *v)
{
    free(v->table.row);
    free(v->table.sum);
}

void
ss_varpro_start(varpro *v, double w, double s, double forcing)
{
    v->w = w, v->s = s;
    v->forcing = forcing;
    v->is_bent = 0;
    v->line = 0;
}

size_t
ss_varpro_columns(const varpro *v)
{
    enum { RING = 2, LINE = 2 };
    size_t slow = (v->forcing > 0 ? 3 : 2) + (v->is_bent ? v->forcing > 0 ? 1 : 2 : 0);
    return slow + RING + (v->line > 0 ? LINE : 0);
}

/* --- columns and their sums ------------------------------------------------------------------ */

static wave
wave_of(double w, double s)
{
    return (wave){ 1, 0, exp(-s) * cos(w), exp(-s) * sin(w) };
}

static void
turn(wave *z)
{
    double next = z->cos * z->turn_cos - z->sin * z->turn_sin;
    z->sin = z->cos * z->turn_sin + z->sin * z->turn_cos;
    z->cos = next;
}

/* Where the forcing is slow, sin, 1 - cos and t - sin are about t, t^2 and t^3: cos and t themselves
 * would differ from the others by rounding only. */
static void
make_row(const varpro_table *tab, double t, double row[COLUMNS])
{
    double phase = tab->forcing * t, *next = row;
    memset(row, 0, COLUMNS * sizeof *row);
    *next++ = 1;
    *next++ = tab->forcing > 0 ? tab->slow.sin : t;
    if (tab->forcing > 0)
        *next++ = 1 - tab->slow.cos;
    else if (tab->is_bent)
        *next++ = t * t;
    if (tab->is_bent)
        *next++ = tab->forcing > 0 ? phase - tab->slow.sin : t * t * t;
    if (tab->line > 0)
        *next++ = tab->steady.cos, *next++ = tab->steady.sin;
    *next++ = tab->ring.cos, *next++ = tab->ring.sin;
    *next++ = t * tab->ring.cos, *next++ = t * tab->ring.sin;
}

/* Add the products of n rows' columns, of which the first `width` are in use. */
static inline void
add_products_of(double (*restrict row)[COLUMNS], size_t n, double (*restrict g)[COLUMNS], int width)
{
    for (size_t i = 0; i < n; i++)
        for (int j = 0; j < width; j++)
            for (int k = 0; k < width; k++)
                g[j][k] += row[i][j] * row[i][k];
}

VERSIONS static void
add_products(double (*restrict row)[COLUMNS], size_t n, double (*restrict g)[COLUMNS], size_t m)
{
    if (m + 2 <= VARPRO_NARROW)
        add_products_of(row, n, g, VARPRO_NARROW);
    else
        add_products_of(row, n, g, COLUMNS);
}

/* Add the products of n rows with x less level. */
static inline void
add_samples_of(const double *restrict x, double level, double (*restrict row)[COLUMNS], size_t n,
               double *restrict to, double *restrict xx, int width)
{
    double even[COLUMNS] = { 0 }, odd[COLUMNS] = { 0 }, squares[2] = { 0 };
    size_t i = 0;
    for (; i + 2 <= n; i += 2) {
        double a = x[i] - level, b = x[i + 1] - level;
        for (int k = 0; k < width; k++)
            even[k] += a * row[i][k];
        for (int k = 0; k < width; k++)
            odd[k] += b * row[i + 1][k];
        squares[0] += a * a, squares[1] += b * b;
    }
    if (i < n) {
        double a = x[i] - level;
        for (int k = 0; k < width; k++)
            even[k] += a * row[i][k];
        squares[0] += a * a;
    }
    for (int k = 0; k < width; k++)
        to[k] += even[k] + odd[k];
    *xx += squares[0] + squares[1];
}

VERSIONS static void
add_samples(const double *restrict x, double level, double (*restrict row)[COLUMNS], size_t n,
            double *restrict to, double *restrict xx, size_t m)
{
    if (m + 2 <= VARPRO_NARROW)
        add_samples_of(x, level, row, n, to, xx, VARPRO_NARROW);
    else
        add_samples_of(x, level, row, n, to, xx, COLUMNS);
}

/* The sums over the first n rows, whose last row may lack its sums so far. */
static void
sum_rows(const varpro_table *tab, size_t n, double (*g)[COLUMNS])
{
    size_t known = n > 0 ? (n - 1) / OFTEN : 0;
    if (known > 0)
        memcpy(g, tab->sum[known - 1], sizeof tab->sum[0]);
    else
        memset(g, 0, sizeof tab->sum[0]);
    add_products(tab->row + known * OFTEN, n - known * OFTEN, g, tab->m);
}

/* Begin the columns again if w, s, forcing, is_bent or line have changed. */
static void
restart(varpro *v)
{
    varpro_table *tab = &v->table;
    if (tab->w == v->w && tab->s == v->s && tab->forcing == v->forcing && tab->line == v->line
        && tab->is_bent == v->is_bent)
        return;
    tab->w = v->w, tab->s = v->s, tab->forcing = v->forcing, tab->line = v->line;
    tab->is_bent = v->is_bent;
    tab->ring = wave_of(v->w, v->s);
    tab->slow = wave_of(v->forcing, 0);
    tab->steady = wave_of(v->line, 0);
    tab->n = 0;
    tab->m = ss_varpro_columns(v);
    v->factored = 0;
}

/* Compute those of the first n rows that are not there yet. */
static void
extend(varpro *v, size_t n)
{
    varpro_table *tab = &v->table;
    restart(v);
    for (; tab->n < n; tab->n++) {
        make_row(tab, (double)tab->n, tab->row[tab->n]);
        turn(&tab->ring), turn(&tab->slow), turn(&tab->steady);
        if ((tab->n + 1) % OFTEN == 0)
            sum_rows(tab, tab->n + 1, tab->sum[tab->n / OFTEN]);
    }
}

void
ss_varpro_sums_start(const varpro *v, size_t origin, varpro_sums *sums)
{
    *sums = (varpro_sums){ .origin = origin, .m = ss_varpro_columns(v), .level = v->x[origin] };
}

void
ss_varpro_sums_add(varpro *v, ss_window more, varpro_sums *sums)
{
    size_t from = more.first - sums->origin, n = ss_window_length(more);
    extend(v, from + n);
    add_products(v->table.row + from, n, sums->g, sums->m);
    add_samples(v->x + more.first, sums->level, v->table.row + from, n, sums->x, &sums->xx, sums->m);
}

/* --- projection ------------------------------------------------------------------------------ */

/* The first n columns.  A column that depends on those before is left out: its row of l and what is below
 * it are 0. */
static void
factorise(double (*g)[COLUMNS], double (*l)[COLUMNS], size_t n)
{
    for (size_t j = 0; j < n; j++) {
        double pivot = g[j][j];
        for (size_t k = 0; k < j; k++)
            pivot -= l[j][k] * l[j][k];
        l[j][j] = pivot > DEPENDENT * g[j][j] ? sqrt(pivot) : 0;
        for (size_t i = j + 1; i < n; i++) {
            double sum = g[i][j];
            for (size_t k = 0; k < j && l[j][j] > 0; k++)
                sum -= l[i][k] * l[j][k];
            l[i][j] = l[j][j] > 0 ? sum / l[j][j] : 0;
        }
    }
}

/* The first n elements of l^-1 times `of`. */
static void
substitute(const varpro_factor *f, const double of[COLUMNS], double to[COLUMNS], size_t n)
{
    for (size_t j = 0; j < n; j++) {
        double sum = of[j];
        to[j] = 0;
        if (!(f->l[j][j] > 0))
            continue;
        for (size_t k = 0; k < j; k++)
            sum -= f->l[j][k] * to[k];
        to[j] = sum / f->l[j][j];
    }
}

void
ss_varpro_substitute(const varpro_factor *f, const double of[COLUMNS], double to[COLUMNS])
{
    substitute(f, of, to, f->m + 2);
}

/* Kaufman: d r = -P (d Phi) c, Phi c the oscillation fitted and P what projects it out. */
void
ss_varpro_derivatives(const varpro_factor *f, double a, double b, double by_w[2], double by_s[2])
{
    const double *c = &f->l[f->m][f->m], *s = &f->l[f->m + 1][f->m];
    by_w[0] = a * s[0] - b * c[0], by_w[1] = a * s[1];
    by_s[0] = a * c[0] + b * s[0], by_s[1] = b * s[1];
}

/* The residual of the sum of squares xx. */
static double
left_of(const varpro_factor *f, double xx)
{
    for (size_t j = 0; j < f->m; j++)
        xx -= f->y[j] * f->y[j];
    return fmax(xx, 0);
}

static linear
linear_of(const varpro_factor *f, double xx)
{
    const size_t at_cos = f->m - 2, at_sin = f->m - 1;
    const double *y = f->y, *left = y + f->m;
    linear fit = { .whole = xx, .rss = left_of(f, xx) };
    fit.ring = y[at_cos] * y[at_cos] + y[at_sin] * y[at_sin];
    double c = f->l[at_cos][at_cos], s = f->l[at_sin][at_sin], w[2], d[2];
    fit.b = s > 0 ? y[at_sin] / s : 0;
    fit.a = c > 0 ? (y[at_cos] - f->l[at_sin][at_cos] * fit.b) / c : 0;
    ss_varpro_derivatives(f, fit.a, fit.b, w, d);
    fit.normal = (normal){ w[0] * w[0] + w[1] * w[1], w[0] * d[0] + w[1] * d[1],
                           d[0] * d[0] + d[1] * d[1], w[0] * left[0] + w[1] * left[1],
                           d[0] * left[0] + d[1] * left[1] };
    return fit;
}

double
ss_varpro_left(varpro_sums *sums)
{
    varpro_factor f;
    f.m = sums->m;
    factorise(sums->g, f.l, f.m);
    substitute(&f, sums->x, f.y, f.m);
    return left_of(&f, sums->xx);
}

/* The factor for windows of n samples. */
static void
find_factor(varpro *v, size_t n)
{
    double g[COLUMNS][COLUMNS];
    extend(v, n);
    if (v->factored == n)
        return;
    sum_rows(&v->table, n, g);
    v->factor.m = v->table.m;
    factorise(g, v->factor.l, v->factor.m + 2);
    v->factored = n;
}

linear
ss_varpro_project(varpro *v, ss_window win)
{
    size_t n = ss_window_length(win);
    double x[COLUMNS] = { 0 }, xx = 0;
    find_factor(v, n);
    add_samples(v->x + win.first, v->x[win.first], v->table.row, n, x, &xx, v->table.m);
    ss_varpro_substitute(&v->factor, x, v->factor.y);
    linear fit = linear_of(&v->factor, xx);
    fit.windows = 1;
    fit.samples = n;
    return fit;
}

linear
ss_varpro_project_all(varpro *v, const ss_window *window, size_t n)
{
    linear all = { 0 };
    for (size_t i = 0; i < n; i++) {
        if (ss_window_length(window[i]) == 0)
            continue;
        linear one = ss_varpro_project(v, window[i]);
        all.windows += one.windows, all.samples += one.samples;
        all.whole += one.whole, all.rss += one.rss, all.ring += one.ring;
        all.normal.ww += one.normal.ww, all.normal.ws += one.normal.ws;
        all.normal.ss += one.normal.ss;
        all.normal.w += one.normal.w, all.normal.s += one.normal.s;
    }
    return all;
}

/* --- the fit of w and s -------------------------------------------------------------------- */

/* Fit all windows at this w and s. */
static linear
project_at(varpro *v, const ss_window *window, size_t n, const double at[2])
{
    v->w = at[0], v->s = at[1];
    return ss_varpro_project_all(v, window, n);
}

/* The next w and s of Levenberg and Marquardt; 0: they are out of range. */
static int
next_place(const normal *h, double damping, const double at[2], double next[2])
{
    double ww = h->ww * (1 + damping), ss = h->ss * (1 + damping), det = ww * ss - h->ws * h->ws;
    next[0] = at[0] + (h->ws * h->s - ss * h->w) / det;
    next[1] = at[1] + (h->ws * h->w - ww * h->s) / det;
    return next[0] > 0 && next[0] < M_PI && isfinite(next[1]);
}

static int
is_near(const double a[2], const double b[2], double tol)
{
    return fabs(b[0] - a[0]) <= tol * (fabs(a[0]) + tol)
        && fabs(b[1] - a[1]) <= tol * (fabs(a[1]) + tol);
}

/* A short step that does not lessen the residual ends the fit, too: it stands at the minimum already. */
int
ss_varpro_fit(varpro *v, const ss_window *window, size_t n, double tol)
{
    double at[2] = { v->w, v->s }, next[2], damping = FIRST_DAMPING;
    linear here = project_at(v, window, n, at), there;
    int ended = 0;
    for (int i = 0; i < STEPS && !ended; i++) {
        int is_place = next_place(&here.normal, damping, at, next);
        if (is_place)
            there = project_at(v, window, n, next);
        ended = is_place && is_near(at, next, tol);
        if (is_place && there.rss <= here.rss + ROUNDING * here.whole) {
            memcpy(at, next, sizeof at);
            here = there;
            damping /= 10;
        } else
            damping *= 10;
    }
    v->w = at[0], v->s = at[1];
    return ended;
}
