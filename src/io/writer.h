/* writer.h -- a writer of one file: as a stream (writer.c), or in HDF5 (hdf5/writer.c). */
#ifndef WRITER_H
#define WRITER_H

#include <stickslip/store.h>
#include "signal/source.h"

struct writer_calls {           /* as the public functions, whose arguments have been checked */
    ss_status (*rows)(ss_writer *w, double *const column[], size_t n, ss_error *err);
    ss_status (*coefficients)(ss_writer *w, const ss_scale *scale, size_t first, size_t n, const double *c,
                              size_t samples, ss_error *err);
    ss_status (*events)(ss_writer *w, const ss_event *event, size_t n, ss_error *err);
    ss_status (*note)(ss_writer *w, const char *key, const char *value, ss_error *err);
    ss_status (*end)(ss_writer *w, size_t samples, ss_error *err);
    void (*free)(ss_writer *w);
};

/* The first member of each writer. */
struct ss_writer {
    const struct writer_calls *calls;
};

/* What HDF5 is needed for, behind the checks of arguments. */
struct ss_store_calls {
    /* As open_file of a format. */
    ss_status (*open_signal)(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts,
                             ss_error *err);
    ss_status (*open_coefficients)(ss_coefficients **out, const char *path, ss_error *err);
    ss_status (*writer_new)(ss_writer **out, const char *path, const ss_contents *contents, ss_error *err);
};

#endif
