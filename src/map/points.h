/* points.h -- interpolate between the points of an oversampled Fourier series: the kernel (kaiser.c), the values
 * at each sample (dense.c), and those anywhere (places.c). */
#ifndef POINTS_H
#define POINTS_H

#include <stddef.h>
#include "map/plan.h"

enum { KAISER_TAPS = 16, KAISER_PARTS = 32, KAISER_NODES = 7 };

typedef struct kaiser {
    double beta, edge;          /* edge: the series has |nu| <= edge < 1/2 cycles a point */
    int prepared;               /* the table is filled in */
    _Alignas(64) double table[KAISER_PARTS][KAISER_NODES][KAISER_TAPS];  /* of a weight, see ss_kaiser_weights */
} kaiser;

/* *out is the kernel for the widest band that keeps |error| <= bound where the series has size 1.  At nu cycles a
 * point it is at most exp(-v^2/2) with v = reach nu / edge, but beyond center not below second (the admissible
 * wavelet's hump about v = -center). */
void ss_kaiser_choose(kaiser *out, double reach, double center, double second, double bound);
/* Fill in the table that weights use. */
void ss_kaiser_prepare(kaiser *ker);
/* Weights of the taps for a place f points, 0 <= f < 1, after a point; tap i is KAISER_TAPS/2 - 1 - i points
 * before it: the polynomial in y with coefficients table[p][.][i], f KAISER_PARTS = p + (y + 1)/2. */
void ss_kaiser_weights(const kaiser *ker, double f, double weight[KAISER_TAPS]);
/* The response of the kernel, 1/response(0) times I0(beta sqrt(1 - (2 t/KAISER_TAPS)^2)). */
double ss_kaiser_response(double beta, double nu);

/* Weights of a kernel at positions that repeat periodically, to be freed; phases: a power of two.  NULL: no
 * memory. */
typedef struct weights weights;
weights *ss_dense_new(const kaiser *ker, size_t phases);
size_t ss_dense_phases(const weights *d);

enum {
    DENSE_PHASES_MAX = 128,
    DENSE_MARGIN = 64           /* points before and after those of the circle that are read, too */
};

/* Doubles that ss_dense_write needs beside its output. */
size_t ss_dense_room(size_t n);
/* Coefficient c - first < n is factor exp(2 pi i turns c/circle) times the series v at c/phases
 * points; first is a multiple of phases; turns, circle < 2^32. */
void ss_dense_write(const weights *d, const double *v, size_t turns, size_t circle, size_t first,
                    size_t n, double factor, double *spare, double *w);

enum { PLACES_MARGIN = KAISER_TAPS };       /* points before and after those asked for that are read, too */

/* Point p of a series, which its carrier turns by so many turns a point, is sample start + samples p;
 * samples is a power of two. */
typedef struct point_series {
    const double *v;            /* re, im */
    double start, samples, turns;
} point_series;

/* A part of a scale, times factor; its translations are those of a dense grid, or no fractions of samples
 * (ss_scale_parts). */
void ss_places_write(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate,
                     span part, double factor, double *w);
/* The adjoint of this: its conjugate is added to the points v of the series. */
void ss_places_add(const kaiser *ker, const point_series *s, const ss_scale *scale, double rate,
                   span part, double factor, const double *w, double *v);

#endif
