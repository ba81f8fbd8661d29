/* map.c -- draw a sweep over two parameters: regions of equal count, lines of equal value.
 *
 * A region is drawn as boxes.  The neighbouring grid points of a region in one row make one box,
 * which overlaps the next row by a quarter, so that no seams are visible.  map_lines.c makes the
 * lines. */
#include <stickslip/sweep.h>
#include "plot/map.h"
#include "plot/script.h"
#include "plot/style.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/sort.h"

enum { REGIONS_MAX = 10, COLUMNS_MAX = 4 };     /* COLUMNS_MAX: x, y and two over them */

/* Light to dark, in equal steps of lightness, from pale yellow to violet.  Readers with any kind of
 * colour vision see the order, also in print without colour. */
static const char *const shade[REGIONS_MAX] = { "#fbf3d5", "#dcebc8", "#b7dec3", "#93cdc4",
    "#74b9c4", "#5fa3c0", "#558bb7", "#5273a9", "#505b97", "#4b4381" };

/* The columns of the table that are drawn: x, y, and one or two over them. */
typedef struct drawn {
    const ss_table *table;
    map_column column[COLUMNS_MAX];
    size_t n;
} drawn;

static ss_status
read_columns(drawn *d, const size_t column[], size_t n, ss_error *err)
{
    ss_status st = SS_OK;
    if (n < 3 || n > COLUMNS_MAX)
        return ss_fail(err, SS_EINVAL, "a map shows one column or two");
    for (size_t i = 0; st == SS_OK && i < n; i++)
        st = ss_map_read_column(&d->column[d->n++], d->table, column[i], err);
    return st;
}

/* The border between the cells of values i - 1 and i; the outermost end at their values. */
static double
border(const map_axis *a, double i)
{
    return ss_map_along(a, fmin(fmax(i - 0.5, 0), (double)(a->n - 1)));
}

/* --- regions ------------------------------------------------------------------------------- */

typedef struct regions {
    size_t column;                  /* of those drawn; 0: there are none */
    double value[REGIONS_MAX];      /* ascending */
    int rest;                       /* the first is AT_REST */
    size_t n;
    int missing;                    /* there are points without one */
} regions;

/* Returns 1 if the column has at most REGIONS_MAX different values, and stores them. */
static int
find_regions(regions *r, const map_grid *g, const double *column)
{
    *r = (regions){ .n = 0 };
    for (size_t k = 0; k < g->x.n * g->y.n; k++) {
        double z = ss_map_value(g, column, k % g->x.n, k / g->x.n);
        size_t i = 0;
        r->missing |= isnan(z);
        while (i < r->n && r->value[i] != z)
            i++;
        if (isnan(z) || i < r->n)
            continue;
        if (r->n == REGIONS_MAX)
            return 0;
        r->value[r->n++] = z;
    }
    qsort(r->value, r->n, sizeof *r->value, ss_ascending);
    return r->n > 0;
}

/* There are two reasons for no stop in a cycle: the mass never moves, or it never stops. */
#define AT_REST (-1.0)

static void
mark_rest(const drawn *d, size_t c)
{
    const ss_table *t = d->table;
    size_t stick = (size_t)ss_table_column(t, ss_measure_label(SS_STICK_FRACTION)->name);
    size_t amplitude = (size_t)ss_table_column(t, ss_measure_label(SS_AMPLITUDE)->name);
    for (size_t i = 0; i < t->n; i++)
        if (d->column[c].value[i] == 0
            && (ss_table_number(t, i, stick) == 1 || ss_table_number(t, i, amplitude) == 0))
            d->column[c].value[i] = AT_REST;
}

/* Lines do not show where a part of the time is 1 or 0, so these two become regions. */
static void
find_ends(regions *r, const map_grid *g, const map_column *column, size_t c)
{
    for (int end = 0; end <= 1; end++) {
        size_t n = g->x.n * g->y.n, k = 0;
        while (k < n && ss_map_value(g, column->value, k % g->x.n, k / g->x.n) != end)
            k++;
        if (k == n)
            continue;
        r->column = c;
        r->value[r->n++] = end;
    }
}

