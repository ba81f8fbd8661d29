/* models.c -- compare a scene with simpler scenes, to find the model that it requires.
 *
 * All scenes have the same clock, so errors are differences of samples.  The maps are those that a
 * plot shows: each is in dB below its own largest |W|, and what lies below the span is blank. */
#include <stickslip/trade.h>

#include <math.h>
#include <stdlib.h>
#include <stickslip/features.h>
#include <stickslip/sweep.h>
#include "base/error.h"
#include "find/numbers.h"
#include "map/map.h"
#include "motion/method.h"
#include "study/curve.h"
#include "study/trade/trade.h"

/* --- what is compared ---------------------------------------------------------------------- */

enum { COLUMNS = 4, A = 2, F = 3, MAP = 2 * COLUMNS };

static const struct { const char *name, *unit; } compared[SS_COMPARED_FEATURES] = {
    { "x", "" }, { "x_rms", "" }, { "v", "" }, { "v_rms", "" },
    { "a", "" }, { "a_rms", "" }, { "f", "" }, { "f_rms", "" },
    [MAP] = { "map", "dB" }, { "map_rms", "dB" },
    [SS_COMPARED_EVENTS] = { "events", "" }, { "microslips", "" },
};

/* The number of ss_features that is compared at place i, or SS_FEATURE_NUMBERS. */
static ss_feature
feature_at(size_t i)
{
    size_t k = SS_TRANSITIONS + 1;
    for (size_t at = SS_COMPARED_FEATURES; k < SS_FEATURE_NUMBERS; k++)
        if ((ss_feature_numbers[k].needs & OF_EVENTS) == 0 && at++ == i)
            break;
    return (ss_feature)k;
}

const char *
ss_compared_name(size_t i)
{
    if (i < SS_COMPARED_FEATURES)
        return compared[i].name;
    const ss_feature feature = feature_at(i);
    return feature < SS_FEATURE_NUMBERS ? ss_feature_numbers[feature].label.name : NULL;
}

const char *
ss_compared_unit(size_t i)
{
    return i < SS_COMPARED_FEATURES ? compared[i].unit : "";
}

/* --- one run ------------------------------------------------------------------------------- */

typedef struct portrait {           /* of one scene */
    ss_signal *signal;              /* x - U t, v, a, f */
    ss_coefficients *map;           /* NULL: no scale is usable */
    ss_features *features;
    double largest;                 /* the largest |W| of the map */
    ss_sim_stats stats;
    size_t events, microslips;
    int slip;                       /* direction of the last slip; 0: none */
    size_t seen;
} portrait;

static void
portrait_free(portrait *p)
{
    ss_features_free(p->features);
    ss_coefficients_free(p->map);
    ss_signal_free(p->signal);
}

static int
keep_samples(const ss_sample *s, size_t n, void *user)
{
    portrait *p = user;
    size_t all = p->signal->n;
    for (size_t i = 0; i < n; i++, p->seen++) {
        const double row[COLUMNS] = { s[i].x, s[i].v, s[i].a, s[i].f };
        for (size_t c = 0; c < COLUMNS; c++)
            p->signal->values[c * all + p->seen] = row[c];
    }
    return 0;
}

static int
count_event(const ss_event *e, void *user)
{
    portrait *p = user;
    p->events++;
    if (e->kind == SS_STICK)
        return 0;
    p->microslips += e->kind == SS_SLIP && p->slip == e->direction;
    p->slip = e->direction;
    return 0;
}

static int
pass_samples(const ss_sample *s, size_t n, void *user)
{
    (void)s, (void)n, (void)user;
    return 0;
}

/* Simulate a scene and measure its time.  If p is NULL, only the time is kept. */
static ss_status
simulate(const ss_scene *scene, portrait *p, double *seconds, ss_error *err)
{
    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    opts.method = ss_method_for(scene, BEST)->name;
    opts.samples = p != NULL ? keep_samples : pass_samples;
    opts.events = p != NULL ? count_event : NULL;
    opts.user = p;
    *seconds = ss_trade_cpu_time();
    ss_status st = ss_sim_run(scene, &opts, p != NULL ? &p->stats : NULL, err);
    *seconds = ss_trade_cpu_time() - *seconds;
    return st;
}

