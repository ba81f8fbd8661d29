/* output.c -- write bytes through a buffer. */
#include "io/output.h"

ss_status
ss_output_drain(struct output *out)
{
    size_t n = out->used;
    out->used = 0;
    return fwrite(out->buffer, 1, n, out->file) == n ? SS_OK : SS_EIO;
}

ss_status
ss_output_flush(FILE *file)
{
    return fflush(file) == 0 && !ferror(file) ? SS_OK : SS_EIO;
}
