/* reader.h -- a signal that is being read. */
#ifndef READER_H
#define READER_H

#include <stdint.h>
#include <stickslip/signal.h>
#include "stream/input.h"

/* Rows as ss_reader_rows gives them; each format has its own. */
typedef ss_status read_rows(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err);

typedef struct sample_type {    /* of a sound file; integers are signed, big-endian comes first */
    unsigned bytes;
    int is_float, is_unsigned, little_endian;
} sample_type;

struct ss_reader {
    struct input in;
    ss_header *head;
    read_rows *rows;
    const char *magic;          /* with which the header begins, in text and in AU's annotation */
    uint64_t row;               /* rows given so far */
    sample_type type;           /* frames: of their values */
    uint64_t bytes_left;        /* frames: UINT64_MAX if unknown */
    uint64_t end;               /* frames: where they end in the file, unless that is unknown */
    int is_chunk;               /* frames: behind them, another chunk of a WAV file is no error */
    double *values;             /* delimited text: all rows, one after the other */
    size_t n_rows;
};

#endif
