/* noise.h -- white noise, and its level, in one call. */
#ifndef NOISE_H
#define NOISE_H

#include <stickslip/signal.h>
/* Add Gaussian white noise of standard deviation rms >= 0 to the n values of x.  The same seed
 * gives the same noise (GSL's mt19937 and its Ziggurat). */
ss_status ss_noise_add_once(double *x, size_t n, double rms, unsigned long seed, ss_error *err);
/* The rms of noise whose power is snr_db [dB] below the variance of x about its mean. */
double ss_noise_rms(const double *x, size_t n, double snr_db);

#endif
