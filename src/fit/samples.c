/* samples.c -- samples of a scene's motion, with the accuracy and cost that a comparison needs.
 *
 * The method is the closed form if there is one, else rkck.  At a tolerance of 1e-7 its error is
 * 3e-6 of the largest acceleration, at a twentieth of the cost of the default.
 *
 * The motion of a model without events is smooth, and the Jacobian gives its second derivative.
 * So the state inside a step is the polynomial of degree 5 that has the state and two derivatives
 * at both ends.  Its error is of the sixth order in the step, as that of the method.  (ss_sim_run,
 * which promises more digits, repeats the step for each sample; here this was more than half of
 * the cost.) */
#include "fit/samples.h"

#include <math.h>
#include <stickslip/sim.h>
#include "motion/walk.h"
#include "scene/model.h"

enum { STEPS_MOST = 1000000 };          /* of one run */

typedef struct sampled {
    int pick;
    size_t n, room;
    double *value, *clear, rate;
} sampled;

static int
append_samples(const ss_sample *s, size_t n, void *user)
{
    sampled *t = user;
    const ss_sim_columns picked = { 0, 1, { t->pick } };
    for (size_t i = 0; i < n && t->n < t->room; i++)
        ss_sim_row(&picked, &s[i], &t->value[t->n++]);
    return 0;
}

static int
clear_event(const ss_event *e, void *user)
{
    sampled *t = user;
    double at = e->t * t->rate, first = fmax(ceil(at - SAMPLES_REACH), 0);
    for (double i = first; i < (double)t->room && i <= at + SAMPLES_REACH; i++)
        t->clear[(size_t)i] = fmin(t->clear[(size_t)i], fabs(i - at));
    return 0;
}

static ss_status
run_events(sampled *t, const ss_scene *scene, const ss_sim_opts *opts, double *steps)
{
    ss_sim_opts o = *opts;
    ss_sim_stats stats = { .steps = 0 };
    o.samples = append_samples;
    o.events = t->clear != NULL ? clear_event : NULL;
    o.user = t;
    ss_status st = ss_sim_run(scene, &o, &stats, NULL);
    *steps += st == SS_EBUDGET ? STEPS_MOST : (double)stats.steps;
    return st;
}

/* --- smooth motions ------------------------------------------------------------------------ */

/* The rate of change of dqdt along the motion. */
static void
bend(const state *m, double u, const double q[], const double dqdt[], double bends[])
{
    size_t n = m->model->dim;
    double dfdq[MAX_DIM * MAX_DIM];
    m->model->jacobian(m, u, q, dfdq, bends);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            bends[i] += dfdq[i * n + k] * dqdt[k];
}

/* Coefficients in s / h of the polynomial of the step just taken. */
static void
draw_curve(const walk *w, double c[6][MAX_DIM])
{
    const state *m = &w->m.now;
    const engine *e = w->e;
    double h = w->h, first[MAX_DIM], last[MAX_DIM];
    bend(m, m->u, m->q, e->dq0, first);
    bend(m, m->u + h, e->q1, e->dq1, last);
    for (size_t i = 0; i < m->model->dim; i++) {
        double a = m->q[i], b = h * e->dq0[i], d = h * h / 2 * first[i];
        double value = e->q1[i] - a - b - d, slope = h * e->dq1[i] - b - 2 * d;
        double half_bend = h * h / 2 * last[i] - d;
        c[0][i] = a;
        c[1][i] = b;
        c[2][i] = d;
        c[3][i] = 10 * value - 4 * slope + half_bend;
        c[4][i] = -15 * value + 7 * slope - 2 * half_bend;
        c[5][i] = 6 * value - 3 * slope + half_bend;
    }
}

static void
append_smooth(sampled *t, const walk *w, double c[6][MAX_DIM], double s)
{
    const state *m = &w->m.now;
    double x = s / w->h, q[MAX_DIM] = { 0 }, rates[MAX_DIM], drive = base_force(m, m->u + s);
    ss_sample sample = { .t = 0 };
    for (int k = 5; k >= 0; k--)
        for (size_t i = 0; i < m->model->dim; i++)
            q[i] = q[i] * x + c[k][i];
    m->model->rates(m, drive, q, rates);
    m->model->sample(m, drive, q, rates, &sample);
    append_samples(&sample, 1, t);
}

/* Advance the motion by so many seconds, and append its samples to t, unless t is NULL. */
static ss_status
advance(walk *w, double seconds, sampled *t)
{
    const state *m = &w->m.now;
    const instant since = instant_add(w->m.origin, m->u);
    const double none = 1e-12 / m->scene->base_frequency;
    double c[6][MAX_DIM], left = seconds;
    while (left > none) {
        ss_event event;
        int is_event;
        double longest = m->model->sight != NULL ? fmin(left, m->model->sight(m, w->e->dq0)) : left;
        ss_status st = ss_walk_leg(w, longest, NULL);
        if (st != SS_OK)
            return st;
        double done = seconds - left, end = left - w->h <= none ? INFINITY : done + w->h;
        if (t != NULL && t->n < t->room && (double)t->n / t->rate < end)
            draw_curve(w, c);
        while (t != NULL && t->n < t->room && (double)t->n / t->rate < end)
            append_smooth(t, w, c, (double)t->n / t->rate - done);
        st = ss_walk_on(w, &is_event, &event, NULL);
        if (st != SS_OK)
            return st;
        left = seconds - instant_diff(w->m.origin, since) - m->u;
    }
    return SS_OK;
}

static ss_status
run_smooth(sampled *t, const ss_scene *scene, const ss_sim_opts *opts, double *steps)
{
    walk w;
    ss_status st = ss_scene_check(scene, NULL);
    if (st != SS_OK)
        return st;
    st = ss_walk_begin(&w, scene, opts, NULL);
    if (st == SS_OK)
        st = advance(&w, scene->settle, NULL);
    if (st == SS_OK)
        st = advance(&w, scene->duration, t);
    *steps += w.e != NULL ? (double)w.e->steps : 0;
    ss_walk_end(&w);
    return st;
}

ss_status
ss_samples_run(const ss_scene *scene, int pick, double tol, double *value, double *clear,
               size_t n, double *steps)
{
    const struct model *model = ss_model_of(scene);
    sampled t = { pick, 0, n, value, clear, scene->rate };
    const ss_sim_opts opts = { .method = model->linear ? EXACT : "rkck", .tol = tol,
                               .max_steps = STEPS_MOST };
    for (size_t i = 0; clear != NULL && i < n; i++)
        clear[i] = INFINITY;
    ss_status st = (model->guard == NULL && model->jacobian != NULL ? run_smooth : run_events)
        (&t, scene, &opts, steps);
    *steps += (double)t.n / SAMPLES_A_STEP;
    return st == SS_OK && t.n != n ? SS_EDATA : st;
}
