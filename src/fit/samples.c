/* samples.c -- samples of a scene's motion, with the accuracy and at the cost that a comparison needs. */
#include "fit/samples.h"

#include <math.h>
#include "motion/method.h"

enum { STEPS_MOST = 1000000 };          /* of one run */

typedef struct sampled {
    int pick;
    size_t n, room;
    double *value, *clear, rate;
} sampled;

static int
append_samples(const ss_sample *s, size_t n, void *user)
{
    sampled *t = user;
    const ss_sim_columns picked = { 0, 1, { t->pick } };
    for (size_t i = 0; i < n && t->n < t->room; i++)
        ss_sim_row(&picked, &s[i], &t->value[t->n++]);
    return 0;
}

static int
clear_event(const ss_event *e, void *user)
{
    sampled *t = user;
    double at = e->t * t->rate, first = fmax(ceil(at - SAMPLES_REACH), 0);
    for (double i = first; i < (double)t->room && i <= at + SAMPLES_REACH; i++)
        t->clear[(size_t)i] = fmin(t->clear[(size_t)i], fabs(i - at));
    return 0;
}

ss_sim_opts
ss_samples_opts(const ss_scene *scene, double tol)
{
    return (ss_sim_opts){ .size = sizeof(ss_sim_opts), .method = ss_method_for(scene, BEST)->name, .tol = tol,
                          .max_steps = STEPS_MOST };
}

ss_status
ss_samples_run(const ss_scene *scene, int pick, double tol, double *value, double *clear, size_t n,
               double *steps)
{
    sampled t = { pick, 0, n, value, clear, scene->rate };
    ss_sim_opts opts = ss_samples_opts(scene, tol);
    ss_sim_stats stats = { .steps = 0 };
    for (size_t i = 0; clear != NULL && i < n; i++)
        clear[i] = INFINITY;
    opts.samples = append_samples;
    opts.events = clear != NULL ? clear_event : NULL;
    opts.user = &t;
    ss_status st = ss_sim_run(scene, &opts, &stats, NULL);
    *steps += (st == SS_EBUDGET ? STEPS_MOST : (double)stats.steps) + (double)t.n / SAMPLES_A_STEP;
    return st == SS_OK && t.n != n ? SS_EDATA : st;
}
