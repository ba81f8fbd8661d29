/* state.c -- the state of a scene before its first mode, and its frame. */
#include "scene/model.h"

state
ss_state_of(const ss_scene *scene, double tol)
{
    double hold = static_friction(scene) / scene->stiffness;
    state m = { .scene = scene, .model = scene->model,
                .omega = 2 * M_PI * scene->base_frequency,
                .drive = scene->stiffness * scene->base_amplitude,
                .ramp = scene->model->from_pull ? 0 : scene->stiffness * pull_of(scene),
                .drag = scene->damping * scene->surface_velocity,
                .moves = scene->base_velocity != 0 || scene->surface_velocity != 0
                    || scene->base != NULL,
                .x_scale = fmax(amplitude_of(scene), hold),
                .tol = tol, .theta = atan2(sin(scene->phase), cos(scene->phase)) };
    if (scene->base != NULL)
        ss_state_meet_base(&m, 0);
    return m;
}

void
ss_state_follow(state *m)
{
    double far = pull_of(m->scene) * m->u;
    if (m->mode != 0 || !m->model->has_contact) {
        m->q[0] -= far;
        return;
    }
    m->x_ref -= far;
    m->f0 = m->scene->stiffness * m->x_ref;
}
