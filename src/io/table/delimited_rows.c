/* delimited_rows.c -- the rows of a text table, which are kept: only all stamps together show the rate, and
 * all cells the gaps. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/number.h"
#include "io/table/delimited.h"
#include "io/table/stamp.h"

/* --- lines --------------------------------------------------------------------------------- */

char
ss_delimited_first_of(const char *line)
{
    while (*line == ' ' || *line == '\t')
        line++;
    return *line;
}

ss_status
ss_delimited_line(struct table *t, char **line, int *comment, ss_error *err)
{
    size_t length;
    do {
        ss_status st = ss_input_line(t->in, line, &length, err);
        if (st != SS_OK || *line == NULL)
            return st;
        if (strlen(*line) != length)
            return ss_fail(err, SS_EDATA, "%s:%lu: a NUL byte: this is not text of 8-bit characters",
                           t->in->name, t->in->line);
        if (strchr(*line, '\r') != NULL)
            return ss_fail(err, SS_EDATA, "%s:%lu: a lone CR; lines end in LF or CRLF (tr '\\r' '\\n' "
                           "makes them)", t->in->name, t->in->line);
    } while (ss_delimited_first_of(*line) == '\0');
    *comment = **line == '#';
    return SS_OK;
}

/* --- cells of a row ------------------------------------------------------------------------ */

/* SS_EDATA if a number has another decimal mark than those before: beside 0.5, 1,234 may be either of two
 * numbers. */
static ss_status
check_mark(struct table *t, size_t column, ss_error *err)
{
    const char *cell = t->cell[column];
    char mark = cell[strcspn(cell, t->separator == ',' ? "." : ".,")];
    if (t->mark == '\0')
        t->mark = mark;
    if (mark == '\0' || mark == t->mark)
        return SS_OK;
    return ss_fail(err, SS_EDATA, "%s:%lu: column %s: '%.40s' has a decimal %s, numbers before it "
                   "have a %s", t->in->name, t->in->line, t->names->column[column].name, cell,
                   mark == ',' ? "comma" : "point", mark == ',' ? "point" : "comma");
}

static int
order_of(const struct table_column *c)
{
    return c->fits[DAY_FIRST] ? DAY_FIRST : MONTH_FIRST;
}

double
ss_delimited_day(const struct table_column *c)
{
    int known = c->dated && !(c->fits[DAY_FIRST] && c->fits[MONTH_FIRST] && c->first[DAY_FIRST] != c->first[MONTH_FIRST]);
    return known ? (double)c->first[order_of(c)] : NAN;
}

/* The days since the first row.  Day and month have the same order in all rows.  A day above 12 shows it, or
 * else, where the date changes, the order in which the next day follows.  NaN: the date fits no order. */
static double
count_days(struct table_column *c, const long day[ORDERS])
{
    if (!c->dated)
        memcpy(c->first, day, sizeof c->first);
    for (int i = 0; i < ORDERS; i++)
        c->fits[i] &= day[i] != NO_DAY;
    if (c->dated && c->fits[DAY_FIRST] && c->fits[MONTH_FIRST]
        && day[DAY_FIRST] - c->first[DAY_FIRST] != day[MONTH_FIRST] - c->first[MONTH_FIRST])
        for (int i = 0; i < ORDERS; i++)
            c->fits[i] = day[i] == c->before[i] + 1;
    memcpy(c->before, day, sizeof c->before);
    c->dated = 1;
    int order = order_of(c);
    return c->fits[order] ? (double)(day[order] - c->first[order]) : NAN;
}

/* The seconds of a stamp since the midnight before the first row.  Times without a date go on at midnight, and those
 * without hours at the hour.  Second 60 is the next minute's second 0 unless that follows, too: then it was a leap
 * second. */
static double
read_stamp(struct table_column *c, const char *cell)
{
    const time_stamp s = ss_stamp_read(cell);
    double seconds = s.seconds;
    if (s.parts != c->parts)
        return NAN;
    if (c->parts & STAMP_DATE)
        seconds += 86400 * count_days(c, s.day);
    else if (!isnan(c->last))                   /* on the day that brings it nearest to the row before */
        seconds += s.turn * floor((c->last - s.seconds) / s.turn + 0.5);
    c->leaps += c->leap && !s.leap && seconds <= c->last;
    c->leap = s.leap;
    c->last = seconds;
    return seconds + c->leaps;
}

/* Give NaN as the value of a column that nobody needs. */
static ss_status
pass_over(struct table *t, size_t column, double *value)
{
    struct table_column *c = &t->column[column];
    if (!c->incomplete)
        ss_delimited_warn(t, SS_OK, "%s:%lu: column %s has no number here; it is not needed, and read as 0 "
                          "where it has none", t->in->name, t->in->line, t->names->column[column].name);
    c->incomplete = 1;
    *value = 0;
    return SS_OK;
}

static unsigned long
first_line(const struct table *t)
{
    return (unsigned long)t->first[t->n_columns];
}

