/* timed_rows.c -- an array whose rows have times, of another dataset or of a column of its own: they become a
 * table, whose clock is found, checked and filled as that of a table in text. */
#include "io/hdf5/groups.h"

#include <stdlib.h>
#include <string.h>
#include "base/columns.h"
#include "signal/header.h"
#include "io/table/sheet.h"

/* Add the column of times, with the name of its dataset and the unit: the s of "s since 1970-01-01 00:00". */
static ss_status
name_times(struct sheet *t, signal_rows *s, const char *time)
{
    char *unit;
    const char *slash = strrchr(time, '/');
    ss_status status = ss_h5_get_text(&s->file, s->stamps, "units", &unit);
    char *since = unit != NULL ? strstr(unit, " since ") : NULL;
    if (since != NULL)
        *since = '\0';
    if (status == SS_OK)
        status = ss_header_add_column(t->names, slash != NULL ? slash + 1 : time, unit, NULL);
    free(unit);
    return status;
}

/* Give the table its columns: times, if they are a dataset, and those of the array. */
static ss_status
name_columns(struct sheet *t, signal_rows *s)
{
    const ss_header *head = s->base.head;
    ss_status status = s->stamps > 0 ? name_times(t, s, t->opts->time) : SS_OK;
    for (size_t c = 0; status == SS_OK && c < head->n_columns; c++)
        status = ss_header_add_column(t->names, head->column[c].name, head->column[c].unit, NULL);
    t->named = 1;
    t->n_columns = t->names->n_columns;
    t->column = calloc(t->n_columns, sizeof *t->column);
    return status == SS_OK && t->column == NULL ? SS_ENOMEM : status;
}

static ss_status
fill_table(struct sheet *t, signal_rows *s)
{
    size_t own = s->stamps > 0, n;
    double **column = ss_columns_new(t->n_columns, s->piece);
    ss_status status = column != NULL ? SS_OK : SS_ENOMEM;
    for (size_t done = 0; status == SS_OK && done < s->n; done += n) {
        status = ss_source_rows(&s->base, column + own, s->piece, &n, s->file.err);
        if (status == SS_OK && own && !ss_h5_read_rows(s->stamps, s->stamps_by_columns, done, n, *column))
            status = ss_h5_fail(&s->file, SS_EIO, s->stamps, "", "cannot be read");
        if (status == SS_OK)
            status = ss_sheet_add_columns(t, column, done, n, s->file.err);
    }
    free(column);
    return status == SS_OK ? ss_kept_end(&t->rows, s->file.err) : status;
}

ss_status
ss_h5_time_rows(ss_source **out, const ss_read_opts *opts, ss_error *err)
{
    signal_rows *s = (signal_rows *)*out;
    ss_read_opts own = *opts;
    struct sheet t = { .names = NULL };
    ss_status status = ss_sheet_begin(&t, s->base.name, &own);
    s->file.err = err;
    s->gaps = 1;                                /* the table refuses them */
    if (status == SS_OK)
        QUIETLY(
            status = name_columns(&t, s);
        );
    if (status == SS_OK && s->stamps > 0)
        own.time = t.names->column[0].name;
    if (status == SS_OK) {
        ss_sheet_begin_rows(&t);
        QUIETLY(
            status = fill_table(&t, s);
        );
    }
    *out = NULL;
    if (status == SS_OK)
        status = ss_sheet_give(out, &t, (ss_progress){ NULL, NULL }, err);
    ss_sheet_free(&t);
    if (status == SS_ENOMEM)
        ss_fail_memory(err, s->base.name);
    ss_source_free(&s->base);
    return status;
}
