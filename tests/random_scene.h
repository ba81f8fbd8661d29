/* random_scene.h -- scenes drawn log-uniformly from the ranges that stickslip-scene(5) says are supported. */
#ifndef RANDOM_SCENE_H
#define RANDOM_SCENE_H

#include <math.h>
#include <stdint.h>
#include <string.h>
#include <stickslip.h>

enum { RANDOM_SAMPLES = 400, RANDOM_STEPS = 4000 };

typedef struct rng { uint64_t s; } rng;

/* splitmix64 (Steele, Lea & Flood 2014) */
static inline double
uniform(rng *r)
{
    uint64_t z = r->s += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ z >> 31) >> 11) * 0x1p-53;
}

static inline double
between(rng *r, double from, double to)
{
    return from * pow(to / from, uniform(r));
}

/* One time in two none of it; else of either sign, if that is asked for. */
static inline double
perhaps(rng *r, double from, double to, int is_signed)
{
    double x = between(r, from, to), sign = is_signed && uniform(r) < .5 ? -1 : 1;
    return uniform(r) < .5 ? 0 : sign * x;
}

enum { RIG_PERIODS = 30, RIG_SAMPLES = 300 };

/* Scenes before this number are of the first RANDOM_OLDER models of the list, without terms: some were measured,
 * and are known by their numbers.  Those from it on have terms, and are of the last of these and all behind it. */
enum { RANDOM_NEWER = 1000000, RANDOM_OLDER = 4 };
/* A scene of any of these models, within the ranges of the model. */
ss_scene random_scene(uint64_t number);
/* A Coulomb or compliant scene with all keys, each of which one time in two does nothing. */
ss_scene random_rig(uint64_t number);
/* The same with a gap and another friction and stiffness of the other side. */
ss_scene random_contact(uint64_t number);

/* A range in which results are verified; the manual shows these ranges. */
typedef struct scene_range {
    const char *name, *unit;    /* "Omega/omega_n"; stickslip-scene(5) defines X */
    double from, to;
    int zero;                   /* 1: 0 belongs to the range too */
    const char *key;            /* of a number; NULL: it is computed by `of` alone */
    double (*of)(const ss_scene *scene);        /* the number's unit, 0 where it has no meaning */
    const char *model;          /* that has it; NULL: every */
} scene_range;
/* The i-th range of the scenes of a model; NULL after the last. */
const scene_range *range_of(const ss_model *model, size_t i);
/* The name of a range that a scene is not within; NULL: it is within all. */
const char *outside_of(const ss_scene *scene);

#endif
