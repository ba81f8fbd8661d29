/* maxima.c -- local maxima of |W| and how far they stand out.
 *
 * From every point a way leads to a higher neighbour, and so on up to a peak: all the points whose
 * ways end there are its basin.  Ways only rise, whichever they are, so the basins of two peaks
 * join at the highest point of their border, and the borders alone say what flooding the whole map
 * from above would: they are taken from the highest down, and where two pools meet, the one with
 * the lower peak ends.  That border is the highest saddle between this peak and any higher one: the
 * prominence is the fall from peak to saddle.
 *
 * The map is passed over strip by strip in time, so that only a strip of it is in memory: its points
 * and, of each row, HALO more at either side.  A way that leaves a strip ends in a peak of level -1,
 * whose pool is that of the next strip's point.
 *
 * A peak on the border of the map (its first or last scale, or beside the cone of influence) is
 * where the map was cut, not a maximum; it is not reported, but it is higher ground for others.  So
 * are places within the reach of gaps: a map cut there would fall apart into islands. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/list.h"
#include "features/levels.h"
#include "features/maxima.h"
#include "morlet/plan.h"

#define DRY SIZE_MAX            /* a way that leads nowhere: no point of the map */
#define PEAK (SIZE_MAX / 2 + 1) /* a way's end: plus the number of the peak */

typedef struct peak {
    size_t row, k;              /* its coefficient */
    double level;               /* |W| > 0, or -1 */
    double saddle;              /* the level where its pool ended, 0 if it did not */
    size_t pool;                /* towards its pool's highest peak, which is its own */
} peak;

typedef struct border {         /* between the basins of two peaks */
    uint64_t key;               /* |W| > 0, as its bits, which are ordered as the numbers are */
    size_t p, q;                /* p < q; q = 0: none */
} border;

enum {
    RECENT = 1 << 12,           /* borders that are kept at hand while they may be met higher up */
    HALO = 3,                   /* neighbours of a point in a row beside it are within so many */
    STRIP = 1 << 21             /* points of a strip, about */
};

/* A row in a strip: points lo ... hi - 1, of which from ... end - 1 are the strip's own. */
typedef struct line {
    size_t lo, from, end, hi;
    size_t at;                  /* of point lo among the strip's points */
    size_t left[HALO];          /* the ways of the points before end in the strip before, */
    size_t right[HALO];         /* and the peaks, plus PEAK, at those from end on; or DRY */
} line;

typedef struct map {
    const map_source *source;
    const ss_coefficients *grid;
    size_t first, last;         /* rows looked at */
    double floor;               /* lower levels are not looked at; 0: all are */
    double outside, all;        /* the largest levels so far: outside the cone of influence, and of all */
    line *line;                 /* of row first and on */
    size_t room;                /* points */
    double *level;              /* of a strip's points; 0: dry */
    size_t *way;                /* to another point, or to a peak */
    size_t n_peaks, peak_room;
    peak *peak;
    size_t n_borders, border_room;
    border *border;
    border recent[RECENT];
    int failed;                 /* 1: no memory for peaks or borders */
} map;

static void
map_free(map *m)
{
    if (m == NULL)
        return;
    free(m->line);
    free(m->level);
    free(m->way);
    free(m->peak);
    free(m->border);
    free(m);
}

/* --- strips ---------------------------------------------------------------------------------- */

static const ss_scale *
scale_of(const map *m, size_t row)
{
    return &m->grid->scale[row];
}

/* Move all rows on to their points up to time t; returns the number of points. */
static size_t
next_strip(map *m, double t)
{
    size_t n = 0;
    for (size_t row = m->first; row <= m->last; row++) {
        line *l = &m->line[row - m->first];
        const ss_scale *scale = scale_of(m, row);
        size_t count = t < INFINITY ? ss_scale_count(scale, t) : scale->n;
        l->from = l->end;
        l->end = count > l->from ? count < scale->n ? count : scale->n : l->from;
        l->lo = l->from > HALO ? l->from - HALO : 0;
        l->hi = scale->n - l->end > HALO ? l->end + HALO : scale->n;
        l->at = n;
        n += l->hi - l->lo;
    }
    return n;
}

