/* grid.c -- the scales and translations of a transform, and the ones that it refuses.
 *
 * Scales are numbered: a = 2^(j/V).  Every limit (a frequency, octaves, the sampling, the record's length) becomes
 * a range of V log2 a, widened by SLACK so that a limit which is a scale includes it, and then a range of integers
 * j.  So a request is refused for a scale that it contains, not for the frequency that it names.
 *
 * Translations of a stepped grid are 2^p/m samples apart, m from a short list of odd numbers: the largest such
 * step that does not exceed B_0 a.  Then any 2^p samples that begin at a translation hold a whole number of steps,
 * and inverse FFTs of short lengths give all coefficients (fft/blocks.c).  m B_0 <= STEPS_REPEAT keeps 2^p below
 * twice the reach of the wavelet; steps above B_0 = 1 are few and stay exact.  The grid follows from options, rate
 * and j alone. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/error.h"
#include "base/number.h"
#include "base/options.h"
#include "map/plan.h"

#define SLACK 1e-9          /* added to j, because V log2 a is rounded, by less than 1e-10 */
#define STEPS_REPEAT 17     /* the wavelet reaches 8.5 a to either side */

/* The values of m for which FFTs of m 2^k points are fast.  The steps that they allow are at most 12.5 %
 * apart, or 17 % at B_0 = 1. */
static const int odd_part[] = { 1, 35, 9, 5, 21, 45, 3, 25, 7, 15 };
enum { ODD_PARTS = sizeof odd_part / sizeof *odd_part };

const ss_morlet_opts ss_morlet_defaults = {
    .size = sizeof(ss_morlet_opts), .center = WAVELET_CENTER, .voices = 16, .step = 0.25, .engine = SS_ENGINE_AUTO,
    .accuracy = 1e-6, .norm = SS_NORM_L2, .detrend = SS_DETREND_NONE, .threads = 1
};

SS_OPTIONS(ss_morlet_opts, ss_morlet_defaults)

ss_status
ss_morlet_take(ss_morlet_opts *own, const ss_morlet_opts *given, ss_error *err)
{
    return ss_options_take(own, sizeof *own, &ss_morlet_defaults, given, err);
}

const struct ss_morlet_ranges ss_morlet_ranges = {
    .rate = { 1e-100, 1e100 }, .center = { 2, 1000 }, .voices = { 1, 1024 }, .step = { 1e-6, 1e6 },
    .frequency = { 1e-100, 1e100 }, .octave = { -500, 500 }, .accuracy = { 1e-13, 0.1 },
    .inverse_accuracy = { 1e-12, 0.1 }
};

typedef struct range {
    double lo, hi;          /* the range of j, in whole numbers; empty if lo > hi */
} range;

static range
whole(double a_lo, double a_hi, int voices)
{
    return (range){ ceil(voices * log2(a_lo) - SLACK), floor(voices * log2(a_hi) + SLACK) };
}

static double
label(double j, const ss_morlet_opts *opts)
{
    return opts->center / (2 * M_PI * exp2(j / opts->voices));
}

/* The scales that the sampling resolves and the record can hold, see stickslip/morlet.h; n is 0 if the
 * length of the record is not known. */
static range
usable(size_t n, double rate, const ss_morlet_opts *opts)
{
    double a_lo = (opts->center + sqrt(-2 * log(opts->accuracy))) / (M_PI * rate);
    double a_hi = n > 0 ? (double)n / rate / (2 * sqrt(2)) : INFINITY;
    return whole(a_lo, a_hi, opts->voices);
}

static range
requested_range(size_t n, double rate, const ss_morlet_opts *opts, range use)
{
    double per_f = opts->center / (2 * M_PI);   /* a = per_f / f */
    if (opts->octaves)
        return whole(exp2(opts->m0), exp2(opts->m1), opts->voices);
    range ask = use;
    if (opts->fmax > 0)
        ask.lo = whole(per_f / opts->fmax, 1, opts->voices).lo;
    if (opts->fmin > 0)
        ask.hi = whole(1, per_f / opts->fmin, opts->voices).hi;
    else {
        double four_cycles = whole(1, per_f * (double)n / rate / 4, opts->voices).hi;
        if (four_cycles >= ask.lo)
            ask.hi = fmin(use.hi, four_cycles);
        ask.hi = fmax(ask.hi, ask.lo);
    }
    if (opts->fmax == 0)        /* a limit that was asked for is kept even if it is not usable */
        ask.lo = fmin(ask.lo, ask.hi);
    return ask;
}

