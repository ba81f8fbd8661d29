/* ringdown.h -- one damped oscillation shared by many short windows of a signal. */
#ifndef RINGDOWN_H
#define RINGDOWN_H

#include <stddef.h>
#include <stickslip/features.h>
#include "find/window.h"

/* Fit exp(-s t) (cos w t, sin w t) plus a line to a window about each of the n_anchors samples
 * given, w and s shared, starting from w. Where the forcing's omega per sample is known and that is
 * better, a constant and a sinusoid take the place of the line; 0: it is not. window[i] is that of
 * anchor i on return, empty (end = first) where less than two periods could be fitted. value gets w
 * and s, per sample, with standard errors; each[2 i], each[2 i + 1] those of window i alone. All are
 * NaN if no window is left; errors are infinite where micro-slips recur once a period, which passes
 * for damping. white is the rms of the white noise: what is left beyond it adds to the
 * errors.  No window has a sample of the gaps in it, which are in time order. */
ss_status ss_ringdown_fit(const double *x, size_t n, const size_t *anchor, size_t n_anchors,
                          double w, double forcing, double white, const ss_window *gap,
                          size_t n_gaps, ss_window *window, ss_value value[2], ss_value *each);

/* The same for windows of two periods that begin up to two before an anchor or one behind it, each
 * fitted by itself beside a line and kept if nine tenths of what is left of the line are the
 * oscillation's: value is the median of these, its error from their scatter; NaN for under four. */
ss_status ss_ringdown_fit_each(const double *x, size_t n, const size_t *anchor, size_t n_anchors,
                               double w, const ss_window *gap, size_t n_gaps, ss_window *window,
                               ss_value value[2], ss_value *each);

/* Make the windows empty, and the values unknown, as before a fit. */
void ss_ringdown_clear(const size_t *anchor, size_t n, ss_window *window, ss_value value[2],
                       ss_value *each);

#endif