static ss_status
make_room(map *m, size_t n)
{
    if (n <= m->room)
        return SS_OK;
    free(m->level);
    free(m->way);
    m->level = malloc(n * sizeof *m->level);
    m->way = malloc(n * sizeof *m->way);
    m->room = m->level != NULL && m->way != NULL ? n : 0;
    return m->room > 0 ? SS_OK : SS_ENOMEM;
}

/* Note the largest levels of a row; then set those that are dry, or in the cone of influence, to 0. */
static void
dry_out(map *m, size_t row)
{
    const line *l = &m->line[row - m->first];
    const ss_scale *scale = scale_of(m, row);
    double *level = m->level + l->at, rate = m->grid->head->rate, floor = m->floor;
    size_t from = l->lo, to = l->hi;
    for (size_t k = l->lo; k < l->hi; k++) {
        double here = level[k - l->lo];
        if (here > m->outside && !ss_coefficients_edge(m->grid, row, k))
            m->outside = here;
        if (here > m->all)
            m->all = here;
        level[k - l->lo] = here > floor ? here : 0;
    }
    while (from < to && ss_scale_edge(scale, from, m->grid->n, rate))
        level[from++ - l->lo] = 0;
    while (to > from && ss_scale_edge(scale, to - 1, m->grid->n, rate))
        level[--to - l->lo] = 0;
}

static ss_status
fill(map *m)
{
    size_t rows = m->last - m->first + 1;
    level_part *part = malloc(rows * sizeof *part);
    if (part == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < rows; i++) {
        const line *l = &m->line[i];
        part[i] = (level_part){ m->first + i, l->lo, l->hi - l->lo, m->level + l->at };
    }
    ss_status st = ss_levels_fill(m->source, part, rows);
    for (size_t row = m->first; st == SS_OK && row <= m->last; row++)
        dry_out(m, row);
    free(part);
    return st;
}

/* --- passing over a strip -------------------------------------------------------------------- */

/* The point of a row nearest in time to point i of another, the first and the last beyond: its
 * steps over theirs are ratio. */
static inline size_t
nearest(size_t i, double ratio, const ss_scale *in)
{
    double at = (double)(ptrdiff_t)i * ratio + 0.5;
    return at < (double)(ptrdiff_t)in->n ? (size_t)(ptrdiff_t)at : in->n - 1;
}

static double
ratio_of(const ss_scale *from, const ss_scale *to)
{
    return from->b_num / from->b_den / (to->b_num / to->b_den);
}

/* --- ways and peaks ------------------------------------------------------------------------ */

/* Of equals, the first is the higher.  Without branches: they would be guessed wrong. */
static inline int
is_higher(const double *level, size_t p, size_t q)
{
    return (level[p] > level[q]) | ((level[p] == level[q]) & (p < q));
}

/* The highest of a point and of its neighbours in a row beside, those that it is nearest to, too. */
static size_t
highest_beside(const map *m, size_t row, size_t i, size_t beside, size_t highest)
{
    const ss_scale *from = scale_of(m, row), *to = scale_of(m, beside);
    const line *b = &m->line[beside - m->first];
    double ratio = ratio_of(from, to), back = ratio_of(to, from);
    size_t mine = nearest(i, ratio, to), reach = (size_t)(ratio / 2) + 2;
    for (size_t j = mine > reach ? mine - reach : 0; j <= mine + reach && j < to->n; j++)
        if (j >= b->lo && j < b->hi && (j == mine || nearest(j, back, from) == i)
            && is_higher(m->level, b->at + (j - b->lo), highest))
            highest = b->at + (j - b->lo);
    return highest;
}

static size_t
highest_across(const map *m, size_t row, size_t i, size_t highest)
{
    if (row > m->first)
        highest = highest_beside(m, row, i, row - 1, highest);
    return row < m->last ? highest_beside(m, row, i, row + 1, highest) : highest;
}

/* The ways of a row: along it if they rise there, as it does not matter which way up is taken; from its
 * maxima to the rows beside. */
static void
climb(map *m, size_t row)
{
    const double *level = m->level;
    const line *l = &m->line[row - m->first];
    size_t end = l->at + (l->hi - l->lo);
    for (size_t p = l->at; p < end; p++) {
        size_t before = p > l->at ? p - 1 : p, behind = p + 1 < end ? p + 1 : p;
        size_t way = is_higher(level, before, p) ? before : p;
        way = is_higher(level, behind, way) ? behind : way;
        m->way[p] = level[p] > 0 ? way : DRY;
        if (m->way[p] == p)
            m->way[p] = highest_across(m, row, l->lo + (p - l->at), p);
    }
}

