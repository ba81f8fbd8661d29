/* match.c -- adjust a scene to a record, sample by sample.
 *
 * The mean cycle finds the right motion (candidate.c), but a record is seldom settled to the last
 * digit, and the rest of the transient would shift the parameters or seem an error of the model.  So the
 * motion is fitted to the record itself, with a start of its own: position and velocity within a
 * slip half a cycle or more before the record, where they are all the state there is, or what else
 * there is has died out when the record begins.
 *
 * Size and offset are linear and follow from the rest in closed form; the other unknowns are found
 * by least squares (Levenberg 1944, Marquardt 1963).  A sample that an event crosses as a parameter
 * moves jumps, so the sum of squares has steps.  But an event that is a little from its place changes
 * only the samples beside it: these weigh nothing, and others the more the farther they are from the
 * events of the motion.  What is left of the sum is smooth, with one minimum and the errors of a
 * linear problem.  The weights reach full size after many samples first, then after fewer and fewer,
 * and in the end two samples or so an event are lost, of hundreds a cycle, and what they say of the
 * event's time.
 *
 * A fit that explains a record leaves white noise.  Half the mean square difference of what is left
 * over any lag is the variance of that noise if it is white, and less at some lag if it is not. */
#include "study/rank/match.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_statistics_double.h>
#include <stickslip/sim.h>
#include "scene/model.h"

enum { PASSES = 24, TRIALS = 6 };       /* of a descent, and of the damping in each */
enum { LAGS = 32 };
enum { LOOKED_AT = 128 };               /* samples of half a cycle, to find the fastest slip */
enum { UNKNOWNS = MATCH_UNKNOWNS, MOVED = MATCH_SIZE };     /* MOVED: those that move the motion */
#define FARTHEST 0.2                    /* of one step, of a key, a radian, or a start */
#define UNLIKELY 0.2                    /* of the power: if the search leaves that, it is the end */
#define LOST 0.03                       /* of the power: no start makes up for that */
#define RIDGE 1e-12                     /* of a diagonal: directions that the record does not show */

/* What is left is noise if its mean square is at most this much above it, and above what the estimate
 * of the noise may be low by: it rests on medians of n numbers, two of which may share a sample, so
 * its standard deviation is some 2.3 / sqrt n. */
#define ALLOWED 1.2
#define UNCERTAIN (3 * 2.3)
#define QUIET 1e-6                      /* of the power: methods of simulation differ by a tenth of it */

typedef struct point {
    double p[MOVED];                    /* see scene_at */
    double size, offset;
    double left;                        /* mean square over the samples used; infinite: no motion */
} point;

typedef struct matching {
    candidate *c;
    const match_record *r;
    const ss_stretch *progress;
    double runs, expected;
    ss_status status;                   /* SS_ENOMEM or SS_STOP */
    double frequency, lead;             /* of the start [Hz], and from there to the first sample [s] */
    double x_unit, v_unit;
    double turn;                        /* of a relative change of the frequency, that which shifts
                                           the ends of the record by a radian or so */
    size_t n_moved, moved[MOVED];       /* those that are adjusted */
    double wide;                        /* from one sample to so many more weights grow from 0 to 1 */
    double *motion, *slope[UNKNOWNS];   /* at the present point, and by each of moved, size, offset */
    double *clear, *weight;             /* of the point evaluated last: see ss_candidate_run */
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
    double frequency = w->frequency * exp(w->turn * p[MATCH_FREQUENCY]);
    ss_scene s = ss_candidate_scene(w->c, p, 1 / frequency);
    s.rate = w->r->rate;
    s.duration = (double)w->r->n / s.rate;
    s.settle = w->lead;
    /* the phase in the middle of the record: there it does not depend on the frequency */
    s.phase = p[MATCH_PHASE] - 2 * M_PI * frequency * (w->lead + s.duration / 2);
    s.x0 = w->x_unit * p[MATCH_X0];
    s.v0 = w->v_unit * p[MATCH_V0];
    return s;
}

