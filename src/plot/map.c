/* map.c -- a sweep over two parameters: regions of equal count, lines of equal value.
 *
 * A region is drawn as the boxes of its grid points, those next to each other in a row as one, and
 * each overlaps the next row by a quarter, so that no seams show.  isoline.c traces the lines.  Each
 * level has a label on at least one line: lines with the least choice of place are labelled first;
 * other long lines have a label where it covers no other. */
#include "plot/isoline.h"
#include "plot/script.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "base/sort.h"

enum { REGIONS_MAX = 10, LEVELS_MAX = 40, LABELS_MAX = 80 };
#define LONG 0.15                       /* a line worth a second label: in widths of the map */
#define RIM 0.04                        /* where labels are avoided */

/* Light to dark, in equal steps of lightness, from pale yellow to violet: the order is seen by all
 * kinds of colour vision, in print without colour too. */
static const char *const shade[REGIONS_MAX] = { "#fbf3d5", "#dcebc8", "#b7dec3", "#93cdc4",
    "#74b9c4", "#5fa3c0", "#558bb7", "#5273a9", "#505b97", "#4b4381" };

/* A column's values that differ, ascending. */
typedef struct axis {
    const double *column;
    double *value;
    size_t n;
    int log;                        /* their ratios are equal, not their differences */
    int digits;                     /* that tell apart a hundred-thousandth of their range */
} axis;

typedef struct grid {
    axis x, y;
    size_t *row;                    /* of the table at x i, y j: row[j * x.n + i]; SIZE_MAX: none */
} grid;

/* The step that varies less over the values is the grid's. */
static int
is_log(const axis *a)
{
    double d[2] = { INFINITY, 0 }, r[2] = { INFINITY, 0 };
    for (size_t i = 1; i < a->n; i++) {
        double difference = a->value[i] - a->value[i - 1];
        double ratio = log(a->value[i] / a->value[i - 1]);
        d[0] = fmin(d[0], difference);
        d[1] = fmax(d[1], difference);
        r[0] = fmin(r[0], ratio);
        r[1] = fmax(r[1], ratio);
    }
    return a->n > 2 && a->value[0] > 0 && isfinite(a->value[a->n - 1] / a->value[0])
        && d[1] > d[0] * (1 + 1e-6) && r[1] / r[0] < d[1] / d[0];
}

static ss_status
make_axis(axis *a, const ss_sweep_table *t, size_t column, ss_error *err)
{
    a->column = t->value + column * t->n;
    a->value = malloc((t->n + 1) * sizeof *a->value);
    if (a->value == NULL)
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    size_t found = 0;
    for (size_t i = 0; i < t->n; i++)
        if (isfinite(a->column[i]))
            a->value[found++] = a->column[i];
    qsort(a->value, found, sizeof *a->value, ss_ascending);
    for (size_t i = 0; i < found; i++)
        if (a->n == 0 || a->value[i] != a->value[a->n - 1])
            a->value[a->n++] = a->value[i];
    if (a->n < 2)
        return ss_fail(err, SS_EINVAL, "a map needs two values of %s at least", t->name[column]);
    double lo = a->value[0], hi = a->value[a->n - 1];
    a->log = is_log(a);
    a->digits = 6 + (int)fmax(0, floor(log10(fmax(fabs(lo), fabs(hi)) / (hi - lo))));
    return SS_OK;
}

/* The index of x among the values; x is one of them. */
static size_t
find(const axis *a, double x)
{
    const double *at = bsearch(&x, a->value, a->n, sizeof x, ss_ascending);
    return (size_t)(at - a->value);
}

