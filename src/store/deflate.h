/* deflate.h -- numbers as HDF5's filters shuffle and deflate keep them. */
#ifndef DEFLATE_H
#define DEFLATE_H

#include <stddef.h>
#include <stdint.h>

enum { DEFLATE_MOST = 65536, DEFLATE_HASH = 13 };      /* numbers at a time; bits */

/* Room to work in; its contents say nothing. */
typedef struct deflater {
    uint64_t word[DEFLATE_MOST];
    unsigned char plane[DEFLATE_MOST];
    uint32_t token[DEFLATE_MOST];
    uint16_t place[1 << DEFLATE_HASH];
    unsigned char out[9 * DEFLATE_MOST + 1024];
} deflater;

/* 1 <= n <= DEFLATE_MOST doubles, little-endian, shuffled, as a zlib stream in d->out.  Returns its length. */
size_t ss_deflate_doubles(deflater *d, const double *x, size_t n);

#endif
