/* delimited.c -- text tables of data-acquisition systems.
 *
 * The first line with nothing but numbers begins the data and shows the separator; the lines above
 * it are searched for names and units, and one column becomes the clock.  The whole table is read
 * first, as only all stamps together show the rate. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "base/list.h"
#include "base/utf8.h"
#include "signal/gaps.h"
#include "signal/header.h"
#include "signal/resample.h"
#include "stream/clock.h"
#include "stream/format.h"
#include "stream/reader.h"

enum {
    HEADER_LINES = 1000,
    GAPS_MOST = 1000            /* samples for each that is there */
};
#define NONE SIZE_MAX

struct table {
    struct input *in;
    const ss_read_opts *opts;
    char mark;                  /* decimal point or comma, '\0': none seen */
    char separator;             /* '\t' ';' ',' or ' ' (any blanks); '\0': one column */
    size_t n_columns;           /* that of time among them */
    char **cell;                /* of the line that was split last */
    size_t cell_room;
    char *above[2];             /* the last two header lines: [1] stands right above the data */
    unsigned long above_line[2];
    size_t time;                /* column of time, or NONE */
    double origin, increment;   /* [s] of numbered rows: the first column; increment 0: not so */
    int named;                  /* is there a row of names? */
    ss_header *names;           /* all columns, that of time among them, and the clock */
    double *value;              /* rows, one after the other */
    unsigned long *line;        /* where each row stands */
    size_t n_rows, room;
};

static ss_status
out_of_memory(const struct table *t, ss_error *err)
{
    return ss_fail(err, SS_ENOMEM, "%s:%lu: no memory for a table this large", t->in->name,
                   t->in->line);
}

/* --- cells --------------------------------------------------------------------------------- */

static char *
trim(char *p)
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

/* Split a line, in place, into t->cell; empty cells too many at the end are dropped.  NONE: no
 * memory. */
static size_t
split(struct table *t, char *p, char separator)
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
        t->cell[n++] = trim(begin);
        p = end + more;
    }
    while (n > 1 && n != t->n_columns && t->cell[n - 1][0] == '\0')
        n--;
    return n;
}

enum cell_kind { CELL_TEXT, CELL_NUMBER, CELL_NOT_FINITE };

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

static enum cell_kind
read_cell(char *cell, char separator, double *x)
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

/* The number of cells of a line if all are numbers with this separator, else 0; NONE: no memory. */
static size_t
count_numbers(struct table *t, const char *line, char separator)
{
    double x;
    size_t numbers = 0;
    char *copy = strdup(line);
    size_t n = copy != NULL ? split(t, copy, separator) : NONE;
    for (size_t i = 0; n != NONE && i < n; i++) {
        enum cell_kind kind = read_cell(t->cell[i], separator, &x);
        if (kind == CELL_TEXT && !(t->opts->gaps != SS_GAPS_REFUSE && t->cell[i][0] == '\0'))
            n = 0;
        numbers += kind == CELL_NUMBER;
    }
    free(copy);
    return n == NONE || numbers > 0 ? n : 0;
}

/* --- the lines above the data -------------------------------------------------------------- */

