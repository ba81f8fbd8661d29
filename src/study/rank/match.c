/* match.c -- fit a scene to a record, sample by sample.
 *
 * The mean cycle finds the right motion (candidate.c).  But a record is seldom completely settled,
 * and the rest of the transient would shift the parameters or look like an error of the model.  So
 * the motion is fitted to the record itself, with its own start: position and velocity within a
 * slip, half a cycle or more before the record.  These two are the whole state there, or the rest
 * of the state has decayed when the record begins.
 *
 * Size and offset are linear and follow from the rest in closed form; the other unknowns are found
 * by least squares (Levenberg 1944, Marquardt 1963).  When a parameter moves an event across a
 * sample, the sample jumps, so the sum of squares has steps.  But an event slightly out of place
 * changes only the samples beside it: these have weight 0, and the weight of others grows with
 * their distance from the events of the motion.  The weighted sum is smooth, with one minimum and
 * the errors of a linear problem.  At first the weights reach 1 after many samples, then after
 * fewer and fewer.  In the end some two samples per event are lost, of hundreds per cycle, with
 * their information on its time.
 *
 * A fit that explains a record leaves white noise.  Half the mean square difference of the
 * residual over any lag is the variance of that noise if it is white, and less at some lag if it
 * is not. */
#include "study/rank/match.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/sim.h>
#include "scene/model.h"
#include "study/rank/normal.h"
#include "study/rank/samples.h"

enum { PASSES = 48, TRIALS = 6 };       /* steps of a descent, and how many may fail in a row */
enum { LAGS = 32 };
enum { LOOKED_AT = 128 };               /* samples of half a cycle, to find the fastest slip */
enum { UNKNOWNS = MATCH_UNKNOWNS, MOVED = MATCH_SIZE };     /* MOVED: those that move the motion */
#define FARTHEST 0.2                    /* the longest step of an unknown */
#define UNLIKELY 0.1                    /* part of the power: no descent or start mends more than it */
#define MUCH 4.                         /* times the noise: no digits are needed of it */

/* A residual is noise if its mean square is at most ALLOWED times the noise, plus three standard errors
 * of the estimate of the noise, which is some 2.3 / sqrt n: it rests on medians of n numbers, two of
 * which may share a sample. */
#define ALLOWED 1.2
#define UNCERTAIN (3 * 2.3)

typedef struct point {
    double p[MOVED];                    /* see scene_at */
    double size, offset;
    double left;                        /* mean square over the samples used; infinite: no motion */
} point;

/* The samples of a motion, and the distance of each from an event: see ss_samples_run. */
typedef struct course {
    double *motion, *clear;
} course;

/* Slopes are kept as long as steps by them gain as much as they predict: a step by old slopes costs one
 * run of the motion, and new slopes cost one run for each unknown. */
enum { NO_SLOPES, OLD_SLOPES, FRESH_SLOPES };

typedef struct matching {
    candidate *c;
    const rank_record *r;
    const ss_stretch *progress;
    double runs;                        /* of the motion so far */
    ss_status status;                   /* SS_ENOMEM or SS_STOP */
    match_origin o;
    size_t n_moved, moved[MOVED];       /* the unknowns that are adjusted */
    double wide;                        /* weights grow from 0 to 1 over so many samples */
    course here, tried;                 /* of the present point, and of one that was tried from it */
    double *slope[MOVED];               /* of the motion, by each of moved */
    int slopes;                         /* NO_SLOPES, OLD_SLOPES or FRESH_SLOPES */
    double *weight;                     /* of each sample, by the course compared last */
    double used;                        /* sum of the weights */
} matching;

static size_t
unknowns(const matching *w)
{
    return w->n_moved + 2;
}

/* --- a point ------------------------------------------------------------------------------- */

static ss_scene
scene_at(const matching *w, const double p[MOVED])
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

