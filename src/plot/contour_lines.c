/* contour_lines.c -- write lines of equal |W|, with the fewest points that keep them within a fraction of a pixel,
 * and the areas between them.
 *
 * For the areas, the map is extended by a border of very low values, so that every line is closed.  Lines do not
 * cross: of two areas that they enclose, one contains the other, or they have nothing in common.  So the areas are
 * painted in the order of their size, the largest first, each in the colour of the level just inside its line.
 * Every level, with its holes, is then visible where it belongs. */
#include "plot/contour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "plot/isoline.h"

#define BLUR 0.2                /* a line may move by so many pixels when points are left out */

/* Write a point of the map, given by column and row, as time and frequency, with the texts between and behind
 * them. */
static void
write_point(FILE *out, const contour_map *map, const double point[2], const char *between, const char *behind)
{
    double range = map->to - map->from;
    size_t row = (size_t)fmin(point[1], (double)(map->rows - 2));
    double part = point[1] - (double)row, f = map->f[row] * pow(map->f[row + 1] / map->f[row], part);
    ss_script_write(out, map->from + point[0] / CONTOUR_COLUMNS * range, ss_script_decimals(range), between);
    ss_script_write(out, f, 3 - (int)floor(log10(f)), behind);
}

/* The next of n points, after first, that is needed to keep a line within a fraction of a pixel. */
static size_t
next_point(const contour_map *map, const double (*point)[2], size_t n, size_t first)
{
    double row = (double)CONTOUR_ROWS / (double)(map->rows - 1);        /* pixels */
    for (size_t last = first + 2; last < n && last - first <= 64; last++) {
        double dx = point[last][0] - point[first][0], dy = (point[last][1] - point[first][1]) * row;
        double length = hypot(dx, dy);
        for (size_t i = first + 1; i < last; i++) {
            double x = point[i][0] - point[first][0], y = (point[i][1] - point[first][1]) * row;
            double along = x * dx + y * dy, off = fabs(x * dy - y * dx);
            if (!(off <= BLUR * length && along >= 0 && along <= length * length))
                return last - 1;
        }
    }
    return n - 1 - first < 64 ? n - 1 : first + 64;
}

typedef struct line_sink {
    FILE *out;
    const contour_map *map;
    char behind[16];            /* the number of the level */
    size_t lines;               /* of this level, so far */
} line_sink;

static void
write_line(const double (*point)[2], size_t n, int left, void *user)
{
    line_sink *sink = user;
    (void)left;
    write_point(sink->out, sink->map, point[0], " ", sink->behind);
    for (size_t i = 0; i < n - 1;) {
        i = next_point(sink->map, point, n, i);
        write_point(sink->out, sink->map, point[i], " ", sink->behind);
    }
    putc('\n', sink->out);
    sink->lines++;
}

ss_status
ss_contour_write_lines(FILE *out, const contour_map *map, int levels, int *any)
{
    char drawn[CONTOUR_LEVELS * sizeof " 100"] = "";
    line_sink sink = { .out = out, .map = map };
    const isoline_map heights = { CONTOUR_COLUMNS + 1, map->rows, map->level };
    ss_status status = SS_OK;
    fputs("$contour << EOD\n", out);
    for (int k = 1; status == SS_OK && k <= levels; k++) {
        snprintf(sink.behind, sizeof sink.behind, " %d\n", k);
        sink.lines = 0;
        status = ss_isolines(&heights, -k * map->span / levels, write_line, &sink);
        if (sink.lines > 0) {
            putc('\n', out);
            snprintf(drawn + strlen(drawn), sizeof drawn - strlen(drawn), " %d", k);
        }
    }
    *any = drawn[0] != '\0';
    ss_print(out, "EOD\ndrawn = '%s'     # levels that have lines\n", drawn + (drawn[0] == ' '));
    return status;
}

typedef struct polygon {
    double area;                /* [cells] */
    int band;                   /* just inside, |W| is between lines band and band + 1 */
    size_t first, n;            /* points */
} polygon;

typedef struct painting {
    const contour_map *map;
    int line;                   /* the number of the line that is being traced */
    polygon *polygon;
    size_t n, room;
    double (*point)[2];
    size_t n_points, points_room;
    int failed;
} painting;

/* Keep a closed line as an area.  Twice its area is > 0 if it lies on its left. */
static void
keep_polygon(const double (*point)[2], size_t n, int high_left, void *user)
{
    painting *p = user;
    double area = 0;
    polygon *list = ss_list_room(p->polygon, &p->room, p->n, sizeof *list);
    void *points = ss_list_grow(p->point, &p->points_room, p->n_points + n, sizeof *p->point);
    p->polygon = list != NULL ? list : p->polygon;
    p->point = points != NULL ? points : p->point;
    p->failed |= list == NULL || points == NULL;
    for (size_t i = 1; i < n; i++)
        area += point[i - 1][0] * point[i][1] - point[i][0] * point[i - 1][1];
    if (p->failed || area == 0)
        return;
    polygon *new = &p->polygon[p->n++];
    *new = (polygon){ fabs(area), p->line - ((area > 0) == high_left), p->n_points, 0 };
    for (size_t i = 0; i < n - 1; i = next_point(p->map, point, n, i)) {
        double *to = p->point[p->n_points++];
        to[0] = fmin(fmax(point[i][0] - 1, 0), CONTOUR_COLUMNS);        /* without the border */
        to[1] = fmin(fmax(point[i][1] - 1, 0), (double)(p->map->rows - 1));
    }
    new->n = p->n_points - new->first;
}

static int
larger_first(const void *a, const void *b)
{
    const polygon *p = a, *q = b;
    return p->area != q->area ? (p->area < q->area) - (p->area > q->area)
        : (p->first > q->first) - (p->first < q->first);
}

/* An area below the last line has the colour of the ground. */
ss_status
ss_contour_write_fill(FILE *out, const contour_map *map, int levels)
{
    size_t nx = CONTOUR_COLUMNS + 3, ny = map->rows + 2;
    painting p = { .map = map };
    double *height = malloc(nx * ny * sizeof *height);
    ss_status st = height != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < nx * ny; i++) {
        size_t x = i % nx, y = i / nx;
        height[i] = x == 0 || y == 0 || x == nx - 1 || y == ny - 1 ? -1e6 * CONTOUR_FLOOR
            : map->level[(y - 1) * (CONTOUR_COLUMNS + 1) + x - 1];
    }
    for (p.line = 1; st == SS_OK && p.line <= levels; p.line++) {
        const isoline_map heights = { nx, ny, height };
        st = ss_isolines(&heights, -p.line * map->span / levels, keep_polygon, &p);
        st = p.failed ? SS_ENOMEM : st;
    }
    if (st == SS_OK && p.n > 0)
        qsort(p.polygon, p.n, sizeof *p.polygon, larger_first);
    for (const polygon *area = p.polygon; st == SS_OK && area < p.polygon + p.n; area++) {
        if (area->n <= 2)
            continue;
        fputs("set object polygon from ", out);
        for (size_t i = 0; i <= area->n; i++)
            write_point(out, map, p.point[area->first + i % area->n], ",", i < area->n ? " to " : "");
        if (area->band < levels)
            ss_print(out, " back fc palette cb -%d.5*step fs solid 1 noborder\n", area->band);
        else
            fputs(" back fc rgb ground_colour fs solid 1 noborder\n", out);
    }
    free(height);
    free(p.polygon);
    free(p.point);
    return st;
}
