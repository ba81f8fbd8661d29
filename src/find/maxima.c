/* maxima.c -- local maxima of |W| and how far they stand out.
 *
 * From each point of the map a way leads up to a peak; all points whose ways lead to the same peak are its
 * basin.  Each row is cut into hills, from valley to valley.  A hill leads to the highest neighbour of its top in
 * the rows beside, if that is higher, and so to another hill, and so on up to a peak.
 *
 * The prominence of a peak is its fall to the highest saddle between it and any higher peak.  Two basins join
 * at the highest point of their border, and the borders alone say what flooding the whole map from above would
 * say.  They are sorted from the highest down.  Where a border joins two pools of basins, the pool with the lower
 * peak ends: the border is the saddle of that peak.
 *
 * A peak on the border of the map (its first or last scale, or beside the cone of influence) is
 * where the map was cut, not a maximum; it is not reported, but it is higher ground for others.  So
 * are places within the reach of gaps: a map cut there would fall apart into islands.
 *
 * The map is read strip by strip in time, so that only a strip of it is in memory.  The last HALO
 * points of each row are read again with the next strip, as hills of one point whose peaks are known.
 * A top that is the highest only as far as its strip shows is a peak as well.  Its border with the
 * next strip is as high as it is, so its prominence will be 0. */
#include "find/maxima.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/list.h"
#include "base/versions.h"
#include "map/map.h"
#include "map/plan.h"

#define NONE UINT32_MAX         /* no peak: of a dry hill, or not known yet */

enum {
    HALO = 3,                   /* neighbours of a point in a row beside it are within so many */
    STRIP = 1 << 20             /* points of a strip, about */
};

typedef struct hill {
    uint32_t top, end;          /* points of the strip; it begins where the one before it ends */
    uint32_t next;              /* the hill to which it leads: itself, if it is dry or ends at a peak */
    uint32_t peak;              /* or NONE */
} hill;

typedef struct peak {
    size_t row, k;              /* its coefficient */
    double level;               /* |W| > 0 */
    double saddle;              /* where its pool ends; 0: it does not */
    size_t pool;                /* leads to the highest peak of its pool */
} peak;

/* Between the basins of peaks p and q.  Of several between the same two, the highest counts. */
typedef struct border {
    double level;               /* |W| > 0 */
    uint32_t p, q;
} border;

/* A row in a strip: points lo ... end - 1, of which those before `from` are of the strip before. */
typedef struct line {
    size_t lo, from, end;
    size_t at;                  /* of point lo among the strip's points */
    size_t hill;                /* its first hill */
    uint32_t before[HALO];      /* the peaks of its points before end, from the last on */
} line;

typedef struct flood {
    const ss_coefficients *map;
    size_t first, rows;         /* the rows that are searched */
    double floor;               /* |W| >= 0; points that are not above it are dry: they belong to no basin */
    double outside, all;        /* the largest levels so far: outside the cone of influence, of all */
    line *line;                 /* one a row, and one behind the last */
    size_t room;
    double *level;              /* of a strip's points; 0: dry */
    uint32_t *label;            /* their hills */
    size_t n_hills, hill_room, n_peaks, peak_room, n_borders, border_room;
    hill *hill;                 /* of a strip, row by row */
    peak *peak;
    border *border;
    int failed;                 /* 1: no memory for hills, peaks or borders */
} flood;

/* The list, possibly moved, with room for one entry more; NULL, and failed: there is no memory. */
static void *
longer(flood *f, void *list, size_t *room, size_t n, size_t size)
{
    void *at = n < NONE ? ss_list_room(list, room, n, size) : NULL;
    f->failed |= at == NULL;
    return at;
}

/* --- strips ---------------------------------------------------------------------------------- */

static const ss_scale *
scale_of(const flood *f, size_t row)
{
    return &f->map->scale[f->first + row];
}

