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
#define TALL 0.055                      /* the height of a label and its rim, in heights of the map */

/* A piece of a line; the values at all corners of its cells are known. */
typedef struct piece {
    size_t first, n;                /* of the points */
    double level, length;           /* [widths of the map] */
    int is_longest;                 /* of its level */
} piece;

typedef struct lines {
    FILE *out;
    const map_grid *g;
    const double *height;
    double level;
    double (*point)[2];             /* of all pieces, in units of the grid */
    piece *piece;
    size_t n_points, n_pieces, points_room, pieces_room;
    int no_memory;
} lines;

static void
write_point(const lines *s, const double point[2], double level)
{
    ss_map_write_coordinate(s->out, &s->g->x, ss_map_along(&s->g->x, point[0]), ' ');
    ss_map_write_coordinate(s->out, &s->g->y, ss_map_along(&s->g->y, point[1]), ' ');
    ss_print(s->out, "%.6g\n", level);
}

/* Are all corners of the cell around a point known? */
static int
is_known(const lines *s, const double point[2])
{
    size_t n = s->g->x.n, x = (size_t)point[0], y = (size_t)point[1];
    size_t x1 = (size_t)ceil(point[0]), y1 = (size_t)ceil(point[1]);
    return isfinite(s->height[y * n + x] + s->height[y * n + x1] + s->height[y1 * n + x] + s->height[y1 * n + x1]);
}

/* The place of a point in the map, 0 to 1 on each axis. */
static void
place_of(double place[2], const lines *s, const double point[2])
{
    for (int i = 0; i < 2; i++) {
        const map_axis *a = i == 0 ? &s->g->x : &s->g->y;
        double x = ss_map_along(a, point[i]), lo = a->value[0], hi = a->value[a->n - 1];
        place[i] = a->log ? log(x / lo) / log(hi / lo) : (x - lo) / (hi - lo);
    }
}

/* Write the pieces of a line, and keep them for their labels. */
static void
write_line(const double (*point)[2], size_t n, int high_left, void *user)
{
    lines *s = user;
    (void)high_left;
    for (size_t first = 0, end; first < n && !s->no_memory; first = end + 1) {
        for (end = first; end < n && is_known(s, point[end]); end++)
            write_point(s, point[end], s->level);
        if (end == first)
            continue;
        putc('\n', s->out);
        piece p = { s->n_points, end - first, s->level, 0, 0 };
        for (size_t i = first + 1; i < end; i++) {
            double at[2], last[2];
            place_of(at, s, point[i]);
            place_of(last, s, point[i - 1]);
            p.length += hypot(at[0] - last[0], at[1] - last[1]);
        }
        void *points = ss_list_grow(s->point, &s->points_room, s->n_points + p.n, sizeof *s->point);
        s->point = points != NULL ? points : s->point;
        void *pieces = ss_list_room(s->piece, &s->pieces_room, s->n_pieces, sizeof *s->piece);
        s->piece = pieces != NULL ? pieces : s->piece;
        s->no_memory = points == NULL || pieces == NULL;
        if (s->no_memory)
            return;
        memcpy(s->point + s->n_points, point + first, p.n * sizeof *point);
        s->n_points += p.n;
        s->piece[s->n_pieces++] = p;
    }
}

/* --- their labels -------------------------------------------------------------------------- */

typedef struct label {
    double at[2], width;            /* in widths and heights of the map */
} label;

/* The distance of a label from the next of n and from the rim, 1 if it just touches none. */
static double
clearance(const label l[], size_t n, const label *new)
{
    double nearest = 1;
    for (int k = 0; k < 2; k++)
        nearest = fmin(nearest, fmin(new->at[k], 1 - new->at[k]) / (k == 0 ? new->width / 2 : RIM));
    for (size_t i = 0; i < n; i++)
        nearest = fmin(nearest, fmax(fabs(new->at[0] - l[i].at[0]) / ((new->width + l[i].width) / 2),
                                     fabs(new->at[1] - l[i].at[1]) / TALL));
    return nearest;
}

/* First the longest piece of each level, in ascending order of length; then the other pieces, in
 * descending order. */
static int
by_need(const void *a, const void *b)
{
    const piece *p = a, *q = b;
    if (p->is_longest != q->is_longest)
        return q->is_longest - p->is_longest;
    int order = (p->length > q->length) - (p->length < q->length);
    return order == 0 ? (p->first > q->first) - (p->first < q->first) : p->is_longest ? order : -order;
}

