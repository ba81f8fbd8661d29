/* source.h -- a source of rows: each format that is read, and each step between a format and its reader.
 *
 * A source gives the rows of its header, column by column, from the first to the last.  Steps wrap each
 * other: a source of filled gaps has the source with the gaps as its inner one. */
#ifndef SOURCE_H
#define SOURCE_H

#include <stddef.h>
#include <stdint.h>
#include <stickslip/signal.h>

typedef struct source ss_source;

struct source_calls {
    /* At most max rows, as ss_reader_rows gives them; *n is 0 before the call.  Or make rows that are given from
     * here on: set held, and given to the first of them.  NULL: all are there when it begins. */
    ss_status (*next)(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err);
    /* Back to the first row, beside what all sources do; NULL: there is nothing more to do. */
    void (*rewind)(ss_source *s);
    int (*left)(const ss_source *s);       /* 1: it has rows that it has read and not given; NULL: it keeps none */
    void (*free)(ss_source *s);            /* what the source itself holds; NULL: nothing */
};

/* The first member of each source. */
struct source {
    const struct source_calls *calls;
    char *name;                 /* of the file, for messages */
    ss_header *head;
    uint64_t length;            /* rows; UINT64_MAX: not known before the last */
    int rewinds;                /* 1: it can go back, to begin with if calls has rewind, or the inner one can */
    int stamped;                /* 1: the last column holds the times of the rows, at any spacing */
    unsigned long line;         /* of text, where the last row stood; 0: rows have no lines */
    ss_source *inner;              /* the one whose rows these are made of, or NULL */
    const double *made;         /* rows that were made: the value of row i in column c is made[c * apart + i] */
    size_t apart, held, given;  /* held: rows there; given: of these, the next to be given */
    uint64_t row;               /* for its own use: the number of the next row; 0 after going back */
};

/* A source of this size, all zeros behind its first member, with an empty header.  NULL: no memory. */
void *ss_source_new(size_t size, const struct source_calls *calls, const char *name, ss_error *err);
/* Wrap *s, whose header is copied, and let *s be the new one.  Returns it; NULL: no memory, *s stays. */
void *ss_source_wrap(ss_source **s, size_t size, const struct source_calls *calls, ss_error *err);
/* Let *s be the inner one again, and free the outer one. */
void ss_source_unwrap(ss_source **s);
void ss_source_free(ss_source *s);                 /* with the inner ones; NULL is allowed */

ss_status ss_source_rows(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err);
/* SS_EINVAL: it cannot. */
ss_status ss_source_rewind(ss_source *s, ss_error *err);
/* 1: it, or an inner one, has rows that were read or made, and not given. */
int ss_source_has_rows(const ss_source *s);
/* The rows to read at a time, as ss_reader_piece. */
size_t ss_source_piece(const ss_source *s);
/* All rows that are left, as a signal. */
ss_status ss_source_all(ss_signal **out, ss_source *s, ss_error *err);
/* The rows of a signal in memory, which must live as long. */
ss_source *ss_source_of_signal(const ss_signal *signal, const char *name, ss_error *err);

/* Is the time start + row / rate, but for rounding and 1e-6 sample periods? */
int ss_is_on_clock(double time, double rate, double start, uint64_t row);

/* Wrap a source in one that gives its rows filtered, or with noise, as ss_reader_filter and ss_reader_noise do. */
ss_status ss_source_filter(ss_source **s, const ss_filter_opts *opts, ss_error *err);
ss_status ss_source_noise(ss_source **s, const ss_noise_opts *opts, ss_noise_done *done, ss_error *err);

/* Wrap a source in one that gives its rows at this rate [Hz], from the first on, by a cubic spline through
 * each column; NaN are skipped.  stamped: the last column of the source holds the times of its rows, which
 * ascend; it is left out, and samples between times more than longest [s] apart, or beyond a column's own
 * first and last, are NaN.  SS_EDATA, when rows are read: there is but one; SS_ERANGE: a value is not
 * finite. */
ss_status ss_source_resample(ss_source **s, double rate, int stamped, double longest, ss_error *err);

/* The first sample in which there is no value, if times end at one and go on at another, or a negative
 * number; both count from the first time. */
double ss_resample_gap(double end, double next, double rate);
/* The number of samples from the first time to the last, which may be more than an integer holds. */
double ss_resample_count(double first, double last, double rate);

#endif
