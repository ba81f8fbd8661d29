/* sheet.c -- the rows of a table, which are kept: only all stamps together show the rate, and all cells the gaps.
 *
 * Then they are a source: a row is the sample that its stamp shows, and samples without a row are NaN; with
 * opts->resample, a spline leads from the rows to the samples. */
#include "io/table/sheet.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include "base/number.h"
#include "base/progress.h"
#include "io/table/clock.h"
#include "signal/gaps.h"
#include "signal/resample.h"

ss_status
ss_sheet_begin(struct sheet *t, const char *name, const ss_read_opts *opts)
{
    t->name = name;
    t->opts = opts;
    t->names = ss_header_new(0, 0);
    return t->names != NULL ? SS_OK : SS_ENOMEM;
}

void
ss_sheet_begin_rows(struct sheet *t)
{
    ss_kept_begin(&t->rows, t->name, t->opts->folder, t->n_columns + 1);
}

void
ss_sheet_free(struct sheet *t)
{
    ss_kept_free(&t->rows);
    ss_header_free(t->names);
    free(t->column);
    free(t->first);
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

/* --- adding rows --------------------------------------------------------------------------- */

ss_status
ss_sheet_new_row(struct sheet *t, unsigned long line, double **row, ss_error *err)
{
    ss_status st = ss_kept_new(&t->rows, row, err);
    if (st == SS_OK)
        (*row)[t->n_columns] = (double)line;
    return st;
}

ss_status
ss_sheet_add_row(struct sheet *t, const double *row, ss_error *err)
{
    ss_kept_add(&t->rows);
    if (t->rows.n > 1)
        return SS_OK;
    free(t->first);
    t->first = malloc((t->n_columns + 1) * sizeof *t->first);
    if (t->first == NULL)
        return ss_fail_memory(err, t->name);
    memcpy(t->first, row, (t->n_columns + 1) * sizeof *t->first);
    return SS_OK;
}

ss_status
ss_sheet_add_columns(struct sheet *t, double *const column[], size_t first, size_t n, ss_error *err)
{
    ss_status st = SS_OK;
    double *row;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        st = ss_sheet_new_row(t, (unsigned long)(first + i + 1), &row, err);
        for (size_t c = 0; st == SS_OK && c < t->n_columns; c++) {
            row[c] = column[c][i];
            if (isfinite(row[c]))
                continue;
            row[c] = NAN;
            if (t->opts->gaps == SS_GAPS_REFUSE)
                st = ss_fail(err, SS_EGAPS, "%s: row %zu, column %s: not a finite number", t->name, first + i + 1,
                             t->names->column[c].name);
        }
        if (st == SS_OK)
            st = ss_sheet_add_row(t, row, err);
    }
    return st;
}

/* --- samples ------------------------------------------------------------------------------- */

ss_status
ss_sheet_next(struct kept *rows, size_t time, const double **row, ss_error *err)
{
    ss_status st;
    do
        st = ss_kept_next(rows, row, err);
    while (*row != NULL && time != NONE && isnan((*row)[time]));
    return st;
}

double
ss_sheet_stamp(const struct time_column *c, const double *row)
{
    return c->origin + (row[c->column] - c->zero) * c->factor / c->divisor;
}

struct samples {
    ss_source base;
    struct kept rows;
    struct timing timing;
    size_t *of, n;              /* the columns of the table that are given */
    struct sample_count count;
    const double *row;          /* that is given next, as this sample; NULL: it is not read yet */
    size_t sample, given;       /* given: samples so far */
    ss_progress progress;
};

/* Give the values of a row, NaN where there is none, as number `at`. */
static void
give_row(const struct samples *s, const double *row, double *const column[], size_t at)
{
    for (size_t c = 0; c < s->n; c++)
        if (column[c] != NULL)
            column[c][at] = row != NULL ? row[s->of[c]] : NAN;
}

