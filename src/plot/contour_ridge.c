/* contour_ridge.c -- find the ridges of a map of |W|: at each time, the scales of its maxima. */
#include "plot/contour.h"

#include <math.h>
#include "map/wavelet.h"
#include "signal/gaps.h"

#define RISE 3.0                /* [dB] of a ridge above the saddles beside it */

/* A column of the map: its level at row r is level[r * (CONTOUR_COLUMNS + 1)]. */
static double
at(const double *level, size_t r)
{
    return level[r * (CONTOUR_COLUMNS + 1)];
}

/* Does the column fall by RISE from row r, in the direction of step, before it is higher than there? */
static int
falls(const double *level, size_t rows, size_t r, size_t step)
{
    double least = at(level, r);
    for (size_t i = r + step; i < rows; i += step) {        /* -1 is SIZE_MAX here */
        if (at(level, i) > at(level, r))
            break;
        least = fmin(least, at(level, i));
    }
    return least <= at(level, r) - RISE;
}

/* ln f of the parabola's top through three rows. */
static double
top_of(const contour_map *map, const double *level, size_t r)
{
    double x0 = log(map->f[r - 1]), x1 = log(map->f[r]), x2 = log(map->f[r + 1]);
    double left = (at(level, r) - at(level, r - 1)) / (x1 - x0);
    double right = (at(level, r + 1) - at(level, r)) / (x2 - x1);
    double curve = (right - left) / (x2 - x0);
    return curve < 0 ? fmin(fmax((x0 + x1) / 2 - left / (2 * curve), x0), x2) : x1;
}

/* Is the time within the cone of influence at label f? */
static int
in_cone(const ss_coefficients *c, double t, double f)
{
    double start = c->head->start, reach = wavelet_cone(c->center / (2 * M_PI * f));
    return t < start + reach || t > start + (double)(c->n - 1) / c->head->rate - reach
        || (c->n_gaps > 0 && ss_gaps_near(c->gap, c->n_gaps, t, reach));
}

size_t
ss_contour_ridge(const contour_map *map, const ss_coefficients *c,
                 void (*visit)(double t, double f, double level, void *user), void *user)
{
    size_t n = 0;
    for (size_t i = 0; i <= CONTOUR_COLUMNS; i++)
        for (size_t r = 1; r + 1 < map->rows; r++) {
            const double *level = map->level + i;
            double t = map->from + (double)i / CONTOUR_COLUMNS * (map->to - map->from), here = at(level, r);
            if (here < -map->span || here <= at(level, r - 1) || here < at(level, r + 1)
                || !falls(level, map->rows, r, 1) || !falls(level, map->rows, r, (size_t)-1))
                continue;
            double f = exp(top_of(map, level, r));
            if (in_cone(c, t, f))
                continue;
            visit(t, f, here, user);
            n++;
        }
    return n;
}
