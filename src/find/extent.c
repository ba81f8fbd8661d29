/* extent.c -- measure how long a single event lasts.
 *
 * |W| does not show this: it is wider than the event by some scales on each side.  So a line is
 * fitted to the samples on one side that the wavelet does not reach.  The event ends at the last
 * sample that is farther from this line than noise is expected to come in m samples, sqrt(2 ln m)
 * of its standard deviations, before all samples are near the line for half a period.  (An
 * oscillation crosses the line more often.) */
#include "find/extent.h"

#include <math.h>
#include "find/line.h"

#define AWAY 4.0                /* periods: a wavelet's reach, and the fewest periods of quiet for a line */
#define FAINT 0.01              /* of the event's height: so little counts as noise */

/* The last sample of the event on the side of `at` that ends with sample `end`. */
static size_t
last_of(const double *x, size_t at, size_t end, double period)
{
    size_t n = (end > at ? end - at : at - end) + 1, away = (size_t)ceil(AWAY * period), last = 0;
    double height = 0;
    if (n < 2 * away + 4)
        return at;
    line quiet = ss_line_through(x, NULL, end > at ? (ss_window){ at + away + 1, end + 1 }
                                                   : (ss_window){ end, at - away });
    for (size_t k = 0; k <= away; k++)
        height = fmax(height, fabs(ss_line_off(&quiet, x, end > at ? at + k : at - k)));
    double band = fmax(quiet.rms * sqrt(2 * log((double)(n - away - 1))), FAINT * height);
    for (size_t k = 0; k < n && (double)(k - last) <= 0.5 * period; k++)
        if (fabs(ss_line_off(&quiet, x, end > at ? at + k : at - k)) > band)
            last = k;
    return end > at ? at + last : at - last;
}

ss_window
ss_extent(const double *x, ss_window win, size_t at, double period)
{
    return (ss_window){ last_of(x, at, win.first, period), last_of(x, at, win.end - 1, period) };
}
