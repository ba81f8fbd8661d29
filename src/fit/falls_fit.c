/* falls_fit.c -- fit a scene that is pulled to the falls of its spring's force, by simulation.
 *
 * In every measured pull, static and kinetic friction differ from slip to slip; the rig and its
 * law do not.  So onset, f_s and f_k of each fall, and mass, speed, damping and the numbers of the
 * law of all of them, are found by one least-squares fit (GSL's, Levenberg and Marquardt's) to the
 * samples about the falls.  The stiffness is held: a force shows k/m and k U only.  A scene is
 * simulated with the frictions of a fall until it has settled, which takes one slip or a few, and
 * its force is laid over the samples: any scene that sticks and slips can be fitted so.
 *
 * The slope of loading is known from the whole sticks, better than from the samples about the
 * falls: it is one datum more for each fall, but where a contact may ring in the stick.  Where the
 * scene knows its rig to within a factor, each of its numbers is one, too: then a number that the
 * falls do not tell stays where it is. */
#include "fit/falls.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "find/medians.h"
#include "scene/model.h"
#include "fit/fall_run.h"

enum { LOCAL = FALL_UNKNOWNS, ONSET = 0, MIDDLE, HALF };
enum { STEPS = 60 };            /* in a stage of the fit, at most */
#define LEAST 2                 /* f_k over f_s - f_k in a simulation: see fill_rows */
#define BENT 0.01               /* relative error of the slope of loading if slips are no Coulomb slips */
#define FAR 5                   /* spreads: a scene whose key changes by more is another scene */
#define FARTHEST 1e3            /* the largest factor of a key if there is no spread */
#define LITTLE 1e-4             /* a stage ends if a step lessens the residual by no larger part, */
#define LITTLE_NOISE 0.01       /* or by no larger part of the noise of a sample */
#define NEARLY 0.05             /* relative error of a fall's height from which the fit may start */
#define HELD 0.01               /* a change of a held key by so much costs all of the power */
#define DIFFERENCE 1e-4         /* of an unknown, for its slopes */
#define HOPELESS 1e3            /* rms residual of a scene that does not slip, re the fall's */

/* --- unknowns ------------------------------------------------------------------------------ */

typedef struct problem {
    const falls *r;
    const ss_scene *scene;
    falls_fit *out;
    double spread, budget, *steps;
    double noise;               /* variance, in the units of rows */
    double farthest;            /* the largest change of a key */
    int stage;                  /* of the fit */
    double held[FALLS_KEYS];    /* the keys at the begin of the stage: it moves only those that are free */
    double size;                /* the unit of rows, so that their squares are parts of the power */
    double (*start)[LOCAL];     /* the locals of each fall from which the fit starts */
    size_t rows;
    double *changed;            /* the rows of a fall with one unknown changed */
    double *time;               /* at which the scene's fall comes, for each fall [s] */
    const ss_stretch *progress;
    ss_status status;
} problem;

static void
add_key(falls_fit *out, size_t offset, int power, double own)
{
    out->key[out->n_keys++] = (falls_key){ .offset = offset, .power = power, .own = own };
}

enum { MASS, SPEED };           /* the first keys */

static void
list_keys(falls_fit *out, const ss_scene *scene)
{
    const struct model *model = ss_model_of(scene);
    ss_scene s = *scene;
    size_t pull = s.base_velocity != 0 ? offsetof(ss_scene, base_velocity)
                                       : offsetof(ss_scene, surface_velocity);
    out->n_keys = 0;
    add_key(out, offsetof(ss_scene, mass), 1, s.mass);
    add_key(out, pull, -1, fabs(pull_of(&s)));
    if (s.damping > 0)
        add_key(out, offsetof(ss_scene, damping), 1, s.damping);
    for (size_t i = 0; i < model->n_parameters; i++) {
        const parameter *p = &model->parameter[i];
        if (*number_at(&s, p->offset) > 0)
            add_key(out, p->offset, p->by_mass + p->by_speed, *number_at(&s, p->offset));
    }
}

