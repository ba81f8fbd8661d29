/* inertia.h -- whether the falls of a force are the slips of a mass. */
#ifndef INERTIA_H
#define INERTIA_H

#include "find/slip.h"

/* *sign becomes 1 if the slip explains the samples about it better than a relaxation between the same
 * loadings, -1 if it does not, 0 if there are too few samples or no fit.  Only samples in room are used.
 * loading: the slope of the loadings in the slip's fit. */
ss_status ss_inertia_sign(int *sign, const double *x, ss_window room, const ss_slip *slip, double loading);

#endif
