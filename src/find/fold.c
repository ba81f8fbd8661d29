/* fold.c -- the mean cycle of a signal that repeats itself.
 *
 * The mean of cycles shows micro-slips that noise hides in each of them, as its noise is less by
 * the root of their number.  CYCLES copies of the mean are put one behind the other, so that the
 * ends do not influence the cycles in the middle. */
#include "find/fold.h"

#include <stdlib.h>

enum { CYCLES = 3, FEWEST = 4 };        /* copies of the mean cycle; fewest cycles to average */

ss_status
ss_fold_spikes(const search *s, ss_spikes **out, double *period)
{
    double samples = s->rate / s->out->number[SS_REPETITION_FREQUENCY].value;      /* NaN if nothing repeats */
    *out = NULL;
    *period = samples / s->rate;
    if (!(samples * (CYCLES + FEWEST) <= (double)s->n))
        return SS_OK;
    size_t n = (size_t)(samples * CYCLES);
    size_t over = (size_t)(((double)s->n - 1 - (double)n) / samples);
    double *mean = calloc(2 * n, sizeof *mean);
    if (mean == NULL)
        return SS_ENOMEM;
    double *used = mean + n;
    for (size_t k = 0; k < over; k++) {
        size_t first = (size_t)((double)k * samples + 0.5);
        for (size_t i = 0; i < n; i++) {
            if (s->n_gaps > 0 && ss_gaps_near(s->gap, s->n_gaps, (double)(first + i) / s->rate, 0))
                continue;
            mean[i] += s->x[first + i];
            used[i]++;
        }
    }
    for (size_t i = 0; i < n; i++)
        mean[i] = used[i] > 0 ? mean[i] / used[i] : 0;
    ss_status st = ss_spikes_find(out, mean, n, s->rate, &ss_spike_defaults, NULL);
    free(mean);
    return st;
}
