/* least.c -- the one least squares of all fits.
 *
 * GSL's trust region with Levenberg's and Marquardt's step (More 1978) does the work.  What is added: ranges,
 * models that do not exist everywhere, slopes by differences, and an end that knows the noise.
 *
 * GSL's point only adds up GSL's steps.  The unknowns follow each of them as far as their ranges, and the
 * longest step, allow; one at an end of its range that would leave it has no slope for GSL.  A model that does
 * not exist at a trial step is an infinite residual there, so that the step is refused.
 *
 * Slopes by differences cost one run of the model for each unknown, a step only one run.  So slopes are kept
 * as long as steps by them gain half of what they predict.  A fit ends by fresh slopes only. */
#include "base/least.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_multifit.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_multilarge_nlinear.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { REFUSED = 6 };           /* steps in a row, each shorter, that end a fit: it is at the least */
enum { ENOUGH = 60 };           /* steps of a fit that says no other number */
#define LITTLE_NOISE 0.01       /* times noise: the squares change by about noise for no reason */
#define UNSEEN 1e-12            /* of a column that others explain: less is rounding */

enum { REFRESH = GSL_EMAXITER + 1000, AT_LEAST };       /* what ends an iteration of GSL's early */

typedef struct descent {
    const least *fit;
    size_t n, *free;            /* the unknowns that are free */
    double *residual, *u;       /* of the point evaluated last; behind u there is room */
    double *at, *left, *slopes; /* of the last step that was taken: u, residuals, slopes by u */
    double *place;              /* GSL's point there */
    double squares;             /* of left; NAN: none was taken */
    int is_old;                 /* slopes are those of a point before */
    int refresh;                /* the next slopes must be new */
    size_t refused;             /* steps since the last that was taken */
    ss_status status;
} descent;

static ss_range
range_of(const least *fit, size_t k)
{
    return fit->range != NULL ? fit->range[k] : (ss_range){ -INFINITY, INFINITY };
}

/* Follow GSL's step as far as the ranges allow.  0: it is too long. */
static int
follow(descent *d, const gsl_vector *w)
{
    int is_long = 0;
    for (size_t i = 0; i < d->n; i++) {
        size_t k = d->free[i];
        ss_range range = range_of(d->fit, k);
        d->u[k] = fmax(range.from, fmin(d->at[k] + (gsl_vector_get(w, i) - d->place[i]), range.to));
        is_long = is_long || (d->fit->farthest > 0 && fabs(d->u[k] - d->at[k]) > d->fit->farthest);
    }
    return !is_long;
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
    const int is_first = isnan(d->squares);
    const int is_run = follow(d, w) && (is_first || memcmp(d->u, d->at, d->fit->unknowns * sizeof *d->u) != 0);
    memcpy(d->residual, d->left, rows * sizeof *d->left);
    if (is_run)
        d->status = d->fit->model(d->u, d->residual, NULL, d->fit->user);
    if (!follow(d, w) || (d->status == SS_EDATA && !is_first)) {
        memset(d->residual, 0, rows * sizeof *d->residual);
        d->residual[0] = INFINITY;
        d->status = SS_OK;
    }
    if (d->status != SS_OK)
        return GSL_EFAILED;
    memcpy(out->data, d->residual, rows * sizeof *d->residual);
    if (is_first || !is_run || squares_of(d->residual, rows) < d->squares)
        return GSL_SUCCESS;
    return d->is_old ? REFRESH : ++d->refused < REFUSED ? GSL_SUCCESS : AT_LEAST;
}

/* Find the slopes; by differences: from a step by each unknown to either side, whichever has a model. */
static ss_status
find_slopes(descent *d)
{
    const least *fit = d->fit;
    memset(d->slopes, 0, fit->rows * fit->unknowns * sizeof *d->slopes);
    if (fit->difference == NULL)
        return fit->model(d->u, d->residual, d->slopes, fit->user);
    double *changed = malloc(fit->rows * sizeof *changed);
    ss_status st = changed != NULL ? SS_OK : SS_ENOMEM;
    for (size_t n = 0; st == SS_OK && n < d->n; n++) {
        const size_t k = d->free[n];
        const double u = d->u[k];
        double h = fit->difference[k];
        d->u[k] = u + h;
        st = fit->model(d->u, changed, NULL, fit->user);
        if (st == SS_EDATA) {
            h = -h;
            d->u[k] = u + h;
            st = fit->model(d->u, changed, NULL, fit->user);
        }
        d->u[k] = u;
        for (size_t i = 0; st == SS_OK && i < fit->rows; i++)
            d->slopes[i * fit->unknowns + k] = (changed[i] - d->residual[i]) / h;
    }
    free(changed);
    return st;
}

