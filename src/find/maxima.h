/* maxima.h -- the maxima of a map whose lower parts are noise. */
#ifndef MAXIMA_H
#define MAXIMA_H

#include <stickslip/features.h>
#include "find/window.h"

/* ss_maxima_find of the map above floor, a |W| >= 0, and in some places only: a lower saddle, and one elsewhere,
 * counts as one at floor.  *top: ss_coefficients_max of what is read. */
ss_status ss_maxima_above(ss_maximum **out, size_t *n, const ss_coefficients *map,
                          double min_prominence, double floor, search_places at, double *top);
/* ss_maxima_along of the map whose ss_coefficients_max is top. */
ss_status ss_maxima_of_row(ss_maximum **out, size_t *n, const ss_coefficients *map, size_t row,
                           double top, double range, double min_prominence, search_places at);

#endif
