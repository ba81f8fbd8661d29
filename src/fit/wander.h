/* wander.h -- coloured noise at uneven times: white, with a part that wanders and returns. */
#ifndef WANDER_H
#define WANDER_H

#include <stddef.h>
#include <stickslip/status.h>

typedef struct wander {
    double part;                /* of the variance, that wanders: 0 ... 1 */
    double memory;              /* its correlation falls as exp(-t / memory) > 0 [s] */
    int by_rows;                /* 1: memory counts rows, as behind a logger's filter */
} wander;

/* Write to `white` what n rows of so many columns are beyond their prediction from the rows before, in its
 * standard error (for a noise of variance 1); in and white may be the same.  Returns the sum of the logarithms of
 * these variances. */
double ss_wander_whiten(double *white, const wander *w, const double *t, const double *in, size_t n,
                        size_t columns);

/* Find the noise in the last of the columns, of which the others explain a part, by restricted maximum likelihood:
 * what they explain is no noise.  SS_ENOMEM. */
ss_status ss_wander_find(wander *w, const double *t, const double *in, size_t n, size_t columns);

/* The variance of n Gaussian numbers whose squares these are, by all but the largest tenth, which may be something
 * else; sorts them. */
double ss_wander_variance(double squares[], size_t n);

#endif
