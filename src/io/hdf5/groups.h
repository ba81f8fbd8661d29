/* groups.h -- a reader and a writer of each group of our files; they fail as ss_h5_fail does. */
#ifndef GROUPS_H
#define GROUPS_H

#include "io/hdf5/h5.h"
#include "io/hdf5/h5_write.h"
#include "signal/source.h"

/* /signal (signal_writer.c, read.c).  The samples come in pieces; the datasets stay open. */
typedef struct signal_writer {
    h5_pieces *pieces;
    size_t length, samples;     /* length: in all, unless the file grows; samples: written so far */
    size_t n_columns;
    hid_t *column, times;       /* column: a dataset each; NULL: there is no /signal */
} signal_writer;

/* Begin /signal with the columns of a header.  Pieces stay the caller's. */
ss_status ss_signal_writer_open(signal_writer *w, h5_pieces *pieces, const ss_header *head,
                                size_t length);
/* n samples more of each column. */
ss_status ss_signal_writer_append(signal_writer *w, double *const column[], size_t n);

/* Open /signal, or the array at a path in the file; *out is to be freed even after a failure. */
ss_status ss_h5_open_signal(ss_source **out, const char *path, const char *dataset, const ss_read_opts *opts,
                            ss_error *err);
/* The same for a file that is open, unless id < 0, and becomes the source's. */
ss_status ss_h5_begin_signal(ss_source **out, hid_t id, const char *path, const char *dataset,
                             const ss_read_opts *opts, ss_error *err);
/* /events (events_writer.c). */
ss_status ss_h5_write_events(h5_file *file, const ss_event *event, size_t n);

/* /wavelet (wavelet_writer.c, wavelet_reader.c).  The coefficients of each scale come in pieces.  Where
 * their number is known, the datasets of a scale are closed when they are full; else all stay open. */
typedef struct wavelet_writer {
    h5_pieces *pieces;
    size_t n, n_scales;         /* n: samples of the record */
    ss_scale *scale;
    ss_span *gap;
    size_t n_gaps;
    char *unit;                 /* of the coefficients */
    double tolerance;           /* of rounding, re the largest |W| of a scale; 0: all bits stay */
    int dense;
    hid_t group;
    struct scale_datasets *datasets;    /* of each scale; if dense, the first holds those of all */
} wavelet_writer;

ss_status ss_wavelet_writer_open(wavelet_writer *w, h5_pieces *pieces, const ss_coefficients *grid);
/* The scale with this j, if n of its coefficients from the first on are the next; else n_scales. */
size_t ss_wavelet_writer_find(const wavelet_writer *w, const ss_scale *scale, size_t first, size_t n);
/* The next n coefficients of scale i, as pairs, of a record with so many samples until now. */
ss_status ss_wavelet_writer_append(wavelet_writer *w, size_t i, size_t n, const double *x,
                                   size_t samples);
/* Write the length and the times that all scales share, which are known only at the end. */
ss_status ss_wavelet_writer_end(wavelet_writer *w, size_t samples);
void ss_wavelet_writer_free(wavelet_writer *w);

/* The coefficients of a file, which stay there (wavelet_reader.c). */
ss_status ss_h5_open_coefficients(ss_coefficients **out, const char *path, ss_error *err);
/* The same for a file that is open, unless id < 0, and becomes the map's. */
ss_status ss_h5_begin_coefficients(ss_coefficients **out, hid_t id, const char *path, ss_error *err);

#endif
