/* basins.c -- see basins.h.
 *
 * Each row is cut into hills, from valley to valley.  A hill leads to the highest neighbour of its top
 * in the rows beside, if that is higher, and so to another hill, and so on up to a peak.
 *
 * The map is read strip by strip in time, so that only a strip of it is in memory.  The last HALO
 * points of each row are read again with the next strip, as hills of one point whose peaks are known.
 * A top that is the highest only as far as its strip shows is a peak as well.  Its border with the
 * next strip is as high as it is, so its prominence will be 0. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/largest.h"
#include "base/list.h"
#include "base/versions.h"
#include "find/basins.h"
#include "map/map.h"
#include "map/plan.h"

#define DRY SIZE_MAX            /* a way that leads nowhere: no hill */
#define PEAK (SIZE_MAX / 2 + 1) /* the end of a way: plus the number of the peak */

enum {
    RECENT = 1 << 12,           /* borders that are kept at hand while they may be met higher up */
    HALO = 3,                   /* neighbours of a point in a row beside it are within so many */
    STRIP = 1 << 20             /* points of a strip, about */
};

/* Points of a row from the end of the hill before on. */
typedef struct hill {
    size_t top, end;
    size_t way;                 /* to another hill, or to a peak; or DRY */
} hill;

/* A row in a strip: points lo ... end - 1, of which those before from are of the strip before. */
typedef struct line {
    size_t lo, from, end;
    size_t at;                  /* of point lo among the strip's points */
    size_t hill, hill_end;      /* its hills */
    size_t before[HALO];        /* the peaks of the points before from, from the last on; or DRY */
} line;

typedef struct map {
    basins *out;
    double outside, all;        /* the largest levels so far: outside the cone of influence, of all */
    line *line;                 /* of row first and on */
    size_t room, longest;       /* points, and those of a row */
    double *level;              /* of a strip's points; 0: dry */
    size_t *turn;               /* of a row, see find_turns */
    size_t n_hills, hill_room;
    hill *hill;                 /* of a strip, row by row */
    size_t peak_room, border_room;
    border recent[RECENT];
    int failed;                 /* 1: no memory for hills, peaks or borders */
} map;

static void
map_free(map *m)
{
    if (m == NULL)
        return;
    free(m->line);
    free(m->level);
    free(m->turn);
    free(m->hill);
    free(m);
}

/* --- strips ---------------------------------------------------------------------------------- */

static const ss_scale *
scale_of(const map *m, size_t row)
{
    return &m->out->map->scale[row];
}

/* Move all rows on to their points up to time t; returns the number of points. */
static size_t
next_strip(map *m, double t)
{
    size_t n = 0;
    for (size_t row = m->out->first; row <= m->out->last; row++) {
        line *l = &m->line[row - m->out->first];
        const ss_scale *scale = scale_of(m, row);
        size_t count = t < INFINITY ? ss_scale_count(scale, t) : scale->n;
        l->from = l->end;
        l->end = count > l->from ? count < scale->n ? count : scale->n : l->from;
        l->lo = l->from > HALO ? l->from - HALO : 0;
        l->at = n;
        n += l->end - l->lo;
    }
    return n;
}

static ss_status
make_room(map *m, size_t n)
{
    size_t longest = 0, rows = m->out->last - m->out->first + 1;
    for (const line *l = m->line; l < m->line + rows; l++)
        longest = l->end - l->lo > longest ? l->end - l->lo : longest;
    if (n <= m->room && longest <= m->longest)
        return SS_OK;
    free(m->level);
    free(m->turn);
    m->room = n + n / 64 + rows * HALO;         /* strips differ, and the first has no halo */
    m->longest = longest + longest / 64 + HALO;
    m->level = malloc(m->room * sizeof *m->level);
    m->turn = malloc((m->longest + 1) * sizeof *m->turn);
    return m->level != NULL && m->turn != NULL ? SS_OK : SS_ENOMEM;
}

VERSIONS static double
top_of(const double *level, size_t n)
{
    return largest_of(level, n);
}

VERSIONS static void
dry_below(double *level, size_t n, double floor)
{
    for (size_t k = 0; k < n; k++)
        level[k] = level[k] > floor ? level[k] : 0;
}

