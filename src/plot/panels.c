/* panels.c -- draw a signal over time with a panel for each column, or one column over another. */
#include "plot/contour_marks.h"
#include "plot/script.h"
#include "plot/style.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"

#define PANEL 2.1               /* height of one panel [cm] */
#define TIME 1.0                /* and below them [cm] */
#define LEGEND 0.4              /* and above them, of two signals [cm] */
#define ROOM 8.2                /* for the label of a panel [ems] */
#define XY_ROOM 17.0            /* and for those of one column over another */

/* Margins in the script's own variables: panel i of n has its share of the height between the rims,
 * and all panels have the same left edge. */
static const char layout[] =
    "set multiplot\n"
    SCRIPT_TIME_TICS
    "set lmargin at screen 0.175; set rmargin at screen letters < 5 ? 0.965 : 1 - 0.0095*letters\n"
    "set xrange [from:to]; set offsets 0,0,graph 0.06,graph 0.06\n"
    "set autoscale yfix; set tics nomirror out scale 0.6; set xtics format ''\n"
    "set grid xtics lc rgb '" GRID_COLOUR "' lt 1; set border lw 0.8\n"
    "unset key\n";

typedef struct panel {
    const ss_column *column;
    const double *x;            /* of the whole record */
    script_extent drawn;        /* known, as the scale, when its trace is written */
    script_scale scale;
    script_label label;
} panel;

/* Make a panel for each of n columns, or for all if column is NULL; to be freed even after a failure. */
static ss_status
make_panels(panel **out, const ss_signal *signal, const size_t column[], size_t n, ss_error *err)
{
    const ss_header *head = signal->head;
    if (n == 0)
        return ss_fail(err, SS_EINVAL, "no columns to draw");
    panel *p = *out = malloc(n * sizeof *p);
    if (p == NULL)
        return ss_fail_memory(err, NULL);
    for (size_t i = 0; i < n; i++) {
        size_t c = column != NULL ? column[i] : i;
        if (c >= head->n_columns)
            return ss_fail_column(err, c, head->n_columns);
        p[i] = (panel){ &head->column[c], signal->values + c * signal->n, SCRIPT_NO_EXTENT, ss_script_power(0), { .n = 0 } };
    }
    return SS_OK;
}

/* Find the part of opts->over to draw, as if it began at this time. */
static ss_status
find_over_span(script_span *span, double start, const ss_plot_opts *opts, ss_error *err)
{
    ss_header head = *opts->over->head;
    head.start = start;
    return ss_script_find_span(span, &head, opts->over->n, opts, err);
}

/* Prepare the first column of opts->over.  Its values count in the range, but not in the scale. */
static ss_status
make_over(script_clock *clock, script_span *span, double start, const ss_plot_opts *opts, ss_error *err)
{
    if (opts->over == NULL)
        return SS_OK;
    start = isnan(opts->over_start) ? start : opts->over_start;
    const ss_header *head = opts->over->head;
    ss_status st = find_over_span(span, start, opts, err);
    if (st == SS_OK)
        st = ss_script_check(head->column[0].name, opts->over->values + span->first, span->n, err);
    if (st == SS_OK)
        st = ss_script_make_clock(clock, head, span, err);
    for (size_t i = 0; st == SS_OK && i < clock->n_gaps; i++) {
        clock->gap[i].from += start - head->start;
        clock->gap[i].to += start - head->start;
    }
    clock->start = start;
    return st;
}

static void
write_traces(FILE *out, panel p[], size_t n, const script_clock *clock, const script_span *span)
{
    for (size_t i = 0; i < n; i++) {
        char name[32];
        snprintf(name, sizeof name, "$panel%zu", i + 1);
        p[i].scale = ss_script_scale(ss_script_span_extent(p[i].x, clock, span));
        ss_script_write_trace(out, name, p[i].x, clock, span, p[i].scale, &p[i].drawn);
    }
}

