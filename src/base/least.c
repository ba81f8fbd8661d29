/* least.c -- the one least squares of all fits.
 *
 * GSL's trust region with Levenberg's and Marquardt's step (More 1978) does the work.  What is added: ranges,
 * models that do not exist everywhere, slopes by differences, and an end that knows the noise.
 *
 * An unknown v with a range is a sine of one without: v = from + (to - from) (1 + sin w) / 2.  A model that
 * does not exist at a trial step is an infinite residual there, so that the step is refused.
 *
 * Slopes by differences cost one run of the model for each unknown, a step only one run.  So slopes are kept
 * as long as steps by them gain half of what they predict.  A fit ends by fresh slopes only. */
#include "base/least.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REFUSED = 6 };           /* steps in a row, each shorter, that end a fit: it is at the least */
#define INSIDE 1e-3             /* of a range: the distance from its ends of a start */
#define LITTLE_NOISE 0.01       /* times noise: the squares change by about noise for no reason */
#define LITTLE 1e-4             /* times the squares beyond twice the noise: there the model is wrong */
#define UNSEEN 1e-12            /* of a column that others explain: less is rounding */

enum { REFRESH = GSL_EMAXITER + 1000, AT_LEAST };       /* what ends an iteration of GSL's early */

typedef struct descent {
    const least *fit;
    size_t n, *free;            /* the unknowns that are free */
    double *u, *residual;       /* of the point evaluated last */
    double *at, *left, *slopes; /* of the last step that was taken: u, residuals, slopes by u */
    double squares;             /* of left; NAN: none was taken */
    int is_old;                 /* slopes are those of a point before */
    int refresh;                /* the next slopes must be new */
    size_t refused;             /* steps since the last that was taken */
    ss_status status;
} descent;

/* --- ranges -------------------------------------------------------------------------------- */

static double
width_of(const least *fit, size_t k)
{
    return fit->range != NULL ? fit->range[k].to - fit->range[k].from : INFINITY;
}

static double
bounded(const least *fit, size_t k, double w)
{
    double width = width_of(fit, k);
    return isinf(width) ? w : fit->range[k].from + width * (0.5 + 0.5 * sin(w));
}

static double
unbounded(const least *fit, size_t k, double u)
{
    double width = width_of(fit, k);
    if (isinf(width))
        return u;
    double part = (u - fit->range[k].from) / width;
    return asin(2 * fmin(fmax(part, INSIDE), 1 - INSIDE) - 1);
}

/* The slope of bounded. */
static double
stretch_at(const least *fit, size_t k, double w)
{
    double width = width_of(fit, k);
    return isinf(width) ? 1 : 0.5 * width * cos(w);
}

/* --- residuals and slopes ------------------------------------------------------------------ */

static double
squares_of(const double *x, size_t n)
{
    double norm = cblas_dnrm2((int)n, x, 1);
    return norm * norm;
}

/* Called by GSL for the residuals at a trial step. */
static int
residuals(const gsl_vector *w, void *user, gsl_vector *out)
{
    descent *d = user;
    const size_t rows = d->fit->rows;
    for (size_t i = 0; i < d->n; i++)
        d->u[d->free[i]] = bounded(d->fit, d->free[i], gsl_vector_get(w, i));
    int is_known = !isnan(d->squares) && memcmp(d->u, d->at, d->fit->unknowns * sizeof *d->u) == 0;
    if (is_known)
        memcpy(d->residual, d->left, rows * sizeof *d->left);
    else
        d->status = d->fit->model(d->u, d->residual, NULL, d->fit->user);
    if (d->status == SS_EDATA && !isnan(d->squares)) {
        memset(d->residual, 0, rows * sizeof *d->residual);
        d->residual[0] = INFINITY;
        d->status = SS_OK;
    }
    if (d->status != SS_OK)
        return GSL_EFAILED;
    memcpy(out->data, d->residual, rows * sizeof *d->residual);
    if (is_known || isnan(d->squares) || squares_of(d->residual, rows) < d->squares)
        return GSL_SUCCESS;
    return d->is_old ? REFRESH : ++d->refused < REFUSED ? GSL_SUCCESS : AT_LEAST;
}

/* Find the slopes by one unknown from a step to either side, whichever has a model. */
static ss_status
differentiate(descent *d, size_t k, double *changed)
{
    const least *fit = d->fit;
    const double u = d->u[k];
    double h = fit->difference[k];
    d->u[k] = u + h;
    ss_status st = fit->model(d->u, changed, NULL, fit->user);
    if (st == SS_EDATA) {
        h = -h;
        d->u[k] = u + h;
        st = fit->model(d->u, changed, NULL, fit->user);
    }
    d->u[k] = u;
    for (size_t i = 0; st == SS_OK && i < fit->rows; i++)
        d->slopes[i * fit->unknowns + k] = (changed[i] - d->residual[i]) / h;
    return st;
}

