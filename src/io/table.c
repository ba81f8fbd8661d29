/* table.c -- read tables of words and numbers of any kind. */
#include <stickslip/table.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "signal/header.h"
#include "io/input.h"
#include "io/record.h"

typedef struct table_reader {
    struct input in;
    ss_table *table;
    char *columns_text;                 /* the columns as the first header names them */
    size_t notes, columns, cells;       /* the room of each list */
} table_reader;

/* Read the labels of the columns, which blanks separate. */
static ss_status
read_columns(table_reader *r, char *text, ss_error *err)
{
    ss_table *t = r->table;
    char *name, *unit;
    if (r->columns_text != NULL)
        return strcmp(text, r->columns_text) == 0 ? SS_OK
            : ss_fail(err, SS_EDATA, "%s:%lu: other columns than before", r->in.name, r->in.line);
    if ((r->columns_text = strdup(text)) == NULL)
        return ss_fail_memory(err, r->in.name);
    while (ss_next_label(&text, &name, &unit)) {
        if (t->n_columns == MAX_COLUMNS)
            return ss_fail(err, SS_EDATA, "%s:%lu: more than %d columns", r->in.name, r->in.line, MAX_COLUMNS);
        ss_column *more = ss_list_room(t->column, &r->columns, t->n_columns, sizeof *more);
        if (more == NULL)
            return ss_fail_memory(err, r->in.name);
        t->column = more;
        more += t->n_columns++;
        *more = (ss_column){ strdup(name), strdup(unit) };
        if (more->name == NULL || more->unit == NULL)
            return ss_fail_memory(err, r->in.name);
    }
    return SS_OK;
}

/* Read a row.  Its cells lie in a copy of the line, which begins with the first of them. */
static ss_status
read_row(table_reader *r, const char *line, ss_error *err)
{
    ss_table *t = r->table;
    size_t found = 1;
    for (const char *p = line; *p != '\0'; p++)
        found += *p == '\t';
    if (t->n_columns == 0)
        return ss_fail(err, SS_EDATA, "%s:%lu: no '# columns:' line in the header", r->in.name, r->in.line);
    if (found != t->n_columns)
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu column%s, found %zu", r->in.name,
                       r->in.line, t->n_columns, PLURAL(t->n_columns), found);
    char **more = ss_list_room(t->cell, &r->cells, t->n, t->n_columns * sizeof *more);
    char *copy = more != NULL ? strdup(line) : NULL;
    t->cell = more != NULL ? more : t->cell;
    if (copy == NULL)
        return ss_fail_memory(err, r->in.name);
    for (size_t c = 0; c < t->n_columns; c++) {
        size_t length = strcspn(copy, "\t");
        more[t->n * t->n_columns + c] = copy;
        copy += length + (copy[length] == '\t');
        if (c + 1 < t->n_columns)
            copy[-1] = '\0';
    }
    t->n++;
    return SS_OK;
}

ss_status
ss_table_read(ss_table **out, FILE *in, const char *name, ss_kind kind, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    if (kind < SS_KIND_FEATURES || kind > SS_KIND_SUMMARIES)
        return ss_fail(err, SS_EINVAL, "text of this kind is no table");
    static const char columns[] = "# columns: ";
    table_reader r = { .table = calloc(1, sizeof *r.table) };
    ss_table *t = r.table;
    char *line;
    *out = NULL;
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK && t == NULL)
        st = ss_fail_memory(err, name);
    if (st == SS_OK)
        st = ss_input_begin(&r.in, kind, err);
    while (st == SS_OK && (st = ss_input_row(&r.in, &line, err)) == SS_OK && line != NULL)
        if (strncmp(line, columns, strlen(columns)) == 0)
            st = read_columns(&r, line + strlen(columns), err);
        else if (line[0] != '#')
            st = read_row(&r, line, err);
        else if (strstr(line, ": ") != NULL) {
            char **more = ss_list_room(t->note, &r.notes, t->n_notes, sizeof *more);
            t->note = more != NULL ? more : t->note;
            if (more == NULL || (more[t->n_notes++] = strdup(line + 1 + strspn(line + 1, " "))) == NULL)
                st = ss_fail_memory(err, name);
        }
    if (st == SS_OK && t->n_columns == 0)
        st = ss_fail(err, SS_EDATA, "%s: no '# columns:' line in the header", name);
    free(r.columns_text);
    ss_input_close(&r.in);
    if (st == SS_OK)
        *out = r.table;
    else
        ss_table_free(r.table);
    return st;
}

const char *
ss_table_note(const ss_table *table, const char *key)
{
    size_t length = key != NULL ? strlen(key) : 0;
    for (size_t i = 0; table != NULL && key != NULL && i < table->n_notes; i++)
        if (strncmp(table->note[i], key, length) == 0 && strncmp(table->note[i] + length, ": ", 2) == 0)
            return table->note[i] + length + 2;
    return NULL;
}

int
ss_table_column(const ss_table *table, const char *name)
{
    for (size_t c = 0; c < table->n_columns; c++)
        if (strcmp(table->column[c].name, name) == 0)
            return (int)c;
    return -1;
}

double
ss_table_number(const ss_table *table, size_t row, size_t column)
{
    if (row >= table->n || column >= table->n_columns)
        return NAN;
    const char *cell = table->cell[row * table->n_columns + column];
    char *end;
    double x = ss_number_parse(cell, &end);
    return end > cell && *end == '\0' ? x : NAN;
}

void
ss_table_free(ss_table *table)
{
    if (table == NULL)
        return;
    for (size_t i = 0; i < table->n_notes; i++)
        free(table->note[i]);
    for (size_t c = 0; c < table->n_columns; c++) {
        free(table->column[c].name);
        free(table->column[c].unit);
    }
    for (size_t i = 0; i < table->n; i++)
        free(table->cell[i * table->n_columns]);
    free(table->note);
    free(table->column);
    free(table->cell);
    free(table);
}
