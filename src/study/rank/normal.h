/* normal.h -- a step of least squares, damped and within ranges, from its normal equations. */
#ifndef NORMAL_H
#define NORMAL_H

#include <stddef.h>

enum { NORMAL_MOST = 10 };              /* unknowns */

/* The undamped step solves a step = -g. */
typedef struct normal {
    size_t n;
    double a[NORMAL_MOST][NORMAL_MOST], g[NORMAL_MOST];
} normal;

/* The step, the diagonal of a raised by the part damping, with lo <= step <= hi: unknowns that would
 * leave theirs go to its end, and the others are solved for again. */
void ss_normal_step(const normal *e, double damping, const double lo[], const double hi[],
                    double step[]);
/* How much a step lowers the sum of squares if slopes are all there is to it. */
double ss_normal_gain(const normal *e, const double step[]);
/* The inverse of a, 0 in directions of which it knows nothing. */
void ss_normal_invert(const normal *e, double inverse[NORMAL_MOST][NORMAL_MOST]);

#endif
