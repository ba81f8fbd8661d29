/* driven_fit.c -- fit a friction law, driven by a measured motion, to the force.
 *
 * * The force is linear in the amplitudes of the law's parts and in what stands beside the law: a tilt, inertia, a
 * viscous part, an offset and its drift.  Linear least squares finds these for each value of the other unknowns
 * (variable projection), so that a search moves at most six.  It begins at points all over their ranges, of rows
 * that were thinned.
 *
 * * What a fit leaves is no white noise.  So errors come from the scatter of the slopes of the squares between
 * blocks of time (the sandwich), the difference of the fits of the two folds, and the converter's steps. */
#include "fit/driven.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_qrng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"

#define RIDGE 1e-7                  /* of the columns' squares: columns that look alike share an amplitude */
#define NUDGE 1e-3                  /* of an unknown, for slopes: less than errors, more than kinks */
#define NUDGE_DELAY 0.1             /* rows: of a law that jumps, some rows must change */
enum { KEPT = 3 };                  /* starts that are improved */

/* Where a fit may go; its starts lie in the upper three quarters, of a ratio in the middle half. */
static const ss_range ranges[UNKNOWNS] = {
    [LENGTH] = { -7, 1 }, [OTHER_LENGTH] = { -2, 2 }, [GAP] = { -7, 1 }, [EXPONENT] = { -1, 3 },
    [BETA] = { 0.5, 1 }, [RISE] = { 0, 2 }, [SPEED] = { -6, 2 }, [SHAPE] = { 0, 1 } };

typedef struct problem {
    const driven_law *law;
    const driven *d;
    int without;                    /* the fold that is not fitted */
    double *column[COLUMNS];        /* of each row; NULL: the law has no such column */
    double *room;
    double late, *x, *v, *a;        /* the motion, so much earlier */
    double line[COLUMNS + 1][2];    /* of each column, and of the force, over all rows */
    ss_range range[UNKNOWNS];       /* no wider than a point: it is held */
    double nudge[UNKNOWNS];
    driven_fit now;                 /* evaluated last */
} problem;

static int
has_column(const driven_law *law, const driven *d, int k)
{
    switch (k) {
    case SINE: case COSINE: case BY_SIDE: return d->angle != 0;
    case UNEVEN: return law->is_even;
    case PLACE: return law->parts > 0;
    default: return k >= VISCOUS || k < (int)law->parts;
    }
}

static ss_status
problem_new(problem *p, const driven_law *law, const driven *d)
{
    *p = (problem){ .law = law, .d = d, .without = ALL, .late = NAN };
    p->room = malloc(COLUMNS * d->n * sizeof *p->room);
    if (p->room == NULL)
        return SS_ENOMEM;
    for (int k = 0; k < COLUMNS; k++)
        if (has_column(law, d, k))
            p->column[k] = p->room + (size_t)k * d->n;
    p->x = p->column[TILT];
    p->v = p->column[VISCOUS];
    p->a = p->column[INERTIA];
    for (size_t i = 0; i < d->n; i++) {
        p->column[OFFSET][i] = 1;
        p->column[DRIFT][i] = d->t[i] - d->t[d->n - 1] / 2;
    }
    ss_driven_line(p->line[COLUMNS], d, d->f);
    for (size_t k = 0; k < UNKNOWNS; k++) {
        p->range[k] = k == DELAY ? (ss_range){ -d->most_delay, d->most_delay }
            : law->free >> k & 1 ? ranges[k] : (ss_range){ law->held[k], law->held[k] };
        p->nudge[k] = k == DELAY ? NUDGE_DELAY : NUDGE;
    }
    return SS_OK;
}

static int
is_free(const problem *p, size_t k)
{
    return p->range[k].to > p->range[k].from;
}

static int
is_fitted(const problem *p, size_t i)
{
    return p->d->used[i] && driven_fold(p->d, i) != p->without;
}

/* --- the columns --------------------------------------------------------------------------- */

/* The motion so much earlier, by cubics between rows, which is what stands beside the law.  A law that jumps then
 * jumps between rows, too. */
