/* maxima.c -- local maxima of |W| and how far they stand out.
 *
 * The prominence of a peak is its fall to the highest saddle between it and any higher peak.  From all
 * points of a basin (basins.c) a way rises to its peak, so two basins join at the highest point of
 * their border, and the borders alone say what flooding the whole map from above would say.  They are
 * sorted from the highest down.  Where a border joins two pools of basins, the pool with the lower
 * peak ends: the border is the saddle of that peak.
 *
 * A peak on the border of the map (its first or last scale, or beside the cone of influence) is
 * where the map was cut, not a maximum; it is not reported, but it is higher ground for others.  So
 * are places within the reach of gaps: a map cut there would fall apart into islands. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "find/basins.h"
#include "find/maxima.h"
#include "map/plan.h"

/* Sort peaks, the highest first, by counting their digits from the lowest to the highest. */
static ss_status
sort_borders(basins *b)
{
    enum { BITS = 11, DIGITS = 1 << BITS };
    static const uint64_t mask = DIGITS - 1;
    border *from = b->border, *to = malloc((b->n_borders + 1) * sizeof *to);
    if (to == NULL)
        return SS_ENOMEM;
    for (int shift = 0; shift < 64; shift += BITS) {
        size_t place[DIGITS] = { 0 }, sum = 0;
        for (size_t i = 0; i < b->n_borders; i++)
            place[from[i].key >> shift & mask]++;
        for (size_t d = DIGITS; d-- > 0;) {
            size_t count = place[d];
            place[d] = sum;
            sum += count;
        }
        for (size_t i = 0; i < b->n_borders; i++)
            to[place[from[i].key >> shift & mask]++] = from[i];
        border *swap = from;
        from = to;
        to = swap;
    }
    b->border = from;
    free(to);
    return SS_OK;
}

/* --- pools --------------------------------------------------------------------------------- */

/* The number of the highest peak in the pool of peak p.  pool[p] leads there; the way is halved for
 * the next call. */
static size_t
highest_of(size_t *pool, size_t p)
{
    while (pool[p] != p)
        p = pool[p] = pool[pool[p]];
    return p;
}

/* Find the saddle of each peak, where its pool ends; 0 if it does not end. */
static ss_status
find_saddles(double *saddle, const basins *b)
{
    size_t *pool = malloc((b->n_peaks + 1) * sizeof *pool);
    if (pool == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < b->n_peaks; i++) {
        pool[i] = i;
        saddle[i] = 0;
    }
    for (size_t i = 0; i < b->n_borders; i++) {
        size_t p = highest_of(pool, b->border[i].p), q = highest_of(pool, b->border[i].q);
        if (p == q)
            continue;
        double level = b->peak[p].level, other = b->peak[q].level;
        size_t high = level > other || (level == other && p < q) ? p : q, low = high == p ? q : p;
        pool[low] = high;
        memcpy(&saddle[low], &b->border[i].key, sizeof *saddle);
    }
    free(pool);
    return SS_OK;
}

/* --- maxima -------------------------------------------------------------------------------- */

static int
on_border(const basins *b, size_t row, size_t k)
{
    if (b->first < b->last && (row == b->first || row == b->last))
        return 1;
    return k == 0 || k + 1 == b->map->scale[row].n || ss_coefficients_edge(b->map, row, k)
        || ss_coefficients_edge(b->map, row, k - 1) || ss_coefficients_edge(b->map, row, k + 1);
}

static int
earlier_first(const void *a, const void *b)
{
    const ss_maximum *p = a, *q = b;
    return p->t != q->t ? (p->t > q->t) - (p->t < q->t)
        : (p->level < q->level) - (p->level > q->level);
}

/* Write the maxima of at least min_prominence to out, which has room for all peaks; levels are in dB
 * re top.  Returns their number. */
