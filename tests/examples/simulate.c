/* simulate.c -- a long run in constant memory: samples and events go to sinks.
 *
 *     cc simulate.c $(pkg-config --cflags --libs stickslip) -o simulate
 *
 * A scene built in the program, 200 s of it: how often the mass stops a forcing cycle, and how far it
 * goes. */
#include <stickslip.h>

#include <math.h>
#include <stdio.h>

typedef struct summary {
    double farthest;
    unsigned long stops;
} summary;

static int
take_samples(const ss_sample *s, size_t n, void *user)
{
    summary *sum = user;
    for (size_t i = 0; i < n; i++)
        sum->farthest = fmax(sum->farthest, fabs(s[i].x));
    return 0;                           /* anything else would end the run */
}

static int
take_event(const ss_event *event, void *user)
{
    summary *sum = user;
    sum->stops += event->kind == SS_STICK;
    return 0;
}

int
main(void)
{
    ss_error err = { 0 };
    summary sum = { 0, 0 };
    ss_scene scene = ss_scene_defaults;
    scene.model = ss_model_named("coulomb");
    scene.mass = 2.42;
    scene.stiffness = 2310;
    scene.friction = 1.28;
    scene.base_amplitude = 0.0006;
    scene.base_frequency = 2.5;
    scene.settle = 20;
    scene.duration = 200;

    ss_sim_opts opts;
    ss_sim_opts_init(&opts, sizeof opts);
    opts.method = "exact";
    opts.samples = take_samples;
    opts.events = take_event;
    opts.user = &sum;
    ss_status status = ss_sim_run(&scene, &opts, NULL, &err);
    if (status != SS_OK) {
        fprintf(stderr, "simulate: %s\n", err.text);
        return 1;
    }
    printf("%.3g stops a cycle, max|x| = %.6g m\n",
           (double)sum.stops / (scene.duration * scene.base_frequency), sum.farthest);
    return 0;
}
