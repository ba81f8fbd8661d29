/* normal.h -- solve the normal equations for a step of least squares, damped and within ranges. */
#ifndef NORMAL_H
#define NORMAL_H

#include <stddef.h>

enum { NORMAL_MOST = 10 };              /* unknowns */

/* The undamped step solves a step = -g. */
typedef struct normal {
    size_t n;
    double a[NORMAL_MOST][NORMAL_MOST], g[NORMAL_MOST];
} normal;

/* The step for the diagonal of a times 1 + damping, with lo <= step <= hi: an unknown that would leave
 * its range goes to the end of the range, and the others are solved for again.  lo NULL: no ranges. */
void ss_normal_step(const normal *e, double damping, const double lo[], const double hi[],
                    double step[]);
/* The amount by which a step lowers the sum of squares, if the problem were linear. */
double ss_normal_gain(const normal *e, const double step[]);
/* The inverse of a, 0 in directions that a does not determine. */
void ss_normal_invert(const normal *e, double inverse[NORMAL_MOST][NORMAL_MOST]);

#endif
