/* adjust.c -- apply the factors, the units and the span of time that a caller gives, to any format, and give rows
 * their times. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/format.h"

struct adjusted {
    ss_source base;
    double *factor;             /* of each column; NULL: none is calibrated */
    ss_span span;               /* the rows of these times are given; from >= to: all */
    uint64_t first, end;        /* of a clock, the numbers of these rows; end is not given */
};

/* No row lies in the span. */
static ss_status
refuse_span(const struct adjusted *a, ss_error *err)
{
    const char *name = a->base.name;
    if (a->span.to >= DBL_MAX)
        return ss_fail(err, SS_EDATA, "%s: no samples from %.9g s on", name, a->span.from);
    if (a->span.from <= -DBL_MAX)
        return ss_fail(err, SS_EDATA, "%s: no samples before %.9g s", name, a->span.to);
    return ss_fail(err, SS_EDATA, "%s: no samples from %.9g to %.9g s", name, a->span.from, a->span.to);
}

/* Give rows of the span; if they are stamped, each with its time, which the inner source has or its clock
 * shows. */
static ss_status
give_adjusted(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct adjusted *a = (struct adjusted *)s;
    const size_t columns = s->head->n_columns;
    const int cut = a->span.from < a->span.to;
    double *t = s->stamped ? column[columns - 1] : NULL;
    if (s->stamped && t == NULL)
        return ss_fail(err, SS_EINVAL, "%s: the column of stamps must be read", s->name);
    for (size_t rows = 1; *n == 0 && rows > 0 && s->row < a->end;) {
        uint64_t left = a->end - s->row;
        ss_status st = ss_source_rows(s->inner, column, left < max ? (size_t)left : max, &rows, err);
        if (st != SS_OK)
            return st;
        for (size_t i = 0; i < rows; i++, s->row++) {
            if (s->stamped && !s->inner->stamped)
                t[i] = s->head->start + (double)s->row / s->head->rate;
            if (s->row < a->first || (s->stamped && cut && !(t[i] >= a->span.from && t[i] < a->span.to)))
                continue;
            for (size_t c = 0; c < columns; c++)
                if (column[c] != NULL)
                    column[c][*n] = column[c][i];
            ++*n;
        }
    }
    for (size_t c = 0; a->factor != NULL && c < columns; c++)
        for (size_t i = 0; column[c] != NULL && i < *n; i++)
            if (!isfinite(column[c][i] *= a->factor[c]))
                return ss_fail(err, SS_ERANGE, "%s: a value times %g is beyond double precision", s->name,
                               a->factor[c]);
    return cut && !s->stamped && s->row <= a->first && max > 0 ? refuse_span(a, err) : SS_OK;
}

static void
free_adjusted(ss_source *s)
{
    free(((struct adjusted *)s)->factor);
}

/* Apply the factors before the units: a column with a factor loses its unit, unless it is given another.  Note
 * what was done: "force x 4.45 N, accel g". */
static ss_status
calibrate(struct adjusted *a, const ss_read_opts *opts, char *is_new, ss_error *err)
{
    ss_header *head = a->base.head;
    char *text = NULL, number[SS_NUMBER_MAX];
    size_t columns = head->n_columns, size;
    for (size_t i = 0; i < 2 * opts->n_calibrations; i++) {
        const ss_calibration *c = &opts->calibration[i % opts->n_calibrations];
        int units = i >= opts->n_calibrations;
        int column = c->column != NULL ? ss_header_column(head, c->column) : columns == 1 ? 0 : -1;
        if (column < 0)
            return c->column != NULL
                ? ss_fail(err, SS_EINVAL, "%s: no column '%.40s' to calibrate", a->base.name, c->column)
                : ss_fail(err, SS_EINVAL, "%s: has %zu columns: the one to calibrate must be named", a->base.name,
                          columns);
        is_new[column] = 1;
        a->factor[column] *= !units && c->scale != 0 ? c->scale : 1;
        if (units ? c->unit == NULL : c->scale == 0)
            continue;
        char *unit = ss_clean_unit(units ? c->unit : "");
        if (unit == NULL)
            return SS_ENOMEM;
        free(head->column[column].unit);
        head->column[column].unit = unit;
    }
    FILE *out = open_memstream(&text, &size);
    if (out == NULL)
        return SS_ENOMEM;
    const char *before = ss_header_find_note(head, "calibration");
    size_t n = before != NULL;
    fputs(n > 0 ? before : "", out);
    for (size_t c = 0; c < columns; c++) {
        ss_number_format(number, a->factor[c]);
        if (is_new[c])
            fprintf(out, "%s%s x %s%s%s", n++ > 0 ? ", " : "", head->column[c].name, number,
                    *head->column[c].unit != '\0' ? " " : "", head->column[c].unit);
    }
    ss_status st = fclose(out) == 0 ? ss_header_note(head, "calibration", text, NULL) : SS_ENOMEM;
    free(text);
    return st;
}

ss_status
ss_source_adjust(ss_source **s, const ss_read_opts *opts, ss_error *err)
{
    static const struct source_calls calls = { .next = give_adjusted, .free = free_adjusted };
    const int cut = opts->from < opts->to;
    ss_status st = ss_refuse_range((*s)->name, (*s)->head->rate, (*s)->head->start, err);
    if (st != SS_OK || !(cut || opts->stamps || opts->n_calibrations > 0))
        return st;
    struct adjusted *a = ss_source_wrap(s, sizeof *a, &calls, err);
    if (a == NULL)
        return SS_ENOMEM;
    ss_header *head = a->base.head;
    a->span = (ss_span){ opts->from, opts->to };
    a->end = UINT64_MAX;
    a->base.stamped = opts->stamps;
    if (opts->stamps) {
        a->base.length = cut ? UINT64_MAX : a->base.length;
        st = a->base.inner->stamped ? SS_OK : ss_header_add_column(head, "t", "s", err);
    } else if (cut) {
        a->first = ss_header_row(head, opts->from);
        a->end = ss_header_row(head, opts->to);
        if (a->first > 0)
            head->start += (double)a->first / head->rate;
        uint64_t length = a->base.length, end = length < a->end ? length : a->end;
        a->base.length = length == UINT64_MAX ? length : end - a->first;
        st = length == UINT64_MAX || a->first < end ? SS_OK : refuse_span(a, err);
    }
    if (st != SS_OK || opts->n_calibrations == 0)
        return st;
    char *is_new = calloc(head->n_columns, 1);
    a->factor = malloc(head->n_columns * sizeof *a->factor);
    for (size_t c = 0; a->factor != NULL && c < head->n_columns; c++)
        a->factor[c] = 1;
    st = is_new != NULL && a->factor != NULL ? calibrate(a, opts, is_new, err) : SS_ENOMEM;
    free(is_new);
    return st == SS_ENOMEM ? ss_fail_memory(err, a->base.name) : st;
}
