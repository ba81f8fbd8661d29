/* deflate.h -- pack numbers as HDF5's filters shuffle and deflate do. */
#ifndef DEFLATE_H
#define DEFLATE_H

#include <stddef.h>

enum { DEFLATE_MOST = 65536 };          /* numbers at a time */

typedef struct deflater deflater;

/* NULL if memory is short; free it with ss_deflater_free. */
deflater *ss_deflater_new(void);
void ss_deflater_free(deflater *d);

/* 1 <= n <= DEFLATE_MOST numbers of 8 bytes, or rounded to 4, little-endian, shuffled, as a zlib stream,
 * which *out points at until the next call.  Returns its length. */
size_t ss_deflate(deflater *d, const double *x, size_t n, size_t size, const void **out);

#endif
