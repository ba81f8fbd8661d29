/* samples.h -- the samples of a scene's motion, at the accuracy and cost that a comparison asks for. */
#ifndef SAMPLES_H
#define SAMPLES_H

#include <stddef.h>
#include <stickslip/scene.h>
#include <stickslip/status.h>

enum { SAMPLES_REACH = 18 };        /* samples */
#define SAMPLES_FINE 1e-7           /* tolerances: for differences of two motions, and for their sizes */
#define SAMPLES_COARSE 1e-5

/* The n samples of a scene's record, of the quantity pick; without a closed form to some thirty times
 * the tolerance.  clear, unless it is NULL, becomes the distance of each to the nearest event, in
 * samples, if that is at most SAMPLES_REACH, else infinite.  *steps grows by
 * the cost.  As ss_sim_run, or SS_EDATA. */
ss_status ss_samples_run(const ss_scene *scene, int pick, double tol, double *value, double *clear,
                         size_t n, double *steps);

#endif
