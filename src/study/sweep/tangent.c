/* tangent.c -- the derivative of a walk by its initial state.
 *
 * Within a mode it is that of a linear equation.  At an event, which another initial state reaches
 * at another time, it jumps by the saltation matrix (Aizerman and Gantmakher 1958; Leine and
 * Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7).  A Coulomb
 * stick forgets v and the time at which it began, so one direction of the derivative is lost in
 * it. */
#include "study/sweep/meter.h"

#include <math.h>

enum { REF, Q, V };

void
ss_tangent_begin(tangent *t, const state *m)
{
    int stuck = m->mode == 0, compliant = m->scene->model == SS_COMPLIANT;
    *t = (tangent){ .d = { [Q][Q] = 1 } };
    t->d[REF][REF] = stuck && compliant;
    t->d[V][V] = !stuck || compliant;
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
        double force = m->scene->stiffness * t->d[REF][i] / mass, q = t->d[Q][i], v = t->d[V][i];
        t->d[Q][i] = C * q + S * v - G * force;
        t->d[V][i] = -m->k / mass * S * q + (C - m->c / mass * S) * v - S * force;
    }
}

/* The end of a microstick, where |y + ratio v| reaches its limit. */
static void
release(tangent *t, const walk *w, const double q[], const double rates[])
{
    const ss_scene *s = w->m.now.scene;
    double ratio = s->release == SS_RELEASE_TOTAL ? s->contact_damping / s->contact_stiffness : 0;
    double jump = rates[1] - w->e->dq0[1];
    for (int i = 0; i < 3; i++) {
        double later = -(t->d[Q][i] + ratio * t->d[V][i]) / (q[1] + ratio * rates[1]);
        t->d[Q][i] += t->d[REF][i];
        t->d[V][i] += jump * later;
        t->d[REF][i] = 0;
    }
}

/* The end of a slip, where v reaches 0. */
static void
stop(tangent *t, const walk *w, const double rates[])
{
    const state *m = &w->m.now;
    int microstick = m->mode == 0 && m->scene->model == SS_COMPLIANT;
    double factor = m->mode == 0 && !microstick ? 0 : w->e->dq0[1] / rates[1];
    for (int i = 0; i < 3; i++) {
        t->d[V][i] *= factor;
        if (microstick) {
            t->d[REF][i] = t->d[Q][i];
            t->d[Q][i] = 0;
        }
    }
}

void
ss_tangent_event(tangent *t, const walk *w, int mode, const double q[], const double rates[],
                 int is_event)
{
    if (mode != 0 && is_event)
        stop(t, w, rates);
    else if (mode == 0 && is_event && w->m.now.scene->model == SS_COMPLIANT)
        release(t, w, q, rates);
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
    int never_slips = d[REF][REF] == 1 && d[REF][Q] == 0 && d[REF][V] == 0;
    double trace = d[Q][Q] + d[V][V], minors = d[Q][Q] * d[V][V] - d[Q][V] * d[V][Q];
    if (!never_slips) {
        trace += d[REF][REF];
        minors += d[REF][REF] * (d[Q][Q] + d[V][V]) - d[REF][Q] * d[Q][REF] - d[REF][V] * d[V][REF];
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
    if (never_slips && *first < 1) {            /* wherever it came to rest, there it stays */
        *second = *first;
        *first = 1;
        *angle = 0;
    }
}
