/* store.c -- HDF5 as a format, without the HDF5 library, which only the functions of ss_store_calls need. */
#include "io/writer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/error.h"
#include "io/format.h"

/* The signature is at byte 0, 512, 1024, ... */
static int
is_hdf5(const char *path)
{
    static const char signature[8] = "\211HDF\r\n\032\n";
    char bytes[8];
    struct stat st;
    int found = 0;
    if (stat(path, &st) != 0 || !S_ISREG(st.st_mode))   /* a FIFO must not lose its first bytes */
        return 0;
    FILE *in = fopen(path, "rb");
    if (in == NULL)
        return 0;
    for (off_t at = 0; !found && at <= st.st_size - 8; at = at > 0 ? 2 * at : 512)
        found = fseeko(in, at, SEEK_SET) == 0 && fread(bytes, 1, 8, in) == 8
                && memcmp(bytes, signature, 8) == 0;
    fclose(in);
    return found;
}

static ss_status
open_signal(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts, ss_error *err)
{
    const struct ss_store_calls *hdf5 = ss_store_calls(err);
    return hdf5 != NULL ? hdf5->open_signal(out, path, dataset, opts, err) : SS_EIO;
}

static ss_status
open_map(ss_coefficients **out, const char *path, ss_error *err)
{
    const struct ss_store_calls *hdf5 = ss_store_calls(err);
    return hdf5 != NULL ? hdf5->open_coefficients(out, path, err) : SS_EIO;
}

FORMAT(hdf5) = {
    .name = "h5", .magic = "\211HDF", .is_file = is_hdf5, .open_file = open_signal, .open_map = open_map
};
