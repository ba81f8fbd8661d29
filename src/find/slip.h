/* slip.h -- the slip of a pulled slider, seen in the force of its spring. */
#ifndef SLIP_H
#define SLIP_H

#include <stickslip/features.h>
#include "find/window.h"

/* The order of the numbers of a slip. */
enum { SLIP_ONSET, SLIP_END, SLIP_DROP, SLIP_DURATION, SLIP_TOP, SLIP_MIDDLE, SLIP_K_OVER_M, SLIP_NUMBERS };
#define SLIP_EXPLAINED 0.98     /* part of the sum of squares: a fit that explains less is another shape */
enum { SLIP_PARTS = 24 };       /* parts of the time from one length of the slip before it to one behind it */

/* Times in samples, forces in the unit of the samples. */
typedef struct ss_slip {
    ss_value onset, end;        /* the end of the stick before, and the begin of the next */
    ss_value drop, duration;    /* between onset and end; duration of the middle part, from 10 to 90 % */
    ss_value top, middle;       /* the force at the onset; the friction in slip */
    ss_value k_over_m;          /* [rad^2/sample^2] */
    ss_value damping;           /* ratio */
    double shift[SLIP_NUMBERS]; /* by which each changes with damping, if that is fitted */
    double left, power;         /* sums of squares of the samples: of the residuals, and about the mean */
    double n;                   /* number of samples; 0: not fitted */
    double variance;            /* of a sample: the errors come from it */
    double residual[SLIP_PARTS];        /* mean residual of each part over the drop; NaN: no sample lies in
                                           it */
} ss_slip;

/* Fit a slip to the fall of x from sample high to sample low, between loadings by so much per sample > 0, with a
 * damping in a range, whose middle is the start.  Only samples in room are used.  If the slip does not explain the
 * fall, all of *out is NaN and n is 0. */
ss_status ss_slip_fit(ss_slip *out, const double *x, ss_window room, size_t high, size_t low, double loading,
                      ss_range damping);

/* *sign becomes 1 if the slip explains the samples about it better than a relaxation between the same
 * loadings, -1 if it does not, 0 if there are too few samples or no fit.  Only samples in room are used.
 * loading: the slope of the loadings in the slip's fit. */
ss_status ss_inertia_sign(int *sign, const double *x, ss_window room, const ss_slip *slip, double loading);

#endif
