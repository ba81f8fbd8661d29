/* forced_fit.c -- fit a scene whose base moves to a record, sample by sample.
 *
 * The mean cycle finds the right motion (forced.c).  But a record is seldom completely settled,
 * and the rest of the transient would shift the parameters or look like an error of the model.  So
 * the motion is fitted to the record itself, with its own start: position and velocity within a slip, half a
 * cycle or more before the record.  These two are the whole state there, or the rest of the state has decayed
 * when the record begins.  Size and offset are linear, and follow from the rest in closed form.
 *
 * When a parameter moves an event across a sample, the sample jumps, so the sum of squares has steps.  But an
 * event slightly out of place changes only the samples beside it: these have weight 0, and the weight of
 * others grows with their distance from the events of the motion.  The weighted sum is smooth, with one
 * minimum and the errors of a linear problem.  At first the weights reach 1 after many samples, then after
 * fewer and fewer.  In the end some two samples per event are lost, of hundreds per cycle, with their
 * information on its time.
 *
 * A fit that explains a record leaves white noise.  Half the mean square difference of the residual over any
 * lag is the variance of that noise if it is white, and less at some lag if it is not. */
#include "fit/forced.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"
#include "scene/model.h"

enum { LAGS = 32 };
enum { LOOKED_AT = 128 };       /* samples of half a cycle, to find the fastest slip */
#define FARTHEST 0.2            /* the longest step of an unknown */
#define ANYWHERE 5              /* units to either side, in which a start of the motion is sought */

typedef struct fitting {
    forced *c;
    const rank_record *r;
    forced_origin o;
    ss_range range[FORCED_MOVED];
    double runs;                /* of the motion so far */
    double wide;                /* weights grow from 0 to 1 over so many samples */
    double *motion, *clear, *weight;    /* of each sample, at the unknowns `at` */
    double at[FORCED_MOVED], used, size, offset;        /* used: the sum of the weights */
    double mean, squares;       /* of the motion, and about its mean, weighed */
    double *moved, moved_at[FORCED_MOVED];              /* slopes of the motion by each unknown, and where */
} fitting;

/* --- the motion of the unknowns ------------------------------------------------------------ */

static ss_scene
scene_of(const fitting *w, const double *u)
{
    double frequency = w->o.frequency * exp(w->o.turn * u[FORCED_FREQUENCY]);
    ss_scene s = ss_forced_scene(w->c, u, 1 / frequency);
    s.rate = w->r->rate;
    s.duration = (double)w->r->n / s.rate;
    s.settle = w->o.lead;
    /* the phase in the middle of the record: there it does not depend on the frequency */
    s.phase = u[FORCED_PHASE] - 2 * M_PI * frequency * (w->o.lead + s.duration / 2);
    s.x0 = w->o.x_unit * u[FORCED_X0];
    s.v0 = w->o.v_unit * u[FORCED_V0];
    return s;
}

/* SS_EDATA: there is no such motion. */
static ss_status
run(fitting *w, const double *u, double *motion, double *clear)
{
    const ss_scene s = scene_of(w, u);
    ss_status st = ss_stretch_at(&w->c->progress, 1 - exp(-w->runs++ / FORCED_RUNS));
    if (st != SS_OK)
        return st;
    if (w->c->steps > w->c->budget)
        return SS_EDATA;
    st = ss_samples_run(&s, w->c->pick, SAMPLES_FINE, motion, clear, w->r->n, &w->c->steps);
    return st == SS_OK || st == SS_ENOMEM ? st : SS_EDATA;
}

