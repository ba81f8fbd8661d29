/* noise.c -- the errors of a measurement: white noise, noise of a band, a converter's steps.
 *
 * Numbers are drawn with GSL's mt19937 and its Ziggurat.  Noise of a band is made as a spectrum:
 * it has Gaussian numbers at the frequencies of the band and zeros elsewhere, and is scaled to the
 * given rms.  The number of samples of its inverse transform is a power of two; the record takes
 * the first of them. */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include "base/error.h"
#include "base/fft.h"
#include "signal/noise.h"
#include <stickslip/signal.h>

/* An ss_noise is a generator of GSL's. */
static gsl_rng *
generator(ss_noise *noise)
{
    return (gsl_rng *)noise;
}

ss_status
ss_noise_new(ss_noise **out, unsigned long seed, ss_error *err)
{
    if (out == NULL)
        return SS_FAIL_NULL(err);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    *out = (ss_noise *)rng;
    if (rng == NULL)
        return ss_fail_memory(err, NULL);
    gsl_rng_set(rng, seed);
    return SS_OK;
}

static ss_status
refuse_sum(ss_error *err)
{
    return ss_fail(err, SS_ERANGE, "signal and noise exceed what a double holds");
}

ss_status
ss_noise_add(ss_noise *noise, double *const column[], size_t n_columns, size_t n, const double *rms,
             ss_error *err)
{
    if (noise == NULL || column == NULL || rms == NULL)
        return SS_FAIL_NULL(err);
    double zero = 0;                    /* NaN once a sum is not finite */
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < n_columns; c++)
            if (rms[c] > 0) {
                column[c][i] += gsl_ran_gaussian_ziggurat(generator(noise), rms[c]);
                zero += 0 * column[c][i];
            }
    return zero == 0 ? SS_OK : refuse_sum(err);
}

ss_status
ss_noise_add_band(ss_noise *noise, double *x, size_t n, double rate, ss_range band, double rms,
                  ss_error *err)
{
    if (noise == NULL || (x == NULL && n > 0))
        return SS_FAIL_NULL(err);
    size_t m = 2;
    double square = 0, lo = band.from, hi = band.to;
    if (!(rms >= 0 && isfinite(rms)) || !(rate > 0) || n > SIZE_MAX / 64)
        return ss_fail(err, SS_EINVAL, "the rms of noise must be 0 or more");
    if (!(lo >= 0 && lo <= hi && hi <= rate / 2))
        return ss_fail(err, SS_EINVAL, "band %g to %g Hz: not between 0 and half the rate, %g Hz",
                       lo, hi, rate / 2);
    while (m < n)
        m *= 2;
    real_fft f;
    if (ss_real_fft_new(&f, m, 1) != SS_OK)
        return ss_fail_memory(err, NULL);
    memset(f.x, 0, (m + 2) * sizeof *f.x);
    double *y = f.x;
    size_t first = (size_t)ceil(lo / rate * (double)m), last = (size_t)floor(hi / rate * (double)m);
    last = last < m / 2 ? last : m / 2;
    for (size_t k = first; k <= last; k++) {    /* Gaussian numbers at the frequencies of the band */
        y[2 * k] = gsl_ran_gaussian_ziggurat(generator(noise), 1);
        if (k > 0 && k < m / 2)
            y[2 * k + 1] = gsl_ran_gaussian_ziggurat(generator(noise), 1);
    }
    if (first > last) {
        ss_real_fft_free(&f);
        return ss_fail(err, SS_EINVAL, "band %g to %g Hz: a record of %zu sample%s at %g Hz has "
                       "no frequency in it", lo, hi, n, PLURAL(n), rate);
    }
    ss_real_fft_run(&f);
    for (size_t i = 0; i < n; i++)
        square += y[i] * y[i];
    double gain = square > 0 ? rms / sqrt(square / (double)n) : 0, zero = 0;
    for (size_t i = 0; i < n; i++) {
        x[i] += gain * y[i];
        zero += 0 * x[i];
    }
    ss_real_fft_free(&f);
    return zero == 0 ? SS_OK : refuse_sum(err);
}

void
ss_noise_free(ss_noise *noise)
{
    gsl_rng_free(generator(noise));
}

ss_status
ss_noise_add_once(double *x, size_t n, double rms, unsigned long seed, ss_error *err)
{
    ss_noise *noise = NULL;
    if (x == NULL && n > 0)
        return SS_FAIL_NULL(err);
    if (!(rms >= 0 && isfinite(rms)))
        return ss_fail(err, SS_EINVAL, "the rms of noise must be 0 or more");
    ss_status st = ss_noise_new(&noise, seed, err);
    if (st == SS_OK && n > 0)
        st = ss_noise_add(noise, &x, 1, n, &rms, err);
    ss_noise_free(noise);
    return st;
}

/* --- its level ----------------------------------------------------------------------------- */

void
ss_variance_add(ss_variance *v, const double *x, size_t n)
{
    for (size_t i = 0; v != NULL && x != NULL && i < n; i++) {
        long double off = x[i] - v->mean;
        v->mean += off / ++v->n;
        v->square += off * (x[i] - v->mean);
    }
}

double
ss_variance_noise(const ss_variance *v, double snr_db)
{
    if (v == NULL)
        return NAN;
    return v->n > 0 ? (double)sqrtl(v->square / v->n) * pow(10, -snr_db / 20) : 0;
}

double
ss_noise_rms(const double *x, size_t n, double snr_db)
{
    ss_variance v = { .n = 0 };
    ss_variance_add(&v, x, n);
    return ss_variance_noise(&v, snr_db);
}

ss_status
ss_samples_quantise(double *x, size_t n, int bits, double range, size_t *clipped,
                    ss_error *err)
{
    if (x == NULL && n > 0)
        return SS_FAIL_NULL(err);
    if (bits < 1 || bits > SS_BITS_MAX)
        return ss_fail(err, SS_EINVAL, "%d bits are out of range 1 ... %d", bits, SS_BITS_MAX);
    double codes = ldexp(1, bits - 1), step = range / codes;
    if (!(step > 0 && isfinite(range)))
        return ss_fail(err, SS_EINVAL, "range %g has no steps of %d bits", range, bits);
    for (size_t i = 0; i < n; i++) {
        double code = rint(x[i] / step), kept = fmin(fmax(code, -codes), codes - 1);
        if (clipped != NULL)
            *clipped += kept != code;
        x[i] = step * kept + 0.0;     /* no -0 */
    }
    return SS_OK;
}
