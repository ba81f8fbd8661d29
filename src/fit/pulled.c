/* pulled.c -- fit a scene that is pulled to the falls of its spring's force, by simulation.
 *
 * In every measured pull, static and kinetic friction differ from slip to slip; the rig and its law do not.
 * So onset, f_s and f_k of each fall, and mass, speed, damping and the numbers of the law of all of them, are
 * found by one least-squares fit to the samples about the falls.  The stiffness is held: a force shows k/m
 * and k U only.  A scene is simulated with the frictions of a fall, from rest without force, until it has
 * settled, which takes one slip or a few; then again to the samples of that fall, which lie over those of the
 * record: any scene that sticks and slips can be fitted so.
 *
 * The slope of loading is known from the whole sticks, better than from the samples about the falls: it is
 * one datum more for each fall, but where a contact may ring in the stick.  Where the scene knows its rig to
 * within a factor, each of its numbers is one, too: then a number that the falls do not tell stays where it
 * is. */
#include "fit/pulled.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"
#include "find/judgement.h"
#include "find/medians.h"
#include "scene/model.h"

#define LEAST 2                 /* f_k over f_s - f_k in a simulation: see fall_rows */
#define FAR 5                   /* spreads: a scene whose key changes by more is another scene */
#define FARTHEST 1e3            /* the largest factor of a key if there is no spread */
#define DIFFERENCE 1e-4         /* of an unknown, for its slopes */
enum { SETTLED = 4 };           /* the fall that is settled: a contact may ring for long */
#define PATIENCE (2 * SETTLED)  /* times as long as a fall should take, for these to come */

enum { MASS, SPEED };           /* the first keys */
enum { ONSET, MIDDLE, HALF, LOCALS };           /* the unknowns of a fall */

typedef struct problem {
    const falls *r;
    const ss_scene *scene;
    pulled_fit *out;
    double spread, steps, time[FALLS_MOST];     /* at which the scene of each fall falls, of the last residuals */
    const ss_stretch *progress;
} problem;

static void
add_key(pulled_fit *out, const ss_scene *scene, size_t offset, int power, double own)
{
    const char *name = ss_key_of_field(scene->model, offset)->name;
    out->key[out->n_keys++] = (pulled_key){ .name = name, .offset = offset, .power = power, .own = own };
}

static void
list_keys(pulled_fit *out, const ss_scene *scene)
{
    const ss_model *model = scene->model;
    ss_scene s = *scene;
    size_t pull = s.base_velocity != 0 ? offsetof(ss_scene, base_velocity)
                                       : offsetof(ss_scene, surface_velocity);
    add_key(out, scene, offsetof(ss_scene, mass), 1, s.mass);
    add_key(out, scene, pull, -1, fabs(pull_of(&s)));
    if (s.damping > 0)
        add_key(out, scene, offsetof(ss_scene, damping), 1, s.damping);
    for (size_t i = 0; i < model->n_parameters; i++) {
        const parameter *p = &model->parameter[i];
        if (*number_at(&s, p->offset) > 0)
            add_key(out, scene, p->offset, p->by_mass + p->by_speed, *number_at(&s, p->offset));
    }
}

/* The scene with the keys changed, from rest without force. */
static ss_scene
scene_of(const problem *f, const double u[])
{
    ss_scene s = *f->scene;
    for (size_t i = 0; i < f->out->n_keys; i++)
        if (i != SPEED)
            *number_at(&s, f->out->key[i].offset) = f->out->key[i].own * exp(u[i]);
    double speed = f->out->key[SPEED].own * exp(u[SPEED]) * sign(pull_of(f->scene));
    if (f->scene->base_velocity != 0)
        s.base_velocity = s.surface_velocity + speed;
    else
        s.surface_velocity = -speed;
    s.x0 = s.phase = 0;
    s.v0 = s.surface_velocity;
    return s;
}

/* f_k and half the fall of a Coulomb slider, f_s - f_k [N], and the onset [samples] of one fall; as unknowns
 * they have the size of the fall. */
typedef struct local {
    double onset, middle, half;
} local;

static local
local_of(const problem *f, const double u[], size_t i)
{
    const fall *w = &f->r->fall[i];
    const double *v = u + f->out->n_keys + LOCALS * i, height = w->top - w->middle;
    return (local){ w->onset + v[ONSET] * (double)(w->n * w->step) / 8, w->middle + v[MIDDLE] * height,
                    height * exp(v[HALF]) };
}

/* --- the model ----------------------------------------------------------------------------- */

typedef struct waiting {
    double since, least, t;     /* of the last stick's begin, NAN in slip; a stick; of the fall [s] */
    int falls, settled;         /* so far; of a settled motion */
} waiting;

