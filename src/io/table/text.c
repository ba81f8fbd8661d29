/* text.c -- text tables of data-acquisition systems.
 *
 * The first line with nothing but numbers, dates and times begins the data and shows the separator; a table with a
 * column of words has none: there it is the first line, below one without numbers, that the next two lines are
 * like, cell by cell.  The lines above it are searched for names and units (names.c).  A line of words below the
 * rows begins another table if rows follow it again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "base/list.h"
#include "base/number.h"
#include "base/utf8.h"
#include "signal/header.h"
#include "io/table/text.h"

enum { HEADER_LINES = 1000 };

/* --- lines --------------------------------------------------------------------------------- */

/* The first letter that is no blank. */
static char
first_of(const char *line)
{
    while (*line == ' ' || *line == '\t')
        line++;
    return *line;
}

static ss_status
make_room(struct text *x, size_t length)
{
    char *copy = ss_list_grow(x->copy, &x->copy_room, length + 1, 1);
    x->copy = copy != NULL ? copy : x->copy;
    return copy != NULL ? SS_OK : SS_ENOMEM;
}

/* The next line that is not empty; comment is set if it is one.  NULL at the end. */
static ss_status
next_line(struct text *x, char **line, int *comment, ss_error *err)
{
    size_t length;
    do {
        ss_status st = ss_input_line(x->in, line, &length, err);
        if (st != SS_OK || *line == NULL)
            return st;
        if (strlen(*line) != length)
            return ss_fail(err, SS_EDATA, "%s:%lu: a NUL byte: this is not text of 8-bit characters (iconv -f UTF-16 "
                           "-t UTF-8 makes it of UTF-16)", x->t.name, x->in->line);
        if (strchr(*line, '\r') != NULL)
            return ss_fail(err, SS_EDATA, "%s:%lu: a lone CR; lines end in LF or CRLF (tr '\\r' '\\n' "
                           "makes them)", x->t.name, x->in->line);
    } while (first_of(*line) == '\0');
    *comment = **line == '#';
    return make_room(x, length);
}

static ss_status
keep_line(struct text *x, const char *line, int comment)
{
    struct text_line *more = ss_list_room(x->head, &x->head_room, x->n_head, sizeof *more);
    char *copy = more != NULL ? ss_utf8_text(line) : NULL;
    x->head = more != NULL ? more : x->head;
    if (copy == NULL)
        return SS_ENOMEM;
    more[x->n_head++] = (struct text_line){ copy, x->in->line, comment };
    return make_room(x, strlen(copy));
}

static void
drop_lines(struct text *x)
{
    for (size_t i = 0; i < x->n_head; i++)
        free(x->head[i].text);
    x->n_head = 0;
}

/* --- where the data begin ------------------------------------------------------------------ */

static const char candidate[] = { '\t', ';', ',', ' ' };
enum { CANDIDATES = sizeof candidate / sizeof *candidate };

/* The number of cells that belong to columns, if all of these but the last hold numbers; else 0.  LabVIEW leaves
 * the cell of x empty, and writes comments behind some rows. */
static size_t
count_cells(const struct text *x, const char *line, const char *shape, size_t numbers)
{
    size_t n = strlen(shape), first = x->labview && line[0] == '\t';
    const char *wrong = ss_text_may_lack(x) ? "t" : "te";
    if (x->labview && n > 1 && shape[n - 1] == 't')
        n--;
    size_t full = n;
    while (full > 1 && shape[full - 1] == 'e')
        full--;
    return numbers > 0 && n > first && strcspn(shape + first, wrong) >= full - first ? n : 0;
}

/* Is this the first line of data?  Then next_separator and next_columns are set.  Empty cells at its end
 * count if each has a name in the line above.  Blanks are separators of thousands, and not of cells, where
 * other separators leave as many cells as there are names. */
