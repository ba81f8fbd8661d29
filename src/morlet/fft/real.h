/* real.h -- FFTs of a whole record. */
#ifndef FFT_REAL_H
#define FFT_REAL_H

#include <complex.h>
#include <stddef.h>
#include <stickslip/status.h>

/* In place: n samples, n even, to the terms 0 ... n/2, real and imaginary part each, by exp(-i ...); or
 * back, n times as large.  x has room for n + 2.  SS_ENOMEM: x is as it was. */
ss_status ss_real_fft(double *x, size_t n, int back);

/* The same of n complex samples, stride apart, for each of so many records: these begin n samples apart
 * if the stride is 1, else one behind the other. */
ss_status ss_complex_fft(double complex *z, size_t n, size_t records, size_t stride, int back);

#endif
