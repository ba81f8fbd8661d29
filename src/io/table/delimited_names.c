/* delimited_names.c -- names and units of the columns of a table, from the lines above its data. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "signal/header.h"
#include "io/table/delimited.h"

/* Is this one symbol of a unit, such as mm, kHz or kip? */
static int
is_unit_symbol(const char *p, size_t n)
{
    static const char *const symbol[] = { "m", "s", "g", "N", "Pa", "V", "A", "Hz", "K", "W", "J",
        "rad", "Ohm", "bar", "sec", "min", "h", "in", "inch", "ft", "lb", "lbf", "kip", "psi", "deg",
        "\u00b0", "\u00b0C", "\u00b0F", "%", "rpm", "dB", "strain", "\u03a9", NULL };
    static const char *const prefix[] = { "", "m", "\u00b5", "\u03bc", "u", "n", "k", "M", "G", "c",
        "d", "h", NULL };
    for (int i = 0; prefix[i] != NULL; i++) {
        size_t skip = strlen(prefix[i]);
        if (skip >= n || memcmp(p, prefix[i], skip) != 0)
            continue;
        for (int j = 0; symbol[j] != NULL; j++)
            if (strlen(symbol[j]) == n - skip && memcmp(p + skip, symbol[j], n - skip) == 0)
                return 1;
    }
    return 0;
}

/* Is this a unit, such as [mm/s], N m, m/s^2 or 1? */
static int
is_unit(const char *p)
{
    static const char between[] = "/*. ^-()[]0123456789\xc2\xb2\xb3";  /* superscripts too */
    if ((*p == '[' || *p == '(') && strpbrk(p, "])") == p + strlen(p) - 1)
        return 1;
    while (*p != '\0') {
        size_t n = strcspn(p, "/*. ^-()[]0123456789");
        if (n > 2 && p[n - 2] == '\xc2' && (p[n - 1] == '\xb2' || p[n - 1] == '\xb3'))
            n -= 2;
        if (n > 0 && !is_unit_symbol(p, n))
            return 0;
        p += n;
        p += strspn(p, between);
    }
    return 1;
}

/* The kind of a row above the data, if it has as many cells as the data. */
enum row_kind { ROW_OTHER, ROW_NAMES, ROW_UNITS, ROW_MIXED, ROW_NO_MEMORY };

static enum row_kind
kind_of_row(struct table *t, const char *line)
{
    size_t empty = 0, numbers = 0, units = 0;
    double x;
    if (line == NULL)
        return ROW_OTHER;
    char *copy = strdup(line);
    size_t n = copy != NULL ? ss_delimited_split(t, copy, t->separator) : NONE;
    if (n == t->n_columns + 1 && strcasecmp(t->cell[n - 1], "comment") == 0) {
        n--;                                    /* LabVIEW names a column of comments that few rows have */
        t->comments = 1;
    }
    for (size_t i = 0; n == t->n_columns && i < n; i++) {
        empty += t->cell[i][0] == '\0';
        units += (size_t)is_unit(t->cell[i]);
        numbers += ss_cell_read(t->cell[i], t->separator, &x) != CELL_TEXT;
    }
    free(copy);
    if (n == NONE)
        return ROW_NO_MEMORY;
    if (n != t->n_columns)
        return ROW_OTHER;
    if (units == n && empty + numbers < n)
        return ROW_UNITS;
    return numbers > 0 ? ROW_MIXED : ROW_NAMES;
}

/* Cut "name (unit)", "name [unit]" or "name/unit" in two. */
static void
split_name(char *cell, char **name, char **unit)
{
    size_t n = strlen(cell);
    char closing = n > 0 ? cell[n - 1] : '\0';
    char *opening = closing == ')' ? strchr(cell, '(') : closing == ']' ? strchr(cell, '[') : NULL;
    if (opening == NULL || opening == cell) {
        ss_split_label(cell, name, unit);
        *name = ss_cell_trim(*name);
        *unit = ss_cell_trim(*unit);
        return;
    }
    cell[n - 1] = '\0';
    if (opening > cell && opening[-1] == '/')
        opening[-1] = '\0';
    *opening = '\0';
    *name = ss_cell_trim(cell);
    *unit = ss_cell_trim(opening + 1);
}

/* A cell of the units row without the brackets around it. */
static char *
bare_unit(char *cell)
{
    size_t n = strlen(cell);
    if (n < 2 || !((cell[0] == '[' && cell[n - 1] == ']') || (cell[0] == '(' && cell[n - 1] == ')')))
        return cell;
    cell[n - 1] = '\0';
    return ss_cell_trim(cell + 1);
}

/* Name the columns by one line and give them the units of another.  Both lines are cut up; either may be
 * NULL. */
