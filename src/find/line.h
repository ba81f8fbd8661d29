/* line.h -- a line through samples. */
#ifndef LINE_H
#define LINE_H

#include <math.h>
#include <stddef.h>
#include "find/window.h"

typedef struct line {
    double slope, error;        /* per unit of the abscissa; error: of white noise */
    double x, y;                /* the mean of the points, which lies on it */
    double rms;                 /* about it */
} line;

/* Fit a line to y over x in a window, or over the number of the sample if x is NULL. */
static inline line
ss_line_through(const double *y, const double *x, ss_window w)
{
    double m = (double)ss_window_length(w), xx = 0, xy = 0, rr = 0;
    line l = { 0, NAN, 0, 0, 0 };
    for (size_t i = w.first; i < w.end; i++) {
        l.x += (x != NULL ? x[i] : (double)i) / m;
        l.y += y[i] / m;
    }
    for (size_t i = w.first; i < w.end; i++) {
        double u = (x != NULL ? x[i] : (double)i) - l.x;
        xx += u * u;
        xy += u * (y[i] - l.y);
    }
    l.slope = xx > 0 ? xy / xx : NAN;
    for (size_t i = w.first; i < w.end; i++) {
        double r = y[i] - l.y - l.slope * ((x != NULL ? x[i] : (double)i) - l.x);
        rr += r * r;
    }
    l.rms = sqrt(rr / (m - 2));
    l.error = l.rms / sqrt(xx);
    return l;
}

/* How far sample i lies above the line over the numbers of samples. */
static inline double
ss_line_off(const line *l, const double *y, size_t i)
{
    return y[i] - l->y - l->slope * ((double)i - l->x);
}

#endif
