/* slope.h -- stiffness of the contact as the slope of force over displacement. */
#ifndef SLOPE_H
#define SLOPE_H

#include <stickslip/features.h>
#include "find/window.h"

/* |df/dx| over the n windows, each from first to end in samples, with its standard error; y is the
 * signal that the windows were found in.  All hold finite numbers, else the slope is NaN; it is,
 * too, where it is not known within a third. */
ss_status ss_slope_find(const double *f, const double *x, const double *y, const ss_window *span,
                        size_t n, ss_value *slope);

#endif
