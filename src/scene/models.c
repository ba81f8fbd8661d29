/* models.c -- the friction models: one line each, in the order of ss_model. */
#include "scene/model.h"

#define MODELS(model) \
    model(ss_coulomb_model) \
    model(ss_state_variable_model) \
    model(ss_compliant_model) \
    model(ss_stribeck_model)

#define DECLARE(name) extern const struct model name;
#define POINT_TO(name) &name,
MODELS(DECLARE)
static const struct model *const list[] = { MODELS(POINT_TO) };

const struct model *
ss_model_at(size_t i)
{
    return i < sizeof list / sizeof *list ? list[i] : NULL;
}

const struct model *
ss_model_of(const ss_scene *scene)
{
    return ss_model_at((unsigned)scene->model);
}

const char *
ss_model_name(ss_model model)
{
    const struct model *m = ss_model_at((unsigned)model);
    return m != NULL ? m->name : "?";
}

int
ss_model_has_events(ss_model model)
{
    const struct model *m = ss_model_at((unsigned)model);
    return m != NULL && m->guard != NULL;
}

int
ss_model_is_linear(ss_model model)
{
    const struct model *m = ss_model_at((unsigned)model);
    return m != NULL && m->linear;
}
