/* bursts.c -- find the few events of a record that is quiet between them.
 *
 * The row of |W| whose largest maximum is highest above the noise shows events best, whatever their
 * length and the colour of the noise.  The events are its maxima within a range of the largest; the
 * next lower maximum tells how certain this is. */
#include <math.h>
#include <stdlib.h>
#include "base/sort.h"
#include "find/events.h"

#define LONGEST 20.0            /* fewest scales in the record: some of them must be quiet */

static int
stronger_first(const void *a, const void *b)
{
    double p = ((const peak *)a)->level, q = ((const peak *)b)->level;
    return (p < q) - (p > q);
}

static double
label_of(const row_source *source, size_t i)
{
    return ROW_HIGHEST * source->rate / 2 * exp2(-(double)i / ROW_VOICES);
}

/* Keep the row and its peaks if it is clearer than the best. */
static void
keep_clearer(scale_row *best, scale_row *r)
{
    if (!(r->n > 0 && r->top / r->rms > best->top / best->rms)) {
        free(r->peak);
        return;
    }
    free(best->peak);
    *best = *r;
}

/* Find the clearest row, *best, and the number of rows.  The heads come first. */
static ss_status
find_clearest(scale_row *best, row_source *source, size_t rows, ss_error *err)
{
    ss_status st = SS_OK;
    *best = (scale_row){ .rms = 1 };
    for (size_t i = 0; i < rows; i++) {
        const scale_row *head = ss_row_head(source, label_of(source, i));
        if (head != NULL)
            keep_clearer(best, &(scale_row){ .f = head->f, .rms = head->rms_of_all, .top = head->top, .n = head->n });
    }
    if (best->n > 0)
        st = ss_row_new(best, source, best->f, NULL, err);
    for (size_t i = 0; st == SS_OK && i < rows; i++) {
        scale_row r = { 0 };
        if (ss_row_head(source, label_of(source, i)) != NULL)
            continue;
        st = ss_row_new(&r, source, label_of(source, i), NULL, err);
        if (st == SS_OK)
            keep_clearer(best, &r);
    }
    return st;
}

/* Find the peaks of the row that are above the threshold and within range. */
static ss_status
collect_bursts(ss_bursts *found, scale_row *r, double threshold, double range)
{
    size_t n = 0;
    if (r->n > 1)
        qsort(r->peak, r->n, sizeof *r->peak, stronger_first);
    found->burst = malloc((r->n + 1) * sizeof *found->burst);
    if (found->burst == NULL)
        return SS_ENOMEM;
    found->f = r->f;
    found->next = -INFINITY;
    found->floor = r->n > 0 ? 20 * log10(threshold * r->rms / r->top) : 0;
    for (; n < r->n && r->peak[n].level > threshold * r->rms; n++) {
        double level = 20 * log10(r->peak[n].level / r->top);
        if (level < -range) {
            found->next = level;
            break;
        }
        found->burst[found->n++] = (ss_burst){ r->peak[n].t, level, r->peak[n].level / r->rms };
    }
    qsort(found->burst, found->n, sizeof *found->burst, ss_ascending);
    return SS_OK;
}

ss_status
ss_bursts_find(ss_bursts **out, row_source *source, double range, ss_error *err)
{
    scale_row best = { .rms = 1 };
    double length = (double)(source->n - 1) / source->rate;
    double shortest = ROW_CENTER / (M_PI * ROW_HIGHEST * source->rate);
    double octaves = source->constant ? -1 : log2(length / (LONGEST * shortest));
    size_t rows = octaves >= 0 ? (size_t)(octaves * ROW_VOICES) + 1 : 0;
    ss_bursts *found = calloc(1, sizeof *found);
    if (found == NULL)
        return SS_ENOMEM;
    ss_status st = find_clearest(&best, source, rows, err);
    if (st == SS_OK)
        st = collect_bursts(found, &best, ss_row_threshold(length, shortest, rows), range);
    ss_row_source_free(source);
    free(best.peak);
    if (st != SS_OK) {
        ss_bursts_free(found);
        return st;
    }
    *out = found;
    return SS_OK;
}

void
ss_bursts_free(ss_bursts *found)
{
    if (found == NULL)
        return;
    free(found->burst);
    free(found);
}
