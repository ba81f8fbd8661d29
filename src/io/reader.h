/* reader.h -- a signal while it is read. */
#ifndef READER_H
#define READER_H

#include <stdint.h>
#include <stickslip/signal.h>
#include "io/input.h"

/* Rows as ss_reader_rows gives them; each format has its own. */
typedef ss_status read_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err);

typedef struct sample_type {    /* of a sound file; integers are signed, big-endian comes first */
    unsigned bytes;
    int is_float, is_unsigned, little_endian;
} sample_type;

struct ss_reader {
    struct input in;
    ss_header *head;
    read_rows *rows;
    ss_kind kind;               /* a signal, or wavelet coefficients */
    ss_status (*late_note)(ss_reader *reader, char *line, ss_error *err);   /* among rows; NULL: passed over */
    uint64_t row;               /* rows of the source that were read so far */
    double start;               /* of the source, whose first rows may be left out */
    uint64_t first, end_row;    /* the rows to be given; end_row is not */
    uint64_t passed;            /* the source's rows that were read */
    double from, to;            /* [s] the span asked for; from >= to: all */
    double *factor;             /* of each column, or NULL */
    sample_type type;           /* frames: of their values */
    uint64_t bytes_left;        /* frames: UINT64_MAX if unknown */
    uint64_t end;               /* frames: their end in the file, unless that is unknown */
    int is_chunk;               /* frames: behind them, another chunk of a WAV file is no error */
    double **values;            /* HDF5: a piece of each column */
    size_t n_rows, next;        /* next: of these, to be given */
    uint64_t length;            /* rows of the source; UINT64_MAX: not known before its end */
    void *source;               /* what the reader has opened itself */
    void (*close)(ss_reader *reader);   /* closes that, or NULL */
    struct table *table;        /* of delimited text, or NULL */
    ss_status (*rewind)(ss_reader *reader, ss_error *err);      /* back to its first row; NULL: it cannot */
    struct gap_filler *gaps;    /* or NULL */
    read_rows *with_gaps;       /* gives NaN where they are to be filled */
    int (*waits)(const ss_reader *reader);      /* for a source of its own; NULL: it reads `in` */
};

/* Begin to read a file of this kind, in the format that its first bytes show; to be closed even
 * after a failure. */
ss_status ss_reader_open(ss_reader *reader, FILE *in, const char *name, ss_kind kind,
                         const ss_read_opts *opts, ss_error *err);
void ss_reader_close(ss_reader *reader);
/* A reader without a source, with the name and header of another.  NULL: no memory. */
ss_reader *ss_reader_like(const ss_reader *reader);
/* The last step of opening: apply the options that hold for every format; needs the header, length
 * and in.name. */
ss_status ss_reader_adjust(ss_reader *reader, const ss_read_opts *opts, ss_error *err);

/* Fill the gaps of a reader whose rows have NaN there, and which can go back: all rows are read first. */
ss_status ss_reader_fill_gaps(ss_reader *reader, ss_gaps how, ss_error *err);

/* Read all remaining rows. */
ss_status ss_reader_all(ss_signal **out, ss_reader *reader, ss_error *err);

#endif
