/* noise.h -- noise, its level, and a converter's steps, in memory. */
#ifndef NOISE_H
#define NOISE_H

#include <gsl/gsl_rng.h>
#include <stickslip/signal.h>

/* A generator of GSL's, mt19937, to be freed by gsl_rng_free.  The same seed gives the same noise. */
ss_status ss_noise_new(gsl_rng **out, unsigned long seed, ss_error *err);
/* Add Gaussian white noise to several columns, n rows at a time.  That of column[c] has the standard deviation
 * rms[c]; unless this is > 0, no number is drawn.  SS_ERANGE, here and below: a sum is not finite; the columns
 * have then been changed. */
ss_status ss_noise_add(gsl_rng *noise, double *const column[], size_t n_columns, size_t n, const double *rms,
                       ss_error *err);
/* Add noise that has only frequencies in band [Hz], 0 <= from <= to <= rate / 2, to the n samples of one column.
 * The added noise has exactly this rms >= 0.  SS_EINVAL: no frequency of the record lies in the band. */
ss_status ss_noise_add_band(gsl_rng *noise, double *x, size_t n, double rate, ss_range band, double rms,
                            ss_error *err);
/* Add Gaussian white noise of standard deviation rms >= 0 to the n values of x. */
ss_status ss_noise_add_once(double *x, size_t n, double rms, unsigned long seed, ss_error *err);

/* A variance, which begins with zeros, of all values that were added. */
typedef struct ss_variance {
    size_t n;
    long double mean, square;   /* square: the sum of squares about the mean */
} ss_variance;
void ss_variance_add(ss_variance *variance, const double *x, size_t n);
/* The rms of noise whose power is snr_db [dB] below this variance. */
double ss_variance_noise(const ss_variance *variance, double snr_db);

/* Replace x by the output of a converter, as ss_noise_opts has it.  The number of samples beyond its range is
 * added to *clipped. */
ss_status ss_quantise(double *x, size_t n, int bits, double range, size_t *clipped, ss_error *err);

/* The options of benchmark signals by default. */
extern const ss_wave_opts ss_wave_defaults;

#endif
