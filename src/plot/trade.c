/* trade.c -- error over CPU time, both logarithmic: of methods, a line each, or of simpler scenes, a colour
 * each.  An error of 0 is left out. */
#include "plot/script.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"

/* Point types and dashes distinguish what shares a colour. */
static const char *const colour[] = { BLACK, BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE };
static const int point[] = { 7, 5, 9, 13, 4 };
enum { COLOURS = sizeof colour / sizeof *colour, POINTS = sizeof point / sizeof *point };

/* What is drawn. */
typedef struct scatter {
    FILE *out;
    const ss_plot_opts *opts;
    double unit;                /* [s] of time */
    script_extent time, error;  /* over the unit; > 0 */
} scatter;

/* Let the picture have room for a point.  SS_EINVAL: it cannot be drawn. */
static ss_status
include(scatter *s, size_t row, double seconds, double error, ss_error *err)
{
    if (!(seconds >= 1e-12 && seconds <= 1e12 && fabs(error) <= 1e300))
        return ss_fail(err, SS_EINVAL, "row %zu cannot be drawn: an error of %.3g in %.3g s", row + 1, error,
                       seconds);
    ss_script_include(&s->time, seconds / s->unit);
    if (error > 0)
        ss_script_include(&s->error, error);
    return SS_OK;
}

static ss_status
begin(const scatter *s, ss_error *err)
{
    ss_status st = ss_script_begin(s->out, s->opts, NULL, 9, NULL, err);
    if (st == SS_OK)
        ss_print(s->out, "unit = %.3g        # s of CPU time\n$error << EOD\n", s->unit);
    return st;
}

/* The axes, behind the points, and a key with columns of so many entries. */
static void
write_axes(const scatter *s, const char *error, const char *of, int rows)
{
    fputs("EOD\n", s->out);
    ss_script_write_frame(s->out, 0.19, 0.94);
    ss_print(s->out, "set bmargin at screen 0.38; set tmargin at screen 0.93\n"
             "set logscale xy; set format x '%%g'; set grid ytics\n"
             "set xlabel 'CPU time / '.sprintf('%%.2g ms%s', 1000*unit).", of[0] != '\0' ? ", that of " : "");
    ss_script_quote(s->out, of, 0);
    ss_print(s->out, " noenhanced offset 0,0.3\nset ylabel '%s' noenhanced offset 0.5,0\n"
             "set key at screen 0.54,screen 0.265 center top vertical maxrows %d samplen 2 noenhanced\n",
             error, rows);
    ss_script_write_decade_range(s->out, fmin(s->error.lo, 1), s->error.hi > 0 ? s->error.hi : 1);
}