/* Run the motion of u, weigh its samples, and find the size and the offset that leave least of them. */
static ss_status
move_to(fitting *w, const double *u)
{
    const rank_record *r = w->r;
    double mean_x = 0, mx = 0;
    w->at[0] = NAN;
    ss_status st = run(w, u, w->motion, w->clear);
    if (st != SS_OK)
        return st;
    w->used = w->mean = w->squares = 0;
    for (size_t i = 0; i < r->n; i++) {
        int missing = r->missing != NULL && r->missing[i];
        w->weight[i] = missing ? 0 : fmin(fmax((w->clear[i] - 1) / w->wide, 0), 1);
        w->used += w->weight[i];
    }
    if (!(w->used > (w->wide > 1 ? 0.5 * (double)r->n : 2 * (double)FORCED_UNKNOWNS)))
        return SS_EDATA;
    for (size_t i = 0; i < r->n; i++) {
        w->mean += w->weight[i] * w->motion[i] / w->used;
        mean_x += w->weight[i] * r->x[i] / w->used;
    }
    for (size_t i = 0; i < r->n; i++) {
        double m = w->motion[i] - w->mean;
        w->squares += w->weight[i] * m * m;
        mx += w->weight[i] * m * (r->x[i] - mean_x);
    }
    w->size = w->squares > 0 ? mx / w->squares : 0;
    w->offset = mean_x - w->size * w->mean;
    memcpy(w->at, u, sizeof w->at);
    return w->size > 0 ? SS_OK : SS_EDATA;
}

static double
left_at(const fitting *w, size_t i)
{
    return w->r->x[i] - w->size * w->motion[i] - w->offset;
}

/* The step of an unknown for its slope: as small as a method of simulation resolves. */
static double
step_of(const fitting *w)
{
    return w->c->model->linear ? 1e-6 : 1e-4;
}

static int
moves(const fitting *w, size_t unknown)
{
    return w->range[unknown].to > w->range[unknown].from;
}

/* Find the slopes of the motion at w->at by each unknown that is free, unless they are known. */
static ss_status
move_unknowns(fitting *w)
{
    const size_t n = w->r->n;
    double u[FORCED_MOVED];
    ss_status st = SS_OK;
    if (memcmp(w->moved_at, w->at, sizeof w->at) == 0)
        return SS_OK;
    w->moved_at[0] = NAN;
    for (size_t k = 0; st == SS_OK && k < FORCED_MOVED; k++) {
        double h = step_of(w), *slope = w->moved + k * n;
        memcpy(u, w->at, sizeof u);
        u[k] += h;
        if (moves(w, k))
            st = run(w, u, slope, NULL);
        for (size_t i = 0; st == SS_OK && i < n; i++)
            slope[i] = moves(w, k) ? (slope[i] - w->motion[i]) / h : 0;
    }
    if (st == SS_OK)
        memcpy(w->moved_at, w->at, sizeof w->at);
    return st;
}

/* The slope of residual i at w->at by an unknown, 0 by one that is held; the weights are taken as constant. */
static double
slope_at(const fitting *w, size_t i, size_t unknown)
{
    double by = unknown < FORCED_MOVED ? w->size * w->moved[unknown * w->r->n + i]
              : unknown == FORCED_SIZE ? w->size * w->motion[i] : 1;
    return -sqrt(w->weight[i]) * by;
}

/* See least_model: of the mean square residual of the samples used.  Slopes are less what size and offset make up
 * for (Kaufman 1975). */
static ss_status
motion_model(const double *u, double *residual, double *slopes, void *user)
{
    fitting *w = user;
    ss_status st = slopes == NULL || memcmp(u, w->at, sizeof w->at) != 0 ? move_to(w, u) : SS_OK;
    for (size_t i = 0; st == SS_OK && slopes == NULL && i < w->r->n; i++)
        residual[i] = sqrt(w->weight[i] / w->used) * left_at(w, i);
    if (st == SS_OK && slopes != NULL)
        st = move_unknowns(w);
    for (size_t k = 0; st == SS_OK && slopes != NULL && k < FORCED_MOVED; k++) {
        double level = 0, along = 0;
        for (size_t i = 0; i < w->r->n; i++) {
            double slope = sqrt(w->weight[i]) * slope_at(w, i, k);
            level += slope / w->used;
            along += slope * (w->motion[i] - w->mean) / w->squares;
        }
        for (size_t i = 0; i < w->r->n; i++)
            slopes[i * FORCED_MOVED + k] = (slope_at(w, i, k) - sqrt(w->weight[i])
                                            * (level + along * (w->motion[i] - w->mean))) / sqrt(w->used);
    }
    return st;
}

