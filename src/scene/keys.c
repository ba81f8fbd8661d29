/* keys.c -- the keys that scenes of every model have, those of the model between them, and how a name is
 * found among the keys. */
#include <stdio.h>
#include <string.h>
#include "scene/model.h"
#include "scene/scene.h"

static const scene_key of_motion[] = {
    { "model", REQUIRED, ANY_NUMBER, offsetof(ss_scene, model), "", 0, NULL },
    KEY_NUMBER(mass, REQUIRED, POSITIVE, "kg"),
    KEY_NUMBER(stiffness, REQUIRED, POSITIVE, "N/m"),
    KEY_NUMBER(friction, REQUIRED, NOT_NEGATIVE, "N"),
    KEY_NUMBER(base_amplitude, FORCING, NOT_NEGATIVE, "m"),
    KEY_NUMBER(base_frequency, FORCING, NOT_NEGATIVE, "Hz"),
    KEY_NUMBER(phase, OPTIONAL, ANY_NUMBER, "rad"),
    KEY_NUMBER(x0, OPTIONAL, ANY_NUMBER, "m"),
    KEY_NUMBER(v0, OPTIONAL, ANY_NUMBER, "m/s"),
    KEY_NUMBER(damping, TERM, NOT_NEGATIVE, "N s/m"),
    KEY_NUMBER(base_velocity, TERM, ANY_NUMBER, "m/s"),
    KEY_NUMBER(surface_velocity, TERM, ANY_NUMBER, "m/s"),
    KEY_TEXT(base_file, PATH),
    KEY_TEXT(base_column, ANY_TEXT),
};
enum { OF_MOTION = sizeof of_motion / sizeof *of_motion, OF_EVERY_RIG = 3 };

static const scene_key of_record[] = {
    KEY_NUMBER(settle, OPTIONAL, NOT_NEGATIVE, "s"),
    KEY_NUMBER(duration, OPTIONAL, NOT_NEGATIVE, "s"),
    KEY_NUMBER(rate, OPTIONAL, RATE, "Hz"),
};
enum { OF_RECORD = sizeof of_record / sizeof *of_record };

const scene_key *
ss_key_at(const ss_model *model, size_t i)
{
    size_t rig = model->rig_is_own ? OF_EVERY_RIG : OF_MOTION;
    if (i < rig)
        return &of_motion[i];
    i -= rig;
    if (i < model->n_keys)
        return &model->keys[i];
    i -= model->n_keys;
    return i < OF_RECORD ? &of_record[i] : NULL;
}

const char *
ss_key_word(const scene_key *k, size_t i)
{
    const ss_model *model = ss_model_at(i);
    if (k->offset == offsetof(ss_scene, model))
        return model != NULL ? model->name : NULL;
    return k->words != NULL ? k->words[i] : NULL;
}

const scene_key *
ss_key_named(const ss_model *model, const char *name)
{
    const scene_key *k = NULL;
    for (size_t i = 0; (k = ss_key_at(model, i)) != NULL && strcmp(k->name, name) != 0; i++)
        ;
    return k;
}

const scene_key *
ss_key_of_field(const ss_model *model, size_t offset)
{
    const scene_key *k = NULL;
    for (size_t i = 0; (k = ss_key_at(model, i)) != NULL && k->offset != offset; i++)
        ;
    return k;
}

const char *
ss_scene_term(const ss_scene *scene)
{
    const ss_model *model = scene->model;
    const scene_key *k;
    for (size_t i = 0; (k = ss_key_at(model, i)) != NULL; i++)
        if (k->required == TERM && ss_key_is_named(scene, k))
            return k->name;
    return NULL;
}

int
ss_key_is_named(const ss_scene *scene, const scene_key *k)
{
    const char *field = (const char *)scene + k->offset;
    return k->room > 0 ? *field != '\0' : *(const double *)(const void *)field != 0;
}

const scene_key *
ss_key_next(const ss_scene *scene, size_t *i)
{
    const scene_key *k;
    do
        k = ss_key_at(scene->model, (*i)++);
    while (k != NULL && k->required == TERM && !ss_key_is_named(scene, k));
    return k;
}

int
ss_key_is_of_record(const char *name)
{
    for (size_t i = 0; i < OF_RECORD; i++)
        if (strcmp(name, of_record[i].name) == 0)
            return 1;
    return 0;
}

/* --- a name among the keys of all models ----------------------------------------------------- */

const scene_key *
ss_key_of_any(const char *name)
{
    const scene_key *k = NULL;
    const ss_model *model;
    for (size_t i = 0; k == NULL && (model = ss_model_at(i)) != NULL; i++)
        k = ss_key_named(model, name);
    return k;
}

enum { LONGEST = 64 };              /* letters that are looked at; keys have less than half of them */

/* The number of letters to insert, delete or replace between two words (Levenshtein 1966). */
static size_t
distance(const char *a, const char *b)
{
    size_t row[LONGEST + 1], m = strnlen(a, LONGEST), n = strnlen(b, LONGEST);
    for (size_t j = 0; j <= n; j++)
        row[j] = j;
    for (size_t i = 1; i <= m; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= n; j++) {
            size_t best = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            if (row[j] + 1 < best)
                best = row[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            row[j] = best;
        }
    }
    return row[n];
}

/* A name that differs from a key in few letters is probably mistyped. */
const char *
ss_key_unknown(char text[KEY_UNKNOWN_ROOM], const char *name)
{
    const ss_model *model;
    const scene_key *k;
    const char *best = "model";
    for (size_t i = 0; (model = ss_model_at(i)) != NULL; i++)
        for (size_t j = 0; (k = ss_key_at(model, j)) != NULL; j++)
            best = distance(name, k->name) < distance(name, best) ? k->name : best;
    size_t length = strnlen(name, LONGEST), off = distance(name, best);
    if (off < length && off <= (length / 3 > 2 ? length / 3 : 2))
        snprintf(text, KEY_UNKNOWN_ROOM, "unknown key '%.64s'; the nearest is '%s'", name, best);
    else
        snprintf(text, KEY_UNKNOWN_ROOM, "unknown key '%.64s'", name);
    return text;
}
