/* walk.c -- carry a motion from event to event. */
#include "motion/walk.h"

#include <string.h>
#include "base/error.h"
#include "motion/bernstein.h"
#include "motion/event.h"
#include "motion/method.h"

static void
begin_mode(walk *w)
{
    w->cap = ss_step_cap(&w->m.now);
    w->lasted = 0;
    w->e->type->begin(w->e);
}

ss_status
ss_walk_begin(walk *w, const ss_scene *scene, const ss_sim_opts *opts, ss_error *err)
{
    const struct method *how = ss_method_for(scene, USUAL);     /* w is filled even on failure */
    ss_status st = ss_method_named(&how, opts->method, scene, err);
    *w = (walk){ .m = ss_motion_of(scene, how->kind == CLOSED_FORM, opts->tol), .how = how };
    w->slips = ss_motion_start(&w->m);
    if (st == SS_OK)
        st = ss_engine_new(&w->e, &w->m, how, opts->tol, err);
    if (st == SS_OK)
        begin_mode(w);
    return st;
}

void
ss_walk_begin_at(walk *w, const motion *from)
{
    w->m = *from;
    ss_motion_rebase(&w->m);
    w->m.origin = (instant){ 0, 0 };
    ss_motion_rebase(&w->m);
    w->in_a_row = 0;
    begin_mode(w);
}

void
ss_walk_at(walk *w, double s, double q[], double dqdt[])
{
    const state *m = &w->m.now;
    turn base = base_turn(m, m->u + s);
    if (!w->still) {
        w->e->type->at(w->e, ANYWHERE, s, base, q, dqdt);
        return;
    }
    memcpy(q, m->q, sizeof m->q);
    memset(dqdt, 0, sizeof m->q);
}

/* --- a leg ---------------------------------------------------------------------------------- */

static ss_status
fail_lost(const engine *e, ss_error *err)
{
    return ss_fail(err, SS_ERANGE, "the state or its rate of change is not finite at t = %.9g s: "
                   "numbers of this scene lie beyond double precision",
                   e->m->origin.hi + e->m->now.u + e->h);
}

/* Make a step.  SS_ERANGE: it leads to a state that is not finite.  Only the rates of change need a test:
 * each part of the state is in one of them, and the parts that a model does not have are 0. */
static ss_status
make_step(engine *e, double h_max, ss_error *err)
{
    e->series.degree = 0;
    ss_status st = e->type->step(e, h_max, err);
    if (st != SS_OK || 0 * e->dq1[0] + 0 * e->dq1[1] + 0 * e->dq1[2] == 0)
        return st;
    return fail_lost(e, err);
}

static guard_value
guard_at(double s, void *user)
{
    engine *e = user;
    const state *m = &e->m->now;
    double q[MAX_DIM], dqdt[MAX_DIM];
    guard_value at;
    e->type->at(e, ANYWHERE, s, base_turn(m, m->u + s), q, dqdt);
    at.g = bound_value(&m->bound[e->ended], q, dqdt, &at.slope);
    e->lost |= isnan(at.g);
    return at;
}

/* The guard of a step, but not its polynomial p. */
static step_guard
guard_of_step(const engine *e, const bound *b)
{
    const state *m = &e->m->now;
    double base = m->scene->base != NULL ? m->scene->stiffness * m->scene->base->size : m->drive;
    double a = (base + fabs(m->ramp * (m->u + e->h)) + fabs(m->drag) + fabs(m->f0)
                + fabs(m->k * m->q[0]) + fabs(m->c * m->q[1])) / m->scene->mass;
    double by_place = fabs(b->of[0]) + fabs(b->of[2]);
    return (step_guard){ .level = b->level, .either_side = b->either_side, .h = e->h,
                         .rounding = a * e->h * (fabs(b->of[1]) + by_place * e->h / 8) };     /* of v' */
}

/* Find the end of the mode from a bound and its slope at the ends of the step, and by repeating the
 * step with other lengths. */
static int
ends_by_steps(engine *e, const bound *b, double *s_event)
{
    guard_value at_0, at_h;
    at_0.g = bound_value(b, e->m->now.q, e->dq0, &at_0.slope);
    at_h.g = bound_value(b, e->q1, e->dq1, &at_h.slope);
    int ends = ss_event_find(guard_at, e, e->h, at_0, at_h, s_event);
    return e->lost ? -1 : ends;
}

