/* panels.c -- a signal over time, one panel a column, and one column over another. */
#include "plot/script.h"

#include <math.h>
#include <stdlib.h>
#include "base/error.h"

#define PANEL 2.1               /* height of one panel [cm] */
#define TITLE 0.6               /* height above the panels [cm] */
#define TIME 1.0                /* and below them */
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
    "set grid xtics lc rgb '#dddddd' lt 1; set border lw 0.8\n"
    "unset key\n";

typedef struct panel {
    const ss_column *column;
    const double *x;            /* of the whole record */
    double range;               /* known, as the exponent, when its trace is written */
    int exponent;
} panel;

/* A panel for each of n columns, or of all for NULL; to be freed even after a failure. */
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
            return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", c + 1, head->n_columns);
        p[i] = (panel){ .column = &head->column[c], .x = signal->values + c * signal->n };
    }
    return SS_OK;
}

/* The first column of opts->over, as if it were sampled from the start of the signal on.  Its
 * values count in the range, but not in the exponent. */
static ss_status
check_over(ss_header *head, script_span *span, const ss_header *of_signal, const ss_plot_opts *opts,
           ss_error *err)
{
    if (opts->over == NULL)
        return SS_OK;
    *head = *opts->over->head;
    head->start = of_signal->start;
    ss_status st = ss_script_find_span(span, head, opts->over->n, opts, err);
    return st == SS_OK ? ss_script_check(head->column[0].name, opts->over->values + span->first, span->n,
                                         err) : st;
}

static void
write_traces(FILE *out, panel p[], size_t n, const ss_header *head, const script_span *span)
{
    for (size_t i = 0; i < n; i++) {
        char name[32];
        snprintf(name, sizeof name, "$panel%zu", i + 1);
        p[i].exponent = ss_script_exponent(p[i].x + span->first, span->n);
        p[i].range = ss_script_write_trace(out, name, p[i].x, head, span, p[i].exponent);
    }
}

/* Panel i of n, from 1 on; the lowest has the labels of time. */
static void
plot_panel(FILE *out, const panel *p, size_t i, size_t n, int over)
{
    script_label label;
    if (i == n)
        fputs(SCRIPT_TIME_LABELS, out);
    fprintf(out, "set tmargin at screen top - %zu*panel; set bmargin at screen top - %zu*panel "
            "+ 0.1*panel*(%zu)\n", i - 1, i, (size_t)(i < n));
    ss_script_make_label(&label, p->column, p->exponent, ROOM);
    fputs("unset label 1; ", out);
    ss_script_write_side_label(out, 1, &label);
    ss_script_write_tics(out, "ytics", p->range, 5);
    fprintf(out, "plot $panel%zu using 1:2 with lines lw 1 lc rgb colour%s\n", i,
            over ? ", $over using 1:2 with lines lw 1 lc rgb over" : "");
    if (i == 1)
        fputs("unset title\n", out);
}

ss_status
ss_plot_signal(FILE *out, const ss_signal *signal, const size_t column[], size_t n,
               const ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || signal == NULL || opts == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    ss_header over_head;
    script_span span, over_span;
    panel *p = NULL;
    int over = opts->over != NULL;
    size_t panels = n > 0 ? n : head->n_columns;
    double height = TITLE + TIME + PANEL * (double)panels;
    ss_status status = make_panels(&p, signal, n > 0 ? column : NULL, panels, err);
    if (status == SS_OK)
        status = ss_script_find_span(&span, head, signal->n, opts, err);
    for (size_t i = 0; status == SS_OK && i < panels; i++)
        status = ss_script_check(p[i].column->name, p[i].x + span.first, span.n, err);
    if (status == SS_OK)
        status = check_over(&over_head, &over_span, head, opts, err);
    if (status == SS_OK)
        status = ss_script_begin(out, opts, height, err);
    if (status == SS_OK) {
        ss_script_write_title(out, opts, head, NULL);
        ss_script_write_span(out, &span);
        fprintf(out, "colour = '#0072b2'\n%s", over ? "over = '#d55e00'\n" : "");
        write_traces(out, p, panels, head, &span);
        if (over)
            ss_script_write_trace(out, "$over", opts->over->values, &over_head, &over_span,
                                  p[0].exponent);
        fprintf(out, "bottom = %.4f; top = %.4f; panel = (top - bottom)/%zu\n", TIME / height,
                1 - TITLE / height, panels);
        fputs(layout, out);
        for (size_t i = 1; i <= panels; i++)
            plot_panel(out, &p[i - 1], i, panels, over && i == 1);
        fputs("unset multiplot\n", out);
        status = ss_script_end(out);
    }
    free(p);
    return status;
}

/* --- one over the other -------------------------------------------------------------------- */

static double
range(const double *x, size_t n, double unit)
{
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        lo = fmin(lo, x[i]);
        hi = fmax(hi, x[i]);
    }
    return (hi - lo) / unit;
}

