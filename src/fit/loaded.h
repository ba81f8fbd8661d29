/* loaded.h -- rate and state fitted to the friction of a load point whose speed changes. */
#ifndef LOADED_H
#define LOADED_H

#include <stddef.h>
#include <stickslip/steps.h>

/* Where the load point is at a time, between which it moves evenly; the part that friction there has in a row. */
typedef struct place {
    double t, load;
    size_t row;
    double share;
} place;

/* A record around one step. */
typedef struct track {
    size_t n;
    double *t, *load, *mu;      /* [s], [m] from the first row on, friction */
    size_t change[2], changes;  /* rows at which the speed changes */
    place *place;               /* in the order of time */
    size_t places;
    double speed;               /* before them [m/s] > 0 */
    double digit;               /* of friction, or 0 */
    double blur;                /* standard error of where the load point is then [m] */
} track;

#define LOADED_DECISIVE 5       /* difference of logarithms of likelihood that tells two laws, or two fits */

typedef struct loaded loaded;

/* Find where the fit of both laws to a record starts, which the caller keeps; other: the same along another path, or
 * NULL.  stiffness [1/m]; 0: it is found.  *out is to be freed even after SS_ENOMEM. */
ss_status ss_loaded_new(loaded **out, const track *record, const loaded *other, double stiffness);
/* Fit both laws to each of these steps; to several with one a, b, Dc and stiffness.  SS_ENOMEM. */
ss_status ss_loaded_fit(loaded *const step[], size_t n);
/* model[n] of one, then the other law becomes their friction; numbers of a law that has no fit are NaN. */
ss_status ss_loaded_report(loaded *step, ss_step_law out[SS_STEP_LAWS], double *model);
void ss_loaded_free(loaded *step);

#endif
