/* series.h -- the rows of a signal that a picture shows, while they are read, and what they are reduced to. */
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
    double start;               /* [s] when the first row is drawn */
    size_t first, end;          /* rows that are drawn: those before end */
    size_t rows;                /* that were read */
    ss_span *gap;
    size_t n_gaps;
    double **wanted;            /* where the values of each column of the signal go, or NULL */
    double *value;              /* value[c * piece + i]: those of column[c] in the piece that are drawn */
} series;

/* Begin to read what opts shows of a signal that is drawn from this time on; NaN: from its own.  To be freed
 * even after a failure. */
ss_status ss_series_begin(series *s, ss_reader *reader, const size_t column[], size_t n, double start,
                          const ss_plot_opts *opts, ss_error *err);
/* Read the next n > 0 rows that are drawn; values in gaps become NaN.  n = 0: there are none, and all rows have
 * been read.  SS_EINVAL: another value is not finite. */
ss_status ss_series_next(series *s, size_t *n, ss_error *err);
/* SS_EINVAL: gnuplot cannot draw values of a column between these, or there are none. */
ss_status ss_series_check(const ss_column *column, script_extent of_values, const script_span *span,
                          ss_error *err);
ss_status ss_series_rewind(series *s, ss_error *err);
void ss_series_free(series *s);

/* A signal in n panels: its column[i] lies in panel[i].  The first has all panels, and those over it what
 * ss_plot_opts.alike says. */
typedef struct layer {
    size_t *column, *panel, n;  /* n: 1 or more */
} layer;
enum { LAYERS = SS_PLOT_OVER + 1 };
/* Find those of a signal, for these columns (NULL: the first n), and of opts->over; to be freed even after a
 * failure. */
ss_status ss_layers_find(layer l[LAYERS], const ss_header *head, const size_t drawn[], size_t n,
                         const ss_plot_opts *opts, ss_error *err);
void ss_layers_free(layer l[LAYERS]);
/* The name of the block with the data of layer k in a panel, of those over the first with the panel's number from
 * this one on. */
void ss_layer_name(char name[40], size_t k, size_t panel, int first);
/* Plot the data of a panel, as lines or points, and all over it; the first panel has the legend.  before: what
 * lies below them in the plot command, with a comma. */
void ss_layers_plot(FILE *out, const layer l[], const ss_plot_opts *opts, size_t panel, int first,
                    const char *before, const char *by);

/* The smallest and the largest of each block of any number of values.  When all blocks are full, each two become
 * one, and blocks are then twice as long. */
typedef struct extremes {
    int order;                  /* a block has 2^order values */
    size_t n;                   /* values so far */
    size_t room;                /* blocks, a power of 2 */
    double *most, *least;       /* least is NULL if it is not wanted */
} extremes;

/* Make empty blocks.  Returns 0 if there is no memory; they are to be freed even then. */
int ss_extremes_make(extremes *b, size_t room, int both);
void ss_extremes_free(extremes *b);

/* *i becomes the block that the next value lies in.  Returns how many of the next n lie there. */
size_t ss_extremes_next(extremes *b, size_t n, size_t *i);
/* Add n values to blocks that keep both extremes; NaN is no value. */
void ss_extremes_add(extremes *b, const double *x, size_t n);
/* The number of blocks that have begun. */
size_t ss_extremes_count(const extremes *b);
/* What a line from x through block i has of it: its extremes, the nearer one first.  Returns how many values
 * these are, 1 or 2; 0 if the block has only NaN. */
size_t ss_extremes_of(const extremes *b, size_t i, double x, double pair[2]);

enum { BLOCKS = 2048 };         /* of a column; more than a picture has columns of pixels, even when half full */

/* A column that is drawn over time, reduced to the extremes of some blocks for each column of pixels. */
typedef struct trace {
    script_axis y;              /* its scale is the usual one; a caller may change it */
    extremes block;
    double from, step;          /* [s] the time of the first value, and between two */
} trace;

/* Read n columns, and find the part that is shown; all t are to be freed even after a failure.  SS_EINVAL:
 * gnuplot cannot draw a column, or all its values are missing. */
ss_status ss_traces_read(trace t[], script_span *span, ss_reader *reader, const size_t column[], size_t n,
                         double start, const ss_plot_opts *opts, ss_error *err);
/* Find the extent of a trace whose column and blocks are there, and what follows from it. */
ss_status ss_trace_end(trace *t, const series *s, const script_span *span, ss_error *err);
void ss_traces_free(trace t[], size_t n);
/* A datablock of time and scaled values, in which gaps are blank lines. */
void ss_trace_write(FILE *out, const char *name, const trace *t);

#endif
