/* descent.c -- least squares between a record and the motion of a scene.
 *
 * Size and offset are linear and follow from the rest in closed form; the other unknowns are found
 * by least squares (Levenberg 1944, Marquardt 1963).  When a parameter moves an event across a
 * sample, the sample jumps, so the sum of squares has steps.  But an event slightly out of place
 * changes only the samples beside it: these have weight 0, and the weight of others grows with
 * their distance from the events of the motion.  The weighted sum is smooth, with one minimum and
 * the errors of a linear problem.  At first the weights reach 1 after many samples, then after
 * fewer and fewer.  In the end some two samples per event are lost, of hundreds per cycle, with
 * their information on its time. */
#include "fit/descent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "scene/model.h"
#include "fit/samples.h"

enum { PASSES = 48, TRIALS = 6 };       /* steps of a descent, and how many may fail in a row */
#define FARTHEST 0.2                    /* the longest step of an unknown */
#define MUCH 4.                         /* times the noise: such a residual needs few digits */

static size_t
unknowns(const descent *w)
{
    return w->n_moved + 2;
}

/* --- a point ------------------------------------------------------------------------------- */

ss_scene
ss_descent_scene(const descent *w, const double p[MATCH_SIZE])
{
    double frequency = w->o.frequency * exp(w->o.turn * p[MATCH_FREQUENCY]);
    ss_scene s = ss_candidate_scene(w->c, p, 1 / frequency);
    s.rate = w->r->rate;
    s.duration = (double)w->r->n / s.rate;
    s.settle = w->o.lead;
    /* the phase in the middle of the record: there it does not depend on the frequency */
    s.phase = p[MATCH_PHASE] - 2 * M_PI * frequency * (w->o.lead + s.duration / 2);
    s.x0 = w->o.x_unit * p[MATCH_X0];
    s.v0 = w->o.v_unit * p[MATCH_V0];
    return s;
}

int
ss_descent_run(descent *w, const double p[MATCH_SIZE], double *motion, double *clear)
{
    ss_scene s = ss_descent_scene(w, p);
    if (w->status == SS_OK)
        w->status = ss_stretch_at(w->progress, 1 - exp(-w->runs++ / MATCH_RUNS));
    if (w->status != SS_OK || w->c->steps > w->c->budget)
        return 0;
    ss_status st = ss_samples_run(&s, w->c->pick, SAMPLES_FINE, motion, clear, w->r->n, &w->c->steps);
    if (st == SS_ENOMEM)
        w->status = st;
    return st == SS_OK;
}

static void
weigh(descent *w, const double *clear)
{
    const rank_record *r = w->r;
    w->used = 0;
    for (size_t i = 0; i < r->n; i++) {
        int missing = r->missing != NULL && r->missing[i];
        w->weight[i] = missing ? 0 : fmin(fmax((clear[i] - 1) / w->wide, 0), 1);
        w->used += w->weight[i];
    }
}

/* Find the size and the offset of the motion with the least residual of the samples used. */
static void
regress(const descent *w, const double *motion, descent_point *at)
{
    const double *x = w->r->x;
    double mean_m = 0, mean_x = 0, mm = 0, mx = 0, squares = 0;
    for (size_t i = 0; i < w->r->n; i++) {
        mean_m += w->weight[i] * motion[i] / w->used;
        mean_x += w->weight[i] * x[i] / w->used;
    }
    for (size_t i = 0; i < w->r->n; i++) {
        double m = motion[i] - mean_m;
        mm += w->weight[i] * m * m;
        mx += w->weight[i] * m * (x[i] - mean_x);
    }
    at->size = mm > 0 ? mx / mm : 0;
    at->offset = mean_x - at->size * mean_m;
    for (size_t i = 0; i < w->r->n; i++) {
        double left = x[i] - at->size * motion[i] - at->offset;
        squares += w->weight[i] * left * left;
    }
    at->left = at->size > 0 ? squares / w->used : INFINITY;
}

void
ss_descent_compare(descent *w, const descent_course *c, descent_point *at)
{
    at->left = INFINITY;
    weigh(w, c->clear);
    if (w->used > (w->wide > 1 ? 0.5 * (double)w->r->n : 2 * (double)unknowns(w)))
        regress(w, c->motion, at);
}

int
ss_descent_begin(descent *w, const descent_point *at)
{
    w->slopes = NO_SLOPES;
    return ss_descent_run(w, at->p, w->here.motion, w->here.clear);
}

int
ss_descent_resume(descent *w, descent_point *at, const match *m)
{
    w->o = m->origin;
    memcpy(at->p, m->p, sizeof at->p);
    w->n_moved -= w->o.x_unit > 0 ? 0 : 2;
    return ss_descent_begin(w, at);
}

/* --- slopes and steps ---------------------------------------------------------------------- */

/* As small as a method of simulation resolves, but wider for the start while weights are wide, as the
 * motion can change unevenly with it. */
double
ss_descent_step(const descent *w, size_t unknown)
{
    if (w->wide > 1 && (unknown == MATCH_X0 || unknown == MATCH_V0))
        return 0.01;
    return w->c->model->linear ? 1e-6 : 1e-4;
}

int
ss_descent_slopes(descent *w, const descent_point *at)
{
    if (w->slopes == FRESH_SLOPES)
        return 1;
    for (size_t k = 0; k < w->n_moved; k++) {
        double *slope = w->slope[k], h = ss_descent_step(w, w->moved[k]);
        descent_point q = *at;
        q.p[w->moved[k]] += h;
        if (!ss_descent_run(w, q.p, slope, NULL))
            return 0;
        for (size_t i = 0; i < w->r->n; i++)
            slope[i] = (slope[i] - w->here.motion[i]) / h;
    }
    w->slopes = FRESH_SLOPES;
    return 1;
}

