/* dense.c -- a coefficient a sample from the points of an oversampled series.
 *
 * Places between points repeat, and so do their weights: they are a table of LANES places side by
 * side, over the points that any of the LANES needs, with zeros where a place does not need one.
 * The inner loop is then a product of that table with points, ROWS places of the pattern at once,
 * and its results lie side by side in the output.  The carrier at a place is a product of
 * exponentials for the place in its LANES, and for these in 8, in 64 and in the record. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "morlet/dense.h"
#include "morlet/versions.h"

enum { LANES = 8, ROWS = 4, ROOT = 8, GROUP_MAX = ROWS * LANES * DENSE_PHASES_MAX };

struct weights {
    size_t phases;
    size_t blocks, points;      /* of LANES places, and points, after which the pattern repeats */
    int taps, lead;             /* of a block; points before the place's own that tap 0 is */
    double weight[];            /* [blocks][taps][LANES] */
};

static size_t
divisor(size_t a, size_t b)
{
    while (b > 0) {
        size_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

weights *
ss_dense_new(const kaiser *ker, size_t phases)
{
    size_t common = divisor(phases, LANES), blocks = phases / common, extra = 0;
    for (size_t m = 0; m < blocks; m++) {
        size_t span = (m * LANES + LANES - 1) / phases - m * LANES / phases;
        extra = span > extra ? span : extra;
    }
    size_t taps = (size_t)ker->taps + extra;
    weights *d = calloc(1, sizeof *d + blocks * taps * LANES * sizeof *d->weight);
    if (d == NULL)
        return NULL;
    d->phases = phases;
    d->blocks = blocks;
    d->points = LANES / common;
    d->taps = (int)taps;
    d->lead = ker->taps / 2 - 1;
    for (size_t c = 0; c < blocks * LANES; c++) {
        double weight[KAISER_TAPS_MAX];
        size_t block = c / LANES, late = c / phases - block * LANES / phases;
        ss_kaiser_weights(ker, (double)(c % phases) / (double)phases, weight);
        for (size_t i = 0; i < (size_t)ker->taps; i++)
            d->weight[(block * taps + late + i) * LANES + c % LANES] = weight[i];
    }
    return d;
}

void
ss_dense_free(weights *d)
{
    free(d);
}

/* --- the carrier ------------------------------------------------------------------------------ */

/* exp(2 pi i k c/m) */
static void
turn(size_t k, size_t c, size_t m, double e[2])
{
    double p = 2 * M_PI * (double)((uint64_t)(k % m) * (c % m) % m) / (double)m;
    e[0] = cos(p);
    e[1] = sin(p);
}

static void
multiply(const double a[2], const double b[2], double e[2])
{
    double re = a[0] * b[0] - a[1] * b[1];
    e[1] = a[0] * b[1] + a[1] * b[0];
    e[0] = re;
}

typedef struct carrier {
    double lane[2][LANES];              /* re, im; times the factor */
    double block[ROOT * ROOT][2];
    double (*far)[2];                   /* for every ROOT^2 blocks */
} carrier;

static void
make_carrier(carrier *to, size_t turns, size_t circle, size_t first, size_t n, double factor,
             double *spare)
{
    double coarse[2], fine[ROOT][2];
    for (size_t i = 0; i < ROOT; i++)
        turn(turns, i * LANES, circle, fine[i]);
    for (size_t i = 0; i < ROOT; i++) {
        turn(turns, i * ROOT * LANES, circle, coarse);
        for (size_t j = 0; j < ROOT; j++)
            /* cppcheck-suppress uninitvar ; it is written here */
            multiply(coarse, fine[j], to->block[i * ROOT + j]);
    }
    for (size_t i = 0; i < LANES; i++) {
        turn(turns, first + i, circle, coarse);
        to->lane[0][i] = coarse[0] * factor;
        to->lane[1][i] = coarse[1] * factor;
    }
    to->far = (double (*)[2])spare;
    for (size_t i = 0; i * ROOT * ROOT * LANES < n; i++)
        turn(turns, i * ROOT * ROOT * LANES, circle, to->far[i]);
}

/* --- the loop --------------------------------------------------------------------------------- */

typedef struct rows {
    int taps;
    size_t apart, stride;               /* points, and doubles of w, from one row to the next */
    const carrier *carrier;
} rows;

/* Sums times the carrier e of the block are coefficients. */
static inline void
put_lanes(const rows *r, const double x[LANES], const double y[LANES], const double e[2], double *w,
          double most[LANES])
{
    const double *re = r->carrier->lane[0], *im = r->carrier->lane[1];
    for (size_t l = 0; l < LANES; l++) {
        double c = e[0] * re[l] - e[1] * im[l], s = e[0] * im[l] + e[1] * re[l];
        double size = x[l] * x[l] + y[l] * y[l];
        most[l] = size > most[l] ? size : most[l];
        w[2 * l] = x[l] * c - y[l] * s;
        w[2 * l + 1] = x[l] * s + y[l] * c;
    }
}

typedef void put_rows(const rows *r, const double *v, const double *weight, double e[][2],
                      double *w, double most[LANES]);

#define ROWS_NAME rows_16
#define WIDTH 2
#define HELD 1
#define TARGET FAST
#include "morlet/dense_loop.h"

#ifdef HAVE_TARGETS
#define ROWS_NAME rows_32
#define WIDTH 4
#define HELD 2
#define TARGET FAST_FOR("avx2")
#include "morlet/dense_loop.h"

#define ROWS_NAME rows_64
#define WIDTH 8
#define HELD 4
#define TARGET FAST_FOR("avx512f")
#include "morlet/dense_loop.h"
#endif

static put_rows *
best_rows(void)
{
#ifdef HAVE_TARGETS
    if (__builtin_cpu_supports("avx512f"))
        return rows_64;
    if (__builtin_cpu_supports("avx2"))
        return rows_32;
#endif
    return rows_16;
}

size_t
ss_dense_room(size_t n)
{
    return 2 * ((n + GROUP_MAX) / (ROOT * ROOT * LANES) + 1 + GROUP_MAX);
}

/* ROWS rows from one on, a row being the pattern once. */
static void
put_group(const weights *d, const rows *r, put_rows *put, const double *v, size_t row, double *w,
          double most[LANES])
{
    for (size_t m = 0; m < d->blocks; m++) {
        double e[ROWS][2];
        for (size_t i = 0; i < ROWS; i++) {
            size_t block = (row + i) * d->blocks + m;
            multiply(r->carrier->far[block / (ROOT * ROOT)],
                     r->carrier->block[block % (ROOT * ROOT)], e[i]);
        }
        const double *from = v + 2 * (row * d->points + m * LANES / d->phases);
        put(r, from, d->weight + m * (size_t)d->taps * LANES, e, w + 2 * m * LANES, most);
    }
}

double
ss_dense_put(const weights *d, const double *v, size_t turns, size_t circle, size_t first,
             size_t n, double factor, double *spare, double *w)
{
    carrier turning;
    size_t row = 0, group = ROWS * d->blocks * LANES, c = 0;
    double most[LANES] = { 0 }, largest = 0, beyond[LANES] = { 0 };
    rows r = { .taps = d->taps, .apart = d->points, .stride = 2 * d->blocks * LANES,
               .carrier = &turning };
    put_rows *put = best_rows();
    double *last = spare + ss_dense_room(n) - 2 * GROUP_MAX;
    make_carrier(&turning, turns, circle, first, n + group, factor, spare);
    v += 2 * ((ptrdiff_t)(first / d->phases) - d->lead);
    for (; c + group <= n; c += group, row += ROWS)
        put_group(d, &r, put, v, row, w + 2 * c, most);
    if (c < n) {
        put_group(d, &r, put, v, row, last, beyond);
        memcpy(w + 2 * c, last, 2 * (n - c) * sizeof *w);
    }
    for (size_t l = 0; l < LANES; l++)
        largest = fmax(largest, most[l]);
    for (size_t i = 0; c + i < n; i++) {
        double re = last[2 * i] / factor, im = last[2 * i + 1] / factor;
        largest = fmax(largest, re * re + im * im);
    }
    return largest;
}
