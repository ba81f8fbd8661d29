/* bernstein.h -- find when a guard becomes negative inside one step, if its derivatives are known. */
#ifndef BERNSTEIN_H
#define BERNSTEIN_H

#include "scene/model.h"

enum { MOST_DEGREE = MOST_SERIES };

/* A guard within a step: level + p, or, if either_side is 1, the smaller of level + p and level - p. */
typedef struct step_guard {
    double level;
    int either_side;
    int degree;
    double p[MOST_DEGREE + 1];      /* p's coefficients in Bernstein's form */
    double h;                       /* length of the step */
    double rounding;                /* error of h p' in units of 2^-50, without that of p's own size */
} step_guard;

/* Set degree and p from the degree + 1 Taylor coefficients of p in s / h, and add their rounding. */
void ss_guard_by_series(step_guard *g, int degree, const double c[]);
/* 1 if these coefficients alone show that the guard does not become negative; its degree and p
 * need not be set. */
int ss_guard_is_clear(const step_guard *g, int degree, const double c[]);
/* Returns 1 if the guard becomes negative, at *s_event; 0 if it does not; -1 if a number is not
 * finite.  *unresolved becomes 1 if only rounding decides whether, or at which time, it does. */
int ss_first_zero(const step_guard *g, double *s_event, int *unresolved);

#endif
