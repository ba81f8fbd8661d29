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

static void
make_room(struct text *x, size_t length)
{
    char *copy = ss_list_grow(x->copy, &x->copy_room, length + 1, 1);
    x->copy = copy != NULL ? copy : x->copy;
    x->status = copy != NULL ? x->status : SS_ENOMEM;
}

/* The next line that is not empty; comment is set if it is one.  NULL at the end, and after a failure. */
static char *
next_line(struct text *x, int *comment)
{
    size_t length = 0;
    char *line = NULL;
    do {
        x->status = x->status == SS_OK ? ss_input_line(x->in, &line, &length, x->err) : x->status;
        if (x->status != SS_OK || line == NULL)
            return NULL;
        if (strlen(line) != length)
            ss_text_fail(x, SS_EDATA, x->in->line, "a NUL byte: this is not text of 8-bit characters "
                         "(iconv -f UTF-16 -t UTF-8 makes it of UTF-16)");
        if (strchr(line, '\r') != NULL)
            ss_text_fail(x, SS_EDATA, x->in->line,
                         "a lone CR; lines end in LF or CRLF (tr '\\r' '\\n' makes them)");
    } while (first_of(line) == '\0');
    *comment = *line == '#';
    make_room(x, length);
    return x->status == SS_OK ? line : NULL;
}

