/* spectrum.c -- the power spectral density by Welch's method, with GSL's FFT. */
#include <stickslip/spectrum.h>

#include <gsl/gsl_fft_real.h>
#include <math.h>
#include <stdlib.h>
#include "base/error.h"

#define BANDWIDTH 1.5           /* of a Hann window, in steps of frequency */
enum { LEAST = 16 };            /* the shortest segment, in samples */

/* The length of the segments, a power of 2; 0 if n samples cannot have this resolution. */
static size_t
length_of(size_t n, double rate, double resolution)
{
    double most = resolution > 0 ? BANDWIDTH * rate / resolution * (1 + 1e-9) : (double)(n / 4);
    size_t length = LEAST;
    if (resolution > 0 && (most > (double)n + 0.5 || most < LEAST - 0.5))
        return 0;
    while ((double)length * 2 <= most)
        length *= 2;
    return length;
}

static double
hann(size_t i, size_t length)
{
    double s = sin(M_PI * (double)i / (double)length);
    return s * s;
}

/* Add |X|^2 of a segment to the density; part has room for one segment. */
static void
add_segment(double *density, const double *x, double *part, size_t length)
{
    double mean = x[0];         /* plus the mean of x - x[0], which is exactly 0 for a constant */
    for (size_t i = 0; i < length; i++)
        mean += (x[i] - x[0]) / (double)length;
    for (size_t i = 0; i < length; i++)
        part[i] = (x[i] - mean) * hann(i, length);
    gsl_fft_real_radix2_transform(part, 1, length);
    density[0] += part[0] * part[0];
    density[length / 2] += part[length / 2] * part[length / 2];
    for (size_t k = 1; k < length / 2; k++)
        density[k] += part[k] * part[k] + part[length - k] * part[length - k];
}

/* Divide the sum over the segments so that it becomes their mean density. */
static ss_status
finish(ss_spectrum *s, size_t length, double rate, ss_error *err)
{
    double power = 0;           /* the window's sum of squares */
    for (size_t i = 0; i < length; i++)
        power += hann(i, length) * hann(i, length);
    for (size_t k = 0; k < s->n; k++) {
        double sides = k > 0 && k < length / 2 ? 2 : 1;
        s->density[k] *= sides / (rate * power * (double)s->segments);
        if (!isfinite(s->density[k]))
            return ss_fail(err, SS_ERANGE, "the spectral density at %g Hz is not finite", (double)k * s->step);
    }
    return SS_OK;
}

ss_status
ss_spectrum_new(ss_spectrum **out, const double *x, size_t n, double rate, double resolution, ss_error *err)
{
    if (out == NULL || x == NULL)
        return SS_FAIL_NULL(err);
    if (n < LEAST)
        return ss_fail(err, SS_EINVAL, "%zu samples have no spectrum, which needs %d at least", n, LEAST);
    size_t length = rate > 0 && resolution >= 0 ? length_of(n, rate, resolution) : 0;
    if (length == 0)
        return ss_fail(err, SS_EINVAL, "%zu samples at %g Hz have no spectrum of resolution %g Hz: it is %g to "
                       "%g Hz", n, rate, resolution, BANDWIDTH * rate / (double)n, BANDWIDTH * rate / LEAST);
    for (size_t i = 0; i < n; i++)
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EINVAL, "sample %zu is not finite", i + 1);
    ss_spectrum *s = calloc(1, sizeof *s);
    double *part = malloc(length * sizeof *part);
    ss_status st = SS_OK;
    if (s == NULL || part == NULL || (s->density = calloc(length / 2 + 1, sizeof *s->density)) == NULL)
        st = ss_fail_memory(err, NULL);
    if (st == SS_OK) {
        s->n = length / 2 + 1;
        s->step = rate / (double)length;
        s->resolution = BANDWIDTH * s->step;
        for (size_t i = 0; i + length <= n; i += length / 2, s->segments++)
            add_segment(s->density, x + i, part, length);
        st = finish(s, length, rate, err);
    }
    free(part);
    if (st != SS_OK)
        ss_spectrum_free(s);
    else
        *out = s;
    return st;
}

void
ss_spectrum_free(ss_spectrum *s)
{
    if (s != NULL)
        free(s->density);
    free(s);
}
