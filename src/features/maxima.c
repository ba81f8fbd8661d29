/* maxima.c -- local maxima of |W| and how far they stand out.
 *
 * Flooding from above: points are taken from the highest down, each joining the pools of its
 * neighbours that are under water already.  A point with none is a peak and starts a pool; where
 * two pools meet, the one with the lower peak ends, and that point is the highest saddle between
 * this peak and any higher one: the prominence is the fall from peak to saddle.  Cost: a sort.
 *
 * A peak on the border of the map (its first or last scale, or beside the cone of influence) is
 * where the map was cut, not a maximum; it is not reported, but it is higher ground for others.  So
 * is what gaps reach: a map cut there would make islands of what lies between. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "maxima.h"

#define NONE SIZE_MAX

typedef struct point {
    uint64_t key;               /* |W|, > 0, as its bits, which are ordered as the numbers are */
    size_t at;                  /* the coefficient, counted from the first row's first */
} point;

typedef struct map {
    const ss_coefficients *coef;
    size_t first, last;         /* rows looked at */
    double floor;               /* lower levels are not looked at; 0: all are */
    size_t n;                   /* points, highest first */
    point *point;
    size_t *pool;               /* of a coefficient: towards its pool's peak, which is its own; NONE: dry */
    size_t *rank;               /* of a peak among the points */
    double *saddle;             /* of a peak: the level where its pool ended, 0 if it did not */
} map;

static double
level_of(uint64_t key)
{
    double level;
    memcpy(&level, &key, sizeof level);
    return level;
}

static size_t
index_of(const map *m, size_t row, size_t k)
{
    return m->coef->scale[row].offset - m->coef->scale[m->first].offset + k;
}

static size_t
row_of(const map *m, size_t at)
{
    size_t low = m->first, high = m->last;
    while (low < high) {
        size_t mid = high - (high - low) / 2;
        if (index_of(m, mid, 0) <= at)
            low = mid;
        else
            high = mid - 1;
    }
    return low;
}

static void
map_free(map *m)
{
    free(m->point);
    free(m->pool);
    free(m->rank);
    free(m->saddle);
}

/* Highest first, equals as they stand, by counting digits from the lowest to the highest; sorted
 * into *from, with room for as many in *to. */
static void
sort_points(point **from, point **to, size_t n)
{
    enum { BITS = 11, DIGITS = 1 << BITS };
    static const uint64_t mask = DIGITS - 1;
    for (int shift = 0; shift < 64; shift += BITS) {
        size_t place[DIGITS] = { 0 }, sum = 0;
        for (size_t i = 0; i < n; i++)
            place[(*from)[i].key >> shift & mask]++;
        for (size_t d = DIGITS; d-- > 0;) {
            size_t count = place[d];
            place[d] = sum;
            sum += count;
        }
        for (size_t i = 0; i < n; i++)
            (*to)[place[(*from)[i].key >> shift & mask]++] = (*from)[i];
        point *swap = *from;
        *from = *to;
        *to = swap;
    }
}

static void
take_points(map *m)
{
    for (size_t row = m->first; row <= m->last; row++) {
        const ss_scale *scale = &m->coef->scale[row];
        for (size_t k = 0; k < scale->n; k++) {
            const double *w = m->coef->w + 2 * (scale->offset + k);
            point p = { .at = index_of(m, row, k) };
            double level = hypot(w[0], w[1]);
            if (!(level > m->floor) || ss_scale_edge(scale, k, m->coef->n, m->coef->head->rate))
                continue;
            memcpy(&p.key, &level, sizeof level);
            m->point[m->n++] = p;
        }
    }
}

static ss_status
map_new(map *m, const ss_coefficients *coef, size_t first, size_t last, double floor)
{
    *m = (map){ .coef = coef, .first = first, .last = last, .floor = floor };
    size_t room = index_of(m, last, coef->scale[last].n) + 1;
    point *other = malloc(room * sizeof *other);
    m->point = malloc(room * sizeof *m->point);
    if (other != NULL && m->point != NULL) {
        take_points(m);
        sort_points(&m->point, &other, m->n);
    }
    free(other);
    m->pool = malloc(room * sizeof *m->pool);
    m->rank = malloc(room * sizeof *m->rank);
    m->saddle = calloc(room, sizeof *m->saddle);
    if (other == NULL || m->point == NULL || m->pool == NULL || m->rank == NULL
        || m->saddle == NULL) {
        map_free(m);
        return SS_ENOMEM;
    }
    for (size_t i = 0; i < room; i++)
        m->pool[i] = NONE;
    return SS_OK;
}

/* The peak of a wet point's pool; the way there is halved for the next one who asks. */
static size_t
peak_of(map *m, size_t i)
{
    while (m->pool[i] != i) {
        m->pool[i] = m->pool[m->pool[i]];
        i = m->pool[i];
    }
    return i;
}

/* Let the pools of i and of the coefficient (row, k) meet at i, if both are wet. */
static void
meet(map *m, size_t i, double level, size_t row, size_t k)
{
    size_t j = index_of(m, row, k);
    if (m->pool[j] == NONE)
        return;
    size_t p = peak_of(m, i), q = peak_of(m, j);
    if (p == q)
        return;
    size_t low = m->rank[p] > m->rank[q] ? p : q, high = low == p ? q : p;
    m->pool[low] = high;
    m->saddle[low] = level;
}