static ss_status
find_slopes(descent *d)
{
    const least *fit = d->fit;
    memset(d->slopes, 0, fit->rows * fit->unknowns * sizeof *d->slopes);
    if (fit->difference == NULL)
        return fit->model(d->u, d->residual, d->slopes, fit->user);
    double *changed = malloc(fit->rows * sizeof *changed);
    ss_status st = changed != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < d->n; i++)
        st = differentiate(d, d->free[i], changed);
    free(changed);
    return st;
}

/* Has the last step gained more than half of what the slopes predicted? */
static int
are_slopes_good(const descent *d)
{
    const size_t rows = d->fit->rows, m = d->fit->unknowns;
    double predicted = 0;
    for (size_t i = 0; i < rows; i++) {
        double by = d->left[i];
        for (size_t j = 0; j < d->n; j++)
            by += d->slopes[i * m + d->free[j]] * (d->u[d->free[j]] - d->at[d->free[j]]);
        predicted += by * by;
    }
    return d->squares - squares_of(d->residual, rows) > 0.5 * (d->squares - predicted);
}

/* Called by GSL at the start, and after a step that is taken: its residuals are those evaluated last. */
static int
slopes(const gsl_vector *w, void *user, gsl_matrix *out)
{
    descent *d = user;
    const least *fit = d->fit;
    int is_first = isnan(d->squares) || d->refresh;
    d->is_old = fit->costly && !is_first && are_slopes_good(d);
    if (!d->is_old)
        d->status = find_slopes(d);
    if (d->status != SS_OK)
        return GSL_EFAILED;
    d->refresh = 0;
    d->refused = 0;
    memcpy(d->at, d->u, fit->unknowns * sizeof *d->at);
    memcpy(d->left, d->residual, fit->rows * sizeof *d->left);
    d->squares = squares_of(d->left, fit->rows);
    for (size_t j = 0; j < d->n; j++) {
        double stretch = stretch_at(fit, d->free[j], gsl_vector_get(w, j));
        for (size_t i = 0; i < fit->rows; i++)
            gsl_matrix_set(out, i, j, stretch * d->slopes[i * fit->unknowns + d->free[j]]);
    }
    return GSL_SUCCESS;
}

/* --- the fit ------------------------------------------------------------------------------- */

/* Does a step from `before` that gained so much end the fit? */
static int
is_little(const descent *d, const double *before, double gain)
{
    const least *fit = d->fit;
    double beyond = fmax(d->squares - 2 * fit->noise * (double)fit->rows, 0);
    int is_short = 1;
    for (size_t k = 0; k < fit->unknowns; k++)
        is_short = is_short && fabs(d->at[k] - before[k]) <= fit->tol * (fabs(d->at[k]) + fit->tol);
    return is_short || (fit->noise > 0 && gain < LITTLE_NOISE * fit->noise + LITTLE * beyond);
}

static void
iterate(descent *d, gsl_multifit_nlinear_workspace *space, gsl_multifit_nlinear_fdf *of, gsl_vector *w,
        least_end *end)
{
    double *before = d->u + d->fit->unknowns;
    int ended = gsl_multifit_nlinear_init(w, of, space);
    end->why = "it takes too many steps";
    if (ended != GSL_SUCCESS || !isfinite(d->squares))
        end->why = "there is no model where it starts";
    while (ended == GSL_SUCCESS && isfinite(d->squares) && !end->converged && end->steps < d->fit->steps) {
        double squares = d->squares;
        int was_old = d->is_old;
        memcpy(before, d->at, d->fit->unknowns * sizeof *before);
        ended = gsl_multifit_nlinear_iterate(space);
        end->steps++;
        int is_still = ended != GSL_SUCCESS || is_little(d, before, squares - d->squares);
        if (d->status != SS_OK && d->status != SS_EDATA)
            return;
        if (was_old && is_still) {
            d->refresh = 1;
            gsl_vector_memcpy(w, gsl_multifit_nlinear_position(space));
            ended = gsl_multifit_nlinear_init(w, of, space);
        } else
            end->converged = ended == GSL_ENOPROG || ended == AT_LEAST || (ended == GSL_SUCCESS && is_still);
        if (ended != GSL_SUCCESS)
            end->why = "the model has no slopes where a step has led";
    }
    if (end->converged)
        end->why = NULL;
}

