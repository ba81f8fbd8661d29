/* write.c -- errors and times of methods, and of simpler models, as text. */
#include <stickslip/trade.h>

#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "io/record.h"
#include "study/trade/trade.h"

enum { DIGITS = 3 };            /* a measurement does not deserve more */

/* --- methods ------------------------------------------------------------------------------- */

static void
write_row(struct rows *rows, const ss_trade_row *row, int transform, double fastest)
{
    int measured = row->status == SS_OK, estimated = row->status == SS_EBUDGET;
    ss_rows_word(rows, "method", row->method);
    if (!transform)
        ss_rows_rounded(rows, "tol", "", row->tol > 0 ? row->tol : NAN, DIGITS);
    ss_rows_rounded(rows, transform ? "error" : "x_error", "", measured ? row->error_x : NAN, DIGITS);
    if (!transform) {
        ss_rows_rounded(rows, "a_error", "", measured ? row->error_a : NAN, DIGITS);
        ss_rows_rounded(rows, "event_error", "s", measured ? row->error_t : NAN, DIGITS);
        ss_rows_number(rows, "missed", "", measured ? (double)row->missed : NAN);
        ss_rows_number(rows, "invented", "", measured ? (double)row->invented : NAN);
        ss_rows_number(rows, "rhs", "", measured ? (double)row->rhs : NAN);
        ss_rows_number(rows, "steps", "", measured ? (double)row->steps : NAN);
    }
    ss_rows_rounded(rows, "time", "", measured || estimated ? row->seconds / fastest : NAN, DIGITS);
    ss_rows_count(rows, "frontier", (size_t)row->frontier);
    ss_rows_word(rows, "state", measured ? "measured" : estimated ? "estimated" : "refused");
    ss_rows_end(rows);
}

ss_status
ss_trade_write(const ss_trade *trade, const char *name, FILE *out, ss_format format, ss_error *err)
{
    char x[SS_NUMBER_MAX], a[SS_NUMBER_MAX], t[SS_NUMBER_MAX];
    struct rows rows;
    double fastest = NAN;
    if (trade == NULL || name == NULL || out == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_rows_begin(&rows, out, format, SS_KIND_TRADE, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 0; i < trade->n; i++)
        if (trade->row[i].status == SS_OK)
            fastest = fmin(fastest, trade->row[i].seconds);
    ss_rows_note(&rows, "%s: %s", trade->transform ? "signal" : "scene", name);
    ss_rows_note(&rows, "reference: %s", trade->reference);
    if (trade->transform) {
        ss_rows_note(&rows, "compared: %zu coefficients", trade->samples);
    } else {
        ss_rows_note(&rows, "compared: %zu samples, %zu events", trade->samples, trade->events);
        ss_rows_note(&rows, "known: x %s, a %s, t %s s", ss_number_rounded(x, trade->known_x, DIGITS),
                     ss_number_rounded(a, trade->known_a, DIGITS),
                     ss_number_rounded(t, trade->known_t, DIGITS));
    }
    ss_rows_note(&rows, "fastest: %s s", ss_number_rounded(t, fastest, DIGITS));
    write_row(&rows, &(ss_trade_row){ .method = "" }, trade->transform, fastest);       /* the names */
    for (size_t i = 0; i < trade->n; i++)
        write_row(&rows, &trade->row[i], trade->transform, fastest);
    return ss_rows_finish(&rows, err);
}

/* --- models -------------------------------------------------------------------------------- */

static void
write_model(struct rows *rows, const ss_models_row *row, double unit, const ss_need *need, size_t n)
{
    int measured = row->status == SS_OK, counted = measured && ss_model_has_events(row->scene.model);
    ss_rows_word(rows, "model", row->name);
    const char *name;
    for (size_t i = 0; (name = ss_compared_name(i)) != NULL; i++)
        if (i == SS_COMPARED_EVENTS || i == SS_COMPARED_MICROSLIPS)
            ss_rows_number(rows, name, "", !counted ? NAN
                           : (double)(i == SS_COMPARED_EVENTS ? row->events : row->microslips));
        else
            ss_rows_rounded(rows, name, ss_compared_unit(i), measured ? row->error[i] : NAN, DIGITS);
    ss_rows_rounded(rows, "time", "", measured ? row->seconds / unit : NAN, DIGITS);
    if (n > 0)
        ss_rows_count(rows, "keeps", (size_t)ss_models_keeps(row, need, n));
    ss_rows_word(rows, "state", measured ? "measured" : row->reason.text);
    ss_rows_end(rows);
}

ss_status
ss_models_write(const ss_models *models, const char *name, const ss_need *need, size_t n, FILE *out,
                ss_format format, ss_error *err)
{
    struct rows rows;
    char *answer = NULL, seconds[SS_NUMBER_MAX];
    if (models == NULL || name == NULL || out == NULL || (need == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = n > 0 ? ss_models_answer(&answer, models, need, n, err) : SS_OK;
    if (st == SS_OK)
        st = ss_rows_begin(&rows, out, format, SS_KIND_TRADE, err);
    if (st == SS_OK) {
        double unit = models->row[0].seconds;
        ss_rows_note(&rows, "scene: %s", name);
        ss_rows_note(&rows, "compared: %zu samples", models->samples);
        ss_rows_note(&rows, "unit_of_time: %s s", ss_number_rounded(seconds, unit, DIGITS));
        if (answer != NULL)
            ss_rows_note(&rows, "answer: %s", answer);
        write_model(&rows, &models->row[0], unit, need, n);     /* the names */
        for (size_t i = 0; i < models->n; i++)
            write_model(&rows, &models->row[i], unit, need, n);
        st = ss_rows_finish(&rows, err);
    }
    free(answer);
    return st;
}