static int
is_data(struct text *x, const char *line)
{
    size_t columns = x->t.n_columns, last = x->n_head;
    while (last > 0 && x->head[last - 1].comment)
        last--;
    int grouped = 0;
    for (size_t i = 0; i < CANDIDATES; i++) {
        char separator = candidate[i];
        size_t numbers, names = 0;
        if (separator == ' ' ? x->labview || grouped : strchr(line, separator) == NULL)
            continue;
        if (last > 0 && (ss_text_may_lack(x) || !x->labview))
            names = ss_text_split(x, x->head[last - 1].text, separator);
        x->t.n_columns = ss_text_may_lack(x) || !x->labview ? names : columns;
        const char *shape = ss_text_shape(x, line, separator, &numbers);
        x->t.n_columns = columns;
        size_t n = count_cells(x, line, shape, numbers);
        for (size_t k = 0; strlen(shape) == names && k < names; k++)
            grouped |= strchr(x->cell[k], ' ') != NULL && ss_cell_is_grouped(x->cell[k]);
        if (n == 0 || (n == 1 && separator != ';' && separator != ' '))
            continue;
        x->next_separator = n > 1 || separator == ';' ? separator : '\0';
        x->next_columns = n;
        return 1;
    }
    return 0;
}

/* Keep the lines up to the first row of data; *found becomes 0 if there is none. */
static ss_status
keep_header(struct text *x, int *found, ss_error *err)
{
    int comment = 0;
    char *line;
    ss_status st = SS_OK;
    for (*found = 0; st == SS_OK && !*found && x->n_head < HEADER_LINES;) {
        st = next_line(x, &line, &comment, err);
        if (st != SS_OK || line == NULL)
            return st;
        x->labview |= x->in->line == 1 && strncmp(line, "LabVIEW Measurement", 19) == 0;
        *found = !comment && is_data(x, line);
        st = keep_line(x, line + (comment ? strspn(line, "# ") : 0), comment);
    }
    return st;
}

/* 1 if two rows have cells of the same kinds.  The second may lack its empty cells at the end. */
static int
is_like(const char *shape, const char *row)
{
    for (; *shape != '\0' && *row != '\0'; shape++, row++)
        if (*shape != *row && *row != 'e')
            return 0;
    return *row == '\0' && strchr(shape, 'n') == NULL;
}

/* The first of the kept lines with numbers and words, below one without numbers, that has two lines like it below,
 * or one if there are no more; else n_head. */
static size_t
find_like(struct text *x, char separator)
{
    size_t numbers;
    for (size_t i = 0, below, had = 0, has, alike = 0; i < x->n_head; i++, had = has, alike = 0) {
        has = 0;
        if (x->head[i].comment)
            continue;
        strcpy(x->like, ss_text_shape(x, x->head[i].text, separator, &numbers));
        has = strchr(x->like, 'n') != NULL;
        if (!has || had || strpbrk(x->like, "te") == NULL)
            continue;
        for (below = i + 1; below < x->n_head && alike < 2; below++)
            if (x->head[below].comment)
                continue;
            else if (is_like(x->like, ss_text_shape(x, x->head[below].text, separator, &numbers)))
                alike++;
            else
                break;
        if (alike == 2 || (below == x->n_head && i > 0))
            return i;
    }
    return x->n_head;
}

/* Find the first of the kept lines that is a row of data with words in it, as the lines below it are too, or
 * n_head; then next_separator and next_columns are set. */
static size_t
find_mixed(struct text *x)
{
    size_t found = x->n_head;
    for (size_t i = 0; found == x->n_head && i < CANDIDATES; i++)
        if ((found = find_like(x, candidate[i])) < x->n_head) {
            x->next_separator = candidate[i];
            x->next_columns = strlen(x->like);
        }
    return found;
}

/* --- rows ---------------------------------------------------------------------------------- */

/* SS_EDATA if a number has another decimal mark than those before: beside 0.5, 1,234 may be either of two
 * numbers. */