static ss_status
find_covariance(const descent *d, double *covariance)
{
    const size_t m = d->fit->unknowns;
    gsl_matrix *j = gsl_matrix_alloc(d->fit->rows, d->n), *c = gsl_matrix_alloc(d->n, d->n);
    int is_room = j != NULL && c != NULL;
    memset(covariance, 0, m * m * sizeof *covariance);
    if (is_room) {
        for (size_t i = 0; i < d->fit->rows; i++)
            for (size_t k = 0; k < d->n; k++)
                gsl_matrix_set(j, i, k, d->slopes[i * m + d->free[k]]);
        is_room = gsl_multifit_nlinear_covar(j, UNSEEN, c) == GSL_SUCCESS;
        for (size_t i = 0; i < d->n; i++)
            for (size_t k = 0; k < d->n; k++)
                covariance[d->free[i] * m + d->free[k]] = gsl_matrix_get(c, i, k);
    }
    for (size_t i = 0; i < d->n; i++)
        if (!(covariance[d->free[i] * (m + 1)] > 0))
            covariance[d->free[i] * (m + 1)] = INFINITY;
    gsl_matrix_free(j);
    gsl_matrix_free(c);
    return is_room ? SS_OK : SS_ENOMEM;
}

ss_status
ss_least_fit(least_end *end, const least *fit, double u[], double *residual, double *covariance)
{
    const size_t m = fit->unknowns, rows = fit->rows;
    double *room = malloc((3 * m + 2 * rows + rows * m) * sizeof *room);
    size_t *of = malloc(m * sizeof *of);
    *end = (least_end){ .squares = NAN };
    if (room == NULL || of == NULL) {
        free(room);
        free(of);
        return SS_ENOMEM;
    }
    descent d = { .fit = fit, .free = of, .u = room, .at = room + 2 * m, .residual = room + 3 * m,
                  .left = room + 3 * m + rows, .slopes = room + 3 * m + 2 * rows, .squares = NAN };
    memcpy(d.u, u, m * sizeof *u);
    memcpy(d.at, u, m * sizeof *u);
    memset(d.slopes, 0, rows * m * sizeof *d.slopes);
    for (size_t k = 0; k < m; k++)
        if (width_of(fit, k) > 0)
            of[d.n++] = k;
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    how.solver = gsl_multifit_nlinear_solver_mcholesky;     /* it never fails; rounding is far below noise */
    gsl_multifit_nlinear_fdf f = { .f = residuals, .df = slopes, .n = rows, .p = d.n, .params = &d };
    gsl_multifit_nlinear_workspace *space =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, rows, d.n);
    gsl_vector *w = gsl_vector_alloc(d.n);
    if (space == NULL || w == NULL)
        d.status = SS_ENOMEM;
    else {
        for (size_t i = 0; i < d.n; i++)
            gsl_vector_set(w, i, unbounded(fit, of[i], u[of[i]]));
        iterate(&d, space, &f, w, end);
    }
    if (isfinite(d.squares)) {
        end->squares = d.squares;
        memcpy(u, d.at, m * sizeof *u);
        if (residual != NULL)
            memcpy(residual, d.left, rows * sizeof *residual);
        if (covariance != NULL && find_covariance(&d, covariance) != SS_OK)
            d.status = SS_ENOMEM;
    }
    gsl_vector_free(w);
    gsl_multifit_nlinear_free(space);
    free(room);
    free(of);
    return d.status == SS_EDATA ? SS_OK : d.status;
}

ss_status
ss_least_linear(const double *columns, const double *y, size_t rows, size_t n, double c[], double *squares,
                double *covariance)
{
    gsl_multifit_linear_workspace *space = gsl_multifit_linear_alloc(rows, n);
    gsl_matrix *of = gsl_matrix_alloc(n, n);
    gsl_vector *weight = gsl_vector_alloc(rows);
    gsl_matrix_const_view x = gsl_matrix_const_view_array(columns, rows, n);
    gsl_vector_const_view measured = gsl_vector_const_view_array(y, rows);
    gsl_vector_view found = gsl_vector_view_array(c, n);
    size_t rank;
    ss_status st = space != NULL && of != NULL && weight != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK) {
        gsl_vector_set_all(weight, 1);          /* without weights GSL's covariance is that of the residuals */
        gsl_multifit_wlinear_tsvd(&x.matrix, weight, &measured.vector, UNSEEN, &found.vector, of, squares, &rank,
                                  space);
    }
    if (st == SS_OK && covariance != NULL)
        memcpy(covariance, of->data, n * n * sizeof *covariance);
    gsl_vector_free(weight);
    gsl_matrix_free(of);
    gsl_multifit_linear_free(space);
    return st;
}
