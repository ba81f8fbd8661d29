/* sheet.c -- the columns and rows of a table, which are kept: only all stamps together show the rate, and all
 * cells the gaps. */
#include "io/table/sheet.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include "base/columns.h"
#include "base/number.h"

ss_status
ss_sheet_begin(struct sheet *t, const char *name, const ss_read_opts *opts)
{
    t->name = name;
    t->opts = opts;
    ss_header_new(&t->names, 0, 0, NULL);
    return t->names != NULL ? SS_OK : SS_ENOMEM;
}

void
ss_sheet_free(struct sheet *t)
{
    ss_kept_free(&t->rows);
    ss_header_free(t->names);
    free(t->column);
}

void
ss_sheet_warn(const struct sheet *t, ss_status about, const char *format, ...)
{
    ss_error text;
    va_list args;
    if (t->opts->warn == NULL)
        return;
    va_start(args, format);
    ss_print_text(text.text, sizeof text.text, format, args);
    va_end(args);
    t->opts->warn(about, text.text, t->opts->user);
}

/* --- of rows that are no text --------------------------------------------------------------- */

/* Add all rows of a source, and check that they are numbers. */
static ss_status
add_rows(struct sheet *t, ss_source *from, ss_error *err)
{
    size_t piece = ss_source_piece(from), n = 1;
    double **column = ss_columns_new(t->n_columns, piece), *row = malloc((t->n_columns + 1) * sizeof *row);
    ss_status st = column != NULL && row != NULL ? SS_OK : SS_ENOMEM;
    while (st == SS_OK && n > 0) {
        st = ss_source_rows(from, column, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            size_t number = (size_t)t->rows.n + 1;
            row[t->n_columns] = (double)number;
            for (size_t c = 0; st == SS_OK && c < t->n_columns; c++) {
                row[c] = isfinite(column[c][i]) ? column[c][i] : NAN;
                if (isnan(row[c]) && t->opts->gaps == SS_GAPS_REFUSE)
                    st = ss_fail(err, SS_EGAPS, "%s: row %zu, column %s: not a finite number", t->name, number,
                                 t->names->column[c].name);
            }
            st = st == SS_OK ? ss_kept_add(&t->rows, row, err) : st;
        }
    }
    free(column);
    free(row);
    return st == SS_OK ? ss_kept_end(&t->rows, err) : st;
}

ss_status
ss_sheet_of_source(ss_source **s, const ss_read_opts *opts, int named, ss_progress progress, ss_error *err)
{
    ss_source *from = *s;
    struct sheet t = { .name = from->name, .opts = opts, .named = named, .n_columns = from->head->n_columns };
    *s = NULL;
    t.column = calloc(t.n_columns, sizeof *t.column);
    ss_status st = t.column != NULL ? ss_header_copy(&t.names, from->head, NULL) : SS_ENOMEM;
    ss_kept_begin(&t.rows, t.name, opts->folder, t.n_columns + 1);
    if (st == SS_OK)
        st = add_rows(&t, from, err);
    if (st == SS_OK)
        st = ss_sheet_give(s, &t, progress, err);
    if (st == SS_ENOMEM)
        ss_fail_memory(err, from->name);
    ss_sheet_free(&t);
    ss_source_free(from);
    return st;
}
