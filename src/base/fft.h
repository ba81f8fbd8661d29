/* fft.h -- FFTs of records, of segments and of cycles. */
#ifndef FFT_H
#define FFT_H

#include <complex.h>
#include <pthread.h>
#include <stddef.h>
#include <stickslip/status.h>

/* FFTW's planner is not safe for threads: making and freeing of plans take turns.
 * Other users of FFTW in the program must not plan at the same time. */
extern pthread_mutex_t ss_fftw_planner;

/* An FFT in place: n samples, n even, to the terms 0 ... n/2, real and imaginary part each, by exp(-i ...); or
 * back, n times as large. */
typedef struct real_fft {
    double *x;                  /* n + 2 */
    void *plan;
} real_fft;

/* SS_ENOMEM: f holds nothing, as if it were {0}. */
ss_status ss_real_fft_new(real_fft *f, size_t n, int back);
/* Plan the way back for what n samples have become. */
ss_status ss_real_fft_turn(real_fft *f, size_t n);
void ss_real_fft_run(const real_fft *f);
void ss_real_fft_free(real_fft *f);                     /* {0} is allowed */

/* The FFTs of so many records of n complex samples, one behind the other. */
ss_status ss_complex_fft(double complex *z, size_t n, size_t records, int back);

#endif
