/* adjust.c -- apply the factors, the units and the span of time that a caller gives, to any format. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/reader.h"

/* --- factors and units -------------------------------------------------------------------- */

/* The index of the column that is to be calibrated; -1, with the reason in err, if this is not clear. */
static int
find_column(const ss_header *head, const ss_calibration *c, const char *name, ss_error *err)
{
    int found = c->column != NULL ? ss_header_column(head, c->column) : head->n_columns == 1 ? 0 : -1;
    if (found >= 0)
        return found;
    if (c->column != NULL)
        ss_fail(err, SS_EINVAL, "%s: no column '%.40s' to calibrate", name, c->column);
    else
        ss_fail(err, SS_EINVAL, "%s: has %zu columns: the one to calibrate must be named", name,
                head->n_columns);
    return -1;
}

/* Note what was done to the columns: "force x 4.45 N, accel g". */
static ss_status
note_calibration(ss_header *head, const double *factor, const char *is_new)
{
    char *text = NULL, number[SS_NUMBER_MAX];
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (out == NULL)
        return SS_ENOMEM;
    const char *before = ss_header_find_note(head, "calibration");
    fputs(before != NULL ? before : "", out);
    for (size_t c = 0, n = before != NULL; c < head->n_columns; c++) {
        if (!is_new[c])
            continue;
        ss_number_format(number, factor[c]);
        fprintf(out, "%s%s x %s%s%s", n++ > 0 ? ", " : "", head->column[c].name, number,
                *head->column[c].unit != '\0' ? " " : "", head->column[c].unit);
    }
    ss_status st = fclose(out) == 0 ? ss_header_note(head, "calibration", text, NULL) : SS_ENOMEM;
    free(text);
    return st;
}

/* Apply the factors before the units: a column with a factor loses its unit, unless it is given another. */
static ss_status
apply(ss_header *head, const ss_read_opts *opts, const char *name, double *factor, char *is_new,
      ss_error *err)
{
    for (int units = 0; units < 2; units++)
        for (size_t i = 0; i < opts->n_calibrations; i++) {
            const ss_calibration *c = &opts->calibration[i];
            int column = find_column(head, c, name, err);
            if (column < 0)
                return SS_EINVAL;
            is_new[column] = 1;
            if (!units && c->scale != 0)
                factor[column] *= c->scale;
            if (units ? c->unit == NULL : c->scale == 0)
                continue;
            char *unit = ss_clean_unit(units ? c->unit : "");
            if (unit == NULL)
                return ss_fail_memory(err, name);
            free(head->column[column].unit);
            head->column[column].unit = unit;
        }
    return SS_OK;
}

struct calibrated {
    ss_source base;
    double *factor;             /* of each column */
};

static ss_status
give_calibrated(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    const double *factor = ((struct calibrated *)s)->factor;
    ss_status st = ss_source_rows(s->inner, column, max, n, err);
    for (size_t c = 0; c < s->head->n_columns; c++)
        for (size_t i = 0; column[c] != NULL && i < *n; i++)
            if (!isfinite(column[c][i] *= factor[c]))
                return ss_fail(err, SS_ERANGE, "%s: a value times %g is beyond double precision", s->name,
                               factor[c]);
    return st;
}

static void
free_factors(ss_source *s)
{
    free(((struct calibrated *)s)->factor);
}

static ss_status
calibrate(ss_source **s, const ss_read_opts *opts, ss_error *err)
{
    static const struct source_calls calls = { .next = give_calibrated, .free = free_factors };
    struct calibrated *to = ss_source_wrap(s, sizeof *to, &calls, err);
    if (to == NULL)
        return SS_ENOMEM;
    size_t columns = to->base.head->n_columns;
    char *is_new = calloc(columns, 1);
    to->factor = malloc(columns * sizeof *to->factor);
    int made = is_new != NULL && to->factor != NULL;
    for (size_t c = 0; made && c < columns; c++)
        to->factor[c] = 1;
    ss_status st = made ? apply(to->base.head, opts, to->base.name, to->factor, is_new, err) : SS_ENOMEM;
    if (st == SS_OK)
        st = note_calibration(to->base.head, to->factor, is_new);
    free(is_new);
    return st == SS_ENOMEM ? ss_fail_memory(err, to->base.name) : st;
}

/* --- a span of time ------------------------------------------------------------------------ */

struct span {
    ss_source base;
    double from, to;            /* [s] as asked for */
    uint64_t first, end;        /* the rows to be given; end is not */
    uint64_t passed;            /* rows of the inner source so far */
};

