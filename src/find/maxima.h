/* maxima.h -- the maxima of a map whose lower parts are noise. */
#ifndef MAXIMA_H
#define MAXIMA_H

#include <stickslip/features.h>

typedef struct maxima_kind {
    double prominence, range;   /* [dB] the least, and how far below the highest of them */
    double floor;               /* |W| >= 0: a lower saddle counts as one at it */
} maxima_kind;

/* Find the maxima of |W| outside the cone of influence, in time order; *top becomes ss_coefficients_max of what is
 * read.  The translations of neighbouring scales differ: the neighbours of a coefficient are those beside it in its
 * row, and in the two rows beside it those nearest in time.  A highest point on the border of the map (its first and
 * last scale, or beside the cone) is no maximum.  Nor is a point near a gap, but a saddle may lie there.  *out is to
 * be freed. */
ss_status ss_maxima_of(ss_maximum **out, size_t *n, const ss_coefficients *map, const maxima_kind *kind, double *top);
/* The same along one row of a map whose ss_coefficients_max is top. */
ss_status ss_maxima_of_row(ss_maximum **out, size_t *n, const ss_coefficients *map, size_t row,
                           const maxima_kind *kind, double top);

#endif
