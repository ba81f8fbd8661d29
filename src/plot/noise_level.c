/* noise_level.c -- find the level at which noise begins in a map of |W|.
 *
 * In Gaussian noise, re and im of W are independent and normal, so |W|^2 has an exponential distribution: its
 * quantile u is -s^2 ln(1 - u).  A scale can show noise only if the quantiles of its |W|^2 have these ratios in
 * the lower half, which few events reach; they also give s.  The |W|^2 of steady oscillations varies far less;
 * that of transients, with rounding between them, far more.
 *
 * The many harmonics of a tone have this distribution, too, but they have structure: |W|^2 rises and falls slowly,
 * or repeats.  The |W|^2 of noise forgets itself within a length of the wavelet.  So its autocorrelation tells the
 * two apart; levels above the median do not count, so that events that repeat do not hide the noise between them.
 *
 * Quantiles are interpolated in histograms with bins of 1/8 of a binary order, 0.26 to 0.51 dB, and
 * autocorrelations are means over parts of the record, so memory does not grow. */
#include "plot/contour.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/fft.h"
#include "base/list.h"

enum { ORDERS = 1024, PART_BITS = 3, BINS = ORDERS << PART_BITS };
#define LEAST_ORDER (-512)      /* of |W|^2 */
#define RATIO_OFF 1.0           /* [dB] the largest error of a ratio of quantiles */
#define LENGTHS 100.0           /* the least number of independent coefficients for this */
#define SHARE 0.9               /* the part of the scales whose noise is no higher */
#define APART 2.0               /* scales per octave whose noise is independent */

/* The autocorrelation is that of parts of PART levels, two a length.  From the lag of a length on, that
 * of noise is 0 but for its scatter, below .25 for 200 levels; that of noise with events above it for
 * 30 % of the time is below .2.  Of a long record, each ALL_PARTS-th part is enough. */
enum { PART = 1024, LENGTH_LAG = 2, ALL_PARTS = 8 };
#define STRUCTURE 0.3

struct of_scale {
    uint64_t count[BINS];
    double level[PART];         /* the bins of its latest levels */
    size_t levels, parts;       /* how many of these there are, and parts before them */
    double spectrum[PART + 1];  /* the sum over its parts */
};

struct noise_level {
    size_t n_scales;
    struct of_scale *scale;
    double *power;              /* room for one of each */
    real_fft forth, back;       /* of a part, with as many zeros behind it */
};

void
ss_noise_level_free(noise_level *noise)
{
    if (noise == NULL)
        return;
    free(noise->scale);
    free(noise->power);
    ss_real_fft_free(&noise->forth);
    ss_real_fft_free(&noise->back);
    free(noise);
}

noise_level *
ss_noise_level_new(size_t n_scales)
{
    noise_level *noise = calloc(1, sizeof *noise);
    if (noise == NULL)
        return NULL;
    noise->n_scales = n_scales;
    noise->scale = calloc(n_scales, sizeof *noise->scale);
    noise->power = calloc(n_scales, sizeof *noise->power);
    if (noise->scale != NULL && noise->power != NULL && ss_real_fft_new(&noise->forth, 2 * PART, 0) == SS_OK
        && ss_real_fft_new(&noise->back, 2 * PART, 1) == SS_OK)
        return noise;
    ss_noise_level_free(noise);
    return NULL;
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

/* End a part, and add the power spectrum of its levels, those above the median so far cut off. */
static void
end_part(noise_level *noise, struct of_scale *of)
{
    const size_t n = of->levels, part = of->parts++;
    double *x = noise->forth.x, mean = 0;
    of->levels = 0;
    if (part >= ALL_PARTS && part % ALL_PARTS != 0)
        return;
    const double median = (double)bin_of(quantile(of->count, total_of(of->count), 0.5));
    memset(x, 0, 2 * PART * sizeof *x);
    for (size_t k = 0; k < n; k++)
        mean += x[k] = fmin(of->level[k], median);
    for (size_t k = 0; k < n; k++)
        x[k] -= mean / (double)n;
    ss_real_fft_run(&noise->forth);
    for (size_t k = 0; k <= PART; k++)
        of->spectrum[k] += x[2 * k] * x[2 * k] + x[2 * k + 1] * x[2 * k + 1];
}

/* Two coefficients per length of the wavelet, 2 sqrt(pi) a, measure noise as well as all do, since those
 * between follow from them: the 0th and each that is so many behind. */
void
ss_noise_level_add(noise_level *noise, const ss_scale *scale, size_t i, const double *level, size_t first,
                   size_t n)
{
    struct of_scale *of = &noise->scale[i];
    size_t step = (size_t)fmax(1, floor(sqrt(M_PI) * scale->a * scale->b_den / scale->b_num));
    for (size_t k = (step - first % step) % step; k < n; k += step) {
        size_t bin = bin_of(level[k] * level[k]);
        of->count[bin] += step;
        of->level[of->levels++] = (double)bin;
        if (of->levels == PART)
            end_part(noise, of);
    }
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

/* Does |W|^2 of a scale have structure: does it change slowly, or repeat? */
static int
has_structure(noise_level *noise, struct of_scale *of)
{
    double *x = noise->back.x, most = 0;
    end_part(noise, of);
    for (size_t k = 0; k <= PART; k++) {
        x[2 * k] = of->spectrum[k];
        x[2 * k + 1] = 0;
    }
    ss_real_fft_run(&noise->back);
    for (size_t lag = LENGTH_LAG; lag <= PART / 2; lag++)
        most = fmax(most, x[lag]);
    return !(most < STRUCTURE * x[0]);
}

double
ss_noise_level(noise_level *noise, const ss_scale *scale)
{
    size_t n = noise->n_scales, found = 0;
    double *power = noise->power, independent = 0;
    double step = log2(scale[n - 1].f / scale[0].f) / (double)(n - 1);         /* octaves */
    for (size_t i = 0; i < n; i++) {
        struct of_scale *of = &noise->scale[i];
        double total = total_of(of->count);
        /* their duration in lengths of the wavelet: so many coefficients are independent */
        double lengths = total * scale[i].b_num / scale[i].b_den / (2 * sqrt(M_PI) * scale[i].a);
        independent += APART * step * lengths;
        if (lengths >= LENGTHS && (power[found] = power_of(of->count, total)) > 0 && !has_structure(noise, of))
            found++;
    }
    if (found == 0 || (double)found * step < 1)
        return 0;
    qsort(power, found, sizeof *power, ss_ascending);
    return sqrt(power[(size_t)(SHARE * (double)(found - 1))] * log(independent));
}
