/* store.c -- HDF5 as a format, without the HDF5 library, which only the functions of ss_store_calls need. */
#include "io/store.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/error.h"
#include "io/format.h"

/* --- the format ---------------------------------------------------------------------------- */

int
ss_store_is_hdf5(const char *path)
{
    if (path == NULL)
        return 0;
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

FORMAT(hdf5) = {
    .name = "h5", .magic = "\211HDF", .is_file = ss_store_is_hdf5, .open_file = open_signal
};

/* --- coefficients -------------------------------------------------------------------------- */

ss_status
ss_store_open_coefficients(ss_coefficients **out, const char *path, ss_error *err)
{
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    const struct ss_store_calls *hdf5 = ss_store_calls(err);
    return hdf5 != NULL ? hdf5->open_coefficients(out, path, err) : SS_EIO;
}

ss_status
ss_store_read_coefficients(ss_coefficients **out, const char *path, ss_error *err)
{
    ss_coefficients *map;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_status status = ss_store_open_coefficients(&map, path, err);
    if (status != SS_OK)
        return status;
    const ss_scale *last = &map->scale[map->n_scales - 1];
    double *w = malloc(2 * (last->offset + last->n) * sizeof *w);
    if (w == NULL)
        status = ss_fail_memory(err, path);
    for (size_t i = 0; status == SS_OK && i < map->n_scales; i++) {
        const ss_scale *scale = &map->scale[i];
        status = ss_map_read(map, &(ss_map_part){ i, 0, scale->n, w + 2 * scale->offset, NULL }, 1, err);
    }
    map->source->free(map->source);
    map->source = NULL;
    map->w = w;
    if (status == SS_OK)
        *out = map;
    else
        ss_coefficients_free(map);
    return status;
}
