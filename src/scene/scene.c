/* scene.c -- check and write a scene, with the parameters of its model and no others.
 *
 * Tables of keys (keys.c, and one of each model) give the required keys and the ranges of values.
 * Reading (lines.c), checking and writing use the same tables. */
#include <stickslip/scene.h>

#include <math.h>
#include <stdint.h>
#include "base/error.h"
#include "scene/model.h"
#include "scene/value.h"

const ss_scene ss_scene_defaults = { .duration = 10, .rate = 2000 };

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

double *
ss_scene_number(ss_scene *scene, const char *name, const char **unit, ss_error *err)
{
    const struct model *model = scene != NULL ? ss_model_of(scene) : NULL;
    if (model == NULL || name == NULL) {
        ss_fail(err, SS_EINVAL, "no scene of a known model, or no key");
        return NULL;
    }
    const scene_key *k = ss_key_named(model, name);
    if (k == NULL && ss_key_of_any(name) == NULL) {
        char text[KEY_UNKNOWN_ROOM];
        ss_fail(err, SS_EINVAL, "%s", ss_key_unknown(text, name));
    } else if (k == NULL) {
        ss_fail(err, SS_EINVAL, "model %s has no key '%s'", model->name, name);
    } else if (!is_number(k)) {
        ss_fail(err, SS_EINVAL, "%s is not a number", name);
    } else {
        if (unit != NULL)
            *unit = k->unit;
        return number_at(scene, k->offset);
    }
    return NULL;
}

ss_status
ss_scene_check(const ss_scene *scene, ss_error *err)
{
    if (scene == NULL)
        return SS_FAIL_NULL(err);
    const struct model *model = ss_model_of(scene);
    const scene_key *k;
    if (model == NULL)
        return ss_fail(err, SS_EINVAL, "model is no known choice");
    ss_scene copy = *scene;         /* the accessors return pointers that are not const */
    for (size_t i = 0; (k = ss_key_at(model, i)) != NULL; i++) {
        if (k->word != NULL && !ss_value_is_word(k, *word_of(&copy, k)))
            return ss_fail(err, SS_EINVAL, "%s is no known choice", k->name);
        const char *wrong = k->room > 0 ? ss_value_no_text(text_of(&copy, k)) : NULL;
        if (wrong != NULL)
            return ss_fail(err, SS_EINVAL, "%s %s", k->name, wrong);
        if (is_number(k) && !ss_value_in_range(k, *number_at(&copy, k->offset))) {
            char text[SS_NUMBER_MAX];
            ss_number_format(text, *number_at(&copy, k->offset));
            return ss_fail(err, SS_EINVAL, "%s = %s is out of range, it must be %s", k->name,
                           text, ss_value_range(k));
        }
    }
    if ((scene->base != NULL || *scene->base_file != '\0') && scene->base_amplitude != 0)
        return ss_fail(err, SS_EINVAL, TWO_BASES);
    if (scene->static_friction != 0 && scene->static_friction < scene->friction
        && ss_key_named(model, "static_friction") != NULL)
        return ss_fail(err, SS_EINVAL, STATIC_IS_LESS);
    return SS_OK;
}

ss_status
ss_scene_write(const ss_scene *scene, FILE *out)
{
    if (scene == NULL || out == NULL || ss_scene_check(scene, NULL) != SS_OK)
        return SS_EINVAL;
    ss_scene copy = *scene;
    const scene_key *k;
    for (size_t i = 0; (k = ss_key_at(ss_model_of(scene), i)) != NULL; i++) {
        char text[SS_NUMBER_MAX];
        if (k->required == TERM && !ss_key_is_named(scene, k))
            continue;
        if (is_number(k))
            ss_number_format(text, *number_at(&copy, k->offset));
        fprintf(out, "%s = %s\n", k->name, k->word != NULL ? k->word(*word_of(&copy, k))
                : k->room > 0 ? text_of(&copy, k) : text);
    }
    return ferror(out) ? SS_EIO : SS_OK;
}