static ss_status
name_columns(struct table *t, char *names, char *units)
{
    char **unit_cell = NULL, number[32];
    ss_status st = SS_OK;
    if (units != NULL) {
        if (ss_delimited_split(t, units, t->separator) == NONE)
            return SS_ENOMEM;
        unit_cell = t->cell;                    /* the cells of the names get room of their own */
        t->cell = NULL;
        t->cell_room = 0;
    }
    if (names != NULL && ss_delimited_split(t, names, t->separator) == NONE)
        st = SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < t->n_columns; i++) {
        char *name = "", *unit = "";
        snprintf(number, sizeof number, "ch%zu", i + 1);
        if (names != NULL)
            split_name(t->cell[i], &name, &unit);
        if (units != NULL)
            unit = bare_unit(unit_cell[i]);
        else if (*unit == '\0')
            unit = (char *)ss_unit_of_name(name, NULL);
        st = ss_header_add_column(t->names, *name != '\0' ? name : number, unit);
    }
    free(unit_cell);
    return st;
}

/* Cut a line after its first n cells. */
static void
cut(char *line, size_t n, char separator)
{
    for (; *line != '\0' && n > 0; line++)
        if (*line == separator && --n == 0)
            *line = '\0';
}

/* The text of the kept line that is `up` lines above the last one, which is just above the data; NULL if
 * there is none. */
static char *
line_above(const struct table *t, size_t up)
{
    return t->n_head > up ? t->head[t->n_head - 1 - up].text : NULL;
}

/* Rigol's oscilloscopes number the rows.  Behind the names of their columns they write Start and
 * Increment, and the two times in the line below.  Read the times and cut both lines before them. */
static ss_status
find_increment(struct table *t)
{
    char *above = line_above(t, 1), *last = line_above(t, 0);
    char *words = strdup(above != NULL ? above : ""), *numbers = NULL;
    size_t start = NONE, increment = NONE;
    struct counted counted = { 0, 0, 1 };
    size_t n = words != NULL ? ss_delimited_split(t, words, t->separator) : NONE;
    for (size_t i = t->n_columns; n != NONE && i < n; i++) {
        start = strcasecmp(t->cell[i], "Start") == 0 ? i : start;
        increment = strcasecmp(t->cell[i], "Increment") == 0 ? i : increment;
    }
    if (start != NONE && increment != NONE) {
        numbers = strdup(last);
        n = numbers != NULL ? ss_delimited_split(t, numbers, t->separator) : NONE;
        if (n != NONE && start < n && increment < n
            && ss_cell_read(t->cell[start], t->separator, &counted.origin) == CELL_NUMBER
            && ss_cell_read(t->cell[increment], t->separator, &counted.increment) == CELL_NUMBER) {
            cut(above, t->n_columns, t->separator);
            cut(last, t->n_columns, t->separator);
            if (counted.increment > 0)
                t->counted = counted;
        }
    }
    free(words);
    free(numbers);
    return n != NONE ? SS_OK : SS_ENOMEM;
}

/* Refuse a line with numbers that is a row with a bad cell. */
static ss_status
check_mixed(struct table *t, const char *line, enum row_kind before, ss_error *err)
{
    double x;
    char *copy = strdup(line);
    size_t n = copy != NULL ? ss_delimited_split(t, copy, t->separator) : NONE, bad = n;
    int has_words = 0, begins = n != NONE && ss_cell_read(t->cell[0], t->separator, &x) != CELL_TEXT;
    ss_status st = n != NONE ? SS_OK : ss_delimited_no_memory(t, err);
    for (size_t i = n; st == SS_OK && i-- > 0; )
        if (ss_cell_read(t->cell[i], t->separator, &x) == CELL_TEXT) {
            has_words |= t->cell[i][0] != '\0';
            bad = i;
        }
    if (st == SS_OK && bad < n
        && (begins || !has_words || (before == ROW_NAMES && !ss_delimited_is_key(t->cell[0]))))
        st = ss_fail(err, t->cell[bad][0] != '\0' ? SS_EDATA : SS_EGAPS,
                     "%s:%lu: column %zu: '%.40s' is not a number", t->in->name, t->head[t->n_head - 1].number,
                     bad + 1, t->cell[bad]);
    free(copy);
    return st;
}

ss_status
ss_delimited_read_names(struct table *t, ss_error *err)
{
    char *last_line = line_above(t, 0), *above = line_above(t, 1);
    ss_status st = find_increment(t);
    if (st == SS_OK && t->counted.increment > 0) {
        t->named = 1;
        st = name_columns(t, above, last_line);
        return st == SS_OK ? SS_OK : ss_delimited_no_memory(t, err);
    }
    enum row_kind last = kind_of_row(t, last_line), before = kind_of_row(t, above);
    if (st != SS_OK || last == ROW_NO_MEMORY || before == ROW_NO_MEMORY)
        return ss_delimited_no_memory(t, err);
    if (last == ROW_MIXED) {
        st = check_mixed(t, last_line, before, err);
        if (st != SS_OK)
            return st;
        last = ROW_OTHER;
    }
    t->named = last != ROW_OTHER;
    if (last == ROW_UNITS && before == ROW_NAMES)
        st = name_columns(t, above, last_line);
    else
        st = name_columns(t, t->named ? last_line : NULL, NULL);
    return st == SS_OK ? SS_OK : ss_delimited_no_memory(t, err);
}
