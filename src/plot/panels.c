/* panels.c -- draw a signal over time with a panel for each column, or one column over another. */
#include "plot/contour.h"
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

/* A column that is drawn; the gaps of its span are to be freed. */
typedef struct trace {
    const ss_column *column;
    const double *x;            /* of the whole record */
    script_span span;
    script_scale scale;
    script_label label;
} trace;

static script_extent
extent_of(const trace *t)
{
    return ss_script_span_extent(t->x, &t->span);
}

static script_extent
joined(script_extent a, script_extent b)
{
    return (script_extent){ fmin(a.lo, b.lo), fmax(a.hi, b.hi) };
}

static ss_status
make_trace(trace *t, const ss_signal *signal, size_t column, const script_span *span, ss_error *err)
{
    if (column >= signal->head->n_columns)
        return ss_fail_column(err, column, signal->head->n_columns);
    *t = (trace){ .column = &signal->head->column[column], .x = signal->values + column * signal->n };
    t->span = *span;
    return ss_script_check(t->column->name, t->x + span->first, span->n, err);
}

/* The part of opts->over to draw, as if it began at this time, in its place among the options. */
static ss_status
find_over_span(script_span *span, double start, const ss_plot_opts *opts, ss_error *err)
{
    ss_header head = *opts->over->head;
    head.start = isnan(opts->over_start) ? start : opts->over_start;
    ss_status st = ss_script_find_span(span, &head, opts->over->n, opts, err);
    if (st == SS_OK)
        st = ss_script_find_gaps(span, &head, err);
    for (size_t i = 0; st == SS_OK && i < span->n_gaps; i++) {
        span->gap[i].from += head.start - opts->over->head->start;
        span->gap[i].to += head.start - opts->over->head->start;
    }
    return st;
}

/* The legend of a signal and another over it, above their panel. */
static void
write_legend(FILE *out, const ss_plot_opts *opts, const trace *first, const trace *over)
{
    fputs("set title offset 0,0.7; set key at graph 1, graph 1 bottom right horizontal samplen 1.5 noenhanced\n"
          "name = ", out);
    ss_script_quote(out, opts->name != NULL ? opts->name : first->column->name);
    fputs("; over_name = ", out);
    ss_script_quote(out, opts->over_name != NULL ? opts->over_name : over->column->name);
    putc('\n', out);
}

/* --- over time ------------------------------------------------------------------------------ */

/* In the letters of the smallest label. */
static void
make_labels(trace t[], size_t n)
{
    double font = 1;
    for (size_t i = 0; i < n; i++) {
        ss_script_make_label(&t[i].label, t[i].column, t[i].scale, ROOM);
        font = fmin(font, t[i].label.font);
    }
    for (size_t i = 0; i < n; i++)
        t[i].label.font = font;
}

/* The panels, and the trace t[n] over the first, unless opts->over is NULL.  A line of one sample would be
 * invisible. */