static int
wait_for_fall(const ss_event *e, void *user)
{
    waiting *w = user;
    if (e->kind == SS_SLIP && e->t - w->since >= w->least && ++w->falls == w->settled) {
        w->t = e->t;
        return 1;
    }
    w->since = e->kind == SS_STICK ? e->t : NAN;
    return 0;
}

/* The time of the first settled fall of a scene; NaN: it has none.  SS_ENOMEM. */
static ss_status
find_fall(double *time, const ss_scene *scene, double *steps)
{
    const double loading = fabs(scene->stiffness * pull_of(scene)), period = 2 * M_PI / own_frequency(scene);
    const double reload = 2 * (scene->static_friction - scene->friction) / loading;
    ss_scene s = *scene;
    /* only sticks of a contact that rings are shorter before a fall */
    waiting w = { .least = LITTLE * fmin(reload, period), .t = NAN, .settled = SETTLED };
    ss_sim_stats stats = { .steps = 0 };
    ss_sim_opts opts = ss_samples_opts(scene, SAMPLES_FINE);
    opts.events = wait_for_fall;
    opts.user = &w;
    s.settle = 0;
    s.duration = 2 * s.static_friction / loading + PATIENCE * (reload + period);
    s.rate = 1 / s.duration;
    ss_status st = ss_sim_run(&s, &opts, &stats, NULL);
    *steps += (double)stats.steps;
    *time = w.t;
    return st == SS_ENOMEM ? st : SS_OK;
}

/* The scene of fall i.  As long as a slider never slips back, a constant may be subtracted from f_s and f_k: the
 * force is less by the same constant, and the first stick is shorter. */
static ss_scene
fall_scene(const problem *f, const double u[], size_t i)
{
    const local l = local_of(f, u, i);
    ss_scene s = scene_of(f, u);
    s.friction = fmax(fmin(l.middle, LEAST * l.half), 0);
    s.static_friction = s.friction + l.half;
    return s;
}

/* Find the time at which the scene of fall i falls.  SS_EDATA: never. */
static ss_status
fall_time(problem *f, const double u[], size_t i, double *time)
{
    const ss_scene s = fall_scene(f, u, i);
    if (ss_scene_check(&s, NULL) != SS_OK || f->steps > PULLED_BUDGET)
        return SS_EDATA;
    ss_status st = find_fall(time, &s, &f->steps);
    return st == SS_OK && isnan(*time) ? SS_EDATA : st;
}

/* Write the rows of fall i, at which time the scene falls: one for each sample, and the slope of its loading. */
static ss_status
fall_rows(problem *f, const double u[], size_t i, double time, double *row)
{
    const falls *r = f->r;
    const fall *w = &r->fall[i];
    const local l = local_of(f, u, i);
    const double step = (double)w->step / r->rate, before = floor((l.onset - (double)w->first) / (double)w->step);
    ss_scene s = fall_scene(f, u, i);
    s.settle = time - (l.onset - (double)w->first) / r->rate;
    s.rate = 1 / step;
    s.duration = (double)w->n * step;
    ss_status st = s.settle >= 0 ? ss_samples_run(&s, SS_SPRING, SAMPLES_FINE, row, NULL, w->n, &f->steps)
                                 : SS_EDATA;
    if (st != SS_OK)
        return st == SS_ENOMEM ? st : SS_EDATA;
    /* the slips of another law than Coulomb's may begin and end elsewhere than the slope was read */
    const double error = hypot(r->slope.error, FAINT * r->slope.value), direction = sign(pull_of(&s));
    int is_straight = before >= 1 && before < (double)w->n && !s.model->has_contact;
    double slope = is_straight ? direction * (row[(size_t)before] - row[0]) / (before * step) : r->slope.value;
    row[w->n] = (slope - r->slope.value) / error * sqrt(r->noise / (double)r->n);
    for (size_t k = 0; k < w->n; k++)
        row[k] = direction * row[k] + l.middle - s.friction - r->y[w->first + k * w->step];
    return SS_OK;
}

/* The slopes of the rows of fall i, which begin with row `first`, by one unknown: its own k, or k = LOCALS for a
 * key.  The onset only shifts the motion; f_k only lifts the force, if it is not small. */
static ss_status
fall_slopes(problem *f, size_t i, size_t k, size_t column, size_t first, double *u, const double *here,
            double *changed, double *slopes)
{
    const fall *w = &f->r->fall[i];
    const size_t unknowns = f->out->n_keys + LOCALS * f->r->n;
    const double at = u[column], height = w->top - w->middle;
    const local l = local_of(f, u, i);
    ss_status st = SS_EDATA;
    if (k == MIDDLE && l.middle > LEAST * l.half + DIFFERENCE * height) {
        for (size_t n = 0; n < w->n; n++)
            slopes[(first + n) * unknowns + column] = height;
        return SS_OK;
    }
    for (double h = DIFFERENCE; st == SS_EDATA && h >= -DIFFERENCE; h -= 2 * DIFFERENCE) {
        double time = f->time[i];
        u[column] = at + h;
        st = k == ONSET ? SS_OK : fall_time(f, u, i, &time);
        if (st == SS_OK)
            st = fall_rows(f, u, i, time, changed);
        for (size_t n = 0; st == SS_OK && n <= w->n; n++)
            slopes[(first + n) * unknowns + column] = (changed[n] - here[first + n]) / h;
    }
    u[column] = at;
    return st;
}

