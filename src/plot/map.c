/* map.c -- draw a sweep over two parameters: regions of equal count, lines of equal value.
 *
 * A region is drawn as boxes.  The neighbouring grid points of a region in one row make one box, which overlaps
 * the next row by a quarter, so that no seams are visible.  map_lines.c makes the lines. */
#include <stickslip/sweep.h>
#include "plot/map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "io/record.h"

enum { REGIONS_MAX = 10, COLUMNS_MAX = 4 };     /* COLUMNS_MAX: x, y and two over them */

/* Light to dark, in equal steps of lightness, from pale yellow to violet.  Readers with any kind of
 * colour vision see the order, also in print without colour. */
static const char *const shade[REGIONS_MAX] = { "#fbf3d5", "#dcebc8", "#b7dec3", "#93cdc4",
    "#74b9c4", "#5fa3c0", "#558bb7", "#5273a9", "#505b97", "#4b4381" };

/* What is drawn: x, y, and one or two columns over them. */
typedef struct drawn {
    map_grid g;
    map_column column[COLUMNS_MAX];
    size_t n;
    size_t lines;                   /* the column that is drawn as lines; 0: none */
    size_t regions;                 /* the one that is drawn as regions; 0: none */
    double value[REGIONS_MAX];      /* of these, ascending */
    size_t n_values;
    int rest;                       /* is the first AT_REST? */
    int missing;                    /* are there points without a value? */
} drawn;

/* --- what is drawn -------------------------------------------------------------------------- */

/* There are two reasons for no stop in a cycle: the mass never moves, or it never stops. */
#define AT_REST (-1.0)

static int
is_measure(const map_column *column, ss_measure measure)
{
    return strcmp(column->label->name, ss_measure_label(measure)->name) == 0;
}

static int
has(const double *z, size_t points, double value)
{
    size_t k = 0;
    while (k < points && z[k] != value)
        k++;
    return k < points;
}

/* Returns the number of different values, which are stored, or 0 if there are more than REGIONS_MAX. */
static size_t
find_values(double value[REGIONS_MAX], const double *z, size_t points)
{
    size_t n = 0;
    for (size_t k = 0; k < points; k++) {
        if (isnan(z[k]) || has(value, n, z[k]))
            continue;
        if (n == REGIONS_MAX)
            return 0;
        value[n++] = z[k];
    }
    qsort(value, n, sizeof *value, ss_ascending);
    return n;
}

/* Choose the column that is drawn as regions, and the one that is drawn as lines. */
static ss_status
choose_forms(drawn *d, ss_error *err)
{
    size_t points = d->g.x.n * d->g.y.n;
    for (size_t c = 2; c < d->n; c++) {
        double value[REGIONS_MAX];
        size_t n = find_values(value, d->column[c].value, points), *place = n > 0 ? &d->regions : &d->lines;
        if (*place != 0)
            return ss_fail(err, SS_EINVAL, "%s and %s are both drawn as %s: a map has one of each",
                           d->column[*place].label->name, d->column[c].label->name, n > 0 ? "regions" : "lines");
        *place = c;
        if (n == 0)
            continue;
        memcpy(d->value, value, n * sizeof *value);
        d->n_values = n;
        d->rest = is_measure(&d->column[c], SS_STOPS) && value[0] == AT_REST;
    }
    const double *z = d->column[d->regions > 0 ? d->regions : d->lines].value;
    for (size_t k = 0; k < points; k++)
        d->missing |= isnan(z[k]);
    /* Lines do not show where a part of the time is 1 or 0, so these two become regions. */
    int is_share = d->n == 3 && d->lines == 2 && is_measure(&d->column[2], SS_STICK_FRACTION);
    for (double end = 0; is_share && end <= 1; end++)
        if (has(z, points, end)) {
            d->regions = 2;
            d->value[d->n_values++] = end;
        }
    return SS_OK;
}

/* --- data ----------------------------------------------------------------------------------- */

/* The border between the cells of values i - 1 and i; the outermost end at their values. */
static double
border(const map_axis *a, double i)
{
    return ss_map_along(a, fmin(fmax(i - 0.5, 0), (double)(a->n - 1)));
}

