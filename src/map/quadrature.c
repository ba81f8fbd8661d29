/* quadrature.c -- wavelet coefficients by their definition, the sum over samples.
 *
 * The trapezoidal rule is exact enough for a Gaussian window; the difficulties are the cut of the
 * window and a low cost of a tap.
 *
 * Cut.  In units of a^1/2 max|x| the taps with |u| >= R, u = (n/rate - b)/a, contribute at most
 *     tail(R) = 2 pi^-1/4 (d exp(-R^2/2) + sqrt(pi/2) erfc(R/sqrt 2)),   d = 1/(a rate),
 * the outermost tap of each side and the integral that bounds the rest.  A scale is first computed
 * with tail(R) = TOL/10, which suffices if the largest |W| found is not small beside max|x|.  Then
 * the promise is checked: max|W| - tail(R) is below the true maximum, and if tail(R) exceeds TOL
 * times that + TAIL_FLOOR, the taps out to the R which keeps this are added.  So two passes suffice, R
 * stays below 8.3, and no tap is computed twice.  TAIL_FLOOR is 4 eps; of the 16 eps promised the
 * other 12 are for rounding, of which tests/bench/bench_morlet finds 3.5 at most.
 *
 * Tap.  A coefficient's centre lies tau samples, |tau| <= 1/2, from the sample c nearest to it:
 *     conj h((k - tau) d) = T_k exp(k tau d^2) exp(-(tau d)^2/2) exp(i omega_c tau d)
 * for sample c + k, with T_k = conj h(k d) from a table made once a scale.  The last two factors
 * multiply the sum; exp(k tau d^2) is a product of three exps, one for the block of taps and two for
 * the place in the block: no recurrence, nothing accumulates.  Phases are reduced in cycles with
 * the products' rounding errors kept, so they are good to an ulp of pi for any omega_c and k. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/error.h"
#include "map/plan.h"

enum { BLOCK = 64, ROOT = 8, LANES = 4 };     /* BLOCK = ROOT^2 */

/* The wavelet of one scale at whole samples. */
typedef struct kernel {
    double d, d_low;                    /* 1/(a rate) and its rounding error */
    double cycles, cycles_low;          /* omega_c d / (2 pi), likewise */
    double second;                      /* exp(-omega_c^2/2) if admissible, else 0 */
    size_t taps;                        /* tables are filled for |k| < taps */
    double *re, *im, *gauss;            /* T_k and exp(-(k d)^2/2) at index k, also negative */
} kernel;

static kernel
kernel_of(const ss_morlet_opts *opts, double a, double rate)
{
    const double inv_2pi = 0.15915494309189535, inv_2pi_low = -9.8393371591263536e-18;
    kernel ker = { 0 };
    double p = a * rate, p_low = fma(a, rate, -p);
    ker.d = 1 / p;
    ker.d_low = ker.d * (fma(-ker.d, p, 1) - ker.d * p_low);
    double c = opts->center * inv_2pi;
    double c_low = fma(opts->center, inv_2pi, -c) + opts->center * inv_2pi_low;
    ker.cycles = c * ker.d;
    ker.cycles_low = fma(c, ker.d, -ker.cycles) + c * ker.d_low + c_low * ker.d;
    ker.second = wavelet_second(opts);
    return ker;
}

/* The angle omega_c k d without whole turns. */
static double
phase(const kernel *ker, double k)
{
    double turns = k * ker->cycles, low = fma(k, ker->cycles, -turns) + k * ker->cycles_low;
    return 2 * M_PI * (turns - rint(turns) + low);
}

static void
fill_tables(kernel *ker, size_t taps)
{
    for (; ker->taps < taps; ker->taps++) {
        ptrdiff_t k = (ptrdiff_t)ker->taps;
        double u = fma((double)k, ker->d, (double)k * ker->d_low), g = exp(-u * u / 2);
        double p = phase(ker, (double)k);
        ker->re[k] = ker->re[-k] = g * cos(p);
        ker->im[-k] = g * sin(p);
        ker->im[k] = -ker->im[-k];
        if (ker->second > 0)
            ker->gauss[k] = ker->gauss[-k] = g;
    }
}

static double
tail(const kernel *ker, double r)
{
    return 2 * PI_M14 * (1 + ker->second)
        * (ker->d * exp(-r * r / 2) + sqrt(M_PI / 2) * erfc(r / sqrt(2)));
}

/* The number of taps, |k| < taps, with which the tail is at most bound; at most n, which omits nothing. */
static size_t
taps_for(const kernel *ker, double bound, size_t n)
{
    double r = 1 + floor(16 * fmax(sqrt(2 * log(fmax(0.2 / bound, 1))) - 1, 0)) / 16;
    while (tail(ker, r) > bound)                /* it is more than 0.2 exp(-r^2/2) */
        r += 1. / 16;
    double taps = ceil(r / ker->d + 0.5);       /* 0.5 because |tau| <= 1/2 */
    return taps < (double)n ? (size_t)taps : n;
}