static int
same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The boxes of the points at which the column has this value, NaN where it has none. */
static void
write_boxes(FILE *out, const map_grid *g, const double *column, double value)
{
    for (size_t j = 0; j < g->y.n; j++)
        for (size_t i = 0, end; i < g->x.n; i = end) {
            for (end = i; end < g->x.n && same(ss_map_value(g, column, end, j), value); end++)
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
}

static void
write_regions(FILE *out, const map_grid *g, const double *column, const regions *r)
{
    for (size_t i = 0; i < r->n; i++) {
        ss_print(out, "$region%zu << EOD\n", i);
        write_boxes(out, g, column, r->value[i]);
        fputs("EOD\n", out);
    }
}

/* --- the script ---------------------------------------------------------------------------- */

static void
write_curve(FILE *out, const ss_plot_opts *map, const map_grid *g)
{
    fputs("$curve << EOD\n", out);
    for (size_t i = 0; i < map->n_curve; i++)
        if (isfinite(map->curve[2 * i]) && isfinite(map->curve[2 * i + 1])) {
            ss_map_write_coordinate(out, &g->x, map->curve[2 * i], ' ');
            ss_map_write_coordinate(out, &g->y, map->curve[2 * i + 1], '\n');
        } else {
            putc('\n', out);
        }
    fputs("EOD\n", out);
}

static script_extent
drawn_range(const map_axis *a)
{
    return (script_extent){ ss_script_scaled(a->value[0], a->scale), ss_script_scaled(a->value[a->n - 1], a->scale) };
}

/* gnuplot leaves out a tic at the very end of a logarithmic axis where rounding puts it beyond. */
static void
write_axis(FILE *out, const char *name, const map_axis *a)
{
    double lo = a->value[0], hi = a->value[a->n - 1];
    if (a->log) {
        ss_print(out, "set %srange [%.9g:%.9g]; set logscale %s\n", name, lo * (1 - 1e-8), hi * (1 + 1e-8), name);
        ss_script_write_decades(out, name, lo, hi);
        return;
    }
    ss_print(out, "set %srange [", name);
    ss_map_write_coordinate(out, a, lo, ':');
    ss_map_write_coordinate(out, a, hi, ']');
    putc('\n', out);
    if (name[0] == 'x')
        ss_map_write_x_tics(out, drawn_range(a));
}

static void
write_plot(FILE *out, const ss_plot_opts *map, const regions *r, int has_lines)
{
    const char *comma = "plot ";
    for (size_t i = 0; i < r->n; i++, comma = ", \\\n     ") {
        size_t s = r->n > 1 ? i * (REGIONS_MAX - 1) / (r->n > 5 ? r->n - 1 : 5) : 0;
        ss_print(out, "%s$region%zu using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder "
                "lc rgb '%s' title ", comma, i, shade[s]);
        if (r->rest && i == 0)
            fputs("'rest'", out);
        else
            ss_print(out, "'%.6g'", r->value[i]);
    }
    if (has_lines) {
        ss_print(out, "%s$line using 1:2 with lines lw 0.7 lc rgb line_colour notitle", comma);
        comma = ", \\\n     ";
    }
    if (r->missing) {
        ss_print(out, "%s$missing using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb "
                "missing_colour title 'none'", comma);
        comma = ", \\\n     ";
    }
    if (map->n_curve > 0) {
        ss_print(out, "%s$curve using 1:2 with lines lw 2 lc rgb curve_colour notitle", comma);
        comma = ", \\\n     ";
    }
    if (has_lines)
        ss_print(out, "%s$label using 1:2:(sprintf('%%g', $3)) with labels boxed font fine tc rgb "
                "line_colour notitle", comma);
    putc('\n', out);
}

/* Everything that the plot command names. */
static ss_status
write_data(FILE *out, const drawn *d, const map_grid *g, const regions *r, size_t line,
           const ss_plot_opts *map, ss_error *err)
{
    if (r->n > 0)
        write_regions(out, g, d->column[r->column].value, r);
    if (r->missing) {
        fputs("$missing << EOD\n", out);
        write_boxes(out, g, d->column[r->n > 0 ? r->column : line].value, NAN);
        fputs("EOD\n", out);
    }
    if (map->n_curve > 0)
        write_curve(out, map, g);
    return line == 0 ? SS_OK : ss_map_write_lines(out, g, d->column[line].value, err);
}

static void
write_key(FILE *out, const drawn *d, const regions *r)
{
    if (r->n == 0 && !r->missing) {
        fputs("unset key\n", out);
        return;
    }
    fputs("set key at screen 0.995,graph 1 right top Left reverse samplen 0.6 spacing 1.3 "
          "noenhanced font fine\n", out);
    if (r->n == 0)
        return;
    fputs("set key title ", out);
    ss_script_quote(out, d->column[r->column].label->name);
    fputs(" noenhanced font fine\n", out);
}

/* line: the column drawn as lines, 0 for none. */
static ss_status
write_map(FILE *out, const drawn *d, const map_grid *g, const regions *r, size_t line,
          const ss_plot_opts *opts, ss_error *err)
{
    const ss_plot_opts titled = ss_map_titled(opts, d->table);
    script_label x_label = ss_map_label(d->column[0].label, g->x.scale, INFINITY);
    script_label y_label = ss_map_label(d->column[1].label, g->y.scale, INFINITY);
    script_label line_label = ss_map_label(d->column[line].label, ss_script_power(0), INFINITY);
    ss_status st = ss_script_begin(out, &titled, 7, err);
    if (st != SS_OK)
        return st;
    ss_script_write_title(out, &titled, NULL, line > 0 ? &line_label : NULL);
    ss_script_write_x_label(out, &x_label, "0,0.4");
    ss_script_write_side_label(out, 1, &y_label);
    fputs("line_colour = '#222222'; curve_colour = '" VERMILION "'; missing_colour = '#bbbbbb'\n"
          "fine = sprintf(',%.1f', 0.8*letters)\n", out);
    st = write_data(out, d, g, r, line, opts, err);
    if (st != SS_OK)
        return st;
    ss_print(out, "set lmargin at screen %g; set tmargin at screen %s; "
            "set bmargin at screen 0.14\n", 0.14 + 0.025 * fmax(0, ss_map_letters(drawn_range(&g->y), g->y.log) - 3),
            line > 0 && titled.title[0] != '\0' ? "0.88" : "0.92");
    ss_print(out, "set rmargin at screen %s\n", r->n > 0 || r->missing ? "0.835" : "0.965");
    write_axis(out, "x", &g->x);
    write_axis(out, "y", &g->y);
    fputs("set tics nomirror out scale 0.6; set border lw 0.8 front\n"
          "set style textbox opaque fillcolor '#ffffff' noborder margins 0.4,0.3\n", out);
    write_key(out, d, r);
    write_plot(out, opts, r, line > 0);
    return ss_script_end(out);
}

/* Choose the column that is drawn as regions, and the one that is drawn as lines. */
static ss_status
choose_forms(regions *r, size_t *line, const drawn *d, const map_grid *g, ss_error *err)
{
    for (size_t c = 2; c < d->n; c++) {
        regions found;
        int is_stops = strcmp(d->column[c].label->name, ss_measure_label(SS_STOPS)->name) == 0;
        if (is_stops)
            mark_rest(d, c);
        int few = find_regions(&found, g, d->column[c].value);
        size_t *place = few ? &r->column : line;
        if (*place != 0)
            return ss_fail(err, SS_EINVAL, "%s and %s are both drawn as %s: a map has one of each",
                           d->column[*place].label->name, d->column[c].label->name, few ? "regions" : "lines");
        found.rest = is_stops && found.value[0] == AT_REST;
        if (few)
            *r = found;
        else if (c == 2)
            r->missing = found.missing;
        *place = c;
    }
    if (r->n == 0 && *line > 0
        && strcmp(d->column[*line].label->name, ss_measure_label(SS_STICK_FRACTION)->name) == 0)
        find_ends(r, g, &d->column[*line], *line);
    return SS_OK;
}

ss_status
ss_plot_map(FILE *out, const ss_table *t, const size_t column[], size_t n, const ss_plot_opts *opts,
            ss_error *err)
{
    ss_plot_opts own;
    if (out == NULL || t == NULL || column == NULL)
        return SS_FAIL_NULL(err);
    drawn d = { .table = t };
    map_grid g = { .row = NULL };
    regions r = { .n = 0 };
    size_t line = 0;
    ss_status st = ss_script_take(&own, opts, err);
    if (st == SS_OK)
        st = read_columns(&d, column, n, err);
    if (st == SS_OK)
        st = ss_map_grid_make(&g, d.column, t->n, err);
    if (st == SS_OK)
        st = choose_forms(&r, &line, &d, &g, err);
    if (st == SS_OK)
        st = write_map(out, &d, &g, &r, line, &own, err);
    for (size_t i = 0; i < COLUMNS_MAX; i++)
        free(d.column[i].value);
    ss_map_grid_free(&g);
    return st;
}
