/* map.h -- columns of a sweep's rows, the grid of a map, its axes and its lines. */
#ifndef MAP_H
#define MAP_H

#include <stddef.h>
#include <stdio.h>
#include <stickslip/signal.h>
#include <stickslip/table.h>
#include "plot/script.h"

/* --- grid.c --------------------------------------------------------------------------------- */

/* A column that is drawn. */
typedef struct map_column {
    const ss_column *label;
    double *value;              /* of each row, or of each point of a grid; NaN: there is none */
} map_column;

/* Read n columns of the rows, where "-" is NaN, and "aperiodic" a period of 0; to be freed even after a
 * failure.  SS_EDATA: there is another word, or a number that gnuplot cannot draw. */
ss_status ss_map_read_columns(map_column column[], size_t n, const ss_table *t, const size_t index[],
                              ss_error *err);
void ss_map_free_columns(map_column column[], size_t n);

/* The different values of a column, ascending. */
typedef struct map_axis {
    double *value;
    size_t n;
    int log;                    /* 1: the axis is logarithmic */
    script_scale scale;         /* of the coordinates that are written */
    int digits;                 /* enough to show a hundred-thousandth of the range */
} map_axis;

/* Those of n rows; value is to be freed even after a failure. */
ss_status ss_map_make_axis(map_axis *a, const map_column *column, size_t n, ss_error *err);

typedef struct map_grid {
    map_axis x, y;
} map_grid;

/* Arrange n rows as a grid over the first two columns: the values of the others become those at
 * x i, y j, value[j * x.n + i].  The grid is to be freed even after a failure. */
ss_status ss_map_make_grid(map_grid *g, map_column column[], size_t n_columns, size_t n, ss_error *err);
void ss_map_free_grid(map_grid *g);
/* The coordinate at a place on the axis: value i is at the place i, and others lie between. */
double ss_map_along(const map_axis *a, double at);
void ss_map_write_coordinate(FILE *out, const map_axis *a, double x, char behind);

/* These options, with the scene of the rows as their title if they have none. */
ss_plot_opts ss_map_titled(const ss_plot_opts *opts, const ss_table *t);
/* The column with blanks in its name, for labels: base_frequency becomes "base frequency". */
typedef struct map_label {
    char name[128];
    ss_column column;
} map_label;
const ss_column *ss_map_label(map_label *label, const ss_column *column);
int ss_map_letters(const map_axis *a);          /* of the longest label of its tics */
/* Set the range of axis x or y, and tics that have room; powers of ten are left to ss_script_write_decades. */
void ss_map_write_axis(FILE *out, char name, const map_axis *a);

/* --- map_lines.c ---------------------------------------------------------------------------- */

/* Write $line and $label: lines of equal height on the grid, and their labels. */
ss_status ss_map_write_lines(FILE *out, const map_grid *g, const double *height, ss_error *err);

/* --- diagram.c ------------------------------------------------------------------------------ */

/* Draw a sweep over one parameter, as ss_plot_sweep does; opts are complete. */
ss_status ss_plot_diagram(FILE *out, const ss_table *t, const size_t drawn[], size_t n, const ss_plot_opts *opts,
                          ss_error *err);

#endif
