/* maxima.c -- local maxima of |W| and how far they stand out.
 *
 * From every point a way leads to its highest neighbour, and so on up to a peak: all the points
 * whose ways end there are its basin.  Ways only rise, so the basins of two peaks join at the highest
 * point of their border, and the borders alone say what flooding the whole map from above would: they
 * are taken from the highest down, and where two pools meet, the one with the lower peak ends.  That
 * border is the highest saddle between this peak and any higher one: the prominence is the fall from
 * peak to saddle.  Cost: two passes over the map, and a sort of the borders.
 *
 * A peak on the border of the map (its first or last scale, or beside the cone of influence) is
 * where the map was cut, not a maximum; it is not reported, but it is higher ground for others.  So
 * are places within the reach of gaps: a map cut there would fall apart into islands. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "features/maxima.h"

#define DRY SIZE_MAX            /* a way that leads nowhere: no point of the map */
#define PEAK (SIZE_MAX / 2 + 1) /* a way's end: plus the number of the peak */

typedef struct peak {
    size_t row, k;              /* its coefficient */
    double level;               /* |W| > 0 */
    double saddle;              /* the level where its pool ended, 0 if it did not */
    size_t pool;                /* towards its pool's highest peak, which is its own */
} peak;

typedef struct border {         /* between the basins of two peaks */
    uint64_t key;               /* |W| > 0, as its bits, which are ordered as the numbers are */
    size_t p, q;                /* p < q; q = 0: none */
} border;

enum { RECENT = 1 << 12 };      /* borders that are kept at hand while they may be met higher up */

typedef struct map {
    const ss_coefficients *coef;
    size_t first, last;         /* rows looked at */
    double floor;               /* lower levels are not looked at; 0: all are */
    size_t *way;                /* of a coefficient, counted from the first row's first: to another */
    size_t n_peaks;
    peak *peak;                 /* in order of their coefficients */
    size_t n_borders, room;
    border *border;
    border recent[RECENT];
    int failed;                 /* 1: no memory for borders */
} map;

typedef struct line {           /* a row that is passed over */
    size_t row, at, n;          /* at: its first coefficient, counted as ways are */
    double *level;              /* 0: dry */
    double *best;               /* where the way leads, which is not into the dry */
} line;

static void
map_free(map *m)
{
    free(m->way);
    free(m->peak);
    free(m->border);
    free(m);
}

static size_t
index_of(const map *m, size_t row, size_t k)
{
    return m->coef->scale[row].offset - m->coef->scale[m->first].offset + k;
}

/* --- passing over the map ------------------------------------------------------------------ */

static double
level_at(const map *m, size_t row, size_t k)
{
    const double *w = m->coef->w + 2 * (m->coef->scale[row].offset + k);
    return hypot(w[0], w[1]);
}

static void
fill(line *l, const map *m, size_t row)
{
    const ss_scale *scale = &m->coef->scale[row];
    const size_t samples = m->coef->n, n = scale->n;
    const double rate = m->coef->head->rate;
    size_t from = 0, to = n;
    *l = (line){ row, index_of(m, row, 0), n, l->level, l->best };
    while (from < n && ss_scale_edge(scale, from, samples, rate))
        l->level[from++] = 0;
    while (to > from && ss_scale_edge(scale, to - 1, samples, rate))
        l->level[--to] = 0;
    for (size_t k = from; k < to; k++) {
        double level = level_at(m, row, k);
        l->level[k] = level > m->floor ? level : 0;
    }
}

typedef void touch(map *m, line *a, size_t i, line *b, size_t j);

/* Neighbours in two rows: of each point the one nearest in time, the first and the last beyond. */
static inline void
touch_rows(map *m, line *a, line *b, touch *meet)
{
    const ss_scale *from = &m->coef->scale[a->row], *to = &m->coef->scale[b->row];
    double ratio = from->b_num / from->b_den / (to->b_num / to->b_den);
    for (size_t i = 0; i < a->n; i++) {
        double j = (double)i * ratio + 0.5;
        meet(m, a, i, b, j < (double)b->n ? (size_t)j : b->n - 1);
    }
}

static inline void
touch_all(map *m, line *here, line *before, touch *meet)
{
    for (size_t k = 1; k < here->n; k++)
        meet(m, here, k - 1, here, k);
    if (here->row > m->first) {
        touch_rows(m, before, here, meet);
        touch_rows(m, here, before, meet);
    }
}

/* --- ways and peaks ------------------------------------------------------------------------ */

/* Of equals, the first is the higher. */
static inline void
climb(map *m, line *a, size_t i, line *b, size_t j)
{
    if (a->level[i] < b->level[j] || (a->level[i] == b->level[j] && a->at + i > b->at + j)) {
        line *swap = a;
        size_t k = i;
        a = b, i = j;
        b = swap, j = k;
    }
    if (a->level[i] > b->best[j] || (a->level[i] == b->best[j] && a->at + i < m->way[b->at + j])) {
        b->best[j] = a->level[i];
        m->way[b->at + j] = a->at + i;
    }
}

