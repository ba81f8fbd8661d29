/* series.h -- the rows of a signal that a picture shows, while they are read. */
#ifndef SERIES_H
#define SERIES_H

#include <stddef.h>
#include <stickslip/signal.h>
#include "plot/script.h"

typedef struct series {
    ss_reader *reader;
    const ss_header *head;
    const size_t *column;       /* those that are drawn */
    size_t n_columns, piece;
    size_t first, end;          /* rows that are drawn: those before end */
    size_t rows;                /* that were read */
    size_t at;                  /* the first row of the latest piece */
    double **wanted;            /* where the values of each column of the signal go, or NULL */
    double *value;              /* value[c * piece + i]: those of column[c] in the piece that are drawn */
} series;

/* Begin at the first row; to be freed even after a failure. */
ss_status ss_series_begin(series *s, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
                          ss_error *err);
/* Read the next n > 0 rows that are drawn.  n = 0: there are none, and all rows have been read. */
ss_status ss_series_next(series *s, size_t *n, ss_error *err);
ss_status ss_series_rewind(series *s, ss_error *err);
void ss_series_free(series *s);

#endif
