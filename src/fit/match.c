/* match.c -- fit a scene to a record, sample by sample.
 *
 * The mean cycle finds the right motion (candidate.c).  But a record is seldom completely settled,
 * and the rest of the transient would shift the parameters or look like an error of the model.  So
 * the motion is fitted to the record itself (descent.c), with its own start: position and velocity
 * within a slip, half a cycle or more before the record.  These two are the whole state there, or
 * the rest of the state has decayed when the record begins.
 *
 * A fit that explains a record leaves white noise.  Half the mean square difference of the
 * residual over any lag is the variance of that noise if it is white, and less at some lag if it
 * is not. */
#include "fit/match.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/sim.h>
#include "scene/model.h"
#include "fit/descent.h"
#include "fit/samples.h"

enum { LAGS = 32 };
enum { LOOKED_AT = 128 };               /* samples of half a cycle, to find the fastest slip */
#define UNLIKELY 0.1                    /* part of the power: if more is left, no descent or start helps */

/* A residual is noise if its mean square is at most ALLOWED times the noise, plus three standard errors
 * of the estimate of the noise, which is some 2.3 / sqrt n: it rests on medians of n numbers, two of
 * which may share a sample. */
#define ALLOWED 1.2
#define UNCERTAIN (3 * 2.3)

/* --- the start of the motion --------------------------------------------------------------- */

static int
find_fastest(const ss_sample *s, size_t n, void *user)
{
    ss_sample *fastest = user;
    for (size_t i = 0; i < n; i++)
        if (s[i].mode != 0 && fabs(s[i].v) > fabs(fastest->v))
            *fastest = s[i];
    return 0;
}

/* The settled scene from the first sample of the record on. */
static ss_scene
settled(const descent *w, const candidate_start *start, double period)
{
    ss_scene s = ss_candidate_scene(w->c, start->key, period);
    s.phase = 2 * M_PI * (w->r->from / period - start->shift);
    s.rate = w->r->rate;
    s.duration = (double)w->r->n / s.rate;
    return ss_candidate_resized(w->c, s, start->size > 0 ? start->size : 1);
}

/* Start from rest, CANDIDATE_SETTLE cycles before the record, as the search did. */
static void
begin_at_rest(descent *w, const candidate_start *start, double period, descent_point *at)
{
    double cycles = (double)w->r->n / w->r->rate / period;
    w->o = (match_origin){ .frequency = 1 / period, .lead = CANDIDATE_SETTLE * period,
                           .turn = 1 / (2 * M_PI * fmax(cycles, 1)) };
    memcpy(at->p, start->key, sizeof start->key);
    at->p[MATCH_PHASE] = 2 * M_PI * (w->r->from / period - start->shift + cycles / 2);
}

/* Does the record depend on the start?  A change by less than MATCH_QUIET of the power for a whole
 * unit of the start does not count. */
static int
remembers(descent *w, const descent_point *at, double power)
{
    double squares = 0, h = 0.01;
    descent_point q = *at;
    q.p[MATCH_X0] += h;
    if (!ss_descent_run(w, q.p, w->tried.motion, w->tried.clear))
        return 0;
    for (size_t i = 0; i < w->r->n; i++) {
        double d = at->size * (w->tried.motion[i] - w->here.motion[i]) / h;
        squares += d * d / (double)w->r->n;
    }
    return squares > MATCH_QUIET * power;
}

/* Free the start of the motion, `cycles` cycles before the record or up to half a cycle later: it
 * is moved to the fastest slip if x and v are the whole state there.  0 if the motion does not
 * slip, or if the record does not depend on the start. */