/* Is this the first line of data?  Then t->separator and t->n_columns are set. */
static ss_status
is_data(struct table *t, const char *line, int *yes)
{
    static const char candidate[] = { '\t', ';', ',', ' ' };
    *yes = 0;
    for (size_t i = 0; i < sizeof candidate; i++) {
        size_t n = strchr(line, candidate[i]) != NULL || candidate[i] == ' '
                 ? count_numbers(t, line, candidate[i]) : 0;
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

/* The kind of a row above the data that has as many cells as the data. */
enum row_kind { ROW_OTHER, ROW_NAMES, ROW_UNITS, ROW_MIXED, ROW_NO_MEMORY };

static enum row_kind
kind_of_row(struct table *t, const char *line)
{
    size_t empty = 0, numbers = 0, units = 0;
    double x;
    if (line == NULL)
        return ROW_OTHER;
    char *copy = strdup(line);
    size_t n = copy != NULL ? split(t, copy, t->separator) : NONE;
    if (n == t->n_columns + 1 && strcasecmp(t->cell[n - 1], "comment") == 0)
        n--;                                    /* LabVIEW names a column that few of its rows have */
    for (size_t i = 0; n == t->n_columns && i < n; i++) {
        empty += t->cell[i][0] == '\0';
        units += (size_t)is_unit(t->cell[i]);
        numbers += read_cell(t->cell[i], t->separator, &x) != CELL_TEXT;
    }
    free(copy);
    if (n == NONE)
        return ROW_NO_MEMORY;
    if (n != t->n_columns)
        return ROW_OTHER;
    if (units == n && empty < n && numbers < n)
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
        *name = trim(*name);
        *unit = trim(*unit);
        return;
    }
    cell[n - 1] = '\0';
    if (opening > cell && opening[-1] == '/')
        opening[-1] = '\0';
    *opening = '\0';
    *name = trim(cell);
    *unit = trim(opening + 1);
}

/* A cell of the units row without the brackets around it. */
static char *
bare_unit(char *cell)
{
    size_t n = strlen(cell);
    if (n < 2 || !((cell[0] == '[' && cell[n - 1] == ']') || (cell[0] == '(' && cell[n - 1] == ')')))
        return cell;
    cell[n - 1] = '\0';
    return trim(cell + 1);
}

/* Columns with the names of one line and the units of another, which are cut up; either may be
 * NULL. */
static ss_status
name_columns(struct table *t, char *names, char *units)
{
    char **unit_cell = NULL, number[32];
    ss_status st = SS_OK;
    if (units != NULL) {
        if (split(t, units, t->separator) == NONE)
            return SS_ENOMEM;
        unit_cell = t->cell;                    /* kept beside those of the names */
        t->cell = NULL;
        t->cell_room = 0;
    }
    if (names != NULL && split(t, names, t->separator) == NONE)
        st = SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < t->n_columns; i++) {
        char *name = "", *unit = "";
        snprintf(number, sizeof number, "ch%zu", i + 1);
        if (names != NULL)
            split_name(t->cell[i], &name, &unit);
        if (units != NULL)
            unit = bare_unit(unit_cell[i]);
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

/* Rigol's oscilloscopes number the rows; beside the names of their columns are Start and Increment, and
 * below these words the times.  Read them if they are there, and leave names and units. */
static ss_status
find_increment(struct table *t)
{
    char *words = strdup(t->above[0] != NULL ? t->above[0] : ""), *numbers = NULL;
    size_t start = NONE, increment = NONE, n = words != NULL ? split(t, words, t->separator) : NONE;
    for (size_t i = t->n_columns; n != NONE && i < n; i++) {
        start = strcasecmp(t->cell[i], "Start") == 0 ? i : start;
        increment = strcasecmp(t->cell[i], "Increment") == 0 ? i : increment;
    }
    if (start != NONE && increment != NONE) {
        numbers = strdup(t->above[1]);
        n = numbers != NULL ? split(t, numbers, t->separator) : NONE;
        if (n != NONE && start < n && increment < n
            && read_cell(t->cell[start], t->separator, &t->origin) == CELL_NUMBER
            && read_cell(t->cell[increment], t->separator, &t->increment) == CELL_NUMBER) {
            cut(t->above[0], t->n_columns, t->separator);
            cut(t->above[1], t->n_columns, t->separator);
        }
    }
    free(words);
    free(numbers);
    return n != NONE ? SS_OK : SS_ENOMEM;
}

/* Find names and units in the last two lines above the data.
 *
 * A line with numbers in it is either a word about the record ("Rate;1000") or a row of data with
 * a bad cell: the latter if it begins with a number or stands below a row of names. */
static ss_status
read_names(struct table *t, ss_error *err)
{
    double x;
    ss_status st = find_increment(t);
    if (st == SS_OK && t->increment > 0) {
        t->named = 1;
        st = name_columns(t, t->above[0], t->above[1]);
        return st == SS_OK ? SS_OK : out_of_memory(t, err);
    }
    enum row_kind last = kind_of_row(t, t->above[1]), before = kind_of_row(t, t->above[0]);
    if (st != SS_OK || last == ROW_NO_MEMORY || before == ROW_NO_MEMORY)
        return out_of_memory(t, err);
    if (last == ROW_MIXED) {
        size_t n = split(t, t->above[1], t->separator), bad = n, numbers = 0;
        for (size_t i = n; i-- > 0; )
            if (read_cell(t->cell[i], t->separator, &x) == CELL_TEXT)
                bad = i;
            else
                numbers = i == 0 ? 1 : numbers;
        if (bad < n && (numbers > 0 || before == ROW_NAMES))
            return ss_fail(err, SS_EDATA, "%s:%lu: column %zu: '%.40s' is not a number", t->in->name,
                           t->above_line[1], bad + 1, t->cell[bad]);
        last = ROW_OTHER;
    }
    t->named = last != ROW_OTHER;
    if (last == ROW_UNITS && before == ROW_NAMES)
        st = name_columns(t, t->above[0], t->above[1]);
    else
        st = name_columns(t, t->named ? t->above[1] : NULL, NULL);
    return st == SS_OK ? SS_OK : out_of_memory(t, err);
}

/* --- rows ---------------------------------------------------------------------------------- */

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
    size_t n = split(t, text, t->separator);
    if (n == NONE || !make_room(t))
        return out_of_memory(t, err);
    if (n != t->n_columns)
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu columns, found %zu", name, line,
                       t->n_columns, n);
    double *row = t->value + t->n_rows * n;
    for (size_t i = 0; i < n; i++) {
        enum cell_kind kind = read_cell(t->cell[i], t->separator, &row[i]);
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
            return out_of_memory(t, err);
        if (!found && !keep_above(t, line + strspn(line, "# ")))
            return out_of_memory(t, err);
    }
    if (t->n_columns > MAX_COLUMNS)
        return ss_fail(err, SS_EDATA, "%s:%lu: more than 32768 columns", t->in->name, t->in->line);
    char *first = strdup(line);                 /* split below, and for the names */
    if (first == NULL)
        return out_of_memory(t, err);
    st = read_names(t, err);
    if (st == SS_OK)
        st = append_row(t, first, err);
    free(first);
    while (st == SS_OK && (st = next_line(t, &line, &comment, err)) == SS_OK && line != NULL)
        if (!comment)
            st = append_row(t, line, err);
    return st;
}