/* The sum of x_i g_i (re_i, im_i) over n taps, in lanes that a compiler may put into one register. */
static void
block_sum(const double *restrict x, const double *restrict g, const double *restrict re,
          const double *restrict im, size_t n, double sum[2])
{
    double s[LANES] = { 0 }, t[LANES] = { 0 };
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            double y = x[i + l] * g[i + l];
            s[l] += y * re[i + l];
            t[l] += y * im[i + l];
        }
    for (; i < n; i++) {
        s[0] += x[i] * g[i] * re[i];
        t[0] += x[i] * g[i] * im[i];
    }
    sum[0] = (s[0] + s[1]) + (s[2] + s[3]);
    sum[1] = (t[0] + t[1]) + (t[2] + t[3]);
}

/* Add y to *sum, and the rounding error of this to *low. */
static void
add(double *sum, double *low, double y)
{
    double s = *sum + y, back = s - *sum;
    *low += (*sum - (s - back)) + (y - back);
    *sum = s;
}

/* The centre of a coefficient: tau samples after sample c. */
typedef struct place {
    ptrdiff_t c;
    double tau, q;                      /* q = tau d^2 */
    double g[BLOCK];                    /* exp(j q) */
} place;

/* The sum over the taps lo <= k <= hi of x[c + k] exp(k q) (re_k, im_k). */
static void
wing(const place *at, const double *x, const double *re, const double *im, ptrdiff_t lo,
     ptrdiff_t hi, double sum[2])
{
    double low[2] = { 0, 0 }, part[2];
    sum[0] = sum[1] = 0;
    for (ptrdiff_t k = lo; k <= hi; k += BLOCK) {
        size_t n = hi - k < BLOCK ? (size_t)(hi - k) + 1 : BLOCK;
        block_sum(x + at->c + k, at->g, re + k, im + k, n, part);
        double g = at->q == 0 ? 1 : exp(at->q * (double)k);
        add(&sum[0], &low[0], g * part[0]);
        add(&sum[1], &low[1], g * part[1]);
    }
    sum[0] += low[0];
    sum[1] += low[1];
}

/* Fill in the place of b, with the first `width` numbers of at->g. */
static void
locate(place *at, const kernel *ker, spot b, size_t width)
{
    double fine[ROOT];
    at->c = (ptrdiff_t)b.c;
    at->tau = b.tau;
    at->q = at->tau * ker->d * ker->d;
    for (size_t j = 0; j < ROOT; j++)
        fine[j] = at->q == 0 ? 1 : exp(at->q * (double)j);
    for (size_t i = 0; i < BLOCK && i < width; i += ROOT) {
        double coarse = at->q == 0 ? 1 : exp(at->q * (double)i);
        for (size_t j = 0; j < ROOT; j++)
            at->g[i + j] = coarse * fine[j];
    }
}

/* Add to w, in units of a^1/2, the taps from <= |k| < to of the coefficient at b. */
static void
add_taps(const kernel *ker, const record *rec, spot b, size_t from, size_t to, double w[2])
{
    double sum[2], second[2] = { 0, 0 }, part[2];
    const double *x = rec->x;
    place at;
    locate(&at, ker, b, 2 * to);
    at.c -= rec->origin;
    ptrdiff_t first = -at.c, last = (ptrdiff_t)rec->n - 1 - at.c, out = (ptrdiff_t)to - 1;
    ptrdiff_t lo = first > -out ? first : -out, hi = last < out ? last : out;
    ptrdiff_t in = (ptrdiff_t)from - 1; /* |k| <= in is in w already */

    /* first the taps to the left of those in w, or all at once; then those to the right */
    ptrdiff_t cut = from == 0 ? hi : hi < -in - 1 ? hi : -in - 1;
    wing(&at, x, ker->re, ker->im, lo, cut, sum);
    if (ker->second > 0)
        wing(&at, x, ker->gauss, ker->gauss, lo, cut, second);
    if (from > 0) {
        ptrdiff_t start = lo > in + 1 ? lo : in + 1;
        wing(&at, x, ker->re, ker->im, start, hi, part);
        sum[0] += part[0];
        sum[1] += part[1];
        if (ker->second > 0) {
            wing(&at, x, ker->gauss, ker->gauss, start, hi, part);
            second[0] += part[0];
        }
    }
    double u = at.tau * ker->d, scale = PI_M14 * ker->d * exp(-u * u / 2);
    double p = phase(ker, at.tau), c = cos(p), s = sin(p);
    w[0] += scale * (c * sum[0] - s * sum[1] - ker->second * second[0]);
    w[1] += scale * (c * sum[1] + s * sum[0]);
}

/* --- scales -------------------------------------------------------------------------------- */

struct wavelet {
    kernel ker;
    size_t room;                        /* taps with a tail of at most TAIL_FLOOR, or n */
    double *base;                       /* the memory of its tables */
};

size_t
ss_wavelet_bytes(const ss_morlet_opts *opts, double a, double rate, size_t n)
{
    kernel ker = kernel_of(opts, a, rate);
    return 6 * sizeof(double) * taps_for(&ker, TAIL_FLOOR, n);
}

