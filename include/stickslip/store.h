/* stickslip/store.h -- signals, events and coefficients in HDF5 files, in the layout of
 * stickslip-hdf5(5).
 *
 * A call that writes makes a complete file at path and replaces an existing one; if it fails, it
 * removes path.  A caller that needs the old file until the new one is complete writes to another
 * name and then renames it.  The same input gives the same bytes.  path may be a device or a FIFO:
 * the file is then made without a name and copied there.
 *
 * The serial packages of HDF5 are not safe for threads.  With them, a program calls the functions
 * of this header from one thread at a time. */
#ifndef STICKSLIP_STORE_H
#define STICKSLIP_STORE_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/sim.h>
#include <stickslip/morlet.h>

SS_BEGIN_DECLARATIONS

/* The contents of one file.  A part that is NULL is not written. */
typedef struct ss_record {
    const ss_signal *signal;                /* /signal/t and a dataset for each column */
    const ss_event *events;                 /* /events/... */
    size_t n_events;
    int has_events;                         /* 1: write /events even if there are no events */
    const ss_coefficients *coefficients;    /* /wavelet/... */
} ss_record;

/* Write a file of what is in memory. */
ss_status ss_store_write(const char *path, const ss_record *record, ss_error *err);

/* Write a file while its samples and coefficients are still being made, in memory that does not
 * grow with their number.
 *
 * signal is the header of the transformed signal, with all columns that are stored; NULL: the file
 * has no signal.  grid has head (by ss_coefficients_header), n_scales, scale and center as in
 * ss_coefficients; NULL: the file has only a signal, whose length is not known yet.  grid->n is
 * the length of the record; 0: it is not known yet, and the datasets have a time dimension without
 * limit.
 *
 * If the options in grid->head say rounded, re and im become multiples of a power of two that is
 * at most 1.24 TOL x the largest |W| of their scale so far.  They then take a third of the bytes
 * or less, and the error of what a reader gets is still within TOL.  They are 32-bit floats if TOL
 * is at least 1e-7 and the first |W| is from 1e-20 to 1e20. */
typedef struct ss_store_writer ss_store_writer;
ss_status ss_store_writer_new(ss_store_writer **out, const char *path, const ss_header *signal,
                              const ss_coefficients *grid, ss_error *err);
/* Append n samples of each column: those of column c are column[c][0] ... column[c][n - 1]. */
ss_status ss_store_writer_signal(ss_store_writer *writer, double *const column[], size_t n, ss_error *err);
/* Append coefficients; the arguments are those of an ss_coefficient_sink.  SS_ERANGE: they outgrow
 * 32-bit floats. */
ss_status ss_store_writer_rows(ss_store_writer *writer, const ss_scale *scale, size_t first,
                               size_t n, const double *w, size_t samples, ss_error *err);
/* Append a note; it replaces one with the same key. */
ss_status ss_store_writer_note(ss_store_writer *writer, const char *key, const char *value, ss_error *err);
/* Complete the file.  All samples of the record, so many, and their coefficients have been appended. */
ss_status ss_store_writer_end(ss_store_writer *writer, size_t samples, ss_error *err);
/* Free the writer; without ss_store_writer_end the file is removed.  NULL is allowed. */
void ss_store_writer_free(ss_store_writer *writer);

/* 1 if the file is HDF5 (its signature is at byte 0, 512, 1024, ...); 0 if it is not, or cannot be
 * read. */
int ss_store_is_hdf5(const char *path);

/* Read all of /wavelet.  The caller frees *out with ss_coefficients_free. */
ss_status ss_store_read_coefficients(ss_coefficients **out, const char *path, ss_error *err);

/* Read its grid alone.  The file stays open until *out is freed: ss_map_read reads coefficients from it,
 * in the memory of one scale. */
ss_status ss_store_open_coefficients(ss_coefficients **out, const char *path, ss_error *err);

/* All of this that needs the HDF5 library, as one table.  A program that is linked with the static library may
 * define this function itself: to open the shared library when a file needs it, and return what the function there
 * returns.  NULL, with the reason in *err: there is none. */
struct ss_store_calls;
const struct ss_store_calls *ss_store_calls(ss_error *err);

SS_END_DECLARATIONS
#endif
