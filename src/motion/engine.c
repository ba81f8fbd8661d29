/* engine.c -- a step of any engine, the end of a mode within it, and the next mode. */
#include "motion/engine.h"

#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "motion/bernstein.h"
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

void
ss_engine_begin(engine *e)
{
    e->has_start = e->has_guard = 0;
    e->type->begin(e);
}

void
ss_engine_free(engine *e)
{
    if (e != NULL && e->type->release != NULL)
        e->type->release(e);
    free(e);
}

static void
derive(const state *m, double u, const double q[], const double dqdt[],
       double d[ORDERS + 1][MAX_DIM])
{
    memcpy(d[0], q, sizeof d[0]);
    memcpy(d[1], dqdt, sizeof d[1]);
    m->model->derivatives(m, u, q, dqdt, d + 2);
}

void
ss_engine_derive(engine *e)
{
    const state *m = &e->m->now;
    if (!e->has_start)
        derive(m, m->u, m->q, e->dq0, e->start);
    if (!e->has_end)
        derive(m, m->u + e->h, e->q1, e->dq1, e->end);
    e->has_start = e->has_end = 1;
}

/* A guard is its value at the origin plus of_q q + of_v v; its rate of change for q' = 1 and for v' = 1
 * is each factor. */
static void
find_guard(engine *e)
{
    static const double origin[MAX_DIM] = { 0 }, q[MAX_DIM] = { 1, 0 }, v[MAX_DIM] = { 0, 1 };
    const state *m = &e->m->now;
    e->level = m->model->guard(m, origin, origin, &e->of_q);
    m->model->guard(m, q, q, &e->of_q);
    m->model->guard(m, q, v, &e->of_v);
    e->has_guard = 1;
}

/* Fill in the guard of a step, but not its polynomial p.  In stick the force has a limit on either side. */
static void
guard_of_step(engine *e, step_guard *g)
{
    const state *m = &e->m->now;
    if (!e->has_guard)
        find_guard(e);
    g->level = e->level;
    g->either_side = m->mode == 0;
    g->h = e->h;
    double base = m->scene->base != NULL ? m->scene->stiffness * m->scene->base->size : m->drive;
    double a = (base + fabs(m->ramp * (m->u + e->h)) + fabs(m->drag) + fabs(m->f0)
                + fabs(m->k * m->q[0]) + fabs(m->c * m->q[1])) / m->scene->mass;
    g->rounding = a * e->h * (fabs(e->of_v) + fabs(e->of_q) * e->h / 8);    /* of v' */
}

/* Find the end of the mode from the guard and its slope at the ends of the step, and by repeating the
 * step with other lengths. */
static int
ends_by_steps(engine *e, double *s_event)
{
    const state *m = &e->m->now;
    guard_value at_0, at_h;
    at_0.g = m->model->guard(m, m->q, e->dq0, &at_0.slope);
    at_h.g = m->model->guard(m, e->q1, e->dq1, &at_h.slope);
    int ends = ss_event_find(guard_at, e, e->h, at_0, at_h, s_event);
    return e->lost ? -1 : ends;
}

static int
ends_by_derivatives(engine *e, double *s_event, int *unresolved)
{
    double at_0[ORDERS + 1], at_h[ORDERS + 1];
    step_guard g;
    ss_engine_derive(e);
    guard_of_step(e, &g);
    for (int i = 0; i <= ORDERS; i++) {
        at_0[i] = e->of_q * e->start[i][0] + e->of_v * e->start[i][1];
        at_h[i] = e->of_q * e->end[i][0] + e->of_v * e->end[i][1];
    }
    ss_guard_by_ends(&g, at_0, at_h);
    return ss_first_zero(&g, s_event, unresolved);
}

static int
ends_by_curve(engine *e, double *s_event, int *unresolved)
{
    double c[MOST_DEGREE + 1][MAX_DIM], p[MOST_DEGREE + 1];
    step_guard g;
    guard_of_step(e, &g);
    int degree = e->type->curve(e, c);
    for (int i = 0; i <= degree; i++)
        p[i] = e->of_q * c[i][0] + e->of_v * c[i][1];
    if (ss_guard_is_clear(&g, degree, p))
        return 0;
    ss_guard_by_series(&g, degree, p);
    return ss_first_zero(&g, s_event, unresolved);
}

ss_status
ss_engine_ends_within(engine *e, int *ends, double *s_event, ss_error *err)
{
    const ss_model *model = e->m->now.model;
    int unresolved = 0;
    *ends = 0;
    if (model->guard == NULL || e->clear)
        return SS_OK;
    *ends = e->type->curve != NULL ? ends_by_curve(e, s_event, &unresolved)
        : model->derivatives != NULL ? ends_by_derivatives(e, s_event, &unresolved)
        : ends_by_steps(e, s_event);
    e->m->unresolved += (unsigned long)unresolved;
    return *ends < 0 ? fail_lost(e, err) : SS_OK;
}

/* Returns 1 if a pull ends a stick after so short a time s that without the stick the force, growing at
 * its rate, would have moved the mass by rate s^3 / (6 m), no further than the doubt. */
static int
barely_sticks(const motion *m, double s)
{
    const state *now = &m->now;
    return now->ramp != 0
        && fabs(base_force_rate(now, now->u)) * s * s * s <= 6 * now->scene->mass * m->doubt;
}

/* The mode has ended s from now: enter the next one.  Returns 1 if this is an event. */
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
    m->unresolved += (unsigned long)(still && barely_sticks(m, s));
    now->u += s;
    ss_motion_rebase(m);
    if (!now->model->kinks && now->mode != 0 && fabs(now->x_ref + now->q[0] - m->x_begin) <= m->doubt)
        m->unresolved++;
    if (!now->model->next(now, event))
        return 0;
    m->x_begin = now->x_ref + now->q[0];
    e->events++;
    return 1;
}

/* Make a step.  SS_ERANGE: it leads to a state that is not finite.  Only the rates of change need a test:
 * each part of the state is in one of them, and the parts that a model does not have are 0. */
ss_status
ss_engine_step(engine *e, double h_max, ss_error *err)
{
    e->clear = e->has_end = 0;
    ss_status st = e->type->step(e, h_max, err);
    if (st != SS_OK || 0 * e->dq1[0] + 0 * e->dq1[1] + 0 * e->dq1[2] == 0)
        return st;
    return fail_lost(e, err);
}

void
ss_engine_rest(engine *e, double h)
{
    memcpy(e->q1, e->m->now.q, sizeof e->q1);
    memset(e->dq1, 0, sizeof e->dq1);
    e->has_end = 0;
    e->h = h;
}

/* The step has contained no event: go to its end. */
void
ss_engine_accept(engine *e)
{
    state *m = &e->m->now;
    memcpy(m->q, e->q1, sizeof m->q);
    memcpy(e->dq0, e->dq1, sizeof e->dq0);
    memcpy(e->start, e->end, sizeof e->start);
    e->has_start = e->has_end;
    m->u += e->h;
    e->type->go_on(e);
}