/* See least_model.  The unknowns are the changes of the keys, then the locals of each fall. */
static ss_status
falls_model(const double *u, double *residual, double *slopes, void *user)
{
    problem *f = user;
    const size_t keys = f->out->n_keys, unknowns = keys + LOCALS * f->r->n;
    size_t first = 0, most = 0;
    ss_status st = SS_OK;
    for (size_t i = 0; i < f->r->n; i++)
        most = f->r->fall[i].n + 1 > most ? f->r->fall[i].n + 1 : most;
    double *changed = malloc((most + unknowns) * sizeof *changed), *moved = changed + most;
    if (changed == NULL)
        return SS_ENOMEM;
    memcpy(moved, u, unknowns * sizeof *u);
    for (size_t i = 0; st == SS_OK && i < f->r->n; i++) {
        if (slopes == NULL)
            st = fall_time(f, u, i, &f->time[i]);
        if (slopes == NULL && st == SS_OK)
            st = fall_rows(f, u, i, f->time[i], residual + first);
        for (size_t k = 0; st == SS_OK && slopes != NULL && k < LOCALS; k++)
            st = fall_slopes(f, i, k, keys + LOCALS * i + k, first, moved, residual, changed, slopes);
        for (size_t k = 0; st == SS_OK && slopes != NULL && k < keys; k++)
            st = fall_slopes(f, i, LOCALS, k, first, moved, residual, changed, slopes);
        first += f->r->fall[i].n + 1;
    }
    for (size_t k = 0; k < keys; k++) {         /* what the scene knows */
        double weight = sqrt(f->r->noise) / f->spread;
        if (slopes == NULL)
            residual[first + k] = weight * u[k];
        else
            slopes[(first + k) * unknowns + k] = weight;
    }
    free(changed);
    if (st == SS_OK)
        st = ss_stretch_at(f->progress, fmin(f->steps / PULLED_BUDGET, 1));
    return st;
}

/* --- the fit ------------------------------------------------------------------------------- */

/* Find f_s, which the force has at the onset but for a damper's drag, and the f_k with which the scene falls as far
 * as the force does.  If f_s is little more than f_k, a scene may slide without falls; its least fall may be too high.
 * Then it starts from this least fall. */
static ss_status
start_fall(problem *f, size_t i, double *u, double *row)
{
    enum { PASSES = 8 };
    const fall *w = &f->r->fall[i];
    double *v = u + f->out->n_keys + LOCALS * i, height = w->top - w->middle;
    double slides = 0, slips = INFINITY, half = height, time;
    for (int pass = 0; pass <= PASSES; pass++) {
        half = pass < PASSES || isinf(slips) ? half : slips;
        v[HALF] = log(half / height);
        v[MIDDLE] = (w->top - half - w->middle) / height;
        ss_status st = pass < PASSES ? fall_time(f, u, i, &time) : SS_OK;
        if (pass < PASSES && st == SS_OK)
            st = fall_rows(f, u, i, time, row);
        if (st != SS_OK && st != SS_EDATA)
            return st;
        double low = INFINITY, high = -INFINITY;
        for (size_t k = 0; k < w->n; k++) {
            double y = f->r->y[w->first + k * w->step] + row[k];
            low = fmin(low, y), high = fmax(high, y);
        }
        double part = 2 * height / (high - low);
        if (st == SS_OK && fabs(part - 1) < SLIGHT)
            break;
        if (st == SS_EDATA) {
            slides = half;
            half = isinf(slips) ? 2 * half : sqrt(half * slips);
        } else {
            slips = half;
            half = fmax(half * fmax(fmin(part, 2), 0.5), sqrt(slides * half));
        }
    }
    return SS_OK;
}

/* The median of f_k or f_s over the falls.  Its error is that of the scatter, or that of the mean if this is
 * larger: the errors of the keys are common to all falls. */
