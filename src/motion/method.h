/* method.h -- the methods that carry a motion, their properties, and which of them a scene gets. */
#ifndef METHOD_H
#define METHOD_H

#include "motion/engine.h"

typedef enum method_kind {
    CLOSED_FORM,            /* only rounding limits its accuracy: it has no tolerance */
    SERIES,                 /* the model's Taylor series */
    COLLOCATION,            /* implicit, and known inside its steps */
    ONE_STEP,               /* a GSL stepper that can repeat a step to know the state inside it */
    MULTISTEP               /* one that cannot */
} method_kind;

struct method {
    const char *name;
    method_kind kind;
    /* The cost of a right-hand side with the work beside it, in units of rk8pd's, and the number of
     * right-hand sides of a step.  ss-trade measured them on the state-variable scene, and they serve
     * only to compare methods. */
    double cost;
    unsigned rhs_a_step;
};

const struct method *ss_method_at(size_t i);               /* NULL after the last */

/* What is asked of a method, if none is named. */
typedef enum wish {
    USUAL,                  /* any tolerance, by steps: what ss_sim_run does */
    BEST                    /* the closed form; USUAL where there is none */
} wish;
/* Choose the method for a scene that has passed ss_scene_check. */
const struct method *ss_method_for(const ss_scene *scene, wish wanted);
/* Find the method of this name, or the USUAL one if it is NULL.  SS_EINVAL: there is none, or it cannot run
 * the scene. */
ss_status ss_method_named(const struct method **how, const char *name, const ss_scene *scene, ss_error *err);
/* The names of the methods that BEST means for scenes of this model. */
const char *ss_method_best_names(const ss_scene *scene);
/* Give the names of two methods that confirm each other, the better one first, both implicit if the scene
 * is stiff; 0 if there is no such pair.  Pair 1 serves where pair 0 does not agree: the closed form may
 * round more than steps do. */
int ss_method_pair(const ss_scene *scene, int pair, const char *name[2]);

/* Make the engine of a method, for the motion in its present state. */
ss_status ss_engine_new(engine **out, motion *m, const struct method *how, double tol, ss_error *err);

#endif