static void
keep_line(struct text *x, const char *line, int comment)
{
    struct text_line *more = ss_list_room(x->head, &x->head_room, x->n_head, sizeof *more);
    char *copy = more != NULL ? ss_utf8_text(line) : NULL;
    x->head = more != NULL ? more : x->head;
    if (copy == NULL) {
        x->status = SS_ENOMEM;
        return;
    }
    more[x->n_head++] = (struct text_line){ copy, x->in->line, comment };
    make_room(x, strlen(copy));
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
count_cells(const struct text *x, const char *line, const char *shape)
{
    size_t n = strlen(shape), first = x->labview && line[0] == '\t';
    const char *wrong = ss_text_may_lack(x) ? "t" : "te";
    if (x->labview && n > 1 && shape[n - 1] == 't')
        n--;
    size_t full = n;
    while (full > 1 && shape[full - 1] == 'e')
        full--;
    return x->numbers > 0 && n > first && strcspn(shape + first, wrong) >= full - first ? n : 0;
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
        size_t names = 0;
        if (separator == ' ' ? x->labview || grouped : strchr(line, separator) == NULL)
            continue;
        if (last > 0 && (ss_text_may_lack(x) || !x->labview))
            names = ss_text_split(x, x->head[last - 1].text, separator);
        x->t.n_columns = ss_text_may_lack(x) || !x->labview ? names : columns;
        const char *shape = ss_text_shape(x, line, separator);
        x->t.n_columns = columns;
        size_t n = count_cells(x, line, shape);
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

/* Keep the lines up to the first row of data.  Returns 0 if there is none. */
static int
keep_header(struct text *x)
{
    int comment, found = 0;
    char *line;
    while (!found && x->n_head < HEADER_LINES && (line = next_line(x, &comment)) != NULL) {
        x->labview |= x->in->line == 1 && strncmp(line, "LabVIEW Measurement", 19) == 0;
        found = !comment && is_data(x, line);
        keep_line(x, line + (comment ? strspn(line, "# ") : 0), comment);
    }
    return found;
}

/* The first of the kept lines with numbers and words, below one without numbers, that has two lines like it below,
 * or one if there are no more; else n_head.  Rows that are alike have cells of the same kinds; the second may lack
 * its empty cells at the end. */
static size_t
find_like(struct text *x, char separator)
{
    for (size_t i = 0, below, had = 0, has, alike = 0; i < x->n_head; i++, had = has, alike = 0) {
        has = 0;
        if (x->head[i].comment)
            continue;
        strcpy(x->like, ss_text_shape(x, x->head[i].text, separator));
        has = strchr(x->like, 'n') != NULL;
        if (!has || had || strpbrk(x->like, "te") == NULL)
            continue;
        for (below = i + 1; below < x->n_head && alike < 2; below++) {
            if (x->head[below].comment)
                continue;
            const char *shape = x->like, *row = ss_text_shape(x, x->head[below].text, separator);
            for (; *shape != '\0' && (*shape == *row || *row == 'e'); row++)
                shape++;
            if (*row != '\0' || strchr(shape, 'n') != NULL)
                break;
            alike++;
        }
        if (alike == 2 || (below == x->n_head && i > 0))
            return i;
    }
    return x->n_head;
}

/* --- rows ---------------------------------------------------------------------------------- */

/* SS_EDATA if a number has another decimal mark than those before: beside 0.5, 1,234 may be either of two
 * numbers. */
static void
check_mark(struct text *x, size_t column)
{
    const char *cell = x->cell[column], *name = x->t.names->column[column].name;
    char mark = cell[strcspn(cell, x->separator == ',' ? "." : ".,")];
    if (x->mark == '\0' && x->t.rows.n > 0 && ss_cell_is_grouped(cell) && (mark == ',' || x->separator == ';'))
        ss_sheet_warn(&x->t, SS_OK, "%s:%lu: column %s: '%.40s' is read with a decimal %s; no number above it has "
                      "one, so if it separates thousands, remove it", x->t.name, x->in->line, name, cell,
                      mark == ',' ? "comma" : "point");
    if (x->mark == '\0')
        x->mark = mark;
    if (mark != '\0' && mark != x->mark)
        ss_text_fail(x, SS_EDATA, x->in->line, "column %s: '%.40s' has a decimal %s, numbers before it have a %s",
                     name, cell, mark == ',' ? "comma" : "point", mark == ',' ? "point" : "comma");
}

/* The value of one cell of the line that was split.  A missing cell of an unneeded column is read as 0, with one
 * warning. */
static double
read_cell(struct text *x, size_t i)
{
    struct sheet_column *c = &x->t.column[i];
    const char *name = x->t.names->column[i].name;
    char *cell = x->cell[i];
    double value = 0;
    if (c->kind == COLUMN_TEXT && !c->begins_empty)
        return 0;
    enum cell_kind kind = ss_cell_read(cell, x->separator, &value);
    int missing = kind == CELL_NOT_FINITE || cell[strspn(cell, "-")] == '\0';
    if (c->kind == COLUMN_TEXT) {
        if (kind == CELL_NUMBER)
            ss_text_fail(x, SS_EGAPS, x->first, "column %s: '' is not a number", name);
        return 0;
    }
    if (c->spare && kind != CELL_NUMBER) {
        if (!c->incomplete)
            ss_sheet_warn(&x->t, SS_OK, "%s:%lu: column %s has no number here; it is not needed, and read as 0 "
                          "where it has none", x->t.name, x->in->line, name);
        c->incomplete = 1;
        return 0;
    }
    if (missing && x->t.opts->gaps != SS_GAPS_REFUSE)
        return NAN;
    if (c->kind == COLUMN_NUMBERS && kind == CELL_NUMBER) {
        check_mark(x, i);
        return value;
    }
    if (c->kind == COLUMN_STAMPS && !isnan(value = ss_stamp_next(&c->stamps, cell)))
        return value;
    const char *what = c->kind == COLUMN_STAMPS ? "time as those above it" : kind == CELL_NOT_FINITE
        ? "finite number" : "number";
    ss_text_fail(x, missing ? SS_EGAPS : SS_EDATA, x->in->line, "column %s: '%.40s' is not a %s%s", name, cell,
                 what, ss_cell_is_grouped(cell) ? ": it has separators of thousands; remove them" : "");
    return NAN;
}

static void
append_row(struct text *x, const char *line)
{
    size_t columns = x->t.n_columns;
    x->first = x->t.rows.n == 0 ? x->in->line : x->first;
    x->row[columns] = (double)x->in->line;
    size_t n = ss_text_split(x, line, x->separator);
    if (n != columns && !(n == columns + 1 && (x->comments || x->labview)))
        ss_text_fail(x, SS_EDATA, x->in->line, "expected %zu column%s, found %zu", columns, PLURAL(columns), n);
    for (size_t i = 0; x->status == SS_OK && i < columns; i++)
        x->row[i] = read_cell(x, i);
    if (x->status == SS_OK)
        x->status = ss_kept_add(&x->t.rows, x->row, x->err);
}

/* --- one table ----------------------------------------------------------------------------- */

/* Find the columns of a table, whose first row is the line behind the kept ones. */
static void
begin_columns(struct text *x)
{
    struct sheet *t = &x->t;
    const char *row = x->head[x->n_head].text;
    x->in->line = x->head[x->n_head].number;
    if (t->n_columns > MAX_COLUMNS) {
        ss_text_fail(x, SS_EDATA, x->in->line, "more than 32768 columns");
        return;
    }
    const char *shape = ss_text_shape(x, row, x->separator);
    struct sheet_column *column = t->column = calloc(t->n_columns, sizeof *column);
    x->row = malloc((t->n_columns + 1) * sizeof *x->row);
    if (column == NULL || x->row == NULL) {
        x->status = SS_ENOMEM;
        return;
    }
    for (size_t i = 0; i < t->n_columns; i++) {
        unsigned parts = ss_stamp_read(x->cell[i]).parts;
        int empty = shape[i] == 'e' && !ss_text_may_lack(x);
        int is_words = shape[i] == 't' || empty || (x->settings && i < 2);
        column[i].kind = is_words ? COLUMN_TEXT : parts != 0 ? COLUMN_STAMPS : COLUMN_NUMBERS;
        column[i].begins_empty = empty && !x->labview;
        column[i].stamps = STAMP_COLUMN(parts);
    }
    ss_text_read_names(x);
    if (x->status == SS_OK)
        x->status = ss_sheet_mark_spare(t, x->err);
    if (x->status != SS_OK)
        return;
    ss_text_split(x, row, x->separator);        /* the cells were those of the names */
    for (size_t i = 0; i < t->n_columns; i++)
        if (column[i].kind == COLUMN_TEXT && t->opts->n_needed == 0 && ss_cell_is_grouped(x->cell[i]))
            ss_text_fail(x, SS_EDATA, x->in->line, "column %zu (\"%s\"): '%.40s' is not a number: it has "
                         "separators of thousands; remove them, or choose other columns", i + 1,
                         t->names->column[i].name, x->cell[i]);
    for (size_t i = 0; x->status == SS_OK && i < t->n_columns; i++)
        if (column[i].kind == COLUMN_TEXT && !(x->labview && row[0] == '\t' && i == 0))
            ss_sheet_warn(t, SS_OK, "%s:%lu: column %zu (\"%s\") %s; it was skipped", t->name, x->in->line, i + 1,
                          t->names->column[i].name, column[i].begins_empty ? "is empty" : "holds text");
    ss_kept_begin(&t->rows, t->name, t->opts->folder, t->n_columns + 1);
}

/* Begin a table with a kept line as its first row, and the kept lines below it as further rows. */
static void
begin_table(struct text *x, size_t first)
{
    size_t n = x->n_head;
    unsigned long line = x->in->line;
    x->separator = x->next_separator;
    x->t.n_columns = x->next_columns;
    x->n_head = first;                          /* names are sought above this line */
    x->ended = x->another = 0;
    begin_columns(x);
    for (size_t i = first; x->status == SS_OK && i < n; i++) {
        x->in->line = x->head[i].number;
        if (!x->head[i].comment)
            append_row(x, x->head[i].text);
    }
    x->n_head = n;
    x->in->line = line;
}

/* Has a line a setting and its value in two cells that the last of the kept lines has empty, as those of
 * Tektronix's oscilloscopes have? */
static int
has_settings(struct text *x, size_t line)
{
    return strncmp(ss_text_shape(x, x->head[line].text, x->next_separator), "tn", 2) == 0
        && strncmp(ss_text_shape(x, x->head[x->n_head - 1].text, x->next_separator), "ee", 2) == 0;
}

/* Begin with the first row of numbers, which is the last of the kept lines.  If there is none, or a line of words
 * and numbers stands above it, begin with the first line of words and numbers that is like those below it. */
static void
begin_first(struct text *x, int found)
{
    size_t row = x->n_head - (found != 0), first = row;
    int mixed = !found;
    x->t.n_columns = x->next_columns;
    if (found && row > 0 && !x->head[row - 1].comment) {
        const char *shape = ss_text_shape(x, x->head[row - 1].text, x->next_separator);
        mixed = (shape[0] == 'n' && strpbrk(shape, "te") != NULL) || has_settings(x, row - 1);
    }
    first = mixed ? x->n_head : first;
    for (size_t i = 0; mixed && first == x->n_head && i < CANDIDATES; i++)
        if ((first = find_like(x, candidate[i])) < x->n_head) {
            x->next_separator = candidate[i];
            x->next_columns = strlen(x->like);
        }
    x->settings = first < x->n_head && has_settings(x, first);
    if (first == x->n_head && !found)
        ss_text_fail(x, SS_EDATA, x->in->line, "no row of numbers up to here; a table has them between commas, "
                     "semicolons, tabs or blanks");
    else
        begin_table(x, first < row ? first : row);
}

/* --- several tables ------------------------------------------------------------------------ */

/* May this line be a heading, and not a row? */
static int
is_heading(struct text *x, const char *line)
{
    if (strchr("0123456789-.+", first_of(line)) != NULL)
        return 0;
    if (x->labview && strncmp(line, "Channels", 8) == 0)
        return 1;
    const char *shape = ss_text_shape(x, line, x->separator);
    size_t n = strlen(shape);
    return shape[0] == 't' && x->t.column[0].kind != COLUMN_TEXT
        && (n != x->t.n_columns || (n > 1 && strchr(shape, 'n') == NULL));
}

/* Read a line below the first row.  Keep the lines from a heading on, up to the first row of another table.  If
 * none follows, the heading begins a footer, which is nothing but words, in more or fewer cells than rows have, or
 * is a malformed row. */
static void
read_line(struct text *x)
{
    int comment;
    const char *line = next_line(x, &comment);
    unsigned long number = x->in->line;
    x->ended = line == NULL || (!comment && is_heading(x, line));
    if (line == NULL || comment)
        return;
    if (!x->ended) {
        append_row(x, line);
        return;
    }
    drop_lines(x);
    keep_line(x, line, 0);
    x->another = keep_header(x);
    if (x->status != SS_OK || x->another)
        return;
    x->in->line = number;
    int is_footer = x->n_head < HEADER_LINES;
    for (size_t i = 0; is_footer && i < x->n_head; i++) {
        const char *shape = ss_text_shape(x, x->head[i].text, x->separator);
        size_t filled = strlen(shape);
        while (filled > 0 && shape[filled - 1] == 'e')
            filled--;
        is_footer = filled != x->t.n_columns && strchr(shape, 'n') == NULL;
    }
    if (is_footer)
        ss_sheet_warn(&x->t, SS_OK, "%s:%lu: the rows end here; the words below them were skipped", x->t.name,
                      number);
    else
        append_row(x, x->head[0].text);
}

/* Read the tables, up to the one that is wanted.  If there are several and none is, the error lists them: "2 from
 * line 17, 1200 rows of t Fx Fz". */
static void
read_tables(struct text *x)
{
    struct sheet *t = &x->t;
    char list[300] = "";
    size_t n = 0;                               /* letters of the list, or of what it would be with more room */
    for (size_t number = 1, wanted = t->opts->table;; number++) {
        while (x->status == SS_OK && !x->ended)
            read_line(x);
        if (x->status != SS_OK || number == wanted || (!x->another && number == 1 && wanted == 0))
            return;
        if (n < sizeof list)
            n += (size_t)snprintf(list + n, sizeof list - n, "%s%zu from line %lu, %llu row%s of",
                                  number > 1 ? "; " : "", number, x->first, (unsigned long long)t->rows.n,
                                  PLURAL(t->rows.n));
        for (size_t c = 0; c < t->n_columns && n < sizeof list; c++)
            n += (size_t)snprintf(list + n, sizeof list - n, " %s", t->names->column[c].name);
        if (!x->another) {
            ss_text_fail(x, SS_ETABLES, 0, "%zu table%s: %s", number, PLURAL(number), list);
            return;
        }
        free(t->column);
        free(x->row);
        ss_header_free(t->names);
        t->column = NULL;
        x->row = NULL;
        t->counted.increment = 0;
        t->named = x->comments = 0;
        x->mark = '\0';
        x->status = ss_header_new(&t->names, 0, 0, NULL);
        if (x->status == SS_OK)
            begin_table(x, x->n_head - 1);
    }
}

/* --- rows as they come --------------------------------------------------------------------- */

/* Drop the rows, and add those that have arrived, at least one unless the text ends. */
static ss_status
next_rows(struct sheet *t, ss_error *err)
{
    struct text *x = (struct text *)t;
    x->err = err;
    x->status = SS_OK;
    t->rows.first = t->rows.n;
    t->rows.held = 0;
    while (x->status == SS_OK && !x->ended && (t->rows.held == 0 || ss_input_has_line(x->in)))
        read_line(x);
    if (x->another)
        ss_text_fail(x, SS_ETABLES, x->in->line, "another table begins here");
    return x->status;
}

/* Returns 1 if the rows of a text from a pipe can be handed on as they come: if a rate is given, or if the first
 * stamps show one that more of them would not change. */
static int
read_first(struct text *x)
{
    enum { SHOWN = 16 };
    const ss_read_opts *opts = x->t.opts;
    struct kept *rows = &x->t.rows;
    int live = ss_input_is_pipe(x->in) && opts->gaps == SS_GAPS_REFUSE && !(opts->resample > 0) && !opts->stamps
        && opts->table == 0 && !x->labview;
    while (x->status == SS_OK && live && !x->ended && !(opts->rate > 0) && rows->n < SHOWN)
        read_line(x);
    live = x->status == SS_OK && live && !x->ended && !rows->is_away;
    if (live && !(opts->rate > 0))
        x->status = ss_sheet_is_plain(&x->t, &live);
    return live;
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
    static const char *const word[] = { "sampling", "samplerate", "samples per", "samples/s", "abtast",
                                        "chantillonnage", "muestreo", "campionamento", "rate", "interval", "fs",
                                        "dt" };
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
    struct text *x = calloc(1, sizeof *x);
    if (x == NULL)
        return ss_fail_memory(err, in->name);
    x->in = in;
    x->err = err;
    x->layout = LAYOUT_ONE;
    x->opts = *o->opts;
    x->t.name = in->name;
    x->t.opts = &x->opts;
    x->status = ss_header_new(&x->t.names, 0, 0, NULL);
    in->share = 0.5;                            /* of the work; the other half is to give the rows */
    if (x->status == SS_OK)
        x->status = ss_input_need(in, 3, err);
    if (x->status == SS_OK && in->hi - in->lo >= 3 && memcmp(in->buffer + in->lo, "\xef\xbb\xbf", 3) == 0)
        in->lo += 3;                            /* skip the byte-order mark */
    int found = keep_header(x);
    if (x->status == SS_OK)
        begin_first(x, found);
    if (read_first(x))
        x->t.later = &as_they_come;
    else
        read_tables(x);
    if (x->status == SS_OK)
        x->status = ss_kept_end(&x->t.rows, err);
    ss_text_check_times(x);
    const struct text_line *clue = find_rate_line(x);
    x->t.clue = clue != NULL ? clue->text : NULL;
    x->t.clue_line = clue != NULL ? clue->number : 0;
    if (x->status == SS_OK)
        x->status = ss_sheet_give(out, &x->t, in->size > 0 ? in->progress : (ss_progress){ NULL, NULL }, err);
    const ss_status st = x->status;
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
