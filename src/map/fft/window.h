/* window.h -- a window of a level: its samples, its spectrum, and the samples of the next level. */
#ifndef FFT_WINDOW_H
#define FFT_WINDOW_H

#include <stddef.h>
#include "map/fft/stage.h"

/* Samples lo ... hi - 1 of a level, of which x[0] is sample lo; all others are 0. */
typedef struct samples {
    double *x;
    ptrdiff_t lo, hi;
} samples;

/* to[i] becomes sample first + i. */
void ss_window_copy(const samples *s, ptrdiff_t first, size_t n, double *to);
/* The terms of a window.  Its samples follow at x[overlap/2]; before them x has the overlap/2 samples that
 * precede the window.  v has room for a window. */
void ss_window_transform(const stage *st, const double *x, double *v, double *terms);
/* The hop/2 samples of the next level that a window determines; to[0] becomes the first.  spare has room
 * for a window. */
void ss_window_decimate(const stage *st, const double *terms, double *spare, double *to);
/* The doubles needed for a window of any level: its samples, its spectrum and the next level's samples. */
size_t ss_window_room(const struct blocks *b);

#endif
