/* store.h -- what HDF5 is needed for: the functions of stickslip/store.h behind their checks of arguments. */
#ifndef STORE_H
#define STORE_H

#include <stickslip/store.h>
#include "signal/source.h"

struct ss_store_calls {
    /* As open_file of a format. */
    ss_status (*open_signal)(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts,
                             ss_error *err);
    ss_status (*open_coefficients)(ss_coefficients **out, const char *path, ss_error *err);
    ss_status (*write)(const char *path, const ss_record *record, ss_error *err);
    ss_status (*writer_new)(ss_store_writer **out, const char *path, const ss_header *signal,
                            const ss_coefficients *grid, ss_error *err);
    ss_status (*writer_signal)(ss_store_writer *writer, double *const column[], size_t n, ss_error *err);
    ss_status (*writer_rows)(ss_store_writer *writer, const ss_scale *scale, size_t first, size_t n,
                             const double *w, size_t samples, ss_error *err);
    ss_status (*writer_note)(ss_store_writer *writer, const char *key, const char *value, ss_error *err);
    ss_status (*writer_end)(ss_store_writer *writer, size_t samples, ss_error *err);
    void (*writer_free)(ss_store_writer *writer);
};

#endif