static int
free_start(descent *w, double cycles, descent_point *at, double power)
{
    ss_sample fastest = { .v = 0 };
    ss_scene s = ss_descent_scene(w, at->p);
    double period = 1 / s.base_frequency;
    ss_sim_opts opts = ss_samples_opts(&s, SAMPLES_FINE);
    opts.samples = find_fastest;
    opts.user = &fastest;
    if (w->c->model->dim > 2) {         /* from rest, once */
        int is_free = w->o.x_unit > 0;
        w->o.x_unit = s.base_amplitude;
        w->o.v_unit = 2 * M_PI * s.base_frequency * s.base_amplitude;
        return !is_free && remembers(w, at, power);
    }
    s.settle = w->o.lead - cycles * period;
    s.duration = period / 2;
    s.rate = 2 * LOOKED_AT / period;
    ss_status st = s.settle >= 0 ? ss_sim_run(&s, &opts, NULL, NULL) : SS_EINVAL;
    if (st == SS_ENOMEM)
        w->status = st;
    if (st != SS_OK || fastest.mode == 0)
        return 0;
    w->o.lead = cycles * period - fastest.t;
    w->o.x_unit = fmax(fabs(fastest.x), s.base_amplitude);
    w->o.v_unit = fabs(fastest.v);
    at->p[MATCH_X0] = fastest.x / w->o.x_unit;
    at->p[MATCH_V0] = fastest.v / w->o.v_unit;
    return ss_descent_begin(w, at);
}

/* --- the answer ---------------------------------------------------------------------------- */

/* The least of half the mean square differences over a lag: see the head of this file. */
static double
whiteness(const descent *w, const double *left)
{
    double least = INFINITY;
    for (size_t lag = 1; lag <= LAGS && lag < w->r->n / 4; lag++) {
        double squares = 0, count = 0;
        for (size_t i = lag; i < w->r->n; i++)
            if (w->weight[i] == 1 && w->weight[i - lag] == 1) {
                double d = left[i] - left[i - lag];
                squares += d * d;
                count++;
            }
        if (count > 0)
            least = fmin(least, squares / count / 2);
    }
    return least;
}

static void
find_covariance(const descent *w, const normal *e, match *m)
{
    double inverse[NORMAL_MOST][NORMAL_MOST], unit[MATCH_UNKNOWNS] = { 0 };
    size_t name[MATCH_UNKNOWNS] = { 0 };
    ss_normal_invert(e, inverse);
    for (size_t k = 0; k < e->n; k++) {
        name[k] = k < w->n_moved ? w->moved[k] : MATCH_SIZE + k - w->n_moved;
        unit[k] = name[k] == MATCH_FREQUENCY ? w->o.turn : 1;
    }
    memset(m->covariance, 0, sizeof m->covariance);
    for (size_t k = 0; k < e->n; k++)
        for (size_t i = 0; i < e->n; i++)
            m->covariance[name[i]][name[k]] = unit[i] * unit[k] * inverse[k][i];
}

static void
report(descent *w, const descent_point *at, match *m)
{
    normal e;
    const rank_record *r = w->r;
    double all = 0, *left = w->tried.motion;
    if (!isfinite(at->left) || !ss_descent_slopes(w, at))
        return;
    ss_descent_normal(w, at, &e);
    find_covariance(w, &e, m);
    m->left_all = 0;
    for (size_t i = 0; i < r->n; i++) {
        left[i] = r->x[i] - at->size * w->here.motion[i] - at->offset;
        if (r->missing == NULL || !r->missing[i])
            m->left_all += left[i] * left[i], all++;
    }
    m->left_all /= all;
    m->left = at->left * w->used / (w->used - (double)e.n);
    m->white = fmax(whiteness(w, left), r->steps);      /* steps are not white where they are coarse */
    m->compared = (size_t)w->used;
    m->scene = ss_candidate_resized(w->c, ss_descent_scene(w, at->p), at->size);
    memcpy(m->p, at->p, sizeof m->p);
    m->origin = w->o;
}