/* Move all rows on to their points up to time t, and make room for them. */
static ss_status
next_strip(flood *f, double t)
{
    size_t n = 0;
    for (size_t row = 0; row < f->rows; row++) {
        line *l = &f->line[row];
        const ss_scale *scale = scale_of(f, row);
        size_t count = t < INFINITY ? ss_scale_count(scale, t) : scale->n;
        l->from = l->end;
        l->end = count > l->from ? count < scale->n ? count : scale->n : l->from;
        l->lo = l->from > HALO ? l->from - HALO : 0;
        l->at = n;
        n += l->end - l->lo;
    }
    f->line[f->rows].at = n;
    if (n <= f->room)
        return SS_OK;
    free(f->level);
    free(f->label);
    f->room = n + n / 64 + f->rows * HALO;      /* strips differ, and the first has no halo */
    f->level = malloc(f->room * sizeof *f->level);
    f->label = malloc(f->room * sizeof *f->label);
    return f->level != NULL && f->label != NULL ? SS_OK : SS_ENOMEM;
}

/* Set what is not above the floor to 0.  Returns the largest level. */
VERSIONS static double
dry_below(double *level, size_t n, double floor)
{
    double most = 0;
    for (size_t k = 0; k < n; k++) {
        most = level[k] > most ? level[k] : most;
        level[k] = level[k] > floor ? level[k] : 0;
    }
    return most;
}

/* Read the levels of a strip, note the largest of them, and set those that are dry or in the cone of influence
 * to 0. */
static ss_status
read_strip(flood *f)
{
    const ss_coefficients *map = f->map;
    ss_map_part *part = malloc((f->rows + 1) * sizeof *part);
    if (part == NULL)
        return SS_ENOMEM;
    for (size_t row = 0; row < f->rows; row++) {
        const line *l = &f->line[row];
        part[row] = (ss_map_part){ f->first + row, l->lo, l->end - l->lo, NULL, f->level + l->at };
    }
    ss_status st = ss_map_read(map, part, f->rows, NULL);
    free(part);
    for (size_t row = 0; row < f->rows && st == SS_OK; row++) {
        const line *l = &f->line[row];
        const ss_scale *scale = scale_of(f, row);
        double *level = f->level + l->at;
        size_t n = l->end - l->lo, from = 0, to = n;
        double top = dry_below(level, n, f->floor);
        for (size_t k = 0; k < n && top > f->outside; k++)
            if (level[k] > f->outside && !ss_coefficients_edge(map, f->first + row, l->lo + k))
                f->outside = level[k];
        f->all = fmax(f->all, top);
        while (from < to && ss_scale_edge(scale, l->lo + from, map->n, map->head->rate))
            level[from++] = 0;
        while (to > from && ss_scale_edge(scale, l->lo + to - 1, map->n, map->head->rate))
            level[--to] = 0;
    }
    return st;
}

/* --- neighbours ------------------------------------------------------------------------------ */

/* Two rows one beside the other: a point of the finer one has a neighbour in the coarser one, the nearest in
 * time, the first and the last beyond. */
typedef struct pair {
    const line *fine, *coarse;
    size_t n;                   /* of the coarse row, in all */
    double ratio, back;         /* of their steps, fine to coarse <= 1, and coarse to fine */
} pair;

static pair
pair_of(const flood *f, size_t row)
{
    const line *here = &f->line[row], *next = here + 1;
    const ss_scale *of = scale_of(f, row), *to = scale_of(f, row + 1);
    double ratio = of->b_num / of->b_den / (to->b_num / to->b_den);
    double back = to->b_num / to->b_den / (of->b_num / of->b_den);
    return ratio <= 1 ? (pair){ here, next, to->n, ratio, back } : (pair){ next, here, of->n, back, ratio };
}

/* The neighbour of point i of the fine row. */
static inline size_t
nearest(const pair *p, size_t i)
{
    double at = (double)(ptrdiff_t)i * p->ratio + 0.5;
    return at < (double)(ptrdiff_t)p->n ? (size_t)(ptrdiff_t)at : p->n - 1;
}

/* The first point of the fine row in the strip, from i on, whose neighbour is not before j. */
static size_t
first_beside(const pair *p, size_t i, size_t j)
{
    double at = ((double)(ptrdiff_t)j - 0.5) * p->back - 1;
    if (at > (double)(ptrdiff_t)i)
        i = at < (double)(ptrdiff_t)p->fine->end ? (size_t)(ptrdiff_t)at : p->fine->end;
    while (i < p->fine->end && nearest(p, i) < j)
        i++;
    return i;
}