/* The translation of scale nearest to time t. */
static size_t
nearest(const ss_scale *scale, double t)
{
    double k = floor(t * scale->b_den / scale->b_num + 0.5);
    return k <= 0 ? 0 : k >= (double)scale->n ? scale->n - 1 : (size_t)k;
}

/* Neighbours in another row: the nearest there, and those whose nearest here this one is. */
static void
meet_row(map *m, size_t i, double level, size_t mine, size_t k, size_t row)
{
    const ss_scale *here = &m->coef->scale[mine], *there = &m->coef->scale[row];
    size_t at = nearest(there, ss_scale_b(here, k));
    meet(m, i, level, row, at);
    for (size_t j = at; j > 0 && nearest(here, ss_scale_b(there, j - 1)) == k; j--)
        meet(m, i, level, row, j - 1);
    for (size_t j = at + 1; j < there->n && nearest(here, ss_scale_b(there, j)) == k; j++)
        meet(m, i, level, row, j);
}

static void
flood(map *m)
{
    for (size_t i = 0; i < m->n; i++) {
        size_t at = m->point[i].at, row = row_of(m, at), k = at - index_of(m, row, 0);
        double level = level_of(m->point[i].key);
        m->pool[at] = at;
        m->rank[at] = i;
        if (k > 0)
            meet(m, at, level, row, k - 1);
        if (k + 1 < m->coef->scale[row].n)
            meet(m, at, level, row, k + 1);
        if (row > m->first)
            meet_row(m, at, level, row, k, row - 1);
        if (row < m->last)
            meet_row(m, at, level, row, k, row + 1);
    }
}

static int
on_border(const map *m, size_t row, size_t k)
{
    if (m->first < m->last && (row == m->first || row == m->last))
        return 1;
    return k == 0 || k + 1 == m->coef->scale[row].n || ss_coefficients_edge(m->coef, row, k)
        || ss_coefficients_edge(m->coef, row, k - 1) || ss_coefficients_edge(m->coef, row, k + 1);
}

static int
earlier_first(const void *a, const void *b)
{
    const ss_maximum *p = a, *q = b;
    return (p->t > q->t) - (p->t < q->t);
}

/* The map's peaks in dB re top, of at least min_prominence and not more than range below the
 * highest of them, in time order.  The points stand in order of level. */
static ss_status
report(ss_maximum **out, size_t *n, const map *m, double top, double range, double min_prominence)
{
    ss_maximum *peak = malloc((m->n + 1) * sizeof *peak), *fitting;
    size_t count = 0;
    if (peak == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < m->n; i++) {
        size_t at = m->point[i].at;
        double height = level_of(m->point[i].key), saddle = m->saddle[at];
        if (m->pool[at] != at && !(saddle > 0))
            continue;                   /* no peak */
        size_t row = row_of(m, at), k = at - index_of(m, row, 0);
        const ss_scale *scale = &m->coef->scale[row];
        double below = saddle > 0 || i == 0 ? saddle : m->floor;    /* only the highest has no saddle */
        double fall = below > 0 ? 20 * log10(height / below) : INFINITY;
        double level = 20 * log10(height / top);
        if (count > 0 && level < peak[0].level - range)
            break;
        if (fall > 0 && fall >= min_prominence && !on_border(m, row, k))
            peak[count++] = (ss_maximum){ ss_scale_b(scale, k), scale->f, level, fall };
    }
    qsort(peak, count, sizeof *peak, earlier_first);
    fitting = realloc(peak, (count + 1) * sizeof *peak);
    if (fitting == NULL) {
        free(peak);
        return SS_ENOMEM;
    }
    *out = fitting;
    *n = count;
    return SS_OK;
}

ss_status
ss_maxima_above(ss_maximum **out, size_t *n, const ss_coefficients *coefficients,
                double min_prominence, double floor)
{
    map m;
    ss_status st = map_new(&m, coefficients, 0, coefficients->n_scales - 1, floor);
    if (st != SS_OK)
        return st;
    flood(&m);
    st = report(out, n, &m, ss_coefficients_max(coefficients), INFINITY, min_prominence);
    map_free(&m);
    return st;
}

ss_status
ss_maxima(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, double min_prominence)
{
    if (out == NULL || n == NULL || coefficients == NULL)
        return SS_EINVAL;
    return ss_maxima_above(out, n, coefficients, min_prominence, 0);
}

ss_status
ss_spikes(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
          double range, double min_prominence)
{
    if (out == NULL || n == NULL || coefficients == NULL)
        return SS_EINVAL;
    map m;
    if (scale >= coefficients->n_scales)
        return SS_EINVAL;
    ss_status st = map_new(&m, coefficients, scale, scale, 0);
    if (st != SS_OK)
        return st;
    flood(&m);
    st = report(out, n, &m, ss_coefficients_max(coefficients), range, min_prominence);
    map_free(&m);
    return st;
}
