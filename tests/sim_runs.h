/* sim_runs.h -- running scenes, for the tests of simulation. */
#ifndef SIM_RUNS_H
#define SIM_RUNS_H

#include <math.h>
#include <stickslip.h>
#include "extremes/runs.h"
#include "shipped.h"
#include "unit.h"

static inline run
run_by(const ss_scene *scene, const char *method, double tol)
{
    run r = run_with(scene, method, tol, 0);
    if (r.status != SS_OK)
        fail_msg("%s", r.err.text);
    return r;
}

static inline run
run_of(const ss_scene *scene)
{
    return run_by(scene, NULL, 1e-12);
}

static inline double
max_of(const run *r, size_t from, size_t to)
{
    double max = 0;
    for (size_t i = from; i < to; i++)
        max = fmax(max, fabs(r->sample[i].x));
    return max;
}

/* A shipped scene from rest, without settling. */
static inline ss_scene
scene_named(const char *name, double duration, double rate)
{
    ss_scene scene = read_shipped_named(name);
    scene.settle = 0;
    scene.duration = duration;
    scene.rate = rate;
    return scene;
}

/* A free or driven oscillator with m = k = 1, so omega_n = 1, and Coulomb friction. */
static inline ss_scene
unit_oscillator(double friction, double amplitude, double r)
{
    ss_scene s = ss_scene_defaults;
    s.model = ss_model_named("coulomb");
    s.mass = s.stiffness = 1;
    s.friction = friction;
    s.base_amplitude = amplitude;
    s.base_frequency = r / (2 * M_PI);
    return s;
}

static const char *const with_events[] = { "coulomb", "compliant-heavy", "compliant-light" };

#endif
