/* store.h -- what HDF5 is needed for, behind the checks of arguments. */
#ifndef STORE_H
#define STORE_H

#include <stickslip/store.h>
#include "signal/source.h"

struct ss_store_calls {
    /* As open_file of a format. */
    ss_status (*open_signal)(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts,
                             ss_error *err);
    ss_status (*open_coefficients)(ss_coefficients **out, const char *path, ss_error *err);
    ss_status (*writer_new)(ss_writer **out, const char *path, const ss_contents *contents, ss_error *err);
};

#endif
