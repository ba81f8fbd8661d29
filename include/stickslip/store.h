/* stickslip/store.h -- write signals, events and coefficients in any format, as they come or at once.
 *
 * A format is written to a stream, or, if it is HDF5 (in the layout of stickslip-hdf5(5)), to a path.  There a
 * complete file replaces an existing one; after a failure there is none.  A caller that needs the old file until
 * the new one is complete writes to another name and then renames it.  The same input gives the same bytes.
 *
 * The serial packages of HDF5 are not safe for threads.  With them, a program writes or reads HDF5 from one
 * thread at a time. */
#ifndef STICKSLIP_STORE_H
#define STICKSLIP_STORE_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/status.h>
#include <stickslip/signal.h>
#include <stickslip/sim.h>
#include <stickslip/morlet.h>

SS_BEGIN_DECLARATIONS

/* What is written.  HDF5 holds all of it; other formats one of it: events, or else coefficients, or else
 * samples, and leave out what is appended of the others. */
typedef struct ss_contents {
    const ss_header *signal;                /* samples of these columns; NULL: none.  Events have its notes */
    const ss_coefficients *grid;            /* coefficients, of which head (by ss_coefficients_header), n_scales,
                                               scale and center are read; NULL: none */
    int events;                             /* 1: events, even if there will be none */
    size_t n;                               /* samples of the record; 0: not known before the end */
} ss_contents;

/* Begin a file on the stream out, which stays the caller's, or for SS_H5 at path; the other one may be NULL.
 * contents is copied.  SS_EINVAL: the format is not known, or cannot hold this; SS_EDATA: too many notes.
 *
 * If the options in grid->head say rounded, re and im in HDF5 become multiples of a power of two that is
 * at most 1.24 TOL x the largest |W| of their scale so far.  They then take a third of the bytes
 * or less, and the error of what a reader gets is still within TOL.  They are 32-bit floats if TOL
 * is at least 1e-7 and the first |W| is from 1e-20 to 1e20. */
typedef struct ss_writer ss_writer;
ss_status ss_writer_new(ss_writer **out_writer, FILE *out, const char *path, ss_format format,
                        const ss_contents *contents, ss_error *err);
/* Append n rows, whose values in column c are column[c][0] ... column[c][n - 1].  SS_EIO: they cannot be
 * written. */
ss_status ss_writer_rows(ss_writer *writer, double *const column[], size_t n, ss_error *err);
/* Append coefficients; the arguments are those of an ss_coefficient_sink.  SS_ERANGE: they outgrow
 * 32-bit floats. */
ss_status ss_writer_coefficients(ss_writer *writer, const ss_scale *scale, size_t first, size_t n, const double *w,
                                 size_t samples, ss_error *err);
ss_status ss_writer_events(ss_writer *writer, const ss_event *event, size_t n, ss_error *err);
/* Append a note that was not known before; AU and CSV leave it out. */
ss_status ss_writer_note(ss_writer *writer, const char *key, const char *value, ss_error *err);
/* Complete the file, and flush out.  samples: the length of the record, all of which and all coefficients have
 * been appended.  SS_EIO: this or an earlier write failed. */
ss_status ss_writer_end(ss_writer *writer, size_t samples, ss_error *err);
/* Without ss_writer_end a file in HDF5 is removed.  NULL is allowed. */
void ss_writer_free(ss_writer *writer);

/* The simple case: write what is in memory.  A part that is NULL is not written. */
typedef struct ss_record {
    const ss_signal *signal;
    const ss_event *events;
    size_t n_events;
    int has_events;                         /* 1: write events even if there are none */
    const ss_coefficients *coefficients;    /* with all of them in w */
} ss_record;
ss_status ss_record_write(const ss_record *record, FILE *out, const char *path, ss_format format, ss_error *err);

/* All that needs the HDF5 library, as one table.  A program that is linked with the static library may
 * define this function itself: to open the shared library when a file needs it, and return what the function there
 * returns.  NULL, with the reason in *err: there is none. */
struct ss_store_calls;
const struct ss_store_calls *ss_store_calls(ss_error *err);

SS_END_DECLARATIONS
#endif