/* Move u to the least residual, with narrower and narrower weights. */
static ss_status
minimise(fitting *w, double *u)
{
    static const double wide[] = { SAMPLES_REACH - 1, 4, 1 };
    least fit = { .rows = w->r->n, .unknowns = FORCED_MOVED, .model = motion_model, .user = w, .costly = 1,
                  .range = w->range, .farthest = FARTHEST, .tol = 1e-9 };
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < sizeof wide / sizeof *wide; i++) {
        least_end end;
        w->wide = wide[i];
        fit.gain = w->wide > 1 ? 1e-2 : 1e-3;
        fit.noise = w->wide > 1 ? 0 : w->r->noise / (double)w->r->n;
        st = ss_least_fit(&end, &fit, u, NULL, NULL);
    }
    return st;
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

static void
free_ranges(fitting *w)
{
    w->moved_at[0] = NAN;
    for (size_t k = FORCED_X0; k <= FORCED_V0; k++)
        w->range[k] = (ss_range){ -ANYWHERE, ANYWHERE };
}

/* Free the start of the motion, `cycles` cycles before the record or up to half a cycle later: it
 * is moved to the fastest slip if x and v are the whole state there.  *is_free becomes 0 if the motion does
 * not slip, or if its start was free before and is not moved. */
static ss_status
free_start(fitting *w, double cycles, double *u, int *is_free)
{
    ss_sample fastest = { .v = 0 };
    ss_scene s = scene_of(w, u);
    const double period = 1 / s.base_frequency;
    *is_free = 0;
    if (w->c->model->dim > 2) {         /* from rest, once */
        *is_free = !(w->o.x_unit > 0);
        w->o.x_unit = s.base_amplitude;
        w->o.v_unit = 2 * M_PI * s.base_frequency * s.base_amplitude;
        free_ranges(w);
        return SS_OK;
    }
    s.settle = w->o.lead - cycles * period;
    s.duration = period / 2;
    s.rate = 2 * LOOKED_AT / period;
    ss_sim_opts opts = ss_samples_opts(&s, SAMPLES_FINE);
    opts.samples = find_fastest;
    opts.user = &fastest;
    ss_status st = s.settle >= 0 ? ss_sim_run(&s, &opts, NULL, NULL) : SS_EINVAL;
    if (st != SS_OK || fastest.mode == 0)
        return st == SS_ENOMEM ? st : SS_OK;
    w->o.lead = cycles * period - fastest.t;
    w->o.x_unit = fmax(fabs(fastest.x), s.base_amplitude);
    w->o.v_unit = fabs(fastest.v);
    u[FORCED_X0] = fastest.x / w->o.x_unit;
    u[FORCED_V0] = fastest.v / w->o.v_unit;
    free_ranges(w);
    *is_free = 1;
    return SS_OK;
}

/* --- the answer ---------------------------------------------------------------------------- */

/* The least of half the mean square differences over a lag: see the head of this file. */
static double
whiteness(const fitting *w)
{
    double lowest = INFINITY;
    for (size_t lag = 1; lag <= LAGS && lag < w->r->n / 4; lag++) {
        double squares = 0, count = 0;
        for (size_t i = lag; i < w->r->n; i++)
            if (w->weight[i] == 1 && w->weight[i - lag] == 1) {
                double d = left_at(w, i) - left_at(w, i - lag);
                squares += d * d;
                count++;
            }
        if (count > 0)
            lowest = fmin(lowest, squares / count / 2);
    }
    return lowest;
}

/* The linear problem at w->at: residual[i], their slopes by all unknowns and by an EXTRA one, which are 0 at
 * first, and its solution, the step to the least squares and its covariance. */
enum { EXTRA = FORCED_UNKNOWNS, ALL };
typedef struct linear {
    double *residual, *slopes, step[ALL], covariance[ALL][ALL];
} linear;