/* Run the motion at p; 0 if there is none. */
static int
run(matching *w, const double p[MOVED], double *motion, double *clear)
{
    ss_scene s = scene_at(w, p);
    if (w->status == SS_OK)
        w->status = ss_stretch_at(w->progress, fmin(w->runs++ / w->expected, 1));
    if (w->status != SS_OK || w->c->steps > w->c->budget)
        return 0;
    ss_status st = ss_candidate_run(&s, w->c->pick, motion, clear, w->r->n, &w->c->steps);
    if (st == SS_ENOMEM)
        w->status = st;
    return st == SS_OK;
}

static void
weigh(matching *w)
{
    const match_record *r = w->r;
    w->used = 0;
    for (size_t i = 0; i < r->n; i++) {
        int missing = r->missing != NULL && r->missing[i];
        w->weight[i] = missing ? 0 : fmin(fmax((w->clear[i] - 1) / w->wide, 0), 1);
        w->used += w->weight[i];
    }
}

/* Size and offset of the motion that leave least of the samples used, and what that is. */
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
evaluate(matching *w, point *at, double *motion)
{
    at->left = INFINITY;
    if (!run(w, at->p, motion, w->clear))
        return;
    weigh(w);
    if (w->used > (w->wide > 1 ? 0.5 * (double)w->r->n : 2 * (double)unknowns(w)))
        regress(w, motion, at);
}

/* --- least squares ------------------------------------------------------------------------- */

typedef struct normal {
    size_t n;
    double a[UNKNOWNS][UNKNOWNS], g[UNKNOWNS];      /* a step solves a step = -g */
} normal;

/* Over which slopes are differences: what a method of simulation resolves, but wider for the start
 * while the way is long, as what follows it can change unevenly. */
static double
step_of(const matching *w, size_t j)
{
    if (w->wide > 1 && (j == MATCH_X0 || j == MATCH_V0))
        return 0.01;
    return ss_candidate_exact(w->c) ? 1e-6 : 1e-4;
}

/* Slopes of the motion, as large as the record's; 0 if one has none. */
static int
find_slopes(matching *w, const point *at)
{
    for (size_t k = 0; k < w->n_moved; k++) {
        double *slope = w->slope[k];
        point q = *at;
        double h = step_of(w, w->moved[k]);
        q.p[w->moved[k]] += h;
        if (!run(w, q.p, slope, NULL))
            return 0;
        for (size_t i = 0; i < w->r->n; i++)
            slope[i] = at->size * (slope[i] - w->motion[i]) / h;
    }
    for (size_t i = 0; i < w->r->n; i++) {
        w->slope[w->n_moved][i] = at->size * w->motion[i];
        w->slope[w->n_moved + 1][i] = 1;
    }
    return 1;
}

static void
find_normal(const matching *w, const point *at, normal *e)
{
    e->n = unknowns(w);
    memset(e->a, 0, sizeof e->a);
    memset(e->g, 0, sizeof e->g);
    for (size_t i = 0; i < w->r->n; i++) {
        double left = at->size * w->motion[i] + at->offset - w->r->x[i];
        for (size_t k = 0; k < e->n; k++) {
            double s = w->weight[i] * w->slope[k][i];
            e->g[k] += s * left;
            for (size_t l = 0; l <= k; l++)
                e->a[k][l] += s * w->slope[l][i];
        }
    }
    for (size_t k = 0; k < e->n; k++)
        for (size_t l = 0; l < k; l++)
            e->a[l][k] = e->a[k][l];
}

/* Cholesky's factor of a, its diagonal raised by the part ridge; rows and columns that are held are
 * those of the unit matrix. */
