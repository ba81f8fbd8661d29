/* colour.h -- how many samples of a residual count as one independent sample. */
#ifndef COLOUR_H
#define COLOUR_H

#include <stddef.h>

/* The factor of the variance of a mean of n residuals y[i] - slope x[i] (x NULL: slope i) about
 * their mean over that of white ones of the same size; 1 ... n. */
double ss_colour(const double *y, const double *x, size_t n, double slope);

#endif
