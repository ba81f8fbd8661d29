/* least.h -- the one least squares of all fits: a model function, a start, and the ranges of its unknowns. */
#ifndef LEAST_H
#define LEAST_H

#include <stddef.h>
#include <stickslip/status.h>

/* What a model makes of its unknowns u.  If slopes is NULL, write the residuals, in one unit or in their
 * standard errors.  Else these are there already, and slopes, which is 0 everywhere, takes their slopes:
 * slopes[row * unknowns + k] by unknown k.  SS_EDATA: u has no model, and a shorter step is tried; any
 * other failure ends the fit. */
typedef ss_status least_model(const double *u, double *residual, double *slopes, void *user);

typedef struct least {
    size_t rows, unknowns;      /* rows >= unknowns that are free >= 1 */
    least_model *model;
    void *user;
    const ss_range *range;      /* of each unknown; from == to: it is held; NULL: all are free */
    const double *difference;   /* a step of each unknown for its slopes; NULL: the model gives slopes */
    int costly;                 /* 1: slopes are kept as long as steps by them gain as they predict; they may
                                   then be wanted for another u than the residuals written last */
    double farthest;            /* the longest step of an unknown, as slopes do not hold farther; 0: any */
    size_t steps;               /* at most; 0: 60 */
    double tol;                 /* a step ends the fit if no unknown changes by more than this part of it, */
    double noise;               /* or if it lessens the squares by less than a hundredth of this variance of a
                                   residual, */
    double gain;                /* and this part of what is left beyond twice the noise */
} least;

typedef struct least_end {
    int converged;
    const char *why;            /* if it has not converged */
    double squares;             /* sum of the squares of the residuals at the end */
    size_t steps;
} least_end;

/* Move u, the start, to the least sum of squares near it.
 *
 * needs:  u within its ranges
 * gives:  the best u found, also where the fit has not converged; residual[rows] there, and the covariance
 *         [unknowns * unknowns] for residuals of variance 1: 0 for what is held, infinite variance for what
 *         the residuals do not show (either may be NULL)
 * fails:  SS_ENOMEM, or as the model does; not for want of convergence */
ss_status ss_least_fit(least_end *end, const least *fit, double u[], double *residual, double *covariance);

/* The same for residuals that are linear in n unknowns: y less the columns [row * n + k] times c.  Columns
 * that others explain get their share of c; values must be finite.  covariance[n * n], for a variance of 1, may
 * be NULL.  SS_ENOMEM. */
ss_status ss_least_linear(const double *columns, const double *y, size_t rows, size_t n, double c[],
                          double *squares, double *covariance);

#endif