/* A point nearer than half a pixel to the last one written is left out. */
static void
write_path(FILE *out, const char *name, const double *const x[2], size_t n, const double unit[2])
{
    double width = range(x[0], n, unit[0]), height = range(x[1], n, unit[1]);
    double near_x = width / (2 * SCRIPT_COLUMNS), near_y = height / (2 * SCRIPT_COLUMNS);
    size_t last = 0;
    fprintf(out, "%s << EOD\n", name);
    for (size_t i = 0; i < n; i++) {
        if (i > 0 && i + 1 < n && fabs(x[0][i] - x[0][last]) / unit[0] <= near_x
            && fabs(x[1][i] - x[1][last]) / unit[1] <= near_y)
            continue;
        ss_script_write(out, x[0][i] / unit[0], ss_script_decimals(width), " ");
        ss_script_write(out, x[1][i] / unit[1], ss_script_decimals(height), "\n");
        last = i;
    }
    fputs("EOD\n", out);
}

/* The columns of opts->over that have these names, else its first two. */
static ss_status
find_over(const double *over[2], const ss_plot_opts *opts, const ss_column *x, const ss_column *y, ss_error *err)
{
    if (opts->over == NULL)
        return SS_OK;
    const ss_header *head = opts->over->head;
    int found[2] = { ss_header_column(head, x->name), ss_header_column(head, y->name) };
    if (found[0] < 0 || found[1] < 0)
        found[1] = (found[0] = 0) + 1;
    if (head->n_columns < 2)
        return ss_fail(err, SS_EINVAL, "one column cannot be drawn over %s and %s", x->name, y->name);
    ss_status st = SS_OK;
    for (int i = 0; st == SS_OK && i < 2; i++) {
        over[i] = opts->over->values + (size_t)found[i] * opts->over->n;
        st = ss_script_check(head->column[found[i]].name, over[i], opts->over->n, err);
    }
    return st;
}

/* n samples of x and y, and over them those of a signal, unless it is NULL. */
static ss_status
write_xy(FILE *out, const ss_column *const column[2], const double *const x[2], size_t n,
         const double *const over[2], const ss_signal *of_over)
{
    double unit[2];
    script_label label[2];
    for (int i = 0; i < 2; i++) {
        int exponent = ss_script_exponent(x[i], n);
        unit[i] = pow(10, exponent);
        ss_script_make_label(&label[i], column[i], exponent, XY_ROOM);
    }
    ss_script_write_x_label(out, &label[0], "0,0.3");
    ss_script_write_side_label(out, 1, &label[1]);
    fputs("colour = '#0072b2'\n", out);
    ss_script_write_tics(out, "xtics", range(x[0], n, unit[0]), 6);
    ss_script_write_tics(out, "ytics", range(x[1], n, unit[1]), 6);
    write_path(out, "$path", x, n, unit);
    if (of_over != NULL) {
        fputs("over = '#d55e00'\n", out);
        write_path(out, "$over", over, of_over->n, unit);
    }
    fputs("unset key\n"
          "set lmargin at screen 0.175; set rmargin at screen 0.965\n"
          "set tmargin at screen 0.91; set bmargin at screen 0.16\n"
          "set autoscale fix; set offsets graph 0.05,graph 0.05,graph 0.05,graph 0.05\n"
          "set tics nomirror out scale 0.6; set border lw 0.8\n"
          "plot $path using 1:2 with lines lw 1 lc rgb colour", out);
    fputs(of_over != NULL ? ", $over using 1:2 with lines lw 1 lc rgb over\n" : "\n", out);
    return ss_script_end(out);
}

ss_status
ss_plot_xy(FILE *out, const ss_signal *signal, size_t x, size_t y, const ss_plot_opts *opts,
           ss_error *err)
{
    if (out == NULL || signal == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    script_span span;
    if (x >= head->n_columns || y >= head->n_columns)
        return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", (x > y ? x : y) + 1,
                       head->n_columns);
    ss_status status = ss_script_find_span(&span, head, signal->n, opts, err);
    if (status != SS_OK)
        return status;
    const ss_column *column[2] = { &head->column[x], &head->column[y] };
    const double *values = signal->values + span.first, *over[2] = { NULL, NULL };
    const double *at[2] = { values + x * signal->n, values + y * signal->n };
    for (int i = 0; status == SS_OK && i < 2; i++)
        status = ss_script_check(column[i]->name, at[i], span.n, err);
    if (status == SS_OK)
        status = find_over(over, opts, column[0], column[1], err);
    if (status == SS_OK)
        status = ss_script_begin(out, opts, 6.5, err);
    if (status != SS_OK)
        return status;
    ss_script_write_title(out, opts, head, NULL);
    return write_xy(out, column, at, span.n, over, opts->over);
}
