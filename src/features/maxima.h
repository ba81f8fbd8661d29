/* maxima.h -- the maxima of a map whose lower parts are noise. */
#ifndef MAXIMA_H
#define MAXIMA_H

#include <stickslip/features.h>

/* ss_maxima_find of the map above floor, a |W| >= 0: a lower saddle counts as one at floor. */
ss_status ss_maxima_above(ss_maximum **out, size_t *n, const ss_coefficients *coefficients,
                          double min_prominence, double floor);

#endif