/* The scene with the keys changed, from rest without force. */
static ss_scene
scene_of(const problem *f, const double change[])
{
    ss_scene s = *f->scene;
    for (size_t i = 0; i < f->out->n_keys; i++)
        if (i != SPEED)
            *number_at(&s, f->out->key[i].offset) = f->out->key[i].own * exp(change[i]);
    double speed = f->out->key[SPEED].own * exp(change[SPEED]) * sign(pull_of(f->scene));
    if (f->scene->base_velocity != 0)
        s.base_velocity = s.surface_velocity + speed;
    else
        s.surface_velocity = -speed;
    s.x0 = s.phase = 0;
    s.v0 = s.surface_velocity;
    return s;
}

/* The rows of a fall: its samples, and the slope of its loading. */
static size_t
rows_of(const fall *w)
{
    return w->n + 1;
}

/* The error of the slope of loading [N/s].  The slope is read between the ends of Coulomb slips; the slips of
 * another law may begin and end elsewhere. */
static double
slope_error(const falls *r)
{
    return hypot(r->slope.error, BENT * r->slope.value);
}

/* Write the residuals of a fall.  The scene's fall comes at *time; NaN: find it.  As long as a slider never
 * slips back, a constant may be subtracted from f_s and f_k: the force is less by the same constant, and the
 * first stick is shorter. */
static void
fill_rows(problem *f, size_t i, const double change[], const double local[LOCAL], double *time, double *row)
{
    const fall *w = &f->r->fall[i];
    const double rate = f->r->rate / (double)w->step;
    const size_t before = (size_t)fmax((local[ONSET] - (double)w->first) / (double)w->step, 0);
    ss_scene s = scene_of(f, change);
    s.friction = fmax(fmin(local[MIDDLE], LEAST * local[HALF]), 0);
    s.static_friction = s.friction + local[HALF];
    int valid = ss_scene_check(&s, NULL) == SS_OK && *f->steps < f->budget;
    for (size_t k = 0; k < f->out->n_keys; k++)
        valid = valid && fabs(change[k]) <= f->farthest;
    if (valid && isnan(*time))
        *time = ss_fall_find(&s, f->steps, &f->status);
    if (!valid || isnan(*time)
        || !ss_fall_sample(row, &s, *time, local[ONSET], w, f->r->rate, f->steps, &f->status)) {
        for (size_t k = 0; k < rows_of(w); k++)
            row[k] = HOPELESS * sqrt(f->r->power) / f->size;
        return;
    }
    int is_straight = before > 0 && before < w->n && !ss_model_of(&s)->has_contact;
    double slope = is_straight ? (row[before] - row[0]) * rate / (double)before : f->r->slope.value;
    row[w->n] = (slope - f->r->slope.value) / slope_error(f->r);
    row[w->n] *= sqrt(f->noise / (double)f->r->n);
    for (size_t k = 0; k < w->n; k++)
        row[k] = (row[k] + local[MIDDLE] - s.friction - f->r->y[w->first + k * w->step]) / f->size;
}

/* The unknowns of the fit are the changes of the keys, then the changes of the locals of each fall: those of
 * onset and f_k in this unit, that of f_s - f_k as a logarithm. */
static double
unit_of(const fall *w, size_t k)
{
    return k == ONSET ? (double)(w->n * w->step) / 8 : w->top - w->middle;
}

static void
locals_of(const problem *f, const gsl_vector *at, size_t i, double local[LOCAL])
{
    const double *u = at->data + f->out->n_keys + LOCAL * i;
    local[ONSET] = f->start[i][ONSET] + u[ONSET] * unit_of(&f->r->fall[i], ONSET);
    local[MIDDLE] = f->start[i][MIDDLE] + u[MIDDLE] * unit_of(&f->r->fall[i], MIDDLE);
    local[HALF] = f->start[i][HALF] * exp(u[HALF]);
}

/* The stages: first the frictions alone are free, then also mass and speed, then all keys. */
enum { STAGES = 3 };
static const size_t FREE_AT[STAGES] = { 0, SPEED + 1, FALLS_KEYS };

static int
is_held(const problem *f, size_t key)
{
    return key >= FREE_AT[f->stage];
}

/* The weight of the row that says what is known of a key. */
static double
weight_of(const problem *f, size_t key)
{
    return is_held(f, key) ? 1 / HELD : sqrt(f->noise) / f->spread;
}

