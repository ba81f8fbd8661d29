/* cycle.h -- the mean cycle of a periodic signal, and the distance between two cycles. */
#ifndef CYCLE_H
#define CYCLE_H

#include <stddef.h>
#include <stickslip/status.h>
#include "base/fft.h"

enum { CYCLE_LEAST = 64, CYCLE_MOST = 1024 };

typedef struct cycle {
    double period;              /* [s] */
    size_t n;                   /* bins, a power of two, CYCLE_LEAST ... CYCLE_MOST */
    double y[CYCLE_MOST];       /* means of the samples in each bin, about their own mean */
    double power;               /* of y: its mean square */
    double noise;               /* variance of a bin's mean, from the scatter within bins, which
                                   includes motion that does not repeat */
} cycle;

/* The cycle of a signal whose values are finite, at the given frequency [Hz], or at the one found if that is 0.
 * If no cycle is significant, c->period is 0 and why (of the given size), which is empty, states the reason.
 * missing is 1 for each sample that stands in a gap and is left out; NULL: none does.  SS_ENOMEM. */
ss_status ss_cycle_find(cycle *c, char *why, size_t size, const double *x, const char *missing, size_t n,
                        double rate, double frequency);

/* A cycle that others are compared with. */
typedef struct cycle_goal {
    const cycle *c;
    double term[CYCLE_MOST + 2];        /* of its spectrum, over n */
    real_fft forward, back;
} cycle_goal;

ss_status ss_cycle_goal_new(cycle_goal *goal, const cycle *c);  /* SS_ENOMEM */
void ss_cycle_goal_free(cycle_goal *goal);

/* The mean square of the goal less *a times m shifted by *shift cycles, for the best *a >= 0 and *shift.
 * m has the goal's n bins. */
double ss_cycle_misfit(const cycle_goal *goal, const double *m, double *a, double *shift);

#endif
