/* value.c -- the values of keys: read from text, written as text, and checked against their ranges. */

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/error.h"
#include "base/utf8.h"
#include "scene/model.h"
#include "signal/header.h"
#include "scene/scene.h"

static int
is_number(const scene_key *k)
{
    return ss_key_word(k, 0) == NULL && k->room == 0;
}

static int
in_range(const scene_key *k, double x)
{
    if (k->range == RATE)
        return x >= RATE_MIN && x <= RATE_MAX;
    if (k->range == FROM_ONE)
        return isfinite(x) && x >= 1;
    if (k->range == FROM_HALF || k->range == HALF_TO_ONE)
        return isfinite(x) && x >= .5 && (x <= 1 || k->range == FROM_HALF);
    return isfinite(x) && (k->range == ANY_NUMBER || x > 0 || (k->range == NOT_NEGATIVE && x == 0));
}

static int
out_of_range(char wrong[WRONG_ROOM], const scene_key *k, const char *value)
{
    static const char *const range[] = {
        [ANY_NUMBER] = "finite", [NOT_NEGATIVE] = ">= 0", [POSITIVE] = "> 0", [RATE] = ("in " RATE_RANGE),
        [FROM_HALF] = ">= .5", [HALF_TO_ONE] = "in .5 ... 1", [FROM_ONE] = ">= 1",
    };
    snprintf(wrong, WRONG_ROOM, "%s = %.64s is out of range, it must be %s", k->name, value, range[k->range]);
    return 0;
}

/* --- texts --------------------------------------------------------------------------------- */

/* The reason why a text cannot stand in a scene: it would not read back as it is written, or it drives a
 * terminal.  NULL: it can. */
static const char *
no_text(const char *text)
{
    int is_control = 0;
    while (*text != '\0' && *text != '#' && !is_control)
        text += ss_utf8_next(text, &is_control);
    return *text != '\0' || is_control ? "has a control character or a '#'" : NULL;
}

/* A scene may come from a stranger, so it may name only files in its own folder or below. */
static int
leaves_folder(const char *path)
{
    size_t length = strlen(path);
    return path[0] == '/' || strncmp(path, "../", 3) == 0 || strstr(path, "/../") != NULL
        || strcmp(path, "..") == 0 || (length > 2 && strcmp(path + length - 3, "/..") == 0);
}

static int
read_text(char *to, const scene_key *k, const char *value, char wrong[WRONG_ROOM])
{
    const char *why = *value == '\0' ? "is empty" : strlen(value) >= k->room ? "is too long" : no_text(value);
    if (why == NULL && k->range == PATH && leaves_folder(value))
        why = "leads out of the scene's folder; a file there or below is meant";
    if (why == NULL)
        strcpy(to, value);
    else
        snprintf(wrong, WRONG_ROOM, "%s %s", k->name, why);
    return why == NULL;
}

/* --- words --------------------------------------------------------------------------------- */

/* Values of the old model's keys stay where the new model has keys of the same names. */
static void
change_model(ss_scene *scene, const ss_model *model)
{
    const ss_scene old = *scene;
    scene->model = model;
    memset(scene->own, 0, sizeof scene->own);
    for (size_t i = 0; old.model != NULL && i < old.model->n_keys; i++) {
        const scene_key *from = &old.model->keys[i], *to = ss_key_named(model, from->name);
        if (to != NULL && is_number(to))
            *number_at(scene, to->offset) = number_of(&old, from->offset);
    }
}

static int
read_word(ss_scene *scene, const scene_key *k, const char *value, char wrong[WRONG_ROOM])
{
    const char *word;
    int length = snprintf(wrong, WRONG_ROOM, "%s is '%.64s', but must be one of", k->name, value);
    for (size_t i = 0; (word = ss_key_word(k, i)) != NULL; i++) {
        length += snprintf(wrong + length, WRONG_ROOM - (size_t)length, "%s %s", i ? "," : "", word);
        if (strcmp(value, word) != 0)
            continue;
        if (k->offset == offsetof(ss_scene, model))
            change_model(scene, ss_model_at(i));
        else
            *number_at(scene, k->offset) = (double)i;
        return 1;
    }
    return 0;
}