/* --- hills and peaks ------------------------------------------------------------------------- */

/* Add the hill of the points from `first` up to end, of this peak, to those of a row.  Returns end. */
static size_t
add_hill(flood *f, size_t first, size_t top, size_t end, uint32_t number)
{
    hill *list = longer(f, f->hill, &f->hill_room, f->n_hills, sizeof *list);
    if (list == NULL)
        return end;
    f->hill = list;
    for (size_t point = first; point < end; point++)
        f->label[point] = (uint32_t)f->n_hills;
    list[f->n_hills] = (hill){ (uint32_t)top, (uint32_t)end, (uint32_t)f->n_hills, number };
    f->n_hills++;
    return end;
}

/* Cut a row into hills, which begin behind a valley: a top is the first of equals, and a valley the last. */
static void
cut(flood *f, line *l)
{
    const double *level = f->level;
    size_t halo = l->from - l->lo, point = l->at;
    const size_t behind = l->at + l->end - l->lo;
    l->hill = f->n_hills;
    for (; halo > 0; halo--)
        point = add_hill(f, point, point, point + 1, l->before[halo - 1]);
    while (point < behind) {
        size_t top = point, last;
        while (top + 1 < behind && level[top + 1] > level[top])
            top++;
        for (last = top; last + 1 < behind && !(level[last + 1] > level[last]);)
            last++;
        point = add_hill(f, point, top, last + 1, NONE);
    }
}

/* Let the hills of a row lead to the highest neighbours of their tops, if these are higher.  Of equals, the one in
 * the first row is the higher, and in it the first. */
static void
lead(flood *f, size_t row)
{
    const line *l = &f->line[row];
    pair beside[2];
    int n = 0;
    if (row > 0)
        beside[n++] = pair_of(f, row - 1);
    if (row + 1 < f->rows)
        beside[n++] = pair_of(f, row);
    for (hill *h = f->hill + l->hill; h < f->hill + l[1].hill; h++) {
        size_t highest = h->top, k = l->lo + h->top - l->at;
        if (k < l->from || !(f->level[highest] > 0))
            continue;
        for (int side = 0; side < n; side++) {
            const pair *p = &beside[side];
            const line *to = l == p->fine ? p->coarse : p->fine;
            size_t j = l == p->fine ? nearest(p, k) : first_beside(p, to->lo, k);
            for (size_t first = j; j < to->end && (l == p->fine ? j == first : nearest(p, j) == k); j++) {
                const size_t point = to->at + j - to->lo;
                if (j >= to->lo && (f->level[point] > f->level[highest]
                                    || (point < highest && f->level[point] == f->level[highest])))
                    highest = point;
            }
        }
        h->next = f->label[highest];
    }
}

/* Find the peaks of all hills of a strip. */
static void
climb(flood *f)
{
    f->n_hills = 0;
    for (size_t row = 0; row < f->rows && !f->failed; row++)
        cut(f, &f->line[row]);
    f->line[f->rows].hill = f->n_hills;
    for (size_t row = 0; row < f->rows && !f->failed; row++)
        lead(f, row);
    for (size_t row = 0; row < f->rows && !f->failed; row++) {
        const line *l = &f->line[row];
        for (size_t i = l->hill; i < l[1].hill; i++) {
            hill *h = &f->hill[i];
            size_t k = l->lo + h->top - l->at;
            if (h->next != i || k < l->from || !(f->level[h->top] > 0))
                continue;
            peak *list = longer(f, f->peak, &f->peak_room, f->n_peaks, sizeof *list);
            if (list == NULL)
                return;
            f->peak = list;
            f->peak[f->n_peaks] = (peak){ f->first + row, k, f->level[h->top], 0, f->n_peaks };
            h->peak = (uint32_t)f->n_peaks++;
        }
    }
    for (size_t i = 0; i < f->n_hills && !f->failed; i++) {     /* hills on the way lead to its end at once */
        uint32_t end = (uint32_t)i, next;
        while (f->hill[end].next != end)
            end = f->hill[end].next;
        for (uint32_t on = (uint32_t)i; on != end; on = next) {
            next = f->hill[on].next;
            f->hill[on].next = end;
            f->hill[on].peak = f->hill[end].peak;
        }
    }
    for (line *l = f->line; l < f->line + f->rows && !f->failed; l++)
        for (size_t k = 0; k < HALO && l->end - k > l->lo; k++)
            l->before[k] = f->hill[f->label[l->at + (l->end - 1 - k - l->lo)]].peak;
}

