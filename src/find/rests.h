/* rests.h -- the stretches in which a signal stands still at one level. */
#ifndef RESTS_H
#define RESTS_H

#include <stickslip/status.h>
#include "find/window.h"

typedef struct ss_rests {
    size_t n;
    ss_window *rest;            /* in time order; to be freed */
    int is_doubtful;            /* 1: others may be rests, too, or some of these none */
    int is_end_of_range;        /* 1: no sample lies beyond the level, on one side, and it is not 0 */
    double level, band;         /* the samples of a rest are within the band about the level */
} ss_rests;

/* Find the rests of n samples x.  n = 0: it does not rest. */
ss_status ss_rests_find(const double *x, size_t n, ss_rests *out);

#endif
