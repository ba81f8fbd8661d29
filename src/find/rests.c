/* rests.c -- the stretches in which a signal stands still at one level.
 *
 * While a true stick lasts, velocity and acceleration are zero: the samples lie about one level, within the noise
 * of the record, whatever makes it.  The level is where samples are densest.  A motion that crosses the level does
 * not stop there: it passes the band about the level, and the wider one on either side, evenly.  A rest is as long
 * as it lasts in the band, and short beside it.  What is neither may be a short rest, or an extremum of a motion;
 * so may one whose samples are no noise about the level: it may hide a small motion, too.
 */
#include "find/rests.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/sort.h"
#include "find/judgement.h"
#include "find/medians.h"

#define AWAY (SIGMAS * SURELY)  /* standard deviations: what leaves the band of a rest by less is no motion */
#define RARE 2.5                /* standard deviations: few samples of a rest lie beyond */
#define PART 0.1                /* of the samples are at rest */

/* Level and standard deviation of the samples that are at rest, from the narrowest interval with PART of all
 * on. */
static ss_status
find_level(const double *x, size_t n, double *level, double *deviation)
{
    enum { PASSES = 12 };
    double *sorted = malloc((n + 1) * sizeof *sorted);
    size_t held = (size_t)(PART * (double)n), best = 0;
    if (sorted == NULL)
        return SS_ENOMEM;
    memcpy(sorted, x, n * sizeof *x);
    qsort(sorted, n, sizeof *sorted, ss_ascending);
    for (size_t i = 0; i + held < n; i++)
        if (sorted[i + held] - sorted[i] < sorted[best + held] - sorted[best])
            best = i;
    const double step = ss_smallest_change(sorted, n);
    *level = sorted[best + held / 2];
    *deviation = fmax(sorted[best + held] - sorted[best], step / 2);
    free(sorted);
    for (int pass = 0; pass < PASSES; pass++) {
        double sum = 0, squares = 0, m = 0;
        for (size_t i = 0; i < n; i++)
            if (fabs(x[i] - *level) <= SURELY * *deviation) {
                sum += x[i] - *level, squares += (x[i] - *level) * (x[i] - *level);
                m++;
            }
        *deviation = fmax(sqrt(fmax(0, squares / m - sum * sum / m / m)), step / 2);
        *level += sum / m;
    }
    return SS_OK;
}

ss_status
ss_rests_find(const double *x, size_t n, ss_rests *out)
{
    double level = 0, deviation = 0;
    *out = (ss_rests){ .rest = calloc(n / 2 + 1, sizeof *out->rest) };
    ss_status st = out->rest != NULL ? find_level(x, n, &level, &deviation) : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        ss_window in = { n, n };
        size_t from = i;
        for (; i < n && fabs(x[i] - level) <= AWAY * deviation; i++)
            if (fabs(x[i] - level) <= SURELY * deviation)
                in = (ss_window){ in.first < i ? in.first : i, i + 1 };
        size_t length = ss_window_length(in), beside = i - from - length;
        ss_window *last = out->n > 0 ? &out->rest[out->n - 1] : NULL;
        if (length >= 3 * beside + 2 && last != NULL && in.first <= last->end + 1)
            last->end = in.end;                 /* a glitch lies between */
        else if (length >= 3 * beside + 2)
            out->rest[out->n++] = in;
        else
            out->is_doubtful |= length >= beside + 2;
    }
    for (size_t i = 0; i < out->n; i++) {
        size_t beyond = 0;      /* more than noise, and a few wrong samples, put there? */
        for (size_t k = out->rest[i].first; k < out->rest[i].end; k++)
            beyond += fabs(x[k] - level) > RARE * deviation;
        out->is_doubtful |= (double)beyond > FEW + 2 * OUTLIERS * (double)ss_window_length(out->rest[i]);
    }
    out->level = level;
    out->band = SURELY * deviation;
    size_t above = 0, below = 0;        /* with none on one side it is the end of a range, where a converter clips */
    for (size_t i = 0; i < n; i++) {
        above += x[i] > level + out->band;
        below += x[i] < level - out->band;
    }
    out->is_end_of_range = (above == 0 || below == 0) && fabs(level) > SLIGHT;
    out->is_doubtful |= out->band > SLIGHT;     /* of the largest sample */
    return st;
}