static ss_status
linearise(fitting *w, linear *l)
{
    const size_t rows = w->r->n;
    l->residual = calloc(rows * (ALL + 1) + 1, sizeof *l->residual);
    ss_status st = l->residual != NULL ? move_unknowns(w) : SS_ENOMEM;
    l->slopes = l->residual + rows;
    for (size_t i = 0; st == SS_OK && i < rows; i++) {
        l->residual[i] = sqrt(w->weight[i]) * left_at(w, i);
        for (size_t k = 0; k < FORCED_UNKNOWNS; k++)
            l->slopes[i * ALL + k] = slope_at(w, i, k);
    }
    return st;
}

static ss_status
solve(linear *l, size_t rows)
{
    double squares;
    return ss_least_linear(l->slopes, l->residual, rows, ALL, l->step, &squares, *l->covariance);
}

/* Fill in the fit at u, unless it leaves more than it does already. */
static ss_status
report(fitting *w, const double *u, forced_fit *m)
{
    const rank_record *r = w->r;
    double left = 0, all = 0, count = 0, unknowns = 0;
    linear l;
    w->wide = 1;
    ss_status st = move_to(w, u);
    if (st != SS_OK)
        return st == SS_EDATA ? SS_OK : st;
    for (size_t i = 0; i < r->n; i++)
        left += w->weight[i] * left_at(w, i) * left_at(w, i);
    if (m->of_samples.compared > 0 && left / w->used >= m->of_samples.left)
        return SS_OK;
    st = linearise(w, &l);
    if (st == SS_OK)
        st = solve(&l, r->n);
    free(l.residual);
    if (st != SS_OK)
        return st == SS_EDATA ? SS_OK : st;
    for (size_t k = 0; k < FORCED_UNKNOWNS; k++) {
        unknowns += k >= FORCED_MOVED || moves(w, k);
        for (size_t i = 0; i < FORCED_UNKNOWNS; i++)
            m->covariance[i][k] = l.covariance[k][i] * (i == FORCED_FREQUENCY ? w->o.turn : 1)
                * (k == FORCED_FREQUENCY ? w->o.turn : 1);
    }
    for (size_t i = 0; i < r->n; i++)
        if (r->missing == NULL || !r->missing[i])
            all += left_at(w, i) * left_at(w, i), count++;
    m->left_all = all / count;
    m->of_samples = (residue){ left / (w->used - unknowns), m->of_samples.power,
                               fmax(whiteness(w), r->steps),    /* steps are not white where they are coarse */
                               floor(w->used) };
    m->scene = ss_forced_resized(w->c, scene_of(w, u), w->size);
    memcpy(m->u, u, sizeof m->u);
    m->origin = w->o;
    return SS_OK;
}

/* Do two sets of keys differ by no more than RESIDUE_DECISIVE of their errors in a fit? */
static int
are_same(const forced_fit *m, const double a[], const double b[])
{
    for (size_t i = 0; i < FORCED_KEYS; i++) {
        double d = a[i] - b[i];
        if (d * d > RESIDUE_DECISIVE * m->of_samples.left * m->covariance[i][i] + 1e-12)
            return 0;
    }
    return 1;
}

/* Prepare a fit that explains nothing yet: the residual is the record. */
static ss_status
begin(fitting *w, forced_fit *m, forced *c, const rank_record *r)
{
    const double power = ss_record_power(r);
    *m = (forced_fit){ .scene = c->scene, .of_samples = { power, power, 0, 0 }, .left_all = power };
    for (size_t i = 0; i < FORCED_UNKNOWNS; i++)
        for (size_t k = 0; k < FORCED_UNKNOWNS; k++)
            m->covariance[i][k] = NAN;
    *w = (fitting){ .c = c, .r = r, .wide = 1,
                    .motion = malloc(((3 + FORCED_MOVED) * r->n + 1) * sizeof(double)) };
    w->clear = w->motion + r->n;
    w->weight = w->clear + r->n;
    w->moved = w->weight + r->n;
    w->moved_at[0] = w->at[0] = NAN;
    for (size_t k = 0; k < c->n; k++)
        w->range[k] = c->range[k];
    return w->motion != NULL ? SS_OK : SS_ENOMEM;
}

