/* dense.h -- compute a coefficient at each sample from the points of an oversampled series. */
#ifndef DENSE_H
#define DENSE_H

#include <stddef.h>
#include "map/kaiser.h"

/* Weights of a kernel at positions that repeat periodically. */
typedef struct weights weights;

/* phases: a power of two.  NULL: no memory. */
weights *ss_dense_new(const kaiser *ker, size_t phases);
size_t ss_dense_phases(const weights *d);
void ss_dense_free(weights *d);                       /* NULL is allowed */

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

#endif
