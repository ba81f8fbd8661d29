/* wavelet.h -- the constants of the Morlet wavelet, h(t) = pi^-1/4 exp(i omega_c t) exp(-t^2/2). */
#ifndef WAVELET_H
#define WAVELET_H

#include <math.h>
#include <stickslip/morlet.h>
#include "signal/gaps.h"

#define PI_M14 0.75112554446494248286   /* pi^-1/4 */
#define WAVELET_CENTER 6.0              /* omega_c, where none is asked for */

/* The factor of the second term of h; 0 where that is left out. */
static inline double
wavelet_second(const ss_morlet_opts *opts)
{
    return opts->admissible ? exp(-opts->center * opts->center / 2) : 0;
}

/* The width of the cone of influence at scale a: |h|^2 has fallen to exp(-2). */
static inline double
wavelet_cone(double a)
{
    return sqrt(2) * a;
}

/* 1 if coefficient k of a scale lies in the cone of influence of an end of the record, which has n
 * samples from start on, or of one of its gaps. */
static inline int
wavelet_edge(const ss_scale *scale, size_t k, size_t n, double rate, double start, const ss_span *gap,
             size_t n_gaps)
{
    return ss_scale_edge(scale, k, n, rate)
        || (n_gaps > 0 && ss_gaps_near(gap, n_gaps, start + ss_scale_b(scale, k), wavelet_cone(scale->a)));
}

#endif
