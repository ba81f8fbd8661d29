/* trade.c -- the work-precision diagram: error over CPU time, one line a method. */
#include "plot/script.h"
#include "plot/style.h"

#include <math.h>
#include <string.h>
#include "base/error.h"

/* Okabe and Ito's colours, which differ for all kinds of colour vision; point types and dashes
 * distinguish methods that share a colour. */
static const char *const colour[] = { BLACK, BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE };
static const int point[] = { 7, 5, 9, 13, 4 };
enum { COLOURS = sizeof colour / sizeof *colour, POINTS = sizeof point / sizeof *point };

static void
write_point(FILE *out, const ss_trade_row *row, double fastest)
{
    ss_print(out, "%.4g %.3g\n", row->seconds / fastest, row->error_x);
}

/* The points of one method as datablock number k, from row i on.  Returns the row after them. */
static size_t
write_method(FILE *out, const ss_trade *trade, size_t i, size_t k, double fastest)
{
    const char *method = trade->row[i].method;
    ss_print(out, "$method%zu << EOD\n", k);
    for (; i < trade->n && strcmp(trade->row[i].method, method) == 0; i++)
        if (trade->row[i].status == SS_OK)
            write_point(out, &trade->row[i], fastest);
    fputs("EOD\n", out);
    return i;
}

static size_t
next_method(const ss_trade *trade, size_t i)
{
    const char *method = trade->row[i].method;
    while (i < trade->n && strcmp(trade->row[i].method, method) == 0)
        i++;
    return i;
}

static void
write_plot(FILE *out, const ss_trade *trade)
{
    fputs("plot $frontier using 1:2 with points pt 6 ps 1.6 lc rgb '" BLACK "' title 'frontier'", out);
    for (size_t i = 0, method = 0; i < trade->n; i = next_method(trade, i), method++)
        if (trade->row[i].status == SS_OK) {
            ss_print(out, ", \\\n     $method%zu using 1:2 with linespoints lw 1 dt %d pt %d ps 0.7 "
                    "lc rgb '%s' title ", method, method < COLOURS ? 1 : 2, point[method % POINTS],
                    colour[method % COLOURS]);
            ss_script_quote(out, trade->row[i].method);
        }
    putc('\n', out);
}

ss_status
ss_plot_trade(FILE *out, const ss_trade *trade, const ss_plot_opts *opts, ss_error *err)
{
    if (out == NULL || trade == NULL)
        return SS_FAIL_NULL(err);
    ss_plot_opts own;
    ss_status st = ss_script_take(&own, opts, err);
    if (st != SS_OK)
        return st;
    opts = &own;
    double fastest = INFINITY, least = INFINITY, most = 0;
    for (size_t i = 0; i < trade->n; i++) {
        const ss_trade_row *row = &trade->row[i];
        if (row->status != SS_OK)
            continue;
        if (!(row->seconds >= 1e-12 && row->seconds <= 1e12 && fabs(row->error_x) <= 1e300))
            return ss_fail(err, SS_EINVAL, "row %zu cannot be drawn: an error of %.3g in %.3g s", i + 1,
                           row->error_x, row->seconds);
        fastest = fmin(fastest, row->seconds);
        least = row->error_x > 0 ? fmin(least, row->error_x) : least;
        most = fmax(most, row->error_x);
    }
    if (isinf(fastest))
        return ss_fail(err, SS_EINVAL, "nothing to draw: no row was measured");
    st = ss_script_begin(out, opts, 9, err);
    if (st != SS_OK)
        return st;
    ss_script_write_title(out, opts, NULL, NULL);
    ss_print(out, "fastest = %.3g        # s of CPU time\n", fastest);
    for (size_t i = 0, k = 0; i < trade->n; k++)
        i = trade->row[i].status == SS_OK ? write_method(out, trade, i, k, fastest)
            : next_method(trade, i);
    fputs("$frontier << EOD\n", out);
    for (size_t i = 0; i < trade->n; i++)
        if (trade->row[i].frontier)
            write_point(out, &trade->row[i], fastest);
    fputs("EOD\n"
          "set lmargin at screen 0.19; set rmargin at screen 0.94\n"
          "set logscale xy; set format x '%g'\n"
          "set xlabel 'CPU time / '.sprintf('%.2g ms', 1000*fastest) noenhanced offset 0,0.3\n"
          "set bmargin at screen 0.38; set tmargin at screen 0.93\n"
          "set xtics nomirror scale 0.6; set ytics nomirror scale 0.6; set border lw 0.8\n"
          "set grid xtics ytics lc rgb '" GRID_COLOUR "' lt 1\n"
          "set key at screen 0.54,screen 0.265 center top horizontal maxcols 3 samplen 2 "
          "noenhanced\n", out);
    ss_script_write_decade_range(out, least, most);
    ss_print(out, "set ylabel 'worst error of %s' noenhanced offset 0.5,0\n",
            trade->transform ? "W / largest |W| of its scale" : "x / max|x|");
    write_plot(out, trade);
    return ss_script_end(out);
}
