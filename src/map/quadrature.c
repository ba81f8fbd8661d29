/* quadrature.c -- wavelet coefficients by their definition, the sum over samples, and the adjoint of this sum.
 *
 * The trapezoidal rule is exact enough for a Gaussian window, of which the taps beyond REACH a are left out; the
 * difficulty is a low cost of a tap.  A coefficient's centre lies tau samples, |tau| <= 1/2, from the sample c
 * nearest to it:
 *     conj h((k - tau) d) = T_k exp(k tau d^2) exp(-(tau d)^2/2) exp(i omega_c tau d),   d = 1/(a rate),
 * for sample c + k, with T_k = conj h(k d) from a table made once a scale.  The last two factors
 * multiply the sum; exp(k tau d^2) is a product of three exps, one for the block of taps and two for
 * the place in the block: no recurrence, nothing accumulates.  Phases are reduced in cycles with
 * the products' rounding errors kept, so they are good to an ulp of pi for any omega_c and k.  Of the 16 eps
 * promised for rounding, tests/bench/bench_morlet finds 3.5 at most. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/error.h"
#include "map/plan.h"

enum { BLOCK = 64, ROOT = 8, LANES = 4 };     /* BLOCK = ROOT^2 */

struct wavelet {
    double d, d_low;                    /* 1/(a rate) and its rounding error */
    double cycles, cycles_low;          /* omega_c d / (2 pi), likewise */
    double second;                      /* exp(-omega_c^2/2) if admissible, else 0 */
    size_t taps;                        /* |k| < taps */
    double *base;                       /* the memory of the tables: */
    double *re, *im, *gauss;            /* T_k and exp(-(k d)^2/2) at index k, also negative */
};

/* The angle omega_c k d without whole turns. */
static double
phase(const wavelet *wave, double k)
{
    double turns = k * wave->cycles, low = fma(k, wave->cycles, -turns) + k * wave->cycles_low;
    return 2 * M_PI * (turns - rint(turns) + low);
}

static void
set_rates(wavelet *wave, const ss_morlet_opts *opts, double a, double rate)
{
    const double inv_2pi = 0.15915494309189535, inv_2pi_low = -9.8393371591263536e-18;
    double p = a * rate, p_low = fma(a, rate, -p);
    wave->d = 1 / p;
    wave->d_low = wave->d * (fma(-wave->d, p, 1) - wave->d * p_low);
    double c = opts->center * inv_2pi;
    double c_low = fma(opts->center, inv_2pi, -c) + opts->center * inv_2pi_low;
    wave->cycles = c * wave->d;
    wave->cycles_low = fma(c, wave->d, -wave->cycles) + c * wave->d_low + c_low * wave->d;
    wave->second = wavelet_second(opts);
}

