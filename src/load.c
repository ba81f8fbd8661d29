/* load.c -- open a path with any kind of signal. */
#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <stickslip/load.h>
#include <stickslip/store.h>
#include "base/error.h"
#include "stream/calibration.h"

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

/* What opts ask for of a signal that is there. */
static ss_status
adjust(ss_signal **signal, const char *path, const ss_read_opts *opts, ss_error *err)
{
    ss_signal *all = *signal, *chosen;
    ss_header *head = all->head;
    double *factor, start = head->start;
    uint64_t first, end;
    ss_status st = ss_calibrate_header(head, opts, path, &factor, err);
    if (st == SS_OK)
        st = ss_calibrate_rows(all->values, all->n, head->n_columns, 1, all->n, factor, path, err);
    free(factor);
    if (st != SS_OK)
        return st;
    ss_select_rows(head, opts, &first, &end);
    head->start = start;
    end = end < all->n ? end : all->n;
    if (first == 0 && end == all->n)
        return SS_OK;
    if (first >= end)
        return ss_fail_no_rows(path, opts->from, opts->to, err);
    size_t *column = malloc(head->n_columns * sizeof *column);
    for (size_t c = 0; column != NULL && c < head->n_columns; c++)
        column[c] = c;
    st = column != NULL ? ss_signal_select(&chosen, all, column, head->n_columns, (size_t)first, (size_t)end, err)
        : ss_fail_memory(err, path);
    free(column);
    if (st != SS_OK)
        return st;
    ss_signal_free(all);
    *signal = chosen;
    return SS_OK;
}

static ss_status
load_hdf5(ss_signal **out, const char *path, const char *file, const char *dataset, const ss_read_opts *opts,
          ss_error *err)
{
    ss_status st = ss_store_read_signal(out, file, dataset, opts, err);
    if (st != SS_OK || opts == NULL || (st = adjust(out, path, opts, err)) == SS_OK)
        return st;
    ss_signal_free(*out);
    *out = NULL;
    return st;
}

ss_status
ss_signal_load(ss_signal **out, const char *path, const ss_read_opts *opts, ss_error *err)
{
    struct stat st;
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    if (ss_store_is_hdf5(path))
        return load_hdf5(out, path, path, NULL, opts, err);
    const char *colon = strstr(path, ":/");
    if (colon == NULL || stat(path, &st) == 0)
        return load_stream(out, path, opts, err);
    char *file = strndup(path, (size_t)(colon - path));
    if (file == NULL)
        return ss_fail_memory(err, path);
    ss_status status = ss_store_is_hdf5(file)
                       ? load_hdf5(out, path, file, colon + 1, opts, err)
                       : stat(file, &st) != 0
                       ? ss_fail_errno(err, file, errno)
                       : ss_fail(err, SS_EDATA, "%s: not an HDF5 file, so '%s' is not in it", file,
                                 colon + 1);
    free(file);
    return status;
}