/* No row lies in the span. */
static ss_status
refuse_span(const struct span *s, ss_error *err)
{
    const char *name = s->base.name;
    if (s->to >= DBL_MAX)
        return ss_fail(err, SS_EDATA, "%s: no samples from %.9g s on", name, s->from);
    if (s->from <= -DBL_MAX)
        return ss_fail(err, SS_EDATA, "%s: no samples before %.9g s", name, s->to);
    return ss_fail(err, SS_EDATA, "%s: no samples from %.9g to %.9g s", name, s->from, s->to);
}

static ss_status
give_span(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct span *span = (struct span *)s;
    ss_status st;
    do {                                        /* pass over the rows before the first one wanted */
        uint64_t left = (span->passed < span->first ? span->first : span->end) - span->passed;
        *n = 0;
        st = left > 0 ? ss_source_rows(s->inner, column, left < max ? (size_t)left : max, n, err) : SS_OK;
        span->passed += *n;
    } while (st == SS_OK && *n > 0 && span->passed <= span->first);
    int none = span->passed <= span->first;
    *n = none ? 0 : *n;
    return st == SS_OK && none && max > 0 ? refuse_span(span, err) : st;
}

static ss_status
rewind_span(ss_source *s, ss_error *err)
{
    ((struct span *)s)->passed = 0;
    return ss_source_rewind(s->inner, err);
}

static ss_status
cut(ss_source **s, const ss_read_opts *opts, ss_error *err)
{
    static const struct source_calls calls = { .next = give_span, .rewind = rewind_span };
    struct span *span = ss_source_wrap(s, sizeof *span, &calls, err);
    if (span == NULL)
        return SS_ENOMEM;
    ss_header *head = span->base.head;
    span->from = opts->from;
    span->to = opts->to;
    span->first = ss_header_row(head, opts->from);
    span->end = ss_header_row(head, opts->to);
    if (span->first > 0)
        head->start += (double)span->first / head->rate;
    if (span->base.length == UINT64_MAX)
        return SS_OK;
    uint64_t end = span->base.length < span->end ? span->base.length : span->end;
    span->base.length = end - span->first;
    return span->first < end ? SS_OK : refuse_span(span, err);
}

/* --- stamps -------------------------------------------------------------------------------- */

struct stamped {
    ss_source base;
    ss_span span;               /* the rows to be given; from >= to: all */
    uint64_t row;               /* of the inner source, that is read next */
};

/* Each row with its time, which the inner source has or its clock shows. */
static ss_status
give_stamped(ss_source *s, double *const column[], size_t max, size_t *n, ss_error *err)
{
    struct stamped *to = (struct stamped *)s;
    const size_t columns = s->head->n_columns;
    double *t = column[columns - 1];
    size_t rows = 1;
    if (t == NULL)
        return ss_fail(err, SS_EINVAL, "%s: the column of stamps must be read", s->name);
    for (*n = 0; *n == 0 && rows > 0;) {
        ss_status st = ss_source_rows(s->inner, column, max, &rows, err);
        if (st != SS_OK)
            return st;
        for (size_t i = 0; i < rows; i++, to->row++) {
            if (!s->inner->stamped)
                t[i] = s->head->start + (double)to->row / s->head->rate;
            if (to->span.from < to->span.to && !(t[i] >= to->span.from && t[i] < to->span.to))
                continue;
            for (size_t c = 0; c < columns; c++)
                if (column[c] != NULL)
                    column[c][*n] = column[c][i];
            ++*n;
        }
    }
    return SS_OK;
}

static ss_status
rewind_stamped(ss_source *s, ss_error *err)
{
    ((struct stamped *)s)->row = 0;
    return ss_source_rewind(s->inner, err);
}

static ss_status
stamp(ss_source **s, const ss_read_opts *opts, ss_error *err)
{
    static const struct source_calls calls = { .next = give_stamped, .rewind = rewind_stamped };
    struct stamped *to = ss_source_wrap(s, sizeof *to, &calls, err);
    if (to == NULL)
        return SS_ENOMEM;
    to->span = (ss_span){ opts->from, opts->to };
    to->base.length = opts->from < opts->to ? UINT64_MAX : to->base.length;
    to->base.stamped = 1;
    return to->base.inner->stamped ? SS_OK : ss_header_add_column(to->base.head, "t", "s", err);
}

ss_status
ss_source_adjust(ss_source **s, const ss_read_opts *opts, ss_error *err)
{
    ss_status st = ss_refuse_range((*s)->name, (*s)->head->rate, (*s)->head->start, err);
    if (st == SS_OK && opts->stamps)
        st = stamp(s, opts, err);
    else if (st == SS_OK && opts->from < opts->to)
        st = cut(s, opts, err);
    return st == SS_OK && opts->n_calibrations > 0 ? calibrate(s, opts, err) : st;
}