static ss_status
check_mark(struct text *x, size_t column, ss_error *err)
{
    const char *cell = x->cell[column];
    char mark = cell[strcspn(cell, x->separator == ',' ? "." : ".,")];
    if (x->mark == '\0' && x->t.rows.n > 0 && ss_cell_is_grouped(cell) && (mark == ',' || x->separator == ';'))
        ss_sheet_warn(&x->t, SS_OK, "%s:%lu: column %s: '%.40s' is read with a decimal %s; no number above it has "
                      "one, so if it separates thousands, remove it", x->t.name, x->in->line,
                      x->t.names->column[column].name, cell, mark == ',' ? "comma" : "point");
    if (x->mark == '\0')
        x->mark = mark;
    if (mark == '\0' || mark == x->mark)
        return SS_OK;
    return ss_fail(err, SS_EDATA, "%s:%lu: column %s: '%.40s' has a decimal %s, numbers before it "
                   "have a %s", x->t.name, x->in->line, x->t.names->column[column].name, cell,
                   mark == ',' ? "comma" : "point", mark == ',' ? "point" : "comma");
}

/* Read the value of one cell of the line that was split.  A missing cell of an unneeded column is read as 0, with
 * one warning. */
static ss_status
read_cell(struct text *x, size_t i, double *value, ss_error *err)
{
    struct sheet_column *c = &x->t.column[i];
    const char *name = x->t.names->column[i].name;
    char *cell = x->cell[i];
    *value = 0;
    if (c->kind == COLUMN_TEXT && !c->begins_empty)
        return SS_OK;
    enum cell_kind kind = ss_cell_read(cell, x->separator, value);
    if (c->kind == COLUMN_TEXT)
        return kind != CELL_NUMBER ? SS_OK : ss_fail(err, SS_EGAPS, "%s:%lu: column %s: '' is not a number",
                                                     x->t.name, x->first, name);
    int missing = kind == CELL_NOT_FINITE || cell[strspn(cell, "-")] == '\0';
    if (c->spare && kind != CELL_NUMBER) {
        if (!c->incomplete)
            ss_sheet_warn(&x->t, SS_OK, "%s:%lu: column %s has no number here; it is not needed, and read as 0 "
                          "where it has none", x->t.name, x->in->line, name);
        c->incomplete = 1;
        *value = 0;
        return SS_OK;
    }
    if (missing && x->t.opts->gaps != SS_GAPS_REFUSE) {
        *value = NAN;
        return SS_OK;
    }
    if (c->kind == COLUMN_STAMPS && !isnan(*value = ss_stamp_next(&c->stamps, cell)))
        return SS_OK;
    if (c->kind == COLUMN_NUMBERS && kind == CELL_NUMBER)
        return check_mark(x, i, err);
    const char *what = c->kind == COLUMN_STAMPS ? "time as those above it" : kind == CELL_NOT_FINITE
        ? "finite number" : "number";
    return ss_fail(err, missing ? SS_EGAPS : SS_EDATA, "%s:%lu: column %s: '%.40s' is not a %s%s",
                   x->t.name, x->in->line, name, cell, what,
                   ss_cell_is_grouped(cell) ? ": it has separators of thousands; remove them" : "");
}

static ss_status
append_row(struct text *x, const char *line, ss_error *err)
{
    size_t columns = x->t.n_columns;
    x->first = x->t.rows.n == 0 ? x->in->line : x->first;
    x->row[columns] = (double)x->in->line;
    size_t n = ss_text_split(x, line, x->separator);
    if (n != columns && !(n == columns + 1 && (x->comments || x->labview)))
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu column%s, found %zu", x->t.name, x->in->line, columns,
                       PLURAL(columns), n);
    for (size_t i = 0; i < columns; i++) {
        ss_status st = read_cell(x, i, &x->row[i], err);
        if (st != SS_OK)
            return st;
    }
    return ss_kept_add(&x->t.rows, x->row, err);
}

/* --- one table ----------------------------------------------------------------------------- */

