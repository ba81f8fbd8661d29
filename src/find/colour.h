/* colour.h -- how many samples of a residual count as one independent sample. */
#ifndef COLOUR_H
#define COLOUR_H

#include <stddef.h>

/* The variance of the mean of n residuals y[i] - slope x[i] (x NULL: slope i) over that of white residuals
 * of the same size: 1 ... n. */
double ss_colour(const double *y, const double *x, size_t n, double slope);

#endif