/* Read the value of one cell of the line that was split. */
static ss_status
read_cell(struct table *t, size_t i, double *value, ss_error *err)
{
    struct table_column *c = &t->column[i];
    char *cell = t->cell[i];
    *value = 0;
    if (c->kind == COLUMN_TEXT && !c->begins_empty)
        return SS_OK;
    enum cell_kind kind = ss_cell_read(cell, t->separator, value);
    if (c->kind == COLUMN_TEXT)
        return kind != CELL_NUMBER ? SS_OK : ss_fail(err, SS_EGAPS, "%s:%lu: column %s: '' is not a number",
                                                     t->in->name, first_line(t), t->names->column[i].name);
    int missing = kind == CELL_NOT_FINITE || cell[0] == '\0';
    if (c->spare && kind != CELL_NUMBER)
        return pass_over(t, i, value);
    if (missing && t->opts->gaps != SS_GAPS_REFUSE) {
        *value = NAN;
        return SS_OK;
    }
    if (c->kind == COLUMN_STAMPS && !isnan(*value = read_stamp(c, cell)))
        return SS_OK;
    if (c->kind == COLUMN_NUMBERS && kind == CELL_NUMBER)
        return check_mark(t, i, err);
    const char *what = c->kind == COLUMN_STAMPS ? "time as those above it" : kind == CELL_NOT_FINITE
        ? "finite number" : "number";
    return ss_fail(err, missing ? SS_EGAPS : SS_EDATA, "%s:%lu: column %s: '%.40s' is not a %s",
                   t->in->name, t->in->line, t->names->column[i].name, cell, what);
}

/* Read a row of plain numbers only, as most are.  Returns 0 if the row must be read cell by cell. */
static int
read_plain(const struct table *t, char *p, double *row)
{
    const char point = t->separator == ',' || t->mark == '\0' ? '.' : t->mark;
    char *end;
    if (t->separator != ',' && t->mark == '\0' && strpbrk(p, ".,") != NULL)
        return 0;
    for (size_t i = 0; i < t->n_columns; i++, p = end + 1) {
        while (*p == ' ')
            p++;
        const char *digit = p + (*p == '-');
        if (t->column[i].kind != COLUMN_NUMBERS || *digit < '0' || *digit > '9')
            return 0;
        row[i] = ss_number_parse_point(p, point, &end);
        if (*end != (i + 1 < t->n_columns ? t->separator : '\0') || !isfinite(row[i]))
            return 0;
    }
    return 1;
}

static ss_status
parse_row(struct table *t, char *text, double *row, ss_error *err)
{
    if (read_plain(t, text, row))
        return SS_OK;
    size_t n = ss_delimited_split(t, text, t->separator);
    if (n == NONE)
        return ss_delimited_no_memory(t, err);
    if (n != t->n_columns && !(n == t->n_columns + 1 && (t->comments || t->labview)))
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu column%s, found %zu", t->in->name,
                       t->in->line, t->n_columns, PLURAL(t->n_columns), n);
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < t->n_columns; i++)
        st = read_cell(t, i, &row[i], err);
    return st;
}

/* --- rows that are kept -------------------------------------------------------------------- */

void
ss_delimited_begin_rows(struct table *t)
{
    ss_kept_begin(&t->rows, t->in->name, t->opts->folder, t->n_columns + 1);
}

ss_status
ss_delimited_new_row(struct table *t, double **row, ss_error *err)
{
    ss_status st = ss_kept_new(&t->rows, row, err);
    if (st == SS_OK)
        (*row)[t->n_columns] = (double)t->in->line;
    return st;
}

ss_status
ss_delimited_add_row(struct table *t, const double *row, ss_error *err)
{
    ss_kept_add(&t->rows);
    if (t->rows.n > 1)
        return SS_OK;
    free(t->first);
    t->first = malloc((t->n_columns + 1) * sizeof *t->first);
    if (t->first == NULL)
        return ss_delimited_no_memory(t, err);
    memcpy(t->first, row, (t->n_columns + 1) * sizeof *t->first);
    return SS_OK;
}

ss_status
ss_delimited_begin_numbers(struct table *t, uint64_t i, double **row, ss_error *err)
{
    t->in->line = (unsigned long)i + 1;
    return ss_delimited_new_row(t, row, err);
}

ss_status
ss_delimited_add_numbers(struct table *t, uint64_t i, double *row, ss_error *err)
{
    for (size_t c = 0; c < t->n_columns; c++) {
        if (isfinite(row[c]))
            continue;
        if (t->opts->gaps == SS_GAPS_REFUSE)
            return ss_fail(err, SS_EGAPS, "%s: row %llu, column %s: not a finite number", t->in->name,
                           (unsigned long long)i + 1, t->names->column[c].name);
        row[c] = NAN;
    }
    return ss_delimited_add_row(t, row, err);
}

ss_status
ss_delimited_read_row(struct table *t, char *text, const double **row, ss_error *err)
{
    double *new_row;
    ss_status st = ss_delimited_new_row(t, &new_row, err);
    if (st == SS_OK)
        st = parse_row(t, text, new_row, err);
    *row = new_row;
    return st == SS_OK ? ss_delimited_add_row(t, new_row, err) : st;
}

ss_status
ss_delimited_rewind(struct table *t, ss_error *err)
{
    return ss_kept_rewind(&t->rows, err);
}

ss_status
ss_delimited_next(struct table *t, const double **row, ss_error *err)
{
    ss_status st;
    do
        st = ss_kept_next(&t->rows, row, err);
    while (*row != NULL && t->time.column != NONE && isnan((*row)[t->time.column]));
    return st;
}

void
ss_delimited_free_rows(struct table *t)
{
    ss_kept_free(&t->rows);
    free(t->first);
}
