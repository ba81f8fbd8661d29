/* dense.c -- compute a coefficient at each sample from the points of an oversampled series.
 *
 * The positions of samples between points repeat, and so do their weights.  A table has the
 * weights of LANES positions side by side, for all points that any of these positions needs, with
 * zeros for the points that a position does not need.  The inner loop multiplies this table by
 * points, for several repetitions of the pattern at once.  The carrier of a sample is the product of
 * the carrier at its place in the pattern and that of its row, a repetition of the pattern; the
 * latter is a product of two tables.
 *
 * The adjoint adds samples to points, with the same weights. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/versions.h"
#include "map/dense.h"

enum { LANES = 8, ROWS = 4, ROOT = LANES, GROUP_MAX = ROWS * LANES * DENSE_PHASES_MAX,
    LINE = 64,                  /* bytes of a cache line; a vector within one is read at once */
    COLUMN_LEAST = 64, COLUMN_MOST = DENSE_PHASES_MAX };    /* samples of a block of the adjoint */

struct weights {
    size_t phases;
    size_t blocks, points;      /* the pattern repeats after so many blocks of LANES places, or points */
    int taps, lead;             /* taps of a block; tap 0 lies lead points before the place's own */
    size_t *late;               /* [blocks], points before the first of a block */
    double *weight;             /* [blocks][taps][LANES] */
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

static void *
aligned(void *p)
{
    return (char *)p + (LINE - (uintptr_t)p % LINE) % LINE;
}

weights *
ss_dense_new(const kaiser *ker, size_t phases)
{
    size_t common = divisor(phases, LANES), blocks = phases / common, extra = 0;
    for (size_t m = 0; m < blocks; m++) {
        size_t span = (m * LANES + LANES - 1) / phases - m * LANES / phases;
        extra = span > extra ? span : extra;
    }
    size_t taps = (size_t)ker->taps + extra, late = blocks * sizeof(size_t);
    weights *d = calloc(1, sizeof *d + late + LINE + blocks * taps * LANES * sizeof(double));
    if (d == NULL)
        return NULL;
    d->phases = phases;
    d->blocks = blocks;
    d->points = LANES / common;
    d->taps = (int)taps;
    d->lead = ker->taps / 2 - 1;
    d->late = (size_t *)(d + 1);
    d->weight = aligned(d->late + blocks);
    for (size_t c = 0; c < blocks * LANES; c++) {
        double weight[KAISER_TAPS_MAX];
        size_t block = c / LANES, own = c / phases;
        d->late[block] = block * LANES / phases;
        ss_kaiser_weights(ker, (double)(c % phases) / (double)phases, weight);
        for (size_t i = 0; i < (size_t)ker->taps; i++)
            d->weight[(block * taps + own - d->late[block] + i) * LANES + c % LANES] = weight[i];
    }
    return d;
}

size_t
ss_dense_phases(const weights *d)
{
    return d->phases;
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

/* The powers 0 to ROOT - 1 of exp(2 pi i k c/m), each the product of two half as high: errors are some
 * eps. */
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
    ptrdiff_t point = (ptrdiff_t)(first / d->phases) - d->lead;
    make_carrier(&turning, d, turns, circle, first, (whole + 1) * ROWS, factor, aligned(spare));
    BEST_VERSION(write_128, write_256, write_512)(d, series + 2 * point, 0, whole, &turning, w);
    if (rest > 0) {
        BEST_VERSION(write_128, write_256, write_512)(d, series + 2 * point, whole, whole + 1, &turning, last);
        memcpy(w + 2 * whole * group, last, 2 * rest * sizeof *w);
    }
}

/* --- the adjoint ------------------------------------------------------------------------------- */

/* A block is a whole number of points.  A table has the weights of all its samples for each point that
 * any of them needs, with zeros for samples that do not need it. */
struct columns {
    size_t phases, width;       /* samples of a block */
    int taps, lead;             /* points of a block; point 0 lies lead points before the block */
    double *weight;             /* [taps][width][2]: each twice, for re and im */
};

columns *
ss_columns_new(const kaiser *ker, size_t phases)
{
    size_t width = phases > COLUMN_LEAST ? phases : COLUMN_LEAST;
    size_t taps = (size_t)ker->taps + width / phases - 1;
    columns *c = calloc(1, sizeof *c + LINE + taps * width * 2 * sizeof(double));
    if (c == NULL)
        return NULL;
    *c = (columns){ phases, width, (int)taps, ker->taps / 2 - 1, aligned(c + 1) };
    for (size_t k = 0; k < width; k++) {
        double weight[KAISER_TAPS_MAX];
        ss_kaiser_weights(ker, (double)(k % phases) / (double)phases, weight);
        for (size_t i = 0; i < (size_t)ker->taps; i++) {
            double *at = c->weight + 2 * ((k / phases + i) * width + k);
            at[0] = at[1] = weight[i];
        }
    }
    return c;
}

void
ss_columns_free(columns *c)
{
    free(c);
}

/* Add a block: conj w times the carrier, which is near from sample to sample and e at the first. */
VERSIONS static void
add_block(const columns *c, const double *restrict w, const double *restrict near, const double e[2],
          double *restrict v)
{
    double u[2 * COLUMN_MOST];
    for (size_t k = 0; k < c->width; k++) {
        u[2 * k] = w[2 * k] * near[2 * k] + w[2 * k + 1] * near[2 * k + 1];
        u[2 * k + 1] = w[2 * k] * near[2 * k + 1] - w[2 * k + 1] * near[2 * k];
    }
    for (int t = 0; t < c->taps; t++) {
        const double *weight = c->weight + (size_t)t * 2 * c->width;
        double sum[2 * LANES] = { 0 };
        for (size_t k = 0; k < 2 * c->width; k += 2 * LANES)
            for (size_t l = 0; l < 2 * LANES; l++)
                sum[l] += weight[k + l] * u[k + l];
        for (size_t l = LANES; l > 1; l /= 2)
            for (size_t i = 0; i < l; i++)
                sum[i] += sum[i + l];
        double re = sum[0], im = sum[1];
        v[2 * t] += e[0] * re - e[1] * im;
        v[2 * t + 1] += e[0] * im + e[1] * re;
    }
}

void
ss_columns_add(const columns *c, size_t turns, size_t circle, size_t n, double factor, const double *w,
               double *v)
{
    double near[2 * COLUMN_MOST], e[2], last[2 * COLUMN_MOST] = { 0 };
    for (size_t k = 0; k < c->width; k++)
        turn(turns, k, circle, near + 2 * k);
    for (size_t k = 0; k < n; k += c->width) {
        const double *from = w + 2 * k;
        if (n - k < c->width)
            from = memcpy(last, from, 2 * (n - k) * sizeof *last);
        turn(turns, k, circle, e);
        e[0] *= factor;
        e[1] *= factor;
        add_block(c, from, near, e, v + 2 * ((ptrdiff_t)(k / c->phases) - c->lead));
    }
}
