/* sweep.c -- a sweep's rows read back. */
#include <stickslip/sweep.h>

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/signal.h>
#include "base/error.h"
#include "signal/header.h"
#include "stream/input.h"

typedef struct reader {
    ss_sweep_table *table;
    char *columns;                  /* what the header says of them */
    size_t room;
    double *rows;                   /* row after row, while they come in */
    struct input in;
} reader;

static ss_status
no_memory(ss_error *err)
{
    return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
}

void
ss_sweep_table_free(ss_sweep_table *t)
{
    if (t == NULL)
        return;
    for (size_t i = 0; i < t->n_columns; i++) {
        free(t->name[i]);
        free(t->unit[i]);
    }
    free(t->name);
    free(t->unit);
    free(t->value);
    free(t->scene);
    free(t);
}

static ss_status
add_column(reader *r, char *label, ss_error *err)
{
    ss_sweep_table *t = r->table;
    if (t->n_columns == MAX_COLUMNS)
        return ss_fail(err, SS_EDATA, "%s:%lu: more than %d columns", r->in.name, r->in.line,
                       MAX_COLUMNS);
    char *name, *unit, **names = realloc(t->name, (t->n_columns + 1) * sizeof *names), **units;
    if (names == NULL)
        return no_memory(err);
    t->name = names;
    units = realloc(t->unit, (t->n_columns + 1) * sizeof *units);
    if (units == NULL)
        return no_memory(err);
    t->unit = units;
    ss_split_label(label, &name, &unit);
    names[t->n_columns] = strdup(name);
    units[t->n_columns] = strdup(unit);
    t->n_columns++;
    return names[t->n_columns - 1] != NULL && units[t->n_columns - 1] != NULL ? SS_OK
        : no_memory(err);
}

/* "# columns: index friction/N contact_damping/(N s/m) ... status": blanks in brackets are the
 * unit's.  The status, which is last, is no number and stays out. */
static ss_status
take_columns(reader *r, char *text, ss_error *err)
{
    ss_status st = SS_OK;
    if (r->columns != NULL)                 /* shards one after the other: the header again */
        return strcmp(text, r->columns) == 0 ? SS_OK
            : ss_fail(err, SS_EDATA, "%s:%lu: other columns than before: another sweep",
                      r->in.name, r->in.line);
    if ((r->columns = strdup(text)) == NULL)
        return no_memory(err);
    char *label = text;
    while (st == SS_OK && *(text += strspn(text, " ")) != '\0') {
        label = text;
        for (int depth = 0; *text != '\0' && (depth > 0 || *text != ' '); text++)
            depth += (*text == '(') - (*text == ')');
        if (*text != '\0')
            *text++ = '\0';
        if (text[strspn(text, " ")] != '\0')
            st = add_column(r, label, err);
    }
    if (st == SS_OK && (r->table->n_columns == 0 || strcmp(label, "status") != 0))
        return ss_fail(err, SS_EDATA, "%s:%lu: the columns are the index, others, and the status",
                       r->in.name, r->in.line);
    return st;
}

/* A number, aperiodic, or - for what is not known. */
static ss_status
take_cell(const reader *r, const char *cell, double *value, ss_error *err)
{
    char *end;
    *value = ss_number_parse(cell, &end);
    if (strcmp(cell, "-") == 0)
        *value = NAN;
    else if (strcmp(cell, "aperiodic") == 0)
        *value = 0;
    else if (end == cell || *end != '\0' || !isfinite(*value))
        return ss_fail(err, SS_EDATA, "%s:%lu: '%.40s' is not a finite number", r->in.name,
                       r->in.line, cell);
    return SS_OK;
}

static ss_status
take_row(reader *r, char *line, ss_error *err)
{
    ss_sweep_table *t = r->table;
    ss_status st = SS_OK;
    if (t->n_columns == 0)
        return ss_fail(err, SS_EDATA, "%s:%lu: no '# columns:' line in the header", r->in.name,
                       r->in.line);
    if (t->n == r->room) {
        size_t more = r->room > 0 ? 2 * r->room : 1 + 1024 / t->n_columns;
        double *rows = more <= SIZE_MAX / sizeof *rows / t->n_columns
            ? realloc(r->rows, more * t->n_columns * sizeof *rows) : NULL;
        if (rows == NULL)
            return no_memory(err);
        r->rows = rows;
        r->room = more;
    }
    double *row = r->rows + t->n++ * t->n_columns;
    size_t found = 1;
    for (const char *p = line; *p != '\0'; p++)
        found += *p == '\t';
    if (found != t->n_columns + 1)
        return ss_fail(err, SS_EDATA, "%s:%lu: expected %zu columns, found %zu", r->in.name,
                       r->in.line, t->n_columns + 1, found);
    for (size_t i = 0; st == SS_OK && i < t->n_columns; i++) {
        char *end = strchr(line, '\t');
        *end = '\0';
        st = take_cell(r, line, &row[i], err);
        line = end + 1;
    }
    return st;
}

static ss_status
take_line(reader *r, char *line, ss_error *err)
{
    static const char columns[] = "# columns: ", scene[] = "# scene: ";
    if (r->in.line == 1 && strcmp(line, "# stickslip sweep 1") != 0
        && ss_fail_kind(err, r->in.name, line, strlen(line), "a sweep") != SS_OK)
        return SS_EDATA;
    if (r->in.line == 1 && strcmp(line, "# stickslip sweep 1") != 0)
        return ss_fail(err, SS_EDATA, "%s:1: not a sweep, which begins '# stickslip sweep 1'; "
                       "ss-sweep makes one", r->in.name);
    if (strncmp(line, columns, strlen(columns)) == 0)
        return take_columns(r, line + strlen(columns), err);
    if (strncmp(line, scene, strlen(scene)) == 0 && r->table->scene == NULL
        && (r->table->scene = strdup(line + strlen(scene))) == NULL)
        return no_memory(err);
    return line[0] == '#' || line[0] == '\0' ? SS_OK : take_row(r, line, err);
}

/* Rows become columns. */
static ss_status
turn_over(reader *r, ss_error *err)
{
    ss_sweep_table *t = r->table;
    t->value = malloc((t->n * t->n_columns + 1) * sizeof *t->value);
    if (t->value == NULL)
        return no_memory(err);
    for (size_t i = 0; i < t->n; i++)
        for (size_t c = 0; c < t->n_columns; c++)
            t->value[c * t->n + i] = r->rows[i * t->n_columns + c];
    return SS_OK;
}

ss_status
ss_sweep_read(ss_sweep_table **out, FILE *in, const char *name, ss_error *err)
{
    if (out == NULL || in == NULL || name == NULL)
        return SS_FAIL_NULL(err);
    reader r = { .table = NULL };
    ss_status st = ss_input_open(&r.in, in, name, err);
    if (st == SS_OK && (r.table = calloc(1, sizeof *r.table)) == NULL)
        st = no_memory(err);
    char *line = NULL;
    size_t length;
    while (st == SS_OK && (st = ss_input_line(&r.in, &line, &length, err)) == SS_OK && line != NULL)
        st = take_line(&r, line, err);
    if (st == SS_OK && r.in.line == 0)
        st = ss_fail(err, SS_EDATA, "%s: empty", name);
    if (st == SS_OK && r.columns == NULL)
        st = ss_fail(err, SS_EDATA, "%s: no '# columns:' line in the header", name);
    if (st == SS_OK)
        st = turn_over(&r, err);
    free(r.columns);
    free(r.rows);
    ss_input_close(&r.in);
    if (st == SS_OK)
        *out = r.table;
    else
        ss_sweep_table_free(r.table);
    return st;
}
