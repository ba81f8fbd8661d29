/* write.c -- features as text, and the table of the numbers of many recordings. */
#include <stickslip/features.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/options.h"
#include "find/numbers.h"
#include "io/record.h"

/* --- one recording --------------------------------------------------------------------------- */

/* In a format without notes each row ends with the numbers of the whole recording, and a recording without
 * transitions has one row, for these. */
void
ss_features_row(struct rows *rows, const ss_features *f, size_t i, double start, unsigned has)
{
    const ss_transition no_transition = { NAN, NAN, 1, 0, no_maximum, unknown, unknown, NAN, NAN };
    const ss_loading no_loading = { NAN, unknown, unknown, unknown, unknown, unknown, unknown, unknown,
                                    unknown, unknown, NAN, NAN, NAN };
    const ss_transition *tr = i < f->n ? &f->transition[i] : &no_transition;
    const ss_loading *l = i < f->n && f->loading != NULL ? &f->loading[i] : &no_loading;
    ss_rows_number(rows, "onset", "s", start + tr->onset);
    ss_rows_number(rows, "end", "s", start + tr->end);
    ss_rows_number(rows, "spikes", "", f->spikes->conclusive && !tr->gap ? (double)tr->spikes : NAN);
    ss_rows_number(rows, "time", "s", start + tr->maximum.t);
    ss_rows_number(rows, "frequency", "Hz", tr->maximum.f);
    ss_rows_number(rows, "prominence", "dB", tr->maximum.prominence);
    ss_rows_value(rows, "transition_frequency", "Hz", tr->frequency);
    ss_rows_value(rows, "damping_ratio", "", tr->damping_ratio);
    const struct { const char *name, *unit; ss_value value; } of_falls[] = {
        { "slope", "", l->slope }, { "stiffness", "", l->stiffness }, { "drop", "", l->drop },
        { "duration", "s", l->duration }, { "recurrence", "s", l->recurrence }, { "stick", "s", l->stick },
        { "static_friction", "", l->static_friction }, { "friction", "", l->friction },
        { "k_over_m", "1/s^2", l->k_over_m },
    };
    for (size_t k = 0; has & LOADING && k < sizeof of_falls / sizeof *of_falls; k++)
        ss_rows_value(rows, of_falls[k].name, of_falls[k].unit, of_falls[k].value);
    for (size_t k = SS_TRANSITIONS + 1; k < SS_FEATURE_NUMBERS && !rows->format->has_notes; k++)
        if ((ss_feature_numbers[k].needs & ~has) == 0)
            ss_rows_whole_value(rows, ss_feature_numbers[k].label.name,
                                (ss_value){ f->number[k].value, f->number[k].error }, "", 0);
    ss_rows_end(rows);
}

void
ss_features_numbers(struct rows *rows, const ss_features *f, unsigned has)
{
    char value[SS_NUMBER_MAX], error[SS_NUMBER_MAX], scatter[SS_NUMBER_MAX];
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++)
        if (f->number[k].why != NULL)
            ss_rows_note(rows, "about_%s: %s", ss_feature_numbers[k].about, f->number[k].why);
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++) {
        const feature_number *of = &ss_feature_numbers[k];
        int median = (of->needs & OF_EVENTS) != 0;
        if ((of->needs & ~has) == 0)
            ss_rows_note(rows, "%s: %s %s%s%s", of->label.name, ss_number_text(value, f->number[k].value),
                         ss_number_text(error, f->number[k].error), median ? " " : "",
                         median ? ss_number_text(scatter, f->number[k].scatter) : "");
    }
}

/* Write the notes of a signal, except those that features write themselves, or may write: a scene's friction is
 * not the one that was measured, and no file says of itself what was found in it. */
void
ss_features_notes(struct rows *rows, const ss_header *head, size_t column, const ss_features_opts *opts)
{
    char threshold[SS_NUMBER_MAX];
    enum { COLUMN = SS_FEATURE_NUMBERS };
    const char *own[COLUMN + 8]
        = { [COLUMN] = "column", "threshold", "norm", "near_gaps", "spike", "spikes", "about_*" };
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++)
        own[k] = ss_feature_numbers[k].label.name;
    ss_rows_notes(rows, head, own);
    ss_rows_note(rows, "column: %s", head->column[column].name);
    ss_rows_note(rows, "threshold: %s", ss_number_text(threshold, opts->threshold));
    ss_rows_note(rows, "norm: %s", opts->norm == SS_NORM_L1 ? "l1" : "l2");
    if (ss_header_find_note(head, "gaps") != NULL)
        ss_rows_note(rows, "near_gaps: nothing is claimed: no spike within 12 scales, no event "
                     "within 6, no local maximum within sqrt(2), no fit over one");
}

