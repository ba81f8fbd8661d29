/* maxima.c -- local maxima of |W| and how far they stand out.
 *
 * Flooding from above: points are taken from the highest down, each joining the pools of its
 * neighbours that are under water already.  A point with none is a peak and starts a pool; where
 * two pools meet, the one with the lower peak ends, and that point is the highest saddle between
 * this peak and any higher one: the prominence is the fall from peak to saddle.  Cost: a sort.
 *
 * A peak on the border of the map (its first or last scale, or beside the cone of influence) is
 * where the map was cut, not a maximum; it is not reported, but it is higher ground for others. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <stickslip/features.h>

#define NONE SIZE_MAX

typedef struct point {
    double level;               /* |W|, > 0 */
    size_t row, k;
} point;

typedef struct map {
    const ss_coefficients *coef;
    size_t first, last;         /* rows looked at */
    size_t n;                   /* points, highest first */
    point *point;
    size_t *rank;               /* of a coefficient among the points, NONE if it is none of them */
    size_t *pool;               /* of a point: towards its pool's peak, which is its own; NONE: dry */
    double *saddle;             /* of a peak: the level where its pool ended, 0 if it did not */
} map;

static int
higher_first(const void *a, const void *b)
{
    const point *p = a, *q = b;
    if (p->level != q->level)
        return p->level < q->level ? 1 : -1;
    if (p->row != q->row)
        return p->row > q->row ? 1 : -1;
    return (p->k > q->k) - (p->k < q->k);
}

static size_t
index_of(const map *m, size_t row, size_t k)
{
    return m->coef->scale[row].offset - m->coef->scale[m->first].offset + k;
}

static void
map_free(map *m)
{
    free(m->point);
    free(m->rank);
    free(m->pool);
    free(m->saddle);
}

static ss_status
map_new(map *m, const ss_coefficients *coef, size_t first, size_t last)
{
    *m = (map){ .coef = coef, .first = first, .last = last };
    size_t room = index_of(m, last, coef->scale[last].n) + 1;
    m->point = malloc(room * sizeof *m->point);
    m->rank = malloc(room * sizeof *m->rank);
    m->pool = malloc(room * sizeof *m->pool);
    m->saddle = calloc(room, sizeof *m->saddle);
    if (m->point == NULL || m->rank == NULL || m->pool == NULL || m->saddle == NULL) {
        map_free(m);
        return SS_ENOMEM;
    }
    for (size_t i = 0; i < room; i++)
        m->rank[i] = m->pool[i] = NONE;
    for (size_t row = first; row <= last; row++) {
        const ss_scale *scale = &coef->scale[row];
        for (size_t k = 0; k < scale->n; k++) {
            const double *w = coef->w + 2 * (scale->offset + k);
            double level = hypot(w[0], w[1]);
            if (level > 0 && !ss_coefficients_edge(coef, row, k))
                m->point[m->n++] = (point){ level, row, k };
        }
    }
    qsort(m->point, m->n, sizeof *m->point, higher_first);
    for (size_t i = 0; i < m->n; i++)
        m->rank[index_of(m, m->point[i].row, m->point[i].k)] = i;
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
meet(map *m, size_t i, size_t row, size_t k)
{
    size_t j = m->rank[index_of(m, row, k)];
    if (j == NONE || m->pool[j] == NONE)
        return;
    size_t p = peak_of(m, i), q = peak_of(m, j);
    if (p == q)
        return;
    size_t low = p > q ? p : q, high = p > q ? q : p;
    m->pool[low] = high;
    m->saddle[low] = m->point[i].level;
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
meet_row(map *m, size_t i, size_t row)
{
    const ss_scale *here = &m->coef->scale[m->point[i].row], *there = &m->coef->scale[row];
    size_t k = m->point[i].k, at = nearest(there, ss_scale_b(here, k));
    meet(m, i, row, at);
    for (size_t j = at; j > 0 && nearest(here, ss_scale_b(there, j - 1)) == k; j--)
        meet(m, i, row, j - 1);
    for (size_t j = at + 1; j < there->n && nearest(here, ss_scale_b(there, j)) == k; j++)
        meet(m, i, row, j);
}

static void
flood(map *m)
{
    for (size_t i = 0; i < m->n; i++) {
        size_t row = m->point[i].row, k = m->point[i].k;
        m->pool[i] = i;
        if (k > 0)
            meet(m, i, row, k - 1);
        if (k + 1 < m->coef->scale[row].n)
            meet(m, i, row, k + 1);
        if (row > m->first)
            meet_row(m, i, row - 1);
        if (row < m->last)
            meet_row(m, i, row + 1);
    }
}

static int
on_border(const map *m, size_t i)
{
    size_t row = m->point[i].row, k = m->point[i].k;
    if (m->first < m->last && (row == m->first || row == m->last))
        return 1;
    return k == 0 || k + 1 == m->coef->scale[row].n || ss_coefficients_edge(m->coef, row, k - 1)
        || ss_coefficients_edge(m->coef, row, k + 1);
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
        const point *p = &m->point[i];
        const ss_scale *scale = &m->coef->scale[p->row];
        double fall = m->saddle[i] > 0 ? 20 * log10(p->level / m->saddle[i]) : INFINITY;
        double level = 20 * log10(p->level / top);
        if (count > 0 && level < peak[0].level - range)
            break;
        if ((m->pool[i] == i || m->saddle[i] > 0) && fall > 0 && fall >= min_prominence
            && !on_border(m, i))
            peak[count++] = (ss_maximum){ ss_scale_b(scale, p->k), scale->f, level, fall };
    }
    qsort(peak, count, sizeof *peak, earlier_first);
    fitting = realloc(peak, (count + 1) * sizeof *peak);
    *out = fitting != NULL ? fitting : peak;
    *n = count;
    return SS_OK;
}

ss_status
ss_maxima(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, double min_prominence)
{
    map m;
    ss_status st = map_new(&m, coefficients, 0, coefficients->n_scales - 1);
    if (st != SS_OK)
        return st;
    flood(&m);
    st = report(out, n, &m, m.n > 0 ? m.point[0].level : 1, INFINITY, min_prominence);
    map_free(&m);
    return st;
}

ss_status
ss_spikes(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
          double range, double min_prominence)
{
    map m;
    if (scale >= coefficients->n_scales)
        return SS_EINVAL;
    ss_status st = map_new(&m, coefficients, scale, scale);
    if (st != SS_OK)
        return st;
    flood(&m);
    st = report(out, n, &m, ss_coefficients_max(coefficients), range, min_prominence);
    map_free(&m);
    return st;
}