/* Run the motion at p; 0 if there is none. */
static int
run(matching *w, const double p[MOVED], double *motion, double *clear)
{
    ss_scene s = scene_at(w, p);
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
weigh(matching *w, const double *clear)
{
    const rank_record *r = w->r;
    w->used = 0;
    for (size_t i = 0; i < r->n; i++) {
        int missing = r->missing != NULL && r->missing[i];
        w->weight[i] = missing ? 0 : fmin(fmax((clear[i] - 1) / w->wide, 0), 1);
        w->used += w->weight[i];
    }
}

/* Size and offset of the motion that minimise the residual of the samples used, and that residual. */
static void
regress(const matching *w, const double *motion, point *at)
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

static void
compare(matching *w, const course *c, point *at)
{
    at->left = INFINITY;
    weigh(w, c->clear);
    if (w->used > (w->wide > 1 ? 0.5 * (double)w->r->n : 2 * (double)unknowns(w)))
        regress(w, c->motion, at);
}

/* Begin at a point; 0 if it has no motion. */
static int
stand_at(matching *w, const point *at)
{
    w->slopes = NO_SLOPES;
    return run(w, at->p, w->here.motion, w->here.clear);
}

/* --- least squares ------------------------------------------------------------------------- */

/* The step of an unknown for the differences that give slopes: as small as a method of simulation
 * resolves, but wider for the start while weights are wide, as the motion can change unevenly with
 * it. */
static double
step_of(const matching *w, size_t j)
{
    if (w->wide > 1 && (j == MATCH_X0 || j == MATCH_V0))
        return 0.01;
    return w->c->model->linear ? 1e-6 : 1e-4;
}

/* 0 if a motion cannot be run. */
static int
find_slopes(matching *w, const point *at)
{
    for (size_t k = 0; k < w->n_moved; k++) {
        double *slope = w->slope[k], h = step_of(w, w->moved[k]);
        point q = *at;
        q.p[w->moved[k]] += h;
        if (!run(w, q.p, slope, NULL))
            return 0;
        for (size_t i = 0; i < w->r->n; i++)
            slope[i] = (slope[i] - w->here.motion[i]) / h;
    }
    w->slopes = FRESH_SLOPES;
    return 1;
}

static void
find_normal(const matching *w, const point *at, normal *e)
{
    e->n = unknowns(w);
    memset(e->a, 0, sizeof e->a);
    memset(e->g, 0, sizeof e->g);
    for (size_t i = 0; i < w->r->n; i++) {
        double left = at->size * w->here.motion[i] + at->offset - w->r->x[i], row[UNKNOWNS];
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
find_step(const matching *w, const point *at, const normal *e, double damping, double step[UNKNOWNS])
{
    double lo[UNKNOWNS], hi[UNKNOWNS];
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
try_step(matching *w, point *at, const double step[UNKNOWNS])
{
    point q = *at;
    for (size_t k = 0; k < w->n_moved; k++)
        q.p[w->moved[k]] += step[k];
    q.left = INFINITY;
    if (run(w, q.p, w->tried.motion, w->tried.clear))
        compare(w, &w->tried, &q);
    if (!(q.left < at->left)) {
        weigh(w, w->here.clear);
        return 0;
    }
    const course tried = w->tried;
    w->tried = w->here;
    w->here = tried;
    w->slopes = OLD_SLOPES;
    *at = q;
    return 1;
}

/* The part of the residual below which a gain is none.  Noise moves the sum of squares by once its
 * variance: a hundredth of that is nothing. */
static double
least_gain(const matching *w, double left)
{
    double coarse = w->wide > 1 ? 1e-2 : 1e-3;
    return w->wide > 1 || left > MUCH * w->r->noise ? coarse : 1e-2 / (double)w->r->n;
}

/* Move *at, the present point of w, to the least residual. */
static void
descend(matching *w, point *at)
{
    double damping = 1e-3;
    int failed = 0;
    compare(w, &w->here, at);
    for (int pass = 0; pass < PASSES && failed < TRIALS && isfinite(at->left); pass++) {
        double step[UNKNOWNS], before = at->left, least = least_gain(w, before);
        normal e;
        if (w->slopes == NO_SLOPES && !find_slopes(w, at))
            return;
        int old = w->slopes == OLD_SLOPES;
        find_normal(w, at, &e);
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
settled(const matching *w, const candidate_start *start, double period)
{
    ss_scene s = ss_candidate_scene(w->c, start->key, period);
    s.phase = 2 * M_PI * (w->r->from / period - start->shift);
    s.rate = w->r->rate;
    s.duration = (double)w->r->n / s.rate;
    return ss_candidate_resized(w->c, s, start->size > 0 ? start->size : 1);
}

/* Start from rest, CANDIDATE_SETTLE cycles before the record, as the search did. */
static void
begin_at_rest(matching *w, const candidate_start *start, double period, point *at)
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
remembers(matching *w, const point *at, double power)
{
    double squares = 0, h = 0.01;
    point q = *at;
    q.p[MATCH_X0] += h;
    if (!run(w, q.p, w->tried.motion, w->tried.clear))
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
free_start(matching *w, double cycles, point *at, double power)
{
    ss_sample fastest = { .v = 0 };
    ss_scene s = scene_at(w, at->p);
    double period = 1 / s.base_frequency;
    ss_sim_opts opts = { .method = w->c->model->linear ? "exact" : "rkck", .tol = 1e-7,
                         .max_steps = 1000000, .samples = find_fastest, .user = &fastest };
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
    return stand_at(w, at);
}

/* --- the answer ---------------------------------------------------------------------------- */

/* The least of half the mean square differences over a lag: see the head of this file. */
static double
whiteness(const matching *w, const double *left)
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
find_covariance(const matching *w, const normal *e, match *m)
{
    double inverse[NORMAL_MOST][NORMAL_MOST], unit[UNKNOWNS] = { 0 };
    size_t name[UNKNOWNS] = { 0 };
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
report(matching *w, const point *at, match *m)
{
    normal e;
    const rank_record *r = w->r;
    double all = 0, *left = w->tried.motion;
    if (!isfinite(at->left) || (w->slopes != FRESH_SLOPES && !find_slopes(w, at)))
        return;
    find_normal(w, at, &e);
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
    m->scene = ss_candidate_resized(w->c, scene_at(w, at->p), at->size);
    memcpy(m->p, at->p, sizeof m->p);
    m->origin = w->o;
}

/* Descend with narrower and narrower weights; the slopes of the start are coarse until the last. */
static void
descend_all(matching *w, point *at)
{
    static const double wide[] = { SAMPLES_REACH - 1, 4, 1 };
    for (size_t i = 0; i < sizeof wide / sizeof *wide; i++) {
        w->wide = wide[i];
        if (w->wide <= 1 && w->moved[w->n_moved - 1] == MATCH_V0)
            w->slopes = NO_SLOPES;
        descend(w, at);
    }
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

/* Take over the one of others whose settled motion is that of m; 0 if there is none. */
static int
take_over(match *m, const match *others, size_t n)
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
solve(matching *w, point *at, double misfit, const match *others, size_t n_others, match *m)
{
    static const double cycles[] = { 3, 1 };
    w->n_moved -= 2;
    w->wide = 1;
    if (!stand_at(w, at))
        return;
    if (misfit < UNLIKELY * m->power)
        descend_all(w, at);
    else
        compare(w, &w->here, at);
    report(w, at, m);
    memcpy(m->settled, m->p, sizeof m->settled);
    if (take_over(m, others, n_others))
        return;
    w->n_moved += 2;
    for (size_t i = 0; i < 2 && m->compared > 0 && m->left <= UNLIKELY * m->power; i++) {
        double before = m->left;
        if (!free_start(w, cycles[i], at, m->power))
            return;
        descend_all(w, at);
        if (at->left < m->left)
            report(w, at, m);
        if (m->left == before)
            return;
    }
}

/* Allocate all arrays; NULL: no memory. */
static double *
prepare(matching *w)
{
    size_t n = w->r->n;
    for (size_t j = 0; j < MOVED; j++)
        if (j >= CANDIDATE_KEYS || (j < w->c->n && w->c->hi[j] > w->c->lo[j]))
            w->moved[w->n_moved++] = j;
    double *room = malloc((n + 1) * (w->n_moved + 5) * sizeof *room);
    if (room == NULL)
        return NULL;
    w->here = (course){ room, room + n };
    w->tried = (course){ room + 2 * n, room + 3 * n };
    w->weight = room + 4 * n;
    for (size_t k = 0; k < w->n_moved; k++)
        w->slope[k] = room + (k + 5) * n;
    return room;
}

/* A match that explains nothing: the residual is the record. */
static match
no_match(const rank_record *record)
{
    match m = { .power = ss_record_power(record) };
    m.left = m.left_all = m.power;
    for (size_t i = 0; i < UNKNOWNS; i++)
        for (size_t k = 0; k < UNKNOWNS; k++)
            m.covariance[i][k] = NAN;
    return m;
}

ss_status
ss_match_find(match *m, candidate *c, const candidate_start *start, double period,
              const rank_record *record, const match *others, size_t n_others, const ss_stretch *progress)
{
    matching w = { .c = c, .r = record, .progress = progress };
    point at = { .left = INFINITY };
    double *room = prepare(&w);
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

/* Go to where a match ended, with a free start if it had one; 0 if there is no motion. */
static int
resume(matching *w, point *at, const match *m)
{
    w->o = m->origin;
    memcpy(at->p, m->p, sizeof at->p);
    w->n_moved -= w->o.x_unit > 0 ? 0 : 2;
    return stand_at(w, at);
}

ss_status
ss_match_other(match *m, candidate *c, const match *from, const rank_record *record,
               const ss_stretch *progress)
{
    matching w = { .c = c, .r = record, .progress = progress };
    point at = { .left = INFINITY };
    double *room = prepare(&w);
    if (room == NULL)
        return SS_ENOMEM;
    *m = no_match(record);
    m->scene = from->scene;
    memcpy(m->p, from->p, sizeof m->p);
    if (resume(&w, &at, from)) {
        descend_all(&w, &at);
        report(&w, &at, m);
    }
    free(room);
    return w.status;
}

/* How much a step of all unknowns would lessen the sum of squares. */
static double
find_gain(const matching *w, const point *at, double step[UNKNOWNS])
{
    normal e;
    find_normal(w, at, &e);
    ss_normal_step(&e, 0, NULL, NULL, step);
    return ss_normal_gain(&e, step);
}

/* The term is found from its slope, which is the last. */
static double
find_held(matching *w, const point *at, double *slope, double *step_of_term)
{
    double step[UNKNOWNS], held = find_gain(w, at, step);
    w->slope[w->n_moved++] = slope;
    double gain = find_gain(w, at, step) - held;
    *step_of_term = step[--w->n_moved];
    return gain;
}

static double
change_term(ss_scene *s, match_term term, double by)
{
    if (term == MATCH_DAMPING)
        return s->damping += by * sqrt(s->stiffness * s->mass);
    s->static_friction = fmax(s->static_friction, s->friction) + by * s->friction;
    return s->static_friction / s->friction;
}

/* The gain by a term of the scene, w->c's, at a point with slopes. */
static double
gain_by_scene(matching *w, const point *at, match_term term, double *nearer)
{
    const ss_scene scene = w->c->scene;
    double *slope = w->tried.motion, h = step_of(w, 0), step;
    change_term(&w->c->scene, term, h);
    int runs = run(w, at->p, slope, w->tried.clear);
    w->c->scene = scene;
    if (!runs)
        return 0;
    for (size_t i = 0; i < w->r->n; i++)
        slope[i] = (slope[i] - w->here.motion[i]) / h;
    double gain = find_held(w, at, slope, &step);
    *nearer = change_term(&w->c->scene, term, step);
    return gain;
}

/* What a lag of so many samples changes in the motion, which is straight between samples. */
static void
lag_behind(const matching *w, double samples, double *change)
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
gain_by_lag(matching *w, const point *at)
{
    double most = 0, unused;
    for (double samples = 0.125; samples <= 8; samples *= 2) {
        lag_behind(w, samples, w->tried.motion);
        most = fmax(most, find_held(w, at, w->tried.motion, &unused));
    }
    return most;
}

ss_status
ss_match_held(double *gain, double *nearer, match_term term, const candidate *c, const match *m,
              const rank_record *record, const ss_stretch *progress)
{
    candidate changed = *c;
    matching w = { .c = &changed, .r = record, .progress = progress, .wide = 1 };
    point at = { .left = INFINITY };
    double *room = prepare(&w);
    if (room == NULL)
        return SS_ENOMEM;
    *gain = *nearer = 0;
    if (resume(&w, &at, m) && find_slopes(&w, &at)) {
        compare(&w, &w.here, &at);
        *gain = term == MATCH_LAG ? gain_by_lag(&w, &at) : gain_by_scene(&w, &at, term, nearer);
        *gain /= fmax(at.left, MATCH_QUIET * m->power);
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
