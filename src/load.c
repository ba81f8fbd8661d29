/* load.c -- open a path with any kind of signal. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <stickslip/load.h>
#include <stickslip/store.h>
#include "base/error.h"

static ss_status
load_stream(ss_signal **out, const char *path, const ss_read_opts *opts, ss_error *err)
{
    struct stat st;
    FILE *in = fopen(path, "rb");
    if (in == NULL)
        return ss_fail_errno(err, path, errno);
    ss_status status = fstat(fileno(in), &st) == 0 && S_ISDIR(st.st_mode)
                       ? ss_fail_errno(err, path, EISDIR)
                       : ss_signal_read(out, in, path, opts, err);
    fclose(in);
    return status;
}

ss_status
ss_signal_load(ss_signal **out, const char *path, const ss_read_opts *opts, ss_error *err)
{
    struct stat st;
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    if (ss_store_is_hdf5(path))
        return ss_store_read_signal(out, path, NULL, opts, err);
    const char *colon = strstr(path, ":/");
    if (colon == NULL || stat(path, &st) == 0)
        return load_stream(out, path, opts, err);
    char *file = strndup(path, (size_t)(colon - path));
    if (file == NULL)
        return ss_fail_memory(err, path);
    ss_status status = ss_store_is_hdf5(file)
                       ? ss_store_read_signal(out, file, colon + 1, opts, err)
                       : stat(file, &st) != 0
                       ? ss_fail_errno(err, file, errno)
                       : ss_fail(err, SS_EDATA, "%s: not an HDF5 file, so '%s' is not in it", file,
                                 colon + 1);
    free(file);
    return status;
}
