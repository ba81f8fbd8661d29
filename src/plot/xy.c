/* xy.c -- draw one column over another: a phase plane or a friction loop.
 *
 * Of a line of any length, the parts are drawn that cross a cell of half a pixel which the line has not crossed
 * before.  It goes from point to point, each farther than a cell from the one before.  Lines are four cells
 * wide: a part through cells that were crossed shows nothing new. */
#include "plot/series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"

#define ROOM 17.0               /* for the label of y [ems] */
#define HEIGHT 6.5              /* [cm] */
enum { CELLS = 2 * SCRIPT_COLUMNS };    /* along each axis */

/* A line; a point that is NaN stands between two parts of it. */
typedef struct path {
    const ss_column *column[2];
    script_extent extent[2];
    double (*point)[2];
    size_t n, room;
} path;

/* Cross all cells from one to another.  Returns 1 if one of them is new. */
static int
cross(unsigned char *crossed, const double from[2], const double to[2])
{
    int steps = (int)ceil(fmax(fabs(to[0] - from[0]), fabs(to[1] - from[1]))), new = 0;
    double x = from[0], y = from[1], each = steps > 0 ? 1. / steps : 0;
    double dx = each * (to[0] - from[0]), dy = each * (to[1] - from[1]);
    for (int i = 0; i <= steps; i++, x += dx, y += dy) {
        unsigned char *cell = &crossed[(size_t)y * CELLS + (size_t)x];
        new |= !*cell;
        *cell = 1;
    }
    return new;
}

static ss_status
keep(path *p, const double at[2], ss_error *err)
{
    void *more = ss_list_room(p->point, &p->room, p->n, sizeof *p->point);
    if (more == NULL)
        return ss_fail_memory(err, NULL);
    p->point = more;
    memcpy(p->point[p->n++], at, sizeof *p->point);
    return SS_OK;
}

/* Keep what is drawn of the rows that follow. */
static ss_status
thin(path *p, series *s, unsigned char *crossed, ss_error *err)
{
    static const double nowhere[2] = { NAN, NAN };
    double last[2] = { NAN, NAN }, last_cell[2];        /* NaN: a line begins with the next point */
    int is_kept = 0;                                    /* is the last point? */
    size_t n = 1;
    ss_status st = SS_OK;
    while (st == SS_OK && n > 0) {
        st = ss_series_next(s, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++) {
            double at[2] = { s->value[i], s->value[s->piece + i] }, cell[2];
            int begins = isnan(last[0]);
            for (int k = 0; k < 2; k++) {
                double range = p->extent[k].hi - p->extent[k].lo;
                cell[k] = range > 0 ? (at[k] - p->extent[k].lo) / range * (CELLS - 1) : 0;
            }
            if (!begins && fabs(cell[0] - last_cell[0]) <= 1 && fabs(cell[1] - last_cell[1]) <= 1)
                continue;
            int shows = !isnan(at[0]) && (cross(crossed, begins ? cell : last_cell, cell) || begins);
            if (shows && !is_kept && p->n > 0)
                st = keep(p, nowhere, err);
            if (st == SS_OK && shows && !is_kept && !begins)
                st = keep(p, last, err);
            if (st == SS_OK && shows)
                st = keep(p, at, err);
            is_kept = shows;
            memcpy(last, at, sizeof last);
            memcpy(last_cell, cell, sizeof cell);
        }
    }
    return st;
}

/* Read twice: first for the extents, which cells need. */
static ss_status
read_path(path *p, ss_reader *reader, const size_t column[2], double start, const ss_plot_opts *opts,
          ss_error *err)
{
    series s;
    script_span span;
    size_t n = 1;
    unsigned char *crossed = calloc((size_t)CELLS * CELLS, 1);
    *p = (path){ .extent = { SCRIPT_NO_EXTENT, SCRIPT_NO_EXTENT } };
    /* the last column, since rows that bring their times must be read with these */
    const size_t read[] = { column[0], column[1], ss_reader_header(reader)->n_columns - 1 };
    ss_status st = ss_series_begin(&s, reader, read, 3, start, opts, err);
    if (st == SS_OK)
        st = crossed != NULL ? ss_series_rewind(&s, err) : ss_fail_memory(err, NULL);
    while (st == SS_OK && n > 0) {
        st = ss_series_next(&s, &n, err);
        for (size_t k = 0; st == SS_OK && k < 2; k++)
            for (size_t i = 0; i < n; i++)
                ss_script_include(&p->extent[k], s.value[k * s.piece + i]);
    }
    if (st == SS_OK)
        st = ss_script_find_span(&span, s.start, s.head->rate, s.rows, opts, err);
    for (int k = 0; st == SS_OK && k < 2; k++) {
        p->column[k] = &s.head->column[column[k]];
        st = ss_series_check(p->column[k], p->extent[k], &span, err);
    }
    if (st == SS_OK)
        st = ss_series_rewind(&s, err);
    if (st == SS_OK)
        st = thin(p, &s, crossed, err);
    ss_series_free(&s);
    free(crossed);
    return st;
}