static void
factor(const normal *e, const int *held, double ridge, double l[UNKNOWNS][UNKNOWNS])
{
    for (size_t i = 0; i < e->n; i++)
        for (size_t j = 0; j <= i; j++) {
            double s = held[i] || held[j] ? i == j : e->a[i][j];
            if (i == j && !held[i])
                s += fmax(ridge * s, DBL_MIN);
            for (size_t k = 0; k < j; k++)
                s -= l[i][k] * l[j][k];
            /* rounding may leave less than nothing: a direction that is not seen does not move */
            l[i][j] = i != j ? s / l[j][j] : s > RIDGE / 2 * e->a[i][i] || held[i] ? sqrt(s) : INFINITY;
        }
}

static void
substitute(const normal *e, double l[UNKNOWNS][UNKNOWNS], double *b)
{
    for (size_t i = 0; i < e->n; i++) {
        for (size_t k = 0; k < i; k++)
            b[i] -= l[i][k] * b[k];
        b[i] /= l[i][i];
    }
    for (size_t i = e->n; i-- > 0;) {
        for (size_t k = i + 1; k < e->n; k++)
            b[i] -= l[k][i] * b[k];
        b[i] /= l[i][i];
    }
}

/* How far the unknown k may go: within its range, and no step so far that slopes mean nothing there.
 * (What the record hardly shows, as the start where all of it dies out, else goes anywhere.) */
static double
limited(const matching *w, const point *at, size_t k, double step)
{
    if (k >= w->n_moved)
        return step;
    size_t j = w->moved[k];
    step = fmin(fmax(step, -FARTHEST), FARTHEST);
    return j < CANDIDATE_KEYS ? fmin(fmax(step, w->c->lo[j] - at->p[j]), w->c->hi[j] - at->p[j]) : step;
}

/* The damped step within the ranges: unknowns that would leave theirs go to its end, and the others
 * are solved for again. */
static void
find_step(const matching *w, const point *at, const normal *e, double damping, double step[UNKNOWNS])
{
    int held[UNKNOWNS] = { 0 }, again = 1;
    double l[UNKNOWNS][UNKNOWNS];
    memset(step, 0, UNKNOWNS * sizeof *step);
    while (again) {
        double b[UNKNOWNS];
        for (size_t i = 0; i < e->n; i++) {
            b[i] = held[i] ? step[i] : -e->g[i];
            for (size_t k = 0; k < e->n && !held[i]; k++)
                b[i] -= held[k] ? e->a[i][k] * step[k] : 0;
        }
        factor(e, held, damping, l);
        substitute(e, l, b);
        again = 0;
        for (size_t i = 0; i < e->n; i++) {
            step[i] = held[i] ? step[i] : limited(w, at, i, b[i]);
            if (!held[i] && step[i] != b[i])
                held[i] = again = 1;
        }
    }
}

/* How much a step lowers the sum of squares if slopes are all there is to it. */
static double
gain_of(const normal *e, const double step[UNKNOWNS])
{
    double gain = 0;
    for (size_t k = 0; k < e->n; k++)
        gain -= e->g[k] * step[k];
    return gain;
}

/* From at to where least is left. */
static void
descend(matching *w, point *at)
{
    /* noise moves the sum of squares by once its variance: a thousandth of that is nothing */
    double damping = 1e-3, least = w->wide > 1 ? 1e-3 : 1e-3 / (double)w->r->n;
    normal e;
    evaluate(w, at, w->motion);
    for (int pass = 0; pass < PASSES && isfinite(at->left) && find_slopes(w, at); pass++) {
        double before = at->left;
        find_normal(w, at, &e);
        for (int i = 0; i < TRIALS && at->left == before; i++) {
            double step[UNKNOWNS];
            point q = *at;
            find_step(w, at, &e, fmax(damping, RIDGE), step);
            if (!(gain_of(&e, step) > least * before * w->used))
                break;
            for (size_t k = 0; k < w->n_moved; k++)
                q.p[w->moved[k]] += step[k];
            evaluate(w, &q, w->slope[0]);
            damping *= q.left < before ? 0.1 : 10;
            if (q.left < before) {
                *at = q;
                memcpy(w->motion, w->slope[0], w->r->n * sizeof *w->motion);
            }
        }
        if (!(at->left < before * (1 - least)))
            break;
    }
}

