/* spectra.c -- the power spectral density of columns over a logarithmic axis of frequency, a panel
 * each. */
#include "plot/series.h"

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
        st = ss_script_find_span(&span, s.start, s.head->rate, s.rows, &opts, err);
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        ss_welch *welch = NULL;
        st = ss_welch_new(&welch, span.n, s.head->rate, opts.resolution, err);
        if (st == SS_OK)
            st = ss_series_rewind(&s, err);
        for (size_t got = 1; st == SS_OK && got > 0;) {
            st = ss_series_next(&s, &got, err);
            if (st == SS_OK)
                st = ss_welch_add(welch, s.value + i * s.piece, got, err);
        }
        if (st == SS_OK)
            st = ss_welch_end(&spectrum[i], welch, err);
        ss_welch_free(welch);
    }
    ss_series_free(&s);
    return st;
}

/* The spectrum of a layer in a panel; NULL: none. */
static const ss_spectrum *
in_panel(const layer *l, ss_spectrum *const spectrum[], size_t panel)
{
    for (size_t m = 0; m < l->n; m++)
        if (l->panel[m] == panel)
            return spectrum[m];
    return NULL;
}

static ss_status
write_panels(FILE *out, const ss_header *head, size_t n, const layer layers[], ss_spectrum *const *const of[],
             const ss_plot_opts *opts, ss_error *err)
{
    double from = INFINITY, to = 0;
    char name[40], unit[DENSITY_UNIT];
    script_stack stack;
    const ss_column *first[LAYERS];
    const ss_spectrum *s;
    ss_status st = ss_script_begin_stack(&stack, out, opts, head, BELOW + PANEL * (double)n, err);
    if (st != SS_OK)
        return st;
    for (size_t k = 0; k <= opts->n_over; k++) {
        s = of[k][0];
        from = fmin(from, s->step);
        to = fmax(to, (double)(s->n - 1) * s->step);
        first[k] = &(k == 0 ? head : ss_reader_header(opts->over[k - 1]))->column[layers[k].column[0]];
    }
    ss_print(out, "from = %.7g         # Hz\nto = %.7g           # Hz\nresolution = %.6g    # Hz, %zu segments\n",
             from, to, of[0][0]->resolution, of[0][0]->segments);
    ss_script_write_colours(out, opts);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k <= opts->n_over; k++) {
            ss_layer_name(name, k, i, 0);
            if ((s = in_panel(&layers[k], of[k], i)) != NULL)
                write_densities(out, name, s, opts->decibels);
        }
    ss_script_write_frame(out, 0.2, 0.95);
    if (opts->n_over > 0)
        ss_script_write_legend(out, opts, first);
    ss_print(out, "set logscale %s; set xrange [from:to]; set format x ''\n", opts->decibels ? "x" : "xy");
    for (size_t i = 0; i < n; i++) {
        script_extent e = SCRIPT_NO_EXTENT;             /* of densities above 0 */
        double gap = i + 1 < n ? 0.12 * PANEL : 0;
        for (size_t k = 0; k <= opts->n_over; k++)
            for (size_t m = 1; (s = in_panel(&layers[k], of[k], i)) != NULL && m < s->n; m++)
                ss_script_include(&e, s->density[m] > 0 ? s->density[m] : NAN);
        if (!opts->decibels)
            ss_script_write_decade_range(out, e.lo, e.hi);
        if (i + 1 == n) {
            fputs("set format x '%g'; set xlabel sprintf('frequency / Hz (resolution %.3g Hz)', resolution) "
                  "noenhanced offset 0,0.5\n", out);
            ss_script_write_decades(out, "x", from, to);
        }
        const ss_column *column = &head->column[layers->column[i]];
        ss_density_unit(unit, column->unit, opts->decibels);
        const script_axis y = { &(ss_column){ column->name, unit }, e, ss_script_power(0) };
        ss_script_write_panel(&stack, PANEL - gap, gap, &y, ROOM, 0);
        if (e.lo <= e.hi)
            ss_layers_plot(out, layers, opts, i, 0, "", "lines");
        else
            fputs("set label 2 '0 at all frequencies' at graph 0.5,0.5 center; set yrange [0.1:1]; set ytics (0)\n"
                  "plot NaN; set yrange [*:*]; set ytics autofreq; unset label 2\n", out);
    }
    return ss_script_end(out);
}

ss_status
ss_plot_spectrum(FILE *out, const ss_header *head, const size_t column[], size_t n, ss_spectrum *const spectrum[],
                 const ss_plot_opts *given, ss_error *err)
{
    ss_plot_opts own;
    layer layers[LAYERS] = { { .n = 0 } };
    ss_spectrum **over[LAYERS] = { NULL };
    ss_spectrum *const *of[LAYERS] = { spectrum };
    if (out == NULL || head == NULL || column == NULL || spectrum == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, given, err);
    if (st == SS_OK && n == 0)
        st = ss_fail(err, SS_EINVAL, "no columns to draw");
    if (st == SS_OK)
        st = ss_layers_find(layers, head, column, n, &own, err);
    for (size_t k = 1; st == SS_OK && k <= own.n_over; k++) {
        of[k] = over[k] = calloc(layers[k].n, sizeof *over[k]);
        st = over[k] == NULL ? ss_fail_memory(err, NULL)
            : ss_plot_spectra(over[k], own.over[k - 1], layers[k].column, layers[k].n, &own, err);
    }
    if (st == SS_OK)
        st = write_panels(out, head, n, layers, of, &own, err);
    for (size_t k = 1; k < LAYERS; k++) {
        for (size_t i = 0; over[k] != NULL && i < layers[k].n; i++)
            ss_spectrum_free(over[k][i]);
        free(over[k]);
    }
    ss_layers_free(layers);
    return st;
}
