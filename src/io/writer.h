/* writer.h -- a writer of one file: as a stream (writer.c), or in HDF5 (hdf5/writer.c). */
#ifndef WRITER_H
#define WRITER_H

#include <stickslip/store.h>

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

#endif
