/* delimited_labview.c -- headers of LabVIEW and of other programs of National Instruments, which
 * say in lines above the data what each column is: "Delta_X", "Interval" or "delta t",
 * "Y_Unit_Label" or "Unit", "Channel name".
 *
 * The columns of x of LabVIEW's measurement files (.lvm) are as "X_Columns" says: One comes first,
 * Multi have one before each channel, and with No its place is empty and the header alone has the
 * clock.  (National Instruments, Specification for the LabVIEW Measurement File.) */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/error.h"
#include "io/table/delimited.h"

static const char *const steps[] = { "Delta_X", "Interval", "delta t", NULL };
static const char *const starts[] = { "X0", NULL };
static const char *const units[] = { "Y_Unit_Label", "Unit", "Units", NULL };
static const char *const names[] = { "Channel name", "Channel names", "waveform", NULL };
static const char *const dimensions[] = { "X_Dimension", NULL };
static const char *const layouts[] = { "X_Columns", NULL };

static int
is_one_of(const char *cell, const char *const *word)
{
    for (; *word != NULL; word++)
        if (strcasecmp(cell, *word) == 0)
            return 1;
    return 0;
}

int
ss_delimited_is_key(const char *cell)
{
    return is_one_of(cell, steps) || is_one_of(cell, units) || is_one_of(cell, names);
}

/* Find the last kept line that begins with one of these words.  Returns the number of cells behind the
 * word, which are in t->cell + 1; 0: there is no such line; NONE: no memory.  The cells lie in *text,
 * which is to be freed. */
static size_t
find_line(struct table *t, const char *const *word, char **text)
{
    *text = NULL;
    for (size_t i = t->n_head; i-- > 0;) {
        size_t n_columns = t->n_columns;
        char *copy = strdup(t->head[i].text);
        t->n_columns = 0;                       /* then all empty cells at the end are dropped */
        size_t n = copy != NULL ? ss_delimited_split(t, copy, t->separator) : NONE;
        t->n_columns = n_columns;
        if (n == NONE) {
            free(copy);
            return NONE;
        }
        t->cell[0][strcspn(t->cell[0], ":")] = '\0';
        if (n > 1 && is_one_of(t->cell[0], word)) {
            *text = copy;
            return n - 1;
        }
        free(copy);
    }
    return 0;
}

/* --- what the lines say -------------------------------------------------------------------- */

/* Read the number that all cells of a line have in common.  *n becomes the number of these cells, 0 if
 * there is no such line.  Cells without a number, such as dates, do not count. */
static ss_status
read_same(struct table *t, const char *const *word, double *x, size_t *n, ss_error *err)
{
    char *text;
    size_t cells = find_line(t, word, &text);
    ss_status st = cells == NONE ? ss_delimited_no_memory(t, err) : SS_OK;
    *n = 0;
    for (size_t i = 1; st == SS_OK && i <= cells; i++) {
        double value;
        if (ss_cell_read(t->cell[i], t->separator, &value) != CELL_NUMBER)
            continue;
        if (*n > 0 && fabs(value - *x) > 1e-9 * fabs(value))
            st = ss_fail(err, SS_EDATA, "%s: channels of different clocks: %s is %s and %.9g", t->in->name,
                         word[0], t->cell[i], *x);
        *x = value;
        ++*n;
    }
    free(text);
    return st;
}

/* *found becomes the index of a line's second cell in the list of choices; it stays as it is if there is
 * no such line. */
static ss_status
read_choice(struct table *t, const char *const *word, const char *const *choice, int *found, ss_error *err)
{
    char *text;
    size_t n = find_line(t, word, &text);
    for (int i = 0; n != NONE && n > 0 && choice[i] != NULL; i++)
        if (strcasecmp(t->cell[1], choice[i]) == 0)
            *found = i;
    free(text);
    return n != NONE ? SS_OK : ss_delimited_no_memory(t, err);
}

/* If there is a line of names or units, give them to every step-th column from `first` on. */
static ss_status
label_columns(struct table *t, const char *const *word, size_t first, size_t step, int is_unit, ss_error *err)
{
    char *text;
    size_t n = find_line(t, word, &text);
    ss_header *head = ss_header_new(0, 0);
    ss_status st = n != NONE && head != NULL ? SS_OK : SS_ENOMEM;
    for (size_t c = 0; st == SS_OK && c < t->n_columns; c++) {
        const ss_column *old = &t->names->column[c];
        size_t i = (c - first) / step + 1;
        const char *cell = c >= first && (c - first) % step == 0 && i <= n ? t->cell[i] : "";
        st = ss_header_add_column(head, *cell != '\0' && !is_unit ? cell : old->name,
                                  *cell != '\0' && is_unit ? cell : old->unit);
    }
    free(text);
    if (st == SS_OK && n > 0) {
        ss_header_free(t->names);
        t->names = head;
        return SS_OK;
    }
    ss_header_free(head);
    return st == SS_OK ? SS_OK : ss_delimited_no_memory(t, err);
}

/* --- the columns of x ---------------------------------------------------------------------- */

