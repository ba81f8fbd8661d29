/* models.c -- draw the errors of simpler scenes over their times: each scene has a colour, each
 * quantity a kind of point.  An error of 0 is left out, as the axis is logarithmic. */
#include "plot/script.h"
#include "plot/style.h"

#include <math.h>
#include <string.h>
#include "base/error.h"

/* Okabe and Ito's colours, which differ for all kinds of colour vision. */
static const char *const colour[] = { BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY_BLUE };
enum { COLOURS = sizeof colour / sizeof *colour };

/* The errors drawn in the upper panel, of which each has its point; and in the lower one. */
static const struct { const char *name; int point; } drawn[] = {
    { "x", 7 }, { "v", 5 }, { "a", 9 }, { "f", 13 }, { "map", 7 }, { "map_rms", 6 },
};
enum { UPPER = 4, DRAWN = sizeof drawn / sizeof *drawn };

static double
error_of(const ss_models_row *row, size_t k)
{
    for (size_t i = 0; row->status == SS_OK && ss_compared_name(i) != NULL; i++)
        if (strcmp(ss_compared_name(i), drawn[k].name) == 0)
            return row->error[i] > 0 && row->error[i] < 1e300 ? row->error[i] : NAN;
    return NAN;
}

/* $error: time, error, which error, and which scene. */
static void
write_points(FILE *out, const ss_models *models, double unit)
{
    fputs("$error << EOD\n", out);
    for (size_t i = 1; i < models->n; i++)
        for (size_t k = 0; k < DRAWN; k++)
            if (!isnan(error_of(&models->row[i], k)))
                ss_print(out, "%.4g %.3g %zu %zu\n", models->row[i].seconds / unit,
                        error_of(&models->row[i], k), k, i);
    fputs("EOD\n", out);
}

/* The decades that the errors of the upper panel span. */
static void
write_decades(FILE *out, const ss_models *models)
{
    double lo = 1, hi = 1;
    for (size_t i = 1; i < models->n; i++)
        for (size_t k = 0; k < UPPER; k++) {
            lo = fmin(lo, error_of(&models->row[i], k));
            hi = fmax(hi, error_of(&models->row[i], k));
        }
    ss_print(out, "set yrange [%.3g:%.3g]\n", pow(10, floor(log10(lo / 1.1))),
            pow(10, ceil(log10(hi * 1.1))));
}

static void
write_scenes(FILE *out, const ss_models *models, size_t from, size_t to)
{
    const char *comma = "plot ";
    for (size_t i = 1; i < models->n; i++)
        for (size_t k = from; k < to; k++, comma = ", \\\n     ")
            ss_print(out, "%s$error using 1:($3 == %zu && $4 == %zu ? $2 : NaN) with points pt %d ps 1.2 "
                    "lc rgb '%s'", comma, k, i, drawn[k].point, colour[(i - 1) % COLOURS]);
    putc('\n', out);
}

/* Scenes in the key. */
static size_t
count_scenes(const ss_models *models)
{
    size_t n = 0;
    for (size_t i = 1; i < models->n; i++)
        n += models->row[i].status == SS_OK;
    return n;
}

/* An entry of the key, in one of six columns; row 0 is the lowest. */
static void
write_entry(FILE *out, const char *name, size_t row, size_t column, int point, const char *rgb)
{
    fputs("set label ", out);
    ss_script_quote(out, name);
    ss_print(out, " at screen %.3f,row*%zu + 0.035 left noenhanced offset 0.8,-0.15 point pt %d ps 1.2 "
            "lc rgb '%s'\n", 0.165 + 0.118 * (double)column, row, point, rgb);
}

static void
write_key(FILE *out, const ss_models *models)
{
    size_t rows = (count_scenes(models) + 1) / 2;
    for (size_t k = 0; k < DRAWN; k++)
        write_entry(out, drawn[k].name, rows, k, drawn[k].point, BLACK);
    for (size_t i = 1, n = 0; i < models->n; i++)
        if (models->row[i].status == SS_OK) {
            write_entry(out, models->row[i].name, rows - 1 - n / 2, 3 * (n % 2), 5,
                        colour[(i - 1) % COLOURS]);
            n++;
        }
}

static void
write_upper(FILE *out, const ss_models *models)
{
    ss_print(out, "row = 0.045; bottom = row*%zu + 0.175; between = bottom + 0.18\n",
            (count_scenes(models) + 1) / 2);
    fputs("set lmargin at screen 0.16; set rmargin at screen 0.95\n"
          "set tmargin at screen 0.94; set bmargin at screen between + 0.03\n"
          "set logscale y; set format y '%g'; set format x ''\n"
          "set label 1 'largest error / max' at screen 0.04,graph 0.5 center rotate noenhanced\n", out);
    write_decades(out, models);
    write_scenes(out, models, 0, UPPER);
}

static void
write_lower(FILE *out, const ss_models *models)
{
    fputs("unset title; unset logscale y; set yrange [0:85]; set ytics 0,20\n"
          "set tmargin at screen between; set bmargin at screen bottom; set format x '%g'\n"
          "set label 1 'map / dB'\n"
          "set xlabel 'CPU time / '.sprintf('%.2g ms, that of ', 1000*scene).", out);
    ss_script_quote(out, models->row[0].name);
    fputs(" noenhanced offset 0,0.3\n", out);
    write_key(out, models);
    write_scenes(out, models, UPPER, DRAWN);
}

/* The least and the largest time of the scenes that were run, as multiples of the first one's. */
static ss_status
find_times(double *least, double *most, const ss_models *models, ss_error *err)
{
    *least = *most = 1;
    for (size_t i = 0; i < models->n; i++) {
        double ratio = models->row[i].seconds / models->row[0].seconds;
        if (models->row[i].status != SS_OK)
            continue;
        if (!(ratio >= 1e-12 && ratio <= 1e12))
            return ss_fail(err, SS_EINVAL, "row %zu cannot be drawn: a time of %.3g s", i + 1,
                           models->row[i].seconds);
        *least = fmin(*least, ratio);
        *most = fmax(*most, ratio);
    }
    return SS_OK;
}

ss_status
ss_plot_models(FILE *out, const ss_models *models, const ss_plot_opts *opts, ss_error *err)
{
    double least, most;
    if (out == NULL || models == NULL)
        return SS_FAIL_NULL(err);
    ss_plot_opts own;
    ss_status st = ss_script_take(&own, opts, err);
    if (st != SS_OK)
        return st;
    opts = &own;
    if (models->n < 2)
        return ss_fail(err, SS_EINVAL, "nothing to draw: no simpler scene");
    st = find_times(&least, &most, models, err);
    if (st == SS_OK)
        st = ss_script_begin(out, opts, 9, err);
    if (st != SS_OK)
        return st;
    ss_script_write_title(out, opts, NULL, NULL);
    ss_print(out, "scene = %.3g        # s of CPU time\n", models->row[0].seconds);
    write_points(out, models, models->row[0].seconds);
    ss_print(out, "set multiplot\nset logscale x; set xrange [%.3g:%.3g]\n", least / 1.6, most * 1.6);
    ss_print(out, "set xtics nomirror scale 0.6%s; set ytics nomirror scale 0.6; set border lw 0.8; unset key\n",
            most / least > 30 ? "" : " (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20)");
    fputs("set grid xtics ytics lc rgb '" GRID_COLOUR "' lt 1\n"
          "set arrow 1 from 1,graph 0 to 1,graph 1 nohead lc rgb '#888888' dt 2\n", out);
    write_upper(out, models);
    write_lower(out, models);
    fputs("unset multiplot\n", out);
    return ss_script_end(out);
}