static void
move_earlier(problem *p, double late)
{
    const driven *d = p->d;
    for (size_t i = 0, k = 0; i < d->n; i++) {
        const double t = d->t[i] - late;
        for (; k + 2 < d->n && d->t[k + 1] <= t; k++)
            ;
        const double h = d->t[k + 1] - d->t[k], s = fmax(-1, fmin((t - d->t[k]) / h, 2)), r = 1 - s;
        const double of[4] = { r * r * (1 + 2 * s), s * s * (3 - 2 * s), r * r * s * h, -s * s * r * h };
        p->x[i] = of[0] * d->x[k] + of[1] * d->x[k + 1] + of[2] * d->v[k] + of[3] * d->v[k + 1];
        p->v[i] = of[0] * d->v[k] + of[1] * d->v[k + 1] + of[2] * d->a[k] + of[3] * d->a[k + 1];
        p->a[i] = r * d->a[k] + s * d->a[k + 1];
        if (p->column[SINE] != NULL) {
            double angle = (d->middle + p->x[i] * d->length) * d->angle;
            p->column[SINE][i] = sin(angle);
            p->column[COSINE][i] = cos(angle);
            p->column[BY_SIDE][i] = fabs(p->v[i]);     /* joints rub more on one side */
        }
    }
    p->late = late;
}

static void
fill_columns(problem *p, const double u[UNKNOWNS])
{
    static const double ones[DRIVEN_PARTS] = { 1, 1, 1 };
    const driven *d = p->d;
    const int has_sides = (int)(p->law->free >> GAP & 1);
    double memory = 0, part[DRIVEN_PARTS] = { 0 };
    ss_scene scene = ss_scene_defaults;
    double number[LAW_NUMBERS];
    if (p->law->parts > 0) {
        p->law->numbers(number, u, ones);
        ss_driven_scene(&scene, p->law, number);
    }
    if (u[DELAY] * d->step != p->late)
        move_earlier(p, u[DELAY] * d->step);
    for (size_t i = 0; p->law->parts > 0 && i < d->n; i++) {
        piece q = { i > 0 ? p->x[i] - p->x[i - 1] : 0, i > 0 ? d->t[i] - d->t[i - 1] : 0, p->v[i], d->slow / 2 };
        const double before = i > 0 ? p->v[i - 1] : 0;
        if (before * q.v < 0) {             /* it turns between the rows, and went farther */
            const double h = q.h * before / (before - q.v), dx = h * before / 2;
            scene.model->drive(&scene, &memory, &(piece){ dx, h, 0, d->slow / 2 }, part);
            q.dx -= dx;
            q.h -= h;
        }
        scene.model->drive(&scene, &memory, &q, part);
        const double own = p->law->parts > 1 && !has_sides ? part[0] : part[0] + part[1];
        p->column[PART][i] = has_sides ? part[0] : own;
        for (size_t k = 1; k < p->law->parts; k++)
            p->column[PART + k][i] = part[k];
        if (p->column[UNEVEN] != NULL)
            p->column[UNEVEN][i] = fabs(own);
        p->column[PLACE][i] = own * p->x[i];
    }
    for (int k = 0; k < OFFSET; k++)
        if (p->column[k] != NULL)
            ss_driven_line(p->line[k], d, p->column[k]);
}

/* --- the amplitudes ------------------------------------------------------------------------ */

void
ss_driven_solve(double h[], size_t m, double right[][UNKNOWNS + COLUMNS], size_t n)
{
    double size[UNKNOWNS + COLUMNS];
    for (size_t k = 0; k < m; k++)
        size[k] = h[k * (m + 1)] > 0 ? sqrt(h[k * (m + 1)]) : 1;
    for (size_t k = 0; k < m; k++)
        for (size_t l = 0; l <= k; l++)
            h[k * m + l] = h[k * m + l] / (size[k] * size[l]) + (k == l ? RIDGE : 0);
    gsl_matrix_view H = gsl_matrix_view_array(h, m, m);
    gsl_linalg_cholesky_decomp1(&H.matrix);
    for (size_t i = 0; i < n; i++) {
        gsl_vector_view C = gsl_vector_view_array(right[i], m);
        for (size_t k = 0; k < m; k++)
            right[i][k] /= size[k];
        gsl_linalg_cholesky_svx(&H.matrix, &C.vector);
        for (size_t k = 0; k < m; k++)
            right[i][k] /= size[k];
    }
}