static ss_status
make_grid(grid *g, const ss_sweep_table *t, const ss_map_opts *map, ss_error *err)
{
    ss_status st = make_axis(&g->x, t, map->x, err);
    if (st == SS_OK)
        st = make_axis(&g->y, t, map->y, err);
    if (st != SS_OK)
        return st;
    if (g->x.n > SIZE_MAX / sizeof *g->row / g->y.n || g->x.n * g->y.n > 16 * t->n + 100)
        return ss_fail(err, SS_EINVAL, "the rows are no grid: %zu values of %s, %zu of %s in %zu "
                       "rows", g->x.n, t->name[map->x], g->y.n, t->name[map->y], t->n);
    g->row = malloc(g->x.n * g->y.n * sizeof *g->row);
    if (g->row == NULL)
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    for (size_t i = 0; i < g->x.n * g->y.n; i++)
        g->row[i] = SIZE_MAX;
    for (size_t i = 0; i < t->n; i++) {
        if (!isfinite(g->x.column[i]) || !isfinite(g->y.column[i]))
            continue;
        size_t *row = &g->row[find(&g->y, g->y.column[i]) * g->x.n + find(&g->x, g->x.column[i])];
        if (*row != SIZE_MAX)
            return ss_fail(err, SS_EINVAL, "two rows with the same %s and %s: choose among them "
                           "first", t->name[map->x], t->name[map->y]);
        *row = i;
    }
    return SS_OK;
}

static double
value_at(const grid *g, const double *column, size_t i, size_t j)
{
    size_t row = g->row[j * g->x.n + i];
    return row == SIZE_MAX ? NAN : column[row];
}

static double
along(const axis *a, double at)
{
    size_t i = (size_t)fmin(fmax(at, 0), (double)(a->n - 2));
    double part = at - (double)i, lo = a->value[i], hi = a->value[i + 1];
    return a->log ? lo * pow(hi / lo, part) : lo + part * (hi - lo);
}

/* The border between the cells of values i - 1 and i; the outermost end at their values. */
static double
border(const axis *a, double i)
{
    return along(a, fmin(fmax(i - 0.5, 0), (double)(a->n - 1)));
}

static void
write_level(FILE *out, double level)
{
    fprintf(out, "%.6g\n", level);
}

static void
write_coordinate(FILE *out, const axis *a, double x, char behind)
{
    fprintf(out, "%.*g%c", a->digits, x, behind);
}

/* --- regions ------------------------------------------------------------------------------- */

typedef struct regions {
    double value[REGIONS_MAX];      /* ascending */
    size_t n;
    int missing;                    /* there are points without one */
} regions;

/* 1 if the column holds few different values, or few whole ones: a count.  An amplitude that is 0 at
 * some points of a grid is none. */
