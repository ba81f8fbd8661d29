/* candidate.h -- a scene and its like, and the one of them whose settled cycle is nearest to
 * another. */
#ifndef CANDIDATE_H
#define CANDIDATE_H

#include <stickslip/scene.h>
#include <stickslip/sim.h>
#include "base/progress.h"
#include "scene/key.h"
#include "study/rank/cycle.h"

enum { CANDIDATE_STIFFNESS, CANDIDATE_RATIO, CANDIDATE_OWN, CANDIDATE_KEYS = CANDIDATE_OWN + PARAMETERS };
enum { CANDIDATE_SETTLE = 6 };      /* cycles from rest to the one compared */
#define CANDIDATE_STEPS 1e7         /* of all runs of a search, 10 times the usual: some 6 s of CPU time */

/* Its keys: the stiffness k (at the same k Z_e), f_k / (k Z_e), and the parameters that the model
 * says.  The mass is left alone, as no motion tells it: what counts is the ratios
 * to it. */
typedef struct candidate {
    const struct model *model;
    ss_scene scene;             /* as given, normalised */
    int pick;                   /* what is compared: an index of ss_sim_row's */
    size_t n;                   /* keys that the model has */
    double own[CANDIDATE_KEYS];             /* the scene's, as logarithms */
    double lo[CANDIDATE_KEYS], hi[CANDIDATE_KEYS];  /* of the search; the same for what is fixed */
    double best[CANDIDATE_KEYS];
    double misfit;              /* mean square that it leaves of the cycle */
    double size, shift;         /* see ss_cycle_misfit */
    double steps;               /* of all runs so far: the cost of the search */
} candidate;

/* SS_OK for a scene in range whose base moves. */
ss_status ss_candidate_check(const ss_scene *scene, ss_error *err);
/* What the scene says, and each key free within a factor, >= 1. */
candidate ss_candidate_of(const ss_scene *scene, int pick, double factor);
/* Find c->best and what follows: starts points all over the range, and the keep best of them each
 * improved by steps at most.  SS_OK also where none of them moves: then all is left; SS_STOP if told
 * to stop; SS_EBUDGET once the runs have taken CANDIDATE_STEPS. */
ss_status ss_candidate_search(candidate *c, const cycle *goal, size_t starts, size_t keep,
                              size_t steps, const ss_stretch *progress);
/* The scene of the best keys, driven at the cycle's period; its sizes are those of the cycle, and
 * at phase 0 it stands where the cycle begins. */
ss_scene ss_candidate_scene(const candidate *c, const cycle *goal);
/* How far the best keys are from the scene's own: the root mean square of their logarithms, and of
 * the mass's, for that mass which makes it least. */
double ss_candidate_distance(const candidate *c);

/* The n samples of a scene's record, of the quantity pick, in at most CANDIDATE_STEPS / 10;
 * *steps grows by their number.  As ss_sim_run, or SS_EDATA. */
ss_status ss_candidate_run(const ss_scene *scene, int pick, double *value, size_t n, double *steps);

#endif
