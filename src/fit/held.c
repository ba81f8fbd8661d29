/* held.c -- the terms that a match holds: would the record have them otherwise?
 *
 * Near the least residual the sum of squares is quadratic.  So the slope of the motion by one term more
 * tells by how much the sum would fall if the match adjusted this term, too, and how far the term would
 * go: without another descent. */
#include "fit/held.h"

#include <math.h>
#include <stdlib.h>
#include "fit/descent.h"

/* How much a step of all unknowns would lessen the sum of squares. */
static double
find_gain(const descent *w, const descent_point *at, double step[MATCH_UNKNOWNS])
{
    normal e;
    ss_descent_normal(w, at, &e);
    ss_normal_step(&e, 0, NULL, NULL, step);
    return ss_normal_gain(&e, step);
}

/* How much more if the term of this slope is an unknown, too, and the step of the term. */
static double
find_more(descent *w, const descent_point *at, double *slope, double *step_of_term)
{
    double step[MATCH_UNKNOWNS], without = find_gain(w, at, step);
    w->slope[w->n_moved++] = slope;
    double gain = find_gain(w, at, step) - without;
    *step_of_term = step[--w->n_moved];
    return gain;
}

static double
change_term(ss_scene *s, held_term term, double by)
{
    if (term == HELD_DAMPING)
        return s->damping += by * sqrt(s->stiffness * s->mass);
    s->static_friction = fmax(s->static_friction, s->friction) + by * s->friction;
    return s->static_friction / s->friction;
}

/* The gain by a term of the scene, w->c's. */
static double
gain_by_scene(descent *w, const descent_point *at, held_term term, double *nearer)
{
    const ss_scene own = w->c->scene;
    ss_scene changed = own;
    double *slope = w->tried.motion, h = ss_descent_step(w, 0), step;
    change_term(&w->c->scene, term, h);
    int runs = ss_descent_run(w, at->p, slope, NULL);
    w->c->scene = own;
    if (!runs)
        return 0;
    for (size_t i = 0; i < w->r->n; i++)
        slope[i] = (slope[i] - w->here.motion[i]) / h;
    double gain = find_more(w, at, slope, &step);
    *nearer = change_term(&changed, term, step);
    return gain;
}

/* What a lag of so many samples changes in the motion, which is straight between samples. */
static void
lag_behind(const descent *w, double samples, double *change)
{
    const double *x = w->here.motion, keep = exp(-1 / samples), part = samples * (1 - keep);
    double y = x[0];
    change[0] = 0;
    for (size_t i = 1; i < w->r->n; i++) {
        y = keep * y + (1 - part) * x[i] + (part - keep) * x[i - 1];
        change[i] = y - x[i];
    }
}

/* The gain by a lag of the sensor.  Longer lags leave more than noise. */
static double
gain_by_lag(descent *w, const descent_point *at)
{
    double most = 0, unused;
    for (double samples = 0.125; samples <= 8; samples *= 2) {
        lag_behind(w, samples, w->tried.motion);
        most = fmax(most, find_more(w, at, w->tried.motion, &unused));
    }
    return most;
}

ss_status
ss_held_gains(held of[HELD_TERMS], const candidate *c, const match *m, const rank_record *record)
{
    const ss_stretch silent = { { NULL, NULL }, 0, 1 };
    candidate own = *c;
    descent w = { .c = &own, .r = record, .progress = &silent, .wide = 1 };
    descent_point at = { .left = INFINITY };
    double *room = ss_descent_prepare(&w);
    if (room == NULL)
        return SS_ENOMEM;
    for (held_term term = 0; term < HELD_TERMS; term++)
        of[term] = (held){ 0, NAN };
    if (ss_descent_resume(&w, &at, m) && ss_descent_slopes(&w, &at)) {
        ss_descent_compare(&w, &w.here, &at);
        double unit = fmax(at.left, MATCH_QUIET * m->power);
        for (held_term term = 0; term < HELD_LAG; term++)
            of[term].gain = gain_by_scene(&w, &at, term, &of[term].nearer) / unit;
        of[HELD_LAG].gain = gain_by_lag(&w, &at) / unit;
    }
    free(room);
    return w.status;
}