ss_status
ss_features_write(const ss_features *f, const ss_signal *signal, size_t column,
                  const ss_features_opts *given, FILE *out, ss_format format, ss_error *err)
{
    struct rows rows;
    if (f == NULL || signal == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    ss_features_opts own, *opts = &own, usual;
    ss_features_opts_init(&usual, sizeof usual);
    ss_status st = ss_options_take(&own, sizeof own, &usual, given, err);
    if (st == SS_OK)
        st = column < head->n_columns ? ss_rows_begin(&rows, out, format, SS_KIND_FEATURES, err)
            : ss_fail_column(err, column, head->n_columns);
    if (st != SS_OK)
        return st;
    unsigned has = ss_features_have(f, opts);
    ss_rows_note(&rows, "spikes: %s", f->spikes->verdict);
    ss_features_numbers(&rows, f, has);
    ss_features_notes(&rows, head, column, opts);
    ss_features_row(&rows, f, f->n, head->start, has);  /* the names */
    for (size_t i = 0; i < f->n + (f->n == 0 && !rows.format->has_notes); i++)
        ss_features_row(&rows, f, i, head->start, has);
    for (size_t i = 0; i < f->spikes->n; i++) {
        const ss_spike *spike = &f->spikes->spike[i];
        char t[SS_NUMBER_MAX], level[SS_NUMBER_MAX], slope[SS_NUMBER_MAX];
        ss_rows_note(&rows, "spike: %s %s %s %s", ss_number_text(t, head->start + spike->t),
                     ss_spike_kind_name(spike->kind), ss_number_rounded(level, spike->level, 3),
                     ss_number_rounded(slope, spike->slope, 3));
    }
    return ss_rows_finish(&rows, err);
}

/* --- many recordings ------------------------------------------------------------------------- */

enum { FILE_COLUMN, UNIT_COLUMN, FIRST_NUMBER, REASON_COLUMN = FIRST_NUMBER + 2 * SS_FEATURE_NUMBERS };

/* Write a word as one cell; an empty one becomes a hyphen.  A row must not begin as a note does. */
static ss_status
write_word(struct rows *rows, const char *name, const char *word)
{
    const char *before = word[0] == '#' && rows->cells == 0 ? "./" : "";
    char *text = malloc(strlen(before) + strlen(word) + 2);
    if (text == NULL)
        return SS_ENOMEM;
    sprintf(text, "%s%s", before, word[0] != '\0' ? word : "-");
    ss_rows_word(rows, name, ss_printable(text));
    free(text);
    return SS_OK;
}

static ss_status
write_summary(struct rows *rows, const char *file, const char *unit, const ss_value number[],
              const char *reason)
{
    ss_status st = write_word(rows, "file", file);
    if (st == SS_OK)
        st = write_word(rows, "unit", unit);
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++) {
        const ss_label *of = &ss_feature_numbers[k].label;
        ss_rows_value(rows, of->name, of->unit != NULL ? of->unit : "", number[k]);
    }
    if (st == SS_OK)
        st = write_word(rows, "reason", reason);
    ss_rows_end(rows);
    return st;
}