static ss_status
write_panels(FILE *out, const ss_header *head, trace t[], size_t n, const ss_plot_opts *opts, ss_error *err)
{
    const script_span *span = &t->span;
    int has_over = opts->over != NULL;
    script_stack stack;
    size_t bands = 0;
    ss_status st = ss_script_begin_stack(&stack, out, opts, head,
                                         (has_over ? LEGEND : 0) + TIME + PANEL * (double)n, err);
    if (st != SS_OK)
        return st;
    stack.top -= has_over ? LEGEND : 0;
    int letters = ss_script_write_span(out, span);
    ss_print(out, "colour = '" BLUE "'\n%s", has_over ? "over = '" VERMILION "'\n" : "");
    if (opts->features != NULL && (bands = ss_contour_write_spans(out, span, opts->features)) > 0)
        fputs("feature_colour = '" SHADE_COLOUR "'; set y2range [0:1]\n", out);
    for (size_t i = 0; i < n; i++) {
        char name[32];
        snprintf(name, sizeof name, "$panel%zu", i + 1);
        t[i].scale = ss_script_scale(extent_of(&t[i]));
        ss_script_write_trace(out, name, t[i].x, &t[i].span, t[i].scale);
    }
    make_labels(t, n);
    if (has_over)
        ss_script_write_trace(out, "$over", t[n].x, &t[n].span, t[0].scale);
    ss_script_write_frame(out, 0.175, letters < 5 ? 0.965 : 1 - 0.0095 * letters);
    fputs("set xrange [from:to]; set offsets 0,0,graph 0.06,graph 0.06; set autoscale yfix\n"
          "set xtics tics; set xtics format ''\n", out);
    if (has_over)
        write_legend(out, opts, &t[0], &t[n]);
    for (size_t i = 0; i < n; i++) {
        int over = has_over && i == 0;
        script_extent drawn = over ? joined(extent_of(&t[0]), extent_of(&t[n])) : extent_of(&t[i]);
        if (i + 1 == n)
            ss_script_write_time_labels(out, span);
        double gap = i + 1 < n ? 0.1 * PANEL : 0;
        ss_script_write_panel(&stack, PANEL - gap, gap, &t[i].label);
        ss_script_write_tics(out, "ytics", ss_script_scaled_extent(drawn, t[i].scale), 5);
        ss_print(out, "plot %s$panel%zu using 1:2 with %s lw 1 lc rgb colour%s\n",
                 bands > 0 ? "$spans using 1:(0):1:2:(0):(1) axes x1y2 with boxxyerror fill solid noborder "
                 "lc rgb feature_colour, " : "", i + 1, span->n > 1 ? "lines" : "points pt 7 ps 1",
                 over ? " title name, $over using 1:2 with lines lw 1 lc rgb over title over_name" : "");
        fputs(over ? "unset key\n" : "", out);
    }
    return ss_script_end(out);
}

ss_status
ss_plot_signal(FILE *out, const ss_signal *signal, const size_t column[], size_t n,
               const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    script_span span = { .gap = NULL }, over = { .gap = NULL };
    if (out == NULL || signal == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st != SS_OK)
        return st;
    size_t panels = n > 0 ? n : signal->head->n_columns;
    if (panels == 0)
        return ss_fail(err, SS_EINVAL, "no columns to draw");
    trace *t = malloc((panels + 1) * sizeof *t);
    st = t != NULL ? ss_script_find_span(&span, signal->head, signal->n, &own, err) : ss_fail_memory(err, NULL);
    if (st == SS_OK)
        st = ss_script_find_gaps(&span, signal->head, err);
    for (size_t i = 0; st == SS_OK && i < panels; i++)
        st = make_trace(&t[i], signal, n > 0 ? column[i] : i, &span, err);
    if (st == SS_OK && own.over != NULL) {
        st = find_over_span(&over, span.start, &own, err);
        if (st == SS_OK)
            st = make_trace(&t[panels], own.over, 0, &over, err);
    }
    if (st == SS_OK)
        st = ss_contour_check_overlay(own.features, err);
    if (st == SS_OK)
        st = write_panels(out, signal->head, t, panels, &own, err);
    free(over.gap);
    free(span.gap);
    free(t);
    return st;
}

/* --- one over the other -------------------------------------------------------------------- */

/* The columns with the names of x and y, or else the first two. */
static ss_status
find_over(size_t column[2], const ss_header *over, const trace t[2], ss_error *err)
{
    const char *name[2] = { t[0].column->name, t[1].column->name };
    int found[2] = { ss_header_column(over, name[0]), ss_header_column(over, name[1]) };
    int named = found[0] >= 0 && found[1] >= 0;
    for (int i = 0; i < 2; i++)
        column[i] = (size_t)(named ? found[i] : i);
    return named || over->n_columns >= 2 ? SS_OK
        : ss_fail(err, SS_EINVAL, "one column cannot be drawn over %s and %s", name[0], name[1]);
}