/* --- where the motion begins --------------------------------------------------------------- */

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

/* Begin from rest, CANDIDATE_SETTLE cycles before the record, as the search did. */
static void
begin_at_rest(matching *w, const candidate_start *start, double period, point *at)
{
    double cycles = (double)w->r->n / w->r->rate / period;
    w->frequency = 1 / period;
    w->lead = CANDIDATE_SETTLE * period;
    w->turn = 1 / (2 * M_PI * fmax(cycles, 1));
    memset(at->p, 0, sizeof at->p);
    memcpy(at->p, start->key, sizeof start->key);
    at->p[MATCH_PHASE] = 2 * M_PI * (w->r->from / period - start->shift + cycles / 2);
}

/* The same motion as one whose start is free, so many cycles before the record or up to half a cycle
 * later: where it slips fastest, if in a slip x and v are all the state there is.  0 if it does not
 * slip. */
static int
free_start(matching *w, double cycles, point *at)
{
    ss_sample fastest = { .v = 0 };
    ss_scene s = scene_at(w, at->p);
    double period = 1 / s.base_frequency;
    ss_sim_opts opts = { .method = ss_candidate_exact(w->c) ? "exact" : "rkck", .tol = 1e-7,
                         .max_steps = 1000000, .samples = find_fastest, .user = &fastest };
    if (w->c->model->dim > 2) {         /* from rest, once */
        int is_free = w->x_unit > 0;
        w->x_unit = s.base_amplitude;
        w->v_unit = 2 * M_PI * s.base_frequency * s.base_amplitude;
        return !is_free;
    }
    s.settle = w->lead - cycles * period;
    s.duration = period / 2;
    s.rate = 2 * LOOKED_AT / period;
    ss_status st = s.settle >= 0 ? ss_sim_run(&s, &opts, NULL, NULL) : SS_EINVAL;
    if (st == SS_ENOMEM)
        w->status = st;
    if (st != SS_OK || fastest.mode == 0)
        return 0;
    w->lead = cycles * period - fastest.t;
    w->x_unit = fmax(fabs(fastest.x), s.base_amplitude);
    w->v_unit = fabs(fastest.v);
    at->p[MATCH_X0] = fastest.x / w->x_unit;
    at->p[MATCH_V0] = fastest.v / w->v_unit;
    return 1;
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
    const int held[UNKNOWNS] = { 0 };
    double l[UNKNOWNS][UNKNOWNS], unit[UNKNOWNS];
    size_t name[UNKNOWNS];
    factor(e, held, RIDGE, l);
    for (size_t k = 0; k < e->n; k++) {
        name[k] = k < w->n_moved ? w->moved[k] : MATCH_SIZE + k - w->n_moved;
        unit[k] = name[k] == MATCH_FREQUENCY ? w->turn : 1;
    }
    memset(m->covariance, 0, sizeof m->covariance);
    for (size_t k = 0; k < e->n; k++) {
        double column[UNKNOWNS] = { 0 };
        column[k] = 1;
        substitute(e, l, column);
        for (size_t i = 0; i < e->n; i++)
            m->covariance[name[i]][name[k]] = unit[i] * unit[k] * column[i];
    }
}

static void
report(matching *w, point *at, match *m)
{
    normal e;
    const match_record *r = w->r;
    double all = 0, *left = w->slope[0];
    evaluate(w, at, w->motion);
    if (!isfinite(at->left) || !find_slopes(w, at))
        return;
    find_normal(w, at, &e);
    find_covariance(w, &e, m);
    m->left_all = 0;
    for (size_t i = 0; i < r->n; i++) {
        left[i] = r->x[i] - at->size * w->motion[i] - at->offset;
        if (r->missing == NULL || !r->missing[i])
            m->left_all += left[i] * left[i], all++;
    }
    m->left_all /= all;
    m->left = at->left * w->used / (w->used - (double)e.n);
    m->white = whiteness(w, left);
    m->compared = (size_t)w->used;
    m->scene = ss_candidate_resized(w->c, scene_at(w, at->p), at->size);
    memcpy(m->key, at->p, sizeof m->key);
}

