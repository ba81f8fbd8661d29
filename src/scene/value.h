/* value.h -- the value of a key: where it stands in a scene, and what it may be. */
#ifndef VALUE_H
#define VALUE_H

#include "scene/key.h"

/* All enumerations of a scene are read and written through int. */
_Static_assert(sizeof(ss_model) == sizeof(int) && sizeof(ss_law) == sizeof(int)
               && sizeof(ss_release) == sizeof(int), "enumerations have the size of int");

static inline int *
word_of(ss_scene *scene, const scene_key *k)
{
    return (int *)(void *)((char *)scene + k->offset);
}

static inline char *
text_of(ss_scene *scene, const scene_key *k)
{
    return (char *)scene + k->offset;
}

static inline int
is_number(const scene_key *k)
{
    return k->word == NULL && k->room == 0;
}

/* 1 if a number, or the word of an enumeration, is one that the key may have. */
int ss_value_in_range(const scene_key *k, double x);
int ss_value_is_word(const scene_key *k, int word);
/* The range of a number as messages show it. */
const char *ss_value_range(const scene_key *k);
/* The reason why a text cannot stand in a scene: it would not read back as it is written, or it drives a
 * terminal.  NULL: it can. */
const char *ss_value_no_text(const char *text);

/* Contradictions of two keys. */
#define TWO_BASES "base_file and base_amplitude exclude each other: the base moves by one of them"
#define STATIC_IS_LESS "static_friction is less than friction, it must be at least as large"

#endif
