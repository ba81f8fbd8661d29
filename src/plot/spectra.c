/* spectra.c -- the power spectral density of columns over a logarithmic axis of frequency, a panel
 * each. */
#include "plot/series.h"
#include "plot/style.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <stickslip/spectrum.h>
#include "base/error.h"
#include "signal/header.h"
#include "signal/welch.h"

#define PANEL 3.4               /* height of one panel [cm] */
#define BELOW 1.0               /* and below them [cm] */
#define ROOM 12.0               /* for the label of a panel [ems] */

static void
label_of(script_label *label, const ss_column *column, int decibels)
{
    char unit[DENSITY_UNIT];
    ss_density_unit(unit, column->unit, decibels);
    ss_script_make_label(label, &(ss_column){ column->name, unit }, ss_script_power(0), ROOM);
}

static void
write_density(FILE *out, const ss_spectrum *s, size_t k, int decibels)
{
    if (s->density[k] > 0)
        ss_print(out, "%.7g %.6g\n", (double)k * s->step, decibels ? 10 * log10(s->density[k]) : s->density[k]);
}

/* The least and the most of each column of pixels, in the order of frequency. */
static void
write_densities(FILE *out, const char *name, const ss_spectrum *s, int decibels)
{
    double columns = SCRIPT_COLUMNS / log((double)s->n);
    ss_print(out, "%s << EOD\n", name);
    for (size_t k = 1, low, high; k < s->n;) {
        double column = floor(columns * log((double)k));
        for (low = high = k; k < s->n && floor(columns * log((double)k)) == column; k++) {
            low = s->density[k] < s->density[low] ? k : low;
            high = s->density[k] > s->density[high] ? k : high;
        }
        write_density(out, s, low < high ? low : high, decibels);
        if (low != high)
            write_density(out, s, low < high ? high : low, decibels);
    }
    fputs("EOD\n", out);
}

/* --- a signal of any length ----------------------------------------------------------------- */

/* The spectrum of one column of n rows. */
static ss_status
estimate(ss_spectrum **out, series *s, size_t column, size_t n, double resolution, ss_error *err)
{
    ss_welch *welch = NULL;
    ss_status st = ss_welch_new(&welch, n, s->head->rate, resolution, err);
    if (st == SS_OK)
        st = ss_series_rewind(s, err);
    for (size_t got = 1; st == SS_OK && got > 0;) {
        st = ss_series_next(s, &got, err);
        if (st == SS_OK)
            st = ss_welch_add(welch, s->value + column * s->piece, got, err);
    }
    if (st == SS_OK)
        st = ss_welch_end(out, welch, err);
    ss_welch_free(welch);
    return st;
}

/* The rows are read once to be counted, and once for each column. */
ss_status
ss_plot_spectra(ss_spectrum *spectrum[], ss_reader *reader, const size_t column[], size_t n,
                const ss_plot_opts *given, ss_error *err)
{
    ss_plot_opts opts;
    series s;
    script_span span;
    if (spectrum == NULL || reader == NULL || column == NULL)
        return SS_FAIL_NULL(err);
    memset(spectrum, 0, n * sizeof *spectrum);
    ss_status st = ss_script_take(&opts, given, err);
    if (st != SS_OK)
        return st;
    st = ss_series_begin(&s, reader, column, n, NAN, &opts, err);
    s.n_gaps = 0;                       /* values in gaps count as they were filled in */
    if (st == SS_OK)
        st = ss_series_rewind(&s, err);
    for (size_t got = 1; st == SS_OK && got > 0;)
        st = ss_series_next(&s, &got, err);
    if (st == SS_OK)
        st = ss_series_span(&span, &s, &opts, err);
    for (size_t i = 0; st == SS_OK && i < n; i++)
        st = estimate(&spectrum[i], &s, i, span.n, opts.resolution, err);
    ss_series_free(&s);
    return st;
}

/* --- the script ----------------------------------------------------------------------------- */

/* The smallest and the largest density above 0. */
static script_extent
extent_of(const ss_spectrum *s)
{
    script_extent e = SCRIPT_NO_EXTENT;
    for (size_t k = 1; k < s->n; k++)
        if (s->density[k] > 0)
            ss_script_include(&e, s->density[k]);
    return e;
}

/* The spectra of another signal over some panels. */
typedef struct layer {
    ss_spectrum **s;
    size_t *column, *panel, n;
} layer;

static ss_status
read_layer(layer *l, ss_reader *over, const ss_header *head, const size_t column[], size_t n,
           const ss_plot_opts *opts, ss_error *err)
{
    l->s = calloc(n, sizeof *l->s);
    l->column = malloc(n * sizeof *l->column);
    l->panel = malloc(n * sizeof *l->panel);
    if (l->s == NULL || l->column == NULL || l->panel == NULL)
        return ss_fail_memory(err, NULL);
    l->n = ss_series_over(l->column, l->panel, head, column, n, ss_reader_header(over), opts->alike);
    return ss_plot_spectra(l->s, over, l->column, l->n, opts, err);
}

static void
free_layer(layer *l)
{
    for (size_t i = 0; i < l->n; i++)
        ss_spectrum_free(l->s[i]);
    free(l->s);
    free(l->column);
    free(l->panel);
}

/* The spectrum of signal k over a panel; NULL: none. */
static const ss_spectrum *
over_panel(const layer *l, size_t panel)
{
    for (size_t m = 0; m < l->n; m++)
        if (l->panel[m] == panel)
            return l->s[m];
    return NULL;
}

