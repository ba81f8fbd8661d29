/* delimited.c -- text tables of data-acquisition systems.
 *
 * The first line with nothing but numbers begins the data and shows the separator; the lines above
 * it are searched for names and units, and one column becomes the clock.  The whole table is read
 * first, as only all stamps together show the rate.  A line of words below the rows begins another
 * table if rows follow it again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "base/number.h"
#include "base/utf8.h"
#include "signal/gaps.h"
#include "signal/header.h"
#include "stream/csv.h"
#include "stream/delimited.h"
#include "stream/format.h"
#include "stream/reader.h"
#include "stream/stamp.h"

enum { HEADER_LINES = 1000 };

/* --- lines --------------------------------------------------------------------------------- */

static ss_status
keep_line(struct table *t, const char *line, int comment, ss_error *err)
{
    struct table_line *more = ss_list_room(t->head, &t->head_room, t->n_head, sizeof *more);
    char *copy = more != NULL ? ss_utf8_text(line) : NULL;
    t->head = more != NULL ? more : t->head;
    if (copy == NULL)
        return ss_delimited_no_memory(t, err);
    more[t->n_head++] = (struct table_line){ copy, t->in->line, comment };
    return SS_OK;
}

static void
drop_lines(struct table *t)
{
    for (size_t i = 0; i < t->n_head; i++)
        free(t->head[i].text);
    t->n_head = 0;
}

/* The first letter that is no blank. */
static char
first_of(const char *line)
{
    while (*line == ' ' || *line == '\t')
        line++;
    return *line;
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
    } while (first_of(*line) == '\0');
    *comment = **line == '#';
    return SS_OK;
}

/* Keep the lines above the first row of data, which becomes *row; NULL: there is none. */
static ss_status
keep_header(struct table *t, char **row, ss_error *err)
{
    int comment = 0, found = 0;
    char *line;
    *row = NULL;
    while (t->n_head < HEADER_LINES) {
        ss_status st = next_line(t, &line, &comment, err);
        if (st != SS_OK || line == NULL)
            return st;
        t->labview |= t->in->line == 1 && strncmp(line, "LabVIEW Measurement", 19) == 0;
        if (!comment && ss_delimited_is_data(t, line, &found) != SS_OK)
            return ss_delimited_no_memory(t, err);
        if (found) {
            *row = line;
            return SS_OK;
        }
        st = keep_line(t, line + (comment ? strspn(line, "# ") : 0), comment, err);
        if (st != SS_OK)
            return st;
    }
    return SS_OK;
}

/* --- rows ---------------------------------------------------------------------------------- */

