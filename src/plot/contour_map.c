/* contour_map.c -- the map of |W| that a contour plot shows, and its ridges.
 *
 * The map has as many columns as the picture, and a row for each scale.  A column has the largest
 * |W| of its translations, so that no spike is lost.  Where translations are farther apart than
 * columns, |W| is interpolated linearly. */
#include "plot/contour.h"

#include <math.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/progress.h"
#include "map/map.h"
#include "signal/gaps.h"

#define LEAST_SPAN 10.0         /* [dB] that lines span, however high the noise is */
#define RISE 3.0                /* [dB] of a ridge above the saddles beside it */

/* The map while it is filled. */
typedef struct filling {
    const ss_coefficients *c;
    const ss_contour_opts *contour;
    size_t first;               /* scale of the first row */
    double outside;             /* the largest |W| outside the cone of influence; -1: none is outside */
    double anywhere;            /* the largest |W| */
    noise_level *noise;         /* NULL: not measured */
} filling;

/* The |W| of a scale in the column of the times lo ... hi from the first sample. */
static double
in_column(const ss_scale *scale, const double *level, double lo, double hi)
{
    double step = scale->b_num / scale->b_den, at = (lo + hi) / 2 / step;
    size_t last = scale->n - 1, k = at > 0 ? (size_t)fmin(at, (double)last) : 0;
    double part = fmin(fmax(at - (double)k, 0), 1);
    double here = level[k];
    if (k < last)
        here += part * (level[k + 1] - here);
    for (k = lo > 0 ? (size_t)fmin(ceil(lo / step), (double)last) : 0;
         k <= last && (double)k * step <= hi; k++)
        here = fmax(here, level[k]);
    return here;
}

/* Fill the rows with |W|, and find the largest |W| and the noise of all scales. */
static ss_status
fill_rows(contour_map *map, filling *f, double *level, ss_error *err)
{
    const ss_coefficients *c = f->c;
    double width = (map->to - map->from) / CONTOUR_COLUMNS;
    for (size_t s = 0; s < c->n_scales; s++) {
        ss_status st = ss_map_read(c, &(ss_map_part){ s, 0, c->scale[s].n, NULL, level }, 1, err);
        if (st != SS_OK)
            return st;
        for (size_t k = 0; k < c->scale[s].n; k++) {
            if (!isfinite(level[k]))
                return ss_fail(err, SS_EINVAL, "|W| at %g Hz cannot be drawn: a value is not finite",
                               c->scale[s].f);
            f->anywhere = fmax(f->anywhere, level[k]);
            int is_known = f->noise == NULL && (f->contour->top > 0 || level[k] <= f->outside);
            if (is_known || ss_coefficients_edge(c, s, k))
                continue;
            f->outside = fmax(f->outside, level[k]);
            if (f->noise != NULL)
                ss_noise_level_add(f->noise, &c->scale[s], s, &level[k], k, 1);
        }
        for (size_t i = 0; s >= f->first && s - f->first < map->rows && i <= CONTOUR_COLUMNS; i++) {
            double t = map->from - c->head->start + (double)i * width;
            map->level[(s - f->first) * (CONTOUR_COLUMNS + 1) + i]
                = in_column(&c->scale[s], level, t - width / 2, t + width / 2);
        }
        if (ss_progress_at(&f->contour->progress, (double)(s + 1) / (double)c->n_scales) != SS_OK)
            return SS_STOP;
    }
    return SS_OK;
}

/* If fmin and fmax are given, replace the first row by the map at the label fmin, the last by that at fmax. */
static void
cut_rows(contour_map *map, double fmin, double fmax)
{
    size_t last = map->rows - 1, columns = CONTOUR_COLUMNS + 1;
    double *f = map->f, *top = map->level + last * columns;
    double lo = fmin > f[0] ? log(fmin / f[0]) / log(f[1] / f[0]) : 0;
    double hi = fmax < f[last] && fmax > 0 ? log(fmax / f[last - 1]) / log(f[last] / f[last - 1]) : 1;
    for (size_t i = 0; i < columns; i++) {
        double *bottom = map->level + i, below = map->level[(last - 1) * columns + i];
        double at_lo = bottom[0] + lo * (bottom[columns] - bottom[0]);
        top[i] = below + hi * (top[i] - below);
        bottom[0] = at_lo;
    }
    f[0] = lo > 0 ? fmin : f[0];
    f[last] = hi < 1 ? fmax : f[last];
}

void
ss_contour_map_free(contour_map *map)
{
    free(map->f);
    free(map->level);
}