/* Panel i and the spectra over it, whose extent is e. */
static void
plot_panel(FILE *out, const layer layers[], const ss_plot_opts *opts, size_t i, script_extent e)
{
    int titled = i == 0 && opts->n_over > 0;
    if (!(e.lo <= e.hi)) {
        fputs("set label 2 '0 at all frequencies' at graph 0.5,0.5 center; set yrange [0.1:1]; set ytics (0)\n"
              "plot NaN; set yrange [*:*]; set ytics autofreq; unset label 2\n", out);
        return;
    }
    ss_print(out, "plot $panel%zu using 1:2 with lines lw 1 lc rgb colour%s", i + 1, titled ? " title name" : "");
    for (size_t k = 0; k < opts->n_over; k++) {
        char block[60] = "NaN";
        int is_there = over_panel(&layers[k], i) != NULL;
        if (is_there)
            snprintf(block, sizeof block, "$over%s_panel%zu using 1:2", ss_script_number[k], i + 1);
        if (is_there || titled)
            ss_script_write_over(out, k, block, titled);
    }
    fputs(titled ? "\nunset key\n" : "\n", out);
}

static ss_status
write_panels(FILE *out, const ss_header *head, const size_t column[], size_t n, ss_spectrum *const spectrum[],
             const layer layers[], const ss_plot_opts *opts, ss_error *err)
{
    double font = 1, legend = ss_script_legend(opts), from = spectrum[0]->step, to = 0;
    char name[40];
    script_stack stack;
    const ss_column *first[SS_PLOT_OVER + 1] = { &head->column[column[0]] };
    const ss_spectrum *s = spectrum[0], *over;
    script_label label;
    ss_status st = ss_script_begin_stack(&stack, out, opts, head, legend + BELOW + PANEL * (double)n, err);
    if (st != SS_OK)
        return st;
    stack.top -= legend;
    to = (double)(s->n - 1) * s->step;
    for (size_t k = 0; k < opts->n_over; k++) {
        over = layers[k].s[0];
        from = fmin(from, over->step);
        to = fmax(to, (double)(over->n - 1) * over->step);
        first[k + 1] = &ss_reader_header(opts->over[k])->column[layers[k].column[0]];
    }
    ss_print(out, "from = %.7g         # Hz\nto = %.7g           # Hz\nresolution = %.6g    # Hz, %zu segments\n",
             from, to, s->resolution, s->segments);
    ss_script_write_colours(out, opts);
    for (size_t i = 0; i < n; i++) {
        snprintf(name, sizeof name, "$panel%zu", i + 1);
        write_densities(out, name, spectrum[i], opts->decibels);
        for (size_t k = 0; k < opts->n_over; k++) {
            snprintf(name, sizeof name, "$over%s_panel%zu", ss_script_number[k], i + 1);
            if ((over = over_panel(&layers[k], i)) != NULL)
                write_densities(out, name, over, opts->decibels);
        }
        label_of(&label, &head->column[column[i]], opts->decibels);
        font = fmin(font, label.font);          /* one for all panels */
    }
    ss_script_write_frame(out, 0.2, 0.95);
    if (opts->n_over > 0)
        ss_script_write_legend(out, opts, first);
    ss_print(out, "set logscale %s; set xrange [from:to]; set format x ''\n", opts->decibels ? "x" : "xy");
    for (size_t i = 0; i < n; i++) {
        script_extent e = extent_of(spectrum[i]);
        double gap = i + 1 < n ? 0.08 * PANEL : 0;
        for (size_t k = 0; k < opts->n_over; k++)
            if ((over = over_panel(&layers[k], i)) != NULL)
                ss_script_widen(&e, extent_of(over));
        if (!opts->decibels)
            ss_script_write_decade_range(out, e.lo, e.hi);
        if (i + 1 == n) {
            fputs("set format x '%g'; set xlabel sprintf('frequency / Hz (resolution %.3g Hz)', resolution) "
                  "noenhanced offset 0,0.5\n", out);
            ss_script_write_decades(out, "x", from, to);
        }
        label_of(&label, &head->column[column[i]], opts->decibels);
        label.font = font;
        ss_script_write_panel(&stack, PANEL - gap, gap, &label);
        plot_panel(out, layers, opts, i, e);
    }
    return ss_script_end(out);
}

ss_status
ss_plot_spectrum(FILE *out, const ss_header *head, const size_t column[], size_t n, ss_spectrum *const spectrum[],
                 const ss_plot_opts *given, ss_error *err)
{
    ss_plot_opts own;
    layer layers[SS_PLOT_OVER] = { { .n = 0 } };
    if (out == NULL || head == NULL || column == NULL || spectrum == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, given, err);
    if (st == SS_OK)
        st = ss_script_check_over(&own, err);
    if (st == SS_OK && n == 0)
        st = ss_fail(err, SS_EINVAL, "no columns to draw");
    for (size_t k = 0; st == SS_OK && k < own.n_over; k++)
        st = read_layer(&layers[k], own.over[k], head, column, n, &own, err);
    if (st == SS_OK)
        st = write_panels(out, head, column, n, spectrum, layers, &own, err);
    for (size_t k = 0; k < SS_PLOT_OVER; k++)
        free_layer(&layers[k]);
    return st;
}
