/* rows.c -- write a header of notes, and rows of words and numbers. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/rows.h"

ss_status
ss_rows_begin(struct rows *rows, FILE *out, ss_format format, ss_kind kind)
{
    const struct format *table = ss_format_table(format);
    if (table == NULL || table->separator == '\0')
        return SS_EINVAL;
    *rows = (struct rows){ .out = out, .format = table };
    if (table->has_notes)
        fprintf(out, "%s\n", ss_kind_magic(kind));
    return SS_OK;
}

void
ss_rows_note(struct rows *rows, const char *text, ...)
{
    if (!rows->format->has_notes)
        return;
    va_list args;
    va_start(args, text);
    fputs("# ", rows->out);
    vfprintf(rows->out, text, args);
    fputc('\n', rows->out);
    va_end(args);
}

void
ss_rows_notes(struct rows *rows, const ss_header *head, const char *const own[])
{
    for (size_t i = 0; i < head->n_notes; i++)
        if (!ss_note_is(head->note[i], own))
            ss_rows_note(rows, "%s", head->note[i]);
}

/* --- columns ------------------------------------------------------------------------------- */

void
ss_rows_column(struct rows *rows, const char *name, const char *unit)
{
    if (!rows->format->has_notes) {
        ss_rows_word(rows, name);
        return;
    }
    if (rows->cells++ == 0)
        fputs("# columns:", rows->out);
    ss_write_label(rows->out, name, unit);
}

void
ss_rows_columns(struct rows *rows, const char *const label[][2], size_t n)
{
    for (size_t i = 0; i < n; i++)
        ss_rows_column(rows, label[i][0], label[i][1]);
    ss_rows_end(rows);
}

/* --- cells --------------------------------------------------------------------------------- */

void
ss_rows_word(struct rows *rows, const char *word)
{
    if (rows->cells++ > 0)
        fputc(rows->format->separator, rows->out);
    if (rows->format->word != NULL)
        rows->format->word(rows->out, word);
    else
        fputs(word, rows->out);
}

void
ss_rows_count(struct rows *rows, size_t n)
{
    char text[SS_NUMBER_MAX];
    snprintf(text, sizeof text, "%zu", n);
    ss_rows_word(rows, text);
}

void
ss_rows_number(struct rows *rows, double x)
{
    char text[SS_NUMBER_MAX];
    ss_rows_word(rows, ss_number_text(text, x));
}

void
ss_rows_rounded(struct rows *rows, double x, int digits)
{
    char text[SS_NUMBER_MAX];
    ss_rows_word(rows, ss_number_rounded(text, x, digits));
}

void
ss_rows_end(struct rows *rows)
{
    fputc('\n', rows->out);
    rows->cells = 0;
}

const char *
ss_number_text(char text[SS_NUMBER_MAX], double x)
{
    if (isnan(x))
        strcpy(text, "-");
    else
        ss_number_format(text, x);
    return text;
}

/* Copy a number that printf wrote.  The locale's decimal point, of one byte or more, becomes ".". */
static const char *
copy_number(char text[SS_NUMBER_MAX], const char *raw)
{
    char *to = text;
    for (const char *from = raw; *from != '\0'; from++)
        if (((unsigned char)*from < 0x80 && isalnum((unsigned char)*from)) || *from == '-' || *from == '+')
            *to++ = *from;
        else if (to[-1] != '.')
            *to++ = '.';
    *to = '\0';
    return text;
}

const char *
ss_number_rounded(char text[SS_NUMBER_MAX], double x, int digits)
{
    char raw[SS_NUMBER_MAX];
    snprintf(raw, sizeof raw, "%.*g", digits, x);
    return copy_number(text, isnan(x) ? "-" : raw);
}

const char *
ss_number_fixed(char text[SS_NUMBER_MAX], double x, int decimals)
{
    char raw[SS_NUMBER_MAX];
    if (snprintf(raw, sizeof raw, "%.*f", decimals, x) >= (int)sizeof raw)
        snprintf(raw, sizeof raw, "%.9g", x);
    return copy_number(text, isnan(x) ? "-" : raw);
}
