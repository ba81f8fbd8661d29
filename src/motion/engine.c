/* engine.c -- what engines that take steps have in common. */
#include "motion/engine.h"

#include <stdlib.h>
#include "base/error.h"
#include "motion/method.h"

void
ss_engine_begin_steps(engine *e)
{
    const state *m = &e->m->now;
    e->rhs++;
    m->model->rates(m, base_force(m, m->u), m->q, e->dq0);
    e->shortest = ss_step_floor(m);
}

ss_status
ss_engine_fail_short(const engine *e, ss_error *err)
{
    return ss_fail(err, SS_ETOL, "%s cannot keep the tolerance %.3g at t = %.9g s: the step fell below %.3g s",
                   e->how->name, e->tol, e->m->origin.hi + e->m->now.u, e->shortest);
}

void
ss_engine_free(engine *e)
{
    if (e != NULL && e->type->release != NULL)
        e->type->release(e);
    free(e);
}

void
ss_engine_expand(engine *e)
{
    const state *m = &e->m->now;
    double step[MOST_SERIES + 1];
    if (e->series.degree > 0 || !m->model->linear)
        return;
    e->series.degree = e->type->degree;
    for (int n = 0; n <= e->series.degree; n++)
        step[n] = e->h / (n + 1);
    m->model->series(m, step, e->series.degree, e->series.c);
    e->series.per_unit = 1 / e->h;
}
