/* noise_level.c -- find the level at which noise begins in a map of |W|.
 *
 * In Gaussian noise, re and im of W are independent and normal, so |W|^2 has an exponential
 * distribution: its quantile u is -s^2 ln(1 - u).  A scale shows noise if the quantiles of its
 * |W|^2 have these ratios in the lower half, which few events reach; they also give s.  The |W|^2
 * of steady oscillations varies far less; that of transients, with rounding between them, far
 * more.
 *
 * Quantiles are interpolated in histograms with bins of 1/8 of a binary order, 0.26 to 0.51 dB, so
 * no coefficient is kept. */
#include "plot/noise_level.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/sort.h"

enum { ORDERS = 1024, PART_BITS = 3, BINS = ORDERS << PART_BITS };
#define LEAST_ORDER (-512)      /* of |W|^2 */
#define RATIO_OFF 1.0           /* [dB] the largest error of a ratio of quantiles */
#define LENGTHS 100.0           /* the least number of independent coefficients for this */
#define SHARE 0.9               /* the part of the scales whose noise is no higher */
#define APART 2.0               /* scales per octave whose noise is independent */

struct noise_level {
    size_t n_scales;
    uint64_t *count;            /* BINS of each scale */
    double *power;              /* room for one of each */
};

void
ss_noise_level_free(noise_level *noise)
{
    if (noise != NULL) {
        free(noise->count);
        free(noise->power);
    }
    free(noise);
}

noise_level *
ss_noise_level_new(size_t n_scales)
{
    noise_level *noise = calloc(1, sizeof *noise);
    if (noise == NULL || (noise->count = calloc(n_scales, BINS * sizeof *noise->count)) == NULL
        || (noise->power = calloc(n_scales, sizeof *noise->power)) == NULL) {
        ss_noise_level_free(noise);
        return NULL;
    }
    noise->n_scales = n_scales;
    return noise;
}

/* The exponent of a double and the first bits behind its binary point, which count the bins. */
static size_t
bin_of(double power)
{
    int64_t bits;
    memcpy(&bits, &power, sizeof bits);
    int64_t bin = (bits >> (52 - PART_BITS)) - ((int64_t)(1023 + LEAST_ORDER) << PART_BITS);
    return (size_t)(bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin);
}

void
ss_noise_level_add(noise_level *noise, size_t i, const double *power, size_t first, size_t n, size_t step)
{
    uint64_t *count = noise->count + i * BINS;
    for (size_t k = first; k < n; k += step)
        count[bin_of(power[k])] += step;
}

/* The least power in a bin. */
static double
start_of(size_t bin)
{
    const size_t parts = 1 << PART_BITS;
    return ldexp(1 + (double)(bin % parts) / (double)parts, (int)(bin / parts) + LEAST_ORDER);
}

static double
quantile(const uint64_t *count, double total, double part)
{
    double left = part * total;
    size_t bin = 0;
    while (bin < BINS - 1 && (double)count[bin] <= left)
        left -= (double)count[bin++];
    return start_of(bin) + left / (double)count[bin] * (start_of(bin + 1) - start_of(bin));
}

/* Coefficients of a scale. */
static double
total_of(const uint64_t *count)
{
    double total = 0;
    for (size_t i = 0; i < BINS; i++)
        total += (double)count[i];
    return total;
}

/* The duration of the coefficients in lengths of the wavelet: so many of them are independent. */
static double
lengths_of(double total, const ss_scale *scale)
{
    return total * scale->b_num / scale->b_den / (2 * sqrt(M_PI) * scale->a);
}

/* s^2 of a scale's noise; 0 if it shows none. */
static double
power_of(const uint64_t *count, double total)
{
    static const double part[3] = { 0.1, 0.25, 0.5 };
    double q[3];
    for (int i = 0; i < 3; i++)
        q[i] = quantile(count, total, part[i]);
    for (int i = 1; i < 3; i++)
        if (!(fabs(10 * log10(q[i] / q[i - 1] * log1p(-part[i - 1]) / log1p(-part[i]))) <= RATIO_OFF))
            return 0;
    return q[1] / -log1p(-part[1]);
}

double
ss_noise_level(noise_level *noise, const ss_scale *scale)
{
    size_t n = noise->n_scales, found = 0;
    double *power = noise->power, independent = 0;
    double step = log2(scale[n - 1].f / scale[0].f) / (double)(n - 1);         /* octaves */
    for (size_t i = 0; i < n; i++) {
        const uint64_t *count = noise->count + i * BINS;
        double total = total_of(count), lengths = lengths_of(total, &scale[i]);
        independent += APART * step * lengths;
        if (lengths >= LENGTHS && (power[found] = power_of(count, total)) > 0)
            found++;
    }
    if (found == 0 || (double)found * step < 1)
        return 0;
    qsort(power, found, sizeof *power, ss_ascending);
    return sqrt(power[(size_t)(SHARE * (double)(found - 1))] * log(independent));
}
