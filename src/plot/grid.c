/* grid.c -- the rows of a table as the points of a grid over two of its columns, and the axes of maps and
 * diagrams. */
#include "plot/map.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"

/* A cell is a number, "-" for an unknown value, or "aperiodic". */
ss_status
ss_map_read_columns(map_column column[], size_t n, const ss_table *t, const size_t index[], ss_error *err)
{
    ss_status st = SS_OK;
    memset(column, 0, n * sizeof *column);
    for (size_t k = 0; st == SS_OK && k < n; k++) {
        size_t c = index[k];
        if (c >= t->n_columns)
            return ss_fail_column(err, c, t->n_columns);
        column[k] = (map_column){ &t->column[c], malloc((t->n + 1) * sizeof *column[k].value) };
        if (column[k].value == NULL)
            return ss_fail_memory(err, NULL);
        for (size_t i = 0; st == SS_OK && i < t->n; i++) {
            const char *cell = t->cell[i * t->n_columns + c], *name = t->column[c].name;
            int unknown = strcmp(cell, "-") == 0, aperiodic = strcmp(cell, "aperiodic") == 0;
            char *end;
            double x = column[k].value[i] = unknown ? NAN : aperiodic ? 0 : ss_number_parse(cell, &end);
            if (!unknown && !aperiodic && (end == cell || *end != '\0' || !isfinite(x)))
                st = ss_fail(err, SS_EDATA, "row %zu, column %s: '%.40s' is not a finite number", i + 1, name,
                             cell);
            else if (fabs(x) >= 1 && ss_script_check(name, (script_extent){ x, x }, err) != SS_OK)
                st = SS_EDATA;
        }
    }
    return st;
}

void
ss_map_free_columns(map_column column[], size_t n)
{
    for (size_t k = 0; k < n; k++)
        free(column[k].value);
}

ss_status
ss_map_make_axis(map_axis *a, const map_column *column, size_t n, ss_error *err)
{
    size_t found = 0;
    /* of neighbours: differences, logarithms of ratios */
    script_extent d = SCRIPT_NO_EXTENT, r = SCRIPT_NO_EXTENT;
    *a = (map_axis){ .n = 0 };
    a->value = malloc((n + 1) * sizeof *a->value);
    if (a->value == NULL)
        return ss_fail_memory(err, NULL);
    for (size_t i = 0; i < n; i++)
        if (isfinite(column->value[i]))
            a->value[found++] = column->value[i];
    qsort(a->value, found, sizeof *a->value, ss_ascending);
    for (size_t i = 0; i < found; i++)
        if (a->n == 0 || a->value[i] != a->value[a->n - 1])
            a->value[a->n++] = a->value[i];
    if (a->n < 2)
        return ss_fail(err, SS_EDATA, "a picture needs two values of %s at least", column->label->name);
    double lo = a->value[0], hi = a->value[a->n - 1];
    for (size_t i = 1; i < a->n; i++) {
        ss_script_include(&d, a->value[i] - a->value[i - 1]);
        ss_script_include(&r, log(a->value[i] / a->value[i - 1]));
    }
    a->log = a->n > 2 && lo > 0 && isfinite(hi / lo) && d.hi > d.lo * (1 + 1e-6) && r.hi / r.lo < d.hi / d.lo;
    a->scale = ss_script_scale((script_extent){ lo, hi });
    if (a->log || a->scale.offset == 0)         /* values as they are, unless their labels would be long */
        a->scale = ss_script_power(0);
    a->digits = 6 + (int)fmax(0, floor(log10(fmax(fabs(lo), fabs(hi)) / (hi - lo))));
    return SS_OK;
}

/* The index of x among the values; x is one of them. */
static size_t
find(const map_axis *a, double x)
{
    const double *at = bsearch(&x, a->value, a->n, sizeof x, ss_ascending);
    return (size_t)(at - a->value);
}

