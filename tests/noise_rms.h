/* noise_rms.h -- the standard deviation of noise of a given ratio: for tests. */
#ifndef NOISE_RMS_H
#define NOISE_RMS_H

#include "signal/noise.h"

/* Of noise whose power is snr [dB] below the variance of x. */
static inline double
noise_rms(const double *x, size_t n, double snr)
{
    ss_variance v = { .n = 0 };
    ss_variance_add(&v, x, n);
    return ss_variance_noise(&v, snr);
}

#endif
