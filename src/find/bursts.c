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

/* Find the clearest row, *best, of so many.  The heads come first. */
static ss_status
find_clearest(scale_row *best, row_source *source, size_t rows)
{
    ss_status st = SS_OK;
    for (size_t i = 0; i < rows; i++) {
        const scale_row *head = ss_row_head(source, label_of(source, i));
        if (head != NULL)
            keep_clearer(best, &(scale_row){ .f = head->f, .rms = head->rms_of_all, .top = head->top, .n = head->n });
    }
    if (best->n > 0)
        st = ss_row_new(best, source, best->f, NULL);
    for (size_t i = 0; st == SS_OK && i < rows; i++) {
        scale_row r = { 0 };
        if (ss_row_head(source, label_of(source, i)) != NULL)
            continue;
        st = ss_row_new(&r, source, label_of(source, i), NULL);
        if (st == SS_OK)
            keep_clearer(best, &r);
    }
    return st;
}

ss_status
ss_bursts_find(ss_bursts *out, row_source *source, double range)
{
    scale_row best = { .rms = 1 };
    double length = (double)(source->n - 1) / source->rate;
    double shortest = ROW_CENTER / (M_PI * ROW_HIGHEST * source->rate);
    double octaves = source->constant ? -1 : log2(length / (LONGEST * shortest));
    size_t rows = octaves >= 0 ? (size_t)(octaves * ROW_VOICES) + 1 : 0, n = 0;
    ss_status st = find_clearest(&best, source, rows);
    double noise = ss_row_threshold(length, shortest, rows) * best.rms;
    ss_row_source_free(source);
    if (best.n > 0)
        qsort(best.peak, best.n, sizeof *best.peak, stronger_first);
    *out = (ss_bursts){ .burst = best.peak, .f = best.f, .next = -INFINITY,
                        .floor = best.n > 0 ? 20 * log10(noise / best.top) : 0 };
    for (; n < best.n && best.peak[n].level > noise && isinf(out->next); n++) {
        const double level = best.peak[n].level = 20 * log10(best.peak[n].level / best.top);
        if (level < -range)
            out->next = level;
        else
            out->n++;
    }
    if (out->n > 0)
        qsort(out->burst, out->n, sizeof *out->burst, ss_ascending);
    return st;
}
