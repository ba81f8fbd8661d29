/* stickslip/store.h -- signals, events and coefficients in HDF5 files, in the
 * layout of stickslip-hdf5(5).
 *
 * Each writing call makes a complete file at path and replaces an existing one; on failure path is
 * removed.  A caller that needs the old file until the new one is complete writes to another name and
 * renames it, as the tools do.  The same input gives the same bytes.  Path may be a device
 * or a FIFO: the file is then made under no name and copied there.
 *
 * HDF5 itself is safe in several threads only where it was built so, which its serial packages are
 * not: calls of this header then come from one thread at a time. */
#ifndef STICKSLIP_STORE_H
#define STICKSLIP_STORE_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/sim.h>
#include <stickslip/morlet.h>

SS_BEGIN_DECLARATIONS

/* The contents of one file; NULL or 0 for absent parts. */
typedef struct ss_record {
    const ss_signal *signal;                /* /signal/t and a dataset a column */
    const ss_event *events;                 /* /events/... */
    size_t n_events;
    int has_events;                         /* 1: write /events even if there are none */
    const ss_coefficients *coefficients;    /* /wavelet/... */
} ss_record;

ss_status ss_store_write(const char *path, const ss_record *record, ss_error *err);

/* The same while samples and coefficients are still being made, in memory that does not grow with
 * their number.  Grid has head, n_scales, scale and center as in ss_coefficients; its n is the
 * length of the record, or 0 if that is not known yet: the datasets then have a time dimension
 * without limit.  Its head is ss_coefficients_header's; if its options say rounded, re and im
 * become multiples of a power of two that is at most 1.24 TOL x the largest |W| of their scale
 * until then, which leaves a third of the bytes or less: the error of what is read back is within TOL.  Signal is
 * the header of the transformed signal, with all columns that are stored beside it, or NULL.  Grid may be
 * NULL, too: then there is only a signal, whose length is not known yet. */
typedef struct ss_store_writer ss_store_writer;
ss_status ss_store_writer_new(ss_store_writer **out, const char *path, const ss_header *signal,
                              const ss_coefficients *grid, ss_error *err);
/* Append n samples of each column: sample i of column c is x[i * row + c * column]. */
ss_status ss_store_writer_signal(ss_store_writer *writer, const double *x, size_t n, size_t row,
                                 size_t column, ss_error *err);
/* The arguments of a sink of coefficients. */
ss_status ss_store_writer_rows(ss_store_writer *writer, const ss_scale *scale, size_t first,
                               size_t n, const double *w, size_t samples, ss_error *err);
/* A note that the header did not have. */
ss_status ss_store_writer_note(ss_store_writer *writer, const char *key, const char *value, ss_error *err);
/* End: the record has so many samples, and all of them and their coefficients have been appended. */
ss_status ss_store_writer_end(ss_store_writer *writer, size_t samples, ss_error *err);
/* A file without ss_store_writer_end is removed; NULL is allowed. */
void ss_store_writer_free(ss_store_writer *writer);

/* 1 if the file is HDF5 (its signature at byte 0, 512, 1024, ...), else 0, also if it cannot be
 * read. */
int ss_store_is_hdf5(const char *path);

/* 1 if the file is HDF5 with a /signal in it, damaged or not. */
int ss_store_has_signal(const char *path);

/* Begin to read /signal of one of our files (dataset NULL or ""), or any 1-D or 2-D real dataset by its
 * path (columns are the shorter dimension), MATLAB v7.3 among them; its clock from opts->rate.
 * /signal has a clock of its own: SS_EDATA if opts ask for another.  Rows are read chunk by chunk, in
 * memory that does not grow with their number, but all at once where gaps are to be filled. */
ss_status ss_store_signal_reader(ss_reader **out, const char *path, const char *dataset,
                                 const ss_read_opts *opts, ss_error *err);
/* All rows of it. */
ss_status ss_store_read_signal(ss_signal **out, const char *path, const char *dataset,
                               const ss_read_opts *opts, ss_error *err);
ss_status ss_store_read_coefficients(ss_coefficients **out, const char *path, ss_error *err);

/* The same scale by scale, so that memory is that of one.  The grid, whose w is NULL, belongs to the
 * reader; w of a scale has room for its 2 n doubles. */
typedef struct ss_store_reader ss_store_reader;
ss_status ss_store_reader_new(ss_store_reader **out, const char *path, ss_error *err);
const ss_coefficients *ss_store_reader_grid(const ss_store_reader *reader);
ss_status ss_store_reader_scale(ss_store_reader *reader, size_t i, double *w, ss_error *err);
void ss_store_reader_free(ss_store_reader *reader);     /* NULL is allowed */

SS_END_DECLARATIONS
#endif
