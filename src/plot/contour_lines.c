/* contour_lines.c -- lines of equal |W|.
 *
 * |W| is mapped to a rectangle as wide as the picture, one row a scale.  A column has the largest
 * |W| of its translations, so that no spike is lost; between translations farther apart |W| is
 * interpolated linearly.  The script contains the lines of equal level, with the fewest points that
 * keep them within a fraction of a pixel. */
#include "plot/contour.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/progress.h"
#include "plot/isoline.h"

#define ROWS 580                /* pixels that panel (b) is high, about */
#define BLUR 0.2                /* pixels by which a line may move if points are left out */
#define FLOOR 1000.0            /* [dB] below the largest |W|: the level of |W| = 0 */

/* --- the map ------------------------------------------------------------------------------- */

static double
magnitude(const double *w, size_t k)
{
    return hypot(w[2 * k], w[2 * k + 1]);
}

/* |W| of a scale in the column of time [lo, hi], from the first sample. */
static double
in_column(const ss_scale *scale, const double *w, double lo, double hi)
{
    double step = scale->b_num / scale->b_den, at = (lo + hi) / 2 / step;
    size_t last = scale->n - 1, k = at > 0 ? (size_t)fmin(at, (double)last) : 0;
    double part = fmin(fmax(at - (double)k, 0), 1);
    double level = magnitude(w, k);
    if (k < last)
        level += part * (magnitude(w, k + 1) - level);
    for (k = lo > 0 ? (size_t)fmin(ceil(lo / step), (double)last) : 0;
         k <= last && (double)k * step <= hi; k++)
        level = fmax(level, magnitude(w, k));
    return level;
}

/* The largest |W| of scale i, outside the cone of influence and anywhere; returns 0 if a |W| is not
 * finite. */
static int
find_largest(const ss_coefficients *c, size_t i, const double *w, double most[2])
{
    for (size_t k = 0; k < c->scale[i].n; k++) {
        double level = magnitude(w, k);
        if (!isfinite(level))
            return 0;
        most[1] = fmax(most[1], level);
        if (level > most[0] && !ss_coefficients_edge(c, i, k))
            most[0] = level;
    }
    return 1;
}

/* |W|, CONTOUR_COLUMNS + 1 of them a scale, and the results of find_largest. */
static ss_status
fill_map(double *map, const ss_coefficients *c, const ss_contour_opts *contour,
         const script_span *span, double *own, double most[2], ss_error *err)
{
    double width = (span->to - span->from) / CONTOUR_COLUMNS;
    for (size_t s = 0; s < c->n_scales; s++) {
        const double *w = own != NULL ? own : c->w + 2 * c->scale[s].offset;
        ss_status st = own != NULL ? contour->source(s, own, contour->source_user, err) : SS_OK;
        if (st != SS_OK)
            return st;
        if (!find_largest(c, s, w, most))
            return ss_fail(err, SS_EINVAL, "|W| at %g Hz cannot be drawn: a value is not finite",
                           c->scale[s].f);
        for (size_t i = 0; i <= CONTOUR_COLUMNS; i++) {
            double t = span->from - c->head->start + (double)i * width;
            map[s * (CONTOUR_COLUMNS + 1) + i] = in_column(&c->scale[s], w, t - width / 2, t + width / 2);
        }
        if (ss_progress_at(&contour->progress, (double)(s + 1) / (double)c->n_scales) != SS_OK)
            return SS_STOP;
    }
    return SS_OK;
}

ss_status
ss_contour_map(double **out, const ss_coefficients *c, const ss_contour_opts *contour,
         const script_span *span, ss_error *err)
{
    size_t cells = c->n_scales * (CONTOUR_COLUMNS + 1), longest = 0;
    double most[2] = { -1, 0 }, *own = NULL;
    for (size_t s = 0; s < c->n_scales; s++)
        longest = c->scale[s].n > longest ? c->scale[s].n : longest;
    double *map = *out = malloc(cells * sizeof *map);
    if (c->w == NULL)
        own = malloc(2 * longest * sizeof *own);
    ss_status st = map == NULL || (c->w == NULL && own == NULL) ? SS_ENOMEM
        : fill_map(map, c, contour, span, own, most, err);
    free(own);
    if (st == SS_ENOMEM)
        return ss_fail_memory(err, NULL);
    double max = most[0] >= 0 ? most[0] : most[1];
    for (size_t i = 0; st == SS_OK && i < cells; i++)
        map[i] = max > 0 && map[i] > 0
            ? fmin(fmax(20 * log10(map[i] / max), -FLOOR), FLOOR) : -FLOOR;
    return st;
}

/* --- its lines ----------------------------------------------------------------------------- */

typedef struct line_sink {
    FILE *out;
    const ss_coefficients *c;
    const script_span *span;
    int level;                  /* its number */
    size_t lines;               /* of this level, so far */
} line_sink;

static void
write_point(const line_sink *sink, const double point[2])
{
    const ss_scale *scale = sink->c->scale;
    double range = sink->span->to - sink->span->from;
    size_t row = (size_t)fmin(point[1], (double)(sink->c->n_scales - 2));
    double part = point[1] - (double)row;
    double f = scale[row].f * pow(scale[row + 1].f / scale[row].f, part);
    ss_script_write(sink->out, sink->span->from + point[0] / CONTOUR_COLUMNS * range,
                    ss_script_decimals(range), " ");
    ss_script_write(sink->out, f, 3 - (int)floor(log10(f)), "");
    fprintf(sink->out, " %d\n", sink->level);
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

static void
write_line(const double (*point)[2], size_t n, void *user)
{
    line_sink *sink = user;
    double row = (double)ROWS / (double)(sink->c->n_scales - 1);    /* pixels */
    write_point(sink, point[0]);
    for (size_t first = 0, last; first < n - 1; first = last) {
        for (last = first + 1; last + 1 < n && last - first < 64
             && is_straight(point, first, last + 1, row); last++)
            ;
        write_point(sink, point[last]);
    }
    putc('\n', sink->out);
    sink->lines++;
}

ss_status
ss_contour_write_lines(FILE *out, const ss_coefficients *c, const ss_contour_opts *contour,
               const script_span *span, const double *level, int *any)
{
    char drawn[CONTOUR_LEVELS * sizeof " 100"] = "";
    line_sink sink = { out, c, span, 0, 0 };
    const isoline_map map = { CONTOUR_COLUMNS + 1, c->n_scales, level };
    ss_status status = SS_OK;
    fputs("$contour << EOD\n", out);
    for (int k = 1; status == SS_OK && k <= contour->levels; k++) {
        sink.level = k;
        sink.lines = 0;
        status = ss_isolines(&map, -k * contour->span / contour->levels, write_line, &sink);
        if (sink.lines > 0) {
            putc('\n', out);
            snprintf(drawn + strlen(drawn), sizeof drawn - strlen(drawn), " %d", k);
        }
    }
    *any = drawn[0] != '\0';
    fprintf(out, "EOD\ndrawn = '%s'     # levels that have lines\n", drawn + (drawn[0] == ' '));
    return status;
}
