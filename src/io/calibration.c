/* calibration.c -- apply the factors, the units and the span of time that a caller gives, to any format. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/calibration.h"

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

static ss_status
set_unit(ss_header *head, int column, const char *unit)
{
    char *copy = ss_clean_unit(unit);
    if (copy == NULL)
        return SS_ENOMEM;
    free(head->column[column].unit);
    head->column[column].unit = copy;
    return SS_OK;
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
    ss_status st = fclose(out) == 0 ? ss_header_note(head, "calibration", text) : SS_ENOMEM;
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
            if ((units ? c->unit != NULL : c->scale != 0)
                && set_unit(head, column, units ? c->unit : "") != SS_OK)
                return ss_fail_memory(err, name);
        }
    return SS_OK;
}

ss_status
ss_calibrate_header(ss_header *head, const ss_read_opts *opts, const char *name, double **factor,
                    ss_error *err)
{
    *factor = NULL;
    if (opts->n_calibrations == 0)
        return SS_OK;
    char *is_new = calloc(head->n_columns, 1);
    double *of = malloc(head->n_columns * sizeof *of);
    ss_status st = is_new != NULL && of != NULL ? SS_OK
        : ss_fail_memory(err, name);
    for (size_t c = 0; st == SS_OK && c < head->n_columns; c++)
        of[c] = 1;
    if (st == SS_OK)
        st = apply(head, opts, name, of, is_new, err);
    if (st == SS_OK && note_calibration(head, of, is_new) != SS_OK)
        st = ss_fail_memory(err, name);
    free(is_new);
    if (st == SS_OK)
        *factor = of;
    else
        free(of);
    return st;
}

ss_status
ss_calibrate(double *const column[], size_t n, size_t columns, const double *factor, const char *name,
             ss_error *err)
{
    for (size_t c = 0; factor != NULL && c < columns; c++)
        for (size_t i = 0; column[c] != NULL && i < n; i++)
            if (!isfinite(column[c][i] *= factor[c]))
                return ss_fail(err, SS_ERANGE, "%s: a value times %g is beyond double precision", name, factor[c]);
    return SS_OK;
}

void
ss_select_rows(ss_header *head, const ss_read_opts *opts, uint64_t *first, uint64_t *end)
{
    *first = 0;
    *end = UINT64_MAX;
    if (!(opts->from < opts->to))
        return;
    *first = ss_header_row(head, opts->from);
    *end = ss_header_row(head, opts->to);
    if (*first > 0)
        head->start += (double)*first / head->rate;
}

ss_status
ss_fail_no_rows(const char *name, double from, double to, ss_error *err)
{
    if (to >= DBL_MAX)
        return ss_fail(err, SS_EDATA, "%s: no samples from %.9g s on", name, from);
    if (from <= -DBL_MAX)
        return ss_fail(err, SS_EDATA, "%s: no samples before %.9g s", name, to);
    return ss_fail(err, SS_EDATA, "%s: no samples from %.9g to %.9g s", name, from, to);
}
