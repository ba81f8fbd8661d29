/* trade.c -- write the errors and times of methods as text. */
#include <stickslip/trade.h>

#include <math.h>
#include "io/output.h"
#include "io/rows.h"

enum { DIGITS = 3 };            /* a measurement does not deserve more */

static void
write_count(struct rows *rows, size_t n, int known)
{
    if (known)
        ss_rows_count(rows, n);
    else
        ss_rows_number(rows, NAN);
}

static void
write_row(struct rows *rows, const ss_trade_row *row, int transform, double fastest)
{
    int measured = row->status == SS_OK, estimated = row->status == SS_EBUDGET;
    ss_rows_word(rows, row->method);
    ss_rows_rounded(rows, row->tol > 0 ? row->tol : NAN, DIGITS);
    ss_rows_rounded(rows, measured ? row->error_x : NAN, DIGITS);
    if (!transform) {
        ss_rows_rounded(rows, measured ? row->error_a : NAN, DIGITS);
        ss_rows_rounded(rows, measured ? row->error_t : NAN, DIGITS);
        write_count(rows, row->missed, measured);
        write_count(rows, row->invented, measured);
        write_count(rows, row->rhs, measured);
        write_count(rows, row->steps, measured);
    }
    ss_rows_rounded(rows, measured || estimated ? row->seconds / fastest : NAN, DIGITS);
    ss_rows_count(rows, (size_t)row->frontier);
    ss_rows_word(rows, measured ? "measured" : estimated ? "estimated" : "refused");
    ss_rows_end(rows);
}

static void
write_notes(struct rows *rows, const ss_trade *trade, const char *name, double fastest)
{
    char x[SS_NUMBER_MAX], a[SS_NUMBER_MAX], t[SS_NUMBER_MAX];
    ss_rows_note(rows, "%s: %s", trade->transform ? "signal" : "scene", name);
    ss_rows_note(rows, "reference: %s", trade->reference);
    if (trade->transform) {
        ss_rows_note(rows, "compared: %zu coefficients", trade->samples);
    } else {
        ss_rows_note(rows, "compared: %zu samples, %zu events", trade->samples, trade->events);
        ss_rows_note(rows, "known: x %s, a %s, t %s s", ss_number_rounded(x, trade->known_x, DIGITS),
                     ss_number_rounded(a, trade->known_a, DIGITS),
                     ss_number_rounded(t, trade->known_t, DIGITS));
    }
    ss_rows_note(rows, "fastest: %s s", ss_number_rounded(t, fastest, DIGITS));
}

ss_status
ss_trade_write(const ss_trade *trade, const char *name, FILE *out, ss_format format)
{
    static const char *const of_transform[][2] = {
        { "method", "" }, { "accuracy", "" }, { "error", "" }, { "time", "" }, { "frontier", "" },
        { "state", "" } };
    static const char *const of_scene[][2] = {
        { "method", "" }, { "tol", "" }, { "x_error", "" }, { "a_error", "" }, { "event_error", "s" },
        { "missed", "" }, { "invented", "" }, { "rhs", "" }, { "steps", "" }, { "time", "" },
        { "frontier", "" }, { "state", "" } };
    struct rows rows;
    double fastest = NAN;
    if (trade == NULL || name == NULL || out == NULL
        || ss_rows_begin(&rows, out, format, SS_KIND_TRADE) != SS_OK)
        return SS_EINVAL;
    for (size_t i = 0; i < trade->n; i++)
        if (trade->row[i].status == SS_OK)
            fastest = fmin(fastest, trade->row[i].seconds);
    write_notes(&rows, trade, name, fastest);
    if (trade->transform)
        ss_rows_columns(&rows, of_transform, sizeof of_transform / sizeof *of_transform);
    else
        ss_rows_columns(&rows, of_scene, sizeof of_scene / sizeof *of_scene);
    for (size_t i = 0; i < trade->n; i++)
        write_row(&rows, &trade->row[i], trade->transform, fastest);
    return ss_output_flush(out);
}