/* Find the amplitudes of the columns: one that would be negative, and may not, is 0.  Offset and drift are those
 * of all rows: one fold does not tell those of the other. */
static void
find_amplitudes(problem *p)
{
    const driven *d = p->d;
    double g[COLUMNS][COLUMNS] = { { 0 } }, b[COLUMNS] = { 0 }, of_m[COLUMNS * COLUMNS];
    double right[1][UNKNOWNS + COLUMNS], *const c = right[0];
    int of[COLUMNS], worst = 0;
    size_t m = 0;
    for (int k = 0; k < OFFSET; k++)
        if (p->column[k] != NULL)
            of[m++] = k;
    for (size_t i = 0; i < d->n; i++) {
        const double t = p->column[DRIFT][i], f = d->f[i] - p->line[COLUMNS][0] - p->line[COLUMNS][1] * t;
        const int is_used = is_fitted(p, i);
        double x[COLUMNS];
        for (size_t k = 0; is_used && k < m; k++) {
            x[k] = p->column[of[k]][i] - p->line[of[k]][0] - p->line[of[k]][1] * t;
            b[of[k]] += x[k] * f;
            for (size_t l = 0; l <= k; l++)
                g[of[k]][of[l]] += x[k] * x[l];
        }
    }
    while (worst >= 0) {
        for (size_t k = 0; k < m; k++) {
            c[k] = b[of[k]];
            for (size_t l = 0; l <= k; l++)
                of_m[k * m + l] = g[of[k]][of[l]];
        }
        ss_driven_solve(of_m, m, right, 1);
        worst = -1;
        for (size_t k = 0; k < m; k++)
            if (of[k] <= VISCOUS && c[k] < 0 && (worst < 0 || c[k] * b[of[k]] < c[worst] * b[of[worst]]))
                worst = (int)k;
        for (size_t k = (size_t)worst; worst >= 0 && k + 1 < m; k++)
            of[k] = of[k + 1];
        m -= worst >= 0;
    }
    memset(p->now.c, 0, sizeof p->now.c);
    p->now.c[OFFSET] = p->line[COLUMNS][0];
    p->now.c[DRIFT] = p->line[COLUMNS][1];
    for (size_t k = 0; k < m; k++) {
        p->now.c[of[k]] = c[k];
        p->now.c[OFFSET] -= c[k] * p->line[of[k]][0];
        p->now.c[DRIFT] -= c[k] * p->line[of[k]][1];
    }
}

static double
left_of(const problem *p, const double c[], size_t i)
{
    double left = p->d->f[i];
    for (int k = 0; k < COLUMNS; k++)
        if (p->column[k] != NULL)
            left -= c[k] * p->column[k][i];
    return left;
}

/* Set p->now for these unknowns, whose columns are filled in; residual, of the rows fitted, may be NULL. */
static void
evaluate(problem *p, const double u[UNKNOWNS], double *residual)
{
    double sum = 0;
    size_t n = 0;
    find_amplitudes(p);
    memcpy(p->now.u, u, sizeof p->now.u);
    for (size_t i = 0; i < p->d->n; i++)
        if (is_fitted(p, i)) {
            double left = left_of(p, p->now.c, i);
            sum += left * left;
            if (residual != NULL)
                residual[n] = left;
            n++;
        }
    p->now.loss = sum / (double)n;
}

/* --- the search ---------------------------------------------------------------------------- */

/* For ss_least_fit. */
static ss_status
residuals(const double *u, double *residual, double *slopes, void *user)
{
    (void)slopes;
    fill_columns(user, u);
    evaluate(user, u, residual);
    return SS_OK;
}

