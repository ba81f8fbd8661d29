/* places.h -- compute coefficients at any translations from the points of an oversampled series. */
#ifndef PLACES_H
#define PLACES_H

#include "map/kaiser.h"
#include "map/plan.h"

enum {
    PLACES_MARGIN = KAISER_TAPS_MAX     /* points before point 0, and after the last that is asked for,
                                           which are read, too */
};

/* Point p of a series, which its carrier turns by so many turns a point, is sample start + samples p;
 * samples is a power of two. */
typedef struct point_series {
    const double *v;            /* re, im */
    double start, samples, turns;
} point_series;

/* *out is the kernel of KAISER_TAPS_MAX taps for the widest band, in cycles a point; to be prepared. */
void ss_places_kernel(kaiser *out, double reach, double center, double second, double bound);

/* A part of a scale, times factor; its translations are those of a dense grid, or no fractions of samples
 * (ss_scale_parts). */
void ss_places_write(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate,
                     span part, double factor, double *w);
/* The adjoint of this: its conjugate is added to the points v of the series. */
void ss_places_add(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate,
                   span part, double factor, const double *w, double *v);

#endif
