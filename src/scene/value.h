/* value.h -- the value of a key in a scene: as text, and what it may be. */
#ifndef VALUE_H
#define VALUE_H

#include "base/number.h"
#include "scene/key.h"

enum { WRONG_ROOM = 256 };
/* Set a key that the scene's model has from text.  Returns 0, and says in `wrong` what is wrong, if it may
 * not have this value. */
int ss_value_read(ss_scene *scene, const scene_key *k, const char *text, char wrong[WRONG_ROOM]);
/* The value as text, which stands in `room`, in the scene or in a constant. */
const char *ss_value_text(const ss_scene *scene, const scene_key *k, char room[SS_NUMBER_MAX]);
/* Returns 0, and says what is wrong, if a key may not have its value. */
int ss_value_check(const ss_scene *scene, const scene_key *k, char wrong[WRONG_ROOM]);

/* Contradictions of two keys. */
#define TWO_BASES "base_file and base_amplitude exclude each other: the base moves by one of them"
#define STATIC_IS_LESS "%s is less than %s, it must be at least as large"
/* scene.c: the key of a static friction that is less than the kinetic one of its side; NULL: none. */
const char *ss_scene_static_is_less(const ss_scene *scene);

#endif
