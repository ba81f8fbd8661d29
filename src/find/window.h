/* window.h -- a stretch of samples, and a line through it. */
#ifndef WINDOW_H
#define WINDOW_H

#include <math.h>
#include <stddef.h>

typedef struct ss_window {
    size_t first, end;          /* samples [first, end) */
} ss_window;

static inline size_t
ss_window_length(ss_window win)
{
    return win.end - win.first;
}

typedef struct ss_line {
    double slope, error;        /* per unit of the abscissa; error: of white noise */
    double x, y;                /* the mean of the points, which lies on it */
    double rms;                 /* about it */
} ss_line;

/* Fit a line to y over x in a window, or over the number of the sample if x is NULL. */
static inline ss_line
ss_line_through(const double *y, const double *x, ss_window w)
{
    double m = (double)ss_window_length(w), xx = 0, xy = 0, rr = 0;
    ss_line l = { 0, NAN, 0, 0, 0 };
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
ss_line_off(const ss_line *l, const double *y, size_t i)
{
    return y[i] - l->y - l->slope * ((double)i - l->x);
}

#endif
