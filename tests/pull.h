/* pull.h -- a Coulomb slider that is pulled, drawn wide: for tests. */
#ifndef PULL_H
#define PULL_H

#include <math.h>
#include <stickslip.h>

/* lo to hi, evenly in its logarithm; uniform: a number from 0 to 1. */
static inline double
pull_between(double uniform, double lo, double hi)
{
    return lo * pow(hi / lo, uniform);
}

/* q = D w / (k U) from 1.5 to 30, f_k / D from 1 to 20, 10 slips, 40 to 120 samples in pi / w. */
static inline ss_scene
pull_draw(double (*uniform)(void *from), void *from)
{
    ss_scene s = ss_scene_defaults;
    s.model = ss_model_named("coulomb");
    s.mass = pull_between(uniform(from), .01, 100);
    double w = 2 * M_PI * pull_between(uniform(from), 2, 200), q = pull_between(uniform(from), 1.5, 30);
    s.stiffness = s.mass * w * w;
    s.base_velocity = pull_between(uniform(from), 1e-5, 1e-2);
    double D = q * s.stiffness * s.base_velocity / w, loading = s.stiffness * s.base_velocity;
    s.friction = D * pull_between(uniform(from), 1, 20);
    s.static_friction = s.friction + D;
    double period = 2 * (M_PI - atan(q)) / w + 2 * D / loading;
    s.settle = s.static_friction / loading + (1.5 + uniform(from)) * period;
    s.duration = 10 * period;
    s.rate = pull_between(uniform(from), 40, 120) * w / M_PI;
    return s;
}

#endif