/* Add up J'J, its lower half, and J'r, in one pass over the rows. */
static void
add_products(const descent *d, gsl_vector *by, gsl_matrix *products)
{
    gsl_vector_set_zero(by);
    gsl_matrix_set_zero(products);
    for (size_t i = 0; i < d->fit->rows; i++) {
        const double *slope = d->slopes + i * d->fit->unknowns;
        for (size_t j = 0; j < d->n; j++) {
            const double one = slope[d->free[j]];
            double *row = gsl_matrix_ptr(products, j, 0);
            *gsl_vector_ptr(by, j) += one * d->left[i];
            for (size_t k = 0; k <= j; k++)
                row[k] += one * slope[d->free[k]];
        }
    }
}

/* Called by GSL at the start, and after a step that is taken: its residuals are those evaluated last. */
static int
slopes(CBLAS_TRANSPOSE_t transposed, const gsl_vector *w, const gsl_vector *r, void *user, gsl_vector *by,
       gsl_matrix *products)
{
    descent *d = user;
    const least *fit = d->fit;
    int is_first = isnan(d->squares) || d->refresh;
    (void)transposed;
    (void)r;
    d->is_old = fit->costly && !is_first;
    if (d->is_old) {            /* has the last step gained more than half of what the slopes predicted? */
        double predicted = 0;
        for (size_t i = 0; i < fit->rows; i++) {
            double left = d->left[i];
            for (size_t j = 0; j < d->n; j++)
                left += d->slopes[i * fit->unknowns + d->free[j]] * (d->u[d->free[j]] - d->at[d->free[j]]);
            predicted += left * left;
        }
        d->is_old = d->squares - squares_of(d->residual, fit->rows) > 0.5 * (d->squares - predicted);
    }
    if (!d->is_old)
        d->status = find_slopes(d);
    if (d->status != SS_OK)
        return GSL_EFAILED;
    d->refresh = 0;
    d->refused = 0;
    memcpy(d->at, d->u, fit->unknowns * sizeof *d->at);
    memcpy(d->left, d->residual, fit->rows * sizeof *d->left);
    memcpy(d->place, w->data, d->n * sizeof *d->place);
    d->squares = squares_of(d->left, fit->rows);
    add_products(d, by, products);
    for (size_t j = 0; j < d->n; j++) {
        const ss_range range = range_of(fit, d->free[j]);
        const double u = d->at[d->free[j]], rise = gsl_vector_get(by, j);
        if ((u <= range.from && rise > 0) || (u >= range.to && rise < 0)) {     /* it is held */
            gsl_vector_set(by, j, 0);
            for (size_t k = 0; k < d->n; k++)
                gsl_matrix_set(products, k > j ? k : j, k > j ? j : k, 0);
        }
    }
    return GSL_SUCCESS;
}

/* --- the fit ------------------------------------------------------------------------------- */

/* Is a gain too little to go on for? */
static int
is_little_gain(const descent *d, double gain)
{
    double beyond = fmax(d->squares - 2 * d->fit->noise * (double)d->fit->rows, 0);
    return gain < LITTLE_NOISE * d->fit->noise + d->fit->gain * beyond;
}

/* How much the squares would fall by the best step, if the slopes held.  As this costs as much as a step of GSL's,
 * only costly models are asked.  room holds n * (n + 1) numbers. */
