/* summary.c -- the numbers that the transitions of one recording have in common, and their table for
 * many recordings. */
#include "io/summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "find/numbers.h"
#include "io/output.h"

/* 1 if a signal of this kind has the numbers of a group. */
static int
applies(number_group of, const ss_features *f)
{
    switch (of) {
    case WITH_LOADING:         return f->loading != NULL;
    case WITH_FRICTION:
    case WITH_FRICTION_OVER_X: return f->loading != NULL || f->reverses;
    default:                   return 1;
    }
}

/* 1 if a signal of this kind has the numbers of a group, and the options ask for them. */
static int
belongs(number_group of, const ss_features *f, const ss_features_opts *opts)
{
    switch (of) {
    case WITH_FRICTION_OVER_X: return applies(of, f) && opts->displacement >= 0;
    case WITH_MASS:            return opts->mass > 0;
    case WITH_X_AND_F:         return opts->displacement >= 0 && opts->force >= 0;
    default:                   return applies(of, f);
    }
}

/* The next number from i on that the features have and the options ask for, or NULL.  A median also has the
 * scatter of the events. */
static const feature_number *
next_number(size_t *i, const ss_features *f, const ss_features_opts *opts, ss_median *m)
{
    while (*i < SS_SUMMARY_NUMBERS) {
        const feature_number *n = &ss_feature_numbers[(*i)++];
        if (!belongs(n->of, f, opts))
            continue;
        *m = (ss_median){ NAN, NAN, NAN };
        memcpy(m, (const char *)f + n->at, n->is_median ? sizeof *m : sizeof (ss_value));
        return n;
    }
    return NULL;
}

void
ss_summary_columns(struct rows *rows, const ss_features *f, const ss_features_opts *opts)
{
    const feature_number *n;
    ss_median m;
    for (size_t i = 1; (n = next_number(&i, f, opts, &m)) != NULL; ) {
        char name[64];
        snprintf(name, sizeof name, "all_%s", n->key);
        ss_rows_column(rows, name, "");
        snprintf(name, sizeof name, "all_%s_error", n->key);
        ss_rows_column(rows, name, "");
    }
}

void
ss_summary_cells(struct rows *rows, const ss_features *f, const ss_features_opts *opts)
{
    ss_median m;
    for (size_t i = 1; next_number(&i, f, opts, &m) != NULL; ) {
        ss_rows_number(rows, m.value);
        ss_rows_number(rows, m.error);
    }
}

void
ss_summary_write(struct rows *rows, const ss_features *f, const ss_features_opts *opts)
{
    char text[3][SS_NUMBER_MAX];
    const feature_number *n;
    ss_median m;
    for (size_t i = 1; (n = next_number(&i, f, opts, &m)) != NULL; ) {
        ss_rows_note(rows, "%s: %s %s%s%s", n->key, ss_number_text(text[0], m.value),
                     ss_number_text(text[1], m.error), n->is_median ? " " : "",
                     n->is_median ? ss_number_text(text[2], m.scatter) : "");
    }
}

/* --- a summary ----------------------------------------------------------------------------- */

const char *
ss_summary_name(size_t i)
{
    return i < SS_SUMMARY_NUMBERS ? ss_feature_numbers[i].key : NULL;
}

static void
add_reason(ss_summary *s, const char *about, const char *why)
{
    size_t n = strlen(s->reason);
    if (why != NULL)
        snprintf(s->reason + n, sizeof s->reason - n, "%s%s: %s", n > 0 ? "; " : "", about, why);
}

void
ss_summary_fill(ss_summary *out, const ss_features *f, const ss_signal *signal, size_t column,
                const char *reason)
{
    if (out == NULL)
        return;
    memset(out, 0, sizeof *out);        /* padding too, since it may be written to a file */
    for (size_t i = 0; i < SS_SUMMARY_NUMBERS; i++)
        out->number[i] = (ss_value){ NAN, NAN };
    if (f == NULL || signal == NULL || column >= signal->head->n_columns) {
        snprintf(out->reason, sizeof out->reason, "%s", reason != NULL ? reason : "");
        return;
    }
    out->number[0].value = (double)f->n;
    for (size_t i = 1; i < SS_SUMMARY_NUMBERS; i++)
        if (applies(ss_feature_numbers[i].of, f))
            memcpy(&out->number[i], (const char *)f + ss_feature_numbers[i].at, sizeof out->number[i]);
    snprintf(out->unit, sizeof out->unit, "%s", signal->head->column[column].unit);
    add_reason(out, "slips", f->why_slips);
    add_reason(out, "repetition", f->why_repetition);
    add_reason(out, "ringing", f->why_ringing);
}

