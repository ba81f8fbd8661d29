/* contour_fill.c -- fill the areas between lines of equal |W| with colours.
 *
 * The map is extended by a border of very low values, so that every line is closed.  Lines do not
 * cross: of two areas that they enclose, one contains the other, or they have nothing in common.
 * So the areas are painted in the order of their size, the largest first, each in the colour of
 * the level just inside its line.  Every level, with its holes, is then visible where it belongs.
 */
#include "plot/contour.h"

#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "plot/isoline.h"

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

/* Twice the area that a closed line encloses, > 0 if it lies on its left. */
static double
area_of(const double (*point)[2], size_t n)
{
    double area = 0;
    for (size_t i = 1; i < n; i++)
        area += point[i - 1][0] * point[i][1] - point[i][0] * point[i - 1][1];
    return area;
}

/* Append a point, given in the map with its border, as a point of the map. */
static void
keep_point(painting *p, const double at[2])
{
    double *to = p->point[p->n_points++];
    to[0] = fmin(fmax(at[0] - 1, 0), CONTOUR_COLUMNS);
    to[1] = fmin(fmax(at[1] - 1, 0), (double)(p->map->rows - 1));
}

static void
keep_polygon(const double (*point)[2], size_t n, int high_left, void *user)
{
    painting *p = user;
    double area = area_of(point, n);
    polygon *list = ss_list_room(p->polygon, &p->room, p->n, sizeof *list);
    void *points = ss_list_grow(p->point, &p->points_room, p->n_points + n, sizeof *p->point);
    p->polygon = list != NULL ? list : p->polygon;
    p->point = points != NULL ? points : p->point;
    p->failed |= list == NULL || points == NULL;
    if (p->failed || area == 0)
        return;
    polygon *new = &p->polygon[p->n++];
    *new = (polygon){ fabs(area), p->line - ((area > 0) == high_left), p->n_points, 0 };
    for (size_t i = 0; i < n - 1; i = ss_contour_next_point(p->map, point, n, i))
        keep_point(p, point[i]);
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
static void
write_polygon(FILE *out, const painting *p, const polygon *area, int levels)
{
    fputs("set object polygon from ", out);
    for (size_t i = 0; i <= area->n; i++)
        ss_contour_write_point(out, p->map, p->point[area->first + i % area->n], ',',
                               i < area->n ? " to " : "");
    if (area->band < levels)
        ss_print(out, " back fc palette cb -%d.5*step fs solid 1 noborder\n", area->band);
    else
        fputs(" back fc rgb ground_colour fs solid 1 noborder\n", out);
}

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
    for (size_t i = 0; st == SS_OK && i < p.n; i++)
        if (p.polygon[i].n > 2)
            write_polygon(out, &p, &p.polygon[i], levels);
    free(height);
    free(p.polygon);
    free(p.point);
    return st;
}
