/* calls.c -- all that HDF5 is needed for, as one table. */
#include "io/hdf5/groups.h"
#include "io/store.h"

const struct ss_store_calls *
ss_store_calls(ss_error *err)
{
    static const struct ss_store_calls calls = {
        .open_signal = ss_h5_open_signal,
        .open_coefficients = ss_h5_open_coefficients,
        .write = ss_h5_write,
        .writer_new = ss_h5_writer_new,
        .writer_signal = ss_h5_writer_signal,
        .writer_rows = ss_h5_writer_rows,
        .writer_note = ss_h5_writer_note,
        .writer_end = ss_h5_writer_end,
        .writer_free = ss_h5_writer_free,
    };
    (void)err;
    return &calls;
}