/* --- the clock ----------------------------------------------------------------------------- */

/* Seconds are stamps * factor / divisor. */
struct time_unit {
    const char *name;
    double factor, divisor;
};

static const struct time_unit *
find_time_unit(const char *name)
{
    static const struct time_unit known[] = {
        { "", 1, 1 }, { "s", 1, 1 }, { "sec", 1, 1 }, { "seconds", 1, 1 }, { "ms", 1, 1e3 },
        { "us", 1, 1e6 }, { "\u00b5s", 1, 1e6 }, { "\u03bcs", 1, 1e6 }, { "ns", 1, 1e9 },
        { "min", 60, 1 }, { "h", 3600, 1 }, { NULL, 0, 0 } };
    for (const struct time_unit *u = known; u->name != NULL; u++)
        if (strcasecmp(name, u->name) == 0)
            return u;
    return NULL;
}

/* Is this column called time?  "Time", "t", "time_ms"; the unit in its name is then *unit. */
static int
is_called_time(const ss_column *c, const char **unit)
{
    static const char *const word[] = { "t", "time", "timestamp", "zeit", "x_value",
        "second", "seconds", NULL };
    *unit = c->unit;
    for (int i = 0; word[i] != NULL; i++) {
        size_t n = strlen(word[i]);
        if (strncasecmp(c->name, word[i], n) != 0)
            continue;
        if (c->name[n] == '\0')
            return 1;
        if (c->name[n] == '_' && find_time_unit(c->name + n + 1) != NULL) {
            if (**unit == '\0')
                *unit = c->name + n + 1;
            return 1;
        }
    }
    return 0;
}

/* Forget the rows without a time. */
static void
drop_rows_without(struct table *t, size_t column)
{
    size_t kept = 0, n = t->n_columns;
    for (size_t i = 0; i < t->n_rows; i++)
        if (!isnan(t->value[i * n + column])) {
            memmove(t->value + kept * n, t->value + i * n, n * sizeof *t->value);
            t->line[kept++] = t->line[i];
        }
    t->n_rows = kept;
}

/* The rows as samples at their indices, NaN between them. */
static ss_status
spread_rows(struct table *t, const size_t *sample, ss_error *err)
{
    size_t n = t->n_columns, all = sample[t->n_rows - 1] + 1;
    if (all == t->n_rows)
        return SS_OK;
    if (all / GAPS_MOST > t->n_rows)
        return ss_fail(err, SS_EDATA, "%s: of %zu samples only %zu are there", t->in->name, all,
                       t->n_rows);
    double *value = malloc(all * n * sizeof *value);
    if (value == NULL)
        return out_of_memory(t, err);
    for (size_t i = 0; i < all * n; i++)
        value[i] = NAN;
    for (size_t i = 0; i < t->n_rows; i++)
        memcpy(value + sample[i] * n, t->value + i * n, n * sizeof *value);
    free(t->value);
    t->value = value;
    t->n_rows = all;
    return SS_OK;
}

