/* panels.c -- draw a signal over time with a panel for each column. */
#include "plot/contour.h"
#include "plot/series.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"

#define PANEL 2.1               /* height of one panel [cm] */
#define TIME 1.0                /* and below them [cm] */
#define ROOM 8.2                /* for the label of a panel [ems] */

typedef struct drawing {
    FILE *out;
    const ss_plot_opts *opts;
    const script_span *span;
    size_t n;                           /* panels of columns */
    layer layer[LAYERS];
    trace *of[LAYERS];                  /* the columns of each, */
    trace left[LAYERS];                 /* and what the first panel's column has beyond it; of none: no column */
    ss_column difference;
    trace of_left;                      /* the column, the extent and the scale that these share */
    size_t bands;                       /* of features */
} drawing;

/* The differences of all signals from the first panel, which have one scale and label. */
static ss_status
write_differences(drawing *d, ss_error *err)
{
    trace *all = &d->of_left;
    d->difference = (ss_column){ (char *)"difference", d->of[0]->y.column->unit };
    *all = (trace){ .y = { &d->difference, SCRIPT_NO_EXTENT, ss_script_power(0) } };
    for (size_t k = 1; k <= d->opts->n_over; k++)
        if (d->left[k].y.column != NULL)
            ss_script_widen(&all->y.extent, d->left[k].y.extent);
    if (!(all->y.extent.lo <= all->y.extent.hi))
        return ss_fail(err, SS_EINVAL, "no difference can be drawn: no other column lies over the first panel");
    all->y.scale = ss_script_scale(all->y.extent);
    for (size_t k = 1; k <= d->opts->n_over; k++) {
        char block[24];
        d->left[k].y.scale = all->y.scale;
        snprintf(block, sizeof block, "$difference%s", ss_script_number[k - 1]);
        if (d->left[k].y.column != NULL)
            ss_trace_write(d->out, block, &d->left[k]);
    }
    return SS_OK;
}

static ss_status
write_panels(drawing *d, const ss_header *head, ss_error *err)
{
    FILE *out = d->out;
    const ss_plot_opts *opts = d->opts;
    const ss_column *first[LAYERS];
    size_t panels = d->n + (opts->difference != 0);
    char name[40];
    script_stack stack;
    ss_status st = ss_script_begin_stack(&stack, out, opts, head, TIME + PANEL * (double)panels, err);
    if (st != SS_OK)
        return st;
    int letters = ss_script_write_span(out, d->span);
    ss_script_write_colours(out, opts);
    if (opts->features != NULL && (d->bands = ss_contour_write_spans(out, d->span, opts->features)) > 0)
        fputs("feature_colour = '" SHADE_COLOUR "'; set y2range [0:1]\n", out);
    for (size_t k = 0; k <= opts->n_over; k++)
        for (size_t m = 0; m < d->layer[k].n; m++) {            /* those over a panel have its scale */
            size_t panel = d->layer[k].panel[m];
            trace *t = &d->of[k][m], *under = &d->of[0][panel];
            t->y.scale = under->y.scale;
            ss_layer_name(name, k, panel, 1);
            ss_trace_write(out, name, t);
            ss_script_widen(&under->y.extent, t->y.extent);
        }
    if (opts->difference && (st = write_differences(d, err)) != SS_OK)
        return st;
    ss_script_write_frame(out, 0.175, letters < 5 ? 0.965 : 1 - 0.0095 * letters);
    fputs("set xrange [from:to]; set offsets 0,0,graph 0.06,graph 0.06; set autoscale yfix\n"
          "set xtics tics; set xtics format ''\n", out);
    for (size_t k = 0; k <= opts->n_over; k++)
        first[k] = d->of[k]->y.column;
    if (opts->n_over > 0)
        ss_script_write_legend(out, opts, first);
    for (size_t i = 0; i < panels; i++) {
        int is_left = opts->difference && i == 1;
        size_t column = i > 1 && opts->difference ? i - 1 : i;
        const trace *t = is_left ? &d->of_left : &d->of[0][column];
        double gap = i + 1 < panels ? 0.1 * PANEL : 0;
        if (i + 1 == panels)
            ss_script_write_time_labels(out, d->span);
        ss_script_write_panel(&stack, PANEL - gap, gap, &t->y, ROOM, 5);
        const char *before = "plot ";
        for (size_t k = 1; is_left && k <= opts->n_over; k++)
            if (d->left[k].y.column != NULL) {
                const char *number = ss_script_number[k - 1];
                ss_print(out, "%s$difference%s using 1:2 with lines lw 1 lc rgb over%s", before, number, number);
                before = ", ";
            }
        if (is_left)
            putc('\n', out);
        else                            /* a line of one sample would be invisible */
            ss_layers_plot(out, d->layer, opts, column, 1, d->bands > 0 ? "$spans using 1:(0):1:2:(0):(1) axes "
                           "x1y2 with boxxyerror fill solid noborder lc rgb feature_colour, " : "",
                           d->span->n > 1 ? "lines" : "points pt 7 ps 1");
    }
    return ss_script_end(out);
}