/* Find the columns of a table, whose first row is the line behind the kept ones. */
static ss_status
begin_columns(struct text *x, ss_error *err)
{
    struct sheet *t = &x->t;
    const char *row = x->head[x->n_head].text;
    x->in->line = x->head[x->n_head].number;
    if (t->n_columns > MAX_COLUMNS)
        return ss_fail(err, SS_EDATA, "%s:%lu: more than 32768 columns", t->name, x->in->line);
    size_t numbers;
    const char *shape = ss_text_shape(x, row, x->separator, &numbers);
    struct sheet_column *column = t->column = calloc(t->n_columns, sizeof *column);
    x->row = malloc((t->n_columns + 1) * sizeof *x->row);
    if (column == NULL || x->row == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < t->n_columns; i++) {
        unsigned parts = ss_stamp_read(x->cell[i]).parts;
        int empty = shape[i] == 'e' && !ss_text_may_lack(x);
        int is_words = shape[i] == 't' || empty || (x->settings && i < 2);
        column[i].kind = is_words ? COLUMN_TEXT : parts != 0 ? COLUMN_STAMPS : COLUMN_NUMBERS;
        column[i].begins_empty = empty && !x->labview;
        column[i].stamps = ss_stamp_column(parts);
    }
    ss_status st = ss_text_read_names(x, err);
    if (st == SS_OK)
        st = ss_sheet_mark_spare(t, err);
    if (st != SS_OK)
        return st;
    ss_text_split(x, row, x->separator);        /* the cells were those of the names */
    for (size_t i = 0; i < t->n_columns; i++)
        if (column[i].kind == COLUMN_TEXT && t->opts->n_needed == 0 && ss_cell_is_grouped(x->cell[i]))
            return ss_fail(err, SS_EDATA, "%s:%lu: column %zu (\"%s\"): '%.40s' is not a number: it has separators "
                           "of thousands; remove them, or choose other columns", t->name, x->in->line, i + 1,
                           t->names->column[i].name, x->cell[i]);
    for (size_t i = 0; i < t->n_columns; i++)
        if (t->column[i].kind == COLUMN_TEXT && !(x->labview && row[0] == '\t' && i == 0))
            ss_sheet_warn(t, SS_OK, "%s:%lu: column %zu (\"%s\") %s; it was skipped", t->name, x->in->line, i + 1,
                          t->names->column[i].name, t->column[i].begins_empty ? "is empty" : "holds text");
    ss_kept_begin(&t->rows, t->name, t->opts->folder, t->n_columns + 1);
    return SS_OK;
}

/* Begin a table with a kept line as its first row, and the kept lines below it as further rows. */
static ss_status
begin_table(struct text *x, size_t first, ss_error *err)
{
    size_t n = x->n_head;
    unsigned long line = x->in->line;
    x->separator = x->next_separator;
    x->t.n_columns = x->next_columns;
    x->n_head = first;                          /* names are sought above this line */
    x->ended = x->another = 0;
    ss_status st = begin_columns(x, err);
    for (size_t i = first; st == SS_OK && i < n; i++) {
        x->in->line = x->head[i].number;
        st = x->head[i].comment ? SS_OK : append_row(x, x->head[i].text, err);
    }
    x->n_head = n;
    if (st == SS_OK)
        x->in->line = line;
    return st;
}

/* Has a line a setting and its value in two cells that the last of the kept lines has empty, as those of
 * Tektronix's oscilloscopes have? */
static int
has_settings(struct text *x, size_t line)
{
    size_t numbers;
    return strncmp(ss_text_shape(x, x->head[line].text, x->next_separator, &numbers), "tn", 2) == 0
        && strncmp(ss_text_shape(x, x->head[x->n_head - 1].text, x->next_separator, &numbers), "ee", 2) == 0;
}

/* Begin with the first row of numbers, which is the last of the kept lines.  If there is none, or a line of words
 * and numbers stands above it, begin with the first line of words and numbers that is like those below it. */
