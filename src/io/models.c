/* models.c -- write the comparison of a scene with simpler scenes as text. */
#include <stickslip/trade.h>

#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "io/output.h"
#include "io/rows.h"

enum { DIGITS = 3 };

static void
write_row(struct rows *rows, const ss_models_row *row, double unit)
{
    int measured = row->status == SS_OK, counted = measured && ss_model_has_events(row->scene.model);
    ss_rows_word(rows, row->name);
    for (size_t i = 0; i < SS_COMPARED; i++)
        if (i == SS_COMPARED_EVENTS || i == SS_COMPARED_MICROSLIPS)
            ss_rows_number(rows, !counted ? NAN
                           : (double)(i == SS_COMPARED_EVENTS ? row->events : row->microslips));
        else
            ss_rows_rounded(rows, measured ? row->error[i] : NAN, DIGITS);
    ss_rows_rounded(rows, measured ? row->seconds / unit : NAN, DIGITS);
}

static void
write_columns(struct rows *rows, int has_needs)
{
    ss_rows_column(rows, "model", "");
    for (size_t i = 0; i < SS_COMPARED; i++)
        ss_rows_column(rows, ss_compared_name(i), ss_compared_unit(i));
    ss_rows_column(rows, "time", "");
    if (has_needs)
        ss_rows_column(rows, "keeps", "");
    ss_rows_column(rows, "state", "");
    ss_rows_end(rows);
}

ss_status
ss_models_write(const ss_models *models, const char *name, const ss_need *need, size_t n, FILE *out,
                ss_format format, ss_error *err)
{
    struct rows rows;
    char *answer = NULL, seconds[SS_NUMBER_MAX];
    if (models == NULL || name == NULL || out == NULL
        || (need == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = n > 0 ? ss_models_answer(&answer, models, need, n, err) : SS_OK;
    if (st == SS_OK && (st = ss_rows_begin(&rows, out, format, SS_KIND_TRADE)) != SS_OK)
        ss_fail(err, st, "this format holds numbers only");
    if (st != SS_OK) {
        free(answer);
        return st;
    }
    ss_rows_note(&rows, "scene: %s", name);
    ss_rows_note(&rows, "compared: %zu samples", models->samples);
    ss_rows_note(&rows, "unit_of_time: %s s", ss_number_rounded(seconds, models->row[0].seconds, DIGITS));
    if (answer != NULL)
        ss_rows_note(&rows, "answer: %s", answer);
    free(answer);
    write_columns(&rows, n > 0);
    for (size_t i = 0; i < models->n; i++) {
        const ss_models_row *row = &models->row[i];
        write_row(&rows, row, models->row[0].seconds);
        if (n > 0)
            ss_rows_count(&rows, (size_t)ss_models_keeps(row, need, n));
        ss_rows_word(&rows, row->status == SS_OK ? "measured" : row->reason.text);
        ss_rows_end(&rows);
    }
    return ss_output_flush(out);
}
