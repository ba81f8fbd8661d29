/* plan.h -- what the files of the wavelet transform share. */
#ifndef PLAN_H
#define PLAN_H

#include <float.h>
#include <stddef.h>
#include <stickslip/morlet.h>

#define PI_M14 0.75112554446494248286   /* pi^-1/4 */
/* Of the 16 eps promised, what the parts of the wavelet that are left out may take. */
#define TAIL_FLOOR (4 * DBL_EPSILON)

struct ss_morlet {
    ss_morlet_opts opts;
    size_t n;               /* samples */
    double rate;            /* [Hz] */
    size_t n_scales;
    ss_scale *scale;        /* long to short */
    size_t total;           /* coefficients */
    struct fft *fft;        /* NULL: all by quadrature */
};

/* A copy of the samples, detrended, times the power of two that brings max|x| into [1/2, 1). */
typedef struct record {
    size_t n;
    double *x, x_max;       /* x_max = max|x|; x is the caller's to free */
    int exponent;           /* the samples are x 2^exponent */
} record;

/* SS_EINVAL if a sample is not finite. */
ss_status ss_morlet_record(record *rec, const double *x, size_t n, ss_detrend detrend,
                           ss_error *err);

/* w, in units of a^1/2 and of the record, in the norm and the samples' own size. */
ss_status ss_morlet_finish(double *w, size_t n, double a, ss_norm norm, int exponent,
                           ss_error *err);

/* SS_OK if every option lies in its range and n samples at this rate are a record. */
ss_status ss_morlet_check(size_t n, double rate, const ss_morlet_opts *opts, ss_error *err);

/* Fill in scale j of the grid but for its offset; a NaN means 2^(j/V).  SS_EINVAL if its
 * translations are too many to count. */
ss_status ss_morlet_scale_at(ss_scale *scale, int j, double a, size_t n, double rate,
                             const ss_morlet_opts *opts, ss_error *err);

/* All coefficients of a scale, factor times those in units of a^1/2 and of the record; and about
 * what they cost [s]. */
ss_status ss_quadrature_scale(const ss_morlet *plan, const ss_scale *scale, const record *rec,
                              double factor, double *w);
double ss_quadrature_cost(const ss_morlet *plan, const ss_scale *scale);

/* The same at any b, by the definition, as exactly as double precision allows, for factor 1. */
ss_status ss_quadrature_points(const ss_morlet *plan, const ss_scale *scale, const record *rec,
                               const double *b, size_t n, double *w);

/* Choose the scales that are transformed by FFT, all that can be or those where it is cheaper, and
 * prepare for them: plan->fft, NULL if there are none. */
ss_status ss_fft_new(ss_morlet *plan);
void ss_fft_free(struct fft *fft);                     /* NULL is allowed */
int ss_fft_takes(const struct fft *fft, size_t i);     /* scale i */

/* The record's spectra, which threads share, and the same for scale i. */
typedef struct spectra {
    double *level[2];
    double *size[2];        /* sums of their sizes, in steps; NULL: not needed */
} spectra;
ss_status ss_fft_forward(const struct fft *fft, const record *rec, spectra *out);
void ss_fft_release(spectra *s);
void ss_fft_scale(const ss_morlet *plan, size_t i, const record *rec, const spectra *s,
                  double *scratch, double factor, double *w);
double *ss_fft_scratch(const struct fft *fft);         /* for one thread; NULL: no memory */
void ss_fft_scratch_free(double *scratch);

#endif
