/* forced.c -- a scene whose base moves, and its variants.
 *
 * The parameters of the measured rig differ from those of the scene by some tenths, so a model is
 * judged by its best fit within this range.  Motion is proportional to f_k and Z_e together, if alpha
 * decreases as they increase: two to four numbers, and size and phase, remain to be found.
 *
 * A fit to a record starts from its mean cycle.
 * Size and phase of a cycle are free and found in closed form (cycle.c).  Events move, appear and vanish as
 * the keys change, so the misfit has steps and creases, and its derivative is of no use.  The search
 * therefore tries points all over the ranges (Sobol's, always the same), and continues with a simplex
 * (Nelder and Mead 1965) from the best of them. */
#include "fit/forced.h"

#include <float.h>
#include <gsl/gsl_multimin.h>
#include <gsl/gsl_qrng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "scene/model.h"

enum { STEPS = 40 };            /* of a simplex, at most */

/* Parameter i of the model. */
static double *
own(const forced *c, ss_scene *s, size_t i)
{
    return number_at(s, c->model->parameter[i].offset);
}

static double
drive_of(const ss_scene *scene)
{
    return scene->stiffness * scene->base_amplitude;
}

/* f_s over f_k, which no change of f_k changes. */
static double
static_ratio(const ss_scene *scene)
{
    return scene->friction > 0 ? static_friction(scene) / scene->friction : 1;
}

ss_status
ss_forced_check(const ss_scene *scene, ss_error *err)
{
    ss_scene rest = *scene;
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK && ss_scene_is_pulled(scene))
        return ss_fail(err, SS_EINVAL, "pulled scenes are ranked among themselves only, and fitted by their "
                       "slips");
    if (st == SS_OK && !(drive_of(scene) > 0))
        return ss_fail(err, SS_EINVAL, "base_amplitude = 0: such a scene has no cycle to compare");
    rest.damping = rest.static_friction = 0;            /* terms that are held; no other is allowed for */
    const char *term = st == SS_OK ? ss_scene_term(&rest) : NULL;
    return term == NULL ? st : ss_fail(err, SS_EINVAL, "a scene with %s is not adjusted to a signal", term);
}

forced
ss_forced_of(const ss_scene *scene, int pick, double factor)
{
    forced c = { .model = scene->model, .scene = *scene, .pick = pick, .budget = INFINITY };
    ss_scene *s = &c.scene;
    if (c.model->normalise != NULL)
        c.model->normalise(s);
    double key[FORCED_KEYS] = { s->stiffness, s->friction / drive_of(s) };
    c.n = FORCED_OWN + c.model->n_parameters;
    for (size_t i = 0; i < c.model->n_parameters; i++)
        key[FORCED_OWN + i] = *own(&c, s, i);
    for (size_t i = 0; i < c.n; i++) {
        int by_speed = i >= FORCED_OWN && c.model->parameter[i - FORCED_OWN].by_speed != 0;
        double wide = log(factor) * (by_speed ? 1.5 : 1);   /* the speed is as free as Z_e is */
        c.own[i] = log(fmax(key[i], 1e-300));   /* no friction or damping is as good as too little to see */
        c.range[i] = (ss_range){ c.own[i] - wide, c.own[i] + wide };
    }
    double most = -log(static_ratio(s));
    if (c.range[FORCED_RATIO].from < most)      /* f_s > k Z_e: nothing slips */
        c.range[FORCED_RATIO].to = fmin(c.range[FORCED_RATIO].to, most);
    return c;
}

ss_scene
ss_forced_scene(const forced *c, const double key[FORCED_KEYS], double period)
{
    ss_scene s = c->scene;
    double drive = drive_of(&s);
    s.stiffness = exp(key[FORCED_STIFFNESS]);
    s.base_amplitude = drive / s.stiffness;
    s.friction = drive * exp(key[FORCED_RATIO]);
    s.static_friction = s.static_friction > 0 ? s.friction * static_ratio(&c->scene) : 0;
    s.base_frequency = 1 / period;
    for (size_t i = 0; i < c->model->n_parameters; i++)
        *own(c, &s, i) = exp(key[FORCED_OWN + i]);
    s.phase = s.x0 = s.v0 = 0;
    s.settle = FORCED_SETTLE * period;
    return s;
}

ss_scene
ss_forced_resized(const forced *c, ss_scene s, double size)
{
    s.friction *= size;
    s.static_friction *= size;
    s.base_amplitude *= size;
    s.x0 *= size;
    s.v0 *= size;
    for (size_t i = 0; i < c->model->n_parameters; i++)
        *own(c, &s, i) *= pow(size, -c->model->parameter[i].by_speed);
    return s;
}

double
ss_forced_distance(const forced *c, const double key[FORCED_KEYS])
{
    double sum = 0, of_mass = 0, squares = 0;
    for (size_t i = 0; i < c->n; i++) {
        double d = key[i] - c->own[i];
        int by_mass = i == FORCED_STIFFNESS || (i >= FORCED_OWN && c->model->parameter[i - FORCED_OWN].by_mass);
        sum += by_mass ? d : 0;
        of_mass += by_mass;
        squares += d * d;
    }
    /* d + mu for those that go by mass, and mu: least at mu = -sum / (of_mass + 1) */
    return sqrt(fmax(squares - sum * sum / (of_mass + 1), 0) / (double)(c->n + 1));
}