/* The scales that are drawn are those within the labels, and one more beyond each end. */
ss_status
ss_contour_map(contour_map *map, const ss_coefficients *c, const ss_contour_opts *contour,
               const script_span *span, ss_error *err)
{
    filling f = { .c = c, .contour = contour, .outside = -1 };
    const ss_scale *scale = c->scale;
    size_t longest = 0, last = c->n_scales - 1;
    double start = c->head->start, end = start + (double)c->n / c->head->rate;
    double lo = fmax(contour->fmin, scale[0].f);
    double hi = contour->fmax > 0 ? fmin(contour->fmax, scale[last].f) : scale[last].f;
    *map = (contour_map){ .span_of_time = span, .from = fmax(span->from, start), .to = fmin(span->to, end) };
    if (!(lo < hi))
        return ss_fail(err, SS_EINVAL, "nothing to draw from %g Hz to %g Hz; the coefficients go from %g Hz to "
                       "%g Hz", contour->fmin, contour->fmax > 0 ? contour->fmax : hi, scale[0].f, scale[last].f);
    while (scale[f.first + 1].f <= lo)
        f.first++;
    while (scale[last - 1].f >= hi)
        last--;
    map->rows = last - f.first + 1;
    for (size_t s = 0; s < c->n_scales; s++)
        longest = scale[s].n > longest ? scale[s].n : longest;
    map->f = malloc(map->rows * sizeof *map->f);
    map->level = malloc(map->rows * (CONTOUR_COLUMNS + 1) * sizeof *map->level);
    double *level = malloc(longest * sizeof *level);
    f.noise = isnan(contour->noise) ? ss_noise_level_new(c->n_scales) : NULL;
    int made = map->f != NULL && map->level != NULL && level != NULL
        && (!isnan(contour->noise) || f.noise != NULL);
    for (size_t i = 0; made && i < map->rows; i++)
        map->f[i] = scale[f.first + i].f;
    ss_status st = made ? fill_rows(map, &f, level, err) : ss_fail_memory(err, NULL);
    double max = !isnan(contour->level) ? pow(10, contour->level / 20)
        : contour->top > 0 ? contour->top : f.outside >= 0 ? f.outside : f.anywhere;
    double noise = st == SS_OK && f.noise != NULL ? ss_noise_level(f.noise, scale) : contour->noise;
    for (size_t i = 0; st == SS_OK && i < map->rows * (CONTOUR_COLUMNS + 1); i++)       /* decibels */
        map->level[i] = max > 0 && map->level[i] > 0
            ? fmin(fmax(20 * log10(map->level[i] / max), -CONTOUR_FLOOR), CONTOUR_FLOOR) : -CONTOUR_FLOOR;
    map->top = max;
    map->span = contour->span;
    map->noise = max > 0 && noise > 0 ? round(20 * log10(noise / max)) : NAN;
    if (!(map->noise > -map->span))
        map->noise = NAN;
    if (!isnan(map->noise))
        map->span = fmin(fmax(-map->noise, LEAST_SPAN), map->span);
    if (st == SS_OK)
        cut_rows(map, contour->fmin, contour->fmax);
    ss_noise_level_free(f.noise);
    free(level);
    return st;
}

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

/* A point is the top of the parabola through three rows.  In the scale, 1 / f, that of a steady oscillation is a
 * parabola, but for the factor a^1/2 of a norm. */
size_t
ss_contour_ridge(const contour_map *map, const ss_coefficients *c,
                 void (*visit)(double t, double f, double level, void *user), void *user)
{
    size_t n = 0;
    double start = c->head->start, end = start + (double)(c->n - 1) / c->head->rate;
    for (size_t i = 0; i <= CONTOUR_COLUMNS; i++)
        for (size_t r = 1; r + 1 < map->rows; r++) {
            const double *level = map->level + i;
            double t = map->from + (double)i / CONTOUR_COLUMNS * (map->to - map->from), here = at(level, r);
            if (here < -map->span || here <= at(level, r - 1) || here < at(level, r + 1)
                || !falls(level, map->rows, r, 1) || !falls(level, map->rows, r, (size_t)-1))
                continue;
            double x0 = 1 / map->f[r + 1], x1 = 1 / map->f[r], x2 = 1 / map->f[r - 1];
            double left = (here - at(level, r + 1)) / (x1 - x0), right = (at(level, r - 1) - here) / (x2 - x1);
            double curve = (right - left) / (x2 - x0);
            double x = curve < 0 ? fmin(fmax((x0 + x1) / 2 - left / (2 * curve), x0), x2) : x1;
            double f = 1 / x, cone = wavelet_cone(c->center / (2 * M_PI * f));
            if (t < start + cone || t > end - cone || (c->n_gaps > 0 && ss_gaps_near(c->gap, c->n_gaps, t, cone)))
                continue;
            visit(t, f, here + (x - x1) * (left + curve * (x - x0)), user);
            n++;
        }
    return n;
}