static ss_number
median_of(const problem *f, const double *u, const double *covariance, int is_static)
{
    const size_t n = f->r->n, keys = f->out->n_keys, unknowns = keys + LOCALS * n;
    ss_value v[FALLS_MOST] = { { 0, 0 } };
    double scratch[FALLS_MOST], slope[LOCALS * FALLS_MOST] = { 0 }, variance = 0;
    for (size_t i = 0; i < n; i++) {
        const local l = local_of(f, u, i);
        v[i] = (ss_value){ l.middle + (is_static ? l.half : 0), NAN };
        slope[LOCALS * i + MIDDLE] = (f->r->fall[i].top - f->r->fall[i].middle) / (double)n;
        slope[LOCALS * i + HALF] = is_static ? l.half / (double)n : 0;
    }
    for (size_t i = 0; i < LOCALS * n; i++)
        for (size_t k = 0; k < LOCALS * n; k++)
            if (slope[i] != 0 && slope[k] != 0)
                variance += slope[i] * slope[k] * covariance[(keys + i) * unknowns + keys + k];
    ss_number m = ss_median_of(v, n, scratch);
    m.error = fmax(m.error, sqrt(fmax(variance, 0)));
    return m;
}

static ss_status
report(problem *f, const double *u, const double *residual, double *covariance)
{
    pulled_fit *o = f->out;
    const size_t unknowns = o->n_keys + LOCALS * f->r->n;
    double squares = 0, compared = 0, time;
    for (size_t i = 0; i < f->r->n; i++) {
        for (size_t k = 0; k < f->r->fall[i].n; k++)
            squares += residual[k] * residual[k];
        compared += (double)f->r->fall[i].n;
        residual += f->r->fall[i].n + 1;
    }
    double left = squares / (compared - (double)unknowns);
    for (size_t i = 0; i < unknowns * unknowns; i++)
        covariance[i] *= fmax(left, f->r->noise);
    for (size_t k = 0; k < o->n_keys; k++) {
        o->key[k].change = u[k];
        o->key[k].error = sqrt(covariance[k * (unknowns + 1)]);
    }
    o->friction = median_of(f, u, covariance, 0);
    o->static_friction = median_of(f, u, covariance, 1);
    o->scene = scene_of(f, u);
    o->scene.friction = o->friction.value;
    o->scene.static_friction = o->static_friction.value;
    ss_status st = find_fall(&time, &o->scene, &f->steps);
    o->scene.settle = time - f->r->first;
    o->scene.duration = o->scene.rate = 1;
    o->slips = o->scene.settle >= 0 && ss_scene_check(&o->scene, NULL) == SS_OK && left < f->r->power;
    if (o->slips)
        o->of_samples = (residue){ left, f->r->power, f->r->noise, compared };
    return st;
}

ss_status
ss_pulled_fit(pulled_fit *out, const falls *r, const ss_scene *scene, double spread, const ss_stretch *progress)
{
    /* first the frictions alone are free, then also mass and speed, then all keys */
    static const size_t free_keys[] = { 0, SPEED + 1, SS_FIT_KEYS };
    const double far = fmin(FAR * spread, log(FARTHEST));
    problem f = { .r = r, .scene = scene, .out = out, .spread = spread, .progress = progress };
    *out = (pulled_fit){ .of_samples = { r->power, r->power, r->noise, 0 } };
    if (!ss_model_has_events(scene->model))
        return SS_OK;
    list_keys(out, scene);
    size_t rows = out->n_keys, m = out->n_keys + LOCALS * r->n;
    for (size_t i = 0; i < r->n; i++)
        rows += r->fall[i].n + 1;
    double *u = calloc(m + m * m + rows, sizeof *u), *covariance = u + m, *residual = covariance + m * m;
    ss_range *range = malloc(m * sizeof *range);
    ss_status st = u != NULL && range != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK) {          /* from the mass and the speed that the record's slope and k/m give */
        const double mass = scene->stiffness / r->k_over_m.value / out->key[MASS].own;
        const double speed = r->slope.value / scene->stiffness / out->key[SPEED].own, near = 0.9 * far;
        if (mass > 0)
            u[MASS] = fmax(-near, fmin(log(mass), near));
        u[SPEED] = fmax(-near, fmin(log(speed), near));
    }
    for (size_t i = 0; st == SS_OK && i < r->n; i++)
        st = start_fall(&f, i, u, residual);
    least fit = { .rows = rows, .unknowns = m, .model = falls_model, .user = &f, .range = range,
                  .tol = 1e-6, .noise = r->noise, .gain = 1e-4 };
    least_end end = { .why = "" };
    for (size_t stage = 0; st == SS_OK && stage < sizeof free_keys / sizeof *free_keys; stage++) {
        for (size_t k = 0; k < m; k++)
            range[k] = k >= out->n_keys ? (ss_range){ -INFINITY, INFINITY }
                     : k < free_keys[stage] ? (ss_range){ -far, far } : (ss_range){ u[k], u[k] };
        st = ss_least_fit(&end, &fit, u, residual, covariance);
    }
    if (st == SS_OK)
        st = report(&f, u, residual, covariance);
    out->unfinished = f.steps > PULLED_BUDGET;
    free(u);
    free(range);
    return st == SS_EDATA ? SS_OK : st;
}