/* Improve a fit; the columns are then its own. */
static ss_status
improve(problem *p, driven_fit *fit)
{
    double difference[UNKNOWNS], *residual = malloc(p->d->n * sizeof *residual);
    int frees = 0;
    least_end end;
    least how = { .unknowns = UNKNOWNS, .model = residuals, .user = p, .range = p->range, .difference = difference,
                  .farthest = 1, .steps = 10, .tol = NUDGE, .gain = NUDGE, .costly = 1 };
    if (residual == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < p->d->n; i++)
        how.rows += (size_t)is_fitted(p, i);
    for (size_t k = 0; k < UNKNOWNS; k++) {
        const ss_range range = p->range[k];
        frees |= is_free(p, k);
        difference[k] = fit->u[k] > (range.from + range.to) / 2 ? -p->nudge[k] : p->nudge[k];
    }
    ss_status st = frees ? ss_least_fit(&end, &how, fit->u, NULL, NULL) : SS_OK;
    if (st == SS_OK)
        st = residuals(fit->u, residual, NULL, p);
    *fit = p->now;
    free(residual);
    return st;
}

/* Find starts for the fits without either fold and of all rows. */
static ss_status
search(problem *p, driven_fit best[FOLDS + 1][KEPT])
{
    static const size_t points[] = { 1, 24, 40, 60 };
    size_t dim = 0;
    for (size_t k = 0; k < DELAY; k++)
        dim += (size_t)is_free(p, k);
    gsl_qrng *all_over = gsl_qrng_alloc(gsl_qrng_sobol, dim > 0 ? (unsigned)dim : 1);
    if (all_over == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < (dim < 4 ? points[dim] : points[3]); i++) {
        double u[UNKNOWNS], part[UNKNOWNS];
        memcpy(u, p->law->held, sizeof u);
        gsl_qrng_get(all_over, part);
        for (size_t k = 0, n = 0; k < DELAY; k++) {
            const ss_range in = p->range[k];
            if (is_free(p, k))
                u[k] = in.from + (1 + (in.from == -in.to ? 2 : 3) * part[n++]) / 4 * (in.to - in.from);
        }
        fill_columns(p, u);
        for (p->without = 0; p->without <= ALL; p->without++) {
            evaluate(p, u, NULL);
            for (driven_fit *at = best[p->without], other; at < best[p->without] + KEPT; at++)
                if (p->now.loss < at->loss) {
                    other = *at;
                    *at = p->now;
                    p->now = other;
                }
        }
    }
    gsl_qrng_free(all_over);
    return SS_OK;
}

/* Find the covariance of the unknowns and the amplitudes of the fit of all rows, whose columns are filled in.
 * slopes: room for a row of them for each row. */
static void
find_covariance(problem *p, driven_result *r, double *slopes)
{
    const driven *d = p->d;
    const driven_fit *fit = &r->fit[ALL];
    size_t of[UNKNOWNS + COLUMNS], m = 0;
    double h[(UNKNOWNS + COLUMNS) * (UNKNOWNS + COLUMNS)] = { 0 };
    double score[BLOCKS + 1][UNKNOWNS + COLUMNS] = { { 0 } };
    for (size_t k = 0; k < COLUMNS; k++)
        if (fit->c[k] != 0) {
            for (size_t i = 0; i < d->n; i++)
                slopes[i * (UNKNOWNS + COLUMNS) + m] = p->column[k][i];
            of[m++] = UNKNOWNS + k;
        }
    for (size_t k = 0; k < UNKNOWNS; k++) {
        const ss_range range = p->range[k];
        double u[UNKNOWNS];
        memcpy(u, fit->u, sizeof u);
        if (u[k] <= range.from || u[k] >= range.to)
            continue;               /* it is held there */
        const double nudge = u[k] + p->nudge[k] < range.to ? p->nudge[k] : -p->nudge[k];
        u[k] += nudge;
        fill_columns(p, u);
        for (size_t i = 0; i < d->n; i++)
            slopes[i * (UNKNOWNS + COLUMNS) + m] = (r->left[i] - left_of(p, fit->c, i)) / nudge;
        of[m++] = k;
    }
    for (size_t i = 0; i < d->n; i++) {
        const double *s = slopes + i * (UNKNOWNS + COLUMNS);
        for (size_t k = 0; k < m && d->used[i]; k++) {
            score[i * BLOCKS / d->n][k] += s[k] * r->left[i];
            for (size_t l = 0; l <= k; l++)
                h[k * m + l] += s[k] * s[l];
        }
    }
    /* The mean of a value is known to half a step of the converter, unless noise moves it (Widrow 1956). */
    const double stands = d->code / 2 * exp(-2 * M_PI * M_PI * fit->loss / (d->code * d->code));
    for (size_t k = 0; k < m; k++)
        if (h[k * (m + 1)] > 0)
            r->covariance[of[k]][of[k]] = stands * stands / d->codes * (double)d->n / h[k * (m + 1)];
    ss_driven_solve(h, m, score, BLOCKS);
    for (size_t i = 0; i < BLOCKS * m; i++)
        score[i / m][i % m] *= sqrt((double)BLOCKS / (double)(BLOCKS - m));
    for (size_t k = 0; k < m; k++)
        score[BLOCKS][k] = of[k] < UNKNOWNS ? (r->fit[0].u[of[k]] - r->fit[1].u[of[k]]) / 2
            : (r->fit[0].c[of[k] - UNKNOWNS] - r->fit[1].c[of[k] - UNKNOWNS]) / 2;
    for (size_t b = 0; b <= BLOCKS; b++)
        for (size_t k = 0; k < m; k++)
            for (size_t l = 0; l < m; l++)
                r->covariance[of[k]][of[l]] += score[b][k] * score[b][l];
}