/* Room for one more row, and its line. */
static int
make_room(struct table *t)
{
    size_t room = t->room;
    double *value = ss_list_room(t->value, &room, t->n_rows, t->n_columns * sizeof *value);
    t->value = value != NULL ? value : t->value;
    unsigned long *line = ss_list_room(t->line, &t->room, t->n_rows, sizeof *line);
    t->line = line != NULL ? line : t->line;
    return value != NULL && line != NULL;
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

/* The seconds of a stamp: of the day without a date, and going on at midnight; else from the midnight
 * before the first row. */
static double
read_stamp(struct table_column *c, const char *cell)
{
    const time_stamp s = ss_stamp_read(cell);
    if (s.parts != c->parts)
        return NAN;
    if (c->parts & STAMP_DATE) {
        if (isnan(c->day))
            c->day = (double)s.day;
        return 86400 * ((double)s.day - c->day) + s.seconds;
    }
    double days = isnan(c->last) ? 0 : floor((c->last - s.seconds) / 86400 + 0.5);
    return c->last = s.seconds + 86400 * days;  /* the nearest to the row before */
}

/* The value of one cell of the line that was split. */
static ss_status
read_cell(struct table *t, size_t i, double *value, ss_error *err)
{
    struct table_column *c = &t->column[i];
    char *cell = t->cell[i];
    *value = 0;
    if (c->kind == COLUMN_TEXT)
        return SS_OK;
    enum cell_kind kind = ss_cell_read(cell, t->separator, value);
    int missing = kind == CELL_NOT_FINITE || cell[0] == '\0';
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

/* Read a row of nothing but plain numbers, as most are; 0: it must be looked at cell by cell. */
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
append_row(struct table *t, char *text, ss_error *err)
{
    if (!make_room(t))
        return ss_delimited_no_memory(t, err);
    t->line[t->n_rows] = t->in->line;
    if (read_plain(t, text, t->value + t->n_rows * t->n_columns)) {
        t->n_rows++;
        return SS_OK;
    }
    size_t n = ss_delimited_split(t, text, t->separator);
    if (n == NONE)
        return ss_delimited_no_memory(t, err);
    if (n != t->n_columns && !(n == t->n_columns + 1 && (t->comments || t->labview)))
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu columns, found %zu", t->in->name,
                       t->in->line, t->n_columns, n);
    double *row = t->value + t->n_rows * t->n_columns;
    for (size_t i = 0; i < t->n_columns; i++) {
        ss_status st = read_cell(t, i, &row[i], err);
        if (st != SS_OK)
            return st;
    }
    t->n_rows++;
    return SS_OK;
}

/* Find the kinds of the columns, as the cells of the first row show. */
static ss_status
find_kinds(struct table *t, const char *row, ss_error *err)
{
    size_t numbers;
    char *shape = ss_delimited_shape(t, row, t->separator, &numbers), *copy = strdup(row);
    t->column = calloc(t->n_columns, sizeof *t->column);
    ss_status st = shape != NULL && copy != NULL && t->column != NULL
        && ss_delimited_split(t, copy, t->separator) != NONE ? SS_OK : ss_delimited_no_memory(t, err);
    for (size_t i = 0; st == SS_OK && i < t->n_columns; i++) {
        unsigned parts = ss_stamp_read(t->cell[i]).parts;
        int text = shape[i] == 't' || (shape[i] == 'e' && t->opts->gaps == SS_GAPS_REFUSE);
        t->column[i] = (struct table_column){ text ? COLUMN_TEXT : parts != 0 ? COLUMN_STAMPS
                                              : COLUMN_NUMBERS, parts, NAN, NAN };
    }
    free(shape);
    free(copy);
    return st;
}

static void
warn_of_text(const struct table *t, const char *row)
{
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_TEXT && !(t->labview && row[0] == '\t' && i == 0))
            ss_delimited_warn(t, SS_OK, "%s:%lu: column %zu (\"%s\") holds text; it was skipped",
                              t->in->name, t->in->line, i + 1, t->names->column[i].name);
}

/* Begin a table with this row, below the lines that were kept. */
static ss_status
begin_table(struct table *t, const char *row, ss_error *err)
{
    if (t->n_columns > MAX_COLUMNS)
        return ss_fail(err, SS_EDATA, "%s:%lu: more than 32768 columns", t->in->name, t->in->line);
    char *first = strdup(row);                  /* split below, and for the names */
    ss_status st = first != NULL ? find_kinds(t, first, err) : ss_delimited_no_memory(t, err);
    if (st == SS_OK)
        st = ss_delimited_read_names(t, err);
    if (st == SS_OK)
        st = ss_delimited_read_labview(t, err);
    if (st == SS_OK) {
        warn_of_text(t, first);
        st = append_row(t, first, err);
    }
    free(first);
    return st;
}

/* Begin a table with this of the kept lines, and those below it. */
static ss_status
begin_kept(struct table *t, size_t first, ss_error *err)
{
    size_t n = t->n_head;
    unsigned long line = t->in->line;
    t->n_head = first;                          /* for the names */
    t->in->line = t->head[first].number;
    ss_status st = begin_table(t, t->head[first].text, err);
    for (size_t i = first + 1; st == SS_OK && i < n; i++) {
        t->in->line = t->head[i].number;
        st = t->head[i].comment ? SS_OK : append_row(t, t->head[i].text, err);
    }
    t->n_head = n;
    if (st == SS_OK)
        t->in->line = line;
    return st;
}

/* Begin with the first row of numbers.  If there is none, or a line of words and numbers stands
 * above it, begin with the first of the lines that are alike. */
static ss_status
begin_first(struct table *t, const char *row, ss_error *err)
{
    size_t columns = t->n_columns, first;
    char separator = t->separator;
    int mixed = 1;
    if (row != NULL && ss_delimited_ends_mixed(t, &mixed) != SS_OK)
        return ss_delimited_no_memory(t, err);
    if (!mixed)
        return begin_table(t, row, err);
    ss_status st = row != NULL ? keep_line(t, row, 0, err) : SS_OK;
    if (st != SS_OK)
        return st;
    first = ss_delimited_find_mixed(t);
    if (first == NONE)
        return ss_delimited_no_memory(t, err);
    if (first < t->n_head)
        return begin_kept(t, first, err);
    if (row == NULL)
        return ss_fail(err, SS_EDATA, "%s:%lu: no row of numbers up to here; a table has them "
                       "between commas, semicolons, tabs or blanks", t->in->name, t->in->line);
    t->n_columns = columns;
    t->separator = separator;
    return begin_kept(t, t->n_head - 1, err);
}

