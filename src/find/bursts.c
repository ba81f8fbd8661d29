/* bursts.c -- find the few events of a record that is quiet between them, and how long each lasts.
 *
 * The row of |W| whose largest maximum is highest above the noise shows events best, whatever their
 * length and the colour of the noise.  The events are its maxima within a range of the largest; the
 * next lower maximum tells how certain this is.
 *
 * How long an event lasts |W| does not show: it is wider than the event by some scales on each side.  So a line is
 * fitted to the samples on one side that the wavelet does not reach.  The event ends at the last
 * sample that is farther from this line than noise is expected to come in m samples, sqrt(2 ln m)
 * of its standard deviations, before all samples are near the line for half a period.  (An
 * oscillation crosses the line more often.) */
#include <math.h>
#include <stdlib.h>
#include "base/list.h"
#include "find/events.h"
#include "find/judgement.h"

#define LONGEST 20.0            /* fewest scales in the record: some of them must be quiet */
#define AWAY 4.0                /* periods: a wavelet's reach, and the fewest periods of quiet for a line */

static int
stronger_first(const void *a, const void *b)
{
    double p = ((const peak *)a)->level, q = ((const peak *)b)->level;
    return (p < q) - (p > q);
}

ss_status
ss_bursts_find(ss_bursts *out, row_source *source, double range)
{
    scale_row best = { .rms = 1 };
    double length = (double)(source->n - 1) / source->rate;
    double shortest = ROW_CENTER / (M_PI * ROW_HIGHEST * source->rate);
    double octaves = source->constant ? -1 : log2(length / (LONGEST * shortest));
    size_t rows = octaves >= 0 ? (size_t)(octaves * ROW_VOICES) + 1 : 0, n = 0;
    ss_status st = SS_OK;
    for (size_t i = 0; st == SS_OK && i < rows; i++) {
        scale_row r = { 0 };
        st = ss_row_new(&r, source, ROW_HIGHEST * source->rate / 2 * exp2(-(double)i / ROW_VOICES), NULL);
        const int is_clearer = st == SS_OK && r.n > 0 && r.top / r.rms > best.top / best.rms;
        if (st == SS_OK)
            free(is_clearer ? best.peak : r.peak);
        best = is_clearer ? r : best;
    }
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

/* --- how long one lasts ------------------------------------------------------------------------ */

/* The last sample of the event on the side of `at` that ends with sample `end`. */
static size_t
last_of(const double *x, size_t at, size_t end, double period)
{
    size_t n = (end > at ? end - at : at - end) + 1, away = (size_t)ceil(AWAY * period), last = 0;
    double height = 0;
    if (n < 2 * away + 4)
        return at;
    ss_line quiet = ss_line_through(x, NULL, end > at ? (ss_window){ at + away + 1, end + 1 }
                                                   : (ss_window){ end, at - away });
    for (size_t k = 0; k <= away; k++)
        height = fmax(height, fabs(ss_line_off(&quiet, x, end > at ? at + k : at - k)));
    double band = fmax(quiet.rms * sqrt(2 * log((double)(n - away - 1))), FAINT * height);
    for (size_t k = 0; k < n && (double)(k - last) <= 0.5 * period; k++)
        if (fabs(ss_line_off(&quiet, x, end > at ? at + k : at - k)) > band)
            last = k;
    return end > at ? at + last : at - last;
}

ss_window
ss_extent(const double *x, ss_window win, size_t at, double period)
{
    return (ss_window){ last_of(x, at, win.first, period), last_of(x, at, win.end - 1, period) };
}