static ss_status
begin_first(struct text *x, int found, ss_error *err)
{
    size_t row = x->n_head - (found != 0), first = row, numbers;
    int mixed = !found;
    x->t.n_columns = x->next_columns;
    if (found && row > 0 && !x->head[row - 1].comment) {
        const char *shape = ss_text_shape(x, x->head[row - 1].text, x->next_separator, &numbers);
        mixed = (shape[0] == 'n' && strpbrk(shape, "te") != NULL) || has_settings(x, row - 1);
    }
    if (mixed)
        first = find_mixed(x);
    x->settings = first < x->n_head && has_settings(x, first);
    if (first == x->n_head && !found)
        return ss_fail(err, SS_EDATA, "%s:%lu: no row of numbers up to here; a table has them "
                       "between commas, semicolons, tabs or blanks", x->t.name, x->in->line);
    return begin_table(x, first < row ? first : row, err);
}

/* --- several tables ------------------------------------------------------------------------ */

/* May this line be a heading, and not a row? */
static int
is_heading(struct text *x, const char *line)
{
    size_t numbers;
    if (strchr("0123456789-.+", first_of(line)) != NULL)
        return 0;
    if (x->labview && strncmp(line, "Channels", 8) == 0)
        return 1;
    const char *shape = ss_text_shape(x, line, x->separator, &numbers);
    size_t n = strlen(shape);
    return shape[0] == 't' && x->t.column[0].kind != COLUMN_TEXT
        && (n != x->t.n_columns || (n > 1 && strchr(shape, 'n') == NULL));
}

/* Are the lines from a heading to the end of the file nothing but words, in more or fewer cells than rows have? */
static int
is_footer(struct text *x)
{
    size_t numbers;
    for (size_t i = 0; i < x->n_head; i++) {
        const char *shape = ss_text_shape(x, x->head[i].text, x->separator, &numbers);
        size_t filled = strlen(shape);
        while (filled > 0 && shape[filled - 1] == 'e')
            filled--;
        if (filled == x->t.n_columns || strchr(shape, 'n') != NULL)
            return 0;
    }
    return x->n_head < HEADER_LINES;
}

/* Keep the lines from a heading on, up to the first row of another table.  If none follows, the heading is a
 * footer or a malformed row. */
static ss_status
read_heading(struct text *x, const char *heading, ss_error *err)
{
    unsigned long number = x->in->line;
    drop_lines(x);
    ss_status st = keep_line(x, heading, 0);
    if (st == SS_OK)
        st = keep_header(x, &x->another, err);
    if (st != SS_OK || x->another)
        return st;
    x->in->line = number;
    if (!is_footer(x))
        return append_row(x, x->head[0].text, err);
    ss_sheet_warn(&x->t, SS_OK, "%s:%lu: the rows end here; the words below them were skipped", x->t.name, number);
    return SS_OK;
}

/* Read a line below the first row. */
static ss_status
read_line(struct text *x, ss_error *err)
{
    char *line;
    int comment;
    ss_status st = next_line(x, &line, &comment, err);
    x->ended = st != SS_OK || line == NULL;
    if (x->ended || comment)
        return st;
    x->ended = is_heading(x, line);
    return x->ended ? read_heading(x, line, err) : append_row(x, line, err);
}

/* Append a description of a table: "2 from line 17, 1200 rows of t Fx Fz". */
static void
list_table(const struct text *x, size_t number, char *list, size_t size)
{
    const struct sheet *t = &x->t;
    size_t n = strlen(list);
    int more = snprintf(list + n, size - n, "%s%zu from line %lu, %llu row%s of", number > 1 ? "; " : "",
                        number, x->first, (unsigned long long)t->rows.n, PLURAL(t->rows.n));
    for (size_t c = 0; c < t->n_columns && more >= 0 && n + (size_t)more < size; c++) {
        n += (size_t)more;
        more = snprintf(list + n, size - n, " %s", t->names->column[c].name);
    }
}

