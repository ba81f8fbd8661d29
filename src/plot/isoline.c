/* isoline.c -- lines of equal height on a rectangle of heights, traced from cell to cell.
 *
 * Linear interpolation gives the point at which a line crosses the side of a cell.  If all four
 * sides of a cell are crossed (a saddle), the mean of its corners decides which crossings are
 * joined.  Every crossed side belongs to one line and is passed once.  So all lines of a level
 * need one test of every side and one step for each crossing.  (gnuplot's own contouring searches
 * for each new line from the start of a list: 4 s for a clean signal, 10 s and more for noise.) */
#include "plot/isoline.h"

#include <stdlib.h>
#include <string.h>

typedef struct tracer {
    const isoline_map *map;
    double level;
    unsigned char *passed;      /* sides, numbered from point to point: that to the right, and that above */
    double (*point)[2];         /* of the line being traced */
} tracer;

/* The sides of cell (i, j) are numbered around it: 0 below, 1 right, 2 above, 3 left. */
typedef struct cell_side {
    size_t i, j;
    int side;
} cell_side;

/* A side leads from a point of the grid to its neighbour on the right, or above it. */
typedef struct edge {
    size_t x, y, number;
    int upright, crossed;
    double from, to;            /* the heights at its ends */
} edge;

static edge
edge_of(const tracer *t, cell_side p)
{
    edge e = { .x = p.i + (p.side == 1), .y = p.j + (p.side == 2), .upright = p.side % 2 };
    size_t at = e.y * t->map->nx + e.x;
    e.number = 2 * at + (size_t)e.upright;
    e.from = t->map->height[at];
    e.to = t->map->height[at + (e.upright ? t->map->nx : 1)];
    e.crossed = (e.from >= t->level) != (e.to >= t->level);
    return e;
}

static void
cross(tracer *t, const edge *e, size_t n)
{
    double part = (t->level - e->from) / (e->to - e->from);
    t->point[n][0] = (double)e->x + (e->upright ? 0 : part);
    t->point[n][1] = (double)e->y + (e->upright ? part : 0);
    t->passed[e->number] = 1;
}

/* The side through which a line leaves the cell that it entered through p.side. */
static int
exit_side(const tracer *t, cell_side p)
{
    int crossed = 0, other = p.side;
    for (int side = 0; side < 4; side++)
        if (edge_of(t, (cell_side){ p.i, p.j, side }).crossed) {
            crossed++;
            other = side != p.side ? side : other;
        }
    if (crossed < 4)
        return other;
    edge below = edge_of(t, (cell_side){ p.i, p.j, 0 }), above = edge_of(t, (cell_side){ p.i, p.j, 2 });
    double mean = (below.from + below.to + above.from + above.to) / 4;
    return (mean >= t->level) == (below.from >= t->level) ? p.side ^ 1 : 3 - p.side;
}

/* Trace the line that enters a cell through p.side, to its end or back to its start, unless there is none, or it
 * was traced before. */
static void
trace(tracer *t, cell_side p, isoline_sink *sink, void *user)
{
    static const int dx[] = { 0, 1, 0, -1 }, dy[] = { -1, 0, 1, 0 };
    size_t n = 0;
    edge e = edge_of(t, p);
    if (!e.crossed || t->passed[e.number])
        return;
    int high_left = (p.side >= 2 ? e.to : e.from) >= t->level;          /* on the way into the cell */
    cross(t, &e, n++);
    for (int inside = 1; inside;) {
        p.side = exit_side(t, p);
        e = edge_of(t, p);
        if (t->passed[e.number]) {
            memcpy(t->point[n++], t->point[0], sizeof *t->point);
            break;
        }
        cross(t, &e, n++);
        p.i += (size_t)dx[p.side];              /* into the cell beyond the side; -1 is SIZE_MAX here */
        p.j += (size_t)dy[p.side];
        p.side = (p.side + 2) % 4;
        inside = p.i < t->map->nx - 1 && p.j < t->map->ny - 1;
    }
    sink((const double (*)[2])t->point, n, high_left, user);
}

ss_status
ss_isolines(const isoline_map *map, double level, isoline_sink *sink, void *user)
{
    size_t sides = 2 * map->nx * map->ny;
    tracer t = { map, level, calloc(sides, 1), malloc((sides + 2) * sizeof *t.point) };
    ss_status status = t.passed != NULL && t.point != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; status == SS_OK && i + 1 < map->nx; i++) {
        trace(&t, (cell_side){ i, 0, 0 }, sink, user);
        trace(&t, (cell_side){ i, map->ny - 2, 2 }, sink, user);
    }
    for (size_t j = 0; status == SS_OK && j + 1 < map->ny; j++) {
        trace(&t, (cell_side){ 0, j, 3 }, sink, user);
        trace(&t, (cell_side){ map->nx - 2, j, 1 }, sink, user);
    }
    for (size_t j = 0; status == SS_OK && j + 1 < map->ny; j++)
        for (size_t i = 0; i + 1 < map->nx; i++)
            trace(&t, (cell_side){ i, j, 0 }, sink, user);   /* every closed line crosses one */
    free(t.passed);
    free(t.point);
    return status;
}