ss_status
ss_map_make_grid(map_grid *g, map_column column[], size_t n_columns, size_t n, ss_error *err)
{
    *g = (map_grid){ .x = { .n = 0 } };
    ss_status st = ss_map_make_axis(&g->x, &column[0], n, err);
    if (st == SS_OK)
        st = ss_map_make_axis(&g->y, &column[1], n, err);
    if (st != SS_OK)
        return st;
    size_t points = g->x.n * g->y.n, *row;
    if (g->x.n > SIZE_MAX / sizeof *row / g->y.n || points > 16 * n + 100)
        return ss_fail(err, SS_EDATA, "the rows are no grid: %zu values of %s, %zu of %s in %zu "
                       "rows", g->x.n, column[0].label->name, g->y.n, column[1].label->name, n);
    row = malloc(points * sizeof *row);         /* of each point; SIZE_MAX: there is none */
    st = row != NULL ? SS_OK : ss_fail_memory(err, NULL);
    for (size_t k = 0; st == SS_OK && k < points; k++)
        row[k] = SIZE_MAX;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        double x = column[0].value[i], y = column[1].value[i];
        if (!isfinite(x) || !isfinite(y))
            continue;
        size_t k = find(&g->y, y) * g->x.n + find(&g->x, x);
        if (row[k] != SIZE_MAX)
            st = ss_fail(err, SS_EDATA, "two rows with the same %s and %s: choose among them first",
                         column[0].label->name, column[1].label->name);
        row[k] = i;
    }
    for (size_t c = 2; st == SS_OK && c < n_columns; c++) {
        double *of_row = column[c].value, *value = malloc(points * sizeof *value);
        for (size_t k = 0; value != NULL && k < points; k++)
            value[k] = row[k] == SIZE_MAX ? NAN : of_row[row[k]];
        st = value != NULL ? SS_OK : ss_fail_memory(err, NULL);
        free(of_row);
        column[c].value = value;
    }
    free(row);
    return st;
}

void
ss_map_free_grid(map_grid *g)
{
    free(g->x.value);
    free(g->y.value);
}

double
ss_map_along(const map_axis *a, double at)
{
    size_t i = (size_t)fmin(fmax(at, 0), (double)(a->n - 2));
    double part = at - (double)i, lo = a->value[i], hi = a->value[i + 1];
    return a->log ? lo * pow(hi / lo, part) : lo + part * (hi - lo);
}

void
ss_map_write_coordinate(FILE *out, const map_axis *a, double x, char behind)
{
    ss_print(out, "%.*g%c", a->digits, ss_script_scaled(x, a->scale), behind);
}

enum { INTERVALS = 9,           /* of tics at most; */
       TICS_WIDE = 27,          /* letters of all tics below a map together */
       DECADE_LETTERS = 4 };    /* of a logarithmic axis */

ss_plot_opts
ss_map_titled(const ss_plot_opts *opts, const ss_table *t)
{
    ss_plot_opts titled = *opts;
    const char *scene = ss_table_note(t, "scene");
    if (titled.title == NULL)
        titled.title = scene != NULL ? scene : "";
    return titled;
}

const ss_column *
ss_map_label(map_label *l, const ss_column *column)
{
    snprintf(l->name, sizeof l->name, "%s", column->name);
    for (char *c = l->name; *c != '\0'; c++)
        *c = *c == '_' ? ' ' : *c;
    l->column = (ss_column){ l->name, column->unit };
    return &l->column;
}

/* The range of an axis, as it is drawn. */
static script_extent
range_of(const map_axis *a)
{
    return ss_script_scaled_extent((script_extent){ a->value[0], a->value[a->n - 1] }, a->scale);
}

int
ss_map_letters(const map_axis *a)
{
    return a->log ? DECADE_LETTERS : ss_script_letters(range_of(a), INTERVALS);
}

/* gnuplot leaves out a tic at the very end of a logarithmic axis where rounding puts it beyond. */
void
ss_map_write_axis(FILE *out, char name, const map_axis *a)
{
    script_extent e = range_of(a);
    const char axis[] = { name, 't', 'i', 'c', 's', '\0' };
    if (a->log) {
        ss_print(out, "set %crange [%.9g:%.9g]; set logscale %c\n", name, e.lo * (1 - 1e-8), e.hi * (1 + 1e-8),
                 name);
        return;
    }
    ss_print(out, "set %crange [%.*g:%.*g]\n", name, a->digits, e.lo, a->digits, e.hi);
    ss_script_write_tics(out, axis, e, name == 'y' ? INTERVALS
                         : (int)fmax(1, fmin(INTERVALS, TICS_WIDE / ss_map_letters(a))));
}