/* Labels of all panels, in the letters of the smallest. */
static void
make_labels(panel p[], size_t n)
{
    double font = 1;
    for (size_t i = 0; i < n; i++) {
        ss_script_make_label(&p[i].label, p[i].column, p[i].scale, ROOM);
        font = fmin(font, p[i].label.font);
    }
    for (size_t i = 0; i < n; i++)
        p[i].label.font = font;
}

/* Bands from the bottom of the panel to its top, which the second axis of y has at 0 and 1. */
static size_t
write_bands(FILE *out, const ss_overlay *features, const script_span *span)
{
    size_t n = ss_contour_write_spans(out, span, features);
    fputs(n > 0 ? "feature_colour = '" SHADE_COLOUR "'; set y2range [0:1]\n" : "", out);
    return n;
}

static const char plot_bands[] = "$spans using 1:(0):1:2:(0):(1) axes x1y2 with boxxyerror fill solid "
    "noborder lc rgb feature_colour, ";

/* The legend of a signal and another over it, above their panel. */
static void
write_legend(FILE *out, const ss_plot_opts *opts, const ss_column *column, const ss_column *over)
{
    fputs("set title offset 0,0.7; set key at graph 1, graph 1 bottom right horizontal samplen 1.5 noenhanced\nname = ", out);
    ss_script_quote(out, opts->name != NULL ? opts->name : column->name);
    fputs("; over_name = ", out);
    ss_script_quote(out, opts->over_name != NULL ? opts->over_name : over->name);
    putc('\n', out);
}

/* Panel i of n, from 1 on; the lowest has the labels of time.  A line of one sample would be invisible. */
static void
plot_panel(FILE *out, const panel *p, size_t i, size_t n, size_t samples, int bands, int over)
{
    if (i == n)
        fputs(SCRIPT_TIME_LABELS, out);
    ss_print(out, "set tmargin at screen top - %zu*panel; set bmargin at screen top - %zu*panel "
            "+ 0.1*panel*(%zu)\n", i - 1, i, (size_t)(i < n));
    fputs("unset label 1; ", out);
    ss_script_write_side_label(out, 1, &p->label);
    ss_script_write_tics(out, "ytics", p->drawn, 5);
    ss_print(out, "plot %s$panel%zu using 1:2 with %s lw 1 lc rgb colour%s\n", bands ? plot_bands : "", i,
            samples > 1 ? "lines" : "points pt 7 ps 1",
            over ? " title name, $over using 1:2 with lines lw 1 lc rgb over title over_name" : "");
    if (i == 1)
        fputs(over ? "unset title; unset key\n" : "unset title\n", out);
}

