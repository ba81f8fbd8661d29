/* drops.h -- the falls of a force that has loaded in a stick, and the height that they have. */
#ifndef DROPS_H
#define DROPS_H

#include <stddef.h>
#include <stickslip/signal.h>

#define DROPS_RELOAD 0.25       /* part of the height asked for: a rise by it ends a fall of ss_drops_find then */

/* A fall: the samples of its maximum and of the minimum behind it. */
typedef struct ss_drop {
    size_t high, low;
} ss_drop;

/* Find all falls of n finite samples x by more than height > 0, in time order.  The caller frees *out with free().
 * A fall ends where x has risen again by reload, so a slow drift is no fall.  Single wrong samples
 * have no effect; white noise changes heights by some 3 % of height. */
ss_status ss_drops_find(ss_drop **out, size_t *n_drops, const double *x, size_t n, double height, double reload);

typedef struct ss_typical {
    double height;              /* it separates falls from noise; 0: falls have no typical height */
    size_t more, less;          /* more: falls above half of it, or above the noise; less: falls above twice
                                   it */
} ss_typical;

/* Find the height of the falls of x, which has n samples. */
ss_status ss_drops_typical(const double *x, size_t n, ss_typical *out);

/* Copy the n samples of x to y.  A single wrong sample, which differs from its neighbours by more than
 * the noise and a part of the median drop, is replaced by their median. */
ss_status ss_drops_without_glitches(double *y, const double *x, size_t n, const ss_drop *drop,
                                    size_t n_drops);

#endif