void
ss_descent_normal(const descent *w, const descent_point *at, normal *e)
{
    e->n = unknowns(w);
    memset(e->a, 0, sizeof e->a);
    memset(e->g, 0, sizeof e->g);
    for (size_t i = 0; i < w->r->n; i++) {
        double left = at->size * w->here.motion[i] + at->offset - w->r->x[i], row[MATCH_UNKNOWNS];
        if (w->weight[i] == 0)
            continue;
        for (size_t k = 0; k < w->n_moved; k++)
            row[k] = at->size * w->slope[k][i];
        row[w->n_moved] = at->size * w->here.motion[i];
        row[w->n_moved + 1] = 1;
        for (size_t k = 0; k < e->n; k++) {
            double s = w->weight[i] * row[k];
            e->g[k] += s * left;
            for (size_t l = 0; l <= k; l++)
                e->a[k][l] += s * row[l];
        }
    }
    for (size_t k = 0; k < e->n; k++)
        for (size_t l = 0; l < k; l++)
            e->a[l][k] = e->a[k][l];
}

/* A damped step within the ranges of the keys and not beyond FARTHEST, where slopes no longer hold.
 * (Without this limit an unknown that hardly affects the record, as a start that has died out, could
 * take any value.) */
static void
find_step(const descent *w, const descent_point *at, const normal *e, double damping,
          double step[MATCH_UNKNOWNS])
{
    double lo[MATCH_UNKNOWNS], hi[MATCH_UNKNOWNS];
    for (size_t k = 0; k < e->n; k++) {
        size_t j = k < w->n_moved ? w->moved[k] : MATCH_SIZE;
        hi[k] = k < w->n_moved ? FARTHEST : INFINITY;
        lo[k] = -hi[k];
        if (j < CANDIDATE_KEYS) {
            lo[k] = fmax(lo[k], w->c->lo[j] - at->p[j]);
            hi[k] = fmin(hi[k], w->c->hi[j] - at->p[j]);
        }
    }
    ss_normal_step(e, damping, lo, hi, step);
}

/* Take the step if it lowers the residual: 1, else 0. */
static int
try_step(descent *w, descent_point *at, const double step[MATCH_UNKNOWNS])
{
    descent_point q = *at;
    for (size_t k = 0; k < w->n_moved; k++)
        q.p[w->moved[k]] += step[k];
    q.left = INFINITY;
    if (ss_descent_run(w, q.p, w->tried.motion, w->tried.clear))
        ss_descent_compare(w, &w->tried, &q);
    if (!(q.left < at->left)) {
        weigh(w, w->here.clear);
        return 0;
    }
    const descent_course tried = w->tried;
    w->tried = w->here;
    w->here = tried;
    w->slopes = OLD_SLOPES;
    *at = q;
    return 1;
}

/* The part of the residual below which a gain does not count.  Noise moves the sum of squares by about its
 * own variance; a hundredth of this does not count. */
static double
least_gain(const descent *w, double left)
{
    double coarse = w->wide > 1 ? 1e-2 : 1e-3;
    return w->wide > 1 || left > MUCH * w->r->noise ? coarse : 1e-2 / (double)w->r->n;
}

/* Move *at, the present point, to the least residual with the present weights. */
static void
descend(descent *w, descent_point *at)
{
    double damping = 1e-3;
    int failed = 0;
    ss_descent_compare(w, &w->here, at);
    for (int pass = 0; pass < PASSES && failed < TRIALS && isfinite(at->left); pass++) {
        double step[MATCH_UNKNOWNS], before = at->left, least = least_gain(w, before);
        normal e;
        if (w->slopes == NO_SLOPES && !ss_descent_slopes(w, at))
            return;
        int old = w->slopes == OLD_SLOPES;
        ss_descent_normal(w, at, &e);
        find_step(w, at, &e, damping, step);
        double gain = ss_normal_gain(&e, step);
        int goes_on = gain > least * before * w->used;
        if (!goes_on && !old)
            return;
        int gained = goes_on && try_step(w, at, step);
        if (!(gained && (before - at->left) * w->used > gain / 2) && old)
            w->slopes = NO_SLOPES;
        if (gained)
            damping *= 0.1, failed = 0;
        else if (!old)
            damping *= 10, failed++;
        if (gained && !old && !(at->left < before * (1 - least)))
            return;
    }
}

/* Descend with narrower and narrower weights.  With the last ones the slopes by the start are no longer
 * coarse, so they are found again. */
void
ss_descent_minimise(descent *w, descent_point *at)
{
    static const double wide[] = { SAMPLES_REACH - 1, 4, 1 };
    for (size_t i = 0; i < sizeof wide / sizeof *wide; i++) {
        w->wide = wide[i];
        if (w->wide <= 1 && w->moved[w->n_moved - 1] == MATCH_V0)
            w->slopes = NO_SLOPES;
        descend(w, at);
    }
}

double *
ss_descent_prepare(descent *w)
{
    size_t n = w->r->n;
    for (size_t j = 0; j < MATCH_SIZE; j++)
        if (j >= CANDIDATE_KEYS || (j < w->c->n && w->c->hi[j] > w->c->lo[j]))
            w->moved[w->n_moved++] = j;
    double *room = malloc((n + 1) * (w->n_moved + 5) * sizeof *room);
    if (room == NULL)
        return NULL;
    w->here = (descent_course){ room, room + n };
    w->tried = (descent_course){ room + 2 * n, room + 3 * n };
    w->weight = room + 4 * n;
    for (size_t k = 0; k < w->n_moved; k++)
        w->slope[k] = room + (k + 5) * n;
    return room;
}