static void
descend_all(matching *w, point *at)
{
    static const double wide[] = { CANDIDATE_REACH - 1, 4, 1 };
    for (size_t i = 0; i < sizeof wide / sizeof *wide; i++) {
        w->wide = wide[i];
        descend(w, at);
    }
}

/* The settled motion first, then those of any start that leave less.  A start three cycles before the
 * record is nearly forgotten there, so that what is left changes slowly with it; from one cycle before
 * descents end on the way, unless they begin near. */
static void
solve(matching *w, point *at, double misfit, match *m)
{
    static const double cycles[] = { 3, 1 };
    w->n_moved -= 2;
    w->expected = 6 * PASSES * (double)w->n_moved;
    w->wide = 1;
    if (misfit < UNLIKELY * m->power)
        descend_all(w, at);
    report(w, at, m);
    w->n_moved += 2;
    for (size_t i = 0; i < 2 && m->compared > 0 && m->left <= LOST * m->power; i++) {
        double before = m->left;
        if (!free_start(w, cycles[i], at))
            return;
        descend_all(w, at);
        if (at->left < m->left)
            report(w, at, m);
        if (m->left == before)
            return;
    }
}

static double
power_of(const match_record *r)
{
    double mean = 0, sum = 0, n = 0;
    for (size_t i = 0; i < r->n; i++)
        if (r->missing == NULL || !r->missing[i])
            mean += r->x[i], n++;
    mean /= fmax(n, 1);
    for (size_t i = 0; i < r->n; i++)
        if (r->missing == NULL || !r->missing[i])
            sum += (r->x[i] - mean) * (r->x[i] - mean);
    return sum / fmax(n, 1);
}

ss_status
ss_match_find(match *m, candidate *c, const candidate_start *start, double period,
              const match_record *record, const ss_stretch *progress)
{
    matching w = { .c = c, .r = record, .progress = progress, .expected = 1 };
    size_t n = record->n;
    point at = { .left = INFINITY };
    for (size_t j = 0; j < MOVED; j++)
        if (j < c->n ? c->hi[j] > c->lo[j] : j >= CANDIDATE_KEYS)
            w.moved[w.n_moved++] = j;
    double *room = malloc((n + 1) * (unknowns(&w) + 3) * sizeof *room);
    if (room != NULL) {
        w.motion = room;
        w.clear = room + n;
        w.weight = room + 2 * n;
        for (size_t k = 0; k < unknowns(&w); k++)
            w.slope[k] = room + (k + 3) * n;
        *m = (match){ .power = power_of(record), .scene = settled(&w, start, period) };
        memcpy(m->key, start->key, sizeof m->key);
        m->left = m->left_all = m->power;
        m->white = 0;
        for (size_t i = 0; i < UNKNOWNS; i++)
            for (size_t k = 0; k < UNKNOWNS; k++)
                m->covariance[i][k] = NAN;
        begin_at_rest(&w, start, period, &at);
        if (start->size > 0)
            solve(&w, &at, start->misfit, m);
    } else {
        w.status = SS_ENOMEM;
    }
    free(room);
    return w.status;
}

