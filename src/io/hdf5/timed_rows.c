/* timed_rows.c -- an array whose rows have times, of another dataset or of a column of its own: they become a table,
 * whose clock is found, checked and filled as that of a table in text. */
#include "io/hdf5/groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "signal/header.h"
#include "io/table/delimited.h"

/* Add the column of times, with the name of its dataset and the unit: the s of "s since 1970-01-01 00:00". */
static ss_status
name_times(struct table *t, signal_rows *s, const char *time)
{
    char *unit;
    const char *slash = strrchr(time, '/');
    ss_status status = ss_h5_get_text(&s->file, s->stamps, "units", &unit);
    char *since = unit != NULL ? strstr(unit, " since ") : NULL;
    if (since != NULL)
        *since = '\0';
    if (status == SS_OK)
        status = ss_header_add_column(t->names, slash != NULL ? slash + 1 : time, unit);
    free(unit);
    return status;
}

/* Give the table its columns: times, if they are a dataset, and those of the array. */
static ss_status
name_columns(struct table *t, const ss_header *head, signal_rows *s, const char *time)
{
    ss_status status = s->stamps > 0 ? name_times(t, s, time) : SS_OK;
    for (size_t c = 0; status == SS_OK && c < head->n_columns; c++)
        status = ss_header_add_column(t->names, head->column[c].name, head->column[c].unit);
    t->named = 1;
    t->n_columns = t->names->n_columns;
    t->column = calloc(t->n_columns, sizeof *t->column);
    return status == SS_OK && t->column == NULL ? SS_ENOMEM : status;
}

/* Add n rows of the array, of which `done` were added before. */
static ss_status
add_rows(struct table *t, const double *times, double *const column[], size_t done, size_t n, ss_error *err)
{
    double *row;
    size_t own = times != NULL, columns = t->n_columns - own;
    ss_status status = SS_OK;
    for (size_t i = 0; status == SS_OK && i < n; i++) {
        status = ss_delimited_begin_numbers(t, done + i, &row, err);
        if (status != SS_OK)
            break;
        if (own)
            row[0] = times[i];
        for (size_t c = 0; c < columns; c++)
            row[own + c] = column[c][i];
        status = ss_delimited_add_numbers(t, done + i, row, err);
    }
    return status;
}

static ss_status
fill_table(ss_reader *reader, signal_rows *s)
{
    size_t columns = reader->head->n_columns, n;
    double **stamp = ss_columns_new(columns + 1, s->piece), **column = stamp + 1;
    ss_status status = stamp != NULL ? SS_OK : SS_ENOMEM;
    for (size_t done = 0; status == SS_OK && done < s->n; done += n) {
        status = reader->rows(reader, column, s->piece, &n, s->file.err);
        if (status == SS_OK && s->stamps > 0 && !ss_h5_read_rows(s->stamps, s->stamps_by_columns, done, n, *stamp))
            status = ss_h5_fail(&s->file, SS_EIO, s->stamps, "", "cannot be read");
        if (status == SS_OK)
            status = add_rows(reader->table, s->stamps > 0 ? *stamp : NULL, column, done, n, s->file.err);
    }
    free(stamp);
    return status;
}

ss_status
ss_h5_time_rows(ss_reader *reader, signal_rows *s, const ss_read_opts *opts)
{
    ss_read_opts own = *opts;
    struct table *t = ss_delimited_new(reader, &own);
    ss_status status = t != NULL ? name_columns(t, reader->head, s, opts->time) : SS_ENOMEM;
    if (status != SS_OK)
        return status;
    if (s->stamps > 0)
        own.time = t->names->column[0].name;
    s->gaps = 1;                                /* the table refuses them */
    ss_delimited_begin_rows(t);
    status = fill_table(reader, s);
    reader->length = UINT64_MAX;                /* not all of it may be on the clock */
    return status == SS_OK ? ss_delimited_finish(t, reader, s->file.err) : status;
}
