/* walk.c -- carry a motion from event to event. */
#include "motion/walk.h"

#include <string.h>
#include "base/error.h"
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
        if (!w->ends)
            ss_engine_rest(e, longest);
        return SS_OK;
    }
    w->h = longest;
    w->ends = e->type->ahead != NULL && !w->by_steps ? e->type->ahead(e, longest, &w->h) : -1;
    if (w->ends >= 0)
        return SS_OK;
    ss_status st = ss_engine_step(e, fmin(w->cap, longest), err);
    if (st != SS_OK)
        return st;
    if (e->h > longest) {               /* steps of an exact engine may be longer than asked for */
        e->h = longest;
        ss_walk_at(w, longest, e->q1, e->dq1);
    }
    w->h = e->h;
    return ss_engine_ends_within(e, &w->ends, &w->h, err);
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
