/* models.c -- the friction models. */
#include "scene/model.h"

/* In the order of ss_model. */
static const struct model *const models[] = {
    &ss_coulomb_model,
    &ss_state_variable_model,
    &ss_compliant_model,
};

const struct model *
ss_model_of(const ss_scene *scene)
{
    return (unsigned)scene->model < sizeof models / sizeof *models ? models[scene->model] : NULL;
}
