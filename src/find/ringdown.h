/* ringdown.h -- one damped oscillation shared by many short windows of a signal. */
#ifndef RINGDOWN_H
#define RINGDOWN_H

#include <stddef.h>
#include <stickslip/features.h>
#include "find/window.h"

/* What is beside the oscillation in a window: a line, or a constant and a sinusoid of the forcing. */
typedef enum slow_part { SLOW_EITHER, SLOW_LINE, SLOW_FORCED } slow_part;

typedef struct ringdown {
    /* given: */
    const double *x;            /* n samples */
    size_t n;
    const size_t *anchor;       /* n_anchors samples, in time order */
    size_t n_anchors;
    const ss_window *bar;       /* n_bars, in time order: no window crosses them */
    size_t n_bars;
    double w;                   /* per sample: where the search starts */
    double forcing;             /* per sample; 0: it is not known */
    slow_part is;               /* the better one if SLOW_EITHER; SLOW_FORCED needs the forcing */
    double white;               /* the rms of the white noise: what is left beyond it adds to the errors */
    /* found, with room for n_anchors: */
    ss_window *window;          /* of each anchor; empty, end = first: two periods could not be fitted */
    ss_value (*each)[2];        /* w and s of each window alone, per sample, with standard errors */
    ss_value all[2];            /* w and s of all; NaN: no window is left */
    int is_train;               /* micro-slips recur once a period, which passes for damping */
    double slow;                /* the forcing if the slow part is a sinusoid of it, 0: it is a line */
} ringdown;

/* Fit exp(-s t) (cos w t, sin w t) plus a line to a window about each anchor, w and s shared.  Where the
 * forcing is known and that is better, a constant and a sinusoid take the place of the line. */
ss_status ss_ringdown_fit(ringdown *r);

/* The same for windows of two periods that begin up to two before an anchor or one behind it, each fitted by
 * itself beside a line and kept if nine tenths of what is left of the line are the oscillation's: all is the
 * median of these, its error from their scatter, *scatter; NaN for under four. */
ss_status ss_ringdown_fit_each(ringdown *r, double *scatter);

/* Make the windows empty, and the values unknown, as before a fit. */
void ss_ringdown_clear(ringdown *r);

#endif
