/* deflate.c -- doubles as the filters shuffle and deflate keep them, by libdeflate, which takes
 * about half of the time of zlib: a zlib stream (RFC 1950) of all first bytes, then all second
 * bytes, and so on. */
#include "store/deflate.h"

#include <libdeflate.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { FASTEST = 1 };           /* of libdeflate's levels */

struct deflater {
    struct libdeflate_compressor *compressor;
    size_t room;                /* bytes of out */
    unsigned char shuffled[DEFLATE_MOST * sizeof(double)], out[];
};

deflater *
ss_deflater_new(void)
{
    size_t room = libdeflate_zlib_compress_bound(NULL, DEFLATE_MOST * sizeof(double));
    deflater *d = malloc(sizeof *d + room);
    if (d == NULL)
        return NULL;
    d->room = room;
    d->compressor = libdeflate_alloc_compressor(FASTEST);
    if (d->compressor != NULL)
        return d;
    free(d);
    return NULL;
}

void
ss_deflater_free(deflater *d)
{
    if (d != NULL)
        libdeflate_free_compressor(d->compressor);
    free(d);
}

size_t
ss_deflate_doubles(deflater *d, const double *x, size_t n, const void **out)
{
    unsigned char *to = d->shuffled;
    for (unsigned shift = 0; shift < 64; shift += 8)
        for (size_t i = 0; i < n; i++) {
            uint64_t word;
            memcpy(&word, &x[i], sizeof word);
            *to++ = (unsigned char)(word >> shift);
        }
    *out = d->out;
    return libdeflate_zlib_compress(d->compressor, d->shuffled, n * sizeof *x, d->out, d->room);
}
