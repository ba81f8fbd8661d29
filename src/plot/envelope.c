/* envelope.c -- reduce a signal of any length for a picture over time: a long signal becomes the
 * extremes of blocks, of which each column of pixels has many. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "plot/extremes.h"
#include "plot/script.h"

enum {
    KEPT = 1 << 20,             /* values of a signal that is drawn as it is */
    LEAST_KEPT = 4096           /* rows */
};

typedef struct envelope {
    ss_reader *reader;
    ss_header head;             /* of the source, from its start in the picture on */
    const size_t *column;
    size_t n_columns;           /* of these */
    size_t room;                /* rows, and blocks */
    double *kept;               /* of each column that is drawn room values: the first, then a piece */
    double **to;                /* where those of each column of the source go, or NULL */
    size_t n;                   /* rows so far */
    size_t first, end;          /* those that are drawn */
    extremes *part;             /* of each column */
} envelope;

/* Read at most max rows, and keep their values from number `at` on. */
static ss_status
read_piece(envelope *e, size_t at, size_t max, size_t *got, ss_error *err)
{
    size_t piece = ss_reader_piece(e->reader);
    for (size_t c = 0; c < e->n_columns; c++)
        e->to[e->column[c]] = e->kept + c * e->room + at;
    return ss_reader_rows(e->reader, e->to, max < piece ? max : piece, got, err);
}

static ss_status
read_start(envelope *e, ss_error *err)
{
    ss_status st = SS_OK;
    for (size_t got = 1; st == SS_OK && got > 0 && e->n < e->room; e->n += got)
        st = read_piece(e, e->n, e->room - e->n, &got, err);
    return st;
}

/* Make a signal of the rows that were read. */
static ss_status
give_whole(const envelope *e, ss_header *head, ss_signal **out)
{
    ss_status st = ss_signal_new(out, head, e->n);
    for (size_t c = 0; st == SS_OK && c < e->n_columns; c++)
        memcpy((*out)->values + c * e->n, e->kept + c * e->room, e->n * sizeof *e->kept);
    return st;
}

/* Add the n rows that are kept; the first of them is row number at of the source. */
static void
add_rows(envelope *e, size_t at, size_t n)
{
    size_t from = at < e->first ? e->first - at : 0, end = e->end > at ? e->end - at : 0;
    end = end < n ? end : n;
    for (size_t c = 0; from < end && c < e->n_columns; c++)
        ss_extremes_add(&e->part[c], e->kept + c * e->room + from, end - from);
}

static ss_status
read_rest(envelope *e, ss_error *err)
{
    ss_status st = SS_OK;
    e->part = calloc(e->n_columns, sizeof *e->part);
    for (size_t c = 0; e->part != NULL && st == SS_OK && c < e->n_columns; c++)
        st = ss_extremes_make(&e->part[c], e->room, 1) ? SS_OK : SS_ENOMEM;
    if (e->part == NULL || st != SS_OK)
        return ss_fail_memory(err, NULL);
    add_rows(e, 0, e->n);
    for (size_t got = 1; st == SS_OK && got > 0; e->n += got) {
        st = read_piece(e, 0, e->room, &got, err);
        add_rows(e, e->n, got);
    }
    return st;
}

/* Make a signal of the blocks; opts get the span of the source. */
static ss_status
give_blocks(const envelope *e, ss_header *head, ss_signal **out, ss_plot_opts *opts, ss_error *err)
{
    script_span span;
    ss_status st = ss_script_find_span(&span, &e->head, e->n, opts, err);
    if (st != SS_OK)
        return st;
    size_t n = ss_extremes_each(e->part) * ss_extremes_count(e->part);
    head->start += (double)e->first / e->head.rate;
    head->rate = ldexp((double)ss_extremes_each(e->part) * e->head.rate, -e->part->order);
    st = ss_signal_new(out, head, n);
    for (size_t c = 0; st == SS_OK && c < e->n_columns; c++)
        ss_extremes_give(&e->part[c], (*out)->values + c * n);
    opts->from = span.from;
    opts->to = span.to;
    return st;
}

ss_status
ss_plot_envelope(ss_signal **out, size_t *rows, ss_reader *reader, const size_t column[], size_t n,
                 double start, ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || rows == NULL || reader == NULL || column == NULL || n == 0 || opts == NULL)
        return SS_FAIL_NULL(err);
    envelope e = { .reader = reader, .head = *ss_reader_header(reader), .column = column, .n_columns = n };
    size_t columns = e.head.n_columns;
    ss_header *head = NULL;
    e.room = LEAST_KEPT;
    while (e.room * columns < KEPT)
        e.room *= 2;
    *out = NULL;
    e.head.start = start;
    ss_script_find_rows(&e.first, &e.end, &e.head, opts);
    e.to = calloc(columns, sizeof *e.to);
    e.kept = malloc(e.room * n * sizeof *e.kept);
    ss_status st = e.to != NULL && e.kept != NULL
        ? ss_header_select(&head, ss_reader_header(reader), column, n, 0) : SS_ENOMEM;
    st = st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st == SS_OK ? read_start(&e, err) : st;
    int whole = e.n < e.room;
    if (st == SS_OK)
        st = whole ? give_whole(&e, head, out) : read_rest(&e, err);
    if (st == SS_OK && !whole)
        st = give_blocks(&e, head, out, opts, err);
    for (size_t c = 0; e.part != NULL && c < n; c++)
        ss_extremes_free(&e.part[c]);
    free(e.part);
    free(e.to);
    free(e.kept);
    ss_header_free(head);
    *rows = e.n;
    return st;
}
