/* models.c -- the friction models: one line each. */
#include <string.h>
#include "scene/model.h"

#define MODELS(model) \
    model(ss_coulomb_model) \
    model(ss_state_variable_model) \
    model(ss_compliant_model) \
    model(ss_stribeck_model)

#define DECLARE(name) extern const ss_model name;
#define POINT_TO(name) &name,
MODELS(DECLARE)
static const ss_model *const list[] = { MODELS(POINT_TO) };

const ss_model *
ss_model_at(size_t i)
{
    return i < sizeof list / sizeof *list ? list[i] : NULL;
}

const ss_model *
ss_model_named(const char *name)
{
    const ss_model *m = NULL;
    for (size_t i = 0; name != NULL && (m = ss_model_at(i)) != NULL && strcmp(m->name, name) != 0; i++)
        ;
    return m;
}

const char *
ss_model_name(const ss_model *model)
{
    return model != NULL ? model->name : "?";
}

int
ss_model_has_events(const ss_model *model)
{
    return model != NULL && model->guard != NULL;
}

int
ss_model_is_linear(const ss_model *model)
{
    return model != NULL && model->linear;
}
