/* next_cycle.h -- how a cycle of a signal differs from the next one, and at which lag it differs least. */
#ifndef NEXT_CYCLE_H
#define NEXT_CYCLE_H

#include <stddef.h>

#define CYCLE_WIDTH 0.2         /* relative difference of a cycle's period from the record's, at most */
enum { CYCLE_PARTS = 16 };      /* cycles that may be taken for one, at most */
enum { CYCLE_LAGS = 3 };        /* lags over 2, 4 and 8 cycles */

typedef struct view {           /* of the signal: all n samples, or averages of q */
    const double *x;
    size_t n;
} view;

typedef struct next_cycle {
    unsigned parts;             /* bit p: it repeats after 1/p of its length as well as after all of it, to
                                   within a sample */
    double lag;                 /* to the next cycle [samples]; NaN: there is no best one */
    double later[CYCLE_LAGS];   /* half of the lag over two cycles, a quarter of that over four ... */
    double likeness;            /* correlation with the next cycle */
    double symmetry;            /* correlation with itself half a cycle later */
    double mean;
    double energy, slopes;      /* mean squares of the signal, less its mean, and of its differences */
    double change, twice;       /* mean square differences from the next cycle and from the one after */
    double bend;                /* error of the lag between samples, by two parabolas [samples] */
} next_cycle;

/* The mean square difference of the m samples from i on and those lag later, each less their mean.  *a and *b
 * become the mean squares of both, *ab their mean product. */
double ss_view_difference(const view *v, size_t i, size_t lag, size_t m, double *a, double *b, double *ab);
/* The correlation of the m samples from i on with those lag later. */
double ss_view_correlation(const view *v, size_t i, size_t lag, size_t m);

/* Measure the cycle that begins at sample `first`, and its lag, within CYCLE_WIDTH of the period [samples].
 * coarse is fine averaged over q samples.  fine reaches (2 + CYCLE_WIDTH) periods and a few samples beyond. */
next_cycle ss_next_cycle(const view *fine, const view *coarse, size_t q, size_t first, double period);

#endif