/* Read the tables, up to the one that is wanted. */
static ss_status
read_tables(struct text *x, ss_error *err)
{
    struct sheet *t = &x->t;
    char list[300] = "";
    for (size_t number = 1, wanted = t->opts->table;; number++) {
        ss_status st = SS_OK;
        while (st == SS_OK && !x->ended)
            st = read_line(x, err);
        if (st != SS_OK || number == wanted || (!x->another && number == 1 && wanted == 0))
            return st;
        list_table(x, number, list, sizeof list);
        if (!x->another)
            return ss_fail(err, SS_ETABLES, "%s: %zu table%s: %s", t->name, number, PLURAL(number), list);
        free(t->column);
        free(x->row);
        ss_header_free(t->names);
        t->column = NULL;
        x->row = NULL;
        t->counted.increment = 0;
        t->named = x->comments = 0;
        x->mark = '\0';
        st = ss_header_new(&t->names, 0, 0, NULL);
        if (st == SS_OK)
            st = begin_table(x, x->n_head - 1, err);
        if (st != SS_OK)
            return st;
    }
}

/* --- rows as they come --------------------------------------------------------------------- */

/* Drop the rows, and add those that have arrived, at least one unless the text ends. */
static ss_status
next_rows(struct sheet *t, ss_error *err)
{
    struct text *x = (struct text *)t;
    ss_status st = SS_OK;
    t->rows.first = t->rows.n;
    t->rows.held = 0;
    while (st == SS_OK && !x->ended && (t->rows.held == 0 || ss_input_has_line(x->in)))
        st = read_line(x, err);
    return st == SS_OK && x->another ? ss_fail(err, SS_ETABLES, "%s:%lu: another table begins here", t->name,
                                               x->in->line) : st;
}

/* *live becomes 1 if the rows of a text from a pipe can be handed on as they come: if a rate is given, or if the
 * first stamps show one that more of them would not change. */
static ss_status
read_first(struct text *x, int *live, ss_error *err)
{
    enum { SHOWN = 16 };
    const ss_read_opts *opts = x->t.opts;
    struct kept *rows = &x->t.rows;
    ss_status st = SS_OK;
    *live = ss_input_is_pipe(x->in) && opts->gaps == SS_GAPS_REFUSE && !(opts->resample > 0) && !opts->stamps
        && opts->table == 0 && !x->labview;
    while (st == SS_OK && *live && !x->ended && !(opts->rate > 0) && rows->n < SHOWN)
        st = read_line(x, err);
    *live = *live && !x->ended && !rows->is_away;
    return st == SS_OK && *live && !(opts->rate > 0) ? ss_sheet_is_plain(&x->t, live) : st;
}

/* --- the format ---------------------------------------------------------------------------- */

static int
is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/* The line above the data that most probably gives the clock; NULL: there is none.  It is shown, not read: whether
 * a number is the rate of this table, its period or a rate of flow, and in what unit, only its writer knows.  A
 * longer word that begins with one of more than four letters counts, too. */
static const struct text_line *
find_rate_line(const struct text *x)
{
    static const char *const word[] = { "sampling", "samplerate", "samples per", "samples/s", "abtast", "chantillonnage",
                                        "muestreo", "campionamento", "rate", "interval", "fs", "dt" };
    for (size_t w = 0; w < sizeof word / sizeof *word; w++)
        for (size_t i = 0; i < x->n_head; i++) {
            const char *line = x->head[i].text;
            size_t n = strlen(word[w]);
            for (const char *p = line; *p != '\0'; p++)
                if ((p == line || !is_letter(p[-1])) && strncasecmp(p, word[w], n) == 0
                    && (n > 4 || !is_letter(p[n])) && strpbrk(p, "0123456789") != NULL)
                    return &x->head[i];
        }
    return NULL;
}

