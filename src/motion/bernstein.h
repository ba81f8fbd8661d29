/* bernstein.h -- when a guard becomes negative inside one step, of which the derivatives are known. */
#ifndef BERNSTEIN_H
#define BERNSTEIN_H

#include "scene/model.h"

enum { MOST_DEGREE = MOST_SERIES };

/* A guard within a step: level + p, or, if p is limited on either side, the smaller of that and
 * level - p. */
typedef struct step_guard {
    double level;
    int either_side;
    int degree;
    double p[MOST_DEGREE + 1];      /* p's coefficients in Bernstein's form */
    double h;                       /* from end to end */
    double rounding;                /* h p' is known to this, in units of 2^-50, besides p's own size */
} step_guard;

/* Set degree and p from p and its ORDERS derivatives at the ends of a step h within the step caps. */
void ss_guard_by_ends(step_guard *g, const double at_0[], const double at_h[]);
/* From p's Taylor coefficients in s / h, degree + 1 of them; adds their rounding. */
void ss_guard_by_series(step_guard *g, int degree, const double c[]);
/* *unresolved becomes 1 where rounding alone decides that there is none, or which it is. */
int ss_first_zero(const step_guard *g, double *s_event, int *unresolved);

#endif
