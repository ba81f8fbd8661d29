/* resampled.c -- a reader of what another gives, at another rate. */
#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "signal/header.h"
#include "signal/resample.h"
#include "io/reader.h"

#define MOST 1e6                /* samples for each row: a short file cannot fill a disk */

struct inner {
    ss_reader *reader;
    resampler *resampler;
    size_t row;                 /* rows read so far */
};

static ss_status
next_rows(void *source, double *stamp, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct inner *in = source;
    const ss_header *head = in->reader->head;
    ss_status st = ss_reader_rows(in->reader, column, max, n, err);
    for (size_t i = 0; i < *n; i++)
        stamp[i] = head->start + (double)in->row++ / head->rate;
    return st;
}

static ss_status
give_samples(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct inner *in = reader->source;
    return ss_resampler_rows(in->resampler, column, max, n, err);
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
    if (r == NULL || in == NULL
        || ss_resampler_new(&in->resampler, r->in.name, columns, rate, INFINITY, next_rows, in, NULL) != SS_OK) {
        ss_reader_free(r);
        if (in != NULL)
            ss_resampler_free(in->resampler);
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
