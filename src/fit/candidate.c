/* candidate.c -- adjust a scene to a mean cycle, within a range about its own parameters.
 *
 * The parameters of the measured rig differ from those of the scene by some tenths, so a model is
 * judged by its best fit within this range.  Size and phase are free and found in closed form
 * (cycle.c): motion is proportional to f_k and Z_e together, if alpha decreases as they increase.
 * Two to four numbers remain to search.  Events move, appear and vanish as these change, so the
 * misfit has steps and creases, and its derivative is of no use.  The search therefore tries
 * points all over the range (Sobol's, always the same), and continues with a simplex (Nelder and
 * Mead 1965) from the best of them. */
#include "fit/candidate.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_qrng.h>
#include "base/error.h"
#include "base/sort.h"
#include "scene/model.h"
#include "fit/samples.h"

enum { STARTS_MOST = 256 };
#define SMALL 0.01              /* size of a simplex that ends a search: a match goes on faster from there */
#define SAME 0.02               /* difference of two keys from which descents end at the same point */

/* Parameter i of the model. */
static double *
own(const candidate *c, ss_scene *s, size_t i)
{
    return number_at(s, c->model->parameter[i].offset);
}

static double
drive_of(const ss_scene *scene)
{
    return scene->stiffness * scene->base_amplitude;
}

/* A term of the scene that no adjustment allows for; NULL: none. */
static const char *
strange_term(const ss_scene *scene)
{
    ss_scene rest = *scene;
    rest.damping = rest.static_friction = 0;
    return ss_scene_term(&rest);
}

/* f_s over f_k, which no change of f_k changes. */
static double
static_ratio(const ss_scene *scene)
{
    return scene->friction > 0 ? static_friction(scene) / scene->friction : 1;
}

ss_status
ss_candidate_check(const ss_scene *scene, ss_error *err)
{
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK && ss_scene_is_pulled(scene))
        return ss_fail(err, SS_EINVAL, "pulled scenes are ranked among themselves only, and fitted by their "
                       "slips");
    if (st == SS_OK && !(drive_of(scene) > 0))
        return ss_fail(err, SS_EINVAL, "base_amplitude = 0: such a scene has no cycle to compare");
    const char *term = st == SS_OK ? strange_term(scene) : NULL;
    if (term != NULL)
        return ss_fail(err, SS_EINVAL, "a scene with %s is not adjusted to a signal", term);
    return st;
}

candidate
ss_candidate_of(const ss_scene *scene, int pick, double factor)
{
    candidate c = { .model = scene->model, .scene = *scene, .pick = pick, .budget = INFINITY };
    ss_scene *s = &c.scene;
    if (c.model->normalise != NULL)
        c.model->normalise(s);
    double key[CANDIDATE_KEYS] = { s->stiffness, s->friction / drive_of(s) };
    c.n = CANDIDATE_OWN + c.model->n_parameters;
    for (size_t i = 0; i < c.model->n_parameters; i++)
        key[CANDIDATE_OWN + i] = *own(&c, s, i);
    for (size_t i = 0; i < c.n; i++) {
        /* no friction or damping is as good as too little to see */
        c.own[i] = log(fmax(key[i], 1e-300));
        c.lo[i] = c.own[i] - log(factor);
        c.hi[i] = c.own[i] + log(factor);
    }
    double most = -log(static_ratio(s));
    if (c.lo[CANDIDATE_RATIO] < most)         /* f_s > k Z_e: nothing slips */
        c.hi[CANDIDATE_RATIO] = fmin(c.hi[CANDIDATE_RATIO], most);
    for (size_t i = 0; i < c.model->n_parameters; i++) {
        if (!c.model->parameter[i].by_speed)
            continue;
        c.lo[CANDIDATE_OWN + i] -= log(factor) / 2;     /* the speed is as free as Z_e is */
        c.hi[CANDIDATE_OWN + i] += log(factor) / 2;
    }
    return c;
}