/* The word of the present value; NULL if it is none's number. */
static const char *
word_of(const ss_scene *scene, const scene_key *k)
{
    if (k->offset == offsetof(ss_scene, model))
        return ss_model_name(scene->model);
    double value = number_of(scene, k->offset);
    for (size_t i = 0; ss_key_word(k, i) != NULL; i++)
        if (value == (double)i)
            return ss_key_word(k, i);
    return NULL;
}

/* --- all values ---------------------------------------------------------------------------- */

int
ss_value_read(ss_scene *scene, const scene_key *k, const char *text, char wrong[WRONG_ROOM])
{
    char *end;
    if (ss_key_word(k, 0) != NULL)
        return read_word(scene, k, text, wrong);
    if (k->room > 0)
        return read_text((char *)scene + k->offset, k, text, wrong);
    double x = ss_number_parse(text, &end);
    if (end == text || *end != '\0') {
        snprintf(wrong, WRONG_ROOM, "%s is '%.64s', but must be a number", k->name, text);
        return 0;
    }
    if (!in_range(k, x))
        return out_of_range(wrong, k, text);
    *number_at(scene, k->offset) = x;
    return 1;
}

const char *
ss_value_text(const ss_scene *scene, const scene_key *k, char room[SS_NUMBER_MAX])
{
    if (ss_key_word(k, 0) != NULL)
        return word_of(scene, k);
    if (k->room > 0)
        return (const char *)scene + k->offset;
    ss_number_format(room, number_of(scene, k->offset));
    return room;
}

int
ss_value_check(const ss_scene *scene, const scene_key *k, char wrong[WRONG_ROOM])
{
    char room[SS_NUMBER_MAX];
    if (is_number(k))
        return in_range(k, number_of(scene, k->offset)) || out_of_range(wrong, k, ss_value_text(scene, k, room));
    const char *text = ss_value_text(scene, k, room), *why = text == NULL ? "is no known choice" : no_text(text);
    if (why != NULL)
        snprintf(wrong, WRONG_ROOM, "%s %s", k->name, why);
    return why == NULL;
}

/* --- for callers --------------------------------------------------------------------------- */

/* The key of this name that the scene's model has; NULL, and the reason in err, if it has none. */
static const scene_key *
key_of(const ss_scene *scene, const char *name, ss_error *err)
{
    char text[KEY_UNKNOWN_ROOM];
    const scene_key *k = NULL;
    if (scene == NULL || scene->model == NULL || name == NULL)
        ss_fail(err, SS_EINVAL, "no scene with a model, or no key");
    else if ((k = ss_key_named(scene->model, name)) == NULL && ss_key_of_any(name) == NULL)
        ss_fail(err, SS_EINVAL, "%s", ss_key_unknown(text, name));
    else if (k == NULL)
        ss_fail(err, SS_EINVAL, "model %s has no key '%s'", scene->model->name, name);
    return k;
}

double
ss_scene_get(const ss_scene *scene, const char *key)
{
    const scene_key *k = key_of(scene, key, NULL);
    return k != NULL && is_number(k) ? number_of(scene, k->offset) : NAN;
}

const char *
ss_scene_unit(const ss_scene *scene, const char *key)
{
    const scene_key *k = key_of(scene, key, NULL);
    return k != NULL && is_number(k) ? k->unit : NULL;
}

ss_status
ss_scene_set(ss_scene *scene, const char *key, double value, ss_error *err)
{
    const scene_key *k = key_of(scene, key, err);
    if (k == NULL)
        return SS_EINVAL;
    if (!is_number(k))
        return ss_fail(err, SS_EINVAL, "%s is not a number", key);
    *number_at(scene, k->offset) = value;
    return SS_OK;
}

ss_status
ss_scene_set_text(ss_scene *scene, const char *key, const char *value, ss_error *err)
{
    char wrong[WRONG_ROOM];
    if (scene == NULL || key == NULL || value == NULL)
        return SS_FAIL_NULL(err);
    const scene_key *k = strcmp(key, "model") == 0 ? ss_key_of_any(key) : key_of(scene, key, err);
    if (k == NULL)
        return SS_EINVAL;
    return ss_value_read(scene, k, value, wrong) ? SS_OK : ss_fail(err, SS_EINVAL, "%s", wrong);
}
