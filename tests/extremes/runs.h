/* runs.h -- a scene run and kept, and runs compared: for the tests of simulation, test_extremes and test_random. */
#ifndef RUNS_H
#define RUNS_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip.h>

#include "../unit.h"

typedef struct run {
    size_t n, n_events, room, room_events;
    ss_sample *sample;
    ss_event *event;
    int in_order;               /* each event came before the samples from it on, after the others */
    ss_sim_stats stats;
    ss_status status;
    ss_error err;
} run;

static int
keep_samples(const ss_sample *s, size_t n, void *user)
{
    run *r = user;
    if (r->n + n > r->room) {
        r->room = 2 * r->room + n + 1000;
        r->sample = realloc(r->sample, r->room * sizeof *r->sample);
    }
    memcpy(r->sample + r->n, s, n * sizeof *s);
    r->n += n;
    if (r->n_events > 0)
        r->in_order &= r->event[r->n_events - 1].t <= s[0].t;
    return 0;
}

static int
keep_event(const ss_event *e, void *user)
{
    run *r = user;
    if (r->n_events == r->room_events) {
        r->room_events = 2 * r->room_events + 100;
        r->event = realloc(r->event, r->room_events * sizeof *r->event);
    }
    if (r->n > 0)
        r->in_order &= r->sample[r->n - 1].t < e->t;
    r->event[r->n_events++] = *e;
    return 0;
}

/* method NULL: the scene's; max_steps 0: no budget.  To be freed with run_free in any case. */
static run
run_with(const ss_scene *scene, const char *method, double tol, unsigned long max_steps)
{
    run r = { .in_order = 1 };
    ss_sim_opts opts = { .size = sizeof(ss_sim_opts), .method = method, .tol = tol, .max_steps = max_steps,
                         .samples = keep_samples, .events = keep_event, .user = &r };
    r.status = ss_sim_run(scene, &opts, &r.stats, &r.err);
    return r;
}

static void
run_free(run *r)
{
    free(r->sample);
    free(r->event);
}

static inline double
max_x(const run *r)
{
    double max = 0;
    for (size_t i = 0; i < r->n; i++)
        max = fmax(max, fabs(r->sample[i].x));
    return max;
}

/* What the library measures x by: its absolute tolerances are relative to this. */
static inline double
scale_of(const ss_scene *s)
{
    double omega = sqrt(s->stiffness / s->mass);
    return fmax(fmax(s->base_amplitude, fabs(s->x0)),
                fmax(fabs(s->v0) / omega, s->friction / s->stiffness));
}

/* The largest difference of x between samples, b's multiplied by factor. */
static inline double
difference(const run *a, const run *b, double factor)
{
    double worst = a->n == b->n ? 0 : INFINITY;
    for (size_t i = 0; i < a->n && i < b->n; i++)
        worst = fmax(worst, fabs(a->sample[i].x - factor * b->sample[i].x));
    return worst;
}

/* What is wrong with a scene, with all that it takes to see it again. */
static inline void
complain(uint64_t number, const ss_scene *scene, const char *what, double got, double allowed)
{
    fprintf(stderr, "scene %lu: %s: %.3g, allowed %.3g\n", (unsigned long)number, what, got, allowed);
    ss_scene_write(scene, stderr, NULL);
    fail();
}

#endif