/* Find it from the series of the step. */
static int
ends_by_series(const engine *e, const bound *b, double *s_event, int *unresolved)
{
    const int degree = e->series.degree;
    double p[MOST_DEGREE + 1], step = e->h * e->series.per_unit, scale = 1;
    step_guard g = guard_of_step(e, b);
    for (int n = 0; n <= degree; n++, scale *= step) {
        const double *c = e->series.c[n];
        p[n] = b->of[0] * (scale * c[0]) + b->of[1] * (scale * c[1]) + b->of[2] * (scale * c[2]);
    }
    if (ss_guard_is_clear(&g, degree, p))
        return 0;
    ss_guard_by_series(&g, degree, p);
    return ss_first_zero(&g, s_event, unresolved);
}

/* The bound that is reached first ends the mode. */
static ss_status
ends_within(engine *e, int *ends, double *s_event, ss_error *err)
{
    const state *m = &e->m->now;
    int unresolved = 0, first = 0;
    *ends = 0;
    ss_engine_expand(e);
    for (e->ended = 0; e->ended < m->n_bounds; e->ended++) {
        const bound *b = &m->bound[e->ended];
        double s;
        int found = e->series.degree > 0 ? ends_by_series(e, b, &s, &unresolved) : ends_by_steps(e, b, &s);
        if (found < 0)
            return fail_lost(e, err);
        if (!found || (*ends && s >= *s_event))
            continue;
        *ends = 1;
        *s_event = s;
        first = e->ended;
    }
    e->ended = first;
    e->m->unresolved += (unsigned long)unresolved;
    return SS_OK;
}

ss_status
ss_walk_leg(walk *w, double longest, ss_error *err)
{
    const state *m = &w->m.now;
    engine *e = w->e;
    double u_end;
    if (w->max_steps > 0
        && (e->steps >= w->max_steps || e->rhs / RHS_PER_STEP >= w->max_steps))
        return ss_fail(err, SS_EBUDGET, "step budget of %lu used up at t = %.9g s", w->max_steps,
                       w->m.origin.hi + m->u);
    w->still = m->model->still != NULL && m->model->still(m, &u_end);
    if (w->still) {
        w->h = fmin(u_end - m->u, longest);
        w->ends = isfinite(u_end) && u_end - m->u <= longest;
        if (!w->ends) {
            memcpy(e->q1, m->q, sizeof e->q1);
            memset(e->dq1, 0, sizeof e->dq1);
            e->h = longest;
        }
        return SS_OK;
    }
    w->h = longest;
    w->ends = e->type->ahead != NULL && !w->by_steps ? e->type->ahead(e, longest, &w->h) : -1;
    if (w->ends >= 0)
        return SS_OK;
    ss_status st = make_step(e, fmin(w->cap, longest), err);
    if (st != SS_OK)
        return st;
    if (e->h > longest) {               /* steps of an exact engine may be longer than asked for */
        e->h = longest;
        ss_walk_at(w, longest, e->q1, e->dq1);
    }
    w->h = e->h;
    return ends_within(e, &w->ends, &w->h, err);
}

/* --- its end ---------------------------------------------------------------------------------- */

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
static int
next_mode(engine *e, int still, double s, ss_event *event)
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
    now->ended = e->ended;
    ss_motion_rebase(m);
    if (!now->model->kinks && now->mode != 0 && fabs(now->x_ref + now->q[0] - m->x_begin) <= m->doubt)
        m->unresolved++;
    if (!now->model->next(now, event))
        return 0;
    m->x_begin = now->x_ref + now->q[0];
    e->events++;
    return 1;
}

/* The step has contained no event: go to its end. */
static void
accept_step(engine *e)
{
    state *m = &e->m->now;
    memcpy(m->q, e->q1, sizeof m->q);
    memcpy(e->dq0, e->dq1, sizeof e->dq0);
    m->u += e->h;
    if (e->type->go_on != NULL)
        e->type->go_on(e);
    else
        ss_motion_rebase(e->m);
}

ss_status
ss_walk_on(walk *w, int *is_event, ss_event *event, ss_error *err)
{
    *is_event = 0;
    w->lasted += w->h;
    if (!w->ends) {
        accept_step(w->e);
        return SS_OK;
    }
    *is_event = next_mode(w->e, w->still, w->h, event);
    double lasted = w->lasted;
    begin_mode(w);
    return ss_motion_chatters(&w->m, lasted, &w->in_a_row, err);
}

void
ss_walk_end(walk *w)
{
    ss_engine_free(w->e);
    w->e = NULL;
}
