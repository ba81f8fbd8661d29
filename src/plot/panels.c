/* panels.c -- draw a signal over time with a panel for each column. */
#include "plot/contour.h"
#include "plot/series.h"
#include "plot/style.h"

#include <math.h>
#include <stdlib.h>
#include "base/error.h"

#define PANEL 2.1               /* height of one panel [cm] */
#define TIME 1.0                /* and below them [cm] */
#define ROOM 8.2                /* for the label of a panel [ems] */

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
write_panels(FILE *out, const ss_header *head, const script_span *span, trace t[], size_t n,
             const ss_plot_opts *opts, ss_error *err)
{
    int has_over = opts->over != NULL;
    double legend = has_over ? SCRIPT_LEGEND : 0;
    script_stack stack;
    size_t bands = 0;
    ss_status st = ss_script_begin_stack(&stack, out, opts, head, legend + TIME + PANEL * (double)n, err);
    if (st != SS_OK)
        return st;
    stack.top -= legend;
    int letters = ss_script_write_span(out, span);
    ss_print(out, "colour = '" BLUE "'\n%s", has_over ? "over = '" VERMILION "'\n" : "");
    if (opts->features != NULL && (bands = ss_contour_write_spans(out, span, opts->features)) > 0)
        fputs("feature_colour = '" SHADE_COLOUR "'; set y2range [0:1]\n", out);
    for (size_t i = 0; i < n; i++) {
        char name[32];
        snprintf(name, sizeof name, "$panel%zu", i + 1);
        ss_trace_write(out, name, &t[i]);
    }
    make_labels(t, n);
    if (has_over) {
        t[n].scale = t[0].scale;
        ss_trace_write(out, "$over", &t[n]);
        ss_script_widen(&t[0].extent, t[n].extent);
    }
    ss_script_write_frame(out, 0.175, letters < 5 ? 0.965 : 1 - 0.0095 * letters);
    fputs("set xrange [from:to]; set offsets 0,0,graph 0.06,graph 0.06; set autoscale yfix\n"
          "set xtics tics; set xtics format ''\n", out);
    if (has_over)
        ss_script_write_legend(out, opts, t[0].column, t[n].column);
    for (size_t i = 0; i < n; i++) {
        int over = has_over && i == 0;
        double gap = i + 1 < n ? 0.1 * PANEL : 0;
        if (i + 1 == n)
            ss_script_write_time_labels(out, span);
        ss_script_write_panel(&stack, PANEL - gap, gap, &t[i].label);
        ss_script_write_tics(out, "ytics", ss_script_scaled_extent(t[i].extent, t[i].scale), 5);
        ss_print(out, "plot %s$panel%zu using 1:2 with %s lw 1 lc rgb colour%s\n",
                 bands > 0 ? "$spans using 1:(0):1:2:(0):(1) axes x1y2 with boxxyerror fill solid noborder "
                 "lc rgb feature_colour, " : "", i + 1, span->n > 1 ? "lines" : "points pt 7 ps 1",
                 over ? " title name, $over using 1:2 with lines lw 1 lc rgb over title over_name" : "");
        fputs(over ? "unset key\n" : "", out);
    }
    return ss_script_end(out);
}

ss_status
ss_plot_signal(FILE *out, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
               ss_error *err)
{
    ss_plot_opts own;
    script_span span, of_over;
    if (out == NULL || reader == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st != SS_OK)
        return st;
    const ss_header *head = ss_reader_header(reader);
    size_t panels = n > 0 ? n : head->n_columns;
    if (panels == 0)
        return ss_fail(err, SS_EINVAL, "no columns to draw");
    trace *t = calloc(panels + 1, sizeof *t);
    size_t *index = malloc(panels * sizeof *index);
    st = t != NULL && index != NULL ? ss_contour_check_overlay(own.features, err) : ss_fail_memory(err, NULL);
    for (size_t i = 0; st == SS_OK && i < panels; i++)
        index[i] = n > 0 ? column[i] : i;
    if (st == SS_OK)
        st = ss_traces_read(t, &span, reader, index, panels, NAN, &own, err);
    if (st == SS_OK && own.over != NULL)
        st = ss_traces_read(t + panels, &of_over, own.over, (const size_t[]){ 0 }, 1, head->start, &own, err);
    if (st == SS_OK)
        st = write_panels(out, head, &span, t, panels, &own, err);
    if (t != NULL)
        ss_traces_free(t, panels + 1);
    free(index);
    free(t);
    return st;
}