static int
residuals(const gsl_vector *at, void *user, gsl_vector *out)
{
    problem *f = user;
    double local[LOCAL], *row = out->data;
    for (size_t i = 0; i < f->r->n; i++) {
        locals_of(f, at, i, local);
        f->time[i] = NAN;
        fill_rows(f, i, at->data, local, &f->time[i], row);
        row += rows_of(&f->r->fall[i]);
    }
    for (size_t k = 0; k < f->out->n_keys; k++)
        *row++ = weight_of(f, k) * (at->data[k] - (is_held(f, k) ? f->held[k] : 0));
    return f->status == SS_OK ? GSL_SUCCESS : GSL_EFAILED;
}

/* The slopes of one fall's rows, from row `first` on, by one unknown. */
static void
fill_column(problem *f, size_t i, const gsl_vector *at, size_t column, size_t first, const double *here,
            gsl_matrix *out)
{
    const size_t keys = f->out->n_keys, k = column < keys ? LOCAL : (column - keys) % LOCAL;
    double change[FALLS_KEYS], local[LOCAL], time = k == ONSET ? f->time[i] : NAN;
    memcpy(change, at->data, keys * sizeof *change);
    locals_of(f, at, i, local);
    if (k == LOCAL)
        change[column] += DIFFERENCE;
    else
        local[k] += DIFFERENCE * (k == HALF ? local[HALF] : unit_of(&f->r->fall[i], k));
    fill_rows(f, i, change, local, &time, f->changed);
    for (size_t n = 0; n < rows_of(&f->r->fall[i]); n++)
        gsl_matrix_set(out, first + n, column, (f->changed[n] - here[n]) / DIFFERENCE);
}

static int
jacobian(const gsl_vector *at, void *user, gsl_matrix *out)
{
    problem *f = user;
    const size_t keys = f->out->n_keys;
    size_t first = 0;
    gsl_vector *here = gsl_vector_alloc(f->rows);
    if (here == NULL)
        return GSL_ENOMEM;
    gsl_matrix_set_zero(out);
    residuals(at, f, here);
    for (size_t i = 0; i < f->r->n; i++) {
        for (size_t k = 0; k < keys; k++)
            fill_column(f, i, at, k, first, here->data + first, out);
        for (size_t k = 0; k < LOCAL; k++)
            fill_column(f, i, at, keys + LOCAL * i + k, first, here->data + first, out);
        first += rows_of(&f->r->fall[i]);
    }
    for (size_t k = 0; k < keys; k++)
        gsl_matrix_set(out, first + k, k, weight_of(f, k));
    gsl_vector_free(here);
    if (f->status == SS_OK)
        f->status = ss_stretch_at(f->progress, fmin(*f->steps / f->budget, 1));
    return f->status == SS_OK ? GSL_SUCCESS : GSL_EFAILED;
}

/* --- the fit ------------------------------------------------------------------------------- */

/* The height of a fall of the scene; NAN: it has none. */
static double
height_of(problem *f, size_t i, const double change[])
{
    const fall *w = &f->r->fall[i];
    double time = NAN, low = INFINITY, high = -INFINITY;
    fill_rows(f, i, change, f->start[i], &time, f->changed);
    for (size_t k = 0; k < w->n; k++) {
        double y = f->r->y[w->first + k * w->step] + f->changed[k] * f->size;
        low = fmin(low, y), high = fmax(high, y);
    }
    return isnan(time) ? NAN : high - low;
}

/* Find where the fit of a fall starts: at its onset, with the f_s that the force has there, and the f_k with
 * which the scene falls as far as the force does.  If f_s is little more than f_k, a scene may slide without
 * falls; its least fall may be too high.  Then the fit starts from this least fall. */
static void
start_fall(problem *f, size_t i, const double change[])
{
    enum { PASSES = 8 };
    const ss_scene s = scene_of(f, change);
    const fall *w = &f->r->fall[i];
    const double fallen = 2 * (w->top - w->middle), top = w->top - fabs(s.damping * s.surface_velocity)
                                                         * sign(s.surface_velocity * pull_of(&s));
    double *local = f->start[i], half = 0.5 * fallen, slides = 0, slips = INFINITY;
    local[ONSET] = w->onset;
    for (int pass = 0; pass < PASSES; pass++) {
        local[HALF] = half;
        local[MIDDLE] = top - half;
        double height = height_of(f, i, change);
        if (fabs(fallen / height - 1) < NEARLY)
            return;
        if (isnan(height)) {
            slides = half;
            half = isinf(slips) ? 2 * half : sqrt(half * slips);
        } else {
            slips = half;
            half = fmax(half * fmax(fmin(fallen / height, 2), 0.5), sqrt(slides * half));
        }
    }
    local[HALF] = isinf(slips) ? half : slips;
    local[MIDDLE] = top - local[HALF];
}

