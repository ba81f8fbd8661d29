/* map_lines.c -- draw lines of equal value on a map, and their labels.
 *
 * isoline.c traces the lines.  Each level has a label on at least one line; the lines with the
 * fewest places for a label get theirs first.  Another long line has a label if it covers no other
 * label. */
#include "plot/map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "base/sort.h"
#include "plot/isoline.h"

enum { LEVELS_MAX = 40, LABELS_MAX = 80 };
#define LONG 0.15                       /* least length of a line with a second label, in widths of the map */
#define RIM 0.04                        /* labels avoid the border of the map by this */

/* A piece of a line; the values at all corners of its cells are known. */
typedef struct line_piece {
    size_t first, n;                /* of the points */
    double level, length;           /* [widths of the map] */
    int longest;                    /* of its level */
} line_piece;

typedef struct map_lines {
    FILE *out;
    const map_grid *g;
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
place_on(const map_axis *a, double at)
{
    double x = ss_map_along(a, at), lo = a->value[0], hi = a->value[a->n - 1];
    return a->log ? log(x / lo) / log(hi / lo) : (x - lo) / (hi - lo);
}

static void
write_point(FILE *out, const map_grid *g, const double point[2], double level)
{
    ss_map_write_coordinate(out, &g->x, ss_map_along(&g->x, point[0]), ' ');
    ss_map_write_coordinate(out, &g->y, ss_map_along(&g->y, point[1]), ' ');
    ss_print(out, "%.6g\n", level);
}

/* Are all corners of the cell around a point known? */
static int
is_known(const map_lines *s, const double point[2])
{
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += ss_map_value(s->g, s->column, (size_t)(k % 2 ? ceil(point[0]) : point[0]),
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
write_line(const double (*point)[2], size_t n, int high_left, void *user)
{
    (void)high_left;
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

/* First the longest piece of each level, in ascending order of length; then the other pieces, in
 * descending order. */
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

/* If no value is below 0 and the middle 96 % of those above 0 span more than a factor of 20,
 * levels are at 1, 2 and 5 times powers of ten; else they have equal steps of 1, 2 or 5 times a
 * power of ten. */
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
    int decimals;
    double step = ss_script_step(hi - lo, 8, &decimals);
    for (double k = ceil(lo / step); k * step <= hi && count < LEVELS_MAX; k++)
        level[count++] = k * step;
    return count;
}

/* Fill in the heights to trace.  An unknown height is replaced by that of a neighbour; no line is
 * drawn there. */
static void
fill_heights(double *height, double *known, size_t *n_known, const map_grid *g, const double *column)
{
    double last = 0;
    *n_known = 0;
    for (size_t k = 0; k < g->x.n * g->y.n; k++) {
        double z = ss_map_value(g, column, k % g->x.n, k / g->x.n);
        if (isfinite(z))
            known[(*n_known)++] = last = z;
        height[k] = last;
    }
}

ss_status
ss_map_write_lines(FILE *out, const map_grid *g, const double *column, ss_error *err)
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
    return st == SS_OK ? SS_OK : ss_fail_memory(err, NULL);
}
