/* read.c -- read our own files, and arrays in files of other programs, into memory. */
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "io/hdf5/groups.h"

struct ss_store_reader {
    h5_file file;
    char *path;
    ss_error error;
    wavelet_reader wavelet;
};

int
ss_store_has_signal(const char *path)
{
    if (path == NULL)
        return 0;
    h5_file file = { .id = -1, .path = path };
    int has = 0;
    QUIETLY(
        if (ss_h5_open(&file) == SS_OK)
            has = H5Lexists(file.id, "signal", H5P_DEFAULT) > 0;
        ss_h5_close(&file);
    );
    return has;
}

ss_status
ss_store_signal_reader(ss_reader **out, const char *path, const char *dataset,
                       const ss_read_opts *opts, ss_error *err)
{
    static const ss_read_opts no_opts;
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    h5_file file = { .id = -1, .path = path, .err = err };
    ss_reader *reader = calloc(1, sizeof *reader);
    ss_status status = reader != NULL ? SS_OK : SS_ENOMEM;
    opts = opts != NULL ? opts : &no_opts;
    QUIETLY(
        if (status == SS_OK)
            status = ss_h5_open(&file);
        if (status == SS_OK)
            status = ss_h5_open_signal(reader, &file, dataset, opts);
    );
    if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    if (status == SS_OK)
        status = ss_reader_adjust(reader, opts, err);
    if (status == SS_OK)
        *out = reader;
    else
        ss_reader_free(reader);
    return status;
}

ss_status
ss_store_read_signal(ss_signal **out, const char *path, const char *dataset,
                     const ss_read_opts *opts, ss_error *err)
{
    ss_reader *reader;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_status status = ss_store_signal_reader(&reader, path, dataset, opts, err);
    if (status != SS_OK)
        return status;
    status = ss_reader_all(out, reader, err);
    ss_reader_free(reader);
    return status;
}

ss_status
ss_store_reader_new(ss_store_reader **out, const char *path, ss_error *err)
{
    if (out == NULL || path == NULL)
        return SS_FAIL_NULL(err);
    ss_store_reader *r = calloc(1, sizeof *r);
    ss_status status = SS_ENOMEM;
    if (r != NULL)
        r->file = (h5_file){ .id = -1, .path = r->path = strdup(path), .err = &r->error };
    QUIETLY(
        if (r != NULL && r->path != NULL && (status = ss_h5_open(&r->file)) == SS_OK)
            status = ss_wavelet_reader_open(&r->wavelet, &r->file);
    );
    if (status == SS_OK)
        *out = r;
    else if (status == SS_ENOMEM)
        ss_fail(err, status, "%s: %s", path, ss_strerror(status));
    else if (err != NULL)
        *err = r->error;
    if (status != SS_OK)
        ss_store_reader_free(r);
    return status;
}

const ss_coefficients *
ss_store_reader_grid(const ss_store_reader *r)
{
    return r != NULL ? r->wavelet.grid : NULL;
}

ss_status
ss_store_reader_scale(ss_store_reader *r, size_t i, double *w, ss_error *err)
{
    ss_status status;
    if (r == NULL || w == NULL)
        return SS_FAIL_NULL(err);
    size_t n = r->wavelet.grid->n_scales;
    if (i >= n)
        return ss_fail(err, SS_EINVAL, "no scale %zu, there are %zu", i, n);
    QUIETLY(
        status = ss_wavelet_reader_scale(&r->wavelet, i, w);
    );
    if (status != SS_OK && err != NULL)
        *err = r->error;
    return status;
}

void
ss_store_reader_free(ss_store_reader *r)
{
    if (r == NULL)
        return;
    QUIETLY(
        ss_wavelet_reader_close(&r->wavelet);
        ss_h5_close(&r->file);
    );
    free(r->path);
    free(r);
}

ss_status
ss_store_read_coefficients(ss_coefficients **out, const char *path, ss_error *err)
{
    ss_store_reader *r;
    if (out == NULL)
        return SS_FAIL_NULL(err);
    ss_status status = ss_store_reader_new(&r, path, err);
    if (status != SS_OK)
        return status;
    ss_coefficients *c = r->wavelet.grid;
    c->w = malloc(2 * r->wavelet.total * sizeof *c->w);
    if (c->w == NULL)
        status = ss_fail_memory(err, path);
    for (size_t i = 0; status == SS_OK && i < c->n_scales; i++)
        status = ss_store_reader_scale(r, i, c->w + 2 * c->scale[i].offset, err);
    if (status == SS_OK) {
        *out = c;
        r->wavelet.grid = NULL;
    }
    ss_store_reader_free(r);
    return status;
}