ss_status
ss_plot_trade(FILE *out, const ss_trade *trade, const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    scatter s = { out, &own, INFINITY, SCRIPT_NO_EXTENT, SCRIPT_NO_EXTENT };
    if (out == NULL || trade == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    for (size_t i = 0; st == SS_OK && i < trade->n; i++)
        if (trade->row[i].status == SS_OK)
            s.unit = fmin(s.unit, trade->row[i].seconds);
    if (st == SS_OK && isinf(s.unit))
        return ss_fail(err, SS_EINVAL, "nothing to draw: no row was measured");
    for (size_t i = 0; st == SS_OK && i < trade->n; i++)
        if (trade->row[i].status == SS_OK)
            st = include(&s, i, trade->row[i].seconds, trade->row[i].error_x, err);
    if (st == SS_OK)
        st = begin(&s, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 0, line = 0; i < trade->n; i++) {
        const ss_trade_row *row = &trade->row[i];
        line += i > 0 && strcmp(row->method, row[-1].method) != 0;
        if (row->status == SS_OK && row->error_x > 0)
            ss_print(out, "%.4g %.3g %zu %d\n", row->seconds / s.unit, row->error_x, line, row->frontier);
    }
    write_axes(&s, trade->transform ? "worst error of W / largest |W| of its scale"
               : "worst error of x / max|x|", "", 7);
    fputs("plot $error using ($4 == 1 ? $1 : NaN):2 with points pt 6 ps 1.6 lc rgb '" BLACK
          "' title 'frontier'", out);
    for (size_t i = 0, line = 0; i < trade->n; i++) {
        const ss_trade_row *row = &trade->row[i];
        int is_first = i == 0 || strcmp(row->method, row[-1].method) != 0;
        line += i > 0 && is_first;
        if (!is_first || row->status != SS_OK)
            continue;
        ss_print(out, ", \\\n     $error using ($3 == %zu ? $1 : NaN):2 with linespoints lw 1 dt %d pt %d ps 0.7 "
                 "lc rgb '%s' title ", line, line < COLOURS ? 1 : 2, point[line % POINTS], colour[line % COLOURS]);
        ss_script_quote(out, row->method, 0);
    }
    putc('\n', out);
    return ss_script_end(out);
}

/* The errors that are drawn, of which each has its point. */
enum { X, V, A, F, CONTOURS, KINDS };
static const char *const kind[KINDS] = { "x", "v", "a", "f", "contours (rms)" };

/* The rms error of the contours, in decibels, is drawn as a ratio less 1, as it would be of an amplitude. */
static double
error_of(const ss_models_row *row, size_t k)
{
    return k < CONTOURS ? row->error[2 * k] : pow(10, row->error[2 * k + 1] / 20) - 1;
}

ss_status
ss_plot_models(FILE *out, const ss_models *models, const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts own;
    if (out == NULL || models == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK && models->n < 2)
        return ss_fail(err, SS_EINVAL, "nothing to draw: no simpler scene");
    scatter s = { out, &own, st == SS_OK ? models->row[0].seconds : 1, { 1, 1 }, SCRIPT_NO_EXTENT };
    if (st == SS_OK)
        st = include(&s, 0, models->row[0].seconds, 0, err);
    for (size_t i = 1; st == SS_OK && i < models->n; i++)
        for (size_t k = 0; st == SS_OK && k < KINDS && models->row[i].status == SS_OK; k++)
            if (isfinite(error_of(&models->row[i], k)))
                st = include(&s, i, models->row[i].seconds, error_of(&models->row[i], k), err);
    if (st == SS_OK)
        st = begin(&s, err);
    if (st != SS_OK)
        return st;
    for (size_t i = 1; i < models->n; i++)
        for (size_t k = 0; k < KINDS && models->row[i].status == SS_OK; k++)
            if (error_of(&models->row[i], k) > 0)
                ss_print(out, "%.4g %.3g %zu %zu\n", models->row[i].seconds / s.unit,
                         error_of(&models->row[i], k), i, k);
    write_axes(&s, "largest or rms error / max", models->row[0].name, KINDS);
    ss_print(out, "set xrange [%.3g:%.3g]\n%s", s.time.lo / 1.6, s.time.hi * 1.6,
             s.time.hi / s.time.lo > 30 ? "" : "set xtics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20)\n");
    fputs("set arrow 1 from 1,graph 0 to 1,graph 1 nohead lc rgb '#888888' dt 2\nplot ", out);
    for (size_t k = 0; k < KINDS; k++)
        ss_print(out, "%sNaN with points pt %d lc rgb '" BLACK "' title '%s'", k > 0 ? ", " : "",
                 point[k], kind[k]);
    for (size_t i = 1; i < models->n; i++) {
        const char *rgb = colour[1 + (i - 1) % (COLOURS - 1)];
        if (models->row[i].status != SS_OK)
            continue;
        ss_print(out, ", \\\n     NaN with points pt 5 lc rgb '%s' title ", rgb);
        ss_script_quote(out, models->row[i].name, 0);
        for (size_t k = 0; k < KINDS; k++)
            ss_print(out, ", \\\n     $error using ($3 == %zu && $4 == %zu ? $1 : NaN):2 with points pt %d ps 1.2 "
                     "lc rgb '%s' notitle", i, k, point[k], rgb);
    }
    putc('\n', out);
    return ss_script_end(out);
}
