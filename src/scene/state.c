/* state.c -- the state of a scene before its first mode. */
#include "scene/model.h"

state
ss_state_of(const ss_scene *scene, double tol)
{
    return (state){ .scene = scene, .model = ss_model_of(scene),
                    .omega = 2 * M_PI * scene->base_frequency,
                    .drive = scene->stiffness * scene->base_amplitude,
                    .x_scale = fmax(amplitude_of(scene), scene->friction / scene->stiffness),
                    .tol = tol, .theta = atan2(sin(scene->phase), cos(scene->phase)) };
}
