/* kept_reader.c -- a reader of what another gives, which can go back to its first row. */
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "base/error.h"
#include "signal/gaps.h"
#include "io/kept.h"
#include "io/reader.h"

static ss_status
give_kept(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct kept *kept = reader->source;
    const double *row;
    ss_status st = SS_OK;
    for (*n = 0; *n < max && (st = ss_kept_next(kept, &row, err)) == SS_OK && row != NULL; ++*n)
        for (size_t c = 0; c < kept->width; c++)
            if (column[c] != NULL)
                column[c][*n] = row[c];
    return st;
}

static ss_status
rewind_kept(ss_reader *reader, ss_error *err)
{
    return ss_kept_rewind(reader->source, err);
}

static void
close_kept(ss_reader *reader)
{
    ss_kept_free(reader->source);
    free(reader->source);
}

static int
never_waits(const ss_reader *reader)
{
    (void)reader;
    return 0;
}

static ss_status
keep_rows(struct kept *kept, ss_reader *from, ss_error *err)
{
    size_t columns = from->head->n_columns, piece = ss_reader_piece(from), n = 1;
    double **column = ss_columns_new(columns, piece), *row;
    ss_status st = column != NULL ? SS_OK : ss_fail_memory(err, from->in.name);
    while (st == SS_OK && n > 0) {
        st = ss_reader_rows(from, column, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++)
            if ((st = ss_kept_new(kept, &row, err)) == SS_OK) {
                for (size_t c = 0; c < columns; c++)
                    row[c] = column[c][i];
                ss_kept_add(kept);
            }
    }
    free(column);
    return st == SS_OK ? ss_kept_end(kept, err) : st;
}

ss_status
ss_reader_keep(ss_reader **reader, const char *folder, ss_error *err)
{
    if (reader == NULL || *reader == NULL)
        return SS_FAIL_NULL(err);
    if ((*reader)->rewind != NULL)
        return SS_OK;
    ss_reader *r = ss_reader_like(*reader);
    struct kept *kept = calloc(1, sizeof *kept);
    if (r == NULL || kept == NULL) {
        ss_reader_free(r);
        free(kept);
        return ss_fail_memory(err, (*reader)->in.name);
    }
    r->source = kept;
    r->close = close_kept;
    ss_kept_begin(kept, r->in.name, folder, r->head->n_columns);
    ss_status st = keep_rows(kept, *reader, err);
    if (st == SS_OK)
        st = ss_kept_rewind(kept, err);
    if (st != SS_OK) {
        ss_reader_free(r);
        return st;
    }
    r->rows = give_kept;
    r->rewind = rewind_kept;
    r->waits = never_waits;
    ss_reader_free(*reader);
    *reader = r;
    return SS_OK;
}

ss_status
ss_reader_rewind(ss_reader *reader, ss_error *err)
{
    if (reader == NULL)
        return SS_FAIL_NULL(err);
    if (reader->rewind == NULL)
        return ss_fail(err, SS_EINVAL, "%s: its rows are not kept to be read again", reader->in.name);
    reader->passed = 0;
    if (reader->gaps != NULL)
        ss_gaps_rewind(reader->gaps);
    return reader->rewind(reader, err);
}