/* The path, and those over it. */
static ss_status
write_paths(FILE *out, const ss_header *head, const path p[], const ss_plot_opts *opts, ss_error *err)
{
    const ss_column *second[SS_PLOT_OVER + 1];
    script_scale scale[2];
    ss_status st = ss_script_begin(out, opts, head, HEIGHT, NULL, err);
    if (st != SS_OK)
        return st;
    for (int k = 0; k < 2; k++)
        scale[k] = ss_script_scale(p->extent[k]);
    ss_script_write_x_label(out, p->column[0], scale[0]);
    ss_script_write_side_label(out, 1, p->column[1], scale[1], ROOM);
    ss_script_write_frame(out, 0.175, 0.965);
    ss_script_write_colours(out, opts);
    for (int k = 0; k < 2; k++) {
        script_extent drawn = p->extent[k];
        for (size_t i = 1; i <= opts->n_over; i++)
            ss_script_widen(&drawn, p[i].extent[k]);
        ss_script_write_tics(out, k == 0 ? "xtics" : "ytics", ss_script_scaled_extent(drawn, scale[k]), 6);
    }
    for (size_t i = 0; i <= opts->n_over; i++) {
        int decimals[2];
        for (int k = 0; k < 2; k++) {
            script_extent e = ss_script_scaled_extent(p[i].extent[k], scale[k]);
            decimals[k] = ss_script_decimals(e.hi - e.lo);
        }
        second[i] = p[i].column[1];
        ss_print(out, "$%s%s << EOD\n", i == 0 ? "path" : "over", i == 0 ? "" : ss_script_number[i - 1]);
        for (size_t n = 0; n < p[i].n; n++) {
            const double *at = p[i].point[n];
            if (isnan(at[0])) {
                putc('\n', out);
                continue;
            }
            ss_script_write(out, ss_script_scaled(at[0], scale[0]), decimals[0], " ");
            ss_script_write(out, ss_script_scaled(at[1], scale[1]), decimals[1], "\n");
        }
        fputs("EOD\n", out);
    }
    if (opts->n_over > 0)
        ss_script_write_legend(out, opts, second);
    ss_print(out, "unset grid; set tmargin at screen %.4g; set bmargin at screen 0.16\n"
             "set autoscale fix; set offsets graph 0.05,graph 0.05,graph 0.05,graph 0.05\n"
             "plot $path using 1:2 with lines lw 1 lc rgb colour%s",
             0.91 - 0.975 * ss_script_legend(opts) / HEIGHT, opts->n_over > 0 ? " title name" : "");
    for (size_t i = 0; i < opts->n_over; i++) {
        char block[24];
        snprintf(block, sizeof block, "$over%s using 1:2", ss_script_number[i]);
        ss_script_write_over(out, i, block, 1);
    }
    putc('\n', out);
    return ss_script_end(out);
}

ss_status
ss_plot_xy(FILE *out, ss_reader *reader, size_t x, size_t y, const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    path p[SS_PLOT_OVER + 1] = { { .n = 0 } };
    size_t column[2] = { x, y };
    if (out == NULL || reader == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = ss_reader_header(reader);
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK)
        st = read_path(p, reader, column, NAN, &own, err);
    for (size_t k = 0; st == SS_OK && k < own.n_over; k++) {
        /* the columns with the names of x and y, or else the first two */
        const ss_header *over = ss_reader_header(own.over[k]);
        const char *x_name = p->column[0]->name, *y_name = p->column[1]->name;
        int of_x = ss_header_column(over, x_name), of_y = ss_header_column(over, y_name);
        int named = of_x >= 0 && of_y >= 0;
        column[0] = named ? (size_t)of_x : 0;
        column[1] = named ? (size_t)of_y : 1;
        st = named || over->n_columns >= 2 ? read_path(&p[k + 1], own.over[k], column, head->start, &own, err)
            : ss_fail(err, SS_EINVAL, "one column cannot be drawn over %s and %s", x_name, y_name);
    }
    if (st == SS_OK)
        st = write_paths(out, head, p, &own, err);
    for (size_t k = 0; k <= SS_PLOT_OVER; k++)
        free(p[k].point);
    return st;
}
