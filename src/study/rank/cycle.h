/* cycle.h -- the mean cycle of a periodic signal, and how far one is from another. */
#ifndef CYCLE_H
#define CYCLE_H

#include <stddef.h>
#include <stickslip/status.h>
#include "base/progress.h"

enum { CYCLE_LEAST = 64, CYCLE_MOST = 1024 };

typedef struct cycle {
    double period;              /* [s] */
    size_t n;                   /* bins, a power of two, CYCLE_LEAST ... CYCLE_MOST */
    double y[CYCLE_MOST];       /* means of the samples in each bin, about their own mean */
    double power;               /* of y: its mean square */
    double noise;               /* variance of a bin's mean, from the scatter within bins: what does
                                   not repeat is in it too */
} cycle;

/* Fold n samples at rate [Hz] at the period, of which the record must hold one at least, with
 * CYCLE_LEAST samples or more in it.  missing, here and below, is 1 for each sample that stands in a
 * gap and is left out; NULL: none does. */
ss_status ss_cycle_fold(cycle *c, const double *x, const char *missing, size_t n, double rate,
                        double period, ss_error *err);
/* The period within part of the given one (0.01: from 0.99 to 1.01) at which most power repeats. */
double ss_cycle_period(const double *x, const char *missing, size_t n, double rate, double period,
                       double part);

/* The cycle of a signal whose values are finite: at the frequency [Hz] given or, if that is 0,
 * found.  *why (of the given size) is filled in where there is none that says anything, and
 * c->period is then 0.  SS_STOP if progress asks for it. */
ss_status ss_cycle_find(cycle *c, char *why, size_t size, const double *x, const char *missing,
                        size_t n, double rate, double frequency, const ss_stretch *progress);

/* The mean square that is left of c when a times m, shifted by *shift cycles, is taken from it, a
 * >= 0 and the shift being the best.  m has c's n bins. */
double ss_cycle_misfit(const cycle *c, const double *m, double *a, double *shift);

#endif
