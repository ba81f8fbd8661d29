/* ringdown.h -- one damped oscillation shared by many short windows of a signal. */
#ifndef RINGDOWN_H
#define RINGDOWN_H

#include <stddef.h>
#include <stickslip/features.h>

typedef struct ss_window {
    size_t first, end;          /* samples [first, end) */
} ss_window;

typedef struct ss_ringdown {
    const double *x;            /* the record, n samples */
    size_t n;
    double w, s;                /* omega and decay, per sample */
    double noise;               /* variance of the residual */
    size_t n_windows;
    ss_window *window;
} ss_ringdown;

/* Fit exp(-s t) (cos w t, sin w t) plus a line to a window about each of the n_anchors samples
 * given, w and s shared, starting from w.  window[i] is that of anchor i on return, empty (end =
 * first) where less than two periods could be fitted.  value gets w and s, per sample, with standard
 * errors; each[2 i], each[2 i + 1] those of window i alone.  All are NaN if no window is left. */
ss_status ss_ringdown_fit(const double *x, size_t n, const size_t *anchor, size_t n_anchors,
                          double w, ss_window *window, ss_value value[2], ss_value *each);

#endif
