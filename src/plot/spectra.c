/* spectra.c -- the power spectral density of columns over a logarithmic axis of frequency, a panel each, or as
 * text. */
#include "plot/series.h"

#include <math.h>
#include <stdlib.h>
#include <stickslip/spectrum.h>
#include "base/error.h"
#include "io/record.h"
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

/* Estimate the spectra of n columns, *spectrum, which the caller frees even after a failure.  The rows are read
 * once to be counted, and once for each column. */
static ss_status
find_spectra(ss_spectrum ***spectrum, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *opts,
             ss_error *err)
{
    series s;
    script_span span;
    *spectrum = calloc(n + 1, sizeof **spectrum);
    if (*spectrum == NULL)
        return ss_fail_memory(err, NULL);
    ss_status st = ss_series_begin(&s, reader, column, n, NAN, opts, err);
    s.n_gaps = 0;                       /* values in gaps count as they were filled in */
    if (st == SS_OK)
        st = ss_series_rewind(&s, err);
    for (size_t got = 1; st == SS_OK && got > 0;)
        st = ss_series_next(&s, &got, err);
    if (st == SS_OK)
        st = ss_script_find_span(&span, s.start, s.head->rate, s.rows, opts, err);
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        ss_welch *welch = NULL;
        st = ss_welch_new(&welch, span.n, s.head->rate, opts->resolution, err);
        if (st == SS_OK)
            st = ss_series_rewind(&s, err);
        for (size_t got = 1; st == SS_OK && got > 0;) {
            st = ss_series_next(&s, &got, err);
            if (st == SS_OK)
                st = ss_welch_add(welch, s.value + i * s.piece, got, err);
        }
        if (st == SS_OK)
            st = ss_welch_end(&(*spectrum)[i], welch, err);
        ss_welch_free(welch);
    }
    ss_series_free(&s);
    return st;
}

static void
free_spectra(ss_spectrum **spectrum, size_t n)
{
    for (size_t i = 0; spectrum != NULL && i < n; i++)
        ss_spectrum_free(spectrum[i]);
    free(spectrum);
}

/* --- as text ------------------------------------------------------------------------------- */

/* Write the densities at one frequency. */
static void
write_row(struct rows *rows, ss_spectrum *const spectrum[], size_t k, const ss_column column[],
          const size_t index[], size_t n, int decibels)
{
    char unit[DENSITY_UNIT];
    ss_rows_number(rows, "frequency", "Hz", (double)k * spectrum[0]->step);
    for (size_t i = 0; i < n; i++) {
        const ss_column *of = &column[index[i]];
        double density = spectrum[i]->density[k];
        ss_density_unit(unit, of->unit, decibels);
        ss_rows_number(rows, of->name, unit, !decibels ? density : density > 0 ? 10 * log10(density) : NAN);
    }
    ss_rows_end(rows);
}

ss_status
ss_spectrum_write(ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *given, FILE *out,
                  ss_format format, ss_error *err)
{
    static const char *const own_notes[] = { "resolution", "segments", NULL };
    char resolution[SS_NUMBER_MAX];
    struct rows rows;
    ss_plot_opts opts;
    ss_spectrum **spectrum = NULL;
    if (out == NULL || reader == NULL || column == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = ss_reader_header(reader);
    ss_status st = ss_script_take(&opts, given, err);
    if (st == SS_OK && n == 0)
        st = ss_fail(err, SS_EINVAL, "no spectra to write");
    if (st == SS_OK)
        st = find_spectra(&spectrum, reader, column, n, &opts, err);
    if (st == SS_OK)
        st = ss_rows_begin(&rows, out, format, SS_KIND_SPECTRUM, err);
    if (st == SS_OK) {
        ss_rows_notes(&rows, head, own_notes);
        ss_rows_note(&rows, "resolution: %s Hz", ss_number_text(resolution, spectrum[0]->resolution));
        ss_rows_note(&rows, "segments: %zu", spectrum[0]->segments);
        write_row(&rows, spectrum, 0, head->column, column, n, opts.decibels);   /* the names */
        for (size_t k = 0; k < spectrum[0]->n; k++)
            write_row(&rows, spectrum, k, head->column, column, n, opts.decibels);
        st = ss_rows_finish(&rows, err);
    }
    free_spectra(spectrum, n);
    return st;
}

/* --- as a picture -------------------------------------------------------------------------- */

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
ss_plot_spectrum(FILE *out, ss_reader *reader, const size_t column[], size_t n, const ss_plot_opts *given,
                 ss_error *err)
{
    ss_plot_opts own;
    layer layers[LAYERS] = { { .n = 0 } };
    ss_spectrum **found[LAYERS] = { NULL };
    ss_spectrum *const *of[LAYERS] = { NULL };
    if (out == NULL || reader == NULL || column == NULL)
        return SS_FAIL_NULL(err);
    const ss_header *head = ss_reader_header(reader);
    ss_status st = ss_script_take(&own, given, err);
    if (st == SS_OK && n == 0)
        st = ss_fail(err, SS_EINVAL, "no columns to draw");
    if (st == SS_OK)
        st = ss_layers_find(layers, head, column, n, &own, err);
    for (size_t k = 0; st == SS_OK && k <= own.n_over; k++) {
        st = find_spectra(&found[k], k == 0 ? reader : own.over[k - 1], layers[k].column, layers[k].n, &own, err);
        of[k] = found[k];
    }
    if (st == SS_OK)
        st = write_panels(out, head, n, layers, of, &own, err);
    for (size_t k = 0; k < LAYERS; k++)
        free_spectra(found[k], layers[k].n);
    ss_layers_free(layers);
    return st;
}
