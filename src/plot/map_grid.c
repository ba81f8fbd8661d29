/* map_grid.c -- arrange the rows of a table as the points of a grid over two of its columns. */
#include "plot/map.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/sort.h"

/* Read a cell: a number, "-" for an unknown value, or "aperiodic". */
static ss_status
read_cell(double *x, const char *cell, const char *column, size_t row, ss_error *err)
{
    char *end;
    *x = ss_number_parse(cell, &end);
    if (strcmp(cell, "-") == 0)
        *x = NAN;
    else if (strcmp(cell, "aperiodic") == 0)
        *x = 0;
    else if (end == cell || *end != '\0' || !isfinite(*x))
        return ss_fail(err, SS_EDATA, "row %zu, column %s: '%.40s' is not a finite number", row + 1, column,
                       cell);
    return isnan(*x) || fabs(*x) < 1 ? SS_OK : ss_script_check(column, x, 1, err);
}

ss_status
ss_map_read_column(map_column *column, const ss_table *t, size_t c, ss_error *err)
{
    ss_status st = SS_OK;
    if (c >= t->n_columns)
        return ss_fail_column(err, c, t->n_columns);
    double *value = malloc((t->n + 1) * sizeof *value);
    if (value == NULL)
        return ss_fail_memory(err, NULL);
    *column = (map_column){ &t->column[c], value };
    for (size_t i = 0; st == SS_OK && i < t->n; i++)
        st = read_cell(&value[i], t->cell[i * t->n_columns + c], t->column[c].name, i, err);
    return st;
}

/* Returns 1 if the ratios of neighbouring values vary less than their differences. */
static int
is_log(const map_axis *a)
{
    double d[2] = { INFINITY, 0 }, r[2] = { INFINITY, 0 };
    for (size_t i = 1; i < a->n; i++) {
        double difference = a->value[i] - a->value[i - 1];
        double ratio = log(a->value[i] / a->value[i - 1]);
        d[0] = fmin(d[0], difference);
        d[1] = fmax(d[1], difference);
        r[0] = fmin(r[0], ratio);
        r[1] = fmax(r[1], ratio);
    }
    return a->n > 2 && a->value[0] > 0 && isfinite(a->value[a->n - 1] / a->value[0])
        && d[1] > d[0] * (1 + 1e-6) && r[1] / r[0] < d[1] / d[0];
}

static ss_status
make_axis(map_axis *a, const map_column *column, size_t n, ss_error *err)
{
    a->column = column->value;
    a->value = malloc((n + 1) * sizeof *a->value);
    if (a->value == NULL)
        return ss_fail_memory(err, NULL);
    size_t found = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(a->column[i]))
            a->value[found++] = a->column[i];
    qsort(a->value, found, sizeof *a->value, ss_ascending);
    for (size_t i = 0; i < found; i++)
        if (a->n == 0 || a->value[i] != a->value[a->n - 1])
            a->value[a->n++] = a->value[i];
    if (a->n < 2)
        return ss_fail(err, SS_EINVAL, "a map needs two values of %s at least", column->label->name);
    double lo = a->value[0], hi = a->value[a->n - 1];
    a->log = is_log(a);
    a->scale = a->log ? ss_script_power(0) : ss_map_scale((script_extent){ lo, hi });
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
ss_map_grid_make(map_grid *g, const map_column axis[2], size_t n, ss_error *err)
{
    const char *x = axis[0].label->name, *y = axis[1].label->name;
    ss_status st = make_axis(&g->x, &axis[0], n, err);
    if (st == SS_OK)
        st = make_axis(&g->y, &axis[1], n, err);
    if (st != SS_OK)
        return st;
    if (g->x.n > SIZE_MAX / sizeof *g->row / g->y.n || g->x.n * g->y.n > 16 * n + 100)
        return ss_fail(err, SS_EINVAL, "the rows are no grid: %zu values of %s, %zu of %s in %zu "
                       "rows", g->x.n, x, g->y.n, y, n);
    g->row = malloc(g->x.n * g->y.n * sizeof *g->row);
    if (g->row == NULL)
        return ss_fail_memory(err, NULL);
    for (size_t i = 0; i < g->x.n * g->y.n; i++)
        g->row[i] = SIZE_MAX;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(g->x.column[i]) || !isfinite(g->y.column[i]))
            continue;
        size_t *row = &g->row[find(&g->y, g->y.column[i]) * g->x.n + find(&g->x, g->x.column[i])];
        if (*row != SIZE_MAX)
            return ss_fail(err, SS_EINVAL, "two rows with the same %s and %s: choose among them "
                           "first", x, y);
        *row = i;
    }
    return SS_OK;
}

double
ss_map_value(const map_grid *g, const double *column, size_t i, size_t j)
{
    size_t row = g->row[j * g->x.n + i];
    return row == SIZE_MAX ? NAN : column[row];
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

void
ss_map_grid_free(map_grid *g)
{
    free(g->x.value);
    free(g->y.value);
    free(g->row);
}
