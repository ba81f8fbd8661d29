/* method.c -- all methods, and the choice of one for a scene.  No other file names a method. */
#include "motion/method.h"

#include <stdlib.h>
#include <string.h>
#include "base/error.h"

enum { EXACT, TAYLOR, RK8PD, RKF45, RKCK, RK4, RK2, RK1IMP, RK2IMP, RK4IMP, BSIMP, RADAU, MSADAMS, MSBDF,
       METHODS };

static const struct method list[METHODS] = {
    [EXACT] = { .name = "exact", .kind = CLOSED_FORM },
    [TAYLOR] = { "taylor", SERIES, 0.4, 12 },
    [RK8PD] = { "rk8pd", ONE_STEP, 1, 13 },
    [RKF45] = { "rkf45", ONE_STEP, 1.1, 6 },
    [RKCK] = { "rkck", ONE_STEP, 1.1, 6 },
    [RK4] = { "rk4", ONE_STEP, 1, 11 },
    [RK2] = { "rk2", ONE_STEP, 1.2, 3 },
    [RK1IMP] = { "rk1imp", ONE_STEP, 3.5, 9 },
    [RK2IMP] = { "rk2imp", ONE_STEP, 3.5, 9 },
    [RK4IMP] = { "rk4imp", ONE_STEP, 3.3, 17 },
    [BSIMP] = { "bsimp", ONE_STEP, 3, 50 },
    [RADAU] = { "radau", COLLOCATION, 8, 30 },
    [MSADAMS] = { "msadams", MULTISTEP, 4.6, 3 },
    [MSBDF] = { "msbdf", MULTISTEP, 6.4, 3 },
};

const struct method *
ss_method_at(size_t i)
{
    return i < METHODS ? &list[i] : NULL;
}

/* --- choice -------------------------------------------------------------------------------- */

static int
has_closed_form(const ss_scene *scene)
{
    return scene->model->linear && scene->base == NULL;
}

static int
has_series(const ss_scene *scene)
{
    const ss_model *model = scene->model;
    return model->series != NULL && (model->analytic == NULL || model->analytic(scene));
}

static int
is_stiff(const ss_scene *scene)
{
    const ss_model *model = scene->model;
    return model->stiff != NULL && model->stiff(scene);
}

const struct method *
ss_method_for(const ss_scene *scene, wish wanted)
{
    const ss_model *model = scene->model;
    if (wanted == BEST && has_closed_form(scene))
        return &list[EXACT];
    if (is_stiff(scene))
        return &list[RADAU];
    return &list[!model->linear && has_series(scene) ? TAYLOR : RK8PD];
}

const char *
ss_method_best_names(const ss_scene *scene)
{
    return has_closed_form(scene) ? "exact" : "taylor, radau where stiff";
}

int
ss_method_pair(const ss_scene *scene, int pair, const char *name[2])
{
    const struct method *first = ss_method_for(scene, pair == 0 ? BEST : USUAL);
    int closed = has_closed_form(scene), m = closed && pair == 1 ? TAYLOR : (int)(first - list);
    name[0] = list[m].name;
    int implicit = scene->model->next != NULL ? BSIMP : MSBDF;
    name[1] = list[m == EXACT ? TAYLOR : m == TAYLOR ? RK8PD : m == RK8PD ? RKCK : implicit].name;
    return pair <= closed;
}

/* --- use ----------------------------------------------------------------------------------- */

ss_status
ss_method_named(const struct method **how, const char *name, const ss_scene *scene, ss_error *err)
{
    const ss_model *model = scene->model;
    size_t i = 0;
    if (name == NULL) {
        *how = ss_method_for(scene, USUAL);
        return SS_OK;
    }
    while (i < METHODS && strcmp(list[i].name, name) != 0)
        i++;
    if (i == METHODS)
        return ss_fail(err, SS_EINVAL, "unknown method '%.32s'", name);
    method_kind kind = list[i].kind;
    const char *lacks = kind == CLOSED_FORM && !model->linear ? "closed form"
        : kind == SERIES && !has_series(scene) ? "series" : NULL;
    if (lacks != NULL)
        return ss_fail(err, SS_EINVAL, "method %s: %s %s model has no %s", name,
                       kind == SERIES && model->series != NULL ? "with this exponent the" : "the", model->name, lacks);
    if (kind == CLOSED_FORM && scene->base != NULL)
        return ss_fail(err, SS_EINVAL, "method %s: a measured base has no closed form", name);
    if (kind == MULTISTEP && model->next != NULL && !model->linear)
        return ss_fail(err, SS_EINVAL, "method %s does not repeat a step, by which alone %s of "
                       "the %s model are found", name, model->kinks ? "kinks" : "events", model->name);
    if (i < RK1IMP && model->from_pull && is_stiff(scene))
        return ss_fail(err, SS_EINVAL, "method %s: its steps would be millions, as between slips the friction of "
                       "this scene follows the force within %.2g s; %s is implicit", name,
                       1 / model->quickest(scene), list[RADAU].name);
    *how = &list[i];
    return SS_OK;
}

ss_status
ss_engine_new(engine **out, motion *m, const struct method *how, double tol, ss_error *err)
{
    static const struct engine_type *const types[] = {
        [CLOSED_FORM] = &ss_exact_engine, [SERIES] = &ss_taylor_engine, [COLLOCATION] = &ss_radau_engine,
        [ONE_STEP] = &ss_ode_engine, [MULTISTEP] = &ss_ode_engine,
    };
    const struct engine_type *type = types[how->kind];
    engine *e = calloc(1, type->size);
    if (e == NULL)
        return ss_fail_memory(err, NULL);
    *e = (engine){ .type = type, .m = m, .how = how, .tol = tol,
                   .next = fmax(ss_step_cap(&m->now), ss_step_floor(&m->now)) };
    ss_status st = how->kind != CLOSED_FORM ? ss_motion_scales(&m->now, tol, e->scale, err) : SS_OK;
    for (size_t k = 0; k < MAX_DIM; k++)
        e->unit[k] = ldexp(1, ilogb(e->scale[k]));
    if (st == SS_OK && type->make != NULL)
        st = type->make(e, err);
    if (st == SS_OK)
        *out = e;
    else
        ss_engine_free(e);
    return st;
}

const char *
ss_sim_method_name(size_t i)
{
    return i < METHODS ? list[i].name : NULL;
}

const char *
ss_sim_method_for(const ss_scene *scene, const char **why)
{
    if (scene == NULL || scene->model == NULL)
        return NULL;
    if (why != NULL)
        *why = is_stiff(scene) ? "implicit, as the friction of this scene is stiff" : "the default";
    return ss_method_for(scene, USUAL)->name;
}
