/* varpro.c -- a damped oscillation fitted to windows of a signal; its linear parameters are
 * projected out.
 *
 * The signal of a window is A exp(-s t) cos(w t) + B exp(-s t) sin(w t) and a slow part of two to
 * four columns.  The amplitudes are its own; w and s are those of all windows.  So the amplitudes are
 * projected out of each window (variable projection, Golub and Pereyra 1973, with Kaufman's Jacobian),
 * and two numbers are left to fit to all windows at once, by Levenberg-Marquardt.
 *
 * The fit of a window needs only the products of its samples with the columns: all windows of one
 * length share g, the products of the columns with each other.  The last two columns are the
 * derivatives t exp(-s t) cos(w t) and t exp(-s t) sin(w t).  With g = l l' (Cholesky) and y = l^-1 x',
 * x' the products with the samples, the other columns explain their |y|^2, and J and J'r lie along the
 * last two.  The sum of squares that is left is known to some 1e-15 of the whole, so that its root is
 * known to 3e-8 of the signal: misfits that pass for noise are far larger. */
#include "find/fitter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/versions.h"

enum { COLUMNS = VARPRO_COLUMNS, OFTEN = 16, STEPS = 50 };
#define ROUNDING 1e-13          /* part of a column's square, and of the sum of squares: less is no change */

