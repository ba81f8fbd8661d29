/* varpro.c -- a damped oscillation fitted to windows of a signal; its linear parameters are
 * projected out.
 *
 * The signal of a window is A exp(-s t) cos(w t) + B exp(-s t) sin(w t), a slow part of two to
 * four columns, and a steady line if asked for. The amplitudes are its own; w and s are those of all windows. So the amplitudes are
 * projected out of each window (variable projection, Golub and Pereyra 1973, with Kaufman's
 * Jacobian), and two numbers are left to fit to all windows at once, by GSL's Levenberg-Marquardt. */
#include "features/varpro.h"

#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

ss_status
ss_varpro_init(varpro *v, const double *x, size_t room)
{
    enum { PIECES = VARPRO_COLUMNS + VARPRO_DERIVATIVES + 7 };
    double *at = malloc(PIECES * room * sizeof *at);
    *v = (varpro){ .x = x, .room = room, .memory = at };
    if (at == NULL)
        return SS_ENOMEM;
    for (int i = 0; i < VARPRO_COLUMNS; i++, at += room)
        v->basis.q[i] = at;
    for (int i = 0; i < VARPRO_DERIVATIVES; i++, at += room)
        v->j[i] = at;
    v->r = at;
    v->slow.cos = at + room, v->slow.sin = at + 2 * room;
    v->ring.cos = at + 3 * room, v->ring.sin = at + 4 * room;
    v->steady.cos = at + 5 * room, v->steady.sin = at + 6 * room;
    return SS_OK;
}

void
ss_varpro_free(varpro *v)
{
    free(v->memory);
}

void
ss_varpro_start(varpro *v, double w, double s, double forcing)
{
    v->w = w, v->s = s;
    v->forcing = forcing;
    v->line = 0;
    ss_varpro_bend(v, 0);
}

static void
count_columns(varpro *v)
{
    enum { RING = 2, LINE = 2 };
    size_t slow = v->is_cubic ? 4 : v->forcing > 0 ? 3 : 2;
    v->columns = slow + RING + (v->line > 0 ? LINE : 0);
}

void
ss_varpro_bend(varpro *v, int is_cubic)
{
    v->is_cubic = is_cubic;
    count_columns(v);
}

void
ss_varpro_add_line(varpro *v, double line)
{
    v->line = line;
    count_columns(v);
}

/* In lanes, which do not wait for each other. */
double
ss_dot(const double *a, const double *b, size_t n)
{
    enum { LANES = 8 };
    double sum[LANES] = { 0 };
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++)
            sum[l] += a[i + l] * b[i + l];
    for (; i < n; i++)
        sum[0] += a[i] * b[i];
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

/* Subtract from v its component along the unit vector q; returns the component. */
static double
project_out(double *v, const double *q, size_t n)
{
    double part = ss_dot(q, v, n);
    for (size_t i = 0; i < n; i++)
        v[i] -= part * q[i];
    return part;
}

static double
normalise(double *v, size_t n)
{
    double norm = sqrt(ss_dot(v, v, n));
    for (size_t i = 0; i < n; i++)
        v[i] /= norm;
    return norm;
}

/* The first n samples, by rotation. */
static void
extend(wave *to, double w, double s, size_t n)
{
    double step = exp(-s), turn_c = step * cos(w), turn_s = step * sin(w);
    if (to->w != w || to->s != s)
        to->n = 0;
    to->w = w, to->s = s;
    for (; to->n < n; to->n++) {
        size_t i = to->n;
        to->cos[i] = i == 0 ? 1 : to->cos[i - 1] * turn_c - to->sin[i - 1] * turn_s;
        to->sin[i] = i == 0 ? 0 : to->cos[i - 1] * turn_s + to->sin[i - 1] * turn_c;
    }
}

/* The slow part, about the middle of the window: its columns are scaled to unit size. */
static void
slow_columns(varpro *v, double **q, size_t n)
{
    double middle = 0.5 * (double)(n - 1);
    double c = cos(v->forcing * middle), s = sin(v->forcing * middle);
    if (v->forcing > 0)
        extend(&v->slow, v->forcing, 0, n);
    for (size_t i = 0; i < n; i++) {
        q[0][i] = 1;
        double t = (double)i - middle;
        if (v->forcing > 0) {
            q[1][i] = v->slow.sin[i] * c - v->slow.cos[i] * s;
            q[2][i] = v->slow.cos[i] * c + v->slow.sin[i] * s;
        } else {
            q[1][i] = t;
            if (v->is_cubic)
                q[2][i] = t * t;
        }
        if (v->is_cubic)
            q[3][i] = t * t * t;
    }
}

