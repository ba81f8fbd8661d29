/* delimited_samples.c -- give the rows of a text table as samples of its clock.
 *
 * A row is the sample that its stamp shows, and samples without a row are NaN; with opts->resample, a
 * spline leads from the rows to the samples. */
#include <math.h>
#include "io/table/clock.h"
#include "io/table/delimited.h"

double
ss_delimited_stamp(const struct time_column *c, const double *row)
{
    return c->origin + (row[c->column] - c->zero) * c->factor / c->divisor;
}

static void
keep_values(const struct table *t, const double *row, double *const column[], size_t at)
{
    for (size_t c = 0; c < t->n_kept; c++)
        if (column[c] != NULL)
            column[c][at] = row != NULL ? row[t->kept[c]] : NAN;
}

static ss_status
next_rows(void *source, double *stamp, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct table *t = source;
    const double *row;
    ss_status st = SS_OK;
    for (*n = 0; *n < max && (st = ss_delimited_next(t, &row, err)) == SS_OK && row != NULL; ++*n) {
        stamp[*n] = ss_delimited_stamp(&t->time, row);
        keep_values(t, row, column, *n);
    }
    return st;
}

ss_status
ss_delimited_begin_samples(struct table *t, ss_error *err)
{
    ss_resampler_free(t->resampler);
    t->resampler = NULL;
    t->count = (struct sample_count){ .usual = t->count.usual };
    t->row = NULL;
    t->given = 0;
    ss_status st = ss_delimited_rewind(t, err);
    if (st == SS_OK && t->longest > 0)
        st = ss_resampler_new(&t->resampler, t->in->name, t->n_kept, t->names->rate, t->longest, next_rows, t, err);
    return st;
}

ss_status
ss_delimited_samples(struct table *t, double *const column[], size_t max, size_t *n, ss_error *err)
{
    if (t->resampler != NULL)
        return ss_resampler_rows(t->resampler, column, max, n, err);
    for (*n = 0; *n < max; ++*n, t->given++) {
        if (t->row == NULL) {
            ss_status st = ss_delimited_next(t, &t->row, err);
            if (st != SS_OK || t->row == NULL)
                return st;
            t->sample = t->time.column == NONE ? t->given : ss_clock_sample(&t->count, ss_delimited_stamp(&t->time, t->row));
        }
        int there = t->sample == t->given;
        keep_values(t, there ? t->row : NULL, column, *n);
        t->row = there ? NULL : t->row;
    }
    return SS_OK;
}
