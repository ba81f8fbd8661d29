/* candidate.h -- a scene and its variants, and the variant whose settled cycle is nearest to a given
 * one. */
#ifndef CANDIDATE_H
#define CANDIDATE_H

#include <stickslip/scene.h>
#include <stickslip/sim.h>
#include "base/progress.h"
#include "scene/key.h"
#include "fit/cycle.h"

enum { CANDIDATE_STIFFNESS, CANDIDATE_RATIO, CANDIDATE_OWN, CANDIDATE_KEYS = CANDIDATE_OWN + PARAMETERS };
enum { CANDIDATE_SETTLE = 6 };      /* cycles from rest to the one compared */
enum { CANDIDATE_KEPT = 8 };        /* the most starts that are kept */

/* The end of a search: the keys, and the misfit, size and shift of their scene, see ss_cycle_misfit. */
typedef struct candidate_start {
    double key[CANDIDATE_KEYS];
    double misfit, size, shift;
} candidate_start;

/* The keys are the stiffness k (at the same k Z_e), f_k / (k Z_e), and the parameters that the model
 * lists.  The mass is not adjusted: no motion determines it, as only ratios to it count.  Damping of the
 * mass and f_s / f_k stay as they are given. */
typedef struct candidate {
    const ss_model *model;
    ss_scene scene;             /* as given, normalised */
    int pick;                   /* the compared quantity: an index of ss_sim_row's */
    size_t n;                   /* keys that the model has */
    double own[CANDIDATE_KEYS];             /* the scene's, as logarithms */
    double lo[CANDIDATE_KEYS], hi[CANDIDATE_KEYS];  /* of the search; equal for a fixed key */
    candidate_start start[CANDIDATE_KEPT];          /* the best first, no two the same */
    size_t n_starts;
    double steps;               /* integration steps of all runs so far */
    double budget;              /* of these steps: the search ends when it is used up */
} candidate;

/* SS_OK for a scene in range whose base moves. */
ss_status ss_candidate_check(const ss_scene *scene, ss_error *err);
/* The scene's own keys, each free within a factor, >= 1. */
candidate ss_candidate_of(const ss_scene *scene, int pick, double factor);
/* Find c->start: try `starts` points all over the range and improve the best keep <= CANDIDATE_KEPT of
 * them, each by at most `steps` steps.  SS_OK also if none of them moves: then the misfit is all of the
 * cycle.  SS_STOP if the progress function stops it. */
ss_status ss_candidate_search(candidate *c, const cycle *goal, size_t starts, size_t keep,
                              size_t steps, const ss_stretch *progress);
/* The scene of some keys with the drive k Z_e of c->scene, settled from rest at phase 0. */
ss_scene ss_candidate_scene(const candidate *c, const double key[CANDIDATE_KEYS], double period);
/* The scene whose motion is size times that of s. */
ss_scene ss_candidate_resized(const candidate *c, ss_scene s, double size);
/* The distance of keys from the scene's own: the root mean square of the differences of their
 * logarithms and of the mass's, for the mass that minimises it. */
double ss_candidate_distance(const candidate *c, const double key[CANDIDATE_KEYS]);
/* The name of a key in scenes. */
const char *ss_candidate_key_name(const candidate *c, size_t key);

#endif
