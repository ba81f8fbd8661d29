/* loaded.h -- rate and state fitted to the friction of a load point whose speed changes. */
#ifndef LOADED_H
#define LOADED_H

#include <stddef.h>
#include <stickslip/steps.h>

/* A place of the load point between two rows; NaN: there is none. */
typedef struct corner {
    double t, load;
} corner;

/* A record around one step. */
typedef struct track {
    size_t n;
    double *t, *load, *mu;      /* [s], [m] from the first row on, friction */
    size_t change[2], changes;  /* rows at which the speed changes */
    corner corner[2];           /* of each change */
    double speed;               /* before them [m/s] > 0 */
} track;

/* Fit one law.  stiffness [1/m]; 0: it is found.  model[n] becomes the law's friction.  SS_ENOMEM. */
ss_status ss_loaded_fit(ss_step_law *out, double *model, const track *record, int is_slip, double stiffness);

#endif