/* May this line be a heading, and no row? */
static ss_status
is_heading(struct table *t, const char *line, int *yes, ss_error *err)
{
    size_t numbers;
    *yes = 0;
    if (strchr("0123456789-.+", first_of(line)) != NULL)
        return SS_OK;
    char *shape = ss_delimited_shape(t, line, t->separator, &numbers);
    if (shape == NULL)
        return ss_delimited_no_memory(t, err);
    size_t n = strlen(shape);
    if (shape[0] == 't' && t->column[0].kind != COLUMN_TEXT)
        *yes = n != t->n_columns || (n > 1 && strchr(shape, 'n') == NULL);
    *yes |= ss_delimited_is_segment(t, line);
    free(shape);
    return SS_OK;
}

/* Keep the lines from a heading on, up to the first row of another table, which becomes *row.  If none
 * follows, the heading is a malformed row. */
static ss_status
look_below(struct table *t, const char *heading, char **row, ss_error *err)
{
    unsigned long number = t->in->line;
    size_t columns = t->n_columns;
    char separator = t->separator;
    drop_lines(t);
    ss_status st = keep_line(t, heading, 0, err);
    if (st == SS_OK)
        st = keep_header(t, row, err);
    t->next_columns = t->n_columns;
    t->next_separator = t->separator;
    t->n_columns = columns;
    t->separator = separator;
    if (st != SS_OK || *row != NULL)
        return st;
    t->in->line = number;
    return append_row(t, t->head[0].text, err);
}

/* Read rows up to the end, or up to the first row of another table, which becomes *row. */
static ss_status
read_body(struct table *t, char **row, ss_error *err)
{
    char *line;
    int comment, heading = 0;
    ss_status st;
    *row = NULL;
    while ((st = next_line(t, &line, &comment, err)) == SS_OK && line != NULL) {
        if (!comment)
            st = is_heading(t, line, &heading, err);
        if (st == SS_OK && heading)
            return look_below(t, line, row, err);
        if (st == SS_OK && !comment)
            st = append_row(t, line, err);
        if (st != SS_OK)
            return st;
    }
    return st;
}

/* --- a table that is read twice ------------------------------------------------------------- */

enum { PIECE = 4096 };          /* rows that are read again at a time */

static int
may_read_twice(const struct table *t)
{
    const ss_read_opts *opts = t->opts;
    return opts->gaps == SS_GAPS_REFUSE && !(opts->resample > 0) && opts->table == 0 && !t->labview
        && !(t->counted.increment > 0);
}

/* Add the stamp of a row to the clock; 0 if it is not later than the one before. */
static int
add_stamp(struct table *t, struct time_column time, size_t row)
{
    if (time.column == NONE)
        return 1;
    double stamp = t->value[row * t->n_columns + time.column] * time.factor / time.divisor;
    return (t->fit.n == 0 || stamp > t->fit.last.stamp) && ss_clock_add(&t->fit, (double)t->fit.n, stamp);
}

/* Add the last n rows to the sum that shows whether they are the same when they are read again. */
static void
add_to_sum(struct table *t, size_t n)
{
    uint64_t bits;
    for (size_t i = (t->n_rows - n) * t->n_columns; i < t->n_rows * t->n_columns; i++) {
        memcpy(&bits, &t->value[i], sizeof bits);
        t->sum = (t->sum ^ bits) * UINT64_C(0x9e3779b97f4a7c15);
        t->sum ^= t->sum >> 32;
    }
}

/* Keep the sum of a piece that is full, or of the last one. */
static int
keep_sum(struct table *t)
{
    uint64_t *more = ss_list_room(t->sums, &t->sums_room, t->n_sums, sizeof *more);
    if (more == NULL)
        return 0;
    t->sums = more;
    more[t->n_sums++] = t->sum;
    t->sum = 0;
    return 1;
}

/* Check all rows, and find their clock, keeping none but the first.  Sets t->twice unless there is
 * another table or the clock is not uniform. */