ss_status
ss_driven_fit(driven_result *out, const driven_law *law, const driven *d, const driven *coarse)
{
    problem p = { 0 }, rough = { 0 };
    driven_fit start[FOLDS + 1][KEPT];
    double rows = 0, *slopes = malloc(d->n * (UNKNOWNS + COLUMNS) * sizeof *slopes);
    *out = (driven_result){ .law = law, .left = calloc(2 * d->n, sizeof *out->left) };
    ss_status st = slopes != NULL && out->left != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        st = problem_new(&p, law, d);
    if (st == SS_OK)
        st = problem_new(&rough, law, coarse);
    if (st == SS_OK) {
        for (size_t i = 0; i < d->n; i++)
            rows += d->used[i];
        for (size_t k = 0; k < (FOLDS + 1) * KEPT; k++)
            start[k / KEPT][k % KEPT].loss = INFINITY;
        st = search(&rough, start);
    }
    /* without each fold, from the best of the starts; what it leaves of that fold is added up */
    for (int fold = 0; fold <= ALL && st == SS_OK; fold++) {
        driven_fit *fit = &out->fit[fold], *from = start[fold];
        p.without = rough.without = fold;
        *fit = *from;
        for (size_t k = 0; k < KEPT && st == SS_OK && isfinite(from[k].loss); k++) {
            st = improve(&rough, &from[k]);
            if (from[k].loss < fit->loss || k == 0)
                *fit = from[k];
        }
        if (st == SS_OK)
            st = improve(&p, fit);
        for (size_t i = 0; i < d->n && st == SS_OK; i++) {
            const double left = out->left[i] = left_of(&p, fit->c, i);
            const double part = d->used[i] && driven_fold(d, i) == fold ? left * left / rows : 0;
            out->loss += part;
            out->block[i * BLOCKS / d->n] += part;
        }
    }
    if (st == SS_OK) {
        out->own = out->left + d->n;
        for (size_t k = PART; k < law->parts; k++)
            for (size_t i = 0; i < d->n; i++)
                out->own[i] += out->fit[ALL].c[k] * p.column[k][i];
        find_covariance(&p, out, slopes);
    }
    free(p.room);
    free(rough.room);
    free(slopes);
    return st;
}

ss_status
ss_driven_predict(double out[], const driven_law *law, const driven *d, const driven_fit *fit)
{
    problem p;
    ss_status st = problem_new(&p, law, d);
    if (st != SS_OK)
        return st;
    fill_columns(&p, fit->u);
    for (size_t i = 0; i < d->n; i++)
        out[i] = d->f[i] - left_of(&p, fit->c, i);
    free(p.room);
    return SS_OK;
}
