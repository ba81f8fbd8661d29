/* resampled.c -- a reader of what another gives, at another rate. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "signal/resample.h"
#include "io/reader.h"

#define MOST 1e6                /* samples for each row: a short file cannot fill a disk */

struct inner {
    ss_reader *reader;
    resampler *resampler;
    double *rows;               /* the rows that were read */
    size_t n, next;             /* their number; the next of them to be given */
    size_t row;                 /* rows given so far */
};

static ss_status
next_row(void *source, int *there, double *stamp, double *row, ss_error *err)
{
    struct inner *in = source;
    const ss_header *head = in->reader->head;
    ss_status st = SS_OK;
    if (in->next == in->n) {
        in->next = in->n = 0;
        st = ss_reader_rows(in->reader, in->rows, ss_reader_piece(in->reader), &in->n, err);
    }
    *there = st == SS_OK && in->next < in->n;
    if (!*there)
        return st;
    memcpy(row, in->rows + in->next++ * head->n_columns, head->n_columns * sizeof *row);
    *stamp = head->start + (double)in->row++ / head->rate;
    return SS_OK;
}

static ss_status
give_samples(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err)
{
    struct inner *in = reader->source;
    return ss_resampler_rows(in->resampler, rows, max, n, err);
}

static int
waits(const ss_reader *reader)
{
    const struct inner *in = reader->source;
    return ss_reader_waits(in->reader);
}

static void
close_inner(ss_reader *reader)
{
    struct inner *in = reader->source;
    ss_resampler_free(in->resampler);
    ss_reader_free(in->reader);
    free(in->rows);
    free(in);
}

ss_status
ss_reader_resample(ss_reader **reader, double rate, ss_error *err)
{
    if (reader == NULL || *reader == NULL)
        return SS_FAIL_NULL(err);
    if (!(rate > 0) || !isfinite(rate))
        return ss_fail(err, SS_EINVAL, "nothing can be resampled at %g Hz", rate);
    const ss_header *head = (*reader)->head;
    if (!(rate / head->rate <= MOST))
        return ss_fail(err, SS_EDATA, "%s: each sample would become %.3g at %g Hz; at most %g are made",
                       (*reader)->in.name, rate / head->rate, rate, MOST);
    ss_status st = ss_refuse_range((*reader)->in.name, rate, head->start, err);
    if (st != SS_OK)
        return st;
    size_t columns = head->n_columns;
    ss_reader *r = ss_reader_like(*reader);
    struct inner *in = calloc(1, sizeof *in);
    size_t room = ss_reader_piece(*reader) * columns * sizeof(double);
    if (r == NULL || in == NULL || (in->rows = malloc(room)) == NULL
        || ss_resampler_new(&in->resampler, r->in.name, columns, rate, INFINITY, next_row, in, NULL) != SS_OK) {
        ss_reader_free(r);
        if (in != NULL) {
            ss_resampler_free(in->resampler);
            free(in->rows);
        }
        free(in);
        return ss_fail_memory(err, (*reader)->in.name);
    }
    in->reader = *reader;
    r->head->rate = rate;
    r->rows = give_samples;
    r->waits = waits;
    r->source = in;
    r->close = close_inner;
    *reader = r;
    return SS_OK;
}
