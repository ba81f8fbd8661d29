/* stickslip/spectrum.h -- the power spectral density of a record. */
#ifndef STICKSLIP_SPECTRUM_H
#define STICKSLIP_SPECTRUM_H

#include <stddef.h>
#include <stickslip/signal.h>
#include <stickslip/status.h>

SS_BEGIN_DECLARATIONS

/* A spectrum by the method of P. Welch (1967): the mean of the periodograms of segments that
 * overlap by half; from each segment its mean is subtracted, then a Hann window is applied.  It is
 * one-sided: the sum of density[k] * step is the mean square of the segments about their means. */
typedef struct ss_spectrum {
    size_t n;                   /* density[k] is at k * step, k = 0 ... n - 1, up to half the rate */
    double step;                /* [Hz] */
    double *density;            /* [unit^2/Hz] */
    double resolution;          /* [Hz] the bandwidth of the window, 1.5 step */
    size_t segments;            /* each of 2 (n - 1) samples, a power of 2 */
} ss_spectrum;

/* Of columns of any length, as a reader gives them, ss_spectrum_write and ss_plot_spectrum of stickslip/plot.h write
 * and draw spectra.
 *
 * Estimate the spectrum of n >= 16 samples.  The segments are the longest whose bandwidth is at
 * least resolution [Hz]; with 0 there are at least seven, of at most 2^22 samples.  SS_EINVAL: a sample is
 * not finite, or the resolution is not within 1.5 rate / n ... 1.5 rate / 16; SS_ERANGE: a density is not
 * finite. */
ss_status ss_spectrum_new(ss_spectrum **out, const double *x, size_t n, double rate, double resolution,
                          ss_error *err);
void ss_spectrum_free(ss_spectrum *spectrum);           /* NULL is allowed */

SS_END_DECLARATIONS
#endif