static ss_status
give_samples(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct samples *s = (struct samples *)base;
    const struct time_column *time = &s->timing.time;
    ss_status st = SS_OK;
    for (; *n < max; ++*n, s->given++) {
        if (s->row == NULL) {
            st = ss_sheet_next(&s->rows, time->column, &s->row, err);
            if (st != SS_OK || s->row == NULL)
                break;
            s->sample = s->timing.usual > 0 ? ss_clock_sample(&s->count, ss_sheet_stamp(time, s->row)) : s->given;
        }
        int there = s->sample == s->given;
        give_row(s, there ? s->row : NULL, column, *n);
        s->row = there ? NULL : s->row;
    }
    ss_progress_at(&s->progress, (1 + (double)s->rows.given / (double)s->rows.n) / 2);
    return st;
}

/* Each row as it is, and its time in the last column. */
static ss_status
give_rows(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct samples *s = (struct samples *)base;
    const struct time_column *time = &s->timing.time;
    const double *row;
    ss_status st = SS_OK;
    for (; *n < max && (st = ss_sheet_next(&s->rows, time->column, &row, err)) == SS_OK && row != NULL; ++*n) {
        give_row(s, row, column, *n);
        column[s->n - 1][*n] = ss_sheet_stamp(time, row);
    }
    ss_progress_at(&s->progress, (1 + (double)s->rows.given / (double)s->rows.n) / 2);
    return st;
}

static ss_status
rewind_samples(ss_source *base, ss_error *err)
{
    struct samples *s = (struct samples *)base;
    s->count = (struct sample_count){ .usual = s->timing.usual };
    s->row = NULL;
    s->given = 0;
    return ss_kept_rewind(&s->rows, err);
}

static void
free_samples(ss_source *base)
{
    struct samples *s = (struct samples *)base;
    ss_kept_free(&s->rows);
    free(s->of);
}

/* The columns of numbers without that of time, and, if stamped, that one behind them. */
static ss_status
choose_columns(struct samples *s, const struct sheet *t, int stamped, ss_error *err)
{
    size_t time = s->timing.time.column;
    ss_header *head = NULL;
    s->of = malloc((t->n_columns + 1) * sizeof *s->of);
    if (s->of == NULL)
        return ss_fail_memory(err, t->name);
    for (size_t c = 0; c < t->n_columns; c++)
        if (c != time && t->column[c].kind == COLUMN_NUMBERS)
            s->of[s->n++] = c;
    if (s->n == 0)
        return ss_fail(err, SS_EDATA, "%s: no column but time", t->name);
    if (stamped)
        s->of[s->n++] = time;
    if (ss_header_select(&head, t->names, s->of, s->n, 0) != SS_OK)
        return ss_fail_memory(err, t->name);
    ss_header_free(s->base.head);
    s->base.head = head;
    return SS_OK;
}

ss_status
ss_sheet_give(ss_source **out, struct sheet *t, ss_progress progress, ss_error *err)
{
    static const struct source_calls samples = { give_samples, rewind_samples, NULL, free_samples };
    static const struct source_calls rows = { give_rows, rewind_samples, NULL, free_samples };
    struct timing timing = { .usual = 0 };
    ss_status st = ss_sheet_find_clock(t, &timing, err);
    if (st != SS_OK)
        return st;
    int stamped = timing.longest > 0;
    struct samples *s = ss_source_new(sizeof *s, stamped ? &rows : &samples, t->name, err);
    if (s == NULL)
        return SS_ENOMEM;
    *out = &s->base;
    s->timing = timing;
    s->progress = progress;
    s->rows = t->rows;
    s->rows.name = s->base.name;
    t->rows = (struct kept){ 0 };
    st = choose_columns(s, t, stamped, err);
    if (st == SS_OK)
        st = rewind_samples(&s->base, err);
    if (st == SS_OK && stamped)
        st = ss_source_resample(out, t->names->rate, 1, timing.longest, err);
    return st == SS_OK && t->opts->gaps != SS_GAPS_REFUSE ? ss_source_fill_gaps(out, t->opts->gaps, err) : st;
}