/* By modified Gram-Schmidt, for more samples than columns. */
static void
make_basis(varpro *v, size_t n)
{
    basis *b = &v->basis;
    size_t c = v->columns - 2;
    if (b->n == n && b->columns == v->columns && b->w == v->w && b->s == v->s
        && b->forcing == v->forcing && b->line == v->line)
        return;
    b->n = n, b->columns = v->columns, b->w = v->w, b->s = v->s;
    b->forcing = v->forcing, b->line = v->line;
    slow_columns(v, b->q, n);
    if (v->line > 0) {
        extend(&v->steady, v->line, 0, n);
        memcpy(b->q[c - 2], v->steady.cos, n * sizeof(double));
        memcpy(b->q[c - 1], v->steady.sin, n * sizeof(double));
    }
    extend(&v->ring, v->w, v->s, n);
    memcpy(b->q[c], v->ring.cos, n * sizeof(double));
    memcpy(b->q[c + 1], v->ring.sin, n * sizeof(double));
    for (size_t j = 0; j < v->columns; j++) {
        for (size_t l = 0; l < j; l++)
            b->cross = project_out(b->q[j], b->q[l], n);   /* the last one: of sin along cos */
        b->norm[j] = normalise(b->q[j], n);
    }
}

linear
ss_varpro_project(varpro *v, ss_window win)
{
    const basis *p = &v->basis;
    size_t n = ss_window_length(win), c = v->columns - 2, s = c + 1;
    double z[VARPRO_COLUMNS] = { 0 };
    make_basis(v, n);
    memcpy(v->r, v->x + win.first, n * sizeof *v->r);
    for (size_t j = 0; j < v->columns; j++)
        z[j] = project_out(v->r, p->q[j], n);
    double b = z[s] / p->norm[s];
    return (linear){ ss_dot(v->r, v->r, n), z[c] * z[c] + z[s] * z[s],
                     (z[c] - p->cross * b) / p->norm[c], b };
}

/* --- the fit of w and s -------------------------------------------------------------------- */

static int
residuals(const gsl_vector *at, void *user, gsl_vector *f)
{
    varpro *v = user;
    double *to = f->data;
    v->w = gsl_vector_get(at, 0);
    v->s = gsl_vector_get(at, 1);
    for (size_t i = 0; i < v->n_windows; i++) {
        size_t n = ss_window_length(v->window[i]);
        if (n == 0)
            continue;
        ss_varpro_project(v, v->window[i]);
        memcpy(to, v->r, n * sizeof *to);
        to += n;
    }
    return GSL_SUCCESS;
}

void
ss_varpro_project_out(const varpro *v, double *y, size_t n)
{
    for (size_t j = 0; j < v->columns; j++)
        project_out(y, v->basis.q[j], n);
}

/* Kaufman: d r = -P (d Phi) c, Phi c the oscillation fitted and P what projects it out. */
linear
ss_varpro_derive(varpro *v, ss_window win)
{
    double *j_w = v->j[0], *j_s = v->j[1];
    size_t n = ss_window_length(win);
    linear fit = ss_varpro_project(v, win);
    for (size_t i = 0; i < n; i++) {
        double c = (double)i * v->ring.cos[i], s = (double)i * v->ring.sin[i];
        j_w[i] = fit.a * s - fit.b * c;
        j_s[i] = fit.a * c + fit.b * s;
    }
    ss_varpro_project_out(v, j_w, n);
    ss_varpro_project_out(v, j_s, n);
    return fit;
}

static int
jacobian(const gsl_vector *at, void *user, gsl_matrix *to)
{
    varpro *v = user;
    v->w = gsl_vector_get(at, 0);
    v->s = gsl_vector_get(at, 1);
    for (size_t i = 0, row = 0; i < v->n_windows; i++) {
        size_t n = ss_window_length(v->window[i]);
        if (n == 0)
            continue;
        ss_varpro_derive(v, v->window[i]);
        for (size_t l = 0; l < n; l++, row++) {
            gsl_matrix_set(to, row, 0, v->j[0][l]);
            gsl_matrix_set(to, row, 1, v->j[1][l]);
        }
    }
    return GSL_SUCCESS;
}

ss_status
ss_varpro_fit(varpro *v, const ss_window *window, size_t n, double tol, int *ok)
{
    enum { STEPS = 50, FITTED = 2 };
    double w = v->w, s = v->s;
    size_t samples = ss_window_total(window, n);
    int info;
    *ok = 0;
    if (samples < FITTED)
        return SS_OK;
    v->window = window;
    v->n_windows = n;
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    gsl_multifit_nlinear_fdf problem = { .f = residuals, .df = jacobian, .n = samples, .p = FITTED,
                                         .params = v };
    gsl_multifit_nlinear_workspace *space =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, samples, FITTED);
    if (space == NULL)
        return SS_ENOMEM;
    double start[2] = { w, s };
    gsl_vector_view at = gsl_vector_view_array(start, 2);
    if (gsl_multifit_nlinear_init(&at.vector, &problem, space) == GSL_SUCCESS) {
        int how_it_ended = gsl_multifit_nlinear_driver(STEPS, tol, 0, 0, NULL, NULL, &info, space);
        w = gsl_vector_get(space->x, 0);
        s = gsl_vector_get(space->x, 1);
        /* no progress: it stands at the minimum already */
        *ok = (how_it_ended == GSL_SUCCESS || info == GSL_ENOPROG) && w > 0 && w < M_PI
            && isfinite(s);
    }
    v->w = w;
    v->s = s;
    gsl_multifit_nlinear_free(space);
    return SS_OK;
}
