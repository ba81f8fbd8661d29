/* delimited.c -- text tables of data-acquisition systems.
 *
 * The first line with nothing but numbers begins the data and shows the separator; the lines above
 * it are searched for names and units, and one column becomes the clock.  A line of words below the rows
 * begins another table if rows follow it again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "base/number.h"
#include "base/utf8.h"
#include "signal/header.h"
#include "io/csv.h"
#include "io/table/delimited.h"
#include "io/format.h"
#include "io/reader.h"
#include "io/table/stamp.h"

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

/* Keep the lines above the first row of data.  *row becomes this row; NULL: there is none. */
static ss_status
keep_header(struct table *t, char **row, ss_error *err)
{
    int comment = 0, found = 0;
    char *line;
    *row = NULL;
    while (t->n_head < HEADER_LINES) {
        ss_status st = ss_delimited_line(t, &line, &comment, err);
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

/* Add the stamp of a row to the clock. */
static ss_status
add_stamp(struct table *t, const double *row, ss_error *err)
{
    struct time_column *c = &t->fitted;
    if (t->rows.n == 1) {
        *c = ss_delimited_time(t);
        t->ascends = c->column != NONE;
        t->fit.taken = c->zero * c->factor / c->divisor;
    }
    if (!t->ascends)
        return SS_OK;
    double stamp = ss_delimited_stamp(c, row);
    t->ascends = t->fit.n == 0 || stamp > t->fit.last.stamp;
    return !t->ascends || ss_clock_add(&t->fit, (double)t->fit.n, stamp) ? SS_OK : ss_delimited_no_memory(t, err);
}

static ss_status
append_row(struct table *t, char *text, ss_error *err)
{
    const double *row;
    ss_status st = ss_delimited_read_row(t, text, &row, err);
    return st == SS_OK ? add_stamp(t, row, err) : st;
}

/* Find the kinds of the columns from the cells of the first row. */
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
        int empty = shape[i] == 'e' && !ss_delimited_may_lack(t);
        enum column_kind kind = shape[i] == 't' || empty ? COLUMN_TEXT : parts != 0 ? COLUMN_STAMPS : COLUMN_NUMBERS;
        t->column[i] = (struct table_column){ .kind = kind, .begins_empty = empty && !t->labview, .parts = parts,
                                              .fits = { 1, 1 }, .last = NAN };
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
            ss_delimited_warn(t, SS_OK, "%s:%lu: column %zu (\"%s\") %s; it was skipped", t->in->name, t->in->line,
                              i + 1, t->names->column[i].name, t->column[i].begins_empty ? "is empty" : "holds text");
}

/* Begin a table with this row, below the lines that were kept. */
static ss_status
begin_table(struct table *t, const char *row, ss_error *err)
{
    if (t->n_columns > MAX_COLUMNS)
        return ss_fail(err, SS_EDATA, "%s:%lu: more than 32768 columns", t->in->name, t->in->line);
    char *first = strdup(row);                  /* row may lie in what is split below */
    ss_status st = first != NULL ? find_kinds(t, first, err) : ss_delimited_no_memory(t, err);
    if (st == SS_OK)
        st = ss_delimited_read_names(t, err);
    if (st == SS_OK)
        st = ss_delimited_read_labview(t, err);
    if (st == SS_OK)
        st = ss_delimited_mark_spare(t, err);
    if (st == SS_OK) {
        warn_of_text(t, first);
        ss_delimited_begin_rows(t);
        st = append_row(t, first, err);
    }
    free(first);
    return st;
}

/* Begin a table with a kept line as its first row, and the kept lines below it as further rows. */
static ss_status
begin_kept(struct table *t, size_t first, ss_error *err)
{
    size_t n = t->n_head;
    unsigned long line = t->in->line;
    t->n_head = first;                          /* names are sought above this line */
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

/* Begin a table with the first row of numbers.  If there is none, or a line of words and numbers stands
 * above it, begin with the first line of words and numbers that is like those below it. */
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

/* *yes becomes 1 if this line may be a heading, and not a row. */
static ss_status
is_heading(struct table *t, const char *line, int *yes, ss_error *err)
{
    size_t numbers;
    *yes = 0;
    if (strchr("0123456789-.+", ss_delimited_first_of(line)) != NULL)
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

/* Are the lines from a heading to the end of the file nothing but words, in other columns than those of rows? */
static ss_status
is_footer(struct table *t, int *yes, ss_error *err)
{
    size_t numbers;
    *yes = t->n_head < HEADER_LINES;
    for (size_t i = 0; *yes && i < t->n_head; i++) {
        char *shape = ss_delimited_shape(t, t->head[i].text, t->separator, &numbers);
        if (shape == NULL)
            return ss_delimited_no_memory(t, err);
        *yes = strlen(shape) != t->n_columns && strchr(shape, 'n') == NULL;
        free(shape);
    }
    return SS_OK;
}

/* Keep the lines from a heading on, up to the first row of another table, which becomes *row.  If none
 * follows, the heading is a footer or a malformed row. */
static ss_status
read_heading(struct table *t, const char *heading, char **row, ss_error *err)
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
    int footer;
    t->in->line = number;
    if ((st = is_footer(t, &footer, err)) != SS_OK || !footer)
        return st == SS_OK ? append_row(t, t->head[0].text, err) : st;
    ss_delimited_warn(t, SS_OK, "%s:%lu: the rows end here; the words below them were skipped", t->in->name, number);
    return SS_OK;
}

/* Read rows up to the end, or up to the first row of another table, which becomes *row. */
static ss_status
read_body(struct table *t, char **row, ss_error *err)
{
    char *line;
    int comment, heading = 0;
    ss_status st;
    *row = NULL;
    while ((st = ss_delimited_line(t, &line, &comment, err)) == SS_OK && line != NULL) {
        if (!comment)
            st = is_heading(t, line, &heading, err);
        if (st == SS_OK && heading)
            return read_heading(t, line, row, err);
        if (st == SS_OK && !comment)
            st = append_row(t, line, err);
        if (st != SS_OK)
            return st;
    }
    return st;
}

/* --- several tables ------------------------------------------------------------------------- */

/* Discard the rows and columns of a table before the next one. */
static ss_status
clear_table(struct table *t, ss_error *err)
{
    free(t->column);
    ss_header_free(t->names);
    ss_clock_free(&t->fit);
    t->column = NULL;
    t->fit = (clock_fit){ 0 };
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
    int more = snprintf(list + n, size - n, "%s%zu from line %.0f, %llu row%s of", number > 1 ? "; " : "",
                        number, t->first[t->n_columns], (unsigned long long)t->rows.n, PLURAL(t->rows.n));
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
    return ss_fail(err, SS_ETABLES, "%s: %zu table%s: %s", t->in->name, number, PLURAL(number), list);
}

/* --- as a reader --------------------------------------------------------------------------- */

/* Keep the columns of numbers without that of time; *head becomes a header with their names. */
static ss_status
keep_columns(struct table *t, ss_header **head)
{
    t->kept = malloc(t->n_columns * sizeof *t->kept);
    if (t->kept == NULL)
        return SS_ENOMEM;
    for (size_t c = 0; c < t->n_columns; c++)
        if (c != t->time.column && t->column[c].kind == COLUMN_NUMBERS)
            t->kept[t->n_kept++] = c;
    ss_header_free(*head);
    *head = NULL;
    return ss_header_select(head, t->names, t->kept, t->n_kept, 0);
}

double
ss_delimited_given(const struct table *t)
{
    return READING + (1 - READING) * (t->rows.n > 0 ? (double)t->rows.given / (double)t->rows.n : 1);
}

static ss_status
rewind_samples(ss_reader *reader, ss_error *err)
{
    return ss_delimited_begin_samples(reader->table, err);
}

static ss_status
give_samples(ss_reader *reader, double *const column[], size_t max, size_t *n, ss_error *err)
{
    return ss_delimited_samples(reader->table, column, max, n, err);
}

ss_status
ss_delimited_finish(struct table *t, ss_reader *reader, ss_error *err)
{
    ss_gaps gaps = t->opts->gaps;
    ss_status st = ss_kept_end(&t->rows, err);
    if (st == SS_OK)
        st = ss_delimited_check_labview(t, err);
    if (st == SS_OK)
        st = ss_delimited_choose_clock(t, err);
    if (st == SS_OK && keep_columns(t, &reader->head) != SS_OK)
        st = ss_delimited_no_memory(t, err);
    if (st == SS_OK && t->n_kept == 0)
        st = ss_fail(err, SS_EDATA, "%s: no column but time", t->in->name);
    if (st == SS_OK)
        st = ss_delimited_begin_samples(t, err);
    t->opts = NULL;                             /* they may no longer exist when samples are read */
    reader->rows = give_samples;
    reader->rewind = rewind_samples;
    return st == SS_OK && gaps != SS_GAPS_REFUSE ? ss_reader_fill_gaps(reader, gaps, err) : st;
}

struct table *
ss_delimited_new(ss_reader *reader, const ss_read_opts *opts)
{
    struct table *t = reader->table = malloc(sizeof *t);
    if (t == NULL)
        return NULL;
    *t = (struct table){ .in = &reader->in, .opts = opts, .time = { NONE, 0, 0, 1, 1 },
                         .fitted = { NONE, 0, 0, 1, 1 }, .layout = LAYOUT_ONE, .names = ss_header_new(0, 0) };
    reader->in.share = READING;
    return t->names != NULL ? t : NULL;
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
    free(t->kept);
    ss_delimited_free_rows(t);
    ss_resampler_free(t->resampler);
    ss_clock_free(&t->fit);
    ss_header_free(t->names);
    free(t);
}

static ss_status
open_table(ss_reader *reader, const ss_read_opts *opts, ss_error *err)
{
    struct input *in = &reader->in;
    struct table *t = ss_delimited_new(reader, opts);
    if (t == NULL)
        return ss_fail_memory(err, in->name);
    ss_status st = ss_input_need(in, 3, err);
    if (st == SS_OK && in->hi - in->lo >= 3 && memcmp(in->buffer + in->lo, "\xef\xbb\xbf", 3) == 0)
        in->lo += 3;                            /* skip the byte-order mark */
    if (st == SS_OK)
        st = read_table(t, err);
    return st == SS_OK ? ss_delimited_finish(t, reader, err) : st;
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
