/* state.c -- the state of a scene before its first mode. */
#include "scene/model.h"

/* x is measured by the largest of Z_e, |x0|, |v0| / omega_n and f_k / k. */
static double
x_scale(const ss_scene *s)
{
    double omega_n = sqrt(s->stiffness / s->mass);
    return fmax(fmax(s->base_amplitude, fabs(s->x0)),
                fmax(fabs(s->v0) / omega_n, s->friction / s->stiffness));
}

state
ss_state_of(const ss_scene *scene, double tol)
{
    return (state){ .scene = scene, .model = ss_model_of(scene), .omega = 2 * M_PI * scene->base_frequency,
                    .drive = scene->stiffness * scene->base_amplitude,
                    .x_scale = x_scale(scene), .tol = tol,
                    .theta = atan2(sin(scene->phase), cos(scene->phase)) };
}