wavelet *
ss_wavelet_new(const ss_morlet_opts *opts, double a, double rate, size_t n)
{
    wavelet *wave = malloc(sizeof *wave);
    if (wave == NULL)
        return NULL;
    kernel *ker = &wave->ker;
    *ker = kernel_of(opts, a, rate);
    size_t taps = wave->room = taps_for(ker, TAIL_FLOOR, n), width = 2 * taps - 1;
    wave->base = taps > SIZE_MAX / (8 * sizeof(double)) ? NULL : malloc(3 * width * sizeof(double));
    if (wave->base == NULL) {
        free(wave);
        return NULL;
    }
    ker->re = wave->base + taps - 1;
    ker->im = ker->re + width;
    ker->gauss = ker->im + width;
    return wave;
}

void
ss_wavelet_free(wavelet *wave)
{
    if (wave == NULL)
        return;
    free(wave->base);
    free(wave);
}

/* Add to w the taps from <= |k| < to of a part of a scale, and return the largest |W|. */
static double
add_to_part(const kernel *ker, const record *rec, double rate, const ss_scale *scale, span part,
            size_t from, size_t to, double *w)
{
    double most = 0;
    for (size_t i = 0; i < part.n; i++, w += 2) {
        add_taps(ker, rec, ss_scale_spot(scale, part.first + i, rate), from, to, w);
        most = fmax(most, w[0] * w[0] + w[1] * w[1]);
    }
    return sqrt(most);
}

/* The second pass adds the taps that the largest |W| of the first requires, as the head says. */
void
ss_quadrature_scale(const ss_morlet *plan, const ss_scale *scale, const record *rec,
                    wavelet *wave, span part, double factor, double *most, double *w)
{
    kernel *ker = &wave->ker;
    double tol = plan->opts.accuracy, bound = tol / 10, before = *most;
    size_t n = rec->n < wave->room ? rec->n : wave->room, from = 0;
    for (size_t i = 0; i < 2 * part.n; i++)
        w[i] = 0;

    for (int pass = 0; pass < 2 && rec->x_max > 0; pass++) {
        size_t to = taps_for(ker, fmax(bound, TAIL_FLOOR), n);
        if (to <= from)
            break;
        fill_tables(ker, to);
        *most = fmax(before, add_to_part(ker, rec, plan->rate, scale, part, from, to, w));
        double cut = to >= rec->n ? 0 : tail(ker, ((double)to - 0.5) * ker->d);
        bound = tol * fmax(0, *most / rec->x_max - cut) + TAIL_FLOOR;
        if (cut <= bound)
            break;
        from = to;
    }
    for (size_t i = 0; i < 2 * part.n; i++)
        w[i] *= factor;
}

/* Add Re(w h) to x, over all taps of the coefficient w at b. */
static void
add_wavelet(const kernel *ker, size_t n, spot b, const double w[2], double *x)
{
    place at;
    locate(&at, ker, b, 2 * ker->taps);
    ptrdiff_t out = (ptrdiff_t)ker->taps - 1, last = (ptrdiff_t)n - 1 - at.c;
    ptrdiff_t lo = -at.c > -out ? -at.c : -out, hi = last < out ? last : out;
    double u = at.tau * ker->d, scale = PI_M14 * ker->d * exp(-u * u / 2);
    double p = phase(ker, at.tau), c = cos(p), s = sin(p);
    double re = scale * (w[0] * c + w[1] * s), im = scale * (w[0] * s - w[1] * c);
    double second = ker->second * scale * w[0];
    for (ptrdiff_t k = lo; k <= hi; k += BLOCK) {
        ptrdiff_t width = hi - k < BLOCK ? hi - k + 1 : BLOCK;
        double g = at.q == 0 ? 1 : exp(at.q * (double)k), *y = x + at.c + k;
        for (ptrdiff_t j = 0; j < width; j++)
            y[j] += g * at.g[j] * (re * ker->re[k + j] - im * ker->im[k + j]);
        for (ptrdiff_t j = 0; second != 0 && j < width; j++)
            y[j] -= g * at.g[j] * second * ker->gauss[k + j];
    }
}

void
ss_quadrature_adjoint(const ss_morlet *plan, const ss_scale *scale, wavelet *wave, span part,
                      double factor, const double *w, double *x)
{
    fill_tables(&wave->ker, wave->room);
    for (size_t i = 0; i < part.n; i++) {
        double one[2] = { factor * w[2 * i], factor * w[2 * i + 1] };
        add_wavelet(&wave->ker, plan->n, ss_scale_spot(scale, part.first + i, plan->rate), one, x);
    }
}

ss_status
ss_quadrature_points(const ss_morlet *plan, const ss_scale *scale, const record *rec,
                     const size_t *k, size_t n, double *w)
{
    wavelet *wave = ss_wavelet_new(&plan->opts, scale->a, plan->rate, rec->n);
    if (wave == NULL)
        return SS_ENOMEM;
    fill_tables(&wave->ker, wave->room);
    for (size_t i = 0; i < n; i++) {
        w[2 * i] = w[2 * i + 1] = 0;
        add_taps(&wave->ker, rec, ss_scale_spot(scale, k[i], plan->rate), 0, wave->room, w + 2 * i);
    }
    ss_wavelet_free(wave);
    return SS_OK;
}