static size_t
list_maxima(ss_maximum *out, const basins *b, const double *saddle, double top, double min_prominence)
{
    size_t n = 0;
    double highest = 0;
    for (size_t i = 0; i < b->n_peaks; i++)
        highest = fmax(highest, b->peak[i].level);
    for (size_t i = 0; i < b->n_peaks; i++) {
        const peak *p = &b->peak[i];
        const ss_scale *scale = &b->map->scale[p->row];
        /* the highest alone has no saddle */
        double below = saddle[i] > 0 || p->level == highest ? saddle[i] : b->floor;
        double fall = below > 0 ? 20 * log10(p->level / below) : INFINITY;
        if (fall > 0 && fall >= min_prominence && !on_border(b, p->row, p->k))
            out[n++] = (ss_maximum){ ss_scale_b(scale, p->k), scale->f,
                                     20 * log10(p->level / top), fall };
    }
    return n;
}

/* Keep those of n maxima that are within range of the highest of them, in time order.  Returns their number. */
static size_t
keep_highest(ss_maximum *list, size_t n, double range)
{
    size_t kept = 0;
    double highest = -INFINITY;
    for (size_t i = 0; i < n; i++)
        highest = fmax(highest, list[i].level);
    for (size_t i = 0; i < n; i++)
        if (list[i].level >= highest - range)
            list[kept++] = list[i];
    qsort(list, kept, sizeof *list, earlier_first);
    return kept;
}

/* The maxima of these basins, in dB re top, in time order. */
static ss_status
report(ss_maximum **out, size_t *n, basins *b, double top, double range, double min_prominence)
{
    size_t count = 0;
    ss_maximum *list = malloc((b->n_peaks + 1) * sizeof *list), *fitting = NULL;
    double *saddle = malloc((b->n_peaks + 1) * sizeof *saddle);
    ss_status st = list != NULL && saddle != NULL ? sort_borders(b) : SS_ENOMEM;
    if (st == SS_OK && (st = find_saddles(saddle, b)) == SS_OK) {
        count = keep_highest(list, list_maxima(list, b, saddle, top, min_prominence), range);
        fitting = realloc(list, (count + 1) * sizeof *list);
    }
    free(saddle);
    if (fitting == NULL) {
        free(list);
        return st != SS_OK ? st : SS_ENOMEM;
    }
    *out = fitting;
    *n = count;
    return SS_OK;
}

ss_status
ss_maxima_above(ss_maximum **out, size_t *n, const ss_coefficients *map, double min_prominence,
                double floor, double *top)
{
    basins b;
    ss_status st = ss_basins_find(&b, map, 0, map->n_scales - 1, floor);
    if (st == SS_OK) {
        *top = b.top;
        st = report(out, n, &b, b.top, INFINITY, min_prominence);
    }
    ss_basins_free(&b);
    return st;
}

ss_status
ss_maxima_of_row(ss_maximum **out, size_t *n, const ss_coefficients *map, size_t row, double top,
                 double range, double min_prominence)
{
    basins b;
    ss_status st = ss_basins_find(&b, map, row, row, 0);
    if (st == SS_OK)
        st = report(out, n, &b, top, range, min_prominence);
    ss_basins_free(&b);
    return st;
}

ss_status
ss_maxima_find(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, double min_prominence,
               ss_error *err)
{
    double top;
    if (out == NULL || n == NULL || coefficients == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_maxima_above(out, n, coefficients, min_prominence, 0, &top);
    return st == SS_OK ? st : ss_fail(err, st, "%s", ss_strerror(st));
}

ss_status
ss_maxima_along(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
                double range, double min_prominence, ss_error *err)
{
    if (out == NULL || n == NULL || coefficients == NULL)
        return SS_FAIL_NULL(err);
    if (scale >= coefficients->n_scales)
        return ss_fail(err, SS_EINVAL, "scale %zu of %zu", scale + 1, coefficients->n_scales);
    ss_status st = ss_maxima_of_row(out, n, coefficients, scale, ss_coefficients_max(coefficients), range,
                                    min_prominence);
    return st == SS_OK ? st : ss_fail(err, st, "%s", ss_strerror(st));
}
