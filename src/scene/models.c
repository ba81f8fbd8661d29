/* models.c -- the friction models by their places in the list and by their names. */
#include <string.h>
#include "scene/models.h"
#include "scene/scene.h"

#define POINT_TO(name) &ss_##name##_model,
static const ss_model *const list[MODELS] = { MODEL_LIST(POINT_TO) };

const ss_model *
ss_model_at(size_t i)
{
    return i < MODELS ? list[i] : NULL;
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
    return model != NULL && model->next != NULL && !model->kinks;
}

int
ss_model_is_linear(const ss_model *model)
{
    return model != NULL && model->linear;
}
