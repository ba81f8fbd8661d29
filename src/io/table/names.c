/* names.c -- names, units and a clock in the lines above the data of a text table.
 *
 * In most tables the last line names the columns, and one may give their units.  LabVIEW and other programs of
 * National Instruments say in lines that begin with a key what each column is: "Delta_X", "Interval" or "delta t",
 * "Y_Unit_Label" or "Unit", "Channel name".  The columns of x of LabVIEW's measurement files (.lvm) are as
 * "X_Columns" says: One comes first, Multi have one before each channel, and with No its place is empty and the
 * header alone has the clock.  (National Instruments, Specification for the LabVIEW Measurement File.) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "signal/header.h"
#include "io/table/text.h"

/* --- units --------------------------------------------------------------------------------- */

/* Is this one symbol of a unit, such as mm, kHz or kip? */
static int
is_unit_symbol(const char *p, size_t n)
{
    static const char *const symbol[] = { "m", "s", "g", "N", "Pa", "V", "A", "Hz", "K", "W", "J",
        "rad", "Ohm", "bar", "sec", "min", "h", "in", "inch", "ft", "lb", "lbf", "kip", "kips", "psi", "deg",
        "\u00b0", "\u00b0C", "\u00b0F", "degC", "degF", "%", "rpm", "RPM", "dB", "strain", "\u03a9", "Nm", "mil",
        "micron", "Volt", "Volts", NULL };
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

/* --- keys --------------------------------------------------------------------------------- */

static const char *const step_keys[] = { "Delta_X", "Interval", "delta t", NULL };
static const char *const start_keys[] = { "X0", NULL };
static const char *const unit_keys[] = { "Y_Unit_Label", "Unit", "Units", NULL };
static const char *const name_keys[] = { "Channel name", "Channel names", "waveform", NULL };
static const char *const dimension_keys[] = { "X_Dimension", NULL };
static const char *const layout_keys[] = { "X_Columns", NULL };

static int
is_one_of(const char *cell, const char *const *word)
{
    for (; *word != NULL; word++)
        if (strcasecmp(cell, *word) == 0)
            return 1;
    return 0;
}

/* --- lines above the data ------------------------------------------------------------------ */

/* The kind of a row above the data, if it has as many cells as the data. */
enum row_kind { ROW_OTHER, ROW_NAMES, ROW_UNITS, ROW_MIXED };

static enum row_kind
kind_of_row(struct text *x, const char *line)
{
    size_t empty = 0, numbers = 0, units = 0, columns = x->t.n_columns;
    double number;
    size_t n = line != NULL ? ss_text_split(x, line, x->separator) : 0;
    if (n == columns + 1 && strcasecmp(x->cell[n - 1], "comment") == 0) {
        n--;                                    /* LabVIEW names a column of comments that few rows have */
        x->comments = 1;
    }
    if (n != columns)
        return ROW_OTHER;
    for (size_t i = 0; i < n; i++) {
        empty += x->cell[i][0] == '\0';
        units += (size_t)is_unit(x->cell[i]);
        numbers += ss_cell_read(x->cell[i], x->separator, &number) != CELL_TEXT;
    }
    if (units == n && empty + numbers < n)
        return ROW_UNITS;
    return numbers > 0 ? ROW_MIXED : ROW_NAMES;
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

/* Is a line of words one of units, since it has one of time below the name of a time, or a whole word for it? */
static int
has_unit_of_time(struct text *x, const char *names, const char *units)
{
    size_t n = ss_text_split(x, names, x->separator), at = 0;
    while (at < n && !ss_is_called_time(x->cell[at]))
        at++;
    const int is_named = at < n;
    ss_text_split(x, units, x->separator);
    const char *unit = bare_unit(x->cell[is_named ? at : 0]);
    return ss_time_unit_find(unit) != NULL && (is_named || unit[1] != '\0');
}

/* Cut "name (unit)", "name [unit]", "name/unit", "name, unit" or "name in unit" in two. */
static void
split_name(char *cell, char **name, char **unit)
{
    static const char *const before[] = { ",", " in " };
    size_t n = strlen(cell);
    char closing = n > 0 ? cell[n - 1] : '\0', *end = NULL;
    char *opening = closing == ')' ? strchr(cell, '(') : closing == ']' ? strchr(cell, '[') : NULL;
    if (opening != NULL && opening != cell) {
        cell[n - 1] = '\0';
        if (opening[-1] == '/')
            opening[-1] = '\0';
        *opening = '\0';
        *name = ss_cell_trim(cell);
        *unit = ss_cell_trim(opening + 1);
        return;
    }
    for (size_t i = 0; i < sizeof before / sizeof *before; i++)
        for (char *at = strstr(cell, before[i]); at != NULL && end == NULL; at = strstr(at + 1, before[i])) {
            char *rest = at + strlen(before[i]);
            rest += strspn(rest, " ");
            if (*rest != '\0' && strchr("0123456789.-", *rest) == NULL && is_unit(rest)) {
                *at = '\0';
                end = rest;
            }
        }
    ss_split_label(cell, name, unit);
    *name = ss_cell_trim(*name);
    *unit = end != NULL ? end : ss_cell_trim(*unit);
}

static void
set_unit(struct text *x, size_t column, const char *unit)
{
    char *clean = ss_clean_unit(unit), **of = &x->t.names->column[column].unit;
    if (clean == NULL) {
        x->status = SS_ENOMEM;
        return;
    }
    free(*of);
    *of = clean;
}

/* Name the columns by one line and give them the units of another; either may be NULL. */
static void
name_columns(struct text *x, const char *names, const char *units)
{
    char number[32];
    if (names != NULL)
        ss_text_split(x, names, x->separator);
    for (size_t i = 0; x->status == SS_OK && i < x->t.n_columns; i++) {
        char *name = "", *unit = "";
        snprintf(number, sizeof number, "ch%zu", i + 1);
        if (names != NULL)
            split_name(x->cell[i], &name, &unit);
        x->status = ss_header_add_column(x->t.names, *name != '\0' ? name : number,
                                         *unit != '\0' ? unit : ss_unit_of_name(name, NULL), NULL);
    }
    if (units != NULL)
        ss_text_split(x, units, x->separator);
    for (size_t i = 0; x->status == SS_OK && units != NULL && i < x->t.n_columns; i++)
        set_unit(x, i, bare_unit(x->cell[i]));
}

/* The text of the kept line that is `up` lines above the last one, which is just above the data; NULL if
 * there is none. */
static const char *
line_above(const struct text *x, size_t up)
{
    return x->n_head > up ? x->head[x->n_head - 1 - up].text : NULL;
}

/* Rigol's oscilloscopes number the rows.  Behind the names of their columns they write Start and Increment, and
 * the two times in the line below. */
static void
find_increment(struct text *x)
{
    const char *above = line_above(x, 1), *last = line_above(x, 0);
    size_t at_start = NONE, at_step = NONE;
    double start, step;
    size_t n = ss_text_split(x, above != NULL ? above : "", x->separator);
    for (size_t i = x->t.n_columns; i < n; i++) {
        at_start = strcasecmp(x->cell[i], "Start") == 0 ? i : at_start;
        at_step = strcasecmp(x->cell[i], "Increment") == 0 ? i : at_step;
    }
    if (at_start == NONE || at_step == NONE)
        return;
    n = ss_text_split(x, last, x->separator);
    if (at_start >= n || at_step >= n || ss_cell_read(x->cell[at_start], x->separator, &start) != CELL_NUMBER
        || ss_cell_read(x->cell[at_step], x->separator, &step) != CELL_NUMBER || !(step > 0))
        return;
    x->t.counted.origin = start;
    x->t.counted.increment = step;
    x->t.counted.numbered = 1;
}

/* Refuse the last line, which has numbers, if it is a row with a bad cell. */
static void
check_mixed(struct text *x, enum row_kind before)
{
    double number;
    const struct text_line *line = &x->head[x->n_head - 1];
    size_t n = ss_text_split(x, line->text, x->separator), bad = n;
    int has_words = 0, begins = ss_cell_read(x->cell[0], x->separator, &number) != CELL_TEXT;
    for (size_t i = n; i-- > 0; )
        if (ss_cell_read(x->cell[i], x->separator, &number) == CELL_TEXT) {
            has_words |= x->cell[i][0] != '\0';
            bad = i;
        }
    int has_key = is_one_of(x->cell[0], step_keys) || is_one_of(x->cell[0], unit_keys)
        || is_one_of(x->cell[0], name_keys);
    int is_row = begins || !has_words || (before == ROW_NAMES && !has_key);
    if (bad < n && is_row)
        ss_text_fail(x, x->cell[bad][0] != '\0' ? SS_EDATA : SS_EGAPS, line->number,
                     "column %zu: '%.40s' is not a number%s", bad + 1, x->cell[bad],
                     ss_cell_is_grouped(x->cell[bad]) ? ": it has separators of thousands; remove them" : "");
}

/* --- lines that begin with a key ----------------------------------------------------------- */

/* Find the last kept line that begins with one of these words.  Returns the number of cells behind the
 * word, which are in x->cell + 1; 0: there is no such line. */
static size_t
find_line(struct text *x, const char *const *word)
{
    size_t n_columns = x->t.n_columns, found = 0;
    x->t.n_columns = 0;                         /* then all empty cells at the end are dropped */
    for (size_t i = x->n_head; found == 0 && i-- > 0;) {
        size_t n = ss_text_split(x, x->head[i].text, x->separator);
        x->cell[0][strcspn(x->cell[0], ":")] = '\0';
        found = n > 1 && is_one_of(x->cell[0], word) ? n - 1 : 0;
    }
    x->t.n_columns = n_columns;
    return found;
}

/* The number that all cells of a line have in common.  *n becomes the number of these cells, 0 if there is no such
 * line.  Cells without a number, such as dates, do not count. */
static double
read_same(struct text *x, const char *const *word, size_t *n)
{
    size_t cells = find_line(x, word);
    double same = 0, value;
    *n = 0;
    for (size_t i = 1; i <= cells; i++) {
        if (ss_cell_read(x->cell[i], x->separator, &value) != CELL_NUMBER)
            continue;
        if (*n > 0 && fabs(value - same) > 1e-9 * fabs(value))
            ss_text_fail(x, SS_EDATA, 0, "channels of different clocks: %s is %s and %.9g", word[0], x->cell[i],
                         same);
        same = value;
        ++*n;
    }
    return same;
}

/* If there is a line of names or units, give them to every step-th column from `first` on. */
static void
label_columns(struct text *x, const char *const *word, size_t first, size_t step)
{
    size_t n = find_line(x, word);
    ss_header *head = NULL, *old = x->t.names;
    if (x->status == SS_OK && word == name_keys)
        x->status = ss_header_new(&head, 0, 0, NULL);
    for (size_t c = 0; x->status == SS_OK && c < x->t.n_columns; c++) {
        size_t i = (c - first) / step + 1;
        const char *cell = c >= first && (c - first) % step == 0 && i <= n ? x->cell[i] : "";
        if (head != NULL)
            x->status = ss_header_add_column(head, *cell != '\0' ? cell : old->column[c].name, old->column[c].unit,
                                             NULL);
        else if (*cell != '\0')
            set_unit(x, c, cell);
    }
    x->t.names = x->status == SS_OK && head != NULL ? head : old;
    ss_header_free(x->t.names == head ? old : head);
}

/* Read names, units and clock from lines that begin with a key: Interval, Delta_X, Unit. */
static void
name_by_keys(struct text *x)
{
    static const char *const layout[] = { "No", "One", "Multi" };
    size_t n, ignored;
    if (!x->labview && find_line(x, name_keys) == 0)
        return;
    double step = read_same(x, step_keys, &n), start = read_same(x, start_keys, &ignored);
    if (x->labview && find_line(x, layout_keys) > 0)
        for (int i = LAYOUT_NO; i <= LAYOUT_MULTI; i++)
            x->layout = strcasecmp(x->cell[1], layout[i]) == 0 ? i : (int)x->layout;
    if (x->status != SS_OK || n == 0 || !(step > 0) || x->t.n_columns < n)
        return;
    if (x->labview && (find_line(x, dimension_keys) == 0 || strcasecmp(x->cell[1], "Time") != 0))
        ss_text_fail(x, SS_EDATA, 0, "the X_Dimension of its channels is not Time");
    size_t first = x->first_x = x->t.n_columns > n, every = x->labview && x->layout == LAYOUT_MULTI ? 2 : 1;
    label_columns(x, unit_keys, first, every);
    label_columns(x, name_keys, first, every);
    x->t.named = 1;
    x->t.counted.origin = start;
    x->t.counted.increment = step;
    x->t.counted.numbered = 0;
}

void
ss_text_read_names(struct text *x)
{
    const char *last_line = line_above(x, 0), *above = line_above(x, 1);
    find_increment(x);
    if (x->t.counted.increment > 0) {
        x->t.named = 1;
        name_columns(x, above, last_line);
    } else {
        enum row_kind last = kind_of_row(x, last_line), before = kind_of_row(x, above);
        if (last == ROW_MIXED)
            check_mixed(x, before);
        int is_units = last == ROW_UNITS
            || (last == ROW_NAMES && before == ROW_NAMES && has_unit_of_time(x, above, last_line));
        x->t.named = last == ROW_NAMES || last == ROW_UNITS;
        if (is_units && before == ROW_NAMES)
            name_columns(x, above, last_line);
        else
            name_columns(x, x->t.named ? last_line : NULL, NULL);
    }
    if (x->status == SS_OK)
        name_by_keys(x);
}

/* --- the columns of x ---------------------------------------------------------------------- */

#define MOST_APART 0.1          /* a time may be off by so many sample periods, as on any clock */
#define MOST_ROUNDING 5.1e-7    /* [s] LabVIEW writes six decimals */

/* The first column may repeat the times that the header gives, or hold the rows' numbers.  Where each channel has
 * a column of times, they must be equal; all but the first are left out. */
void
ss_text_check_times(struct text *x)
{
    struct sheet *t = &x->t;
    const double *row, step = t->counted.increment;
    double first = 0, from_times = 0, from_numbers = 0;
    size_t other = t->n_columns;
    int each = x->labview && x->layout == LAYOUT_MULTI;
    if (x->status != SS_OK || !(step > 0) || t->counted.numbered || t->column[0].kind != COLUMN_NUMBERS
        || t->opts->time != NULL || t->opts->rate > 0)
        return;
    for (uint64_t i = 0; (row = ss_kept_row(&t->rows, i)) != NULL; i++) {
        for (size_t c = 2; each && c < other; c += 2)
            if (row[0] < row[c] || row[0] > row[c])
                other = c;
        first = i == 0 ? row[0] : first;
        from_times = fmax(from_times, fabs(row[0] - first - (double)i * step));
        from_numbers = fmax(from_numbers, fabs(row[0] - first - (double)i));
    }
    x->status = ss_kept_check(&t->rows, x->err);
    if (each && other < t->n_columns)
        ss_text_fail(x, SS_EDATA, 0, "column %zu: the times of its channel are not those of the first; make a "
                     "file of each", other + 1);
    for (size_t c = 2; each && c < t->n_columns; c += 2)
        t->column[c].kind = COLUMN_TEXT;
    if (x->status != SS_OK || x->first_x == 0 || (x->labview && x->layout == LAYOUT_NO))
        return;
    if (from_times > fmax(MOST_APART * step, MOST_ROUNDING) && from_numbers > 1e-6) {
        free(t->names->column[0].name);         /* nor does it number the rows: it has the times */
        t->names->column[0].name = strdup("X_Value");
        x->status = t->names->column[0].name != NULL ? SS_OK : SS_ENOMEM;
        t->counted.increment = 0;
        set_unit(x, 0, "s");
        return;
    }
    if (from_times <= fmax(MOST_APART * step, MOST_ROUNDING))
        t->counted.origin = first;
    t->column[0].kind = COLUMN_TEXT;
}
