/* extent.c -- measure how long a single event lasts.
 *
 * |W| does not show this: it is wider than the event by some scales on each side.  So a line is
 * fitted to the samples on one side that the wavelet does not reach.  The event ends at the last
 * sample that is farther from this line than noise is expected to come in m samples, sqrt(2 ln m)
 * of its standard deviations, before all samples are near the line for half a period.  (An
 * oscillation crosses the line more often.) */
#include "find/extent.h"

#include <math.h>

#define AWAY 4.0                /* periods: a wavelet's reach */
#define QUIET 4.0               /* the fewest periods of quiet for a line */
#define FAINT 0.01              /* of the event's height: so little counts as noise */

/* The side of an event: the sample k steps off its middle is x[k * step]. */
typedef struct side {
    const double *x;
    ptrdiff_t step;
    size_t n;
} side;

static double
value(const side *s, size_t k)
{
    return s->x[(ptrdiff_t)k * s->step];
}

/* The line offset + slope k through the samples from first on; returns its standard deviation. */
static double
fit_line(const side *s, size_t first, double *offset, double *slope)
{
    double m = (double)(s->n - first), middle = (double)first + (m - 1) / 2, mean = 0, kk = 0;
    double ky = 0, rss = 0;
    for (size_t k = first; k < s->n; k++)
        mean += value(s, k) / m;
    for (size_t k = first; k < s->n; k++) {
        double off = (double)k - middle;
        kk += off * off;
        ky += off * (value(s, k) - mean);
    }
    *slope = ky / kk;
    *offset = mean - *slope * middle;
    for (size_t k = first; k < s->n; k++) {
        double left = value(s, k) - *offset - *slope * (double)k;
        rss += left * left;
    }
    return sqrt(rss / (m - 2));
}

/* The steps to the last sample of the event on its side. */
static size_t
reach(const side *s, double period)
{
    double offset, slope, height = 0;
    size_t last = 0, away = (size_t)ceil(AWAY * period) + 1;
    size_t quiet = (size_t)ceil(QUIET * period) + 3;
    if (s->n < away + quiet)
        return 0;
    double band = fit_line(s, away, &offset, &slope) * sqrt(2 * log((double)(s->n - away)));
    for (size_t k = 0; k < away; k++)
        height = fmax(height, fabs(value(s, k) - offset - slope * (double)k));
    band = fmax(band, FAINT * height);
    for (size_t k = 0; k < s->n && (double)(k - last) <= 0.5 * period; k++)
        if (fabs(value(s, k) - offset - slope * (double)k) > band)
            last = k;
    return last;
}

ss_window
ss_extent(const double *x, ss_window win, size_t at, double period)
{
    const side before = { x + at, -1, at + 1 - win.first }, behind = { x + at, 1, win.end - at };
    return (ss_window){ at - reach(&before, period), at + reach(&behind, period) };
}