static ss_status
survey(struct table *t, ss_error *err)
{
    const struct time_column time = ss_delimited_time(t);
    size_t kept = t->n_rows;
    int comment, heading = 0, even = 1;
    double rate;
    char *line;
    for (size_t i = 0; even && i < kept; i++)
        even = add_stamp(t, time, i);
    while (even) {
        ss_status st = next_line(t, &line, &comment, err);
        if (st == SS_OK && line != NULL && !comment)
            st = is_heading(t, line, &heading, err);
        if (st != SS_OK || heading)
            return st;
        if (line == NULL)
            break;
        if (comment)
            continue;
        if ((st = append_row(t, line, err)) != SS_OK)
            return st;
        even = add_stamp(t, time, kept);
        add_to_sum(t, 1);
        t->n_rows = kept;
        if (++t->left % PIECE == 0 && !keep_sum(t))
            return ss_delimited_no_memory(t, err);
    }
    if (!keep_sum(t))
        return ss_delimited_no_memory(t, err);
    t->twice = even && (time.column == NONE || ss_clock_rate(&t->fit, t->in->name, &rate, NULL) == SS_OK);
    return SS_OK;
}

/* Survey a table that can be read again, and return to the line below the rows that are kept. */
static ss_status
try_twice(struct table *t, ss_error *err)
{
    off_t place = may_read_twice(t) ? ss_input_place(t->in) : -1;
    unsigned long line = t->in->line;
    char mark = t->mark;
    if (place < 0)
        return SS_OK;
    ss_status st = survey(t, err);
    const double *last = t->value + (t->n_rows - 1) * t->n_columns;
    t->mark = mark;
    for (size_t i = 0; st == SS_OK && i < t->n_columns; i++)    /* times of day go on from there */
        t->column[i].last = last[i];
    return st == SS_OK ? ss_input_return(t->in, place, line, err) : st;
}

/* Leave the columns that are not kept out of the rows. */
static void
drop_columns(struct table *t)
{
    size_t to = 0;
    for (size_t i = 0; i < t->n_rows; i++)
        for (size_t c = 0; c < t->n_kept; c++)
            t->value[to++] = t->value[i * t->n_columns + t->kept[c]];
}

/* Read rows again, as many as fit into a piece.  Rows that a recorder has appended since are not
 * read. */
static ss_status
read_piece(ss_reader *reader, struct table *t, ss_error *err)
{
    char *line;
    int comment;
    ss_status st = SS_OK;
    t->value = reader->values;
    t->n_rows = 0;
    while (st == SS_OK && t->n_rows < PIECE && t->n_rows < t->left
           && (st = next_line(t, &line, &comment, err)) == SS_OK) {
        if (line == NULL)
            st = ss_fail(err, SS_EDATA, "%s:%lu: the file has become shorter while it was read", t->in->name,
                         t->in->line);
        else if (!comment)
            st = append_row(t, line, err);
    }
    if (st == SS_OK && t->n_rows > 0) {
        add_to_sum(t, t->n_rows);
        if (t->sum != t->sums[t->piece++])
            st = ss_fail(err, SS_EDATA, "%s:%lu: the rows up to here have changed while the file was read",
                         t->in->name, t->in->line);
        t->sum = 0;
    }
    t->left -= t->n_rows;
    drop_columns(t);
    reader->values = t->value;
    reader->n_rows = t->n_rows;
    reader->next = 0;
    t->value = NULL;
    return st;
}

/* --- several tables ------------------------------------------------------------------------- */

/* Forget the rows and columns of a table before the next. */
static ss_status
clear_table(struct table *t, ss_error *err)
{
    free(t->column);
    free(t->value);
    free(t->line);
    ss_header_free(t->names);
    t->column = NULL;
    t->value = NULL;
    t->line = NULL;
    t->n_rows = t->room = 0;
    t->mark = '\0';
    t->n_columns = t->next_columns;
    t->separator = t->next_separator;
    t->counted = (struct counted){ 0, 0, 0 };
    t->named = t->comments = 0;
    t->names = ss_header_new(0, 0);
    return t->names != NULL ? SS_OK : ss_delimited_no_memory(t, err);
}

/* Append a description of a table: "2 from line 17, 1200 rows of t Fx Fz". */
static void
list_table(const struct table *t, size_t number, char *list, size_t size)
{
    size_t n = strlen(list);
    int more = snprintf(list + n, size - n, "%s%zu from line %lu, %zu rows of", number > 1 ? "; " : "",
                        number, t->line[0], t->n_rows);
    for (size_t c = 0; c < t->n_columns && more >= 0 && n + (size_t)more < size; c++) {
        n += (size_t)more;
        more = snprintf(list + n, size - n, " %s", t->names->column[c].name);
    }
}

