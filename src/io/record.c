/* record.c -- see record.h. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "signal/header.h"
#include "io/record.h"

enum { KEY_MAX = 48 };          /* bytes of the longest name of a number, as all_NAME */

ss_status
ss_rows_begin(struct rows *rows, FILE *out, ss_format format, ss_kind kind, ss_error *err)
{
    const struct format *table = ss_format_table(format);
    if (table == NULL || table->separator == '\0')
        return ss_fail(err, SS_EINVAL, "this format holds numbers only");
    *rows = (struct rows){ .out = out, .format = table, .names = 1 };
    if (table->has_notes)
        fprintf(out, "%s\n", ss_kind_magic(kind));
    return SS_OK;
}

ss_status
ss_rows_finish(struct rows *rows, ss_error *err)
{
    return fflush(rows->out) == 0 && !ferror(rows->out) ? SS_OK
        : ss_fail(err, SS_EIO, "%s", ss_strerror(SS_EIO));
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
ss_rows_note_value(struct rows *rows, const char *key, ss_value v, const char *unit, int digits)
{
    char value[SS_NUMBER_MAX], error[SS_NUMBER_MAX];
    ss_rows_note(rows, "%s: %s %s%s%s", key, ss_number_rounded(value, v.value, digits),
                 ss_number_rounded(error, v.error, digits / 2), unit[0] != '\0' ? " " : "", unit);
}

void
ss_rows_whole_word(struct rows *rows, const char *key, const char *text)
{
    if (rows->format->has_notes)
        ss_rows_note(rows, "%s: %s", key, text);
    else
        ss_rows_word(rows, key, text);
}

void
ss_rows_whole_value(struct rows *rows, const char *key, ss_value v, const char *unit, int digits)
{
    char name[KEY_MAX];
    snprintf(name, sizeof name, "all_%s", key);
    if (rows->format->has_notes)
        ss_rows_note_value(rows, key, v, unit, digits);
    else
        ss_rows_value(rows, name, unit, v);
}

void
ss_rows_notes(struct rows *rows, const ss_header *head, const char *const own[])
{
    for (size_t i = 0; i < head->n_notes; i++)
        if (!ss_note_is(head->note[i], own))
            ss_rows_note(rows, "%s", head->note[i]);
}

static void
write_cell(struct rows *rows, const char *name, const char *word, int is_word)
{
    const struct format *format = rows->format;
    if (format->key != NULL)
        format->key(rows->out, name, rows->cells == 0);
    else if (rows->cells > 0)
        fputc(format->separator, rows->out);
    rows->cells++;
    if (format->key != NULL && !is_word)
        fputs(isdigit((unsigned char)word[word[0] == '-']) ? word : "null", rows->out);
    else if (format->word != NULL)
        format->word(rows->out, word);
    else
        fputs(word, rows->out);
}

/* Write the name of a cell if this is the line of names.  Returns 1 if so. */
static int
write_name(struct rows *rows, const char *name, const char *unit)
{
    if (!rows->names)
        return 0;
    if (rows->format->key != NULL)
        return 1;
    if (!rows->format->has_notes) {
        write_cell(rows, name, name, 1);
        return 1;
    }
    if (rows->cells++ == 0)
        fputs("# columns:", rows->out);
    ss_write_label(rows->out, name, unit);
    return 1;
}

void
ss_rows_word(struct rows *rows, const char *name, const char *word)
{
    if (!write_name(rows, name, ""))
        write_cell(rows, name, word, 1);
}

void
ss_rows_count(struct rows *rows, const char *name, size_t n)
{
    ss_rows_number(rows, name, "", (double)n);
}

void
ss_rows_number(struct rows *rows, const char *name, const char *unit, double x)
{
    ss_rows_rounded(rows, name, unit, x, 0);
}

void
ss_rows_rounded(struct rows *rows, const char *name, const char *unit, double x, int digits)
{
    char text[SS_NUMBER_MAX];
    if (!write_name(rows, name, unit))
        write_cell(rows, name, ss_number_rounded(text, x, digits), 0);
}

void
ss_rows_value(struct rows *rows, const char *name, const char *unit, ss_value v)
{
    char error[KEY_MAX + sizeof "_error"];
    snprintf(error, sizeof error, "%s_error", name);
    ss_rows_number(rows, name, unit, v.value);
    ss_rows_number(rows, error, unit, v.error);
}

void
ss_rows_end(struct rows *rows)
{
    if (rows->format->key == NULL || !rows->names)
        fputs(rows->format->key != NULL ? "}\n" : "\n", rows->out);
    rows->cells = 0;
    rows->names = 0;
}

const char *
ss_number_text(char text[SS_NUMBER_MAX], double x)
{
    return ss_number_rounded(text, x, 0);
}

const char *
ss_number_rounded(char text[SS_NUMBER_MAX], double x, int digits)
{
    if (isnan(x))
        strcpy(text, "-");
    else if (digits == 0)
        ss_number_format(text, x);
    else
        ss_print_to(text, SS_NUMBER_MAX, "%.*g", digits < 17 ? digits : 17, x);
    return text;
}

const char *
ss_number_fixed(char text[SS_NUMBER_MAX], double x, int decimals)
{
    if (isnan(x) || ss_print_to(text, SS_NUMBER_MAX, "%.*f", decimals, x) >= SS_NUMBER_MAX)
        ss_number_rounded(text, x, 9);
    return text;
}
