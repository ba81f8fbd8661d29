/* samples.h -- samples of a scene's motion, with the accuracy and cost that a comparison needs. */
#ifndef SAMPLES_H
#define SAMPLES_H

#include <stddef.h>
#include <stickslip/scene.h>
#include <stickslip/sim.h>
#include <stickslip/status.h>

enum { SAMPLES_REACH = 18 };        /* samples */
enum { SAMPLES_A_STEP = 4 };        /* samples that cost about as much as an integration step */
#define SAMPLES_FINE 1e-7           /* tolerances: for differences of two motions, and for their sizes */
#define SAMPLES_COARSE 1e-5

/* The method and limits of a run whose samples or events are compared. */
ss_sim_opts ss_samples_opts(const ss_scene *scene, double tol);

/* The n samples of a scene's record, of the quantity pick; without a closed form their error is
 * some thirty times the tolerance.  clear[i], unless clear is NULL, becomes the distance of sample
 * i from the nearest event, in samples; infinite beyond SAMPLES_REACH.  *steps grows by the cost.
 * Fails as ss_sim_run, or with SS_EDATA. */
ss_status ss_samples_run(const ss_scene *scene, int pick, double tol, double *value, double *clear,
                         size_t n, double *steps);

#endif
