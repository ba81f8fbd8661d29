/* sheet.c -- the columns and rows of a table, which are kept: only all stamps together show the rate, and all
 * cells the gaps. */
#include "io/table/sheet.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
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

ss_status
ss_sheet_add_columns(struct sheet *t, double *const column[], size_t first, size_t n, ss_error *err)
{
    double *row = malloc((t->n_columns + 1) * sizeof *row);
    ss_status st = row != NULL ? SS_OK : ss_fail_memory(err, t->name);
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        for (size_t c = 0; st == SS_OK && c < t->n_columns; c++) {
            row[c] = isfinite(column[c][i]) ? column[c][i] : NAN;
            if (isnan(row[c]) && t->opts->gaps == SS_GAPS_REFUSE)
                st = ss_fail(err, SS_EGAPS, "%s: row %zu, column %s: not a finite number", t->name, first + i + 1,
                             t->names->column[c].name);
        }
        row[t->n_columns] = (double)(first + i + 1);
        if (st == SS_OK)
            st = ss_kept_add(&t->rows, row, err);
    }
    free(row);
    return st;
}