/* --- the table ----------------------------------------------------------------------------- */

static void
write_columns(struct rows *rows)
{
    ss_rows_column(rows, "file", "");
    ss_rows_column(rows, "unit", "");
    for (size_t i = 0; i < SS_SUMMARY_NUMBERS; i++) {
        const feature_number *n = &ss_feature_numbers[i];
        char error[64];
        snprintf(error, sizeof error, "%s_error", n->key);
        ss_rows_column(rows, n->key, n->unit != NULL ? n->unit : "");
        ss_rows_column(rows, error, n->unit != NULL ? n->unit : "");
    }
    ss_rows_column(rows, "reason", "");
    ss_rows_end(rows);
}

/* Write a word as one cell; an empty one becomes a hyphen. */
static ss_status
write_word(struct rows *rows, const char *word)
{
    char *text = strdup(word[0] != '\0' ? word : "-");
    if (text == NULL)
        return SS_ENOMEM;
    ss_rows_word(rows, ss_printable(text));
    free(text);
    return SS_OK;
}

static ss_status
write_row(struct rows *rows, const char *file, const ss_summary *s)
{
    ss_status st = write_word(rows, file);
    if (st == SS_OK)
        st = write_word(rows, s->unit);
    for (size_t i = 0; i < SS_SUMMARY_NUMBERS; i++) {
        ss_rows_number(rows, s->number[i].value);
        ss_rows_number(rows, s->number[i].error);
    }
    if (st == SS_OK)
        st = write_word(rows, s->reason);
    ss_rows_end(rows);
    return st;
}

/* The scatter of one number over all files that have it. */
typedef struct scatter {
    size_t n, n_errors;
    double mean, squares;       /* sum of squares of differences from the mean (Welford 1962) */
    double errors;              /* sum of squares of standard errors */
    const char *unit;           /* NULL: it is not the same in all files */
} scatter;

static void
add_value(scatter *sum, const ss_summary *s, size_t i)
{
    ss_value v = s->number[i];
    if (isnan(v.value))
        return;
    double off = v.value - sum->mean;
    sum->mean += off / (double)++sum->n;
    sum->squares += off * (v.value - sum->mean);
    if (sum->n == 1)
        sum->unit = s->unit;
    else if (ss_feature_numbers[i].unit == NULL && sum->unit != NULL && strcmp(sum->unit, s->unit) != 0)
        sum->unit = NULL;
    if (isnan(v.error))
        return;
    sum->n_errors++;
    sum->errors += v.error * v.error;
}

/* Write the mean of a number and its scatter.  Forces in N and in lbf have no mean. */
static void
write_scatter(struct rows *rows, size_t i, const ss_summary summary[], size_t n)
{
    scatter sum = { .unit = NULL };
    char mean[SS_NUMBER_MAX], between[SS_NUMBER_MAX], within[SS_NUMBER_MAX];
    for (size_t k = 0; k < n; k++)
        add_value(&sum, &summary[k], i);
    int comparable = sum.unit != NULL;
    ss_rows_note(rows, "%s: %s %s %s %zu", ss_feature_numbers[i].key,
                 ss_number_text(mean, comparable ? sum.mean : NAN),
                 ss_number_text(between, comparable && sum.n > 1
                                ? sqrt(sum.squares / (double)(sum.n - 1)) : NAN),
                 ss_number_text(within, comparable && sum.n_errors > 0
                                ? sqrt(sum.errors / (double)sum.n_errors) : NAN), sum.n);
}

ss_status
ss_summaries_write(const char *const file[], const ss_summary summary[], size_t n, FILE *out,
                   ss_format format)
{
    struct rows rows;
    ss_status st = SS_OK;
    if (file == NULL || summary == NULL || out == NULL
        || ss_rows_begin(&rows, out, format, SS_KIND_SUMMARIES) != SS_OK)
        return SS_EINVAL;
    write_columns(&rows);
    for (size_t i = 0; st == SS_OK && i < n; i++)
        st = write_row(&rows, file[i], &summary[i]);
    ss_rows_note(&rows, "scatter: mean, standard deviation between files, rms standard error within "
                 "a file, files");
    for (size_t i = 0; i < SS_SUMMARY_NUMBERS; i++)
        write_scatter(&rows, i, summary, n);
    return st == SS_OK ? ss_output_flush(out) : st;
}