/* Start from the mass and the speed that the record's slope and k/m give, and the scene's other keys. */
static void
start(problem *f, gsl_vector *at)
{
    const falls *r = f->r;
    const ss_scene *s = f->scene;
    falls_fit *o = f->out;
    const double most = 0.9 * f->farthest, speed = r->slope.value / s->stiffness / o->key[SPEED].own;
    gsl_vector_set_zero(at);
    if (r->k_over_m.value > 0) {
        double mass = s->stiffness / r->k_over_m.value / o->key[MASS].own;
        gsl_vector_set(at, MASS, fmax(-most, fmin(log(mass), most)));
    }
    gsl_vector_set(at, SPEED, fmax(-most, fmin(log(speed), most)));
    for (size_t i = 0; i < r->n; i++)
        start_fall(f, i, at->data);
}

/* The covariance of f_k or f_s of two falls. */
static double
covariance_of(const problem *f, const gsl_vector *at, const gsl_matrix *covariance, size_t i, size_t j,
              int is_static)
{
    size_t a = f->out->n_keys + LOCAL * i + MIDDLE, b = f->out->n_keys + LOCAL * j + MIDDLE;
    double middle_i = unit_of(&f->r->fall[i], MIDDLE), middle_j = unit_of(&f->r->fall[j], MIDDLE);
    double of_i[LOCAL], of_j[LOCAL];
    locals_of(f, at, i, of_i);
    locals_of(f, at, j, of_j);
    double sum = middle_i * middle_j * gsl_matrix_get(covariance, a, b);
    if (is_static)
        sum += of_i[HALF] * of_j[HALF] * gsl_matrix_get(covariance, a + 1, b + 1)
               + middle_i * of_j[HALF] * gsl_matrix_get(covariance, a, b + 1)
               + of_i[HALF] * middle_j * gsl_matrix_get(covariance, a + 1, b);
    return sum;
}

/* The median of f_k or f_s over the falls.  Its error is that of the scatter, or that of the mean if this is
 * larger: the errors of the keys are common to all falls. */
static ss_median
median_of(const problem *f, const gsl_vector *at, const gsl_matrix *covariance, int is_static)
{
    const size_t n = f->r->n;
    ss_value v[FALLS_MOST] = { { 0, 0 } };
    double scratch[FALLS_MOST], local[LOCAL], sum = 0;
    for (size_t i = 0; i < n; i++) {
        locals_of(f, at, i, local);
        v[i] = (ss_value){ local[MIDDLE] + (is_static ? local[HALF] : 0), NAN };
        for (size_t j = 0; j < n; j++)
            sum += covariance_of(f, at, covariance, i, j, is_static);
    }
    ss_median m = ss_median_of(v, n, scratch);
    m.error = fmax(m.error, sqrt(fmax(sum, 0)) / (double)n);
    return m;
}

/* Find the mean square of the residuals of samples. */
static void
find_left(problem *f, const gsl_vector *left)
{
    falls_fit *o = f->out;
    double squares = 0;
    const double *row = left->data;
    for (size_t i = 0; i < f->r->n; i++) {
        for (size_t k = 0; k < f->r->fall[i].n; k++)
            squares += row[k] * row[k];
        o->compared += f->r->fall[i].n;
        row += rows_of(&f->r->fall[i]);
    }
    o->left = squares * f->size * f->size / ((double)o->compared - (double)(o->n_keys + LOCAL * f->r->n));
}