ss_status
ss_varpro_init(varpro *v, const double *x, size_t room)
{
    *v = (varpro){ .x = x };
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

size_t
ss_varpro_columns(const varpro *v)
{
    return 4 + (v->forcing > 0) + (v->is_bent ? v->forcing > 0 ? 1 : 2 : 0);
}

/* --- columns and their sums ------------------------------------------------------------------ */

/* Where the forcing is slow, sin, 1 - cos and t - sin are about t, t^2 and t^3: cos and t themselves
 * would differ from the others by rounding only. */
static void
make_row(const varpro *v, double t, double row[COLUMNS])
{
    const double fade = exp(-v->s * t), turned = v->forcing * t, of_cos = fade * cos(v->w * t);
    const double of_sin = fade * sin(v->w * t);
    double *next = row;
    memset(row, 0, COLUMNS * sizeof *row);
    *next++ = 1;
    if (v->forcing > 0) {
        *next++ = sin(turned), *next++ = 1 - cos(turned);
        if (v->is_bent)
            *next++ = turned - sin(turned);
    } else {
        *next++ = t;
        if (v->is_bent)
            *next++ = t * t, *next++ = t * t * t;
    }
    *next++ = of_cos, *next++ = of_sin;
    *next++ = t * of_cos, *next++ = t * of_sin;
}

/* Add the products of n rows' columns. */
VERSIONS static void
add_products(double (*restrict row)[COLUMNS], size_t n, double (*restrict g)[COLUMNS])
{
    for (int j = 0; j < COLUMNS; j++) {
        double sum[COLUMNS];
        memcpy(sum, g[j], sizeof sum);
        for (size_t i = 0; i < n; i++)
            for (int k = 0; k < COLUMNS; k++)
                sum[k] += row[i][j] * row[i][k];
        memcpy(g[j], sum, sizeof sum);
    }
}

/* Add the products of n rows with x less level, and the squares of that. */
VERSIONS static void
add_samples(const double *restrict x, double level, double (*restrict row)[COLUMNS], size_t n,
            double *restrict to, double *restrict xx)
{
    double sum[COLUMNS] = { 0 }, squares = 0;
    for (size_t i = 0; i < n; i++) {
        const double off = x[i] - level;
        for (int k = 0; k < COLUMNS; k++)
            sum[k] += off * row[i][k];
        squares += off * off;
    }
    for (int k = 0; k < COLUMNS; k++)
        to[k] += sum[k];
    *xx += squares;
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
    add_products(tab->row + known * OFTEN, n - known * OFTEN, g);
}

/* Extend the table to n rows; begin again if w, s, forcing or is_bent have changed. */
static void
extend(varpro *v, size_t n)
{
    varpro_table *tab = &v->table;
    if (tab->w != v->w || tab->s != v->s || tab->forcing != v->forcing || tab->is_bent != v->is_bent) {
        tab->w = v->w, tab->s = v->s, tab->forcing = v->forcing, tab->is_bent = v->is_bent;
        tab->n = 0;
        v->factored = 0;
    }
    for (; tab->n < n; tab->n++) {
        make_row(v, (double)tab->n, tab->row[tab->n]);
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
    add_products(v->table.row + from, n, sums->g);
    add_samples(v->x + more.first, sums->level, v->table.row + from, n, sums->x, &sums->xx);
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
        l[j][j] = pivot > ROUNDING * g[j][j] ? sqrt(pivot) : 0;
        for (size_t i = j + 1; i < n; i++) {
            double sum = g[i][j];
            for (size_t k = 0; k < j && l[j][j] > 0; k++)
                sum -= l[i][k] * l[j][k];
            l[i][j] = l[j][j] > 0 ? sum / l[j][j] : 0;
        }
    }
}

void
ss_varpro_substitute(const varpro_factor *f, const double of[COLUMNS], double to[COLUMNS], size_t n)
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

double
ss_varpro_left(varpro_sums *sums)
{
    varpro_factor f;
    f.m = sums->m;
    factorise(sums->g, f.l, f.m);
    ss_varpro_substitute(&f, sums->x, f.y, f.m);
    return left_of(&f, sums->xx);
}

linear
ss_varpro_project(varpro *v, ss_window win)
{
    varpro_factor *f = &v->factor;
    double g[COLUMNS][COLUMNS], x[COLUMNS] = { 0 }, xx = 0, w[2], d[2];
    size_t n = ss_window_length(win);
    extend(v, n);
    if (v->factored != n) {             /* windows of one length share their factor */
        sum_rows(&v->table, n, g);
        f->m = ss_varpro_columns(v);
        factorise(g, f->l, f->m + 2);
        v->factored = n;
    }
    add_samples(v->x + win.first, v->x[win.first], v->table.row, n, x, &xx);
    ss_varpro_substitute(f, x, f->y, f->m + 2);
    const size_t at_cos = f->m - 2, at_sin = f->m - 1;
    const double *y = f->y, *left = y + f->m, c = f->l[at_cos][at_cos], s = f->l[at_sin][at_sin];
    linear fit = { .windows = 1, .samples = n, .whole = xx, .rss = left_of(f, xx),
                   .ring = y[at_cos] * y[at_cos] + y[at_sin] * y[at_sin] };
    fit.b = s > 0 ? y[at_sin] / s : 0;
    fit.a = c > 0 ? (y[at_cos] - f->l[at_sin][at_cos] * fit.b) / c : 0;
    ss_varpro_derivatives(f, fit.a, fit.b, w, d);
    fit.normal = (normal){ w[0] * w[0] + w[1] * w[1], w[0] * d[0] + w[1] * d[1],
                           d[0] * d[0] + d[1] * d[1], w[0] * left[0] + w[1] * left[1],
                           d[0] * left[0] + d[1] * left[1] };
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

/* The normal equations of two unknowns are solved here and not by base/least.c: they are sums over windows,
 * so that no residual of a sample is ever stored.  A short step that does not lessen the residual ends the
 * fit, too: it stands at the minimum already. */
int
ss_varpro_fit(varpro *v, const ss_window *window, size_t n, double tol)
{
    double w = v->w, s = v->s, damping = 1e-3;
    linear here = ss_varpro_project_all(v, window, n);
    int ended = 0;
    for (int i = 0; i < STEPS && !ended; i++) {
        const normal *h = &here.normal;
        double ww = h->ww * (1 + damping), ss = h->ss * (1 + damping), det = ww * ss - h->ws * h->ws;
        v->w = w + (h->ws * h->s - ss * h->w) / det;
        v->s = s + (h->ws * h->w - ww * h->s) / det;
        damping *= 10;
        if (!(v->w > 0 && v->w < M_PI && isfinite(v->s)))
            continue;
        linear there = ss_varpro_project_all(v, window, n);
        ended = fabs(v->w - w) <= tol * (w + tol) && fabs(v->s - s) <= tol * (fabs(s) + tol);
        if (there.rss <= here.rss + ROUNDING * here.whole) {
            w = v->w, s = v->s;
            here = there;
            damping /= 100;
        }
    }
    v->w = w, v->s = s;
    return ended;
}