/* Note the largest levels of a row; then set those that are dry, or in the cone of influence, to 0. */
static void
dry_out(map *m, size_t row)
{
    const line *l = &m->line[row - m->out->first];
    const ss_scale *scale = scale_of(m, row);
    double *level = m->level + l->at, rate = m->out->map->head->rate;
    size_t n = l->end - l->lo, from = 0, to = n;
    double top = top_of(level, n);
    for (size_t k = 0; k < n && top > m->outside; k++)
        if (level[k] > m->outside && !ss_coefficients_edge(m->out->map, row, l->lo + k))
            m->outside = level[k];
    m->all = fmax(m->all, top);
    dry_below(level, n, m->out->floor);
    while (from < to && ss_scale_edge(scale, l->lo + from, m->out->map->n, rate))
        level[from++] = 0;
    while (to > from && ss_scale_edge(scale, l->lo + to - 1, m->out->map->n, rate))
        level[--to] = 0;
}

static ss_status
fill(map *m)
{
    size_t rows = m->out->last - m->out->first + 1;
    ss_map_part *part = malloc(rows * sizeof *part);
    if (part == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < rows; i++) {
        const line *l = &m->line[i];
        part[i] = (ss_map_part){ m->out->first + i, l->lo, l->end - l->lo, NULL, m->level + l->at };
    }
    ss_status st = ss_map_read(m->out->map, part, rows, NULL);
    for (size_t row = m->out->first; st == SS_OK && row <= m->out->last; row++)
        dry_out(m, row);
    free(part);
    return st;
}

/* --- neighbours ------------------------------------------------------------------------------ */

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

/* Two rows one beside the other: a point of the finer one has a neighbour in the coarser one, the
 * nearest. */
typedef struct pair {
    const line *fine, *coarse;
    const ss_scale *to;         /* of the coarse one */
    double ratio, back;         /* of their steps, fine to coarse <= 1, and coarse to fine */
} pair;

static pair
pair_of(const map *m, size_t row)
{
    const line *here = &m->line[row - m->out->first], *next = here + 1;
    const ss_scale *of = scale_of(m, row), *to = scale_of(m, row + 1);
    double ratio = ratio_of(of, to), back = ratio_of(to, of);
    return ratio <= 1 ? (pair){ here, next, to, ratio, back } : (pair){ next, here, of, back, ratio };
}

/* The first point of the fine row, from i on, whose neighbour is not before j. */
static size_t
first_beside(const pair *p, size_t i, size_t j)
{
    double at = ((double)(ptrdiff_t)j - 0.5) * p->back - 1;
    if (at > (double)(ptrdiff_t)i)
        i = at < (double)(ptrdiff_t)p->fine->end ? (size_t)(ptrdiff_t)at : p->fine->end;
    while (i < p->fine->end && nearest(i, p->ratio, p->to) < j)
        i++;
    return i;
}

/* --- hills and peaks ------------------------------------------------------------------------- */

static void
add_hill(map *m, size_t top, size_t end, size_t way)
{
    hill *list = ss_list_room(m->hill, &m->hill_room, m->n_hills, sizeof *list);
    if (list == NULL) {
        m->failed = 1;
        return;
    }
    m->hill = list;
    m->hill[m->n_hills++] = (hill){ top, end, way };
}

/* The points from k on, before n, from which on levels rise no more, and then rise again, by turns; the last
 * point is the end of both.  Returns their number, which is even.  No branch, as none could be foreseen. */
static size_t
find_turns(const double *level, size_t k, size_t n, size_t *turn)
{
    size_t count = 0, rose = 1;
    for (; k + 1 < n; k++) {
        size_t rises = level[k + 1] > level[k];
        turn[count] = k;
        count += rises != rose;
        rose = rises;
    }
    turn[count] = turn[count + rose] = n - 1;
    return count + 1 + rose;
}

/* The hills of a row: a top is the first of equals. */
static void
find_hills(map *m, size_t row)
{
    line *l = &m->line[row - m->out->first];
    const double *level = m->level + l->at;
    size_t n = l->end - l->lo, k = l->from - l->lo;
    size_t turns = k < n ? find_turns(level, k, n, m->turn) : 0;
    l->hill = m->n_hills;
    for (size_t i = l->lo; i < l->from; i++)
        add_hill(m, i, i + 1, l->before[l->from - 1 - i]);
    for (size_t i = 0; i < turns; i += 2)
        add_hill(m, l->lo + m->turn[i], l->lo + m->turn[i + 1] + 1,
                 level[m->turn[i]] > 0 ? m->n_hills : DRY);
    l->hill_end = m->n_hills;
}

/* Of equals, the one in the first row is the higher, and in it the first. */
static inline int
is_higher(const double *level, size_t p, size_t q)
{
    return level[p] > level[q] || (p < q && level[p] == level[q]);
}

/* From a row to one beside it. */
typedef struct side {
    pair pair;
    const line *to;
    size_t hill;                /* the first that may hold the next point */
} side;

