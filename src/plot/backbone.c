/* backbone.c -- draw a free decay: amplitude in decibels over time, and below it frequency and damping ratio over
 * the amplitude, which is logarithmic; errors are bars, and the mechanism that is named is dashed. */
#include <stickslip/backbone.h>

#include "plot/script.h"

#include <math.h>
#include "base/error.h"

enum { PANELS = 3 };
static const double heights[PANELS] = { 3.4, 2.6, 2.6 }, gaps[PANELS] = { 1.1, .2, 1 };    /* [cm]; below them */
#define ROOM 9.0                /* for a label [ems] */
#define MARGIN .06              /* above and below what is drawn, of it */

/* Half of what the samples span in each period, or in a column of pixels if that is more, in decibels re the first
 * row; of levels their middle. */
static void
write_decay(FILE *out, const ss_backbone *b, const double *x, size_t n, double rate, double start)
{
    double period = rate / b->row[0].frequency.value, least = (double)n / SCRIPT_COLUMNS;
    int is_level = isnan(b->row[0].frequency.error);
    size_t width = (size_t)ceil(is_level ? fmax(least, 1) : fmax(period, least));
    fputs("$decay << EOD\n", out);
    for (size_t i = 0; i + width <= n; i += width) {
        script_extent e = ss_script_extent(x + i, width);
        double level = is_level ? (e.hi + e.lo) / 2 - 20 * log10(b->row[0].amplitude)
            : 20 * log10((e.hi - e.lo) / 2 / b->row[0].amplitude);
        if (isfinite(level))
            ss_print(out, "%.9g %.5g\n", start + ((double)i + ((double)width - 1) / 2) / rate, level);
    }
    fputs("EOD\n", out);
}

/* $rows: t, half the block, level, amplitude, frequency, its error, damping ratio, its error, and by the
 * mechanism. */
static void
write_rows(FILE *out, const ss_backbone *b, double start)
{
    fputs("$rows << EOD\n", out);
    for (size_t i = 0; i < b->n; i++) {
        const ss_backbone_row *r = &b->row[i];
        ss_print(out, "%.9g %.5g %.5g %.6g %.12g %.3g %.6g %.3g %.12g %.6g\n", start + r->t,
                 r->periods / r->frequency.value / 2, 20 * log10(r->amplitude / b->row[0].amplitude), r->amplitude,
                 r->frequency.value, isnan(r->frequency.error) ? 0 : r->frequency.error, r->damping_ratio.value,
                 r->damping_ratio.error, r->named[0], r->named[1]);
    }
    fputs("EOD\n", out);
}

static script_extent
extent_of(const ss_backbone *b, int damping)
{
    script_extent e = SCRIPT_NO_EXTENT;
    for (size_t i = 0; i < b->n; i++) {
        ss_value v = damping ? b->row[i].damping_ratio : b->row[i].frequency;
        double error = isnan(v.error) ? 0 : fmin(v.error, fabs(v.value));
        ss_script_include(&e, v.value - error);
        ss_script_include(&e, v.value + error);
    }
    return e;
}

ss_status
ss_plot_backbone(FILE *out, const ss_backbone *b, const ss_signal *signal, size_t column, const ss_plot_opts *opts,
                 ss_error *err)
{
    static const ss_column names[PANELS] = {
        { "amplitude", "dB" }, { "frequency", "Hz" }, { "damping ratio", "" } };
    ss_plot_opts own;
    script_stack stack;
    if (out == NULL || b == NULL || signal == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK && column >= signal->head->n_columns)
        st = ss_fail_column(err, column, signal->head->n_columns);
    if (st == SS_OK && b->n == 0)
        st = ss_fail(err, SS_EINVAL, "nothing to draw: %s", b->why);
    const int is_level = b->n > 0 && isnan(b->row[0].frequency.error);
    if (st == SS_OK)
        st = ss_script_begin_stack(&stack, out, &own, signal->head, heights[0] + heights[2] + gaps[0] + gaps[2]
                                   + (is_level ? 0 : heights[1] + gaps[1]), err);
    if (st != SS_OK)
        return st;
    const ss_column *of = &signal->head->column[column];
    write_decay(out, b, signal->values + column * signal->n, signal->n, signal->head->rate, signal->head->start);
    write_rows(out, b, signal->head->start);
    fputs("colour = '" BLUE "'; law = '" VERMILION "'\n", out);
    ss_script_write_frame(out, 0.175, 0.965);
    for (int i = 0; i < PANELS; i += is_level ? 2 : 1) {        /* of a level the frequency is not measured */
        script_axis y = { &names[i], SCRIPT_NO_EXTENT, ss_script_power(0) };
        if (i > 0)
            y = ss_script_axis(&names[i], extent_of(b, i == 2));
        ss_script_write_panel(&stack, heights[i], gaps[i], &y, ROOM, i > 0 ? 5 : 0);
        if (i == 0) {
            ss_script_write_x_label(out, &(ss_column){ "time", "s" }, ss_script_power(0));
            ss_print(out, "set xrange [%.9g:%.9g]\n", signal->head->start,
                     signal->head->start + (double)signal->n / signal->head->rate);
            fputs("plot $decay using 1:2 with lines lw 0.7 lc rgb '" ZERO_COLOUR "', "
                  "$rows using 1:3:2 with xerrorbars pt 7 ps 0.3*mark lw 1 lc rgb colour\n", out);
            continue;
        }
        if (i + 1 == PANELS)
            ss_script_write_x_label(out, &(ss_column){ "amplitude", is_level ? "" : of->unit },
                                    ss_script_power(0));
        else
            fputs("unset xlabel\n", out);
        ss_print(out, "set logscale x; set xtics format '%s'\nset xrange [%.6g:%.6g]\n",
                 i + 1 < PANELS ? "" : "%g", b->row[b->n - 1].amplitude / 1.1, b->row[0].amplitude * 1.1);
        ss_script_write_decades(out, "x", i + 1 < PANELS ? 1 : b->row[b->n - 1].amplitude, b->row[0].amplitude);
        script_extent drawn = ss_script_scaled_extent(y.extent, y.scale);
        double rim = drawn.hi > drawn.lo ? MARGIN * (drawn.hi - drawn.lo) : 1;
        ss_print(out, "set yrange [%.9g:%.9g]\n", drawn.lo - rim, drawn.hi + rim);
        ss_print(out, "unit = %.9g; offset = %.17g\n", y.scale.unit, y.scale.offset);
        ss_print(out, "plot $rows using 4:(($%d - offset)/unit):($%d/unit) with yerrorbars pt 7 ps 0.3*mark "
                 "lw 0.8 lc rgb colour, $rows using 4:(($%d - offset)/unit) with lines lw 1.2 dt 2 lc rgb law\n",
                 3 + 2 * i, 4 + 2 * i, 8 + i);
    }
    return ss_script_end(out);
}