static double
predicted_gain(const descent *d, const gsl_multilarge_nlinear_workspace *space, double *room)
{
    gsl_matrix_view l = gsl_matrix_view_array(room, d->n, d->n);
    gsl_vector_view step = gsl_vector_view_array(room + d->n * d->n, d->n);
    gsl_permutation *p = gsl_permutation_alloc(d->n);
    double gain = INFINITY;
    gsl_matrix_memcpy(&l.matrix, space->JTJ);
    for (size_t k = 0; k < d->n; k++)       /* what the residuals do not show promises nothing */
        *gsl_matrix_ptr(&l.matrix, k, k) *= 1 + UNSEEN;
    if (p != NULL) {
        gsl_linalg_mcholesky_decomp(&l.matrix, p, NULL);
        gsl_linalg_mcholesky_solve(&l.matrix, p, space->g, &step.vector);
        gsl_blas_ddot(space->g, &step.vector, &gain);
    }
    gsl_permutation_free(p);
    return gain;
}

static void
iterate(descent *d, gsl_multilarge_nlinear_workspace *space, gsl_multilarge_nlinear_fdf *of, gsl_vector *w,
        least_end *end)
{
    const size_t most = d->fit->steps > 0 ? d->fit->steps : ENOUGH;
    double *before = d->u + d->fit->unknowns;
    int ended = gsl_multilarge_nlinear_init(w, of, space);
    end->why = "it takes too many steps";
    if (ended != GSL_SUCCESS || !isfinite(d->squares))
        end->why = "there is no model where it starts";
    while (ended == GSL_SUCCESS && isfinite(d->squares) && !end->converged && end->steps < most) {
        double squares = d->squares;
        int was_old = d->is_old;
        int is_still = d->fit->costly && is_little_gain(d, predicted_gain(d, space, before + d->fit->unknowns));
        if (!is_still) {
            memcpy(before, d->at, d->fit->unknowns * sizeof *before);
            ended = gsl_multilarge_nlinear_iterate(space);
            end->steps++;
            is_still = 1;       /* the step was short, or gained little */
            for (size_t k = 0; k < d->fit->unknowns && ended == GSL_SUCCESS; k++)
                is_still &= fabs(d->at[k] - before[k]) <= d->fit->tol * (fabs(d->at[k]) + d->fit->tol);
            is_still |= is_little_gain(d, squares - d->squares);
        }
        if (d->status != SS_OK && d->status != SS_EDATA)
            return;
        if (was_old && is_still) {
            d->refresh = 1;
            gsl_vector_memcpy(w, gsl_multilarge_nlinear_position(space));
            ended = gsl_multilarge_nlinear_init(w, of, space);
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
    double *room = malloc((5 * m + m * m + 2 * rows + rows * m) * sizeof *room);
    size_t *of = malloc(m * sizeof *of);
    *end = (least_end){ .squares = NAN };
    if (room == NULL || of == NULL) {
        free(room);
        free(of);
        return SS_ENOMEM;
    }
    descent d = { .fit = fit, .free = of, .at = room, .place = room + m, .residual = room + 2 * m,
                  .left = room + 2 * m + rows, .slopes = room + 2 * m + 2 * rows,
                  .u = room + 2 * m + 2 * rows + rows * m, .squares = NAN };
    memcpy(d.u, u, m * sizeof *u);
    memcpy(d.at, u, m * sizeof *u);
    for (size_t k = 0; k < m; k++)
        if (range_of(fit, k).to > range_of(fit, k).from)
            of[d.n++] = k;
    gsl_multilarge_nlinear_parameters how = gsl_multilarge_nlinear_default_parameters();
    how.solver = gsl_multilarge_nlinear_solver_mcholesky;     /* it never fails; rounding is far below noise */
    gsl_multilarge_nlinear_fdf f = { .f = residuals, .df = slopes, .n = rows, .p = d.n, .params = &d };
    gsl_multilarge_nlinear_workspace *space =
        gsl_multilarge_nlinear_alloc(gsl_multilarge_nlinear_trust, &how, rows, d.n);
    gsl_vector *w = gsl_vector_alloc(d.n);
    if (space == NULL || w == NULL)
        d.status = SS_ENOMEM;
    else {
        gsl_vector_set_zero(w);
        memset(d.place, 0, m * sizeof *d.place);
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
    gsl_multilarge_nlinear_free(space);
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
