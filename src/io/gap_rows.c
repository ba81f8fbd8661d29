/* gap_rows.c -- a reader whose gaps are filled. */
#include <stdlib.h>
#include "base/columns.h"
#include "base/error.h"
#include "signal/gaps.h"
#include "io/reader.h"

static ss_status
filled_rows(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    ss_status st = reader->with_gaps(reader, column, max, n, err);
    if (!ss_gaps_fill(reader->gaps, column, *n))
        return ss_fail(err, SS_EDATA, "%s: the rows have changed while they were read", reader->in.name);
    return st;
}

ss_status
ss_reader_fill_gaps(ss_reader *reader, ss_gaps how, ss_error *err)
{
    size_t columns = reader->head->n_columns, piece = 1 + 16384 / columns, n = 1;
    double **column = ss_columns_new(columns, piece);
    reader->gaps = ss_gaps_new(columns, how);
    ss_status st = column != NULL && reader->gaps != NULL ? SS_OK : ss_fail_memory(err, reader->in.name);
    while (st == SS_OK && n > 0) {
        n = 0;
        st = reader->rows(reader, column, piece, &n, err);
        if (st == SS_OK && !ss_gaps_add(reader->gaps, column, n))
            st = ss_fail_memory(err, reader->in.name);
    }
    free(column);
    if (st == SS_OK)
        st = ss_gaps_begin(reader->gaps, reader->head, reader->in.name, err);
    if (st == SS_OK)
        st = reader->rewind(reader, err);
    reader->with_gaps = reader->rows;
    reader->rows = filled_rows;
    return st;
}