/* --- borders ------------------------------------------------------------------------------- */

/* Between two peaks; there is none if they are one, or if there is no peak, or if the border is dry. */
static void
add_border(flood *f, uint32_t p, uint32_t q, double level)
{
    if (p == q || p == NONE || q == NONE || !(level > 0))
        return;
    border *list = longer(f, f->border, &f->border_room, f->n_borders, sizeof *list);
    if (list == NULL)
        return;
    f->border = list;
    list[f->n_borders++] = (border){ level, p, q };
}

/* Between the hills of each row, and of each two rows. */
static void
find_borders(flood *f)
{
    const double *level = f->level;
    for (const line *l = f->line; l < f->line + f->rows; l++)
        for (size_t i = l->hill + 1; i < l[1].hill; i++) {
            size_t k = f->hill[i - 1].end;
            add_border(f, f->hill[i - 1].peak, f->hill[i].peak, level[k - 1] < level[k] ? level[k - 1] : level[k]);
        }
    for (size_t row = 0; row + 1 < f->rows; row++) {
        const pair p = pair_of(f, row);
        const line *fine = p.fine, *coarse = p.coarse;
        size_t i = first_beside(&p, fine->lo, coarse->lo), j;
        while (i < fine->end && (j = nearest(&p, i)) < coarse->end) {
            const hill *a = &f->hill[f->label[fine->at + i - fine->lo]];
            const hill *b = &f->hill[f->label[coarse->at + j - coarse->lo]];
            size_t end = fine->lo + a->end - fine->at;
            size_t other = first_beside(&p, i, coarse->lo + b->end - coarse->at);
            double most = 0;
            end = end < other ? end : other;
            for (; i < end && a->peak != b->peak; i++) {
                double low = level[fine->at + i - fine->lo], at = level[coarse->at + nearest(&p, i) - coarse->lo];
                low = at < low ? at : low;
                most = low > most ? low : most;
            }
            i = end;
            add_border(f, a->peak, b->peak, most);
        }
    }
}

/* Pass over the map in strips of about STRIP points. */
static ss_status
survey(flood *f)
{
    double total = 0, length = (double)f->map->n / f->map->head->rate;
    for (size_t row = 0; row < f->rows; row++)
        total += (double)scale_of(f, row)->n;
    const size_t strips = (size_t)(total / STRIP) + 1;
    ss_status st = SS_OK;
    for (size_t i = 1; st == SS_OK && i <= strips; i++) {
        st = next_strip(f, i < strips ? length * (double)i / (double)strips : INFINITY);
        if (st == SS_OK && (st = read_strip(f)) == SS_OK)
            climb(f);
        if (st == SS_OK && !f->failed)
            find_borders(f);
        st = st != SS_OK ? st : f->failed ? SS_ENOMEM : ss_map_progress(f->map, (double)i / (double)strips);
    }
    return f->failed ? SS_ENOMEM : st;
}

static int
higher_first(const void *a, const void *b)
{
    const border *p = a, *q = b;
    return (p->level < q->level) - (p->level > q->level);
}

/* --- pools --------------------------------------------------------------------------------- */

/* The number of the highest peak in the pool of peak p; the way there is halved for the next call. */
static size_t
highest_of(peak *list, size_t p)
{
    while (list[p].pool != p)
        p = list[p].pool = list[list[p].pool].pool;
    return p;
}

