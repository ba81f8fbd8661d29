/* deflate.h -- numbers as HDF5's filters shuffle and deflate keep them. */
#ifndef DEFLATE_H
#define DEFLATE_H

#include <stddef.h>

enum { DEFLATE_MOST = 65536 };          /* numbers at a time */

typedef struct deflater deflater;

/* NULL if memory is short; free it with ss_deflater_free. */
deflater *ss_deflater_new(void);
void ss_deflater_free(deflater *d);

/* 1 <= n <= DEFLATE_MOST doubles, little-endian, shuffled, as a zlib stream, which *out points at until
 * the next call.  Returns its length. */
size_t ss_deflate_doubles(deflater *d, const double *x, size_t n, const void **out);

#endif