/* The boxes of the points at which z has this value, or none if it is NaN. */
static void
write_boxes(FILE *out, const char *name, const map_grid *g, const double *z, double value)
{
    ss_print(out, "%s << EOD\n", name);
    for (size_t j = 0; j < g->y.n; j++, z += g->x.n)
        for (size_t i = 0, end; i < g->x.n; i = end) {
            for (end = i; end < g->x.n && (z[end] == value || (isnan(z[end]) && isnan(value))); end++)
                ;
            if (end == i) {
                end++;
                continue;
            }
            ss_map_write_coordinate(out, &g->x, border(&g->x, (double)i), ' ');
            ss_map_write_coordinate(out, &g->x, border(&g->x, (double)end), ' ');
            ss_map_write_coordinate(out, &g->y, border(&g->y, (double)j), ' ');
            double top = (double)(j + 1) + (j + 1 < g->y.n ? 0.25 : 0);
            ss_map_write_coordinate(out, &g->y, border(&g->y, top), '\n');
        }
    fputs("EOD\n", out);
}

/* Everything that the plot command names. */
static ss_status
write_data(FILE *out, const drawn *d, const ss_plot_opts *opts, ss_error *err)
{
    const map_grid *g = &d->g;
    const double *z = d->column[d->regions > 0 ? d->regions : d->lines].value;
    for (size_t i = 0; i < d->n_values; i++) {
        char name[32];
        snprintf(name, sizeof name, "$region%zu", i);
        write_boxes(out, name, g, z, d->value[i]);
    }
    if (d->missing)
        write_boxes(out, "$missing", g, z, NAN);
    fputs(opts->n_curve > 0 ? "$curve << EOD\n" : "", out);
    for (size_t i = 0; i < opts->n_curve; i++) {
        const double *at = opts->curve + 2 * i;
        int breaks = !isfinite(at[0]) || !isfinite(at[1]);
        if (!breaks)
            ss_map_write_coordinate(out, &g->x, at[0], ' ');
        if (!breaks)
            ss_map_write_coordinate(out, &g->y, at[1], '\n');
        else
            putc('\n', out);
    }
    fputs(opts->n_curve > 0 ? "EOD\n" : "", out);
    return d->lines == 0 ? SS_OK : ss_map_write_lines(out, g, d->column[d->lines].value, err);
}

/* --- the script ---------------------------------------------------------------------------- */

static void
write_plot(FILE *out, const drawn *d, const ss_plot_opts *opts)
{
    static const char boxes[] = "using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb";
    const char *comma = "plot ", *next = ", \\\n     ";
    for (size_t i = 0; i < d->n_values; i++, comma = next) {
        size_t s = d->n_values > 1 ? i * (REGIONS_MAX - 1) / (d->n_values > 5 ? d->n_values - 1 : 5) : 0;
        ss_print(out, "%s$region%zu %s '%s' title ", comma, i, boxes, shade[s]);
        if (d->rest && i == 0)
            fputs("'rest'", out);
        else
            ss_print(out, "'%.6g'", d->value[i]);
    }
    if (d->lines > 0) {
        ss_print(out, "%s$line using 1:2 with lines lw 0.7 lc rgb line_colour notitle", comma);
        comma = next;
    }
    if (d->missing) {
        ss_print(out, "%s$missing %s missing_colour title 'none'", comma, boxes);
        comma = next;
    }
    if (opts->n_curve > 0) {
        ss_print(out, "%s$curve using 1:2 with lines lw 2 lc rgb curve_colour notitle", comma);
        comma = next;
    }
    if (d->lines > 0)
        ss_print(out, "%s$label using 1:2:(sprintf('%%g', $3)) with labels boxed font fine tc rgb "
                "line_colour notitle", comma);
    putc('\n', out);
}