/* Find the saddles of the peaks. */
static void
find_saddles(flood *f)
{
    if (f->n_borders > 0)
        qsort(f->border, f->n_borders, sizeof *f->border, higher_first);
    for (size_t i = 0; i < f->n_borders; i++) {
        size_t p = highest_of(f->peak, f->border[i].p), q = highest_of(f->peak, f->border[i].q);
        if (p == q)
            continue;
        double level = f->peak[p].level, other = f->peak[q].level;
        size_t high = level > other || (level == other && p < q) ? p : q, low = high == p ? q : p;
        f->peak[low].pool = high;
        f->peak[low].saddle = f->border[i].level;
    }
}

/* --- maxima -------------------------------------------------------------------------------- */

static int
earlier_first(const void *a, const void *b)
{
    const ss_maximum *p = a, *q = b;
    return p->t != q->t ? (p->t > q->t) - (p->t < q->t)
        : (p->level < q->level) - (p->level > q->level);
}

/* The maxima of these rows, in time order.  *top, if 0, becomes ss_coefficients_max of these rows. */
static ss_status
search_rows(ss_maximum **out, size_t *n, const ss_coefficients *map, size_t first, size_t rows,
            const maxima_kind *kind, double *top)
{
    flood *f = calloc(1, sizeof *f);
    double highest = 0, highest_kept = -INFINITY;
    ss_maximum *list = NULL;
    size_t count = 0, kept = 0;
    if (f == NULL || (f->line = calloc(rows + 1, sizeof *f->line)) == NULL) {
        free(f);
        return SS_ENOMEM;
    }
    f->map = map, f->first = first, f->rows = rows, f->floor = kind->floor, f->outside = -1;
    ss_status st = survey(f);
    if (st == SS_OK) {
        *top = *top > 0 ? *top : f->outside >= 0 ? f->outside : f->all;
        find_saddles(f);
        list = malloc((f->n_peaks + 1) * sizeof *list);
        st = list != NULL ? SS_OK : SS_ENOMEM;
    }
    for (size_t i = 0; st == SS_OK && i < f->n_peaks; i++)
        highest = fmax(highest, f->peak[i].level);
    for (size_t i = 0; st == SS_OK && i < f->n_peaks; i++) {
        const peak *p = &f->peak[i];
        const ss_scale *scale = &map->scale[p->row];
        /* the highest alone has no saddle */
        double below = p->saddle > 0 || p->level == highest ? p->saddle : kind->floor;
        double fall = below > 0 ? 20 * log10(p->level / below) : INFINITY;
        const size_t k = p->k, row = p->row;
        if (!(fall > 0 && fall >= kind->prominence)     /* or it is on the border */
            || (rows > 1 && (row == first || row + 1 == first + rows)) || k == 0 || k + 1 == scale->n
            || ss_coefficients_edge(map, row, k) || ss_coefficients_edge(map, row, k - 1)
            || ss_coefficients_edge(map, row, k + 1))
            continue;
        list[count] = (ss_maximum){ ss_scale_b(scale, p->k), scale->f, 20 * log10(p->level / *top), fall };
        highest_kept = fmax(highest_kept, list[count++].level);
    }
    for (size_t i = 0; i < count; i++)
        if (list[i].level >= highest_kept - kind->range)
            list[kept++] = list[i];
    ss_maximum *fitting = st == SS_OK ? realloc(list, (kept + 1) * sizeof *list) : NULL;
    if (fitting != NULL) {
        qsort(fitting, kept, sizeof *fitting, earlier_first);
        *out = fitting;
        *n = kept;
    } else {
        st = st == SS_OK ? SS_ENOMEM : st;
        free(list);
    }
    free(f->line);
    free(f->level);
    free(f->label);
    free(f->hill);
    free(f->peak);
    free(f->border);
    free(f);
    return st;
}

ss_status
ss_maxima_of(ss_maximum **out, size_t *n, const ss_coefficients *map, const maxima_kind *kind, double *top)
{
    *top = 0;
    return search_rows(out, n, map, 0, map->n_scales, kind, top);
}

ss_status
ss_maxima_of_row(ss_maximum **out, size_t *n, const ss_coefficients *map, size_t row, const maxima_kind *kind,
                 double top)
{
    return search_rows(out, n, map, row, 1, kind, &top);
}
