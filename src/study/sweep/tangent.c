/* tangent.c -- the derivative of a walk by its initial state.
 *
 * Within a mode it is that of a linear equation.  At an event, which another initial state reaches
 * at another time, it jumps by the saltation matrix (Aizerman and Gantmakher 1958; Leine and
 * Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7).  A Coulomb
 * stick forgets v and the time at which it began, so one direction of the derivative is lost in
 * it. */
#include "study/sweep/meter.h"

#include <math.h>

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
    const state *m = &w->m.now;
    double C, S, G, mass = m->scene->mass;
    if (w->still)
        return;
    ss_exact_response(w->e, w->h, &C, &S, &G);
    for (int i = 0; i < 3; i++) {
        double force = m->scene->stiffness * t->d[D_REF][i] / mass, q = t->d[D_Q][i], v = t->d[D_V][i];
        t->d[D_Q][i] = C * q + S * v - G * force;
        t->d[D_V][i] = -m->k / mass * S * q + (C - m->c / mass * S) * v - S * force;
    }
}

void
ss_tangent_event(tangent *t, const walk *w, int mode, const double q[], const double rates[])
{
    const state *m = &w->m.now;
    m->model->variation->cross(m, mode, q, rates, w->e->dq0, t->d);
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

/* The eigenvalues of the last two rows and columns, or of all three of which one is then 0: the
 * mode in which x_ref counts for nothing lies on the way. */
void
ss_tangent_multipliers(const tangent *t, double *first, double *second, double *angle)
{
    const double (*d)[3] = t->d;
    int never_slips = d[D_REF][D_REF] == 1 && d[D_REF][D_Q] == 0 && d[D_REF][D_V] == 0;
    double trace = d[D_Q][D_Q] + d[D_V][D_V], minors = d[D_Q][D_Q] * d[D_V][D_V] - d[D_Q][D_V] * d[D_V][D_Q];
    if (!never_slips) {
        trace += d[D_REF][D_REF];
        minors += d[D_REF][D_REF] * (d[D_Q][D_Q] + d[D_V][D_V]) - d[D_REF][D_Q] * d[D_Q][D_REF] - d[D_REF][D_V] * d[D_V][D_REF];
    }
    double under = trace * trace / 4 - minors;
    if (under < 0) {
        *first = *second = sqrt(minors);
        *angle = acos(fmax(-1, fmin(1, trace / 2 / *first)));
    } else {
        double large = trace / 2 + copysign(sqrt(under), trace);
        *first = fabs(large);
        *second = large != 0 ? fabs(minors / large) : 0;
        *angle = large < 0 ? M_PI : 0;
    }
    if (never_slips && *first < 1) {            /* it stays wherever it came to rest */
        *second = *first;
        *first = 1;
        *angle = 0;
    }
}