static void
free_text(struct sheet *t)
{
    struct text *x = (struct text *)t;
    drop_lines(x);
    free(x->head);
    free(x->row);
    free(x->copy);
    ss_sheet_free(t);
    free(x);
}

static ss_status
open_text(ss_source **out, const struct opening *o, ss_error *err)
{
    static const struct sheet_calls as_they_come = { next_rows, free_text };
    struct input *in = o->in;
    int live = 0, found;
    struct text *x = calloc(1, sizeof *x);
    if (x == NULL)
        return ss_fail_memory(err, in->name);
    x->in = in;
    x->layout = LAYOUT_ONE;
    x->opts = *o->opts;
    x->t.name = in->name;
    x->t.opts = &x->opts;
    ss_status st = ss_header_new(&x->t.names, 0, 0, NULL);
    in->share = 0.5;                            /* of the work; the other half is to give the rows */
    if (st == SS_OK)
        st = ss_input_need(in, 3, err);
    if (st == SS_OK && in->hi - in->lo >= 3 && memcmp(in->buffer + in->lo, "\xef\xbb\xbf", 3) == 0)
        in->lo += 3;                            /* skip the byte-order mark */
    if (st == SS_OK)
        st = keep_header(x, &found, err);
    if (st == SS_OK)
        st = begin_first(x, found, err);
    if (st == SS_OK)
        st = read_first(x, &live, err);
    if (st == SS_OK && live)
        x->t.later = &as_they_come;
    else if (st == SS_OK)
        st = read_tables(x, err);
    if (st == SS_OK)
        st = ss_kept_end(&x->t.rows, err);
    if (st == SS_OK)
        st = ss_text_check_times(x, err);
    const struct text_line *clue = find_rate_line(x);
    x->t.clue = clue != NULL ? clue->text : NULL;
    x->t.clue_line = clue != NULL ? clue->number : 0;
    if (st == SS_OK)
        st = ss_sheet_give(out, &x->t, in->size > 0 ? in->progress : (ss_progress){ NULL, NULL }, err);
    if (*out == NULL || x->t.later == NULL)
        free_text(&x->t);
    return st == SS_ENOMEM ? ss_fail_memory(err, in->name) : st;
}

/* --- writing --------------------------------------------------------------------------------
 *
 * Comma-separated values as RFC 4180 describes: a line of names, then rows.  A cell that contains a comma, a quote
 * or the end of a line is quoted; a number that is not known is an empty cell.  Spreadsheets take what begins with
 * =, +,
 * - or @ for a formula, so a word that does has an apostrophe before it, which makes it text. */

static void
write_word(FILE *out, const char *word)
{
    char *end;
    if (strcmp(word, "-") == 0)
        return;
    ss_number_parse(word, &end);
    int is_formula = word[0] != '\0' && strchr("=+-@", word[0]) != NULL && strcmp(word, "-inf") != 0
        && (end == word || *end != '\0');
    const char *before = is_formula ? "'" : "";
    if (strpbrk(word, ",\"\r\n") == NULL) {
        fprintf(out, "%s%s", before, word);
        return;
    }
    fprintf(out, "\"%s", before);
    for (; *word != '\0'; word++)
        fputs(*word == '"' ? "\"\"" : (char[]){ *word, '\0' }, out);
    fputc('"', out);
}

static ss_status
begin_csv(FILE *out, const ss_header *head, const char *magic, ss_error *err)
{
    (void)magic, (void)err;
    if (head->has_time)
        fputs(head->n_columns > 0 ? "t," : "t", out);
    for (size_t c = 0; c < head->n_columns; c++) {
        write_word(out, head->column[c].name);
        if (c + 1 < head->n_columns)
            fputc(',', out);
    }
    fputc('\n', out);
    return ferror(out) ? SS_EIO : SS_OK;
}

FORMAT(delimited) = {
    .name = "csv",
    .open = open_text,
    .begin = begin_csv,
    .has_time = 1,
    .separator = ',',
    .word = write_word,
};
