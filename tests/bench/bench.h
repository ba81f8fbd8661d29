/* bench.h -- what the comparison programs share: scenes from rest, their reference, rows.
 *
 * A row is scene, seconds simulated, method, tolerance, error, events, CPU seconds, with tabs. */
#ifndef BENCH_H
#define BENCH_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <stickslip.h>
#include "../shipped.h"
#include "../noise_rms.h"
#include "signal/noise.h"
#include "signal/header.h"

typedef struct bench_scene {
    const char *name;
    ss_scene scene;
    double *x, max_x;           /* the reference, at 2 kHz */
} bench_scene;

static inline double
bench_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static inline int
bench_order(const void *a, const void *b)
{
    double d = *(const double *)a - *(const double *)b;
    return (d > 0) - (d < 0);
}

static inline double
bench_median(double *seconds, int n)
{
    qsort(seconds, (size_t)n, sizeof *seconds, bench_order);
    return seconds[n / 2];
}

static inline double *
bench_alloc(size_t n)
{
    double *x = calloc(n > 0 ? n : 1, sizeof *x);
    if (x == NULL)
        exit(1);
    return x;
}

/* One column of a scene's record, alone. */
static inline ss_signal *
bench_column(const ss_scene *scene, size_t column)
{
    ss_signal *all = NULL, *one = NULL;
    ss_error err = { 0 };
    if (ss_sim_signal(&all, scene, &err) != SS_OK
        || ss_signal_select(&one, all, &column, 1, 0, all->n, &err) != SS_OK) {
        printf("# %s\n", err.text);
        exit(1);
    }
    ss_signal_free(all);
    return one;
}

/* The same with white noise. */
static inline ss_signal *
bench_noisy_column(const ss_scene *scene, size_t column, double snr, unsigned long seed)
{
    ss_signal *one = bench_column(scene, column);
    ss_noise_add_once(one->values, one->n, noise_rms(one->values, one->n, snr), seed, NULL);
    return one;
}

typedef struct bench_kept {
    double *x;
    size_t n, events;
} bench_kept;

static inline int
bench_keep(const ss_sample *s, size_t n, void *user)
{
    bench_kept *k = user;
    for (size_t i = 0; i < n; i++)
        k->x[k->n++] = s[i].x;
    return 0;
}

static inline int
bench_count(const ss_event *e, void *user)
{
    (void)e;
    ((bench_kept *)user)->events++;
    return 0;
}

/* x of every sample and the number of events; a failure is a comment among the rows. */
static inline ss_status
cost_simulate(const ss_scene *scene, const char *method, double tol, double *x, size_t *events)
{
    bench_kept k = { x, 0, 0 };
    ss_error err = { 0 };
    ss_sim_opts opts = { .size = sizeof(ss_sim_opts), .method = method, .tol = tol, .samples = bench_keep,
                         .events = bench_count, .user = &k };
    ss_status st = ss_sim_run(scene, &opts, NULL, &err);
    if (st != SS_OK)
        printf("# %s at %g: %s\n", method, tol, err.text);
    *events = k.events;
    return st;
}

static inline void
bench_read(ss_scene *scene, const ss_shipped_scene *s)
{
    *scene = read_shipped(s);
    scene->settle = 0;
}

/* A scene from rest, with the exact motion as reference; where there is no closed form rk8pd at 1e-14. */
static inline bench_scene
bench_scene_of(const char *name, const ss_scene *scene, double duration)
{
    bench_scene b = { .name = name, .scene = *scene };
    size_t events;
    b.scene.duration = duration;
    size_t n = ss_scene_samples(&b.scene);
    b.x = bench_alloc(n);
    int linear = strcmp(ss_sim_method_for(scene, NULL), "rk8pd") == 0;
    if (cost_simulate(&b.scene, linear ? "exact" : "rk8pd", 1e-14, b.x, &events) != SS_OK)
        exit(1);
    for (size_t i = 0; i < n; i++)
        b.max_x = fmax(b.max_x, fabs(b.x[i]));
    return b;
}

static inline bench_scene
bench_scene_new(const ss_shipped_scene *s, double duration)
{
    ss_scene scene;
    bench_read(&scene, s);
    return bench_scene_of(s->name, &scene, duration);
}

static inline void
bench_scene_free(bench_scene *b)
{
    free(b->x);
}

/* The largest error of x over max|x|. */
static inline double
bench_error(const bench_scene *b, const double *x)
{
    double worst = 0;
    for (size_t i = 0; i < ss_scene_samples(&b->scene); i++)
        worst = fmax(worst, fabs(x[i] - b->x[i]));
    return worst / b->max_x;
}

static inline void
bench_row(const bench_scene *b, const char *method, double tol, const double *x, size_t events,
          double seconds)
{
    printf("%s\t%g\t%s\t%.0e\t%.1e\t%zu\t%.3g\n", b->name, b->scene.duration, method, tol,
           bench_error(b, x), events, seconds);
    fflush(stdout);
}

#endif