/* Where frequency and phase are sought. */
static void
set_ranges(fitting *w, const double *u)
{
    w->range[FORCED_FREQUENCY] = (ss_range){ u[FORCED_FREQUENCY] - ANYWHERE, u[FORCED_FREQUENCY] + ANYWHERE };
    w->range[FORCED_PHASE] = (ss_range){ u[FORCED_PHASE] - M_PI, u[FORCED_PHASE] + M_PI };
}

/* Fit from one start.  If the settled motion is that of one of the n fits from other starts, it is that fit.  The
 * settled motion is fitted first, then motions from any start if they leave less.  The record hardly
 * depends on a start three cycles before it, so that the residual changes slowly with that start.
 * For a start one cycle before it, descents end too early unless they begin near the solution. */
static ss_status
fit_start(forced_fit *m, forced *c, const forced_start *start, const rank_record *r, const forced_fit *others,
          size_t n)
{
    static const double before[] = { 3, 1 };            /* cycles */
    const double cycles = (double)r->n / r->rate / c->period;
    double u[FORCED_MOVED] = { 0 };
    int is_free = 1;
    fitting w;
    ss_status st = begin(&w, m, c, r);
    const double power = m->of_samples.power;
    /* from rest, FORCED_SETTLE cycles before the record, as the search did */
    w.o = (forced_origin){ .frequency = 1 / c->period, .lead = FORCED_SETTLE * c->period,
                           .turn = 1 / (2 * M_PI * fmax(cycles, 1)) };
    memcpy(u, start->key, sizeof start->key);
    u[FORCED_PHASE] = 2 * M_PI * (r->from / c->period - start->shift + cycles / 2);
    set_ranges(&w, u);
    m->scene = ss_forced_resized(c, scene_of(&w, u), start->size > 0 ? start->size : 1);
    memcpy(m->u, u, sizeof m->u);
    if (st == SS_OK && start->size > 0 && start->misfit < LITTLE * power)
        st = minimise(&w, u);
    if (st == SS_OK && start->size > 0)
        st = report(&w, u, m);
    memcpy(m->settled, m->u, sizeof m->settled);
    for (size_t i = 0; st == SS_OK && i < n; i++)
        if (are_same(m, m->settled, others[i].settled)) {
            *m = others[i];
            free(w.motion);
            return SS_OK;
        }
    for (size_t i = 0; st == SS_OK && is_free && i < 2; i++) {
        double left = m->of_samples.left;
        if (m->of_samples.compared == 0 || left > LITTLE * power)
            break;
        st = free_start(&w, before[i], u, &is_free);
        if (st == SS_OK && is_free)
            st = minimise(&w, u);
        if (st == SS_OK && is_free)
            st = report(&w, u, m);
        is_free = is_free && m->of_samples.left < left;
    }
    free(w.motion);
    return st;
}

ss_status
ss_forced_fit(forced_fit *best, double *rival, forced *c, const cycle *goal, size_t points, size_t keep,
              const rank_record *r)
{
    const ss_stretch whole = c->progress;
    forced_start start[FORCED_KEPT];
    forced_fit found[FORCED_KEPT] = { { .left_all = 0 } };
    size_t lowest = 0, fits = 0, n;
    c->progress = ss_stretch_part(&whole, 0, 0.5);
    ss_status st = ss_forced_search(start, &n, c, goal, points, keep);
    for (; st == SS_OK && fits < n; fits++) {
        if (fits > 0 && (start[fits].misfit > LITTLE * goal->power
                         || (rival == NULL && ss_residue_explains(&found[lowest].of_samples, r->noise))))
            break;
        c->progress = ss_stretch_part(&whole, 0.5 + 0.5 * (double)fits / (double)n,
                                      0.5 + 0.5 * (double)(fits + 1) / (double)n);
        st = fit_start(&found[fits], c, &start[fits], r, found, fits);
        lowest = found[fits].of_samples.left < found[lowest].of_samples.left ? fits : lowest;
    }
    *best = found[lowest];
    if (rival != NULL)
        *rival = INFINITY;
    for (size_t i = 0; rival != NULL && i < fits; i++)
        if (found[i].of_samples.compared > 0 && !are_same(best, best->u, found[i].u))
            *rival = fmin(*rival, found[i].of_samples.left);
    return st;
}

