/* edge.c -- whether an oscillation is that of a filter.
 *
 * A low-pass filter with steep sides rings behind each jump near its corner, at one frequency and with one
 * damping, as a contact does.  But a contact amplifies what it rings with, so that its spectrum has a
 * peak above the power law that the slips make at lower frequencies.  That of a filter follows this law
 * up to its corner, and falls below it behind. */
#include "find/edge.h"

#include <math.h>
#include <stickslip/spectrum.h>

#define FLAT 1.3                /* power re the power law: with more there is a peak */
#define STEEP 3.2               /* power law re the power beyond: with more there is a corner */
#define STEP 1.67               /* from band to band, each from 1 / WIDE to WIDE of its middle */
#define WIDE 1.18
#define FINE (1 / 32.)          /* resolution re the oscillation; coarser in records of under four segments */

/* The mean density in the band about f. */
static double
mean_about(const ss_spectrum *s, double f)
{
    double sum = 0, n = 0;
    for (double k = ceil(f / WIDE / s->step); k <= f * WIDE / s->step && k < (double)s->n; k++, n++)
        sum += s->density[(size_t)k];
    return n > 0 ? sum / n : NAN;
}

ss_status
ss_edge_find(const double *x, size_t n, double f, int *is_edge)
{
    ss_spectrum *s = NULL;
    ss_status st = ss_spectrum_new(&s, x, n, 1, fmax(FINE * f, 6 / (double)n), NULL);
    *is_edge = 0;
    if (st == SS_ENOMEM)
        return st;
    if (st != SS_OK)
        return SS_OK;
    double at = mean_about(s, f), before = mean_about(s, f / STEP), law = before / mean_about(s, f / STEP / STEP);
    *is_edge = at < FLAT * law * before && STEEP * mean_about(s, f * STEP) < law * at;
    ss_spectrum_free(s);
    return SS_OK;
}