ss_scene
ss_candidate_scene(const candidate *c, const double key[CANDIDATE_KEYS], double period)
{
    ss_scene s = c->scene;
    double drive = drive_of(&s);
    s.stiffness = exp(key[CANDIDATE_STIFFNESS]);
    s.base_amplitude = drive / s.stiffness;
    s.friction = drive * exp(key[CANDIDATE_RATIO]);
    s.static_friction = s.static_friction > 0 ? s.friction * static_ratio(&c->scene) : 0;
    s.base_frequency = 1 / period;
    for (size_t i = 0; i < c->model->n_parameters; i++)
        *own(c, &s, i) = exp(key[CANDIDATE_OWN + i]);
    s.phase = s.x0 = s.v0 = 0;
    s.settle = CANDIDATE_SETTLE * period;
    return s;
}

/* --- misfit -------------------------------------------------------------------------------- */

typedef struct problem {
    candidate *c;
    cycle_goal goal;
    const ss_stretch *progress;
    double runs, expected;      /* so far, and about how many there will be */
    ss_status status;           /* SS_ENOMEM once a run lacked memory, SS_STOP once asked to stop; all
                                   others are a bad fit */
} problem;

static double
misfit(problem *p, const double key[], double *size, double *shift)
{
    candidate *c = p->c;
    const cycle *goal = p->goal.c;
    double value[CYCLE_MOST];
    ss_scene s = ss_candidate_scene(c, key, goal->period);
    s.duration = goal->period;
    s.rate = (double)goal->n / goal->period;
    *size = *shift = 0;
    if (p->status == SS_OK)
        p->status = ss_stretch_at(p->progress, fmin(p->runs++ / p->expected, 1));
    if (p->status != SS_OK)
        return goal->power;
    ss_status st = ss_samples_run(&s, c->pick, SAMPLES_COARSE, value, NULL, goal->n, &c->steps);
    if (st == SS_ENOMEM)
        p->status = SS_ENOMEM;
    if (st != SS_OK)
        return goal->power;
    return ss_cycle_misfit(&p->goal, value, size, shift);
}

/* Any u gives keys in range; a fixed key has no u. */
static void
keys_of(const candidate *c, const double *u, double key[CANDIDATE_KEYS])
{
    for (size_t i = 0, k = 0; i < c->n; i++) {
        double width = c->hi[i] - c->lo[i];
        key[i] = c->lo[i] + (width > 0 ? width * (0.5 + 0.5 * sin(u[k++])) : 0);
    }
}

/* The logarithm of the misfit: with it a simplex descends into valleys of 20 and of 60 dB alike. */
static double
height(const gsl_vector *u, void *user)
{
    problem *p = user;
    double key[CANDIDATE_KEYS], size, shift;
    if (p->c->steps > p->c->budget)
        return 0;
    keys_of(p->c, u->data, key);
    double h = log(misfit(p, key, &size, &shift) / p->goal.c->power + 1e-12);
    return isfinite(h) ? h : log(DBL_MAX);
}

/* --- search -------------------------------------------------------------------------------- */

typedef struct start {
    double height, u[CANDIDATE_KEYS];
} start;

static ss_status
scatter(start *s, size_t starts, size_t free, problem *p)
{
    gsl_qrng *sobol = gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)free);
    if (sobol == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < starts; i++) {
        gsl_vector_view u = gsl_vector_view_array(s[i].u, free);
        gsl_qrng_get(sobol, s[i].u);            /* the middle comes first */
        for (size_t k = 0; k < free; k++)
            s[i].u[k] = asin(2 * s[i].u[k] - 1);
        s[i].height = height(&u.vector, p);
    }
    gsl_qrng_free(sobol);
    qsort(s, starts, sizeof *s, ss_ascending);
    return p->status;
}