/* Refuse scales that are not usable, by the limit as it was given. */
static ss_status
refuse(range use, size_t n, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    double low = n > 0 ? label(use.hi, opts) : 0, high = label(use.lo, opts);
    int by_fmax = opts->fmax > 0 && (opts->fmax > high || opts->fmax < low || !(opts->fmin > 0));
    char samples[32] = "", from[40] = "up", asked[64];
    if (n > 0) {
        snprintf(samples, sizeof samples, "%zu ", n);
        ss_print_to(from, sizeof from, "from %.6g", low);
    }
    if (opts->octaves)
        ss_print_to(asked, sizeof asked, "octaves %g to %g", opts->m0, opts->m1);
    else
        ss_print_to(asked, sizeof asked, "%s %g Hz", by_fmax ? "fmax" : "fmin", by_fmax ? opts->fmax : opts->fmin);
    return ss_fail(err, SS_ESCALE, "%ssamples at %g Hz resolve scales %s to %.6g Hz within accuracy %g, not %s",
                   samples, rate, from, high, opts->accuracy, asked);
}

static ss_status
check_request(range ask, range use, size_t n, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    int complete = opts->octaves || (opts->fmin > 0 && opts->fmax > 0);
    if (use.lo > use.hi && !(opts->force && complete)) {
        double need = ceil(2 * sqrt(2) * rate * exp2(use.lo / opts->voices));
        return ss_fail(err, SS_ESCALE, "a record of %zu sample%s at %g Hz is too short for any "
                       "scale that its sampling resolves within accuracy %g; %.0f samples are "
                       "needed%s", n, PLURAL(n), rate, opts->accuracy, need,
                       opts->force ? ", or both limits of frequency" : "");
    }
    if (!opts->force && (ask.lo < use.lo || ask.hi > use.hi))
        return refuse(use, n, rate, opts, err);
    if (ask.lo > ask.hi)
        return ss_fail(err, SS_EINVAL, "no scale lies between these limits of frequency; %d voices "
                       "an octave are next to them at %.6g and %.6g Hz", opts->voices,
                       label(ask.lo, opts), label(ask.hi, opts));
    if (fmax(fabs(ask.lo), fabs(ask.hi)) > 500.0 * opts->voices)
        return ss_fail(err, SS_EINVAL, "scales must lie between 2^-500 and 2^500 s");
    return SS_OK;
}

ss_status
ss_morlet_check(size_t n, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    if (n == 0)
        return ss_fail(err, SS_EINVAL, "the record is empty");
    const struct ss_morlet_ranges *in = &ss_morlet_ranges;
    const struct { double x; ss_range range; const char *name; } number[] = {
        { rate, in->rate, "rate [Hz]" }, { opts->center, in->center, "center" },
        { opts->voices, in->voices, "voices" }, { opts->dense ? in->step.to : opts->step, in->step, "step" },
        { opts->accuracy, in->accuracy, "accuracy" }
    };
    for (size_t i = 0; i < sizeof number / sizeof *number; i++)
        if (ss_range_check(number[i].x, number[i].range, number[i].name, err) != SS_OK)
            return SS_EINVAL;
    if (!(opts->fmin >= 0 && opts->fmin <= in->frequency.to && opts->fmax >= 0
          && opts->fmax <= in->frequency.to)
        || (opts->fmin > 0 && opts->fmax > 0 && opts->fmin > opts->fmax))
        return ss_fail(err, SS_EINVAL, "no frequencies between fmin %g and fmax %g Hz", opts->fmin, opts->fmax);
    if (opts->octaves && !(opts->m0 >= in->octave.from && opts->m0 <= opts->m1
                           && opts->m1 <= in->octave.to))
        return ss_fail(err, SS_EINVAL, "octaves %g:%g are not ascending in %g ... %g", opts->m0,
                       opts->m1, in->octave.from, in->octave.to);
    if ((unsigned)opts->norm > SS_NORM_L1 || (unsigned)opts->detrend > SS_DETREND_LINEAR
        || (unsigned)opts->engine > SS_ENGINE_FFT)
        return ss_fail(err, SS_EINVAL, "unknown norm, detrend or engine");
    if (opts->threads < 1 || opts->threads > SS_THREADS_MAX)
        return ss_fail(err, SS_EINVAL, "threads %d is out of range 1 ... %d", opts->threads, SS_THREADS_MAX);
    return SS_OK;
}