/* Take a fit up again. */
static void
resume(fitting *w, const forced_fit *from)
{
    w->o = from->origin;
    set_ranges(w, from->u);
    if (w->o.x_unit > 0)
        free_ranges(w);
}

ss_status
ss_forced_refit(forced_fit *m, forced *c, const forced_fit *from, const rank_record *r)
{
    double u[FORCED_MOVED];
    fitting w;
    ss_status st = begin(&w, m, c, r);
    resume(&w, from);
    m->scene = from->scene;
    memcpy(m->u, from->u, sizeof m->u);
    memcpy(u, from->u, sizeof u);
    if (st == SS_OK && m->of_samples.power > 0)
        st = minimise(&w, u);
    if (st == SS_OK && m->of_samples.power > 0)
        st = report(&w, u, m);
    free(w.motion);
    return st;
}

/* --- terms that are held ------------------------------------------------------------------- */

/* How much less the sum of squares would be with the EXTRA unknown, and how far it would go.  (Near the least
 * residual the sum of squares is quadratic: no other fit is needed.) */
static ss_status
find_gain(linear *l, size_t rows, double *gain, double *far)
{
    ss_status st = solve(l, rows);
    const double variance = l->covariance[EXTRA][EXTRA];
    *far = -l->step[EXTRA];             /* residuals fall by slope times step */
    *gain = variance > 0 ? *far * *far / variance : 0;
    return st;
}

/* Change a term of the scene; returns what it becomes. */
static double
change_term(ss_scene *s, forced_term term, double by)
{
    if (term == HELD_DAMPING)
        return s->damping += by * sqrt(s->stiffness * s->mass);
    s->static_friction = fmax(s->static_friction, s->friction) + by * s->friction;
    return s->static_friction / s->friction;
}

ss_status
ss_forced_gains(forced_held of[HELD_TERMS], const forced *c, const forced_fit *m, const rank_record *r)
{
    const double unit = fmax(m->of_samples.left, RESIDUE_QUIET * m->of_samples.power);
    forced own = *c;
    forced_fit unused;
    fitting w;
    linear l = { .residual = NULL };
    double far, gain, y;
    own.progress.progress.function = NULL;
    for (forced_term term = 0; term < HELD_TERMS; term++)
        of[term] = (forced_held){ 0, NAN };
    ss_status st = begin(&w, &unused, &own, r);
    resume(&w, m);
    if (st == SS_OK)
        st = move_to(&w, m->u);
    if (st == SS_OK)
        st = linearise(&w, &l);
    for (forced_term term = 0; st == SS_OK && term < HELD_LAG; term++) {
        const double h = step_of(&w);
        change_term(&own.scene, term, h);
        st = run(&w, w.at, w.clear, NULL);
        own.scene = c->scene;
        for (size_t i = 0; i < r->n; i++)
            l.slopes[i * ALL + EXTRA] = -sqrt(w.weight[i]) * w.size * (w.clear[i] - w.motion[i]) / h;
        if (st == SS_OK)
            st = find_gain(&l, r->n, &gain, &far);
        if (st != SS_OK)
            break;
        of[term].gain = gain / unit;
        of[term].nearer = change_term(&own.scene, term, far);
        own.scene = c->scene;
    }
    /* a lag changes a motion that is straight between samples so; longer lags leave more than noise */
    for (double samples = 1 / 8.; st == SS_OK && samples <= 8; samples *= 2) {
        const double *x = w.motion, keep = exp(-1 / samples), part = samples * (1 - keep);
        y = x[0];
        for (size_t i = 0; i < r->n; i++) {
            y = i > 0 ? keep * y + (1 - part) * x[i] + (part - keep) * x[i - 1] : y;
            l.slopes[i * ALL + EXTRA] = -sqrt(w.weight[i]) * w.size * (y - x[i]);
        }
        st = find_gain(&l, r->n, &gain, &far);
        of[HELD_LAG].gain = fmax(of[HELD_LAG].gain, gain / unit);
    }
    free(l.residual);
    free(w.motion);
    return st == SS_EDATA ? SS_OK : st;
}
