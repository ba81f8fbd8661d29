/* cells.c -- divide lines of a text table into cells, read the numbers in cells, and say what is wrong in a
 * line. */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <stickslip/number.h>
#include "base/error.h"
#include "base/number.h"
#include "io/table/text.h"

void
ss_text_fail(struct text *x, ss_status status, unsigned long line, const char *format, ...)
{
    ss_error why;
    va_list args;
    if (x->status != SS_OK)
        return;
    va_start(args, format);
    ss_print_text(why.text, sizeof why.text, format, args);
    va_end(args);
    x->status = line > 0 ? ss_fail(x->err, status, "%s:%lu: %s", x->t.name, line, why.text)
        : ss_fail(x->err, status, "%s: %s", x->t.name, why.text);
}

char *
ss_cell_trim(char *p)
{
    p += strspn(p, " \t");
    size_t n = strlen(p);
    while (n > 0 && (p[n - 1] == ' ' || p[n - 1] == '\t'))
        n--;
    p[n] = '\0';
    return p;
}

/* Remove the quotes of a cell, in place; returns the text after it. */
static char *
unquote(char *p)
{
    char *to = p;
    for (char *from = p + 1; *from != '\0'; *to++ = *from++)
        if (*from == '"') {
            if (from[1] != '"') {
                *to = '\0';
                return from + 1;
            }
            from++;
        }
    *to = '\0';
    return to;
}

size_t
ss_text_split(struct text *x, const char *line, char separator)
{
    size_t n = 0;
    int more = 1;
    for (char *p = strcpy(x->copy, line); more && n < MAX_CELLS; ) {
        p += separator == '\t' ? strspn(p, " ") : strspn(p, " \t");
        char *begin = p, *rest = *p == '"' ? unquote(p) : p;
        char *end = separator == ' ' ? rest + strcspn(rest, " \t") : strchr(rest, separator);
        end = end != NULL ? end : rest + strlen(rest);
        more = *end != '\0';
        *end = '\0';
        if (rest > begin)                       /* what stands behind quotes belongs to the cell */
            memmove(begin + strlen(begin), rest, strlen(rest) + 1);
        x->cell[n++] = ss_cell_trim(begin);
        p = end + more;
    }
    while (!more && n > 1 && n != x->t.n_columns && x->cell[n - 1][0] == '\0')
        n--;
    return n;
}

int
ss_text_may_lack(const struct text *x)
{
    return x->t.opts->gaps != SS_GAPS_REFUSE || x->t.opts->n_needed > 0;
}

/* SCPI writes 9.9E37 for infinity, and 9.91E37 for no number. */
static int
is_value(double x)
{
    return isfinite(x) && !(fabs(x) >= 9.9e37 && fabs(x) <= 9.91e37);
}

/* Reads as ss_number_parse does, and also Fortran's 1.0D+00. */
enum cell_kind
ss_cell_read(char *cell, char separator, double *x)
{
    static const char *const missing[] = {      /* words that recorders write in place of a missing number */
        "nan", "nan(ind)", "nan(snan)", "1.#qnan", "1.#ind", "1.#inf", "inf", "infinity", "\u221e", "na", "n/a",
        "#n/a", "#nv", "null", "none", "ovr", "ovl", "ol", "ovld", "overload", "overrange", "overflow" };
    char *end, *comma = separator != ',' ? strchr(cell, ',') : NULL;
    if (comma != NULL)
        *comma = '.';
    *x = ss_number_parse(cell, &end);
    if (end > cell && (*end == 'D' || *end == 'd')) {
        char *mark = end, letter = *mark;
        *mark = 'e';
        *x = ss_number_parse(cell, &end);
        *mark = letter;
    }
    int number = end > cell && *end == '\0';
    if (comma != NULL)
        *comma = ',';
    if (number)
        return is_value(*x) ? CELL_NUMBER : CELL_NOT_FINITE;
    for (size_t i = 0; i < sizeof missing / sizeof *missing; i++)
        if (strcasecmp(cell + (*cell == '-' || *cell == '+'), missing[i]) == 0)
            return CELL_NOT_FINITE;
    return *cell >= '0' && *cell <= '9' && ss_stamp_read(cell).parts != 0 ? CELL_STAMP : CELL_TEXT;
}

int
ss_cell_is_grouped(const char *cell)
{
    static const char *const mark[] = { ",", ".", "'", " ", "_", "\u00a0", "\u2009", "\u202f", "\u2019" };
    const char *p = cell + (*cell == '-' || *cell == '+');
    size_t digits = strspn(p, "0123456789"), groups = 0;
    if (*p == '0' || digits < 1 || digits > 3)
        return 0;
    for (size_t i = 0; groups == 0 && i < sizeof mark / sizeof *mark; i++) {
        size_t n = strlen(mark[i]);
        const char *rest = p + digits;
        for (; strncmp(rest, mark[i], n) == 0 && strspn(rest + n, "0123456789") == 3; rest += n + 3)
            groups++;
        if (groups > 0)
            p = rest;
    }
    p += *p == '.' || *p == ',';
    return groups > 0 && p[strspn(p, "0123456789")] == '\0';
}

const char *
ss_text_shape(struct text *x, const char *line, char separator)
{
    double number;
    size_t n = ss_text_split(x, line, separator);
    x->numbers = 0;
    for (size_t i = 0; i < n; i++) {
        enum cell_kind kind = ss_cell_read(x->cell[i], separator, &number);
        x->shape[i] = x->cell[i][0] == '\0' ? 'e' : kind == CELL_TEXT ? 't' : 'n';
        x->numbers += kind == CELL_NUMBER;
    }
    x->shape[n] = '\0';
    return x->shape;
}
