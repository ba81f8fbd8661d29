/* map.h -- columns of a sweep's rows, the grid of a map, its regions and its lines. */
#ifndef MAP_H
#define MAP_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>
#include <stickslip/table.h>
#include "plot/script.h"

/* A column that is drawn. */
typedef struct map_column {
    const ss_column *label;
    double *value;              /* of each row; NaN: the row has none */
} map_column;

/* Read column c of the rows, where "-" is NaN, and "aperiodic" a period of 0.  value is to be
 * freed even after a failure.  SS_EDATA: there is another word. */
ss_status ss_map_read_column(map_column *column, const ss_table *t, size_t c, ss_error *err);
/* Title and axes (map_axis.c). */

/* These options, with the scene of the rows as their title if they have none. */
ss_plot_opts ss_map_titled(const ss_plot_opts *opts, const ss_table *t);
/* The label of a column: "base frequency / Hz" of base_frequency. */
script_label ss_map_label(const ss_column *column, script_scale scale, double room);
/* The scale of a linear axis with a range above 0: values as they are, unless their labels would be long. */
script_scale ss_map_scale(script_extent of_values);
/* The length of the longest label of the tics that gnuplot sets on an axis over this range. */
int ss_map_letters(script_extent drawn, int log);
/* Set fewer tics on a linear horizontal axis than gnuplot would if their labels are long. */
void ss_map_write_x_tics(FILE *out, script_extent drawn);

/* The different values of a column, ascending. */
typedef struct map_axis {
    const double *column;
    double *value;
    size_t n;
    int log;                    /* 1: the axis is logarithmic */
    script_scale scale;         /* of the coordinates that are written */
    int digits;                 /* enough to show a hundred-thousandth of the range */
} map_axis;

typedef struct map_grid {
    map_axis x, y;
    size_t *row;                /* of the table at x i, y j: row[j * x.n + i]; SIZE_MAX: none */
} map_grid;

/* Arrange n rows as a grid over two columns; to be freed even after a failure. */
ss_status ss_map_grid_make(map_grid *g, const map_column axis[2], size_t n, ss_error *err);
void ss_map_grid_free(map_grid *g);
/* The value of a column at x i, y j; NaN: there is none. */
double ss_map_value(const map_grid *g, const double *column, size_t i, size_t j);
/* The coordinate at a place on the axis: value i is at the place i, and others lie between. */
double ss_map_along(const map_axis *a, double at);
void ss_map_write_coordinate(FILE *out, const map_axis *a, double x, char behind);

/* Write $line and $label: lines of equal value of the column, and their labels (map_lines.c). */
ss_status ss_map_write_lines(FILE *out, const map_grid *g, const double *column, ss_error *err);

#endif
