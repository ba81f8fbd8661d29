/* isoline.c -- lines of equal height on a rectangle of heights, traced from cell to cell.
 *
 * Linear interpolation gives the point at which a line crosses the side of a cell.  If all four
 * sides of a cell are crossed (a saddle), the mean of its corners decides which crossings are
 * joined.  Every crossed side belongs to one line and is passed once.  So all lines of a level
 * need one test of every side and one step for each crossing.  (gnuplot's own contouring searches
 * for each new line from the start of a list: 4 s for a clean signal, 10 s and more for noise.) */
#include "plot/isoline.h"

#include <stdlib.h>

typedef struct tracer {
    const isoline_map *map;
    double level;
    unsigned char *passed;      /* sides, numbered by side_index */
    double (*point)[2];         /* of the line being traced */
} tracer;

/* The sides of cell (i, j) are numbered around it: 0 below, 1 right, 2 above, 3 left. */
typedef struct cell_side {
    size_t i, j;
    int side;
} cell_side;

static double
height(const tracer *t, size_t i, size_t j)
{
    return t->map->height[j * t->map->nx + i];
}

/* The ends of a side: from (i, j) to its neighbour on the right, or above it. */
static void
side_ends(cell_side p, size_t from[2], size_t to[2])
{
    from[0] = p.i + (p.side == 1);
    from[1] = p.j + (p.side == 2);
    to[0] = from[0] + (p.side == 0 || p.side == 2);
    to[1] = from[1] + (p.side == 1 || p.side == 3);
}

static size_t
side_index(const tracer *t, cell_side p)
{
    size_t from[2], to[2];
    side_ends(p, from, to);
    return 2 * (from[1] * t->map->nx + from[0]) + (p.side == 1 || p.side == 3);
}

static int
is_crossed(const tracer *t, cell_side p)
{
    size_t from[2], to[2];
    side_ends(p, from, to);
    return (height(t, from[0], from[1]) >= t->level) != (height(t, to[0], to[1]) >= t->level);
}

static void
cross(tracer *t, cell_side p, size_t n)
{
    size_t from[2], to[2];
    side_ends(p, from, to);
    double lo = height(t, from[0], from[1]), hi = height(t, to[0], to[1]);
    double part = (t->level - lo) / (hi - lo);
    t->point[n][0] = (double)from[0] + part * (double)(to[0] - from[0]);
    t->point[n][1] = (double)from[1] + part * (double)(to[1] - from[1]);
    t->passed[side_index(t, p)] = 1;
}

/* The side through which a line leaves the cell that it entered through p.side. */
static int
exit_side(const tracer *t, cell_side p)
{
    int crossed = 0, other = p.side;
    for (int side = 0; side < 4; side++)
        if (is_crossed(t, (cell_side){ p.i, p.j, side })) {
            crossed++;
            other = side != p.side ? side : other;
        }
    if (crossed < 4)
        return other;
    double corner = height(t, p.i, p.j);
    double mean = (corner + height(t, p.i + 1, p.j) + height(t, p.i, p.j + 1) + height(t, p.i + 1, p.j + 1)) / 4;
    return (mean >= t->level) == (corner >= t->level) ? p.side ^ 1 : 3 - p.side;
}

/* Trace the line that enters a cell through p.side, to its end or back to its start, unless there is none, or it
 * was traced before. */
static void
trace(tracer *t, cell_side p, isoline_sink *sink, void *user)
{
    static const int dx[] = { 0, 1, 0, -1 }, dy[] = { -1, 0, 1, 0 };
    size_t n = 0, end[2][2];
    if (!is_crossed(t, p) || t->passed[side_index(t, p)])
        return;
    side_ends(p, end[0], end[1]);
    const size_t *left = end[p.side >= 2];      /* on the way into the cell through the side */
    int high_left = height(t, left[0], left[1]) >= t->level;
    cross(t, p, n++);
    for (int inside = 1; inside; ) {
        p.side = exit_side(t, p);
        if (t->passed[side_index(t, p)]) {
            t->point[n][0] = t->point[0][0];
            t->point[n][1] = t->point[0][1];
            n++;
            break;
        }
        cross(t, p, n++);
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
