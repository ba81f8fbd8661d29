/* samples.c -- give the rows of a table as samples of its clock.
 *
 * A row is the sample that its stamp shows, and samples without a row are NaN; with opts->resample, a spline leads
 * from the rows to the samples. */
#include "io/table/sheet.h"

#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "base/progress.h"
#include "io/format.h"
#include "signal/gaps.h"
#include "signal/source.h"

struct samples {
    ss_source base;
    struct sheet *live;         /* the table whose rows come later, or NULL */
    struct kept own, *rows;     /* rows: of this table, or its own */
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

/* Let s->row be the next row that has a time; NULL: there is none, or, unless it may wait, none is there yet. */
static ss_status
read_row(struct samples *s, int may_wait, ss_error *err)
{
    size_t time = s->timing.time.column;
    do {
        if (s->live != NULL && s->base.row == s->rows->n) {
            ss_status st = may_wait ? s->live->later->next(s->live, err) : SS_OK;
            if (st != SS_OK || s->base.row == s->rows->n)
                return st;
        }
        s->row = ss_kept_row(s->rows, s->base.row);
        s->base.row += s->row != NULL;
    } while (s->row != NULL && time != NONE && isnan(s->row[time]));
    return ss_kept_check(s->rows, err);
}

static ss_status
give_samples(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct samples *s = (struct samples *)base;
    const struct time_column *time = &s->timing.time;
    ss_progress_at(&s->progress, (1 + (double)base->row / (double)s->rows->n) / 2);
    for (; *n < max; ++*n, s->given++) {
        if (s->row == NULL) {
            ss_status st = read_row(s, *n == 0, err);
            if (st != SS_OK || s->row == NULL)
                return st;
            /* a row that came after its clock was found must be on it, but for what a stamp may be off */
            double late = s->live == NULL || time->column == NONE ? 0
                : (ss_sheet_stamp(time, s->row) - base->head->start) * base->head->rate - (double)s->given;
            if (!(fabs(late) <= CLOCK_TOLERANCE))
                return ss_clock_refuse(base->name, (unsigned long)s->row[s->rows->width - 1], late, err);
            s->sample = s->timing.usual > 0 ? ss_clock_sample(&s->count, ss_sheet_stamp(time, s->row)) : s->given;
        }
        int there = s->sample == s->given;
        give_row(s, there ? s->row : NULL, column, *n);
        s->row = there ? NULL : s->row;
    }
    return SS_OK;
}

/* Each row as it is, and its time in the last column. */
static ss_status
give_rows(ss_source *base, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct samples *s = (struct samples *)base;
    ss_status st = SS_OK;
    ss_progress_at(&s->progress, (1 + (double)base->row / (double)s->rows->n) / 2);
    for (; *n < max && (st = read_row(s, 1, err)) == SS_OK && s->row != NULL; ++*n) {
        give_row(s, s->row, column, *n);
        column[s->n - 1][*n] = ss_sheet_stamp(&s->timing.time, s->row);
    }
    return st;
}

static void
rewind_samples(ss_source *base)
{
    struct samples *s = (struct samples *)base;
    s->count = (struct sample_count){ .usual = s->timing.usual };
    s->row = NULL;
    s->given = 0;
}

static int
rows_left(const ss_source *base)
{
    return base->row < ((const struct samples *)base)->rows->n;
}

static void
free_samples(ss_source *base)
{
    struct samples *s = (struct samples *)base;
    if (s->live != NULL)
        s->live->later->free(s->live);
    ss_kept_free(&s->own);
    free(s->of);
}

static const struct source_calls samples_calls = { give_samples, rewind_samples, rows_left, free_samples };

/* The columns are those of numbers without that of time, and, if stamped, that one behind them. */
ss_status
ss_sheet_give(ss_source **out, struct sheet *t, ss_progress progress, ss_error *err)
{
    static const struct source_calls rows = { give_rows, rewind_samples, rows_left, free_samples };
    struct timing timing = { .usual = 0 };
    ss_header *head = NULL;
    ss_status st = ss_sheet_find_clock(t, &timing, err);
    if (st != SS_OK)
        return st;
    int resampled = timing.longest > 0, stamped = resampled || (t->opts->stamps && timing.time.column != NONE);
    struct samples *s = ss_source_new(sizeof *s, stamped ? &rows : &samples_calls, t->name, err);
    if (s == NULL)
        return SS_ENOMEM;
    *out = &s->base;
    s->timing = timing;
    s->progress = progress;
    s->rows = &t->rows;
    s->live = t->later != NULL ? t : NULL;
    s->base.rewinds = s->live == NULL;
    if (s->live == NULL) {
        s->own = t->rows;
        s->own.name = s->base.name;
        s->rows = &s->own;
        t->rows = (struct kept){ 0 };
    }
    rewind_samples(&s->base);
    if ((s->of = malloc((t->n_columns + 1) * sizeof *s->of)) == NULL)
        return ss_fail_memory(err, t->name);
    for (size_t c = 0; c < t->n_columns; c++)
        if (c != timing.time.column && t->column[c].kind == COLUMN_NUMBERS)
            s->of[s->n++] = c;
    if (s->n == 0)
        return ss_fail(err, SS_EDATA, "%s: no column but time", t->name);
    if (ss_header_select(&head, t->names, s->of, s->n, 0, NULL) != SS_OK)
        return ss_fail_memory(err, t->name);
    ss_header_free(s->base.head);
    s->base.head = head;
    s->base.stamped = stamped;
    s->of[s->n] = timing.time.column;
    s->n += (size_t)stamped;
    st = stamped ? ss_header_add_column(head, "t", "s", err) : SS_OK;
    if (st == SS_OK && resampled)
        st = ss_source_resample(out, t->names->rate, 1, timing.longest, err);
    return st == SS_OK && t->opts->gaps != SS_GAPS_REFUSE ? ss_source_fill_gaps(out, t->opts->gaps, err) : st;
}

void
ss_sheet_free(struct sheet *t)
{
    ss_kept_free(&t->rows);
    ss_header_free(t->names);
    free(t->column);
}

/* Keep all rows of a source, each with its number behind it, as a row of a table has.  SS_EGAPS: a value is no
 * number, and gaps are refused. */
static ss_status
keep_rows(struct kept *rows, ss_source *from, const char *folder, ss_gaps gaps, ss_error *err)
{
    size_t columns = from->head->n_columns, piece = ss_source_piece(from), n = 1;
    double **column = ss_columns_new(columns, piece), *row = malloc((columns + 1) * sizeof *row);
    ss_status st = column != NULL && row != NULL ? SS_OK : ss_fail_memory(err, from->name);
    ss_kept_begin(rows, from->name, folder, columns + 1);
    while (st == SS_OK && n > 0) {
        st = ss_source_rows(from, column, piece, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            row[columns] = (double)(rows->n + 1);
            for (size_t c = 0; st == SS_OK && c < columns; c++) {
                row[c] = isfinite(column[c][i]) ? column[c][i] : NAN;
                if (isnan(row[c]) && gaps == SS_GAPS_REFUSE)
                    st = ss_fail(err, SS_EGAPS, "%s: row %.0f, column %s: not a finite number", from->name,
                                 row[columns], from->head->column[c].name);
            }
            st = st == SS_OK ? ss_kept_add(rows, row, err) : st;
        }
    }
    free(column);
    free(row);
    return st == SS_OK ? ss_kept_end(rows, err) : st;
}

ss_status
ss_sheet_of_source(ss_source **s, const ss_read_opts *opts, int named, ss_progress progress, ss_error *err)
{
    ss_source *from = *s;
    struct sheet t = { .name = from->name, .opts = opts, .named = named, .n_columns = from->head->n_columns };
    *s = NULL;
    t.column = calloc(t.n_columns, sizeof *t.column);
    ss_status st = t.column == NULL ? SS_ENOMEM
        : ss_header_select(&t.names, from->head, NULL, t.n_columns, 0, NULL);
    if (st == SS_OK)
        st = keep_rows(&t.rows, from, opts->folder, opts->gaps, err);
    if (st == SS_OK)
        st = ss_sheet_give(s, &t, progress, err);
    if (st == SS_ENOMEM)
        ss_fail_memory(err, from->name);
    ss_sheet_free(&t);
    ss_source_free(from);
    return st;
}

/* Of a source that cannot go back. */
ss_status
ss_source_keep(ss_source **out, const char *folder, ss_error *err)
{
    ss_source *from = *out;
    struct samples *s = from->rewinds ? NULL : ss_source_wrap(out, sizeof *s, &samples_calls, err);
    if (s == NULL)
        return from->rewinds ? SS_OK : SS_ENOMEM;
    s->base.rewinds = 1;
    s->rows = &s->own;
    s->timing.time.column = NONE;
    s->of = malloc((from->head->n_columns + 1) * sizeof *s->of);
    for (; s->of != NULL && s->n < from->head->n_columns; s->n++)
        s->of[s->n] = s->n;
    return s->of != NULL ? keep_rows(&s->own, from, folder, SS_GAPS_SPLIT, err) : ss_fail_memory(err, from->name);
}