/* Let a hill lead to the highest neighbour of its top in the row beside, if that is higher than all
 * seen before. */
static void
lead_beside(map *m, hill *h, size_t *highest, side *s)
{
    const pair *p = &s->pair;
    const line *to = s->to;
    int is_coarse = to == p->coarse;
    size_t j = is_coarse ? nearest(h->top, p->ratio, p->to) : first_beside(p, to->lo, h->top);
    for (size_t first = j; j < to->end; j++) {
        if (is_coarse ? j > first : nearest(j, p->ratio, p->to) != h->top)
            return;
        if (j < to->lo || !is_higher(m->level, to->at + (j - to->lo), *highest))
            continue;
        while (m->hill[s->hill].end <= j)
            s->hill++;
        h->way = s->hill;
        *highest = to->at + (j - to->lo);
    }
}

/* The ways of the hills of a row that have none yet. */
static void
find_ways(map *m, size_t row)
{
    const line *l = &m->line[row - m->out->first];
    side beside[2];
    int n = 0;
    if (row > m->out->first)
        beside[n++] = (side){ pair_of(m, row - 1), l - 1, l[-1].hill };
    if (row < m->out->last)
        beside[n++] = (side){ pair_of(m, row), l + 1, l[1].hill };
    for (size_t i = l->hill; i < l->hill_end; i++) {
        hill *h = &m->hill[i];
        size_t highest = l->at + (h->top - l->lo);
        if (h->way != i)
            continue;
        for (int k = 0; k < n; k++)
            lead_beside(m, h, &highest, &beside[k]);
    }
}

/* The way to a new peak. */
static size_t
new_peak(map *m, size_t row, size_t k, double level)
{
    peak *list = m->out->n_peaks > UINT32_MAX ? NULL    /* borders have no larger numbers */
        : ss_list_room(m->out->peak, &m->peak_room, m->out->n_peaks, sizeof *list);
    if (list == NULL) {
        m->failed = 1;
        return DRY;
    }
    m->out->peak = list;
    m->out->peak[m->out->n_peaks] = (peak){ row, k, level };
    return PEAK + m->out->n_peaks++;
}

/* Hills that lead to no other end in a peak. */
static void
find_peaks(map *m, size_t row)
{
    const line *l = &m->line[row - m->out->first];
    for (size_t i = l->hill; i < l->hill_end; i++) {
        hill *h = &m->hill[i];
        if (h->way == i)
            h->way = new_peak(m, row, h->top, m->level[l->at + (h->top - l->lo)]);
    }
}

/* Let the way of a hill, and those of all hills on it, lead to the peak at once. */
static void
shorten(map *m, size_t i)
{
    size_t end = m->hill[i].way;
    while (end < PEAK)
        end = m->hill[end].way;
    while (m->hill[i].way < PEAK) {
        size_t next = m->hill[i].way;
        m->hill[i].way = end;
        i = next;
    }
}

/* Keep the peaks of a row's last points for the next strip. */
static void
keep_ends(map *m, size_t row)
{
    line *l = &m->line[row - m->out->first];
    size_t i = l->hill_end;
    for (size_t k = 0; k < HALO && l->end - k > l->lo; k++) {
        while (i > l->hill && (i == l->hill_end || m->hill[i - 1].end >= l->end - k))
            i--;
        l->before[k] = m->hill[i].way;
    }
}

static void
climb(map *m)
{
    m->n_hills = 0;
    for (size_t row = m->out->first; row <= m->out->last; row++)
        find_hills(m, row);
    for (size_t row = m->out->first; row <= m->out->last && !m->failed; row++)
        find_ways(m, row);
    for (size_t row = m->out->first; row <= m->out->last && !m->failed; row++)
        find_peaks(m, row);
    for (size_t i = 0; i < m->n_hills && !m->failed; i++)
        shorten(m, i);
    for (size_t row = m->out->first; row <= m->out->last && !m->failed; row++)
        keep_ends(m, row);
}

/* --- borders ------------------------------------------------------------------------------- */

static void
keep_border(map *m, border b)
{
    border *list = ss_list_room(m->out->border, &m->border_room, m->out->n_borders, sizeof *list);
    if (list == NULL) {
        m->failed = 1;
        return;
    }
    m->out->border = list;
    m->out->border[m->out->n_borders++] = b;
}

