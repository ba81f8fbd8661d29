/* map_lines.c -- draw lines of equal value on a map, and their labels.
 *
 * isoline.c traces the lines.  Each level has a label on the longest of its lines: in the middle, or at the place
 * nearest to it where the label covers no other; if there is none, where it covers least. */
#include "plot/map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "plot/isoline.h"

enum { LEVELS_MAX = 40 };
#define RIM 0.04                        /* labels avoid the border of the map by this */
#define TALL 0.055                      /* the height of a label and its rim, in heights of the map */

typedef struct label {
    double point[2];                /* in units of the grid */
    double at[2], width;            /* in widths and heights of the map */
    double level;
} label;

typedef struct lines {
    FILE *out;
    const map_grid *g;
    const double *height;
    double level;
    double (*longest)[2];           /* of the pieces of lines of this level: its points */
    size_t n, room;
    double length;                  /* and its length, in widths of the map */
    int no_memory;
    label label[LEVELS_MAX];
    size_t labels;
} lines;

static void
write_point(const lines *s, const double point[2], double level)
{
    ss_map_write_coordinate(s->out, &s->g->x, ss_map_along(&s->g->x, point[0]), ' ');
    ss_map_write_coordinate(s->out, &s->g->y, ss_map_along(&s->g->y, point[1]), ' ');
    ss_print(s->out, "%.6g\n", level);
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

/* Write the pieces of a line between unknown values, and keep the longest of the level. */
static void
write_line(const double (*point)[2], size_t n, int high_left, void *user)
{
    lines *s = user;
    (void)high_left;
    for (size_t first = 0, end; first < n; first = end + 1) {
        double length = 0, at[2], last[2] = { 0, 0 };
        for (end = first; end < n; end++) {
            size_t x = (size_t)point[end][0], y = (size_t)point[end][1];        /* of the ends of a cell's side */
            size_t x1 = (size_t)ceil(point[end][0]), y1 = (size_t)ceil(point[end][1]);
            if (!isfinite(s->height[y * s->g->x.n + x] + s->height[y1 * s->g->x.n + x1]))
                break;
            write_point(s, point[end], s->level);
            place_of(at, s, point[end]);
            length += end > first ? hypot(at[0] - last[0], at[1] - last[1]) : 0;
            memcpy(last, at, sizeof last);
        }
        if (end > first)
            putc('\n', s->out);
        if (end == first || length < s->length)
            continue;
        void *room = ss_list_grow(s->longest, &s->room, end - first, sizeof *s->longest);
        s->no_memory |= room == NULL;
        if (s->no_memory)
            return;
        s->longest = room;
        s->n = end - first;
        s->length = length;
        memcpy(room, point + first, s->n * sizeof *point);
    }
}

/* Place a label where it is as far as possible from the next and from the rim, up to 1: it just touches none. */
static void
place_label(lines *s)
{
    double most = -INFINITY;
    label new = { .level = s->level, .width = 0.02 + 0.022 * snprintf(NULL, 0, "%g", s->level) }, best = new;
    for (size_t k = 0; k < s->n && most < 1; k++) {
        memcpy(new.point, s->longest[k % 2 == 0 ? s->n / 2 - k / 2 : s->n / 2 + k / 2], sizeof new.point);
        place_of(new.at, s, new.point);
        double clear = fmin(1, fmin(new.at[0], 1 - new.at[0]) / (new.width / 2));
        clear = fmin(clear, fmin(new.at[1], 1 - new.at[1]) / RIM);
        for (const label *l = s->label; l < s->label + s->labels; l++)
            clear = fmin(clear, fmax(fabs(new.at[0] - l->at[0]) / ((new.width + l->width) / 2),
                                     fabs(new.at[1] - l->at[1]) / TALL));
        best = clear > most ? new : best;
        most = fmax(most, clear);
    }
    if (s->n > 0)
        s->label[s->labels++] = best;
}

/* If no value is below 0, the middle 96 % of those above 0 span more than a factor of 20, and their median is
 * nearer to the geometric than to the arithmetic middle of these, levels are at 1, 2 and 5 times powers of ten;
 * else they have equal steps of 1, 2 or 5 times a power of ten.  None is at the largest value, which a region may
 * have. */
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
    double median = known[zeros + n / 2], most = known[zeros + n - 1];
    if (least >= 0 && lo > 0 && hi / lo > 20 && median * median < sqrt(lo * hi) * (lo + hi) / 2) {
        for (int e = (int)floor(log10(lo)); e <= (int)floor(log10(hi)); e++)
            for (int i = 0; i < 3 && count < LEVELS_MAX; i++)
                if (digit[i] * pow(10, e) >= lo && digit[i] * pow(10, e) <= hi && digit[i] * pow(10, e) < most)
                    level[count++] = e < 0 ? digit[i] / pow(10, -e) : digit[i] * pow(10, e);
        return count;
    }
    if (!(hi > lo))
        return 0;
    double step = ss_script_step(hi - lo, 8, &decimals);
    for (double k = ceil(lo / step); k * step <= hi && k * step < most && count < LEVELS_MAX; k++)
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
        s.n = 0;
        s.length = 0;
        st = ss_isolines(&map, level[i], write_line, &s);
        st = s.no_memory ? SS_ENOMEM : st;
        if (st == SS_OK)
            place_label(&s);
    }
    fputs("EOD\n$label << EOD\n", out);
    for (const label *l = s.label; l < s.label + s.labels; l++)
        write_point(&s, l->point, l->level);
    fputs("EOD\n", out);
    free(s.longest);
    free(filled);
    free(known);
    return st == SS_OK ? SS_OK : ss_fail_memory(err, NULL);
}