ss_status
ss_summary_write(const char *file, const ss_features *f, const ss_signal *signal, size_t column,
                 const char *reason, FILE *out, ss_error *err)
{
    struct rows rows;
    ss_value number[SS_FEATURE_NUMBERS];
    if (file == NULL || out == NULL || (f != NULL ? signal == NULL : reason == NULL))
        return SS_FAIL_NULL(err);
    if (f != NULL && column >= signal->head->n_columns)
        return ss_fail_column(err, column, signal->head->n_columns);
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++)
        number[k] = f != NULL ? (ss_value){ f->number[k].value, f->number[k].error } : unknown;
    char *said = NULL;
    size_t size;
    FILE *all = open_memstream(&said, &size);   /* of what is said about the numbers */
    const char *then = "";
    if (all != NULL && f == NULL)
        fputs(reason, all);
    for (size_t k = 0; all != NULL && f != NULL && k < SS_FEATURE_NUMBERS; k++)
        if (f->number[k].why != NULL) {
            fprintf(all, "%s%s: %s", then, ss_feature_numbers[k].about, f->number[k].why);
            then = "; ";
        }
    if (all != NULL && fclose(all) != 0) {
        free(said);
        said = NULL;
    }
    ss_status st = said != NULL ? ss_rows_begin(&rows, out, SS_TSV, SS_KIND_SUMMARIES, err) : SS_ENOMEM;
    for (int i = 0; st == SS_OK && i < 2; i++)          /* the names and the row */
        st = write_summary(&rows, file, f != NULL ? signal->head->column[column].unit : "", number, said);
    free(said);
    return st == SS_OK ? ss_rows_finish(&rows, err) : st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
}

/* Write the mean of a number over all files that have it, and its scatter.  Forces in N and in lbf have no
 * mean. */
static void
write_scatter(struct rows *rows, const ss_table *t, size_t k)
{
    const ss_label *of = &ss_feature_numbers[k].label;
    size_t n = 0, n_errors = 0, column = FIRST_NUMBER + 2 * k;
    double mean = 0, squares = 0, errors = 0;   /* sums of squares: of differences (Welford 1962), of errors */
    const char *unit = NULL;
    int comparable = 1;
    char text[3][SS_NUMBER_MAX];
    for (size_t i = 0; i < t->n; i++) {
        double value = ss_table_number(t, i, column), error = ss_table_number(t, i, column + 1);
        const char *own = t->cell[i * t->n_columns + UNIT_COLUMN];
        if (isnan(value))
            continue;
        double off = value - mean;
        mean += off / (double)++n;
        squares += off * (value - mean);
        comparable &= of->unit != NULL || unit == NULL || strcmp(unit, own) == 0;
        unit = own;
        if (!isnan(error)) {
            n_errors++;
            errors += error * error;
        }
    }
    double between = comparable && n > 1 ? sqrt(squares / (double)(n - 1)) : NAN;
    double within = comparable && n_errors > 0 ? sqrt(errors / (double)n_errors) : NAN;
    ss_rows_note(rows, "%s: %s %s %s %zu", of->name, ss_number_text(text[0], comparable && n > 0 ? mean : NAN),
                 ss_number_text(text[1], between), ss_number_text(text[2], within), n);
}

ss_status
ss_summaries_write(const ss_table *t, FILE *out, ss_format format, ss_error *err)
{
    struct rows rows;
    ss_value number[SS_FEATURE_NUMBERS];
    if (t == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    if (t->n_columns != REASON_COLUMN + 1)
        return ss_fail(err, SS_EDATA, "%zu columns, where a summary has %d", t->n_columns, REASON_COLUMN + 1);
    ss_status st = ss_rows_begin(&rows, out, format, SS_KIND_SUMMARIES, err);
    for (size_t i = 0; st == SS_OK && i <= t->n; i++) {         /* the names, and the rows */
        char **cell = t->n > 0 ? t->cell + (i > 0 ? i - 1 : 0) * t->n_columns : NULL;
        for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++)
            number[k] = (ss_value){ ss_table_number(t, i - 1, FIRST_NUMBER + 2 * k),
                                    ss_table_number(t, i - 1, FIRST_NUMBER + 2 * k + 1) };
        st = write_summary(&rows, cell != NULL ? cell[FILE_COLUMN] : "", cell != NULL ? cell[UNIT_COLUMN] : "",
                           number, cell != NULL ? cell[REASON_COLUMN] : "");
    }
    if (st != SS_OK)
        return st == SS_ENOMEM ? ss_fail_memory(err, NULL) : st;
    ss_rows_note(&rows, "scatter: mean, standard deviation between files, rms standard error within "
                 "a file, files");
    for (size_t k = 0; k < SS_FEATURE_NUMBERS; k++)
        write_scatter(&rows, t, k);
    return ss_rows_finish(&rows, err);
}