static int
find_regions(regions *r, const grid *g, const double *column)
{
    *r = (regions){ .n = 0 };
    for (size_t k = 0; k < g->x.n * g->y.n; k++) {
        double z = value_at(g, column, k % g->x.n, k / g->x.n);
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

static int
same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The boxes of the points at which the column has this value, NaN where it has none. */
static void
write_boxes(FILE *out, const grid *g, const double *column, double value)
{
    for (size_t j = 0; j < g->y.n; j++)
        for (size_t i = 0, end; i < g->x.n; i = end) {
            for (end = i; end < g->x.n && same(value_at(g, column, end, j), value); end++)
                ;
            if (end == i) {
                end++;
                continue;
            }
            write_coordinate(out, &g->x, border(&g->x, (double)i), ' ');
            write_coordinate(out, &g->x, border(&g->x, (double)end), ' ');
            write_coordinate(out, &g->y, border(&g->y, (double)j), ' ');
            double top = (double)(j + 1) + (j + 1 < g->y.n ? 0.25 : 0);
            write_coordinate(out, &g->y, border(&g->y, top), '\n');
        }
}

static void
write_regions(FILE *out, const grid *g, const double *column, const regions *r)
{
    for (size_t i = 0; i < r->n; i++) {
        fprintf(out, "$region%zu << EOD\n", i);
        write_boxes(out, g, column, r->value[i]);
        fputs("EOD\n", out);
    }
}

/* --- lines --------------------------------------------------------------------------------- */

/* A piece of a line, all corners of its cells known. */
typedef struct line_piece {
    size_t first, n;                /* of the points */
    double level, length;           /* [widths of the map] */
    int longest;                    /* of its level */
} line_piece;

typedef struct map_lines {
    FILE *out;
    const grid *g;
    const double *column;
    double level;
    double (*point)[2];             /* of all pieces, in units of the grid */
    line_piece *piece;
    size_t n_points, n_pieces;
    size_t points_room, pieces_room;
    int no_memory;
} map_lines;

/* The position of x on the axis, 0 to 1. */
static double
place_on(const axis *a, double at)
{
    double x = along(a, at), lo = a->value[0], hi = a->value[a->n - 1];
    return a->log ? log(x / lo) / log(hi / lo) : (x - lo) / (hi - lo);
}

static void
write_point(FILE *out, const grid *g, const double point[2], double level)
{
    write_coordinate(out, &g->x, along(&g->x, point[0]), ' ');
    write_coordinate(out, &g->y, along(&g->y, point[1]), ' ');
    write_level(out, level);
}

/* Are all corners of the cell around a point known? */
static int
is_known(const map_lines *s, const double point[2])
{
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += value_at(s->g, s->column, (size_t)(k % 2 ? ceil(point[0]) : point[0]),
                        (size_t)(k / 2 ? ceil(point[1]) : point[1]));
    return isfinite(sum);
}

static void
append_piece(map_lines *s, const double (*point)[2], size_t n)
{
    line_piece p = { s->n_points, n, s->level, 0, 0 };
    void *points = ss_list_grow(s->point, &s->points_room, s->n_points + n, sizeof *s->point);
    s->point = points != NULL ? points : s->point;
    void *pieces = ss_list_room(s->piece, &s->pieces_room, s->n_pieces, sizeof *s->piece);
    s->piece = pieces != NULL ? pieces : s->piece;
    s->no_memory |= points == NULL || pieces == NULL;
    if (s->no_memory)
        return;
    memcpy(s->point + s->n_points, point, n * sizeof *point);
    s->n_points += n;
    for (size_t i = 1; i < n; i++)
        p.length += hypot(place_on(&s->g->x, point[i][0]) - place_on(&s->g->x, point[i - 1][0]),
                          place_on(&s->g->y, point[i][1]) - place_on(&s->g->y, point[i - 1][1]));
    s->piece[s->n_pieces++] = p;
}

static void
write_line(const double (*point)[2], size_t n, void *user)
{
    map_lines *s = user;
    for (size_t first = 0, end; first < n; first = end + 1) {
        for (end = first; end < n && is_known(s, point[end]); end++)
            write_point(s->out, s->g, point[end], s->level);
        if (end == first)
            continue;
        putc('\n', s->out);
        append_piece(s, point + first, end - first);
    }
}

/* --- their labels -------------------------------------------------------------------------- */

typedef struct labels {
    double at[LABELS_MAX][2], width[LABELS_MAX];    /* in widths and heights of the map */
    size_t n;
} labels;

static double
label_width(double level)
{
    char text[32];
    return 0.02 + 0.022 * snprintf(text, sizeof text, "%g", level);
}

/* The distance of a label from the next and from the rim, 1 if it just touches none. */
static double
clearance(const labels *l, const double at[2], double width)
{
    double nearest = 1;
    for (int k = 0; k < 2; k++) {
        double need = k == 0 ? width / 2 : RIM;
        nearest = fmin(nearest, fmin(at[k], 1 - at[k]) / need);
    }
    for (size_t i = 0; i < l->n; i++)
        nearest = fmin(nearest, fmax(fabs(at[0] - l->at[i][0]) / ((width + l->width[i]) / 2),
                                     fabs(at[1] - l->at[i][1]) / 0.055));
    return nearest;
}

/* Label a piece in its middle, or at the nearest point that has room; if no point has room and the
 * piece must have a label, at the point where the label covers least. */
static void
write_label_on(FILE *out, labels *l, const map_lines *s, const line_piece *p, int must)
{
    const double (*point)[2] = (const double (*)[2])s->point + p->first, *best = NULL;
    double most = must ? 0 : 1 - 1e-9, width = label_width(p->level);
    for (size_t k = 0; k < p->n && l->n < LABELS_MAX; k++) {
        const double *at = point[k % 2 == 0 ? p->n / 2 - k / 2 : p->n / 2 + k / 2];
        const double place[2] = { place_on(&s->g->x, at[0]), place_on(&s->g->y, at[1]) };
        double clear = clearance(l, place, width);
        if (clear <= most)
            continue;
        most = clear;
        best = at;
        memcpy(l->at[l->n], place, sizeof place);
        if (clear >= 1)
            break;
    }
    if (best == NULL)
        return;
    write_point(out, s->g, best, p->level);
    l->width[l->n++] = width;
}

/* The longest piece of each level first, the shortest of these before; then the longer before. */
static int
by_need(const void *a, const void *b)
{
    const line_piece *p = a, *q = b;
    if (p->longest != q->longest)
        return q->longest - p->longest;
    int order = (p->length > q->length) - (p->length < q->length);
    if (order == 0)
        return (p->first > q->first) - (p->first < q->first);
    return p->longest ? order : -order;
}

static void
write_line_labels(FILE *out, map_lines *s)
{
    labels l = { .n = 0 };
    for (size_t i = 0, end; i < s->n_pieces; i = end) {
        size_t longest = i;
        for (end = i; end < s->n_pieces && s->piece[end].level == s->piece[i].level; end++)
            longest = s->piece[end].length > s->piece[longest].length ? end : longest;
        s->piece[longest].longest = 1;
    }
    if (s->n_pieces > 0)
        qsort(s->piece, s->n_pieces, sizeof *s->piece, by_need);
    fputs("$label << EOD\n", out);
    for (size_t i = 0; i < s->n_pieces; i++)
        if (s->piece[i].longest || s->piece[i].length >= LONG)
            write_label_on(out, &l, s, &s->piece[i], s->piece[i].longest);
    fputs("EOD\n", out);
}

/* Levels at 1, 2 and 5 times powers of ten where the middle 96 % of values above 0 span more than a
 * factor of 20 and none is below, else in equal steps of that kind. */
static size_t
choose_levels(double level[LEVELS_MAX], double *sorted, size_t n)
{
    static const double digit[] = { 1, 2, 5 };
    size_t count = 0;
    qsort(sorted, n, sizeof *sorted, ss_ascending);
    double least = sorted[0];
    while (least == 0 && n > 1 && sorted[0] == 0)
        sorted++, n--;
    double lo = sorted[n / 50], hi = sorted[n - 1 - n / 50];
    if (least >= 0 && lo > 0 && hi / lo > 20) {
        for (int e = (int)floor(log10(lo)); e <= (int)floor(log10(hi)); e++)
            for (int i = 0; i < 3 && count < LEVELS_MAX; i++)
                if (digit[i] * pow(10, e) >= lo && digit[i] * pow(10, e) <= hi)
                    level[count++] = e < 0 ? digit[i] / pow(10, -e) : digit[i] * pow(10, e);
        return count;
    }
    if (!(hi > lo))
        return 0;
    double power = pow(10, floor(log10((hi - lo) / 8))), share = (hi - lo) / 8 / power;
    double step = power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
    for (double k = ceil(lo / step); k * step <= hi && count < LEVELS_MAX; k++)
        level[count++] = k * step;
    return count;
}

/* Heights for the tracing; an unknown height is replaced by its neighbour's, and no line is drawn
 * there. */
static void
fill_heights(double *height, double *known, size_t *n_known, const grid *g, const double *column)
{
    double last = 0;
    *n_known = 0;
    for (size_t k = 0; k < g->x.n * g->y.n; k++) {
        double z = value_at(g, column, k % g->x.n, k / g->x.n);
        if (isfinite(z))
            known[(*n_known)++] = last = z;
        height[k] = last;
    }
}

static ss_status
write_lines(FILE *out, const grid *g, const double *column, ss_error *err)
{
    size_t cells = g->x.n * g->y.n, n_known;
    double *height = malloc(cells * sizeof *height), *known = malloc(cells * sizeof *known);
    double level[LEVELS_MAX];
    map_lines sink = { .out = out, .g = g, .column = column };
    ss_status st = height != NULL && known != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK) {
        fill_heights(height, known, &n_known, g, column);
        const isoline_map map = { g->x.n, g->y.n, height };
        size_t levels = n_known > 0 ? choose_levels(level, known, n_known) : 0;
        fputs("$line << EOD\n", out);
        for (size_t i = 0; st == SS_OK && i < levels; i++) {
            sink.level = level[i];
            st = ss_isolines(&map, level[i], write_line, &sink);
        }
        fputs("EOD\n", out);
        write_line_labels(out, &sink);
        st = sink.no_memory ? SS_ENOMEM : st;
    }
    free(sink.point);
    free(sink.piece);
    free(height);
    free(known);
    return st == SS_OK ? SS_OK : ss_fail(err, st, "%s", ss_strerror(st));
}

/* --- the script ---------------------------------------------------------------------------- */

static void
write_curve(FILE *out, const ss_map_opts *map, const grid *g)
{
    fputs("$curve << EOD\n", out);
    for (size_t i = 0; i < map->n_curve; i++)
        if (isfinite(map->curve[2 * i]) && isfinite(map->curve[2 * i + 1])) {
            write_coordinate(out, &g->x, map->curve[2 * i], ' ');
            write_coordinate(out, &g->y, map->curve[2 * i + 1], '\n');
        } else {
            putc('\n', out);
        }
    fputs("EOD\n", out);
}

static void
write_axis(FILE *out, const char *name, const axis *a)
{
    fprintf(out, "set %srange [", name);
    write_coordinate(out, a, a->value[0], ':');
    write_coordinate(out, a, a->value[a->n - 1], ']');
    fprintf(out, "%s%s\n", a->log ? "; set logscale " : "", a->log ? name : "");
}

/* "base frequency / Hz" */
static void
make_label(script_label *label, const ss_sweep_table *t, size_t column)
{
    const ss_column of_table = { t->name[column], t->unit[column] };
    ss_script_make_label(label, &of_table, 0, INFINITY);
    for (size_t i = 0; i < strlen(t->name[column]) && i < label->n; i++)
        label->text[i] = label->text[i] == '_' ? ' ' : label->text[i];
}

static void
write_plot(FILE *out, const ss_map_opts *map, const regions *r, int has_lines)
{
    const char *comma = "plot ";
    for (size_t i = 0; i < r->n; i++, comma = ", \\\n     ") {
        size_t s = r->n > 1 ? i * (REGIONS_MAX - 1) / (r->n > 5 ? r->n - 1 : 5) : 0;
        fprintf(out, "%s$region%zu using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder "
                "lc rgb '%s' title '%.6g'", comma, i, shade[s], r->value[i]);
    }
    if (has_lines) {
        fprintf(out, "%s$line using 1:2 with lines lw 0.7 lc rgb line_colour notitle", comma);
        comma = ", \\\n     ";
    }
    if (r->missing) {
        fprintf(out, "%s$missing using 1:3:1:2:3:4 with boxxyerror fs solid 1 noborder lc rgb "
                "missing_colour title 'none'", comma);
        comma = ", \\\n     ";
    }
    if (map->n_curve > 0) {
        fprintf(out, "%s$curve using 1:2 with lines lw 2 lc rgb curve_colour notitle", comma);
        comma = ", \\\n     ";
    }
    if (has_lines)
        fprintf(out, "%s$label using 1:2:(sprintf('%%g', $3)) with labels boxed font fine tc rgb "
                "line_colour notitle", comma);
    putc('\n', out);
}

static ss_status
write_map(FILE *out, const ss_sweep_table *t, const grid *g, const regions *r, size_t region,
          size_t line, const ss_map_opts *map, const ss_plot_opts *opts, ss_error *err)
{
    ss_plot_opts titled = *opts;
    int has_region = r->n > 0, has_lines = line != SIZE_MAX;
    script_label x_label, y_label, line_label;
    if (titled.title == NULL)
        titled.title = t->scene != NULL ? t->scene : "";
    ss_status st = ss_script_begin(out, &titled, 7, err);
    if (st != SS_OK)
        return st;
    make_label(&x_label, t, map->x);
    make_label(&y_label, t, map->y);
    if (has_lines)
        make_label(&line_label, t, line);
    ss_script_write_title(out, &titled, NULL, has_lines ? &line_label : NULL);
    fputs("set xlabel ", out);
    ss_script_write_label(out, &x_label);
    fputs(" noenhanced offset 0,0.4\n", out);
    ss_script_write_side_label(out, 1, &y_label);
    fputs("line_colour = '#222222'; curve_colour = '#d55e00'; missing_colour = '#bbbbbb'\n"
          "fine = ',' . (exists('font') ? sprintf('%.1f', 0.8*word(substr(font, 6, 9), 1)) : "
          "'8')\n", out);
    if (has_region)
        write_regions(out, g, t->value + region * t->n, r);
    if (r->missing) {
        fputs("$missing << EOD\n", out);
        write_boxes(out, g, t->value + (has_region ? region : line) * t->n, NAN);
        fputs("EOD\n", out);
    }
    if (map->n_curve > 0)
        write_curve(out, map, g);
    if (has_lines)
        st = write_lines(out, g, t->value + line * t->n, err);
    if (st != SS_OK)
        return st;
    fprintf(out, "set lmargin at screen 0.14; set tmargin at screen %s; "
            "set bmargin at screen 0.14\n", has_lines && titled.title[0] != '\0' ? "0.88" : "0.92");
    fprintf(out, "set rmargin at screen %s\n", has_region || r->missing ? "0.835" : "0.965");
    write_axis(out, "x", &g->x);
    write_axis(out, "y", &g->y);
    fputs("set tics nomirror out scale 0.6; set border lw 0.8 front\n"
          "set style textbox opaque fillcolor '#ffffff' noborder margins 0.4,0.3\n", out);
    if (has_region || r->missing)
        fputs("set key at screen 0.995,graph 1 right top Left reverse samplen 0.6 spacing 1.3 "
              "noenhanced font fine\n", out);
    else
        fputs("unset key\n", out);
    if (has_region) {
        fputs("set key title ", out);
        ss_script_quote(out, t->name[region]);
        fputs(" noenhanced font fine\n", out);
    }
    write_plot(out, map, r, has_lines);
    return ss_script_end(out);
}

/* Missing values of a sweep are NaN; the others have the bounds of all drawn values. */
static ss_status
check_column(const ss_sweep_table *t, size_t column, ss_error *err)
{
    for (size_t i = 0; i < t->n; i++) {
        const double *x = &t->value[column * t->n + i];
        if (isnan(*x) || fabs(*x) < 1)
            continue;
        ss_status st = ss_script_check(t->name[column], x, 1, err);
        if (st != SS_OK)
            return st;
    }
    return SS_OK;
}

static ss_status
check(const ss_sweep_table *t, const ss_map_opts *map, ss_error *err)
{
    const size_t column[] = { map->x, map->y, map->z[0], map->n_z > 1 ? map->z[1] : 0 };
    if (map->n_z < 1 || map->n_z > 2)
        return ss_fail(err, SS_EINVAL, "a map shows one column or two");
    for (size_t i = 0; i < sizeof column / sizeof *column; i++)
        if (column[i] >= t->n_columns)
            return ss_fail(err, SS_EINVAL, "no column %zu, there are %zu", column[i] + 1,
                           t->n_columns);
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < sizeof column / sizeof *column; i++)
        st = check_column(t, column[i], err);
    return st;
}