/* Rows at stamps as samples of a clock: that of the stamps, or that of --resample. */
static ss_status
place_rows(struct table *t, const double *stamp, ss_error *err)
{
    const char *name = t->in->name;
    int gaps = t->opts->gaps != SS_GAPS_REFUSE;
    size_t *sample = NULL, n = t->n_rows;
    double usual, *value;
    if (!(t->opts->resample > 0)) {
        sample = malloc((n + 1) * sizeof *sample);
        if (sample == NULL)
            return out_of_memory(t, err);
        ss_status st = ss_find_clock(name, stamp, t->line, n, gaps, sample, &t->names->rate, err);
        if (st == SS_OK)
            st = spread_rows(t, sample, err);
        free(sample);
        return st;
    }
    ss_status st = ss_usual_step(name, stamp, t->line, n, &usual, err);
    t->names->rate = t->opts->resample;
    if (st == SS_OK)
        st = ss_resample(&value, &n, stamp, t->value, n, t->n_columns, usual, t->names->rate, name, err);
    if (st != SS_OK)
        return st;
    free(t->value);
    t->value = value;
    t->n_rows = n;
    for (size_t i = 0; !gaps && i < n; i++)
        if (isnan(value[i * t->n_columns]))
            return ss_fail(err, SS_EGAPS, "%s: a gap around %g s, of more than ten usual steps of %g s", name,
                           stamp[0] + (double)i / t->names->rate, usual);
    return SS_OK;
}

/* The column holds times in this unit, counted from t->origin. */
static ss_status
read_stamps(struct table *t, size_t column, double factor, double divisor, ss_error *err)
{
    drop_rows_without(t, column);
    double *stamp = malloc((t->n_rows + 1) * sizeof *stamp);
    if (stamp == NULL)
        return out_of_memory(t, err);
    for (size_t i = 0; i < t->n_rows; i++)
        stamp[i] = t->origin + t->value[i * t->n_columns + column] * factor / divisor;
    ss_status st = place_rows(t, stamp, err);
    if (st == SS_OK) {
        t->names->start = stamp[0];
        t->time = column;
    }
    free(stamp);
    return st;
}

static ss_status
read_clock(struct table *t, size_t column, const char *unit_name, ss_error *err)
{
    const struct time_unit *unit = find_time_unit(unit_name);
    if (unit == NULL)
        return ss_fail(err, SS_EDATA, "%s: column %s: unit '%.40s' is not one of time", t->in->name,
                       t->names->column[column].name, unit_name);
    return read_stamps(t, column, unit->factor, unit->divisor, err);
}

static ss_status
no_such_column(const struct table *t, const char *name, ss_error *err)
{
    char list[300] = "";
    size_t length = 0, room = sizeof list - sizeof " ...";
    for (size_t i = 0; i < t->n_columns && length < room; i++) {
        size_t before = length;
        length += (size_t)snprintf(list + length, room - length, "%s%s", i > 0 ? ", " : "",
                                   t->names->column[i].name);
        if (length >= room)
            strcpy(list + before, " ...");
    }
    return ss_fail(err, SS_EDATA, "%s: no column '%.40s', there are %s", t->in->name, name, list);
}

static ss_status
choose_clock(struct table *t, ss_error *err)
{
    const ss_read_opts *opts = t->opts;
    const char *unit, *first = t->names->column[0].unit;
    int chosen = opts->time != NULL ? ss_header_column(t->names, opts->time) : -1;
    if (opts->time != NULL && chosen < 0)
        return no_such_column(t, opts->time, err);
    if (chosen >= 0) {
        is_called_time(&t->names->column[chosen], &unit);
        return read_clock(t, (size_t)chosen, unit, err);
    }
    if (opts->rate > 0) {
        t->names->rate = opts->rate;
        return SS_OK;
    }
    if (t->increment > 0)
        return read_stamps(t, 0, t->increment, 1, err);
    for (size_t i = 0; i < t->n_columns; i++)
        if (is_called_time(&t->names->column[i], &unit))
            return read_clock(t, i, unit, err);
    if (t->n_columns > 1 && *first != '\0' && find_time_unit(first) != NULL)
        return read_clock(t, 0, first, err);
    ss_status st = SS_ECLOCK;
    if (t->n_columns > 1 && !t->named)          /* a force over its deflection ascends too */
        st = read_clock(t, 0, "", NULL);
    if (st == SS_OK || st == SS_ENOMEM)
        return st == SS_OK ? SS_OK : out_of_memory(t, err);
    return ss_fail(err, SS_ECLOCK, "%s: no column of time", t->in->name);
}

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

/* --- as a reader --------------------------------------------------------------------------- */

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
        st = out_of_memory(&t, err);
    if (st == SS_OK)
        st = read_table(&t, err);
    if (st == SS_OK)
        st = choose_clock(&t, err);
    if (st == SS_OK && t.time != NONE && t.n_columns == 1)
        st = ss_fail(err, SS_EDATA, "%s: no column but time", in->name);
    if (st == SS_OK && drop_time(&t, &reader->head) != SS_OK)
        st = out_of_memory(&t, err);
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
