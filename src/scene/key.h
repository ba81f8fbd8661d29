/* key.h -- the keys of a scene: where the value of each stands, what it may be, and which a fit may vary. */
#ifndef KEY_H
#define KEY_H

#include <stddef.h>
#include <stickslip/scene.h>
#include "base/number.h"

/* ranges of numbers; all are finite */
enum { ANY_NUMBER, NOT_NEGATIVE, POSITIVE, RATE, FROM_HALF, HALF_TO_ONE, FROM_ONE };
enum { ANY_TEXT, PATH };                           /* of texts; a PATH does not leave its folder */
/* TERM: a term of the equation of motion that most scenes do not have; it is 0 if the key is left
 * out, and a scene is then written without it.  FORCING: either all these keys are left out, or
 * none. */
enum { OPTIONAL, REQUIRED, TERM, FORCING };

typedef struct scene_key {
    const char *name;
    int required;
    int range;                      /* of a number */
    size_t offset;                  /* in ss_scene, of a double, a text or the model */
    const char *unit;               /* of a number */
    size_t room;                    /* of a text, with its NUL; 0 for others */
    const char *const *words;       /* that may stand there, up to NULL; the value is the place of one */
} scene_key;

/* The number of a scene at an offset. */
static inline double *
number_at(ss_scene *scene, size_t offset)
{
    return (double *)(void *)((char *)scene + offset);
}

static inline double
number_of(const ss_scene *scene, size_t offset)
{
    return *(const double *)(const void *)((const char *)scene + offset);
}

/* Does the value at an offset stand in ss_scene.own? */
static inline int
ss_key_is_own(size_t offset)
{
    const size_t first = offsetof(ss_scene, own);
    return offset >= first && offset < first + sizeof ((ss_scene *)0)->own;
}

#define KEY_NUMBER(field, required, range, unit) \
    { #field, required, range, offsetof(ss_scene, field), unit, 0, NULL }
#define KEY_STATIC_FRICTION KEY_NUMBER(static_friction, TERM, NOT_NEGATIVE, "N")
#define KEYS_FRICTION_NEGATIVE \
    KEY_NUMBER(friction_negative, TERM, POSITIVE, "N"), KEY_NUMBER(static_friction_negative, TERM, POSITIVE, "N")
/* Those of a model, at a place in ss_scene.own. */
#define OWN_AT(place) offsetof(ss_scene, own[place])
#define OWN_NUMBER(name, place, required, range, unit) { name, required, range, OWN_AT(place), unit, 0, NULL }
#define OWN_WORD(name, place, required, ...) \
    { name, required, ANY_NUMBER, OWN_AT(place), "", 0, (const char *const[]){ __VA_ARGS__, NULL } }
#define KEY_TEXT(field, range) { #field, TERM, range, offsetof(ss_scene, field), "", \
                                 sizeof ((ss_scene *)0)->field, NULL }

/* A number of the scene that a fit may vary besides k and f_k / (k Z_e). */
typedef struct parameter {
    size_t offset;                  /* in ss_scene */
    int by_mass;                    /* 1: the motion stays the same if it grows in proportion to mass */
    int by_speed;                   /* 1: the motion keeps its shape if it falls as the speed grows; -1: if
                                       it grows with the speed */
} parameter;
enum { PARAMETERS = 2 };             /* the most that a model has */

/* keys.c: the i-th key of a model, in the order in which scenes are written; NULL after the last. */
const scene_key *ss_key_at(const ss_model *model, size_t i);
/* The key of this name, or of this field, that the model has; NULL if none. */
const scene_key *ss_key_named(const ss_model *model, const char *name);
const scene_key *ss_key_of_field(const ss_model *model, size_t offset);
/* The i-th word that may be the value of a key; NULL after the last, and of other keys. */
const char *ss_key_word(const scene_key *k, size_t i);
/* The key of this name that some model has; NULL if none. */
const scene_key *ss_key_of_any(const char *name);
/* What is wrong with a name that no model has, with the key that is probably meant; returns text. */
enum { KEY_UNKNOWN_ROOM = 160 };
const char *ss_key_unknown(char text[KEY_UNKNOWN_ROOM], const char *name);
int ss_key_is_named(const ss_scene *scene, const scene_key *k);    /* has it this TERM? */
/* The next key that a scene is written with, from number *i on, which goes on behind it; NULL after the last. */
const scene_key *ss_key_next(const ss_scene *scene, size_t *i);
/* The first TERM that a scene has; NULL if none. */
const char *ss_scene_term(const ss_scene *scene);
/* 1 if the key belongs to the record that is made of the motion, not to the motion. */
int ss_key_is_of_record(const char *name);

const char *ss_scene_unit(const ss_scene *scene, const char *key);      /* of a number; NULL: no such number */
int ss_model_is_linear(const ss_model *model);      /* 1: between events it has a closed form */

/* --- value.c: the value of a key as text, and what it may be --------------------------------- */

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

/* --- simpler.c ----------------------------------------------------------------------------- */

/* Make the i-th of the simpler scenes that a scene contains.  Each loses more than the one before:
 * no damping; static friction equal to kinetic friction; no damping of the contact; the model that
 * is the limit of the scene's model (Coulomb's, for a stiff contact or for friction that follows v
 * at once); no friction.  Returns its name, "damping=0" or the name of its model, a constant text;
 * NULL after the last. */
const char *ss_scene_simpler(ss_scene *simpler, const ss_scene *scene, size_t i);

#endif
