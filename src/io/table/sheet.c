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