/* Column 0 becomes the column of times, in seconds. */
static ss_status
name_first_time(struct table *t, ss_error *err)
{
    ss_header *head = ss_header_new(0, 0);
    ss_status st = head != NULL ? ss_header_add_column(head, "X_Value", "s") : SS_ENOMEM;
    for (size_t c = 1; st == SS_OK && c < t->n_columns; c++)
        st = ss_header_add_column(head, t->names->column[c].name, t->names->column[c].unit);
    if (st != SS_OK) {
        ss_header_free(head);
        return ss_delimited_no_memory(t, err);
    }
    ss_header_free(t->names);
    t->names = head;
    return SS_OK;
}

int
ss_delimited_is_segment(const struct table *t, const char *line)
{
    return t->labview && strncmp(line, "Channels", 8) == 0;
}

ss_status
ss_delimited_read_labview(struct table *t, ss_error *err)
{
    static const char *const layout[] = { "No", "One", "Multi", NULL };
    static const char *const dimension[] = { "Time", NULL };
    size_t n = 0, ignored;
    double step = 0, start = 0;
    int is_time = -1, layout_found = (int)t->layout;
    char *text;
    size_t named = find_line(t, names, &text);
    free(text);
    if (named == NONE)
        return ss_delimited_no_memory(t, err);
    if (!t->labview && named == 0)
        return SS_OK;
    ss_status st = read_same(t, steps, &step, &n, err);
    if (st == SS_OK)
        st = read_same(t, starts, &start, &ignored, err);
    if (st == SS_OK && t->labview)
        st = read_choice(t, layouts, layout, &layout_found, err);
    if (st == SS_OK && t->labview)
        st = read_choice(t, dimensions, dimension, &is_time, err);
    t->layout = layout_found;
    if (st != SS_OK || n == 0 || !(step > 0) || t->n_columns < n)
        return st;
    if (t->labview && is_time < 0)
        return ss_fail(err, SS_EDATA, "%s: the X_Dimension of its channels is not Time", t->in->name);
    size_t first = t->first_x = t->n_columns > n, every = t->labview && t->layout == LAYOUT_MULTI ? 2 : 1;
    st = label_columns(t, units, first, every, 1, err);
    if (st == SS_OK)
        st = label_columns(t, names, first, every, 0, err);
    t->named = 1;
    t->counted = (struct counted){ start, step, 0 };
    return st;
}

/* Find the first column of x that differs from column 0; n_columns: there is none. */
static ss_status
find_other_times(struct table *t, size_t *first, ss_error *err)
{
    const double *row;
    ss_status st = ss_delimited_rewind(t, err);
    *first = t->n_columns;
    while (st == SS_OK && (st = ss_delimited_next(t, &row, err)) == SS_OK && row != NULL)
        for (size_t i = 2; i < *first; i += 2)
            if (row[0] < row[i] || row[0] > row[i])
                *first = i;
    return st;
}

#define MOST_APART 0.1          /* a time may be off by so many sample periods, as on any clock */
#define MOST_ROUNDING 5.1e-7    /* [s] LabVIEW writes six decimals */

/* Find the largest distance of the first column from times that go on by this step. */
static ss_status
find_farthest(struct table *t, double step, double *most, ss_error *err)
{
    const double *row;
    ss_status st = ss_delimited_rewind(t, err);
    *most = 0;
    for (double i = 0; st == SS_OK && (st = ss_delimited_next(t, &row, err)) == SS_OK && row != NULL; i++)
        *most = fmax(*most, fabs(row[0] - t->first[0] - i * step));
    return st;
}

/* Each channel has a column of times.  They must be equal; all but the first are left out. */
static ss_status
leave_one_x(struct table *t, ss_error *err)
{
    size_t other;
    ss_status st = find_other_times(t, &other, err);
    if (st == SS_OK && other < t->n_columns)
        return ss_fail(err, SS_EDATA, "%s: column %zu: the times of its channel are not those of "
                       "the first; make a file of each", t->in->name, other + 1);
    for (size_t i = 2; i < t->n_columns; i += 2)
        t->column[i].kind = COLUMN_TEXT;
    return st;
}

/* The first column may repeat the times that the header gives, or hold the rows' numbers. */
ss_status
ss_delimited_check_labview(struct table *t, ss_error *err)
{
    const struct counted c = t->counted;
    double from_times, from_numbers;
    if (!(c.increment > 0) || c.numbered || t->column[0].kind != COLUMN_NUMBERS || t->opts->time != NULL
        || t->opts->rate > 0)
        return SS_OK;
    ss_status st = t->labview && t->layout == LAYOUT_MULTI ? leave_one_x(t, err) : SS_OK;
    if (st != SS_OK || t->first_x == 0 || (t->labview && t->layout == LAYOUT_NO))
        return st;
    if ((st = find_farthest(t, c.increment, &from_times, err)) != SS_OK
        || (st = find_farthest(t, 1, &from_numbers, err)) != SS_OK)
        return st;
    if (from_times <= fmax(MOST_APART * c.increment, MOST_ROUNDING)) {
        t->counted.origin = t->first[0];
    } else if (from_numbers > 1e-6) {           /* nor does it number the rows */
        t->counted = (struct counted){ 0, 0, 0 };
        return name_first_time(t, err);
    }
    t->column[0].kind = COLUMN_TEXT;
    return SS_OK;
}