/* Do two sets of keys differ by no more than MATCH_DECISIVE of their errors in a match? */
static int
are_same(const match *m, const double a[], const double b[])
{
    for (size_t i = 0; i < CANDIDATE_KEYS; i++) {
        double d = a[i] - b[i];
        if (d * d > MATCH_DECISIVE * m->left * m->covariance[i][i] + 1e-12)
            return 0;
    }
    return 1;
}

/* Copy the one of others that has the same settled motion; 0: there is none. */
static int
copy_same(match *m, const match *others, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (are_same(m, m->settled, others[i].settled)) {
            *m = others[i];
            return 1;
        }
    return 0;
}

/* Fit the settled motion first, then motions from any start if they leave less.  The record hardly
 * depends on a start three cycles before it, so that the residual changes slowly with that start.
 * For a start one cycle before it, descents end too early unless they begin near the solution. */
static void
solve(descent *w, descent_point *at, double misfit, const match *others, size_t n_others, match *m)
{
    static const double cycles[] = { 3, 1 };
    w->n_moved -= 2;
    w->wide = 1;
    if (!ss_descent_begin(w, at))
        return;
    if (misfit < UNLIKELY * m->power)
        ss_descent_minimise(w, at);
    else
        ss_descent_compare(w, &w->here, at);
    report(w, at, m);
    memcpy(m->settled, m->p, sizeof m->settled);
    if (copy_same(m, others, n_others))
        return;
    w->n_moved += 2;
    w->slopes = NO_SLOPES;              /* those by the start are not known yet */
    for (size_t i = 0; i < 2 && m->compared > 0 && m->left <= UNLIKELY * m->power; i++) {
        double before = m->left;
        if (!free_start(w, cycles[i], at, m->power))
            return;
        ss_descent_minimise(w, at);
        if (at->left < m->left)
            report(w, at, m);
        if (m->left == before)
            return;
    }
}

/* A match that explains nothing: the residual is the record. */
static match
no_match(const rank_record *record)
{
    match m = { .power = ss_record_power(record) };
    m.left = m.left_all = m.power;
    for (size_t i = 0; i < MATCH_UNKNOWNS; i++)
        for (size_t k = 0; k < MATCH_UNKNOWNS; k++)
            m.covariance[i][k] = NAN;
    return m;
}

ss_status
ss_match_find(match *m, candidate *c, const candidate_start *start, double period,
              const rank_record *record, const match *others, size_t n_others, const ss_stretch *progress)
{
    descent w = { .c = c, .r = record, .progress = progress };
    descent_point at = { .left = INFINITY };
    double *room = ss_descent_prepare(&w);
    if (room == NULL)
        return SS_ENOMEM;
    *m = no_match(record);
    m->scene = settled(&w, start, period);
    memcpy(m->p, start->key, sizeof start->key);
    begin_at_rest(&w, start, period, &at);
    if (start->size > 0)
        solve(&w, &at, start->misfit, others, n_others, m);
    free(room);
    return w.status;
}

ss_status
ss_match_other(match *m, candidate *c, const match *from, const rank_record *record,
               const ss_stretch *progress)
{
    descent w = { .c = c, .r = record, .progress = progress };
    descent_point at = { .left = INFINITY };
    double *room = ss_descent_prepare(&w);
    if (room == NULL)
        return SS_ENOMEM;
    *m = no_match(record);
    m->scene = from->scene;
    memcpy(m->p, from->p, sizeof m->p);
    if (ss_descent_resume(&w, &at, from)) {
        ss_descent_minimise(&w, &at);
        report(&w, &at, m);
    }
    free(room);
    return w.status;
}

double
ss_match_excess(const match *m, double noise)
{
    return m->left / fmax(fmin(noise, m->white), MATCH_QUIET * m->power);
}

int
ss_match_same(const match *a, const match *b)
{
    return are_same(a, a->p, b->p);
}

int
ss_match_explains(const match *m, double noise)
{
    return m->compared > 0 && ss_match_excess(m, noise)
                              <= ALLOWED * (1 + UNCERTAIN / sqrt((double)m->compared));
}