/* The way to a new peak. */
static size_t
new_peak(map *m, size_t row, size_t k, double level)
{
    peak *list = ss_list_room(m->peak, &m->peak_room, m->n_peaks, sizeof *list);
    if (list == NULL) {
        m->failed = 1;
        return DRY;
    }
    m->peak = list;
    m->peak[m->n_peaks] = (peak){ row, k, level, 0, m->n_peaks };
    return PEAK + m->n_peaks++;
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

/* The ends of ways in a row: its peaks, those that the strip before has found, and those that the
 * next will find. */
static void
find_ends(map *m, size_t row)
{
    line *l = &m->line[row - m->first];
    size_t *way = m->way + l->at, right[HALO];
    for (size_t k = l->lo; k < l->from; k++)
        way[k - l->lo] = l->left[l->from - 1 - k];
    for (size_t k = l->from; k < l->end; k++)
        if (way[k - l->lo] == l->at + (k - l->lo))
            way[k - l->lo] = new_peak(m, row, k, m->level[l->at + (k - l->lo)]);
    for (size_t i = 0; i < HALO; i++) {
        size_t k = l->end + i, before = k - l->from;
        right[i] = DRY;
        if (k >= l->hi || way[k - l->lo] == DRY)
            continue;
        int known = before < HALO && l->right[before] != DRY;
        right[i] = way[k - l->lo] = known ? l->right[before] : new_peak(m, row, k, -1);
    }
    for (size_t i = 0; i < HALO; i++) {     /* left serves for those that this strip has found */
        l->left[i] = l->from + i < l->end ? l->right[i] : DRY;
        l->right[i] = right[i];
    }
}

/* All ways lead to their ends: the peaks of the strip before get their pools, and the next strip
 * its ways. */
static void
close_ends(map *m, size_t row)
{
    line *l = &m->line[row - m->first];
    size_t *way = m->way + l->at;
    for (size_t k = l->from; k < l->end; k++)
        shorten(m, l->at + (k - l->lo));
    for (size_t i = 0; i < HALO; i++)
        if (l->left[i] != DRY)
            m->peak[l->left[i] - PEAK].pool = way[l->from + i - l->lo] - PEAK;
    for (size_t i = 0; i < HALO; i++)
        l->left[i] = l->end > l->lo + i ? way[l->end - 1 - i - l->lo] : DRY;
}

static void
find_ways(map *m)
{
    for (size_t row = m->first; row <= m->last; row++)
        climb(m, row);
    for (size_t row = m->first; row <= m->last; row++)
        find_ends(m, row);
    for (size_t row = m->first; row <= m->last && !m->failed; row++)
        close_ends(m, row);
    for (size_t i = 0; i <= m->last - m->first; i++) {
        const line *l = &m->line[i];
        for (size_t k = l->end; k < l->hi; k++)
            m->way[l->at + (k - l->lo)] = DRY;          /* the next strip's */
    }
}

/* --- borders ------------------------------------------------------------------------------- */

static void
keep_border(map *m, border b)
{
    border *list = ss_list_room(m->border, &m->border_room, m->n_borders, sizeof *list);
    if (list == NULL) {
        m->failed = 1;
        return;
    }
    m->border = list;
    m->border[m->n_borders++] = b;
}

static inline void
add_border(map *m, size_t at, size_t beside)
{
    size_t p = m->way[at], q = m->way[beside];
    if (p == q || p == DRY || q == DRY)
        return;
    double level = fmin(m->level[at], m->level[beside]);
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

/* Between each point of a row and its neighbour beside. */
static void
find_borders_of(map *m, size_t row, size_t beside, double ratio)
{
    const line *a = &m->line[row - m->first], *b = &m->line[beside - m->first];
    for (size_t i = a->lo, p = a->at; i < a->hi; i++, p++) {
        if (m->way[p] == DRY)                           /* most of noise is */
            continue;
        size_t j = nearest(i, ratio, scale_of(m, beside));
        if (j >= b->lo && j < b->hi)
            add_border(m, p, b->at + (j - b->lo));
    }
}

static void
find_borders(map *m)
{
    for (size_t row = m->first; row <= m->last; row++) {
        const line *l = &m->line[row - m->first];
        for (size_t i = 1; i < l->hi - l->lo; i++)
            add_border(m, l->at + i - 1, l->at + i);
        if (row == m->last)
            break;
        const ss_scale *here = scale_of(m, row), *next = scale_of(m, row + 1);
        find_borders_of(m, row, row + 1, ratio_of(here, next));
        if (ratio_of(here, next) != 1 || here->n != next->n)    /* or they are the same */
            find_borders_of(m, row + 1, row, ratio_of(next, here));
    }
}

/* Pass over the map in strips of about STRIP points. */
static ss_status
survey(map *m)
{
    double total = 0, length = (double)m->grid->n / m->grid->head->rate;
    for (size_t row = m->first; row <= m->last; row++)
        total += (double)scale_of(m, row)->n;
    size_t strips = (size_t)(total / STRIP) + 1;
    ss_status st = SS_OK;
    for (size_t i = 1; st == SS_OK && i <= strips; i++) {
        size_t n = next_strip(m, i < strips ? length * (double)i / (double)strips : INFINITY);
        if ((st = make_room(m, n)) != SS_OK || (st = fill(m)) != SS_OK)
            continue;
        find_ways(m);
        if (!m->failed)
            find_borders(m);
        st = m->failed ? SS_ENOMEM : ss_levels_progress(m->source, (double)i / (double)strips);
    }
    for (size_t i = 0; i < RECENT; i++)
        if (m->recent[i].q > 0)
            keep_border(m, m->recent[i]);
    return m->failed ? SS_ENOMEM : st;
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
    return k == 0 || k + 1 == scale_of(m, row)->n || ss_coefficients_edge(m->grid, row, k)
        || ss_coefficients_edge(m->grid, row, k - 1) || ss_coefficients_edge(m->grid, row, k + 1);
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
        const ss_scale *scale = scale_of(m, p->row);
        if (p->level < 0)
            continue;
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
map_new(map **out, const map_source *source, size_t first, size_t last, double floor)
{
    map *m = *out = calloc(1, sizeof *m);
    if (m == NULL || (m->line = calloc(last - first + 1, sizeof *m->line)) == NULL)
        return SS_ENOMEM;
    m->source = source;
    m->grid = source->grid;
    m->first = first;
    m->last = last;
    m->floor = floor;
    m->outside = -1;
    for (size_t i = 0; i <= last - first; i++)
        for (size_t k = 0; k < HALO; k++)
            m->line[i].left[k] = m->line[i].right[k] = DRY;
    ss_status st = survey(m);
    if (st == SS_OK && (st = sort_borders(m)) == SS_OK)
        flood(m);
    return st;
}

ss_status
ss_maxima_above(ss_maximum **out, size_t *n, const map_source *source, double min_prominence,
                double floor, double *top)
{
    map *m;
    ss_status st = map_new(&m, source, 0, source->grid->n_scales - 1, floor);
    if (st == SS_OK) {
        *top = m->outside >= 0 ? m->outside : m->all;
        st = report(out, n, m, *top, INFINITY, min_prominence);
    }
    map_free(m);
    return st;
}

ss_status
ss_maxima_of_row(ss_maximum **out, size_t *n, const map_source *source, size_t row, double top,
                 double range, double min_prominence)
{
    map *m;
    ss_status st = map_new(&m, source, row, row, 0);
    if (st == SS_OK)
        st = report(out, n, m, top, range, min_prominence);
    map_free(m);
    return st;
}

ss_status
ss_maxima_find(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, double min_prominence)
{
    if (out == NULL || n == NULL || coefficients == NULL)
        return SS_EINVAL;
    double top;
    return ss_maxima_above(out, n, &(map_source){ .grid = coefficients }, min_prominence, 0, &top);
}

ss_status
ss_maxima_along(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
          double range, double min_prominence)
{
    if (out == NULL || n == NULL || coefficients == NULL || scale >= coefficients->n_scales)
        return SS_EINVAL;
    return ss_maxima_of_row(out, n, &(map_source){ .grid = coefficients }, scale,
                            ss_coefficients_max(coefficients), range, min_prominence);
}
