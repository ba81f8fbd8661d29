/* walk.c -- carry a motion from event to event without samples between. */
#include "motion/walk.h"

#include <string.h>
#include "base/error.h"
#include "motion/method.h"

ss_status
ss_walk_begin(walk *w, const ss_scene *scene, const ss_sim_opts *opts, ss_error *err)
{
    const struct method *how = ss_method_for(scene, USUAL);     /* w is filled even on failure */
    ss_status st = ss_method_named(&how, opts->method, scene, err);
    *w = (walk){ .m = ss_motion_of(scene, how->kind == CLOSED_FORM, opts->tol), .max_steps = opts->max_steps };
    ss_motion_start(&w->m);
    if (st == SS_OK)
        st = ss_engine_new(&w->e, &w->m, how, opts->tol, err);
    if (st == SS_OK)
        ss_engine_begin(w->e);
    return st;
}

void
ss_walk_begin_at(walk *w, const motion *from)
{
    w->m = *from;
    ss_motion_rebase(&w->m);
    w->m.origin = (instant){ 0, 0 };
    ss_motion_rebase(&w->m);
    w->lasted = 0;
    w->in_a_row = 0;
    ss_engine_begin(w->e);
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

/* Make the steps of a leg, as ss_sim_run makes them. */
static ss_status
advance(walk *w, double longest, ss_error *err)
{
    double cap = ss_step_cap(&w->m.now);
    ss_status st = ss_engine_step(w->e, fmin(cap, longest), err);
    if (st != SS_OK)
        return st;
    if (w->e->h > longest) {            /* steps of an exact engine may be longer than asked for */
        w->e->h = longest;
        ss_walk_at(w, longest, w->e->q1, w->e->dq1);
    }
    w->h = w->e->h;
    return ss_engine_ends_within(w->e, &w->ends, &w->h, err);
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
        w->h = u_end - m->u;
        if (isinf(w->h) && isinf(longest))
            return ss_fail(err, SS_EDATA, "the stick at t = %.9g s is without end: no slip comes within a "
                           "time that a double holds", w->m.origin.hi + m->u);
        w->ends = w->h <= longest;
        if (!w->ends) {
            w->h = longest;
            ss_engine_rest(e, longest);
        }
        return SS_OK;
    }
    w->h = longest;
    w->ends = e->type->ahead != NULL ? e->type->ahead(e, longest, &w->h) : -1;
    return w->ends >= 0 ? SS_OK : advance(w, longest, err);
}

ss_status
ss_walk_on(walk *w, int *is_event, ss_event *event, ss_error *err)
{
    *is_event = 0;
    w->lasted += w->h;
    if (!w->ends) {
        ss_engine_accept(w->e);
        return SS_OK;
    }
    *is_event = ss_engine_next_mode(w->e, w->still, w->h, event);
    ss_engine_begin(w->e);
    ss_status st = ss_motion_chatters(&w->m, w->lasted, &w->in_a_row, err);
    w->lasted = 0;
    return st;
}

void
ss_walk_end(walk *w)
{
    ss_engine_free(w->e);
    w->e = NULL;
}
