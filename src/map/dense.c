/* dense.c -- compute a coefficient at each sample from the points of an oversampled series.
 *
 * The positions of samples between points repeat, and so do their weights.  A table has the weights of LANES
 * positions side by side, for all points that any of these positions needs, with zeros for the points that a
 * position does not need.  The inner loop multiplies this table by points, for several repetitions of the pattern
 * at once.  The carrier of a sample is the product of the carrier at its place in the pattern and that of its row,
 * a repetition of the pattern; the latter is a product of two tables. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/versions.h"
#include "map/points.h"

enum { LANES = 8, ROWS = 4, ROOT = LANES, GROUP_MAX = ROWS * LANES * DENSE_PHASES_MAX,
    LINE = 64 };                /* bytes of a cache line; a vector within one is read at once */

struct weights {
    size_t phases;
    size_t blocks, points;      /* the pattern repeats after so many blocks of LANES places, or points */
    size_t taps;                /* of a block */
    size_t *late;               /* [blocks], points before the first of a block */
    double *weight;             /* [blocks][taps][LANES] */
};

static void *
aligned(void *p)
{
    return (char *)p + (LINE - (uintptr_t)p % LINE) % LINE;
}

weights *
ss_dense_new(const kaiser *ker, size_t phases)
{
    size_t common = phases < LANES ? phases : LANES, blocks = phases / common, extra = 0;
    for (size_t m = 0; m < blocks; m++) {
        size_t more = (m * LANES + LANES - 1) / phases - m * LANES / phases;
        extra = more > extra ? more : extra;
    }
    size_t taps = KAISER_TAPS + extra, late = blocks * sizeof(size_t);
    weights *d = calloc(1, sizeof *d + late + LINE + blocks * taps * LANES * sizeof(double));
    if (d == NULL)
        return NULL;
    d->phases = phases;
    d->blocks = blocks;
    d->points = LANES / common;
    d->taps = taps;
    d->late = (size_t *)(d + 1);
    d->weight = aligned(d->late + blocks);
    for (size_t c = 0; c < blocks * LANES; c++) {
        double weight[KAISER_TAPS];
        size_t block = c / LANES, own = c / phases;
        d->late[block] = block * LANES / phases;
        ss_kaiser_weights(ker, (double)(c % phases) / (double)phases, weight);
        for (size_t i = 0; i < KAISER_TAPS; i++)
            d->weight[(block * taps + own - d->late[block] + i) * LANES + c % LANES] = weight[i];
    }
    return d;
}

size_t
ss_dense_phases(const weights *d)
{
    return d->phases;
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

static inline void
multiply(const double a[2], const double b[2], double e[2])
{
    double re = a[0] * b[0] - a[1] * b[1];
    e[1] = a[0] * b[1] + a[1] * b[0];
    e[0] = re;
}

typedef struct carrier {
    double near[ROOT * ROOT][2];        /* of each row, relative to the last of far before it */
    double (*far)[2];                   /* the carrier of every ROOT^2-th row */
    double *places;                     /* [blocks][2][LANES]: re, im */
} carrier;

/* The powers 0 to ROOT - 1 of exp(2 pi i k c/m), each the product of two half as high: errors are some eps. */
static void
powers(size_t k, size_t c, size_t m, double e[ROOT][2])
{
    e[0][0] = 1;
    e[0][1] = 0;
    turn(k, c, m, e[1]);
    for (size_t i = 2; i < ROOT; i++)
        multiply(e[i / 2], e[i - i / 2], e[i]);
}

/* Fill in the carrier's tables.  Row 0 begins at the place `first`; the places are multiplied by factor. */
static void
make_carrier(carrier *to, const weights *d, size_t turns, size_t circle, size_t first, size_t rows,
             double factor, double *spare)
{
    size_t width = d->blocks * LANES;
    double coarse[ROOT][2], fine[ROOT][2], e[2];
    powers(turns, width, circle, fine);
    powers(turns, ROOT * width, circle, coarse);
    for (size_t i = 0; i < ROOT; i++)
        for (size_t j = 0; j < ROOT; j++)
            /* cppcheck-suppress uninitvar ; it is written here */
            multiply(coarse[i], fine[j], to->near[i * ROOT + j]);
    to->far = (double (*)[2])(spare + 2 * width);
    for (size_t i = 0; i * ROOT * ROOT < rows; i++)
        turn(turns, first + i * ROOT * ROOT * width, circle, to->far[i]);
    to->places = spare;
    powers(turns, 1, circle, fine);
    for (size_t m = 0; m < d->blocks; m++) {
        turn(turns, m * LANES, circle, coarse[0]);
        for (size_t i = 0; i < LANES; i++) {
            double *at = to->places + 2 * m * LANES + i;
            multiply(coarse[0], fine[i], e);
            at[0] = e[0] * factor;
            at[LANES] = e[1] * factor;
        }
    }
}

/* --- the loop --------------------------------------------------------------------------------- */

#define LOOP write_128
#define WIDTH 2
#define TARGET FAST
#include "map/dense_loop.h"

#ifdef HAVE_TARGETS
#define LOOP write_256
#define WIDTH 4
#define TARGET FAST_FOR("avx2,fma")
#include "map/dense_loop.h"

#define LOOP write_512
#define WIDTH 8
#define TARGET FAST_FOR("avx512f")
#include "map/dense_loop.h"
#endif

size_t
ss_dense_room(size_t n)
{
    return LINE / sizeof(double) + 2 * LANES * DENSE_PHASES_MAX
        + 2 * ((n + GROUP_MAX) / (ROOT * ROOT * LANES) + 1) + 2 * GROUP_MAX;
}

void
ss_dense_write(const weights *d, const double *series, size_t turns, size_t circle, size_t first,
               size_t n, double factor, double *spare, double *w)
{
    carrier turning;
    size_t group = ROWS * d->blocks * LANES, whole = n / group, rest = n - whole * group;
    double *last = spare + ss_dense_room(n) - 2 * GROUP_MAX;
    ptrdiff_t point = (ptrdiff_t)(first / d->phases) - (KAISER_TAPS / 2 - 1);
    make_carrier(&turning, d, turns, circle, first, (whole + 1) * ROWS, factor, aligned(spare));
    BEST_VERSION(write_128, write_256, write_512)(d, series + 2 * point, 0, whole, &turning, w);
    if (rest > 0) {
        BEST_VERSION(write_128, write_256, write_512)(d, series + 2 * point, whole, whole + 1, &turning, last);
        memcpy(w + 2 * whole * group, last, 2 * rest * sizeof *w);
    }
}