static ss_status
write_map(FILE *out, const drawn *d, const ss_plot_opts *opts, ss_error *err)
{
    map_label label;
    const ss_column *lines = d->lines > 0 ? ss_map_label(&label, d->column[d->lines].label) : NULL;
    ss_status st = ss_script_begin(out, opts, NULL, 7, lines, err);
    if (st != SS_OK)
        return st;
    ss_script_write_x_label(out, ss_map_label(&label, d->column[0].label), d->g.x.scale);
    ss_script_write_side_label(out, 1, ss_map_label(&label, d->column[1].label), d->g.y.scale, INFINITY);
    fputs("line_colour = '#222222'; curve_colour = '" VERMILION "'; missing_colour = '#bbbbbb'\n"
          "fine = sprintf(',%.1f', 0.8*letters)\n", out);
    st = write_data(out, d, opts, err);
    if (st != SS_OK)
        return st;
    ss_script_write_frame(out, 0.14 + 0.025 * fmax(0, ss_map_letters(&d->g.y) - 3),
                          d->n_values > 0 || d->missing ? 0.835 : 0.965);
    ss_print(out, "unset grid; set tmargin at screen %s; set bmargin at screen 0.14\n",
             d->lines > 0 && opts->title[0] != '\0' ? "0.88" : "0.92");
    for (int i = 0; i < 2; i++) {
        const map_axis *a = i == 0 ? &d->g.x : &d->g.y;
        ss_map_write_axis(out, "xy"[i], a);
        if (a->log)
            ss_script_write_decades(out, i == 0 ? "x" : "y", a->value[0], a->value[a->n - 1]);
    }
    fputs("set border lw 0.8 front\n"
          "set style textbox opaque fillcolor '#ffffff' noborder margins 0.4,0.3\n", out);
    if (d->n_values > 0 || d->missing)
        fputs("set key at screen 0.995,graph 1 right top Left reverse samplen 0.6 spacing 1.3 "
              "noenhanced font fine\n", out);
    if (d->n_values > 0) {
        fputs("set key title ", out);
        ss_script_quote(out, d->column[d->regions].label->name, 0);
        fputs(" noenhanced font fine\n", out);
    }
    write_plot(out, d, opts);
    return ss_script_end(out);
}

static ss_status
draw_map(FILE *out, const ss_table *t, const size_t column[], size_t n, const ss_plot_opts *opts, ss_error *err)
{
    drawn d = { .n = n };
    if (n < 3 || n > COLUMNS_MAX)
        return ss_fail(err, SS_EINVAL, "two keys were varied, so X,Y,Z or X,Y,Z,Z are drawn");
    ss_status st = ss_map_read_columns(d.column, n, t, column, err);
    size_t stick = (size_t)ss_table_column(t, ss_measure_label(SS_STICK_FRACTION)->name);
    size_t amplitude = (size_t)ss_table_column(t, ss_measure_label(SS_AMPLITUDE)->name);
    for (size_t c = 2; st == SS_OK && c < n; c++)
        for (size_t i = 0; is_measure(&d.column[c], SS_STOPS) && i < t->n; i++)
            if (d.column[c].value[i] == 0
                && (ss_table_number(t, i, stick) == 1 || ss_table_number(t, i, amplitude) == 0))
                d.column[c].value[i] = AT_REST;
    if (st == SS_OK)
        st = ss_map_make_grid(&d.g, d.column, n, t->n, err);
    if (st == SS_OK)
        st = choose_forms(&d, err);
    const ss_plot_opts own = ss_map_titled(opts, t);
    if (st == SS_OK)
        st = write_map(out, &d, &own, err);
    ss_map_free_columns(d.column, n);
    ss_map_free_grid(&d.g);
    return st;
}

/* Was the same single parameter varied in every part of the table? */
static int
varies_one(const ss_table *t)
{
    const char *vary = ss_table_note(t, "vary");
    int one = vary != NULL;
    for (size_t i = 0; one && i < t->n_notes; i++)
        one = strncmp(t->note[i], "vary: ", 6) != 0 || strcmp(t->note[i] + 6, vary) == 0;
    return one;
}

ss_status
ss_plot_sweep(FILE *out, const ss_table *table, const size_t column[], size_t n, const ss_plot_opts *opts,
              ss_error *err)
{
    ss_plot_opts own;
    if (out == NULL || table == NULL || column == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_script_take(&own, opts, err);
    if (st != SS_OK)
        return st;
    return (varies_one(table) ? ss_plot_diagram : draw_map)(out, table, column, n, &own, err);
}
