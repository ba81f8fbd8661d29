/* delimited.c -- text tables of data-acquisition systems.
 *
 * The first line with nothing but numbers begins the data and shows the separator; the lines above
 * it are searched for names and units, and one column becomes the clock.  The whole table is read
 * first, as only all stamps together show the rate. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/utf8.h"
#include "signal/gaps.h"
#include "signal/header.h"
#include "stream/delimited.h"
#include "stream/format.h"
#include "stream/reader.h"

enum { HEADER_LINES = 1000 };

/* --- rows ---------------------------------------------------------------------------------- */

/* Is this the first line of data?  Then t->separator and t->n_columns are set. */
static ss_status
is_data(struct table *t, const char *line, int *yes)
{
    static const char candidate[] = { '\t', ';', ',', ' ' };
    *yes = 0;
    for (size_t i = 0; i < sizeof candidate; i++) {
        size_t n = strchr(line, candidate[i]) != NULL || candidate[i] == ' '
                 ? ss_delimited_count_numbers(t, line, candidate[i]) : 0;
        if (n == NONE)
            return SS_ENOMEM;
        if (n > 1 || (n == 1 && (candidate[i] == ';' || candidate[i] == ' '))) {
            t->separator = n > 1 || candidate[i] == ';' ? candidate[i] : '\0';
            t->n_columns = n;
            *yes = 1;
            return SS_OK;
        }
    }
    return SS_OK;
}

static int
keep_above(struct table *t, const char *line)
{
    free(t->above[0]);
    t->above[0] = t->above[1];
    t->above_line[0] = t->above_line[1];
    t->above[1] = ss_utf8_text(line);
    t->above_line[1] = t->in->line;
    return t->above[1] != NULL;
}

/* The next line that is not empty; comment is set if it is one.  NULL at the end. */
static ss_status
next_line(struct table *t, char **line, int *comment, ss_error *err)
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
    } while ((*line)[strspn(*line, " \t")] == '\0');
    *comment = **line == '#';
    return SS_OK;
}

static int
make_room(struct table *t)
{
    if (t->n_rows < t->room)
        return 1;
    size_t room = t->room == 0 ? 1 + 65536 / t->n_columns : 2 * t->room;
    if (room > SIZE_MAX / sizeof *t->value / t->n_columns / 2)
        return 0;
    double *value = realloc(t->value, room * t->n_columns * sizeof *value);
    if (value != NULL)
        t->value = value;
    unsigned long *line = realloc(t->line, room * sizeof *line);
    if (line != NULL)
        t->line = line;
    if (value == NULL || line == NULL)
        return 0;
    t->room = room;
    return 1;
}

/* Numbers of one file have one decimal mark: 1,234 beside 0.5 may be either of two numbers. */
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

static ss_status
append_row(struct table *t, char *text, ss_error *err)
{
    const char *name = t->in->name;
    unsigned long line = t->in->line;
    size_t n = ss_delimited_split(t, text, t->separator);
    if (n == NONE || !make_room(t))
        return ss_delimited_no_memory(t, err);
    if (n != t->n_columns)
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu columns, found %zu", name, line,
                       t->n_columns, n);
    double *row = t->value + t->n_rows * n;
    for (size_t i = 0; i < n; i++) {
        enum cell_kind kind = ss_cell_read(t->cell[i], t->separator, &row[i]);
        int missing = kind == CELL_NOT_FINITE || t->cell[i][0] == '\0';
        if (missing && t->opts->gaps != SS_GAPS_REFUSE) {
            row[i] = NAN;
            continue;
        }
        if (kind != CELL_NUMBER)
            return ss_fail(err, missing ? SS_EGAPS : SS_EDATA, "%s:%lu: column %s: '%.40s' is not a "
                           "%snumber", name, line, t->names->column[i].name, t->cell[i],
                           kind == CELL_NOT_FINITE ? "finite " : "");
        ss_status st = check_mark(t, i, err);
        if (st != SS_OK)
            return st;
    }
    t->line[t->n_rows++] = line;
    return SS_OK;
}