static void
find_ways(map *m, line l[2])
{
    for (size_t row = m->first; row <= m->last; row++) {
        line *here = &l[row % 2], *before = &l[(row + 1) % 2];
        fill(here, m, row);
        for (size_t k = 0; k < here->n; k++) {
            int wet = here->level[k] > 0;
            here->best[k] = wet ? here->level[k] : INFINITY;
            m->way[here->at + k] = wet ? here->at + k : DRY;
        }
        touch_all(m, here, before, climb);
    }
}

static ss_status
find_peaks(map *m)
{
    size_t n = 0, end = index_of(m, m->last, m->coef->scale[m->last].n);
    for (size_t at = 0; at < end; at++)
        n += m->way[at] == at;
    m->peak = malloc((n + 1) * sizeof *m->peak);
    if (m->peak == NULL)
        return SS_ENOMEM;
    for (size_t row = m->first; row <= m->last; row++)
        for (size_t k = 0; k < m->coef->scale[row].n; k++) {
            size_t at = index_of(m, row, k);
            if (m->way[at] != at)
                continue;
            m->peak[m->n_peaks] = (peak){ row, k, level_at(m, row, k), 0, m->n_peaks };
            m->way[at] = PEAK + m->n_peaks++;
        }
    return SS_OK;
}

/* Let the way from a point, and from all those on it, lead to the peak at once. */
static inline void
shorten(map *m, size_t at)
{
    size_t end = m->way[at];
    while (end < PEAK)
        end = m->way[end];
    while (m->way[at] < PEAK) {
        size_t next = m->way[at];
        m->way[at] = end;
        at = next;
    }
}

/* --- borders ------------------------------------------------------------------------------- */

static void
keep_border(map *m, border b)
{
    border *list = ss_list_room(m->border, &m->room, m->n_borders, sizeof *list);
    if (list == NULL) {
        m->failed = 1;
        return;
    }
    m->border = list;
    m->border[m->n_borders++] = b;
}

static inline void
add_border(map *m, line *a, size_t i, line *b, size_t j)
{
    size_t p = m->way[a->at + i], q = m->way[b->at + j];
    if (p == q || p == DRY || q == DRY)
        return;
    double level = a->level[i] < b->level[j] ? a->level[i] : b->level[j];
    border found = { 0, (p < q ? p : q) - PEAK, (p < q ? q : p) - PEAK };
    border *slot = &m->recent[(found.p * 31 + found.q) % RECENT];
    memcpy(&found.key, &level, sizeof level);
    if (slot->p == found.p && slot->q == found.q) {
        slot->key = slot->key > found.key ? slot->key : found.key;
        return;
    }
    if (slot->q > 0)
        keep_border(m, *slot);
    *slot = found;
}

static ss_status
find_borders(map *m, line l[2])
{
    for (size_t row = m->first; row <= m->last; row++) {
        line *here = &l[row % 2], *before = &l[(row + 1) % 2];
        fill(here, m, row);
        for (size_t k = 0; k < here->n; k++)
            shorten(m, here->at + k);
        touch_all(m, here, before, add_border);
    }
    for (size_t i = 0; i < RECENT; i++)
        if (m->recent[i].q > 0)
            keep_border(m, m->recent[i]);
    return m->failed ? SS_ENOMEM : SS_OK;
}

/* Highest first, by counting digits from the lowest to the highest. */
static ss_status
sort_borders(map *m)
{
    enum { BITS = 11, DIGITS = 1 << BITS };
    static const uint64_t mask = DIGITS - 1;
    border *from = m->border, *to = malloc((m->n_borders + 1) * sizeof *to);
    if (to == NULL)
        return SS_ENOMEM;
    for (int shift = 0; shift < 64; shift += BITS) {
        size_t place[DIGITS] = { 0 }, sum = 0;
        for (size_t i = 0; i < m->n_borders; i++)
            place[from[i].key >> shift & mask]++;
        for (size_t d = DIGITS; d-- > 0;) {
            size_t count = place[d];
            place[d] = sum;
            sum += count;
        }
        for (size_t i = 0; i < m->n_borders; i++)
            to[place[from[i].key >> shift & mask]++] = from[i];
        border *swap = from;
        from = to;
        to = swap;
    }
    m->border = from;
    free(to);
    return SS_OK;
}

/* --- pools --------------------------------------------------------------------------------- */

/* The highest peak of a peak's pool; the way there is halved for the next one who asks. */
static size_t
highest_of(map *m, size_t p)
{
    while (m->peak[p].pool != p)
        p = m->peak[p].pool = m->peak[m->peak[p].pool].pool;
    return p;
}