/* Read column x of one signal less column y of another, which begins with it. */
static ss_status
read_difference(trace *t, ss_reader *reader, size_t x, ss_reader *over, size_t y, const ss_plot_opts *opts,
                ss_error *err)
{
    ss_plot_opts whole = *opts;
    whole.from = whole.to = NAN;
    series s, o;                                /* o: the other */
    size_t n = 1, next = 0, there = 1;          /* the next sample of its piece; there: of so many */
    double row = 0, number = -1, before = NAN, value = NAN;     /* its sample of this number, and the one before */
    script_span span;
    ss_status st = ss_series_begin(&s, reader, &x, 1, NAN, opts, err);
    ss_status other = ss_series_begin(&o, over, &y, 1, ss_reader_header(reader)->start, &whole, err);
    st = st == SS_OK ? other : st;
    if (st == SS_OK && (st = ss_series_rewind(&s, err)) == SS_OK)
        st = ss_series_rewind(&o, err);
    if (st == SS_OK && !ss_extremes_make(&t->block, BLOCKS, 1))
        st = ss_fail_memory(err, NULL);
    for (row = (double)s.first; st == SS_OK && n > 0;) {
        st = ss_series_next(&s, &n, err);
        for (size_t i = 0; st == SS_OK && i < n; i++, row++) {
            double at = row * (o.head->rate / s.head->rate);
            for (; st == SS_OK && number < at; number++) {
                if (there > 0 && (number < 0 || next == there)) {
                    st = ss_series_next(&o, &there, err);
                    next = 0;
                }
                before = value;
                value = next < there ? o.value[next++] : NAN;           /* NaN behind the end */
            }
            double part = number - at;
            s.value[i] -= part > 0 ? value + part * (before - value) : value;
        }
        if (st == SS_OK)
            ss_extremes_add(&t->block, s.value, n);
    }
    t->y.column = &s.head->column[x];
    if (st == SS_OK)
        st = ss_script_find_span(&span, s.start, s.head->rate, s.rows, opts, err);
    if (st == SS_OK)
        st = ss_trace_end(t, &s, &span, err);
    ss_series_free(&s);
    ss_series_free(&o);
    return st;
}

ss_status
ss_plot_signal(FILE *out, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
               ss_error *err)
{
    ss_plot_opts own;
    script_span span, ignored;
    if (out == NULL || reader == NULL || (column == NULL && n > 0))
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st != SS_OK)
        return st;
    const ss_header *head = ss_reader_header(reader);
    drawing d = { .out = out, .opts = &own, .span = &span, .n = n > 0 ? n : head->n_columns };
    if (d.n == 0)
        return ss_fail(err, SS_EINVAL, "no columns to draw");
    st = ss_layers_find(d.layer, head, n > 0 ? column : NULL, d.n, &own, err);
    for (size_t k = 0; st == SS_OK && k <= own.n_over; k++) {
        const layer *l = &d.layer[k];
        ss_reader *of = k == 0 ? reader : own.over[k - 1];
        d.of[k] = calloc(l->n, sizeof *d.of[k]);
        st = d.of[k] == NULL ? ss_fail_memory(err, NULL)
            : ss_traces_read(d.of[k], k == 0 ? &span : &ignored, of, l->column, l->n, k == 0 ? NAN : head->start,
                             &own, err);
        if (st == SS_OK && k > 0 && own.difference && l->panel[0] == 0)
            st = read_difference(&d.left[k], reader, *d.layer->column, of, *l->column, &own, err);
    }
    if (st == SS_OK)
        st = write_panels(&d, head, err);
    for (size_t k = 0; k < LAYERS; k++) {
        ss_traces_free(d.of[k], d.of[k] != NULL ? d.layer[k].n : 0);
        ss_traces_free(&d.left[k], 1);
        free(d.of[k]);
    }
    ss_layers_free(d.layer);
    return st;
}