static ss_status
read_table(struct table *t, ss_error *err)
{
    char *row, list[300] = "";
    size_t number = 1, wanted = t->opts->table;
    ss_status st = keep_header(t, &row, err);
    if (st == SS_OK)
        st = begin_first(t, row, err);
    if (st == SS_OK)
        st = try_twice(t, err);
    if (t->twice)
        return st;
    for (; st == SS_OK && (st = read_body(t, &row, err)) == SS_OK && row != NULL; number++) {
        if (number == wanted)
            return SS_OK;
        list_table(t, number, list, sizeof list);
        st = clear_table(t, err);
        if (st == SS_OK)
            st = begin_table(t, row, err);
    }
    if (st != SS_OK || number == wanted || (number == 1 && wanted == 0))
        return st;
    list_table(t, number, list, sizeof list);
    return ss_fail(err, SS_ETABLES, "%s: %zu table%s: %s", t->in->name, number, number > 1 ? "s" : "", list);
}

/* --- as a reader --------------------------------------------------------------------------- */

/* Keep all columns but that of time and those of text or other stamps, with their names in *head. */
static ss_status
keep_columns(struct table *t, ss_header **head)
{
    t->kept = malloc(t->n_columns * sizeof *t->kept);
    if (t->kept == NULL)
        return SS_ENOMEM;
    for (size_t c = 0; c < t->n_columns; c++)
        if (c != t->time && t->column[c].kind == COLUMN_NUMBERS)
            t->kept[t->n_kept++] = c;
    ss_header_free(*head);
    ss_status st = ss_header_select(head, t->names, t->kept, t->n_kept, 0);
    drop_columns(t);
    return st;
}

/* Errors of rows were found at the start, unless the file changes. */
static ss_status
table_rows(ss_reader *reader, double *rows, size_t max, size_t *n, ss_error *err)
{
    ss_status st = SS_OK;
    if (reader->next == reader->n_rows && reader->table != NULL)
        st = read_piece(reader, reader->table, err);
    if (st != SS_OK)
        return st;
    ss_reader_give(reader, rows, max, n);
    return SS_OK;
}

ss_status
ss_delimited_finish(struct table *t, ss_reader *reader, ss_error *err)
{
    ss_status st = ss_delimited_choose_clock(t, err);
    if (st == SS_OK && keep_columns(t, &reader->head) != SS_OK)
        st = ss_delimited_no_memory(t, err);
    size_t columns = reader->head != NULL ? reader->head->n_columns : 0;
    if (st == SS_OK && columns == 0)
        st = ss_fail(err, SS_EDATA, "%s: no column but time", t->in->name);
    if (st == SS_OK && t->opts->gaps != SS_GAPS_REFUSE)
        st = ss_fill_gaps(t->value, t->n_rows, columns, 1, reader->head, t->opts->gaps, t->in->name, err);
    if (st != SS_OK)
        return st;
    reader->values = t->value;
    reader->n_rows = t->n_rows;
    reader->rows = table_rows;
    t->value = NULL;
    return SS_OK;
}

void
ss_delimited_free(struct table *t)
{
    if (t == NULL)
        return;
    drop_lines(t);
    free(t->head);
    free(t->column);
    free(t->cell);
    free(t->value);
    free(t->line);
    free(t->kept);
    free(t->sums);
    ss_clock_free(&t->fit);
    ss_header_free(t->names);
}

static ss_status
open_text(struct table *t, ss_reader *reader, ss_error *err)
{
    struct input *in = t->in;
    ss_status st = ss_input_need(in, 3, err);
    if (st == SS_OK && in->hi - in->lo >= 3 && memcmp(in->buffer + in->lo, "\xef\xbb\xbf", 3) == 0)
        in->lo += 3;                            /* a byte-order mark */
    if (st == SS_OK && t->names == NULL)
        st = ss_delimited_no_memory(t, err);
    if (st == SS_OK)
        st = read_table(t, err);
    if (st == SS_OK)
        st = ss_delimited_check_labview(t, err);
    return st == SS_OK ? ss_delimited_finish(t, reader, err) : st;
}

static ss_status
open_table(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    static const ss_read_opts none;             /* for rows that are read again */
    struct table *t = malloc(sizeof *t);
    if (t == NULL)
        return ss_fail_memory(err, reader->in.name);
    *t = (struct table){ .in = &reader->in, .opts = opts, .time = NONE, .layout = LAYOUT_ONE,
                         .names = ss_header_new(0, 0) };
    ss_status st = open_text(t, reader, err);
    t->opts = &none;
    if (st == SS_OK && t->twice) {
        reader->table = t;
        return SS_OK;
    }
    ss_delimited_free(t);
    free(t);
    return st;
}

const struct format ss_format_delimited = {
    .name = "csv",
    .open = open_table,
    .begin = ss_csv_begin,
    .number = ss_csv_number,
    .has_time = 1,
    .separator = ',',
    .word = ss_csv_word,
};
