/* kaiser.h -- the kernel that interpolates between points of an oversampled Fourier series. */
#ifndef KAISER_H
#define KAISER_H

#include <stddef.h>

/* A bound of the series at nu cycles a point: exp(-v^2/2) with v = reach nu / edge, but beyond center
 * not below second (the admissible wavelet's hump about v = -center). */
typedef struct kaiser_band {
    double edge;                /* |nu| <= edge < 1/2 */
    double reach, center, second;
} kaiser_band;

enum { KAISER_TAPS_MAX = 16, KAISER_PARTS = 32, KAISER_NODES = 7 };

typedef struct kaiser {
    int taps;                   /* even */
    double beta, edge;
    int prepared;               /* the table is filled in */
    _Alignas(64) double table[KAISER_PARTS][KAISER_NODES][KAISER_TAPS_MAX];  /* of a weight, see ss_kaiser_weights */
} kaiser;

/* The shortest kernel that keeps |error| <= bound where the series has size 1; 0 if none does. */
int ss_kaiser_choose(kaiser *out, const kaiser_band *band, double bound);
/* Fill in the table that weights use. */
void ss_kaiser_prepare(kaiser *ker);
/* Weights of the taps for a place f points, 0 <= f < 1, after a point; tap i is taps/2 - 1 - i points
 * before it: the polynomial in y with coefficients table[p][.][i], f KAISER_PARTS = p + (y + 1)/2. */
void ss_kaiser_weights(const kaiser *ker, double f, double weight[]);

/* The kernel itself, 1/response(0) times I0(beta sqrt(1 - (2 t/taps)^2)), and its response. */
double ss_kaiser_at(int taps, double beta, double t);
double ss_kaiser_response(int taps, double beta, double nu);

#endif