static ss_status
read_table(struct table *t, ss_error *err)
{
    char *line;
    int comment = 0, found = 0;
    ss_status st = SS_OK;
    for (int i = 0; !found; i++) {
        st = next_line(t, &line, &comment, err);
        if (st != SS_OK)
            return st;
        if (line == NULL || i == HEADER_LINES)
            return ss_fail(err, SS_EDATA, "%s:%lu: no row of numbers up to here; a table has them "
                           "between commas, semicolons, tabs or blanks", t->in->name,
                           t->in->line);
        if (!comment && is_data(t, line, &found) != SS_OK)
            return ss_delimited_no_memory(t, err);
        if (!found && !keep_above(t, line + strspn(line, "# ")))
            return ss_delimited_no_memory(t, err);
    }
    if (t->n_columns > MAX_COLUMNS)
        return ss_fail(err, SS_EDATA, "%s:%lu: more than 32768 columns", t->in->name, t->in->line);
    char *first = strdup(line);                 /* split below, and for the names */
    if (first == NULL)
        return ss_delimited_no_memory(t, err);
    st = ss_delimited_read_names(t, err);
    if (st == SS_OK)
        st = append_row(t, first, err);
    free(first);
    while (st == SS_OK && (st = next_line(t, &line, &comment, err)) == SS_OK && line != NULL)
        if (!comment)
            st = append_row(t, line, err);
    return st;
}

/* --- as a reader --------------------------------------------------------------------------- */

/* Leave the column of time out of the names, which become *head, and of the rows. */
static ss_status
drop_time(struct table *t, ss_header **head)
{
    size_t kept = 0, n = 0, *column = malloc(t->n_columns * sizeof *column);
    if (column == NULL)
        return SS_ENOMEM;
    for (size_t c = 0; c < t->n_columns; c++)
        if (c != t->time)
            column[n++] = c;
    ss_header_free(*head);
    ss_status st = ss_header_select(head, t->names, column, n, 0);
    free(column);
    for (size_t i = 0; i < t->n_rows * t->n_columns; i++)
        if (i % t->n_columns != t->time)
            t->value[kept++] = t->value[i];
    return st;
}

static ss_status
table_rows(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err)
{
    size_t columns = reader->head->n_columns, left = reader->n_rows - (size_t)reader->row;
    (void)err;                                  /* all errors were found at the start */
    *n = left < max ? left : max;
    memcpy(rows, reader->values + reader->row * columns, *n * columns * sizeof *rows);
    reader->row += *n;
    return SS_OK;
}

static void
free_table(struct table *t)
{
    free(t->cell);
    free(t->above[0]);
    free(t->above[1]);
    free(t->value);
    free(t->line);
    ss_header_free(t->names);
}

static ss_status
open_table(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    struct input *in = &reader->in;
    struct table t = { .in = in, .opts = opts, .time = NONE, .names = ss_header_new(0, 0) };
    ss_status st = ss_input_need(in, 3, err);
    if (st == SS_OK && in->hi - in->lo >= 3 && memcmp(in->buffer + in->lo, "\xef\xbb\xbf", 3) == 0)
        in->lo += 3;                            /* a byte-order mark */
    if (st == SS_OK && t.names == NULL)
        st = ss_delimited_no_memory(&t, err);
    if (st == SS_OK)
        st = read_table(&t, err);
    if (st == SS_OK)
        st = ss_delimited_choose_clock(&t, err);
    if (st == SS_OK && t.time != NONE && t.n_columns == 1)
        st = ss_fail(err, SS_EDATA, "%s: no column but time", in->name);
    if (st == SS_OK && drop_time(&t, &reader->head) != SS_OK)
        st = ss_delimited_no_memory(&t, err);
    size_t columns = reader->head != NULL ? reader->head->n_columns : 0;
    if (st == SS_OK && opts->gaps != SS_GAPS_REFUSE)
        st = ss_fill_gaps(t.value, t.n_rows, columns, 1, reader->head, opts->gaps, in->name, err);
    if (st == SS_OK) {
        reader->values = t.value;
        reader->n_rows = t.n_rows;
        reader->rows = table_rows;
        t.value = NULL;
    }
    free_table(&t);
    return st;
}

const struct format ss_format_delimited = { .name = "csv", .open = open_table };
