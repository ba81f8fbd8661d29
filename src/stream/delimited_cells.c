/* delimited_cells.c -- lines of a text table as cells, and cells as numbers. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "base/list.h"
#include "stream/delimited.h"

ss_status
ss_delimited_no_memory(const struct table *t, ss_error *err)
{
    return ss_fail(err, SS_ENOMEM, "%s:%lu: no memory for a table this large", t->in->name,
                   t->in->line);
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
ss_delimited_split(struct table *t, char *p, char separator)
{
    size_t n = 0;
    for (int more = 1; more; ) {
        char **cell = ss_list_room(t->cell, &t->cell_room, n, sizeof *cell);
        if (cell == NULL)
            return NONE;
        t->cell = cell;
        p += separator == '\t' ? strspn(p, " ") : strspn(p, " \t");
        char *begin = p, *end = *p == '"' ? unquote(p) : p;
        end += separator == ' ' ? strcspn(end, " \t") : separator == '\0' ? strlen(end)
             : strcspn(end, (char[]){ separator, '\0' });
        more = *end != '\0';
        *end = '\0';
        t->cell[n++] = ss_cell_trim(begin);
        p = end + more;
    }
    while (n > 1 && n != t->n_columns && t->cell[n - 1][0] == '\0')
        n--;
    return n;
}

/* Words that recorders write in place of a number. */
static int
is_no_number(const char *cell)
{
    static const char *const word[] = { "nan", "inf", "infinity", "na", "n/a", "null",
        "\u221e", NULL };
    cell += *cell == '-' || *cell == '+';
    for (int i = 0; word[i] != NULL; i++)
        if (strcasecmp(cell, word[i]) == 0)
            return 1;
    return 0;
}

enum cell_kind
ss_cell_read(char *cell, char separator, double *x)
{
    char *end, *comma = separator != ',' ? strchr(cell, ',') : NULL;
    if (comma != NULL)
        *comma = '.';
    *x = ss_number_parse(cell, &end);
    int number = end > cell && *end == '\0';
    if (comma != NULL)
        *comma = ',';
    if (number)
        return isfinite(*x) ? CELL_NUMBER : CELL_NOT_FINITE;
    return is_no_number(cell) ? CELL_NOT_FINITE : CELL_TEXT;
}

size_t
ss_delimited_count_numbers(struct table *t, const char *line, char separator)
{
    double x;
    size_t numbers = 0;
    char *copy = strdup(line);
    size_t n = copy != NULL ? ss_delimited_split(t, copy, separator) : NONE;
    for (size_t i = 0; n != NONE && i < n; i++) {
        enum cell_kind kind = ss_cell_read(t->cell[i], separator, &x);
        if (kind == CELL_TEXT && !(t->opts->gaps != SS_GAPS_REFUSE && t->cell[i][0] == '\0'))
            n = 0;
        numbers += kind == CELL_NUMBER;
    }
    free(copy);
    return n == NONE || numbers > 0 ? n : 0;
}