/* Simulate a scene, transform its record and find its features.  A record may have no usable scale. */
static ss_status
portray(portrait *p, const ss_scene *scene, const ss_trade_opts *how, double *seconds, ss_error *err)
{
    const ss_sim_columns columns = { 1, COLUMNS, { 0, 1, 2, 3 } };
    ss_header *head = NULL;
    ss_morlet_opts transform = ss_morlet_defaults;
    ss_features_opts opts;
    *p = (portrait){ .seen = 0 };
    ss_status st = ss_sim_header(&head, scene, &columns, err);
    if (st == SS_OK)
        st = ss_signal_new(&p->signal, head, ss_scene_samples(scene), err);
    ss_header_free(head);
    if (st == SS_OK)
        st = simulate(scene, p, seconds, err);
    transform.threads = how->threads;
    if (st == SS_OK && (st = ss_morlet_transform(&p->map, p->signal, A, &transform, err)) == SS_OK)
        p->largest = ss_coefficients_max(p->map);
    ss_features_opts_init(&opts, sizeof opts);
    opts.mass = scene->mass;
    opts.stiffness = scene->stiffness;
    opts.displacement = 0;
    opts.force = F;
    opts.threads = how->threads;
    if (st == SS_OK || st == SS_ESCALE)
        st = ss_features_find(&p->features, p->signal, A, &opts, err);
    for (size_t i = 0; st == SS_OK && i < p->signal->n; i++)    /* x is compared as x - U t */
        p->signal->values[i] -= scene->base_velocity * (scene->settle + (double)i / scene->rate);
    return st;
}

/* --- comparison ---------------------------------------------------------------------------- */

static double
level(const portrait *p, size_t i, double span)
{
    const double *w = p->map->w + 2 * i;
    return fmax(-span, 20 * log10(hypot(w[0], w[1]) / p->largest));
}

/* Compare two maps over the area that is drawn.  All coefficients of a row have the same share of it. */
static void
compare_maps(double error[2], const portrait *p, const portrait *ref, double span)
{
    double squares = 0, area = 0, largest = 0;
    for (size_t i = 0; i < ref->map->n_scales; i++) {
        const ss_scale *scale = &ref->map->scale[i];
        for (size_t k = 0; k < scale->n; k++) {
            double here = level(p, scale->offset + k, span);
            double there = level(ref, scale->offset + k, span);
            if (ss_coefficients_edge(ref->map, i, k) || fmax(here, there) <= -span)
                continue;
            largest = fmax(largest, fabs(here - there));
            squares += (here - there) * (here - there) / (double)scale->n;
            area += 1 / (double)scale->n;
        }
    }
    error[0] = largest;
    error[1] = area > 0 ? sqrt(squares / area) : 0;
}

static double
difference(size_t a, size_t b)
{
    return a > b ? (double)(a - b) : (double)(b - a);
}

static void
compare(ss_models_row *row, const portrait *p, const portrait *ref, const ss_scene *scene,
        const ss_trade_opts *how)
{
    double *error = row->error;
    size_t n = ref->signal->n;
    for (size_t c = 0; c < COLUMNS; c++) {
        curve_error e = curve_compare(p->signal->values + c * n, n, ref->signal->values + c * n, n);
        error[2 * c] = e.largest;
        error[2 * c + 1] = e.rms;
    }
    error[MAP] = error[MAP + 1] = NAN;
    if (p->map != NULL && ref->map != NULL && p->largest > 0 && ref->largest > 0)
        compare_maps(error + MAP, p, ref, how->span);
    int both = ss_model_has_events(scene->model) && ss_model_has_events(row->scene.model);
    error[SS_COMPARED_EVENTS] = both ? difference(p->events, ref->events) : NAN;
    error[SS_COMPARED_MICROSLIPS] = both ? difference(p->microslips, ref->microslips) : NAN;
    for (size_t i = SS_COMPARED_FEATURES; ss_compared_name(i) != NULL; i++) {
        double was = ref->features->number[feature_at(i)].value, is = p->features->number[feature_at(i)].value;
        error[i] = is == was ? 0 : fabs(is - was) / fabs(was);
    }
    for (size_t i = 0; ss_compared_name(i) != NULL; i++)
        error[i] = isfinite(error[i]) ? error[i] : NAN;     /* relative to 0, or too large */
    row->events = p->events;
    row->microslips = p->microslips;
}

/* --- the rows ------------------------------------------------------------------------------ */

/* The search for the periodic state to which the scene settles may take so many times the steps of the
 * scene itself. */
#define PATIENCE 30

