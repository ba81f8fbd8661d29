/* spectrum.c -- the power spectral density by Welch's method. */
#include <stickslip/spectrum.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "base/fft.h"
#include "signal/welch.h"

#define BANDWIDTH 1.5           /* of a Hann window, in steps of frequency */
enum { LEAST = 16 };            /* the shortest segment, in samples */
#define LONGEST 0x1p22          /* and the longest, unless it is asked for */

struct ss_welch {
    size_t length;              /* of a segment, a power of 2 */
    double rate;
    real_fft segment;           /* while its samples come, then its terms */
    double *half;               /* the second half of the segment before, which is the first of the next */
    size_t n, at;               /* samples so far; of the segment */
    ss_spectrum *sum;
};

static double
hann(size_t i, size_t length)
{
    double s = sin(M_PI * (double)i / (double)length);
    return s * s;
}

/* Add |X|^2 of the segment to the density. */
static void
add_segment(ss_welch *w)
{
    double *x = w->segment.x, *density = w->sum->density, first = x[0];
    double mean = first;        /* plus the mean of x - first, which is exactly 0 for a constant */
    size_t length = w->length;
    memcpy(w->half, x + length / 2, length / 2 * sizeof *x);
    for (size_t i = 0; i < length; i++)
        mean += (x[i] - first) / (double)length;
    for (size_t i = 0; i < length; i++)
        x[i] = (x[i] - mean) * hann(i, length);
    ss_real_fft_run(&w->segment);
    for (size_t k = 0; k <= length / 2; k++)
        density[k] += x[2 * k] * x[2 * k] + x[2 * k + 1] * x[2 * k + 1];
    w->sum->segments++;
}

ss_status
ss_welch_new(ss_welch **out, size_t n, double rate, double resolution, ss_error *err)
{
    *out = NULL;
    if (n < LEAST)
        return ss_fail(err, SS_EINVAL, "a spectrum needs at least %d samples, not %zu", LEAST, n);
    const double most = resolution > 0 ? BANDWIDTH * rate / resolution * (1 + 1e-9) : fmin((double)(n / 4), LONGEST);
    if (!(rate > 0 && resolution >= 0) || (resolution > 0 && (most > (double)n + 0.5 || most < LEAST - 0.5)))
        return ss_fail(err, SS_EINVAL, "%zu samples at %g Hz have no spectrum of resolution %g Hz: it is %g to "
                       "%g Hz", n, rate, resolution, BANDWIDTH * rate / (double)n, BANDWIDTH * rate / LEAST);
    size_t length = LEAST;
    while ((double)length * 2 <= most)
        length *= 2;
    ss_welch *w = calloc(1, sizeof *w);
    ss_spectrum *s = w != NULL ? w->sum = calloc(1, sizeof *s) : NULL;
    if (s == NULL || ss_real_fft_new(&w->segment, length, 0) != SS_OK
        || (w->half = malloc(length / 2 * sizeof *w->half)) == NULL
        || (s->density = calloc(length / 2 + 1, sizeof *s->density)) == NULL) {
        ss_welch_free(w);
        return ss_fail_memory(err, NULL);
    }
    w->length = length;
    w->rate = rate;
    s->n = length / 2 + 1;
    s->step = rate / (double)length;
    s->resolution = BANDWIDTH * s->step;
    *out = w;
    return SS_OK;
}

ss_status
ss_welch_add(ss_welch *w, const double *x, size_t n, ss_error *err)
{
    for (size_t i = 0; i < n; i++) {
        w->n++;
        if (!isfinite(x[i]))
            return ss_fail(err, SS_EINVAL, "sample %zu is not finite", w->n);
        if (w->at == w->length) {
            memcpy(w->segment.x, w->half, w->length / 2 * sizeof *x);
            w->at = w->length / 2;
        }
        w->segment.x[w->at++] = x[i];
        if (w->at == w->length)
            add_segment(w);
    }
    return SS_OK;
}

ss_status
ss_welch_end(ss_spectrum **out, ss_welch *w, ss_error *err)
{
    *out = NULL;
    if (w->sum->segments == 0)
        return ss_fail(err, SS_EINVAL, "a spectrum needs at least %zu samples, not %zu", w->length, w->n);
    ss_spectrum *s = w->sum;
    double power = 0;           /* the window's sum of squares */
    for (size_t i = 0; i < w->length; i++)
        power += hann(i, w->length) * hann(i, w->length);
    for (size_t k = 0; k < s->n; k++) {         /* the sum over the segments becomes their mean density */
        double sides = k > 0 && k < w->length / 2 ? 2 : 1;
        s->density[k] *= sides / (w->rate * power * (double)s->segments);
        if (!isfinite(s->density[k]))
            return ss_fail(err, SS_ERANGE, "the spectral density at %g Hz is not finite", (double)k * s->step);
    }
    *out = s;
    w->sum = NULL;
    return SS_OK;
}

void
ss_welch_free(ss_welch *w)
{
    if (w == NULL)
        return;
    ss_spectrum_free(w->sum);
    ss_real_fft_free(&w->segment);
    free(w->half);
    free(w);
}

ss_status
ss_spectrum_new(ss_spectrum **out, const double *x, size_t n, double rate, double resolution, ss_error *err)
{
    ss_welch *w;
    if (out == NULL || x == NULL)
        return SS_FAIL_NULL(err);
    ss_status st = ss_welch_new(&w, n, rate, resolution, err);
    if (st == SS_OK)
        st = ss_welch_add(w, x, n, err);
    if (st == SS_OK)
        st = ss_welch_end(out, w, err);
    ss_welch_free(w);
    return st;
}

void
ss_spectrum_free(ss_spectrum *s)
{
    if (s != NULL)
        free(s->density);
    free(s);
}