wavelet *
ss_wavelet_new(const ss_morlet_opts *opts, double a, double rate, size_t n)
{
    /* on either side, and one: those within REACH a of a centre half a sample away; more than n add nothing */
    double reach = ceil(REACH * a * rate + 0.5);
    size_t taps = reach < (double)n ? (size_t)reach : n, width = 2 * taps - 1;
    wavelet *wave = calloc(1, sizeof *wave);
    if (wave != NULL && taps <= SIZE_MAX / (8 * sizeof(double)))
        wave->base = malloc(3 * width * sizeof(double));
    if (wave == NULL || wave->base == NULL) {
        free(wave);
        return NULL;
    }
    set_rates(wave, opts, a, rate);
    wave->taps = taps;
    wave->re = wave->base + taps - 1;
    wave->im = wave->re + width;
    wave->gauss = wave->im + width;
    for (ptrdiff_t k = 0; k < (ptrdiff_t)taps; k++) {
        double u = fma((double)k, wave->d, (double)k * wave->d_low), g = exp(-u * u / 2);
        double p = phase(wave, (double)k);
        wave->re[k] = wave->re[-k] = g * cos(p);
        wave->im[-k] = g * sin(p);
        wave->im[k] = -wave->im[-k];
        wave->gauss[k] = wave->gauss[-k] = g;
    }
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

/* --- a coefficient ---------------------------------------------------------------------------- */

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

/* The centre of a coefficient: tau samples after sample c; taps lo ... hi are of samples. */
typedef struct place {
    ptrdiff_t c, lo, hi;
    double tau, q;                      /* q = tau d^2 */
    double g[BLOCK];                    /* exp(j q) */
    double size, turn[2];               /* of the sum: pi^-1/4 d exp(-(tau d)^2/2), and exp(i omega_c tau d) */
} place;

/* The sum over the taps of x[c + k] exp(k q) (re_k, im_k). */
static void
add_up(const place *at, const double *x, const double *re, const double *im, double sum[2])
{
    double low[2] = { 0, 0 }, part[2];
    sum[0] = sum[1] = 0;
    for (ptrdiff_t k = at->lo; k <= at->hi; k += BLOCK) {
        size_t n = at->hi - k < BLOCK ? (size_t)(at->hi - k) + 1 : BLOCK;
        block_sum(x + at->c + k, at->g, re + k, im + k, n, part);
        double g = at->q == 0 ? 1 : exp(at->q * (double)k);
        add(&sum[0], &low[0], g * part[0]);
        add(&sum[1], &low[1], g * part[1]);
    }
    sum[0] += low[0];
    sum[1] += low[1];
}

/* Fill in the place of b, and its taps of n samples. */
static void
locate(place *at, const wavelet *wave, spot b, size_t n)
{
    double fine[ROOT];
    ptrdiff_t out = (ptrdiff_t)wave->taps - 1, last = (ptrdiff_t)n - 1 - (ptrdiff_t)b.c;
    at->c = (ptrdiff_t)b.c;
    at->tau = b.tau;
    at->q = at->tau * wave->d * wave->d;
    at->lo = -at->c > -out ? -at->c : -out;
    at->hi = last < out ? last : out;
    for (size_t j = 0; j < ROOT; j++)
        fine[j] = at->q == 0 ? 1 : exp(at->q * (double)j);
    for (size_t i = 0; i < BLOCK && i < 2 * wave->taps; i += ROOT) {
        double coarse = at->q == 0 ? 1 : exp(at->q * (double)i);
        for (size_t j = 0; j < ROOT; j++)
            at->g[i + j] = coarse * fine[j];
    }
    double u = at->tau * wave->d, p = phase(wave, at->tau);
    at->size = PI_M14 * wave->d * exp(-u * u / 2);
    at->turn[0] = cos(p);
    at->turn[1] = sin(p);
}

void
ss_wavelet_sum(const wavelet *wave, const record *rec, spot b, double w[2])
{
    double sum[2], second[2] = { 0, 0 };
    place at;
    locate(&at, wave, b, rec->n);
    add_up(&at, rec->x, wave->re, wave->im, sum);
    if (wave->second > 0)
        add_up(&at, rec->x, wave->gauss, wave->gauss, second);
    w[0] = at.size * (at.turn[0] * sum[0] - at.turn[1] * sum[1] - wave->second * second[0]);
    w[1] = at.size * (at.turn[0] * sum[1] + at.turn[1] * sum[0]);
}

void
ss_wavelet_add(const wavelet *wave, size_t n, spot b, const double w[2], double *x)
{
    place at;
    locate(&at, wave, b, n);
    double re = at.size * (w[0] * at.turn[0] + w[1] * at.turn[1]);
    double im = at.size * (w[0] * at.turn[1] - w[1] * at.turn[0]), second = wave->second * at.size * w[0];
    for (ptrdiff_t k = at.lo; k <= at.hi; k += BLOCK) {
        ptrdiff_t width = at.hi - k < BLOCK ? at.hi - k + 1 : BLOCK;
        double g = at.q == 0 ? 1 : exp(at.q * (double)k), *y = x + at.c + k;
        for (ptrdiff_t j = 0; j < width; j++)
            y[j] += g * at.g[j] * (re * wave->re[k + j] - im * wave->im[k + j]);
        for (ptrdiff_t j = 0; second != 0 && j < width; j++)
            y[j] -= g * at.g[j] * second * wave->gauss[k + j];
    }
}

/* --- are coefficients those of the definition? ------------------------------------------------- */

/* The next pseudo-random number, by Vigna's splitmix64. */
static uint64_t
draw(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

ss_status
ss_morlet_points(const ss_morlet *plan, const ss_scale *scale, const record *rec, const size_t k[], size_t n,
                 double *w, ss_error *err)
{
    wavelet *wave = ss_wavelet_new(&plan->opts, scale->a, plan->rate, rec->n);
    if (wave == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++)
        ss_wavelet_sum(wave, rec, ss_scale_spot(scale, k[i], plan->rate), w + 2 * i);
    ss_wavelet_free(wave);
    return ss_morlet_finish(w, n, scale->a, plan->opts.norm, rec->exponent, err);
}

ss_status
ss_morlet_compare(const ss_morlet *plan, const double *x, const double *w, size_t each,
                  double *difference, ss_error *err)
{
    if (plan == NULL || x == NULL || w == NULL || difference == NULL)
        return SS_FAIL_NULL(err);
    if (each < 1 || each > 1000000)
        return ss_fail(err, SS_EINVAL, "%zu coefficients a scale are out of range 1 ... 1e6", each);
    record rec = { .x = NULL };
    uint64_t state = 1;
    double worst = 0, *want = malloc(2 * each * sizeof *want);
    size_t *k = malloc(each * sizeof *k);
    ss_status st = k != NULL && want != NULL ? SS_OK : SS_ENOMEM;
    if (st == SS_OK)
        st = ss_morlet_record(&rec, x, plan->n, plan->opts.detrend, err);
    for (const ss_scale *scale = plan->scale; st == SS_OK && scale < plan->scale + plan->n_scales; scale++) {
        const double *of = w + 2 * scale->offset;
        double most = 0;
        for (size_t c = 0; c < each; c++)
            k[c] = (size_t)(draw(&state) % scale->n);
        st = ss_morlet_points(plan, scale, &rec, k, each, want, err);
        for (size_t c = 0; c < scale->n; c++)
            most = fmax(most, hypot(of[2 * c], of[2 * c + 1]));
        for (size_t c = 0; st == SS_OK && most > 0 && c < each; c++) {
            const double *got = of + 2 * k[c];
            worst = fmax(worst, hypot(got[0] - want[2 * c], got[1] - want[2 * c + 1]) / most);
        }
    }
    if (st == SS_OK)
        *difference = worst;
    free(rec.x);
    free(k);
    free(want);
    return st;
}