/* Label a piece in its middle, or at the nearest point that has room; if no point has room and the
 * piece is the longest of its level, at the point where the label covers least. */
static void
write_labels(lines *s)
{
    label l[LABELS_MAX];
    size_t n = 0;
    for (size_t i = 0, end; i < s->n_pieces; i = end) {
        size_t longest = i;
        for (end = i; end < s->n_pieces && s->piece[end].level == s->piece[i].level; end++)
            longest = s->piece[end].length > s->piece[longest].length ? end : longest;
        s->piece[longest].is_longest = 1;
    }
    if (s->n_pieces > 0)
        qsort(s->piece, s->n_pieces, sizeof *s->piece, by_need);
    fputs("$label << EOD\n", s->out);
    for (const piece *p = s->piece; p < s->piece + s->n_pieces && n < LABELS_MAX; p++) {
        const double *best = NULL;
        double most = p->is_longest ? 0 : 1 - 1e-9;
        label new = { .width = 0.02 + 0.022 * snprintf(NULL, 0, "%g", p->level) };
        if (!p->is_longest && p->length < LONG)
            continue;
        for (size_t k = 0; k < p->n && most < 1; k++) {
            const double *at = s->point[p->first + (k % 2 == 0 ? p->n / 2 - k / 2 : p->n / 2 + k / 2)];
            place_of(new.at, s, at);
            double clear = clearance(l, n, &new);
            if (clear <= most)
                continue;
            most = clear;
            best = at;
            l[n] = new;
        }
        if (best != NULL) {
            write_point(s, best, p->level);
            n++;
        }
    }
    fputs("EOD\n", s->out);
}

/* --- levels --------------------------------------------------------------------------------- */

/* If no value is below 0 and the middle 96 % of those above 0 span more than a factor of 20,
 * levels are at 1, 2 and 5 times powers of ten; else they have equal steps of 1, 2 or 5 times a
 * power of ten. */
static size_t
choose_levels(double level[LEVELS_MAX], double *known, size_t n)
{
    static const double digit[] = { 1, 2, 5 };
    size_t count = 0, zeros = 0;
    int decimals;
    qsort(known, n, sizeof *known, ss_ascending);
    while (zeros + 1 < n && known[zeros] == 0)
        zeros++;
    n -= zeros;
    double least = known[0], lo = known[zeros + n / 50], hi = known[zeros + n - 1 - n / 50];
    if (least >= 0 && lo > 0 && hi / lo > 20) {
        for (int e = (int)floor(log10(lo)); e <= (int)floor(log10(hi)); e++)
            for (int i = 0; i < 3 && count < LEVELS_MAX; i++)
                if (digit[i] * pow(10, e) >= lo && digit[i] * pow(10, e) <= hi)
                    level[count++] = e < 0 ? digit[i] / pow(10, -e) : digit[i] * pow(10, e);
        return count;
    }
    if (!(hi > lo))
        return 0;
    double step = ss_script_step(hi - lo, 8, &decimals);
    for (double k = ceil(lo / step); k * step <= hi && count < LEVELS_MAX; k++)
        level[count++] = k * step;
    return count;
}

/* An unknown height is that of a neighbour while lines are traced; none is drawn there. */
ss_status
ss_map_write_lines(FILE *out, const map_grid *g, const double *height, ss_error *err)
{
    size_t points = g->x.n * g->y.n, n_known = 0;
    double *filled = malloc(points * sizeof *filled), *known = malloc(points * sizeof *known), last = 0;
    double level[LEVELS_MAX];
    lines s = { .out = out, .g = g, .height = height };
    ss_status st = filled != NULL && known != NULL ? SS_OK : SS_ENOMEM;
    for (size_t k = 0; st == SS_OK && k < points; k++) {
        if (isfinite(height[k]))
            known[n_known++] = last = height[k];
        filled[k] = last;
    }
    const isoline_map map = { g->x.n, g->y.n, filled };
    size_t levels = n_known > 0 ? choose_levels(level, known, n_known) : 0;
    fputs("$line << EOD\n", out);
    for (size_t i = 0; st == SS_OK && i < levels; i++) {
        s.level = level[i];
        st = ss_isolines(&map, level[i], write_line, &s);
    }
    fputs("EOD\n", out);
    if (st == SS_OK && !s.no_memory)
        write_labels(&s);
    free(s.point);
    free(s.piece);
    free(filled);
    free(known);
    return st == SS_OK && !s.no_memory ? SS_OK : ss_fail_memory(err, NULL);
}