ss_status
ss_plot_signal(FILE *out, const ss_signal *signal, const size_t column[], size_t n,
               const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    if (out == NULL || signal == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    script_clock clock = { .gap = NULL }, over_clock = { .gap = NULL };
    script_span span, over_span;
    panel *p = NULL;
    ss_status status = ss_script_take(&own, opts, err);
    if (status != SS_OK)
        return status;
    opts = &own;
    int over = opts->over != NULL;
    size_t panels = n > 0 ? n : head->n_columns, bands = 0;
    double title = ss_script_title_height(opts, head) + (over ? LEGEND : 0), height = title + TIME + PANEL * (double)panels;
    status = make_panels(&p, signal, n > 0 ? column : NULL, panels, err);
    if (status == SS_OK)
        status = ss_script_find_span(&span, head, signal->n, opts, err);
    for (size_t i = 0; status == SS_OK && i < panels; i++)
        status = ss_script_check(p[i].column->name, p[i].x + span.first, span.n, err);
    if (status == SS_OK)
        status = ss_script_make_clock(&clock, head, &span, err);
    if (status == SS_OK)
        status = make_over(&over_clock, &over_span, head->start, opts, err);
    if (status == SS_OK)
        status = ss_contour_check_overlay(opts->features, err);
    if (status == SS_OK)
        status = ss_script_begin(out, opts, height, err);
    if (status == SS_OK) {
        ss_script_write_title(out, opts, head, NULL);
        ss_script_write_span(out, &span);
        ss_print(out, "colour = '" BLUE "'\n%s", over ? "over = '" VERMILION "'\n" : "");
        if (opts->features != NULL)
            bands = write_bands(out, opts->features, &span);
        write_traces(out, p, panels, &clock, &span);
        make_labels(p, panels);
        if (over)
            ss_script_write_trace(out, "$over", opts->over->values, &over_clock, &over_span, p[0].scale,
                                  &p[0].drawn);
        ss_print(out, "bottom = %.4f; top = %.4f; panel = (top - bottom)/%zu\n", TIME / height,
                1 - title / height, panels);
        fputs(layout, out);
        if (over)
            write_legend(out, opts, p[0].column, opts->over->head->column);
        for (size_t i = 1; i <= panels; i++)
            plot_panel(out, &p[i - 1], i, panels, span.n, bands > 0, over && i == 1);
        fputs("unset multiplot\n", out);
        status = ss_script_end(out);
    }
    free(over_clock.gap);
    free(clock.gap);
    free(p);
    return status;
}

/* --- one over the other -------------------------------------------------------------------- */

/* Two columns of a signal. */
typedef struct path {
    const ss_column *column[2];
    const double *x[2];         /* of the whole record */
    script_clock clock;
    script_span span;
} path;

/* The clock's gaps are to be freed, even after a failure. */
static ss_status
make_path(path *p, const ss_signal *signal, const size_t column[2], const script_span *span, ss_error *err)
{
    ss_status st = SS_OK;
    p->span = *span;
    for (int i = 0; st == SS_OK && i < 2; i++) {
        p->column[i] = &signal->head->column[column[i]];
        p->x[i] = signal->values + column[i] * signal->n;
        st = ss_script_check(p->column[i]->name, p->x[i] + span->first, span->n, err);
    }
    return st == SS_OK ? ss_script_make_clock(&p->clock, signal->head, span, err) : st;
}

/* The columns with the names of x and y, or else the first two. */
static ss_status
find_over(size_t column[2], const ss_header *over, const ss_header *signal, size_t x, size_t y, ss_error *err)
{
    const char *name[2] = { signal->column[x].name, signal->column[y].name };
    int found[2] = { ss_header_column(over, name[0]), ss_header_column(over, name[1]) };
    int named = found[0] >= 0 && found[1] >= 0;
    for (int i = 0; i < 2; i++)
        column[i] = (size_t)(named ? found[i] : i);
    return named || over->n_columns >= 2 ? SS_OK
        : ss_fail(err, SS_EINVAL, "one column cannot be drawn over %s and %s", name[0], name[1]);
}

/* The columns of opts->over over as much time as the path has. */
static ss_status
make_over_path(path *over, const path *p, const ss_header *head, size_t x, size_t y, const ss_plot_opts *opts,
               ss_error *err)
{
    script_span span;
    size_t column[2];
    ss_status st = find_over(column, opts->over->head, head, x, y, err);
    if (st == SS_OK)
        st = find_over_span(&span, p->clock.start, opts, err);
    return st == SS_OK ? make_path(over, opts->over, column, &span, err) : st;
}

static script_extent
extent_of(const path *p, int i)
{
    return ss_script_span_extent(p->x[i], &p->clock, &p->span);
}

/* A point nearer than half a pixel to the last one written is left out. */
static void
write_path(FILE *out, const char *name, const path *p, const script_scale scale[2])
{
    size_t end = p->span.first + p->span.n;
    double last[2] = { INFINITY, INFINITY }, near[2];
    int decimals[2];
    for (int i = 0; i < 2; i++) {
        script_extent e = extent_of(p, i);
        near[i] = (e.hi - e.lo) / scale[i].unit / (2 * SCRIPT_COLUMNS);
        decimals[i] = ss_script_decimals((e.hi - e.lo) / scale[i].unit);
    }
    ss_print(out, "%s << EOD\n", name);
    for (size_t k = p->span.first; k < end; k++) {
        double at[2] = { ss_script_scaled(p->x[0][k], scale[0]), ss_script_scaled(p->x[1][k], scale[1]) };
        if (ss_script_is_missing(&p->clock, k)) {
            fputs(isinf(last[0]) ? "" : "\n", out);
            last[0] = INFINITY;
            continue;
        }
        if (k + 1 < end && fabs(at[0] - last[0]) <= near[0] && fabs(at[1] - last[1]) <= near[1])
            continue;
        ss_script_write(out, at[0], decimals[0], " ");
        ss_script_write(out, at[1], decimals[1], "\n");
        memcpy(last, at, sizeof last);
    }
    fputs("EOD\n", out);
}

/* The path, and another over it unless it is NULL. */
static ss_status
write_xy(FILE *out, const path *p, const path *over, const ss_plot_opts *opts)
{
    script_scale scale[2];
    script_extent drawn[2] = { SCRIPT_NO_EXTENT, SCRIPT_NO_EXTENT };
    script_label label[2];
    for (int i = 0; i < 2; i++) {
        scale[i] = ss_script_scale(extent_of(p, i));
        ss_script_make_label(&label[i], p->column[i], scale[i], XY_ROOM);
        ss_script_widen(&drawn[i], extent_of(p, i), scale[i]);
        if (over != NULL)
            ss_script_widen(&drawn[i], extent_of(over, i), scale[i]);
    }
    ss_script_write_x_label(out, &label[0], "0,0.3");
    ss_script_write_side_label(out, 1, &label[1]);
    fputs("colour = '" BLUE "'\n", out);
    ss_script_write_tics(out, "xtics", drawn[0], 6);
    ss_script_write_tics(out, "ytics", drawn[1], 6);
    write_path(out, "$path", p, scale);
    if (over != NULL) {
        fputs("over = '" VERMILION "'\n", out);
        write_path(out, "$over", over, scale);
    }
    if (over != NULL)
        write_legend(out, opts, p->column[1], over->column[1]);
    fputs(over != NULL ? "rim = 0.85\n" : "unset key; rim = 0.91\n", out);
    fputs("set lmargin at screen 0.175; set rmargin at screen 0.965\n"
          "set tmargin at screen rim; set bmargin at screen 0.16\n"
          "set autoscale fix; set offsets graph 0.05,graph 0.05,graph 0.05,graph 0.05\n"
          "set tics nomirror out scale 0.6; set border lw 0.8\n"
          "plot $path using 1:2 with lines lw 1 lc rgb colour", out);
    fputs(over != NULL ? " title name, $over using 1:2 with lines lw 1 lc rgb over title over_name\n" : "\n", out);
    return ss_script_end(out);
}

ss_status
ss_plot_xy(FILE *out, const ss_signal *signal, size_t x, size_t y, const ss_plot_opts *opts,
           ss_error *err)
{
    ss_plot_opts own;
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    script_span span;
    path p = { .clock = { .gap = NULL } }, over = p;
    ss_status status = ss_script_take(&own, opts, err);
    if (status != SS_OK)
        return status;
    if (x >= head->n_columns || y >= head->n_columns)
        return ss_fail_column(err, x > y ? x : y, head->n_columns);
    opts = &own;
    status = ss_script_find_span(&span, head, signal->n, opts, err);
    if (status == SS_OK)
        status = make_path(&p, signal, (const size_t[]){ x, y }, &span, err);
    if (status == SS_OK && opts->over != NULL)
        status = make_over_path(&over, &p, head, x, y, opts, err);
    if (status == SS_OK)
        status = ss_script_begin(out, opts, 6.5, err);
    if (status == SS_OK) {
        ss_script_write_title(out, opts, head, NULL);
        status = write_xy(out, &p, opts->over != NULL ? &over : NULL, opts);
    }
    free(over.clock.gap);
    free(p.clock.gap);
    return status;
}
