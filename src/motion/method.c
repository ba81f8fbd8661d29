/* method.c -- find a method by its name, and choose one for a scene. */
#include <string.h>
#include "motion/engine.h"

const char *
ss_sim_method_name(size_t i)
{
    return i == 0 ? EXACT : i == 1 ? TAYLOR : ss_ode_method_name(i - 2);
}

const char *
ss_sim_method_for(const ss_scene *scene)
{
    const struct model *model = scene != NULL ? ss_model_of(scene) : NULL;
    if (model == NULL)
        return NULL;
    if (model->stiff != NULL && model->stiff(scene))
        return "bsimp";
    return !model->linear && model->series != NULL ? TAYLOR : "rk8pd";
}

ss_status
ss_engine_new(engine **out, motion *m, const char *method, double tol, ss_error *err)
{
    return strcmp(method, EXACT) == 0 ? ss_exact_new(out, m, err)
        : strcmp(method, TAYLOR) == 0 ? ss_taylor_new(out, m, tol, err)
        : ss_ode_new(out, m, method, tol, err);
}
