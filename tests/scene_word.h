/* scene_word.h -- the word that is the value of a scene's key: for tests. */
#ifndef SCENE_WORD_H
#define SCENE_WORD_H

#include "scene/key.h"

/* NULL: the model has no such key. */
static inline const char *
scene_word(const ss_scene *scene, const char *key)
{
    char room[SS_NUMBER_MAX];           /* which words do not use */
    const scene_key *k = ss_key_named(scene->model, key);
    return k != NULL && ss_key_word(k, 0) != NULL ? ss_value_text(scene, k, room) : NULL;
}

#endif
