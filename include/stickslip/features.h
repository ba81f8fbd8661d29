/* stickslip/features.h -- from wavelet coefficients to what a contour plot shows. */
#ifndef STICKSLIP_FEATURES_H
#define STICKSLIP_FEATURES_H

#include <stddef.h>
#include <stickslip/status.h>
#include <stickslip/morlet.h>

SS_BEGIN_DECLARATIONS

/* A local maximum of |W| over time and scale: the middle of a closed contour. */
typedef struct ss_maximum {
    double t;               /* [s] from the first sample */
    double f;               /* label omega_c / (2 pi a) [Hz] */
    double level;           /* [dB] re the largest |W| outside the cone of influence */
    double prominence;      /* [dB] above the highest saddle towards any higher point of the map;
                               infinite where there is no way to a higher one */
} ss_maximum;

/* Coefficients must have n > 0, n_scales > 0 and translations at every scale, as all have that
 * ss_transform makes or that are read.
 *
 * All local maxima outside the cone of influence with at least the given prominence, in time order;
 * *out is to be freed with free().  Translations of neighbouring scales differ: a coefficient's
 * neighbours are those of its row and, in the two rows beside, those nearest to it in time.  What is
 * highest on the border of the map (its first and last scale, or beside the cone) is no maximum. */
ss_status ss_maxima(ss_maximum **out, size_t *n, const ss_coefficients *coefficients,
                    double min_prominence);

/* The maxima over time of |W| along one scale, outside the cone of influence, with at least the
 * given prominence along it and not more than range dB below the highest of them: the spikes that
 * reach this high.  f is the same for all. */
ss_status ss_spikes(ss_maximum **out, size_t *n, const ss_coefficients *coefficients, size_t scale,
                    double range, double min_prominence);

SS_END_DECLARATIONS
#endif