/* Cosine, sine and offset by their normal equations, which are near to diagonal over whole cycles. */
double
ss_match_sinusoid(const match_record *r, double frequency)
{
    double a[3][4] = { { 0 } }, squares = 0, count = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < r->n; i++) {
            double phase = 2 * M_PI * frequency * (double)i / r->rate, left = r->x[i];
            const double base[3] = { cos(phase), sin(phase), 1 };
            if (r->missing != NULL && r->missing[i])
                continue;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3 && pass == 0; l++)
                    a[k][l] += base[k] * base[l];
            for (int k = 0; k < 3; k++)
                a[k][3] += pass == 0 ? base[k] * r->x[i] : 0, left -= pass == 1 ? a[k][3] * base[k] : 0;
            squares += pass == 1 ? left * left : 0;
            count += pass;
        }
        for (int k = 0; k < 3 && pass == 0; k++)        /* Gauss and Jordan: a is positive */
            for (int j = 0; j < 3; j++) {
                double part = j != k ? a[j][k] / a[k][k] : 0;
                for (int l = 0; l < 4; l++)
                    a[j][l] -= part * a[k][l];
            }
        for (int k = 0; k < 3 && pass == 0; k++)
            a[k][3] /= a[k][k];
    }
    return squares / fmax(count, 1);
}

double
ss_match_excess(const match *m, double noise)
{
    return m->left / fmax(fmin(noise, m->white), QUIET * m->power);
}

int
ss_match_explains(const match *m, double noise)
{
    return m->compared > 0 && ss_match_excess(m, noise)
                              <= ALLOWED * (1 + UNCERTAIN / sqrt((double)m->compared));
}

/* --- noise --------------------------------------------------------------------------------- */

static int
is_missing(const match_record *r, size_t i, size_t n)
{
    for (size_t k = 0; r->missing != NULL && k < n; k++)
        if (r->missing[i + k])
            return 1;
    return 0;
}

/* Of n numbers as Gaussian ones have it: by the median of their sizes. */
static double
gaussian_variance(double *d, size_t n)
{
    if (n == 0)
        return INFINITY;
    for (size_t i = 0; i < n; i++)
        d[i] = fabs(d[i]);
    double median = gsl_stats_median(d, 1, n) / 0.67448975019608171;
    return median * median;
}

/* By fourth differences, which have (1 + 16 + 36 + 16 + 1) times the variance: slow motion and what
 * happens seldom are not in their median. */
static double
fast_variance(const match_record *r, double *d)
{
    size_t count = 0;
    for (size_t i = 0; i + 5 <= r->n; i++)
        if (!is_missing(r, i, 5)) {
            const double *x = r->x + i;
            d[count++] = (x[0] - 4 * x[1] + 6 * x[2] - 4 * x[3] + x[4]) / sqrt(70);
        }
    return gaussian_variance(d, count);
}

/* By what a cycle later differs, interpolated between two samples: what repeats is not in it,
 * however fast. */
static double
cycle_variance(const match_record *r, double samples, double *d)
{
    size_t lag = (size_t)samples, count = 0;
    double part = samples - floor(samples);
    for (size_t i = 0; i + lag + 2 <= r->n; i++)
        if (!is_missing(r, i, 1) && !is_missing(r, i + lag, 2)) {
            double later = (1 - part) * r->x[i + lag] + part * r->x[i + lag + 1];
            d[count++] = (r->x[i] - later) / sqrt(1 + (1 - part) * (1 - part) + part * part);
        }
    return gaussian_variance(d, count);
}

/* A converter's steps: their variance is a twelfth of the square of the smallest. */
static double
step_variance(const match_record *r)
{
    double least = INFINITY;
    for (size_t i = 1; i < r->n; i++)
        if (r->x[i] != r->x[i - 1])
            least = fmin(least, fabs(r->x[i] - r->x[i - 1]));
    return isfinite(least) ? least * least / 12 : 0;
}

ss_status
ss_match_noise(double *variance, const match_record *record, double samples)
{
    double *d = malloc((record->n + 1) * sizeof *d);
    if (d == NULL)
        return SS_ENOMEM;
    double fast = fast_variance(record, d);
    double repeated = samples > 0 && samples < (double)record->n
        ? cycle_variance(record, samples, d) : INFINITY;
    double least = fmin(fast, repeated);
    *variance = fmax(isfinite(least) ? least : 0, step_variance(record));
    free(d);
    return SS_OK;
}
