/* engine.c -- a step of any engine, the end of a mode within it, and the next mode. */
#include "motion/engine.h"

#include <string.h>
#include "base/error.h"
#include "motion/event.h"

static guard_value
guard_at(double s, void *user)
{
    engine *e = user;
    const state *m = &e->m->now;
    double q[MAX_DIM], dqdt[MAX_DIM];
    guard_value at;
    e->type->at(e, ANYWHERE, s, base_turn(m, m->u + s), q, dqdt);
    at.g = m->model->guard(m, q, dqdt, &at.slope);
    e->lost |= isnan(at.g);
    return at;
}

static ss_status
fail_lost(const engine *e, ss_error *err)
{
    return ss_fail(err, SS_ERANGE, "the state or its rate of change is not finite at t = %.9g s: "
                   "numbers of this scene lie beyond double precision",
                   e->m->origin.hi + e->m->now.u + e->h);
}

ss_status
ss_engine_ends_within(engine *e, int *ends, double *s_event, ss_error *err)
{
    const state *m = &e->m->now;
    guard_value at_0, at_h;
    *ends = 0;
    if (m->model->guard == NULL)
        return SS_OK;
    at_0.g = m->model->guard(m, m->q, e->dq0, &at_0.slope);
    at_h.g = m->model->guard(m, e->q1, e->dq1, &at_h.slope);
    *ends = ss_event_find(guard_at, e, e->h, at_0, at_h, s_event);
    return e->lost ? fail_lost(e, err) : SS_OK;
}

/* The mode has ended s from now: enter the next one.  1 if that is an event. */
int
ss_engine_next_mode(engine *e, int still, double s, ss_event *event)
{
    motion *m = e->m;
    state *now = &m->now;
    if (!still) {
        double q[MAX_DIM], dqdt[MAX_DIM];
        e->type->at(e, ANYWHERE, s, base_turn(now, now->u + s), q, dqdt);
        memcpy(now->q, q, sizeof q);
    }
    now->u += s;
    ss_motion_rebase(m);
    if (now->mode != 0 && fabs(now->x_ref + now->q[0] - m->x_begin) <= m->doubt)
        m->unresolved++;
    if (!now->model->next(now, event))
        return 0;
    m->x_begin = now->x_ref + now->q[0];
    e->events++;
    return 1;
}

/* A step, unless it leads to what is not finite: then a rate of change is not, since each part of
 * the state is in one (and those that a model does not have are 0). */
ss_status
ss_engine_step(engine *e, double h_max, ss_error *err)
{
    ss_status st = e->type->step(e, h_max, err);
    if (st != SS_OK || 0 * e->dq1[0] + 0 * e->dq1[1] + 0 * e->dq1[2] == 0)
        return st;
    return fail_lost(e, err);
}

/* The step is done with, and no event was in it. */
void
ss_engine_accept(engine *e)
{
    state *m = &e->m->now;
    memcpy(m->q, e->q1, sizeof m->q);
    memcpy(e->dq0, e->dq1, sizeof e->dq0);
    m->u += e->h;
    e->type->go_on(e);
}
