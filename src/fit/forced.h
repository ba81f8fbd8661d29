/* forced.h -- a scene whose base moves: its variants, and the variant whose motion is that of a record. */
#ifndef FORCED_H
#define FORCED_H

#include <stickslip/scene.h>
#include "base/progress.h"
#include "fit/cycle.h"
#include "fit/column.h"
#include "scene/key.h"

/* The unknowns of a fit.  Keys, FREQUENCY and SIZE are logarithms. */
enum {
    FORCED_STIFFNESS, FORCED_RATIO, FORCED_OWN, FORCED_KEYS = FORCED_OWN + PARAMETERS,
    FORCED_FREQUENCY = FORCED_KEYS, FORCED_PHASE, FORCED_X0, FORCED_V0, FORCED_MOVED,
    FORCED_SIZE = FORCED_MOVED, FORCED_OFFSET, FORCED_UNKNOWNS
};
enum { FORCED_SETTLE = 6 };         /* cycles from rest to the one compared */
enum { FORCED_KEPT = 8 };           /* the most starts that are kept */
#define FORCED_RUNS 150             /* simulations that a fit takes, typically; 30 to 600 */

/* The keys are the stiffness k (at the same k Z_e), f_k / (k Z_e), and the parameters that the model
 * lists.  The mass is not adjusted: no motion determines it, as only ratios to it count.  Damping of the
 * mass and f_s / f_k stay as they are given. */
typedef struct forced {
    const ss_model *model;
    ss_scene scene;             /* as given, normalised */
    int pick;                   /* the compared quantity: an index of ss_sim_columns' */
    double period;              /* of the base, about [s] */
    size_t n;                   /* keys that the model has */
    double own[FORCED_KEYS];    /* the scene's, as logarithms */
    ss_range range[FORCED_KEYS];    /* of a fit; a key whose range has no width is held */
    ss_stretch progress;
    double steps, budget;       /* integration steps so far, and at most: then work ends */
} forced;

/* Where a fit starts: keys, and the misfit, size and shift of their settled cycle, see ss_cycle_misfit. */
typedef struct forced_start {
    double key[FORCED_KEYS];
    double misfit, size, shift;
} forced_start;

/* The start of the motion, and the units of unknowns. */
typedef struct forced_origin {
    double lead;                /* time from the start to the first sample [s] */
    double frequency;           /* [Hz] */
    double turn;                /* unit of FREQUENCY: the relative change of the frequency that shifts
                                   the ends of the record by about a radian */
    double x_unit, v_unit;      /* 0: from rest */
} forced_origin;

typedef struct forced_fit {
    forced_origin origin;
    double u[FORCED_MOVED];     /* the unknowns that move the motion; the keys come first */
    ss_scene scene;             /* its motion is the record less offset and residual */
    double settled[FORCED_KEYS];    /* the keys of the best settled motion */
    residue of_samples;         /* away from events */
    double left_all;            /* mean square of the residual over all samples that are not missing */
    double covariance[FORCED_UNKNOWNS][FORCED_UNKNOWNS];    /* for noise of variance 1; NaN: no fit */
} forced_fit;

/* --- forced.c: variants, and a search among them ------------------------------------------- */

/* SS_OK for a scene in range whose base moves. */
ss_status ss_forced_check(const ss_scene *scene, ss_error *err);
/* The scene's own keys, each free within a factor, >= 1. */
forced ss_forced_of(const ss_scene *scene, int pick, double factor);
/* The scene of some keys with the drive k Z_e of c->scene, settled from rest at phase 0. */
ss_scene ss_forced_scene(const forced *c, const double key[FORCED_KEYS], double period);
/* The scene whose motion is size times that of s. */
ss_scene ss_forced_resized(const forced *c, ss_scene s, double size);
/* The distance of keys from the scene's own: the root mean square of the differences of their
 * logarithms and of the mass's, for the mass that minimises it. */
double ss_forced_distance(const forced *c, const double key[FORCED_KEYS]);
/* The name of a key in scenes. */
const char *ss_forced_key_name(const forced *c, size_t key);

/* Find *n starts, the best first: try `points` all over the ranges and improve the best
 * keep <= FORCED_KEPT of them.  If none of them moves, the misfit is all of the
 * cycle.  SS_ENOMEM, SS_STOP. */
ss_status ss_forced_search(forced_start start[FORCED_KEPT], size_t *n, forced *c, const cycle *goal,
                           size_t points, size_t keep);

/* --- forced_fit.c -------------------------------------------------------------------------- */

/* Find the best of the fits of a scene, its keys within their ranges, to a record from the starts of a search for
 * its cycle, and *rival, what the best with other keys leaves; infinite: there is none.  If rival is NULL, the
 * first that explains the record is enough.  If no scene slips, can be run, or the budget is used up, the residual
 * is the record.  SS_ENOMEM, SS_STOP. */
ss_status ss_forced_fit(forced_fit *best, double *rival, forced *c, const cycle *goal, size_t points, size_t keep,
                        const rank_record *record);
/* Fit the motion of a fit to a record of another quantity, c->pick, of the same time. */
ss_status ss_forced_refit(forced_fit *m, forced *c, const forced_fit *from, const rank_record *record);
/* The damping of the mass and f_s / f_k, which are the scene's, and the lag of a sensor of first order (or its
 * opposite), which is none. */
typedef enum forced_term { HELD_DAMPING, HELD_STATIC, HELD_LAG, HELD_TERMS } forced_term;

typedef struct forced_held {
    double gain;                /* by how many times the variance left, at least RESIDUE_QUIET of the power,
                                   the sum of squares would be less if the fit adjusted the term too */
    double nearer;              /* the damping [N s/m] or f_s / f_k that it would find; NaN for the lag */
} forced_held;

/* Would the record have the terms that a fit holds otherwise?  If its motion cannot be run, each gain is 0.
 * SS_ENOMEM. */
ss_status ss_forced_gains(forced_held of[HELD_TERMS], const forced *c, const forced_fit *m,
                          const rank_record *record);

/* forced_rank.c: rank the scenes of r's rows, whose base moves. */
ss_status ss_forced_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                            const ss_rank_opts *opts, ss_error *err);

#endif