/* A point nearer than half a pixel to the last one written is left out. */
static void
write_path(FILE *out, const char *name, const trace t[2], const script_scale scale[2])
{
    const script_span *span = &t->span;
    size_t end = span->first + span->n;
    double last[2] = { INFINITY, INFINITY }, near[2];
    int decimals[2];
    for (int i = 0; i < 2; i++) {
        script_extent e = ss_script_scaled_extent(extent_of(&t[i]), scale[i]);
        near[i] = (e.hi - e.lo) / (2 * SCRIPT_COLUMNS);
        decimals[i] = ss_script_decimals(e.hi - e.lo);
    }
    ss_print(out, "%s << EOD\n", name);
    for (size_t k = span->first; k < end; k++) {
        double at[2] = { ss_script_scaled(t[0].x[k], scale[0]), ss_script_scaled(t[1].x[k], scale[1]) };
        if (ss_script_is_missing(span, k)) {
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

/* The path t, and another over it unless it is NULL. */
static ss_status
write_xy(FILE *out, const ss_header *head, const trace t[2], const trace *over, const ss_plot_opts *opts,
         ss_error *err)
{
    script_scale scale[2];
    script_label label[2];
    ss_status st = ss_script_begin(out, opts, head, 6.5, NULL, err);
    if (st != SS_OK)
        return st;
    for (int i = 0; i < 2; i++) {
        scale[i] = ss_script_scale(extent_of(&t[i]));
        ss_script_make_label(&label[i], t[i].column, scale[i], XY_ROOM);
    }
    ss_script_write_x_label(out, &label[0], "0,0.3");
    ss_script_write_side_label(out, 1, &label[1]);
    ss_script_write_frame(out, 0.175, 0.965);
    fputs("colour = '" BLUE "'\n", out);
    for (int i = 0; i < 2; i++) {
        script_extent drawn = over != NULL ? joined(extent_of(&t[i]), extent_of(&over[i])) : extent_of(&t[i]);
        ss_script_write_tics(out, i == 0 ? "xtics" : "ytics", ss_script_scaled_extent(drawn, scale[i]), 6);
    }
    write_path(out, "$path", t, scale);
    if (over != NULL) {
        fputs("over = '" VERMILION "'\n", out);
        write_path(out, "$over", over, scale);
        write_legend(out, opts, &t[1], &over[1]);
    }
    fputs(over != NULL ? "rim = 0.85\n" : "rim = 0.91\n", out);
    fputs("unset grid; set tmargin at screen rim; set bmargin at screen 0.16\n"
          "set autoscale fix; set offsets graph 0.05,graph 0.05,graph 0.05,graph 0.05\n"
          "plot $path using 1:2 with lines lw 1 lc rgb colour", out);
    fputs(over != NULL ? " title name, $over using 1:2 with lines lw 1 lc rgb over title over_name\n" : "\n", out);
    return ss_script_end(out);
}

ss_status
ss_plot_xy(FILE *out, const ss_signal *signal, size_t x, size_t y, const ss_plot_opts *opts,
           ss_error *err)
{
    ss_plot_opts own;
    script_span span = { .gap = NULL }, over_span = { .gap = NULL };
    trace t[2], over[2];
    size_t column[2] = { x, y };
    if (out == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK)
        st = ss_script_find_span(&span, signal->head, signal->n, &own, err);
    if (st == SS_OK)
        st = ss_script_find_gaps(&span, signal->head, err);
    for (int i = 0; st == SS_OK && i < 2; i++)
        st = make_trace(&t[i], signal, column[i], &span, err);
    if (st == SS_OK && own.over != NULL) {
        st = find_over(column, own.over->head, t, err);
        if (st == SS_OK)
            st = find_over_span(&over_span, span.start, &own, err);
        for (int i = 0; st == SS_OK && i < 2; i++)
            st = make_trace(&over[i], own.over, column[i], &over_span, err);
    }
    if (st == SS_OK)
        st = write_xy(out, signal->head, t, own.over != NULL ? over : NULL, &own, err);
    free(over_span.gap);
    free(span.gap);
    return st;
}