static ss_status
settle(ss_scene *settled, const ss_scene *scene, const ss_sim_stats *stats, ss_error *err)
{
    ss_steady_opts opts;
    ss_steady_opts_init(&opts, sizeof opts);
    ss_steady found;
    if (scene->base_frequency == 0)
        return ss_fail(err, SS_EINVAL, "base_frequency is 0: there is no forcing cycle");
    opts.measures = 1u << SS_PERIOD | 1u << SS_CYCLES;
    opts.max_steps = PATIENCE * (stats->steps + stats->rhs / 20 + 1000);
    ss_status st = ss_steady_find(&found, scene, &opts, err);
    if (st != SS_OK)
        return st;
    double period = found.value[SS_PERIOD] / scene->base_frequency;
    double lacks = found.value[SS_CYCLES] / scene->base_frequency - scene->settle;
    *settled = *scene;
    settled->settle += fmax(0, ceil(lacks / period)) * period;
    return SS_OK;
}

static ss_status
make_rows(ss_models *models, const ss_scene *scene, const portrait *ref)
{
    ss_scene simpler;
    size_t n = 0;
    while (ss_scene_simpler(&simpler, scene, n) != NULL)
        n++;
    models->row = calloc(n + SS_MODELS_SIMPLER, sizeof *models->row);
    if (models->row == NULL)
        return SS_ENOMEM;
    models->n = n + SS_MODELS_SIMPLER;
    ss_models_row *settled = &models->row[SS_MODELS_SETTLED], *row = models->row + SS_MODELS_SIMPLER;
    models->row[SS_MODELS_SCENE] = (ss_models_row){ .name = ss_model_name(scene->model), .scene = *scene };
    settled->name = "settled";
    settled->status = settle(&settled->scene, scene, &ref->stats, &settled->reason);
    for (size_t i = 0; i < n; i++)
        row[i].name = ss_scene_simpler(&row[i].scene, scene, i);
    return settled->status == SS_ENOMEM ? SS_ENOMEM : SS_OK;
}

typedef struct comparison {
    ss_models *models;
    const ss_trade_opts *how;
    portrait ref;               /* that of row 0 */
    double seconds;             /* that it took */
} comparison;

/* A ss_trade_runner. */
static ss_status
run_row(size_t i, int again, double done, double *seconds, void *user)
{
    comparison *c = user;
    ss_models_row *row = &c->models->row[i];
    const ss_scene *scene = &c->models->row[SS_MODELS_SCENE].scene;
    portrait p;
    (void)done;
    if (again)
        return simulate(&row->scene, NULL, seconds, NULL);
    *seconds = c->seconds;
    if (i == SS_MODELS_SCENE) {
        compare(row, &c->ref, &c->ref, scene, c->how);
        return SS_OK;
    }
    *seconds = NAN;
    if (row->status != SS_OK)
        return SS_OK;
    row->status = portray(&p, &row->scene, c->how, seconds, &row->reason);
    if (row->status == SS_OK)
        compare(row, &p, &c->ref, scene, c->how);
    else
        *seconds = NAN;
    portrait_free(&p);
    return row->status == SS_ENOMEM ? SS_ENOMEM : SS_OK;
}

static ss_status
measure_rows(ss_models *models, const ss_scene *scene, const ss_trade_opts *how, ss_error *err)
{
    comparison c = { .models = models, .how = how };
    double *seconds = NULL;
    ss_status st = portray(&c.ref, scene, how, &c.seconds, err);
    models->samples = ss_scene_samples(scene);
    if (st == SS_OK)
        st = make_rows(models, scene, &c.ref);
    if (st == SS_OK)
        st = ss_trade_race(&seconds, models->n, run_row, &how->progress, &c);
    for (size_t i = 0; st == SS_OK && i < models->n; i++)
        models->row[i].seconds = isnan(seconds[i]) ? 0 : seconds[i];
    portrait_free(&c.ref);
    free(seconds);
    return st;
}

ss_status
ss_models_measure(ss_models **out, const ss_scene *scene, const ss_trade_opts *given, ss_error *err)
{
    ss_trade_opts opts;
    if (out == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_trade_opts_take(&opts, given, err);
    if (st == SS_OK && !(opts.span > 0))
        return ss_fail(err, SS_EINVAL, "a span is more than 0 dB");
    if (st == SS_OK)
        st = ss_record_check(scene, err);
    if (st == SS_OK && ss_scene_samples(scene) == 0)
        return ss_fail(err, SS_EINVAL, "the record has no samples to compare");
    if (st != SS_OK)
        return st;
    ss_models *models = calloc(1, sizeof *models);
    st = models != NULL ? measure_rows(models, scene, &opts, err) : SS_ENOMEM;
    if (st == SS_OK) {
        *out = models;
        return SS_OK;
    }
    ss_models_free(models);
    return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

void
ss_models_free(ss_models *models)
{
    if (models == NULL)
        return;
    free(models->row);
    free(models);
}
