/* spectrum.h -- the power spectral density of a record. */
#ifndef STICKSLIP_SPECTRUM_H
#define STICKSLIP_SPECTRUM_H

#include <stddef.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* By P. Welch's method (1967): the mean of the periodograms of segments that overlap by half, each without its
 * mean and under a Hann window.  One-sided: the sum of density[k] * step is the mean square of the record
 * about the means. */
typedef struct ss_spectrum {
    size_t n;                   /* densities, of k * step, k = 0 ... n - 1, up to half the rate */
    double step;                /* [Hz] */
    double *density;            /* [unit^2/Hz] */
    double resolution;          /* [Hz] the bandwidth of the window, 1.5 step */
    size_t segments;            /* each of 2 (n - 1) samples, a power of 2 */
} ss_spectrum;

/* Of n >= 16 samples.  resolution [Hz]: about, the segments being the longest with at least this bandwidth that
 * the record has; 0: seven segments or more.  SS_EINVAL: a sample is not finite, or the resolution is less than
 * 1.5 rate / n or more than 1.5 rate / 16; SS_ERANGE: a density is not finite. */
ss_status ss_spectrum_new(ss_spectrum **out, const double *x, size_t n, double rate, double resolution,
                          ss_error *err);
void ss_spectrum_free(ss_spectrum *spectrum);           /* NULL is allowed */

SS_END_DECLARATIONS
#endif
