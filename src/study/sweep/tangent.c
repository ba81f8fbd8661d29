/* tangent.c -- the derivative of a walk with respect to its initial state.
 *
 * Within a mode an engine computes it.  Another initial state reaches an event at another time, so
 * the derivative jumps there, by the saltation matrix (Aizerman and Gantmakher 1958; Leine and
 * Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7).  The motion
 * after a Coulomb stick does not depend on v and on the time at which the stick began, so a stick
 * removes one direction of the derivative. */
#include "study/sweep/meter.h"

#include <math.h>
#include <string.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>

void
ss_tangent_begin(tangent *t, const state *m)
{
    int is_free[D_MOST];
    *t = (tangent){ 0 };
    m->model->variation->free(m, is_free);
    for (int i = 0; i < D_MOST; i++)
        t->d[i][i] = is_free[i];
}

void
ss_tangent_leg(tangent *t, const walk *w)
{
    double leg[D_MOST][D_MOST];
    const tangent before = *t;
    if (w->still)
        return;
    w->e->type->response(w->e, w->h, leg);
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            t->d[i][j] = leg[i][D_REF] * before.d[D_REF][j] + leg[i][D_Q] * before.d[D_Q][j]
                + leg[i][D_V] * before.d[D_V][j];
}

void
ss_tangent_event(tangent *t, const walk *w, int mode, const double q[], const double rates[])
{
    const state *m = &w->m.now;
    for (int i = 0; i < D_MOST; i++)
        t->later[i] = -t->d[D_V][i] / rates[1];
    m->model->variation->cross(m, mode, q, rates, w->e->dq0, t->d);
}

void
ss_tangent_on_onset(tangent *t, const state *m)
{
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            t->d[i][j] = i == D_REF && j == D_REF ? t->d[i][j] - pull_of(m->scene) * t->later[j] : 0;
}

void
ss_tangent_solve(const tangent *t, const double unit[3], const double r[3], double d[3])
{
    double a[3][4];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            a[i][j] = (i == j) - t->d[i][j] * unit[j] / unit[i];
        a[i][3] = r[i] / unit[i];
    }
    int lost[3] = { 0 };
    for (int k = 0; k < 3; k++) {               /* Gauss-Jordan with partial pivoting */
        int best = k;
        for (int i = k + 1; i < 3; i++)
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        for (int j = 0; j < 4; j++) {
            double swap = a[k][j];
            a[k][j] = a[best][j];
            a[best][j] = swap;
        }
        lost[k] = !(fabs(a[k][k]) > 1e-13);
        for (int i = 0; i < 3 && !lost[k]; i++) {
            double factor = a[i][k] / a[k][k];
            for (int j = k; j < 4 && i != k; j++)
                a[i][j] -= factor * a[k][j];
        }
    }
    for (int k = 0; k < 3; k++)
        d[k] = lost[k] ? 0 : unit[k] * a[k][3] / a[k][k];
}

ss_status
ss_tangent_multipliers(const tangent *t, double *first, double *second, double *angle)
{
    double d[D_MOST][D_MOST], sum = 0;
    gsl_complex value[D_MOST];
    gsl_matrix_view matrix = gsl_matrix_view_array(d[0], D_MOST, D_MOST);
    gsl_vector_complex_view values = gsl_vector_complex_view_array((double *)value, D_MOST);
    *first = *second = *angle = NAN;
    memcpy(d, t->d, sizeof d);
    for (int i = 0; i < D_MOST * D_MOST; i++)
        sum += d[i / D_MOST][i % D_MOST];
    if (!isfinite(sum))
        return SS_OK;
    gsl_eigen_nonsymm_workspace *w = gsl_eigen_nonsymm_alloc(D_MOST);
    if (w == NULL)
        return SS_ENOMEM;
    gsl_eigen_nonsymm_params(0, 1, w);          /* balanced: x and v differ by powers of ten */
    int st = gsl_eigen_nonsymm(&matrix.matrix, &values.vector, w);
    gsl_eigen_nonsymm_free(w);
    if (st != 0)
        return SS_OK;
    *first = -1;
    for (int i = 0; i < D_MOST; i++) {
        double modulus = gsl_complex_abs(value[i]);
        if (modulus > *first) {
            *second = *first;
            *first = modulus;
            *angle = modulus > 0 ? fabs(gsl_complex_arg(value[i])) : 0;
        } else {
            *second = fmax(*second, modulus);
        }
    }
    return SS_OK;
}
