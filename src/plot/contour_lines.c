/* contour_lines.c -- write lines of equal |W|, with the fewest points that keep them within a
 * fraction of a pixel. */
#include "plot/contour.h"

#include <math.h>
#include <string.h>
#include "plot/isoline.h"

#define BLUR 0.2                /* a line may move by so many pixels when points are left out */

void
ss_contour_write_point(FILE *out, const contour_map *map, const double point[2], char between,
                       const char *behind)
{
    const char separator[2] = { between, '\0' };
    double range = map->to - map->from;
    size_t row = (size_t)fmin(point[1], (double)(map->rows - 2));
    double part = point[1] - (double)row, f = map->f[row] * pow(map->f[row + 1] / map->f[row], part);
    ss_script_write(out, map->from + point[0] / CONTOUR_COLUMNS * range,
                    ss_script_decimals(range), separator);
    ss_script_write(out, f, 3 - (int)floor(log10(f)), behind);
}

/* May the points between first and last be left out? */
static int
is_straight(const double (*point)[2], size_t first, size_t last, double row)
{
    double dx = point[last][0] - point[first][0], dy = (point[last][1] - point[first][1]) * row;
    double length = hypot(dx, dy);
    for (size_t i = first + 1; i < last; i++) {
        double x = point[i][0] - point[first][0], y = (point[i][1] - point[first][1]) * row;
        double along = x * dx + y * dy, off = fabs(x * dy - y * dx);
        if (!(off <= BLUR * length && along >= 0 && along <= length * length))
            return 0;
    }
    return 1;
}

size_t
ss_contour_next_point(const contour_map *map, const double (*point)[2], size_t n, size_t first)
{
    double row = (double)CONTOUR_ROWS / (double)(map->rows - 1);        /* pixels */
    size_t last = first + 1;
    while (last + 1 < n && last - first < 64 && is_straight(point, first, last + 1, row))
        last++;
    return last;
}

/* --- the lines of a level ------------------------------------------------------------------ */

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
    ss_contour_write_point(sink->out, sink->map, point[0], ' ', sink->behind);
    for (size_t i = 0; i < n - 1;) {
        i = ss_contour_next_point(sink->map, point, n, i);
        ss_contour_write_point(sink->out, sink->map, point[i], ' ', sink->behind);
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
