/* simpler.c -- the simpler scenes that a scene contains: with a number set to 0, with the model
 * that is the limit of its model, and without friction. */
#include "scene/model.h"

static const vanishing of_every[] = {
    { "damping=0", offsetof(ss_scene, damping) },
    { "friction_negative=0", offsetof(ss_scene, friction_negative) },
    { "static_friction_negative=0", offsetof(ss_scene, static_friction_negative) },
    { "static_friction=0", offsetof(ss_scene, static_friction) },
};
enum { OF_EVERY = sizeof of_every / sizeof *of_every };

/* Set a number of the scene to 0.  Returns 0 if its model does not have it, or it was 0 already. */
static int
vanishes(ss_scene *scene, size_t offset)
{
    double *number = number_at(scene, offset);
    int there = *number != 0 && ss_key_of_field(scene->model, offset) != NULL;
    *number = 0;
    return there;
}

/* Apply simplification i to *scene, and return its name: "" if it changes nothing in this scene, NULL
 * after the last. */
static const char *
step(ss_scene *scene, size_t i)
{
    const ss_model *model = scene->model;
    if (i < OF_EVERY)
        return vanishes(scene, of_every[i].offset) ? of_every[i].name : "";
    i -= OF_EVERY;
    if (i < model->n_vanishing)
        return vanishes(scene, model->vanishing[i].offset) ? model->vanishing[i].name : "";
    i -= model->n_vanishing;
    for (; scene->model->limit != NULL; i--) {
        scene->model->limit(scene);
        if (i == 0)
            return ss_model_name(scene->model);
    }
    if (i > 0)
        return NULL;
    scene->static_friction = scene->friction_negative = scene->static_friction_negative = 0;
    return vanishes(scene, offsetof(ss_scene, friction)) ? "friction=0" : "";
}

const char *
ss_scene_simpler(ss_scene *out, const ss_scene *scene, size_t i)
{
    for (size_t k = 0;; k++) {
        ss_scene simpler = *scene;
        const char *name = step(&simpler, k);
        if (name != NULL && (name[0] == '\0' || i-- > 0))
            continue;
        if (name != NULL)
            *out = simpler;
        return name;
    }
}
