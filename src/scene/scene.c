/* scene.c -- check and write a scene, with the parameters of its model and no others.
 *
 * Tables of keys (keys.c, and one of each model) give the required keys and the ranges of values.
 * Reading (lines.c), checking and writing use the same tables. */
#include <stickslip/scene.h>

#include <math.h>
#include <stdint.h>
#include <string.h>
#include "base/error.h"
#include "scene/model.h"
#include "scene/scene.h"

const ss_scene ss_scene_defaults = { .duration = 10, .rate = 2000 };

const char *
ss_event_kind_name(ss_event_kind kind)
{
    static const char *const name[] = { "stick", "slip", "reverse" };
    return (unsigned)kind <= SS_REVERSE ? name[kind] : "?";
}

size_t
ss_scene_samples(const ss_scene *scene)
{
    if (scene == NULL)
        return 0;
    double n = nearbyint(scene->duration * scene->rate);
    return n < 0x1p53 ? (size_t)n : SIZE_MAX;
}

int
ss_scene_is_pulled(const ss_scene *scene)
{
    return scene != NULL && pull_of(scene) != 0 && scene->base_amplitude == 0
        && scene->base_file[0] == '\0' && scene->base == NULL;
}

const char *
ss_scene_static_is_less(const ss_scene *s)
{
    double given = s->static_friction, negative = s->static_friction_negative;
    if (given != 0 && given < s->friction && ss_key_named(s->model, "static_friction") != NULL)
        return "static_friction";
    return negative != 0 && negative < kinetic_friction(s, -1) ? "static_friction_negative" : NULL;
}

ss_status
ss_scene_check(const ss_scene *scene, ss_error *err)
{
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    const ss_model *model = scene->model;
    const scene_key *k;
    char wrong[WRONG_ROOM];
    if (model == NULL)
        return ss_fail(err, SS_EINVAL, "the scene has no model");
    for (size_t i = 0; (k = ss_key_next(scene, &i)) != NULL;)
        if (!ss_value_check(scene, k, wrong))
            return ss_fail(err, SS_EINVAL, "%s", wrong);
    for (size_t i = 0; model->rig_is_own && (k = ss_key_at(ss_model_at(0), i)) != NULL; i++)
        if (ss_key_of_field(model, k->offset) == NULL && ss_key_is_named(scene, k))
            return ss_fail(err, SS_EINVAL, "model %s has no key '%s'", model->name, k->name);
    if ((scene->base != NULL || *scene->base_file != '\0') && scene->base_amplitude != 0)
        return ss_fail(err, SS_EINVAL, TWO_BASES);
    const char *less = ss_scene_static_is_less(scene);
    if (less != NULL)
        return ss_fail(err, SS_EINVAL, STATIC_IS_LESS, less, less + strlen("static_"));
    return SS_OK;
}

ss_status
ss_scene_write(const ss_scene *scene, FILE *out, ss_error *err)
{
    if (scene == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_scene_check(scene, err);
    if (st != SS_OK)
        return st;
    const scene_key *k;
    char room[SS_NUMBER_MAX];
    for (size_t i = 0; (k = ss_key_next(scene, &i)) != NULL;)
        fprintf(out, "%s = %s\n", k->name, ss_value_text(scene, k, room));
    return ferror(out) ? ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO)) : SS_OK;
}