/* Between two hills that lead to different peaks. */
static void
add_border(map *m, size_t p, size_t q, double level)
{
    border found = { 0, (uint32_t)((p < q ? p : q) - PEAK), (uint32_t)((p < q ? q : p) - PEAK) };
    border *slot = &m->recent[((size_t)found.p * 31 + found.q) % RECENT];
    memcpy(&found.key, &level, sizeof level);
    if (slot->p == found.p && slot->q == found.q) {
        slot->key = slot->key > found.key ? slot->key : found.key;
        return;
    }
    if (slot->q > 0)
        keep_border(m, *slot);
    *slot = found;
}

static int
is_border(size_t p, size_t q)
{
    return p != q && p != DRY && q != DRY;
}

/* Between the hills of a row. */
static void
find_borders_along(map *m, const line *l)
{
    const double *level = m->level + l->at;
    for (size_t i = l->hill; i + 1 < l->hill_end; i++) {
        size_t k = m->hill[i].end - l->lo, p = m->hill[i].way, q = m->hill[i + 1].way;
        double low = level[k - 1] < level[k] ? level[k - 1] : level[k];
        if (is_border(p, q) && low > 0)
            add_border(m, p, q, low);
    }
}

/* The highest of the lower ones of points i to end - 1 of the fine row and their neighbours. */
static double
highest_between(const map *m, const pair *p, size_t i, size_t end)
{
    const double *fine = m->level + p->fine->at, *coarse = m->level + p->coarse->at;
    double most = 0;
    for (; i < end; i++) {
        double a = fine[i - p->fine->lo], b = coarse[nearest(i, p->ratio, p->to) - p->coarse->lo];
        double low = a < b ? a : b;
        most = low > most ? low : most;
    }
    return most;
}

/* Between the hills of two rows. */
static void
find_borders_across(map *m, const pair *p)
{
    const line *fine = p->fine, *coarse = p->coarse;
    size_t a = fine->hill, b = coarse->hill, i = first_beside(p, fine->lo, coarse->lo);
    while (i < fine->end) {
        size_t j = nearest(i, p->ratio, p->to);
        if (j >= coarse->end)
            return;
        while (m->hill[a].end <= i)
            a++;
        while (m->hill[b].end <= j)
            b++;
        size_t end = first_beside(p, i, m->hill[b].end), from = i;
        i = end < m->hill[a].end ? end : m->hill[a].end;
        if (!is_border(m->hill[a].way, m->hill[b].way))
            continue;
        double level = highest_between(m, p, from, i);
        if (level > 0)
            add_border(m, m->hill[a].way, m->hill[b].way, level);
    }
}

static void
find_borders(map *m)
{
    for (size_t row = m->out->first; row <= m->out->last; row++)
        find_borders_along(m, &m->line[row - m->out->first]);
    for (size_t row = m->out->first; row < m->out->last; row++) {
        pair p = pair_of(m, row);
        find_borders_across(m, &p);
    }
}

/* Pass over the map in strips of about STRIP points. */
static ss_status
survey(map *m)
{
    double total = 0, length = (double)m->out->map->n / m->out->map->head->rate;
    for (size_t row = m->out->first; row <= m->out->last; row++)
        total += (double)scale_of(m, row)->n;
    size_t strips = (size_t)(total / STRIP) + 1;
    ss_status st = SS_OK;
    for (size_t i = 1; st == SS_OK && i <= strips; i++) {
        size_t n = next_strip(m, i < strips ? length * (double)i / (double)strips : INFINITY);
        if ((st = make_room(m, n)) != SS_OK || (st = fill(m)) != SS_OK)
            continue;
        climb(m);
        if (!m->failed)
            find_borders(m);
        st = m->failed ? SS_ENOMEM : ss_map_progress(m->out->map, (double)i / (double)strips);
    }
    for (size_t i = 0; i < RECENT; i++)
        if (m->recent[i].q > 0)
            keep_border(m, m->recent[i]);
    return m->failed ? SS_ENOMEM : st;
}

/* --- all of it ----------------------------------------------------------------------------- */

ss_status
ss_basins_find(basins *out, const ss_coefficients *grid, size_t first, size_t last, double floor)
{
    *out = (basins){ .map = grid, .first = first, .last = last, .floor = floor };
    map *m = calloc(1, sizeof *m);
    if (m == NULL || (m->line = calloc(last - first + 1, sizeof *m->line)) == NULL) {
        map_free(m);
        return SS_ENOMEM;
    }
    m->out = out;
    m->outside = -1;
    ss_status st = survey(m);
    out->top = m->outside >= 0 ? m->outside : m->all;
    map_free(m);
    return st;
}

void
ss_basins_free(basins *b)
{
    free(b->peak);
    free(b->border);
}
