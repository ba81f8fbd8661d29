/* real.h -- FFTs of a whole real record. */
#ifndef FFT_REAL_H
#define FFT_REAL_H

#include <stddef.h>
#include <stickslip/status.h>

/* In place: n samples, n even, to the terms 0 ... n/2, real and imaginary part each, by exp(-i ...); or
 * back, n times as large.  x has room for n + 2.  SS_ENOMEM: x is as it was. */
ss_status ss_real_fft(double *x, size_t n, int back);

#endif