ss_status
ss_plot_map(FILE *out, const ss_sweep_table *t, const ss_map_opts *map, const ss_plot_opts *opts,
            ss_error *err)
{
    if (out == NULL || t == NULL || map == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    grid g = { .row = NULL };
    regions r = { .n = 0 };
    size_t region = SIZE_MAX, line = SIZE_MAX;
    ss_status st = check(t, map, err);
    if (st == SS_OK)
        st = make_grid(&g, t, map, err);
    for (size_t i = 0; st == SS_OK && i < map->n_z; i++) {
        regions found;
        int few = find_regions(&found, &g, t->value + map->z[i] * t->n);
        size_t *place = few ? &region : &line;
        if (*place != SIZE_MAX)
            st = ss_fail(err, SS_EINVAL, "%s and %s are both drawn as %s: a map has one of each",
                         t->name[*place], t->name[map->z[i]], few ? "regions" : "lines");
        *place = map->z[i];
        if (few || i == 0)
            r = (regions){ .n = few ? found.n : 0, .missing = found.missing };
        if (few)
            memcpy(r.value, found.value, sizeof r.value);
    }
    if (st == SS_OK)
        st = write_map(out, t, &g, &r, region, line, map, opts, err);
    free(g.x.value);
    free(g.y.value);
    free(g.row);
    return st;
}