static ss_status
descend(start *s, size_t free, size_t steps, problem *p)
{
    double first[CANDIDATE_KEYS] = { 0.3, 0.3, 0.3, 0.3 };     /* of the range: about a seventh */
    gsl_vector_view u = gsl_vector_view_array(s->u, free);
    gsl_vector_view step = gsl_vector_view_array(first, free);
    gsl_multimin_function f = { height, free, p };
    gsl_multimin_fminimizer *m = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2,
                                                               free);
    if (m == NULL)
        return SS_ENOMEM;
    int failed = gsl_multimin_fminimizer_set(m, &f, &u.vector, &step.vector);
    for (size_t i = 0; !failed && i < steps && gsl_multimin_fminimizer_size(m) > SMALL; i++)
        failed = gsl_multimin_fminimizer_iterate(m);
    if (m->fval < s->height) {
        s->height = m->fval;
        memcpy(s->u, m->x->data, free * sizeof *s->u);
    }
    gsl_multimin_fminimizer_free(m);
    return p->status;
}

/* Append the keys of u to c->start, unless they are those of a start there, to within SAME. */
static void
keep_start(problem *p, const double *u)
{
    candidate *c = p->c;
    candidate_start *s = &c->start[c->n_starts];
    keys_of(c, u, s->key);
    for (size_t i = 0; i < c->n_starts; i++) {
        double farthest = 0;
        for (size_t k = 0; k < c->n; k++)
            farthest = fmax(farthest, fabs(s->key[k] - c->start[i].key[k]));
        if (farthest < SAME)
            return;
    }
    s->misfit = misfit(p, s->key, &s->size, &s->shift);
    c->n_starts++;
}

ss_status
ss_candidate_search(candidate *c, const cycle *goal, size_t starts, size_t keep, size_t steps,
                    const ss_stretch *progress)
{
    start s[STARTS_MOST];
    /* a step of the simplex runs the scene once or twice */
    problem p = { .c = c, .progress = progress, .expected = (double)(starts + 3 * keep * steps / 2) };
    size_t free = 0;
    ss_status st = ss_cycle_goal_new(&p.goal, goal);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < c->n; i++)
        free += c->hi[i] > c->lo[i];
    memset(&s[0], 0, sizeof s[0]);
    if (free > 0) {
        st = scatter(s, starts, free, &p);
        for (size_t i = 0; st == SS_OK && i < keep; i++)
            st = descend(&s[i], free, steps, &p);
        qsort(s, keep, sizeof *s, ss_ascending);
    }
    for (size_t i = 0; st == SS_OK && i < (free > 0 ? keep : 1); i++) {
        keep_start(&p, s[i].u);
        st = p.status;
    }
    ss_cycle_goal_free(&p.goal);
    return st;
}

ss_scene
ss_candidate_resized(const candidate *c, ss_scene s, double size)
{
    s.friction *= size;
    s.static_friction *= size;
    s.base_amplitude *= size;
    s.x0 *= size;
    s.v0 *= size;
    for (size_t i = 0; i < c->model->n_parameters; i++)
        if (c->model->parameter[i].by_speed > 0)
            *own(c, &s, i) /= size;
        else if (c->model->parameter[i].by_speed < 0)
            *own(c, &s, i) *= size;
    return s;
}

double
ss_candidate_distance(const candidate *c, const double key[CANDIDATE_KEYS])
{
    double sum = 0, of_mass = 0, squares = 0;
    for (size_t i = 0; i < c->n; i++) {
        double d = key[i] - c->own[i];
        int by_mass = i == CANDIDATE_STIFFNESS
                      || (i >= CANDIDATE_OWN && c->model->parameter[i - CANDIDATE_OWN].by_mass);
        sum += by_mass ? d : 0;
        of_mass += by_mass;
        squares += d * d;
    }
    /* d + mu for those that go by mass, and mu: least at mu = -sum / (of_mass + 1) */
    return sqrt(fmax(squares - sum * sum / (of_mass + 1), 0) / (double)(c->n + 1));
}

const char *
ss_candidate_key_name(const candidate *c, size_t key)
{
    if (key == CANDIDATE_STIFFNESS)
        return "stiffness";
    if (key == CANDIDATE_RATIO)
        return "friction / (stiffness base_amplitude)";
    return ss_key_of_field(c->model, c->model->parameter[key - CANDIDATE_OWN].offset)->name;
}