double
ss_scale_b(const ss_scale *scale, size_t k)
{
    if (scale == NULL)
        return NAN;
    return (double)k * scale->b_num / scale->b_den;
}

static int
is_power_of_two(double x)
{
    return frexp(x, &(int){ 0 }) == 0.5;
}

double
ss_scale_parts(const ss_scale *scale, double rate)
{
    double parts = rint(scale->b_den / rate);
    int listed = 0;
    for (int i = 0; i < ODD_PARTS; i++)
        listed |= parts == odd_part[i];
    return listed && scale->b_den == parts * rate && is_power_of_two(scale->b_num) ? parts : 0;
}

spot
ss_scale_spot(const ss_scale *scale, size_t k, double rate)
{
    double parts = ss_scale_parts(scale, rate), all = (double)k * scale->b_num;
    if (parts == 0) {
        double b = ss_scale_b(scale, k), c = rint(b * rate);
        return (spot){ c, c / rate == b ? 0 : fma(b, rate, -c) };
    }
    double c = rint(all / parts);
    return (spot){ c, fma(-c, parts, all) / parts };
}

int
ss_scale_edge(const ss_scale *scale, size_t k, size_t n, double rate)
{
    if (scale == NULL)
        return 1;
    double b = ss_scale_b(scale, k), cone = wavelet_cone(scale->a);
    return b < cone || (double)(n - 1) / rate - b < cone;
}

/* The division differs from the count that ss_scale_b gives by at most one, because of rounding. */
size_t
ss_scale_count(const ss_scale *scale, double t)
{
    size_t n = (size_t)floor(t * scale->b_den / scale->b_num);
    while (ss_scale_b(scale, n) <= t)
        n++;
    while (ss_scale_b(scale, n - 1) > t)
        n--;
    return n;
}

/* Choose the largest step of 2^p/m samples that is at most `samples`. */
static void
choose_step(ss_scale *scale, double samples, double rate, double step)
{
    double best = 0;
    for (int i = 0; i < ODD_PARTS; i++) {
        double m = odd_part[i], two = ldexp(1, ilogb(samples * m));
        if (m * step > STEPS_REPEAT || two / m <= best)
            continue;
        best = two / m;
        scale->b_num = two;
        scale->b_den = m * rate;
    }
}

ss_status
ss_morlet_scale_at(ss_scale *scale, int j, double a, size_t n, double rate,
                   const ss_morlet_opts *opts, ss_error *err)
{
    int v = opts->voices, octave = j >= 0 ? j / v : -((v - 1 - j) / v);     /* rounded down */
    if (isnan(a))       /* then an octave is a factor of exactly 2 */
        a = ldexp(exp2((double)(j - octave * v) / v), octave);
    *scale = (ss_scale){ .j = j, .m = (double)j / v, .a = a, .f = opts->center / (2 * M_PI * a),
                         .b_num = opts->dense ? 1 : opts->step * a,
                         .b_den = opts->dense ? rate : 1 };
    if (!(scale->b_num >= 1e-300))
        return ss_fail(err, SS_EINVAL, "step %g is too small", opts->step);
    /* the paper's grid, of one voice and steps that are powers of two, needs no other steps */
    if (!opts->dense && !opts->exact && opts->step <= 1 && (v > 1 || !is_power_of_two(scale->b_num)))
        choose_step(scale, scale->b_num * rate, rate, opts->step);
    if (n == 0)
        return SS_OK;
    double last = (double)(n - 1) / rate;
    if (!(last * scale->b_den / scale->b_num < 0x1p50))
        return ss_fail(err, SS_EINVAL, "the translation step %g s is too small for a record of %g s",
                       scale->b_num / scale->b_den, last);
    scale->n = ss_scale_count(scale, last);
    return SS_OK;
}

ss_status
ss_grid_make(ss_scale **scale, size_t *n_scales, size_t n, double rate, const ss_morlet_opts *opts, ss_error *err)
{
    range use = usable(n, rate, opts), ask = requested_range(n, rate, opts, use);
    ss_status st = check_request(ask, use, n, rate, opts, err);
    if (st != SS_OK)
        return st;
    *n_scales = (size_t)(ask.hi - ask.lo) + 1;
    *scale = calloc(*n_scales, sizeof **scale);
    if (*scale == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < *n_scales; i++)
        st = ss_morlet_scale_at(*scale + i, (int)ask.hi - (int)i, NAN, n, rate, opts, err);
    if (st != SS_OK) {
        free(*scale);
        *scale = NULL;
    }
    return st;
}