static void
flood(map *m)
{
    for (size_t i = 0; i < m->n_borders; i++) {
        size_t p = highest_of(m, m->border[i].p), q = highest_of(m, m->border[i].q);
        if (p == q)
            continue;
        double a = m->peak[p].level, b = m->peak[q].level;
        size_t high = a > b || (a == b && p < q) ? p : q, low = high == p ? q : p;
        m->peak[low].pool = high;
        memcpy(&m->peak[low].saddle, &m->border[i].key, sizeof(double));
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
    return p->t != q->t ? (p->t > q->t) - (p->t < q->t)
        : (p->level < q->level) - (p->level > q->level);
}

/* The map's peaks in dB re top, of at least min_prominence and not more than range below the
 * highest of them, in time order. */
static ss_status
report(ss_maximum **out, size_t *n, const map *m, double top, double range, double min_prominence)
{
    ss_maximum *found = malloc((m->n_peaks + 1) * sizeof *found), *fitting;
    size_t count = 0, kept = 0;
    double highest = 0, highest_found = -INFINITY;
    if (found == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < m->n_peaks; i++)
        highest = fmax(highest, m->peak[i].level);
    for (size_t i = 0; i < m->n_peaks; i++) {
        const peak *p = &m->peak[i];
        const ss_scale *scale = &m->coef->scale[p->row];
        /* only the highest has no saddle */
        double below = p->saddle > 0 || p->level == highest ? p->saddle : m->floor;
        double fall = below > 0 ? 20 * log10(p->level / below) : INFINITY;
        double level = 20 * log10(p->level / top);
        if (!(fall > 0 && fall >= min_prominence) || on_border(m, p->row, p->k))
            continue;
        found[count++] = (ss_maximum){ ss_scale_b(scale, p->k), scale->f, level, fall };
        highest_found = fmax(highest_found, level);
    }
    for (size_t i = 0; i < count; i++)
        if (found[i].level >= highest_found - range)
            found[kept++] = found[i];
    qsort(found, kept, sizeof *found, earlier_first);
    fitting = realloc(found, (kept + 1) * sizeof *found);
    if (fitting == NULL) {
        free(found);
        return SS_ENOMEM;
    }
    *out = fitting;
    *n = kept;
    return SS_OK;
}

/* --- all of it ----------------------------------------------------------------------------- */

/* A map with its pools as they are when all is flooded. */
static ss_status
map_new(map **out, const ss_coefficients *coef, size_t first, size_t last, double floor)
{
    map *m = calloc(1, sizeof *m);
    if (m == NULL)
        return SS_ENOMEM;
    *m = (map){ .coef = coef, .first = first, .last = last, .floor = floor };
    size_t most = 1;
    for (size_t row = first; row <= last; row++)
        most = coef->scale[row].n > most ? coef->scale[row].n : most;
    double *memory = malloc(4 * most * sizeof *memory);
    m->way = malloc((index_of(m, last, coef->scale[last].n) + 1) * sizeof *m->way);
    ss_status st = SS_ENOMEM;
    if (memory != NULL && m->way != NULL) {
        line l[2] = { { .level = memory, .best = memory + most },
                      { .level = memory + 2 * most, .best = memory + 3 * most } };
        find_ways(m, l);
        if ((st = find_peaks(m)) == SS_OK && (st = find_borders(m, l)) == SS_OK
            && (st = sort_borders(m)) == SS_OK)
            flood(m);
    }
    free(memory);
    if (st != SS_OK)
        map_free(m);
    else
        *out = m;
    return st;
}

ss_status
ss_maxima_above(ss_maximum **out, size_t *n, const ss_coefficients *coefficients,
                double min_prominence, double floor)
{
    map *m;
    ss_status st = map_new(&m, coefficients, 0, coefficients->n_scales - 1, floor);
    if (st != SS_OK)
        return st;
    st = report(out, n, m, ss_coefficients_max(coefficients), INFINITY, min_prominence);
    map_free(m);
    return st;
}

ss_status
ss_maxima_find(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, double min_prominence)
{
    if (out == NULL || n == NULL || coefficients == NULL)
        return SS_EINVAL;
    return ss_maxima_above(out, n, coefficients, min_prominence, 0);
}

ss_status
ss_maxima_along(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
          double range, double min_prominence)
{
    if (out == NULL || n == NULL || coefficients == NULL || scale >= coefficients->n_scales)
        return SS_EINVAL;
    map *m;
    ss_status st = map_new(&m, coefficients, scale, scale, 0);
    if (st != SS_OK)
        return st;
    st = report(out, n, m, ss_coefficients_max(coefficients), range, min_prominence);
    map_free(m);
    return st;
}