const char *
ss_forced_key_name(const forced *c, size_t key)
{
    return key == FORCED_STIFFNESS ? "stiffness" : key == FORCED_RATIO ? "friction / (stiffness base_amplitude)"
        : ss_key_of_field(c->model, c->model->parameter[key - FORCED_OWN].offset)->name;
}

typedef struct search {
    forced *c;
    const cycle *cycle;
    cycle_goal goal;
    double runs, expected;      /* so far, and about how many there will be */
    ss_status status;           /* SS_ENOMEM or SS_STOP; other failures of a run count as a bad fit */
} search;

/* A point of the search: the free keys without their ranges, and the logarithm of the misfit: with it a simplex
 * descends into valleys of 20 and of 60 dB alike. */
typedef struct point {
    double height, w[FORCED_KEYS];
} point;

static void
run_point(search *p, const double *w, forced_start *s)
{
    forced *c = p->c;
    double value[CYCLE_MOST];
    for (size_t i = 0, k = 0; i < c->n; i++) {          /* w goes into the ranges of the keys that are free */
        const double width = c->range[i].to - c->range[i].from;
        s->key[i] = c->range[i].from + (width > 0 ? width * (0.5 + 0.5 * sin(w[k++])) : 0);
    }
    s->misfit = p->cycle->power;
    s->size = s->shift = 0;
    if (p->status == SS_OK)
        p->status = ss_stretch_at(&c->progress, fmin(p->runs++ / p->expected, 1));
    if (p->status != SS_OK || c->steps > c->budget)
        return;
    ss_scene scene = ss_forced_scene(c, s->key, p->cycle->period);
    scene.duration = p->cycle->period;
    scene.rate = (double)p->cycle->n / p->cycle->period;
    ss_status st = ss_samples_run(&scene, c->pick, SAMPLES_COARSE, value, NULL, p->cycle->n, &c->steps);
    if (st == SS_ENOMEM)
        p->status = SS_ENOMEM;
    if (st == SS_OK)
        s->misfit = ss_cycle_misfit(&p->goal, value, &s->size, &s->shift);
}

static double
height(const gsl_vector *w, void *user)
{
    search *p = user;
    forced_start s;
    run_point(p, w->data, &s);
    double h = log(s.misfit / p->cycle->power + 1e-12);
    return isfinite(h) ? h : log(DBL_MAX);
}

ss_status
ss_forced_search(forced_start start[FORCED_KEPT], size_t *n, forced *c, const cycle *goal, size_t points,
                 size_t keep)
{
    /* a step of the simplex runs the scene once or twice */
    search p = { .c = c, .cycle = goal, .expected = (double)(points + 3 * keep * STEPS / 2) };
    double first[FORCED_KEYS] = { 0.3, 0.3, 0.3, 0.3 };     /* of the range: about a seventh */
    point *at = calloc(points + 1, sizeof *at);
    size_t dim = 0;
    *n = 0;
    ss_status st = at != NULL ? ss_cycle_goal_new(&p.goal, goal) : SS_ENOMEM;
    if (st != SS_OK) {
        free(at);
        return st;
    }
    for (size_t i = 0; i < c->n; i++)
        dim += c->range[i].to > c->range[i].from;
    gsl_qrng *sobol = dim > 0 ? gsl_qrng_alloc(gsl_qrng_sobol, (unsigned)dim) : NULL;
    gsl_multimin_fminimizer *m = NULL;
    if (dim > 0)
        m = gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, dim);
    if (dim > 0 && (sobol == NULL || m == NULL))
        p.status = SS_ENOMEM;
    for (size_t i = 0; dim > 0 && p.status == SS_OK && i < points; i++) {
        gsl_vector_view w = gsl_vector_view_array(at[i].w, dim);
        gsl_qrng_get(sobol, at[i].w);           /* the middle comes first */
        for (size_t k = 0; k < dim; k++)
            at[i].w[k] = asin(2 * at[i].w[k] - 1);
        at[i].height = height(&w.vector, &p);
    }
    qsort(at, points, sizeof *at, ss_ascending);
    for (size_t i = 0; dim > 0 && p.status == SS_OK && i < keep; i++) {
        gsl_vector_view w = gsl_vector_view_array(at[i].w, dim), step = gsl_vector_view_array(first, dim);
        gsl_multimin_function f = { height, dim, &p };
        int failed = gsl_multimin_fminimizer_set(m, &f, &w.vector, &step.vector);
        for (size_t k = 0; !failed && k < STEPS && gsl_multimin_fminimizer_size(m) > FAINT; k++)
            failed = gsl_multimin_fminimizer_iterate(m);
        if (m->fval < at[i].height) {
            at[i].height = m->fval;
            memcpy(at[i].w, m->x->data, dim * sizeof *at[i].w);
        }
    }
    qsort(at, keep, sizeof *at, ss_ascending);
    while (p.status == SS_OK && *n < (dim > 0 ? keep : 1)) {
        run_point(&p, at[*n].w, &start[*n]);
        ++*n;
    }
    if (sobol != NULL)
        gsl_qrng_free(sobol);
    if (m != NULL)
        gsl_multimin_fminimizer_free(m);
    ss_cycle_goal_free(&p.goal);
    free(at);
    return p.status;
}
