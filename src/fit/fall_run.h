/* fall_run.h -- the settled fall of a scene that is pulled, by simulation. */
#ifndef FALL_RUN_H
#define FALL_RUN_H

#include "fit/falls.h"

/* The time of the first settled fall of a scene from rest without force; NaN: it has none.  *steps grows by
 * the cost; *status becomes SS_ENOMEM if there is no memory. */
double ss_fall_find(const ss_scene *scene, double *steps, ss_status *status);
/* Write the force of the scene in the direction of its pull to y at the samples of a fall of the record, of
 * this rate [Hz]: the scene's fall at `time` is laid on the sample `onset`.  0 if it cannot be run. */
int ss_fall_sample(double *y, const ss_scene *scene, double time, double onset, const fall *w, double rate,
                   double *steps, ss_status *status);

#endif
