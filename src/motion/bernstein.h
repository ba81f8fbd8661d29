/* bernstein.h -- when a guard becomes negative inside one step, of which the derivatives are known. */
#ifndef BERNSTEIN_H
#define BERNSTEIN_H

#include "scene/model.h"

/* A guard within a step: level + p, or, if p is limited on either side, the smaller of that and
 * level - p. */
typedef struct step_guard {
    double level;
    int either_side;
    double at_0[ORDERS + 1], at_h[ORDERS + 1];      /* p and its derivatives at the ends */
    double h;                       /* from end to end, within the step caps */
    double rounding;                /* p is known to this, in units of 2^-50, besides its own size */
} step_guard;

/* *unresolved becomes 1 where rounding alone decides that there is none, or which it is. */
int ss_first_zero(const step_guard *g, double *s_event, int *unresolved);

#endif
