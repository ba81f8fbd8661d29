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

/* The scale of a panel, known when its trace is written. */
typedef struct trace_scale {
    double range;
    int exponent;
} trace_scale;

/* The first column of opts->over, as if it were sampled from the start of the signal on.  Its values count
 * in the range, but not in the exponent. */
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

ss_status
ss_plot_signal(FILE *out, const ss_signal *signal, const size_t column[], size_t n,
               const ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || signal == NULL || opts == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    const ss_header *head = signal->head;
    ss_header over_head;
    script_span span, over_span;
    size_t panels = n > 0 ? n : head->n_columns;
    double height = TITLE + TIME + PANEL * (double)panels;
    for (size_t i = 0; i < n; i++)
        if (column[i] >= head->n_columns)
            return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", column[i] + 1,
                           head->n_columns);
    if (panels == 0)
        return ss_fail(err, SS_EINVAL, "no columns to draw");
    ss_status status = ss_script_find_span(&span, head, signal->n, opts, err);
    for (size_t i = 0; status == SS_OK && i < panels; i++) {
        size_t c = n > 0 ? column[i] : i;
        status = ss_script_check(head->column[c].name, signal->values + c * signal->n + span.first,
                                 span.n, err);
    }
    if (status == SS_OK)
        status = check_over(&over_head, &over_span, head, opts, err);
    if (status == SS_OK)
        status = ss_script_begin(out, opts, height, err);
    if (status != SS_OK)
        return status;
    trace_scale *scale_of = malloc(panels * sizeof *scale_of);
    if (scale_of == NULL)
        return ss_fail_memory(err, NULL);
    ss_script_write_title(out, opts, head, NULL);
    ss_script_write_span(out, &span);
    fputs("colour = '#0072b2'\n", out);
    if (opts->over != NULL)
        fputs("over = '#d55e00'\n", out);
    for (size_t i = 0; i < panels; i++) {
        size_t c = n > 0 ? column[i] : i;
        const double *x = signal->values + c * signal->n;
        char name[32];
        snprintf(name, sizeof name, "$panel%zu", i + 1);
        scale_of[i].exponent = ss_script_exponent(x + span.first, span.n);
        scale_of[i].range = ss_script_write_trace(out, name, x, head, &span, scale_of[i].exponent);
    }
    if (opts->over != NULL)
        ss_script_write_trace(out, "$over", opts->over->values, &over_head, &over_span,
                              scale_of[0].exponent);
    fprintf(out, "bottom = %.4f; top = %.4f; panel = (top - bottom)/%zu\n", TIME / height,
            1 - TITLE / height, panels);
    fputs(layout, out);
    for (size_t i = 1; i <= panels; i++) {
        if (i == panels)
            fputs(SCRIPT_TIME_LABELS, out);
        fprintf(out, "set tmargin at screen top - %zu*panel; set bmargin at screen top - %zu*panel "
                "+ 0.1*panel*(%zu)\n", i - 1, i, (size_t)(i < panels));
        script_label label;
        ss_script_make_label(&label, &head->column[n > 0 ? column[i - 1] : i - 1],
                             scale_of[i - 1].exponent, ROOM);
        fputs("unset label 1; ", out);
        ss_script_write_side_label(out, 1, &label);
        ss_script_write_tics(out, "ytics", scale_of[i - 1].range, 5);
        fprintf(out, "plot $panel%zu using 1:2 with lines lw 1 lc rgb colour%s\n", i,
                i == 1 && opts->over != NULL ? ", $over using 1:2 with lines lw 1 lc rgb over" : "");
        if (i == 1)
            fputs("unset title\n", out);
    }
    free(scale_of);
    fputs("unset multiplot\n", out);
    return ss_script_end(out);
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
write_path(FILE *out, const char *name, const double *x, const double *y, size_t n, double x_unit, double y_unit)
{
    double x_range = range(x, n, x_unit), y_range = range(y, n, y_unit);
    double near_x = x_range / (2 * SCRIPT_COLUMNS), near_y = y_range / (2 * SCRIPT_COLUMNS);
    size_t last = 0;
    fprintf(out, "%s << EOD\n", name);
    for (size_t i = 0; i < n; i++) {
        if (i > 0 && i + 1 < n && fabs(x[i] - x[last]) / x_unit <= near_x
            && fabs(y[i] - y[last]) / y_unit <= near_y)
            continue;
        ss_script_write(out, x[i] / x_unit, ss_script_decimals(x_range), " ");
        ss_script_write(out, y[i] / y_unit, ss_script_decimals(y_range), "\n");
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
    const double *of_x = signal->values + x * signal->n + span.first;
    const double *of_y = signal->values + y * signal->n + span.first, *over[2] = { NULL, NULL };
    status = ss_script_check(head->column[x].name, of_x, span.n, err);
    if (status == SS_OK)
        status = ss_script_check(head->column[y].name, of_y, span.n, err);
    if (status == SS_OK)
        status = find_over(over, opts, &head->column[x], &head->column[y], err);
    if (status == SS_OK)
        status = ss_script_begin(out, opts, 6.5, err);
    if (status != SS_OK)
        return status;
    int exponent[2] = { ss_script_exponent(of_x, span.n), ss_script_exponent(of_y, span.n) };
    script_label x_label, y_label;
    ss_script_make_label(&x_label, &head->column[x], exponent[0], XY_ROOM);
    ss_script_make_label(&y_label, &head->column[y], exponent[1], XY_ROOM);
    ss_script_write_title(out, opts, head, NULL);
    fputs("set xlabel ", out);
    ss_script_write_label(out, &x_label);
    fputs(" noenhanced offset 0,0.3", out);
    ss_script_write_font(out, &x_label);
    putc('\n', out);
    ss_script_write_side_label(out, 1, &y_label);
    fputs("colour = '#0072b2'\n", out);
    double unit[2] = { pow(10, exponent[0]), pow(10, exponent[1]) };
    ss_script_write_tics(out, "xtics", range(of_x, span.n, unit[0]), 6);
    ss_script_write_tics(out, "ytics", range(of_y, span.n, unit[1]), 6);
    write_path(out, "$path", of_x, of_y, span.n, unit[0], unit[1]);
    if (opts->over != NULL) {
        fputs("over = '#d55e00'\n", out);
        write_path(out, "$over", over[0], over[1], opts->over->n, unit[0], unit[1]);
    }
    fputs("unset key\n"
          "set lmargin at screen 0.175; set rmargin at screen 0.965\n"
          "set tmargin at screen 0.91; set bmargin at screen 0.16\n"
          "set autoscale fix; set offsets graph 0.05,graph 0.05,graph 0.05,graph 0.05\n"
          "set tics nomirror out scale 0.6; set border lw 0.8\n"
          "plot $path using 1:2 with lines lw 1 lc rgb colour", out);
    fputs(opts->over != NULL ? ", $over using 1:2 with lines lw 1 lc rgb over\n" : "\n", out);
    return ss_script_end(out);
}