static void
report(problem *f, const gsl_multifit_nlinear_workspace *space, gsl_matrix *covariance)
{
    falls_fit *o = f->out;
    const gsl_vector *at = gsl_multifit_nlinear_position(space);
    find_left(f, gsl_multifit_nlinear_residual(space));
    gsl_multifit_nlinear_covar(gsl_multifit_nlinear_jac(space), 0, covariance);
    gsl_matrix_scale(covariance, fmax(o->left, f->r->noise) / (f->size * f->size));
    for (size_t k = 0; k < o->n_keys; k++) {
        o->key[k].change = gsl_vector_get(at, k);
        o->key[k].error = sqrt(gsl_matrix_get(covariance, k, k));
    }
    o->friction = median_of(f, at, covariance, 0);
    o->static_friction = median_of(f, at, covariance, 1);
    o->scene = scene_of(f, at->data);
    o->scene.friction = o->friction.value;
    o->scene.static_friction = o->static_friction.value;
    o->scene.settle = ss_fall_find(&o->scene, f->steps, &f->status) - f->r->first;
    o->scene.duration = o->scene.rate = 1;
    o->slips = o->scene.settle >= 0 && ss_scene_check(&o->scene, NULL) == SS_OK
               && o->left < f->r->power;
}

static double
squares_of(const gsl_multifit_nlinear_workspace *space)
{
    double norm = gsl_blas_dnrm2(gsl_multifit_nlinear_residual(space));
    return norm * norm;
}

/* Step until a step gains little beside the noise of a sample, or beside the residual above the noise. */
static int
descend(const problem *f, gsl_multifit_nlinear_workspace *space)
{
    double left = squares_of(space), before = INFINITY;
    int ended = GSL_SUCCESS;
    for (int i = 0; i < STEPS && ended == GSL_SUCCESS; i++) {
        if (before - left < LITTLE_NOISE * f->noise + LITTLE * fmax(left - 2 * f->noise * (double)f->rows, 0))
            break;
        before = left;
        ended = gsl_multifit_nlinear_iterate(space);
        left = squares_of(space);
    }
    return ended;
}

static ss_status
solve(problem *f)
{
    const size_t n = f->out->n_keys + LOCAL * f->r->n;
    gsl_multifit_nlinear_parameters how = gsl_multifit_nlinear_default_parameters();
    how.solver = gsl_multifit_nlinear_solver_cholesky;      /* the cheapest */
    gsl_multifit_nlinear_fdf least = { .f = residuals, .df = jacobian, .n = f->rows, .p = n, .params = f };
    gsl_multifit_nlinear_workspace *space =
        gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &how, f->rows, n);
    gsl_matrix *covariance = gsl_matrix_alloc(n, n);
    gsl_vector *at = gsl_vector_alloc(n);
    int ended = space != NULL && covariance != NULL && at != NULL ? GSL_SUCCESS : GSL_ENOMEM;
    if (ended == GSL_SUCCESS)
        start(f, at);
    for (f->stage = 0; f->stage < STAGES && ended != GSL_ENOMEM && f->status == SS_OK; f->stage++) {
        memcpy(f->held, at->data, f->out->n_keys * sizeof *f->held);
        ended = gsl_multifit_nlinear_init(at, &least, space);
        if (ended == GSL_SUCCESS)
            ended = descend(f, space);
        gsl_vector_memcpy(at, gsl_multifit_nlinear_position(space));
    }
    if (ended == GSL_SUCCESS || ended == GSL_ENOPROG)
        report(f, space, covariance);
    gsl_vector_free(at);
    gsl_matrix_free(covariance);
    gsl_multifit_nlinear_free(space);
    return ended == GSL_ENOMEM ? SS_ENOMEM : f->status;
}

ss_status
ss_falls_fit(falls_fit *out, const falls *r, const ss_scene *scene, double spread, double budget,
             double *steps, const ss_stretch *progress)
{
    double first[FALLS_MOST][LOCAL];
    problem f = { .start = first, .r = r, .scene = scene, .out = out, .spread = spread, .budget = budget,
                  .steps = steps, .progress = progress };
    size_t most = 0;
    *out = (falls_fit){ .slips = 0 };
    if (!ss_model_has_events(scene->model))
        return SS_OK;
    list_keys(out, scene);
    for (size_t i = 0; i < r->n; i++) {
        f.rows += rows_of(&r->fall[i]);
        most = rows_of(&r->fall[i]) > most ? rows_of(&r->fall[i]) : most;
    }
    f.rows += out->n_keys;
    f.size = sqrt(r->power * (double)f.rows);
    f.noise = r->noise / (f.size * f.size);
    f.farthest = fmin(FAR * spread, log(FARTHEST));
    f.changed = malloc((most + r->n + 1) * sizeof *f.changed);
    f.time = f.changed + most;
    ss_status st = f.changed != NULL ? solve(&f) : SS_ENOMEM;
    free(f.changed);
    return st;
}
