/* fft.c -- wavelet coefficients from the spectrum of the record.
 *
 * On a circle of P samples, of which the record fills the first n and zeros the rest, the sum over
 * samples is, for any b = c/rate and with C = pi^-1/4 sqrt(2 pi), in units of a^1/2,
 *     C/P sum_k X_k exp(-v_k^2/2) exp(2 pi i k c/P),   v_k = 2 pi k a rate/P - omega_c,
 * over all integers k, X being periodic in k (Poisson): negative frequencies, the mean and what
 * aliases are in it.  It is exact but for what reaches around the circle, so P is n and REACH a of
 * zeros; the sum is cut to |v| <= R.  What a scale then is, is a Fourier series of few terms.
 *
 * Lattice: translations that divide the circle into L equal parts come from the terms folded modulo
 * L and one inverse FFT of that length, exactly.
 * Other translations: the terms, shifted to zero frequency, by an inverse FFT of a length L that
 * oversamples them, then interpolation between its points (kaiser.c) and the carrier's rotation.
 * With a coefficient a sample the places between points repeat, so that their weights do, too; else
 * each place has its own, and b is met to the last bit.
 *
 * Long scales want many zeros and use low frequencies only.  For them there is a second circle, on
 * which a point stands for D samples: x is spread to its points by the same interpolation, run
 * backwards, with 16 taps and 8 points a cycle, which leaves an error below rounding.
 *
 * Error, in units of a^1/2 max|x|.  The sum over samples of the kernel's error is bounded by its
 * size near b and its decay, 1/|u|, away from it: for the cut
 *     2.4 exp(-R^2/2) (1 + log(1 + n d/(2 R))),   d = 1/(a rate),
 * and for images of size e in the interpolation at most as much with 2 e in place of the
 * exponential.  A scale is computed with TOL/1000 for both together; then the promise is checked as in
 * quadrature.c, and if it does not hold the scale is done again with TAIL_FLOOR for both.
 *
 * FFTW's planner is not safe for threads, so making and freeing of plans takes turns; other users
 * of FFTW in the program must not plan at the same time. */
#include <fftw3.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "error.h"
#include "morlet/kaiser.h"
#include "morlet/plan.h"
#include "morlet/versions.h"

#define EDGE_MAX 0.32               /* of a kernel's band, in cycles a point */
#define SPREAD_BETA (0.985 * M_PI * SPREAD_TAPS * 7 / 8)

/* [s], measured by tests/bench/bench_morlet: a point of an inverse FFT times log2 of its length, a
 * term of the series, a coefficient and a tap of it at places that repeat, and at others. */
#define COST_FFT 0.6e-9
#define COST_TERM 4e-9
#define COST_DENSE 3e-9
#define COST_DENSE_TAP 0.3e-9
#define COST_PLACE 70e-9
#define COST_TAP 5e-9

enum {
    SPREAD_TAPS = 16,
    TERMS = 64, ROOT = 8,           /* terms at a time, ROOT^2 */
    BLOCK = 32, LANES = 8,          /* points, and samples, at a time */
    MARGIN = 64,                    /* points before and after the circle that repeat it */
    PHASES_MAX = 128,               /* places that repeat */
    KERNELS = 40, STEPS = 4         /* kernels for bands apart by 2^(1/STEPS) */
};

/* A circle: its points, and how many samples a point stands for. */
typedef struct level {
    size_t points, samples;
    fftw_plan forward;
    size_t reach;                   /* samples that zeros allow a wavelet to reach beyond */
} level;

typedef struct route {
    enum { BY_SUM, LATTICE, DENSE, ANYWHERE } kind;
    int level;
    size_t length;                  /* L */
    fftw_plan inverse;              /* owned by the list of them */
} route;

typedef struct inverse {
    size_t length;
    fftw_plan plan;
} inverse;

struct fft {
    size_t n;
    double rate;
    double center, second;          /* exp(-omega_c^2/2) if admissible, else 0 */
    double log_factor;              /* the largest 1 + log(1 + n d/2) */
    double bound[2];                /* a scale is computed with the first, again with the last */
    level level[2];
    int levels;
    route *route;
    inverse *inverse;
    size_t n_inverse, longest;
    kaiser *kernel[2][KERNELS];     /* for each bound; NULL: none needed */
    double cost;                    /* of all that is done here, about [s] */
    int no_memory;                  /* for one of them */
};

static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

/* --- the series of a scale -------------------------------------------------------------------- */

/* Half the width of the band, in units of 1/a, that keeps the cut below bound/2. */
static double
reach_for(const struct fft *f, double bound)
{
    double factor = 2.4 * f->log_factor * (f->second > 0 ? 2 : 1);
    return sqrt(2 * log(2 * factor / bound));
}

/* The admissible wavelet has a hump about v = -omega_c, which must be inside, too. */
static double
half_width(const struct fft *f, double reach)
{
    double c = f->center;
    return f->second > 0 && reach > c ? c + sqrt(reach * reach - c * c) : reach;
}

/* Images that interpolation may leave for the same half. */
static double
images_for(const struct fft *f, double bound)
{
    return bound / 2 / (4.8 * f->log_factor);
}

typedef struct band {
    double h, h_low;                /* v_k = k h - omega_c */
    ptrdiff_t lo, mid, hi;          /* k */
} band;

static band
band_of(const struct fft *f, const level *lev, double a, double half)
{
    const double two_pi = 6.2831853071795865, two_pi_low = 2.4492935982947064e-16;
    double points = (double)lev->points * (double)lev->samples;
    double p = a * f->rate, p_low = fma(a, f->rate, -p);
    double s = two_pi * p, s_low = fma(two_pi, p, -s) + two_pi * p_low + two_pi_low * p;
    band b = { .h = s / points };
    b.h_low = (fma(-b.h, points, s) + s_low) / points;
    b.lo = (ptrdiff_t)ceil((f->center - half) / b.h);
    b.mid = (ptrdiff_t)rint(f->center / b.h);
    b.hi = (ptrdiff_t)floor((f->center + half) / b.h);
    return b;
}

/* Cycles a point that the band reaches from its middle with L points. */
static double
edge_of(const band *b, size_t length)
{
    double most = (double)(b->hi - b->mid > b->mid - b->lo ? b->hi - b->mid : b->mid - b->lo);
    return most / (double)length;
}

/* exp(-(v + i h)^2/2) for i < n: products of exps that are each good to an ulp where h is small. */
static void
gaussian(double v, double h, double *g, size_t n)
{
    double fine[ROOT];
    if (h * (double)n > 1) {
        for (size_t i = 0; i < n; i++)
            g[i] = exp(-(v + h * (double)i) * (v + h * (double)i) / 2);
        return;
    }
    for (size_t j = 0; j < ROOT; j++)
        fine[j] = exp(-h * (double)j * (v + h * (double)j / 2));
    for (size_t i = 0; i < n; i += ROOT) {
        double u = v + h * (double)i, coarse = exp(-u * u / 2), cross = exp(-h * h * (double)i);
        double power = 1;           /* exp(-h^2 i j) */
        for (size_t j = 0; j < ROOT && i + j < n; j++, power *= cross)
            g[i + j] = coarse * fine[j] * power;
    }
}

/* to += g x over n terms, of which term k of the spectrum of m points is the first. */
VERSIONS static void
add_terms(const double *x, size_t m, ptrdiff_t k, const double *g, size_t n, double *to,
          size_t length, size_t at)
{
    while (n > 0) {
        ptrdiff_t r = k % (ptrdiff_t)m;
        size_t from = (size_t)(r < 0 ? r + (ptrdiff_t)m : r);
        int mirrored = from > m / 2;        /* of a real signal, X_-k = conj X_k */
        size_t run = mirrored ? m - from : m / 2 + 1 - from;
        run = run < n ? run : n;
        run = run < length - at ? run : length - at;
        double *out = to + 2 * at;
        if (mirrored)
            for (size_t i = 0; i < run; i++) {
                const double *in = x + 2 * (m - from - i);
                out[2 * i] += g[i] * in[0];
                out[2 * i + 1] -= g[i] * in[1];
            }
        else
            for (size_t i = 0; i < run; i++) {
                out[2 * i] += g[i] * x[2 * (from + i)];
                out[2 * i + 1] += g[i] * x[2 * (from + i) + 1];
            }
        g += run;
        n -= run;
        k += (ptrdiff_t)run;
        at = (at + run) % length;
    }
}

/* The L values of the series in units of a^1/2: term k at k - origin modulo L, divided by the
 * response of ker, unless that is NULL. */
static void
series(const struct fft *f, const route *r, const band *b, const double *x, ptrdiff_t origin,
       const kaiser *ker, double *v)
{
    const level *lev = &f->level[r->level];
    ptrdiff_t length = (ptrdiff_t)r->length, k = b->lo;
    double scale = PI_M14 * sqrt(2 * M_PI) / (double)lev->points / (double)lev->samples;
    memset(v, 0, 2 * r->length * sizeof *v);
    while (k <= b->hi) {
        double g[TERMS], first = fma((double)k, b->h, -f->center) + (double)k * b->h_low;
        size_t n = b->hi - k < TERMS ? (size_t)(b->hi - k) + 1 : TERMS;
        gaussian(first, b->h, g, n);
        for (size_t i = 0; f->second > 0 && i < n; i++) {
            double u = (double)(k + (ptrdiff_t)i) * b->h;
            g[i] -= f->second * exp(-u * u / 2);
        }
        for (size_t i = 0; i < n; i++)
            g[i] *= scale;
        if (ker != NULL)
            ss_kaiser_correct(ker, (double)(k - b->mid), 1 / (double)length, g, n);
        ptrdiff_t at = (k - origin) % length;
        add_terms(x, lev->points, k, g, n, v, r->length, (size_t)(at < 0 ? at + length : at));
        k += (ptrdiff_t)n;
    }
    fftw_execute_dft(r->inverse, (fftw_complex *)v, (fftw_complex *)v);
}

/* Make the points before and after the circle repeat it. */
static void
close_circle(double *v, size_t length)
{
    for (size_t i = 0; i < MARGIN; i++) {
        size_t left = (length - 1 - i % length), right = i % length;
        memcpy(v - 2 * (i + 1), v + 2 * left, 2 * sizeof *v);
        memcpy(v + 2 * (length + i), v + 2 * right, 2 * sizeof *v);
    }
}

/* --- output ----------------------------------------------------------------------------------- */

/* exp(2 pi i k c/m) */
static void
turn(size_t k, size_t c, size_t m, double e[2])
{
    double p = 2 * M_PI * (double)((uint64_t)(k % m) * (c % m) % m) / (double)m;    /* m < 2^32 */
    e[0] = cos(p);
    e[1] = sin(p);
}

/* Samples between the translations of a lattice. */
static double
step_of(const level *lev, const route *r)
{
    return (double)lev->points * (double)lev->samples / (double)r->length;
}

/* LATTICE: values of the series as they are.  Returns the largest |w|^2 in units of factor. */
static double
put_lattice(const double *v, size_t n, double factor, double *w)
{
    double most = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]);
        w[2 * i] = v[2 * i] * factor;
        w[2 * i + 1] = v[2 * i + 1] * factor;
    }
    return most;
}

/* Sums over taps for BLOCK places that lie equally far after v's points; taps are even. */
VERSIONS static void
sum_taps(const double *restrict v, const double *restrict weight, int taps, double *restrict s)
{
    for (size_t l = 0; l < 2 * BLOCK; l++)
        s[l] = weight[0] * v[l] + weight[1] * v[l + 2];
    for (int i = 2; i < taps; i += 2) {
        const double *restrict u = v + 2 * i;
        double a = weight[i], b = weight[i + 1];
        for (size_t l = 0; l < 2 * BLOCK; l++)
            s[l] += a * u[l] + b * u[l + 2];
    }
}

/* The n <= BLOCK sums s, times start e, are coefficients. */
VERSIONS static double
put_block(double *restrict s, const double start[2], const double *restrict re,
          const double *restrict im, double factor, double *restrict w, size_t stride, size_t n)
{
    double x[BLOCK], y[BLOCK], size[BLOCK], most = 0;
    for (size_t i = 0; i < BLOCK; i++) {
        double c = start[0] * re[i] - start[1] * im[i], d = start[0] * im[i] + start[1] * re[i];
        x[i] = s[2 * i] * c - s[2 * i + 1] * d;
        y[i] = s[2 * i] * d + s[2 * i + 1] * c;
        size[i] = x[i] * x[i] + y[i] * y[i];
    }
    for (size_t i = 0; i < n; i++) {
        most = size[i] > most ? size[i] : most;
        w[2 * stride * i] = x[i] * factor;
        w[2 * stride * i + 1] = y[i] * factor;
    }
    return most;
}

/* How many places between points repeat. */
static size_t
phases_of(const level *lev, const route *r)
{
    return lev->points / r->length * lev->samples;
}

/* DENSE: coefficient c lies c/phases points along the circle; n from row on, counted in points. */
static double
put_dense(const struct fft *f, const route *r, const band *b, const kaiser *ker, const double *v,
          double *table, size_t row, size_t n_all, double factor, double *w)
{
    size_t phases = phases_of(&f->level[r->level], r), circle = r->length * phases;
    size_t mid = (size_t)b->mid, rows = (n_all + phases - 1) / phases;
    double *weight = table, *shift = weight + phases * (size_t)ker->taps, most = 0;
    double re[BLOCK], im[BLOCK];
    for (size_t p = 0; p < phases; p++) {
        ss_kaiser_weights(ker, (double)p / (double)phases, weight + p * (size_t)ker->taps);
        turn(mid, p, circle, shift + 2 * p);
    }
    for (size_t i = 0; i < BLOCK; i++) {
        double e[2];
        turn(mid, i, r->length, e);
        re[i] = e[0];
        im[i] = e[1];
    }
    v += 2 * row;
    for (size_t j = 0; j < rows; j += BLOCK) {
        double start[2];
        turn(mid, row + j, r->length, start);
        for (size_t p = 0; p < phases && j * phases + p < n_all; p++) {
            const double *q = shift + 2 * p;
            double e[2] = { start[0] * q[0] - start[1] * q[1], start[0] * q[1] + start[1] * q[0] };
            double sum[2 * BLOCK];
            size_t first = j * phases + p, n = (n_all - first + phases - 1) / phases;
            sum_taps(v + 2 * j - (ker->taps - 2), weight + p * (size_t)ker->taps, ker->taps, sum);
            most = fmax(most, put_block(sum, e, re, im, factor, w + 2 * first, phases,
                                        n < BLOCK ? n : BLOCK));
        }
    }
    return most;
}

/* ANYWHERE: each coefficient at its own b, tau samples after sample c. */
static double
put_anywhere(const struct fft *f, const route *r, const band *b, const ss_scale *scale,
             const kaiser *ker, const double *v, ptrdiff_t origin, span part, double factor,
             double *w)
{
    const level *lev = &f->level[r->level];
    double per_sample = (double)r->length / ((double)lev->points * (double)lev->samples), most = 0;
    size_t circle = lev->points * lev->samples;
    for (size_t i = 0; i < part.n; i++) {
        double at = ss_scale_b(scale, part.first + i), c = rint(at * f->rate);
        double tau = c / f->rate == at ? 0 : fma(at, f->rate, -c);
        c -= (double)origin;
        double weight[KAISER_TAPS_MAX], e[2], re = 0, im = 0;
        uint64_t whole = (uint64_t)c * r->length / circle;  /* both below 2^32 */
        double rest = (double)((uint64_t)c * r->length % circle) / (double)circle
            + tau * per_sample;
        ptrdiff_t j = (ptrdiff_t)whole + (ptrdiff_t)floor(rest);
        ss_kaiser_weights(ker, rest - floor(rest), weight);
        const double *p = v + 2 * j - (ker->taps - 2);
        for (int k = 0; k < ker->taps; k++) {
            re += weight[k] * p[2 * k];
            im += weight[k] * p[2 * k + 1];
        }
        double phase = 2 * M_PI * ((double)((uint64_t)b->mid % circle * (uint64_t)c % circle)
                                   + (double)b->mid * tau) / (double)circle;
        e[0] = cos(phase);
        e[1] = sin(phase);
        double x = re * e[0] - im * e[1], y = re * e[1] + im * e[0];
        most = fmax(most, x * x + y * y);
        w[2 * i] = x * factor;
        w[2 * i + 1] = y * factor;
    }
    return most;
}

/* --- a scale ---------------------------------------------------------------------------------- */

/* A kernel for a band to edge <= EDGE_MAX at this bound, with tables; 0 if none is good enough. */
static int
kernel_for(const struct fft *f, double edge, double bound, kaiser *out)
{
    kaiser_band shape = { .edge = edge, .reach = half_width(f, reach_for(f, bound)),
                          .center = f->center, .second = f->second };
    if (!ss_kaiser_choose(out, &shape, images_for(f, bound)))
        return 0;
    ss_kaiser_prepare(out);
    return 1;
}

/* Which of the kernels made in advance is for this band, and the edge that it is made for. */
static int
kernel_index(double edge, double *made_for)
{
    int i = (int)floor(STEPS * log2(EDGE_MAX / edge) + 1e-9);
    i = i < 0 ? 0 : i < KERNELS ? i : KERNELS - 1;
    *made_for = EDGE_MAX * exp2(-(double)i / STEPS);
    return i;
}

/* One pass over part of a scale at one of the bounds.  Returns the largest |W|^2. */
static double
pass(const ss_morlet *plan, size_t i, const double *x, ptrdiff_t origin, span part, int round,
     double *v, double factor, double *w)
{
    const struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const ss_scale *scale = &plan->scale[i];
    double half = half_width(f, reach_for(f, f->bound[round]));
    band b = band_of(f, &f->level[r->level], scale->a, half);
    double made_for;
    const kaiser *ker = r->kind == LATTICE ? NULL
        : f->kernel[round][kernel_index(edge_of(&b, r->length), &made_for)];
    series(f, r, &b, x, r->kind == LATTICE ? 0 : b.mid, ker, v);
    if (r->kind == LATTICE) {
        double before = rint((double)origin / step_of(&f->level[r->level], r));
        ptrdiff_t first = (ptrdiff_t)part.first - (ptrdiff_t)before;
        return put_lattice(v + 2 * first, part.n, factor, w);
    }
    close_circle(v, r->length);
    if (r->kind == ANYWHERE)
        return put_anywhere(f, r, &b, scale, ker, v, origin, part, factor, w);
    double *table = v + 2 * (r->length + MARGIN);
    size_t row = (size_t)((ptrdiff_t)part.first - origin) / phases_of(&f->level[r->level], r);
    return put_dense(f, r, &b, ker, v, table, row, part.n, factor, w);
}

void
ss_fft_scale(const ss_morlet *plan, size_t i, const record *rec, const spectra *s, double *scratch,
             span part, double factor, double *most, double *w)
{
    const double *x = s->level[plan->fft->route[i].level];
    double before = *most;
    for (int round = 0; round < 2; round++) {
        *most = fmax(before, sqrt(pass(plan, i, x, rec->origin, part, round,
                                       scratch + 2 * MARGIN, factor, w)));
        double bound = plan->fft->bound[round];
        if (rec->x_max == 0
            || bound <= TAIL_FLOOR + plan->opts.accuracy * fmax(0, *most / rec->x_max - bound))
            break;
    }
}

double *
ss_fft_scratch(const struct fft *fft)
{
    size_t room = 2 * (fft->longest + 2 * MARGIN) + PHASES_MAX * (KAISER_TAPS_MAX + 2);
    return fftw_malloc(room * sizeof(double));
}

void
ss_fft_scratch_free(double *scratch)
{
    fftw_free(scratch);
}

/* --- the record's spectra --------------------------------------------------------------------- */

/* Samples to points: point j receives those less than SPREAD_TAPS/2 points away. */
VERSIONS static void
spread(const level *lev, const double *x, size_t n, const double *kernel, double *y)
{
    size_t d = lev->samples, points = (n - 1) / d + SPREAD_TAPS / 2 + 1;
    memset(y, 0, lev->points * sizeof *y);
    for (ptrdiff_t j = 1 - SPREAD_TAPS / 2; j < (ptrdiff_t)points; j++) {
        ptrdiff_t first = (j - SPREAD_TAPS / 2) * (ptrdiff_t)d, lo = first > 0 ? first : 0;
        ptrdiff_t end = first + SPREAD_TAPS * (ptrdiff_t)d;
        end = end < (ptrdiff_t)n ? end : (ptrdiff_t)n;
        double s[LANES] = { 0 };
        ptrdiff_t i = lo;
        for (; i + LANES <= end; i += LANES)
            for (size_t l = 0; l < LANES; l++)
                s[l] += x[i + (ptrdiff_t)l] * kernel[i - first + (ptrdiff_t)l];
        for (; i < end; i++)
            s[0] += x[i] * kernel[i - first];
        y[j < 0 ? j + (ptrdiff_t)lev->points : j] =
            ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
    }
}

static ss_status
spread_record(const level *lev, const record *rec, double *y)
{
    size_t width = SPREAD_TAPS * lev->samples;
    double *kernel = malloc(width * sizeof *kernel);
    if (kernel == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < width; i++)
        kernel[i] = ss_kaiser_at(SPREAD_TAPS, SPREAD_BETA,
                                 (double)i / (double)lev->samples - SPREAD_TAPS / 2);
    spread(lev, rec->x, rec->n, kernel, y);
    free(kernel);
    return SS_OK;
}

/* What spreading did to low frequencies. */
static void
undo_spreading(const level *lev, double *x)
{
    for (size_t k = 0; k <= lev->points / 8; k++) {
        double nu = (double)k / (double)lev->points;
        double c = 1 / ss_kaiser_response(SPREAD_TAPS, SPREAD_BETA, nu);
        x[2 * k] *= c;
        x[2 * k + 1] *= c;
    }
}

static ss_status
forward_level(const level *lev, const record *rec, double **out)
{
    double *x = *out = fftw_malloc((lev->points + 2) * sizeof *x);
    ss_status st = x == NULL ? SS_ENOMEM : SS_OK;
    if (st == SS_OK && lev->samples == 1) {
        memcpy(x, rec->x, rec->n * sizeof *x);
        memset(x + rec->n, 0, (lev->points - rec->n) * sizeof *x);
    }
    else if (st == SS_OK)
        st = spread_record(lev, rec, x);
    if (st != SS_OK)
        return st;
    fftw_execute_dft_r2c(lev->forward, x, (fftw_complex *)x);
    if (lev->samples > 1)
        undo_spreading(lev, x);
    return SS_OK;
}

ss_status
ss_fft_forward(const struct fft *fft, const record *rec, spectra *out)
{
    ss_status st = SS_OK;
    for (int i = 0; st == SS_OK && i < fft->levels; i++)
        if (fft->level[i].forward != NULL)
            st = forward_level(&fft->level[i], rec, &out->level[i]);
    return st;
}

void
ss_fft_release(spectra *s)
{
    fftw_free(s->level[0]);
    fftw_free(s->level[1]);
}

/* --- planning --------------------------------------------------------------------------------- */

static const size_t odd_part[] = { 1, 9, 5, 3, 15 };    /* in a circle's points; gaps of 25 % */
enum { ODD_PARTS = sizeof odd_part / sizeof *odd_part };

/* The smallest good number of points, at least so many and a multiple of factor. */
static size_t
good_points(double least, size_t factor)
{
    double best = INFINITY;
    for (int i = 0; i < ODD_PARTS; i++) {
        double points = (double)(odd_part[i] * factor);
        while (points < least)
            points *= 2;
        best = fmin(best, points);
    }
    return best < INT_MAX ? (size_t)best : 0;
}

/* The odd factor that a circle needs for the lattice of octaves: that of the step in samples, if
 * it is small, else 1. */
static size_t
lattice_factor(const ss_morlet *plan)
{
    int e;
    double s = plan->scale[0].b_num / plan->scale[0].b_den * plan->rate;
    if (plan->opts.voices != 1 || plan->opts.dense)
        return 1;
    s = frexp(s, &e);
    for (int i = 0; i < 53 && s != floor(s); i++)
        s *= 2;
    return s < 2048 ? (size_t)s : 1;
}

static size_t
samples_reached(const ss_scale *scale, double rate)
{
    double reach = ceil(REACH * scale->a * rate);
    return reach < 0x1p50 ? (size_t)reach : (size_t)1 << 50;
}

/* Samples that a point may stand for, the shortest scale being so many samples. */
static size_t
samples_for(const struct fft *f, double shortest, size_t most)
{
    double omega = (f->center + half_width(f, reach_for(f, TAIL_FLOOR))) / shortest;
    size_t samples = 1;
    while ((double)(16 * samples) * omega <= 2 * M_PI && samples < most)
        samples *= 2;
    return samples < 4 ? 1 : samples;
}

/* One circle, which a window fills but for what spreading needs. */
static void
choose_window(struct fft *f, ss_morlet *plan)
{
    level *lev = &f->level[0];
    double shortest = plan->scale[plan->n_scales - 1].a * f->rate;
    lev->samples = samples_for(f, shortest, f->n / 8);
    size_t margin = lev->samples > 1 ? 2 * SPREAD_TAPS : 0;
    double least = (double)f->n / (double)lev->samples + (double)margin;
    lev->points = good_points(least, lattice_factor(plan));
    lev->reach = SIZE_MAX;
    f->levels = 1;
    if (lev->points > margin)
        f->n = plan->n = (lev->points - margin) * lev->samples;
}

/* Circle 0 has few zeros; circle 1, if longer scales need one, so many that they do. */
static void
choose_levels(struct fft *f, const ss_morlet *plan)
{
    size_t factor = lattice_factor(plan), far = 0, near = SIZE_MAX;
    level *one = &f->level[1], *zero = &f->level[0];
    zero->samples = 1;
    zero->points = good_points((double)f->n * 17 / 16 + 64, factor);
    zero->reach = zero->points > f->n ? zero->points - f->n : 0;
    f->levels = 1;
    for (size_t i = 0; i < plan->n_scales; i++) {
        size_t reach = samples_reached(&plan->scale[i], f->rate);
        if (reach <= zero->reach || reach / 64 > f->n)      /* the longest by their sum */
            continue;
        far = reach > far ? reach : far;
        near = reach < near ? reach : near;
    }
    if (far == 0)
        return;
    one->samples = samples_for(f, (double)near / REACH, f->n / 8);
    double least = (double)(f->n + far) / (double)one->samples + 3 * SPREAD_TAPS;
    one->points = good_points(least, factor);
    one->reach = far;
    f->levels = 2;
}

/* L, if every translation stands at a multiple of the circle's L-th part, else 0.  Within the
 * promise is near enough, W changing by no more than (omega_c + REACH)/a of its largest a second. */
static size_t
lattice_length(const struct fft *f, const level *lev, const ss_scale *scale, double accuracy,
               int window)
{
    double circle = (double)lev->points * (double)lev->samples;
    int power_of_two = frexp(scale->b_num, &(int){ 0 }) == 0.5, dense = scale->b_den != 1;
    double step = dense ? 1 : scale->b_num * f->rate, parts = rint(circle / step);
    double off = (fabs(circle / parts - step) + 2e-16 * step) * (double)scale->n;
    double allow = accuracy / 20 * scale->a * f->rate / (f->center + REACH);
    int near = !dense && scale->b_num <= scale->a && off < allow;
    if (!(parts >= (double)scale->n && parts < INT_MAX))
        return 0;
    if (window)
        return power_of_two && circle == parts * step && step <= 4 * scale->a * f->rate
            ? (size_t)parts : 0;
    return near || ((dense || power_of_two) && circle == parts * step) ? (size_t)parts : 0;
}

static double
inverse_cost(size_t length)
{
    return COST_FFT * (double)length * log2((double)length + 1);
}

/* The kernel for a band to this edge, made now if need be; NULL if there is none or no memory. */
static const kaiser *
advance_kernel(struct fft *f, int round, double edge)
{
    double made_for;
    int k = kernel_index(edge, &made_for);
    kaiser ker;
    if (edge > EDGE_MAX)
        return NULL;
    kaiser **at = &f->kernel[round][k];
    if (*at != NULL || !kernel_for(f, made_for, f->bound[round], &ker))
        return *at;
    *at = malloc(sizeof ker);
    if (*at != NULL)
        **at = ker;
    else
        f->no_memory = 1;
    return *at;
}

/* With L points: about what the scale costs [s], infinity if it is not possible. */
static double
interpolation_cost(struct fft *f, const level *lev, const ss_scale *scale, int dense, size_t length)
{
    const kaiser *kernel[2];
    band b = { 0 };
    for (int round = 1; round >= 0; round--) {
        b = band_of(f, lev, scale->a, half_width(f, reach_for(f, f->bound[round])));
        kernel[round] = advance_kernel(f, round, edge_of(&b, length));
        if (kernel[round] == NULL)
            return INFINITY;
    }
    double tap = kernel[0]->taps * (dense ? COST_DENSE_TAP : COST_TAP);
    return inverse_cost(length) + COST_TERM * (double)(b.hi - b.lo + 1)
        + (double)scale->n * ((dense ? COST_DENSE : COST_PLACE) + tap);
}

/* Choose how a scale is computed on its level; its cost. */
static double
choose_route(struct fft *f, const ss_morlet *plan, size_t i)
{
    route *r = &f->route[i];
    const ss_scale *scale = &plan->scale[i];
    const level *lev = &f->level[r->level];
    int dense = plan->opts.dense;
    if (lev->points == 0)
        return INFINITY;
    band fine = band_of(f, lev, scale->a, half_width(f, reach_for(f, TAIL_FLOOR)));
    double best = INFINITY, terms = (double)(fine.hi - fine.lo) + 1;
    size_t length = lattice_length(f, lev, scale, plan->opts.accuracy, plan->window && !dense);
    if (terms > (double)lev->points)
        return best;
    if (length > 0) {
        r->kind = LATTICE;
        r->length = length;
        best = inverse_cost(length) + COST_TERM * terms + COST_DENSE * (double)scale->n;
    }
    for (int o = 0; o < ODD_PARTS; o++)     /* twice as many points as the circle has, or fewer */
        for (size_t two = 1; 2 * lev->points >= two * odd_part[o]; two *= 2) {
            size_t part = two * odd_part[o], phases = part / 2 * lev->samples;
            size_t points = 2 * lev->points / part;
            if (2 * lev->points % part != 0 || points > INT_MAX || points < 8
                || (dense && (part % 2 != 0 || phases > PHASES_MAX)))
                continue;
            if ((double)points * EDGE_MAX * 2 < terms)
                break;
            double cost = interpolation_cost(f, lev, scale, dense, points);
            if (cost < best) {
                best = cost;
                r->kind = dense ? DENSE : ANYWHERE;
                r->length = points;
            }
        }
    return best;
}

/* Routes of all scales; by AUTO those only where they are cheaper, the spectra included. */
static void
choose_routes(struct fft *f, const ss_morlet *plan)
{
    double gain[2] = { 0, 0 };
    for (size_t i = 0; i < plan->n_scales; i++) {
        route *r = &f->route[i];
        size_t reach = samples_reached(&plan->scale[i], f->rate);
        r->level = reach > f->level[0].reach;
        if (r->level == 1 && (f->levels == 1 || reach > f->level[1].reach))
            continue;
        double cost = choose_route(f, plan, i);
        double sum = ss_quadrature_cost(plan, &plan->scale[i], plan->scale[i].n);
        if (plan->opts.engine == SS_ENGINE_AUTO && cost > sum)
            r->kind = BY_SUM;
        if (r->kind == BY_SUM)
            continue;
        gain[r->level] += sum - cost;
        f->cost += cost;
    }
    for (int l = 0; l < f->levels; l++) {
        double forward = inverse_cost(f->level[l].points) / 2
            + (f->level[l].samples > 1 ? (double)f->n * SPREAD_TAPS * COST_DENSE_TAP : 0);
        gain[l] -= forward;
        f->cost += forward;
    }
    for (size_t i = 0; plan->opts.engine == SS_ENGINE_AUTO && i < plan->n_scales; i++)
        if (gain[f->route[i].level] < 0)
            f->route[i].kind = BY_SUM;
}

/* --- FFTW's plans, made while planner is held --- */

static fftw_plan
inverse_plan(struct fft *f, size_t length, fftw_complex *v)
{
    for (size_t i = 0; i < f->n_inverse; i++)
        if (f->inverse[i].length == length)
            return f->inverse[i].plan;
    fftw_plan plan = fftw_plan_dft_1d((int)length, v, v, FFTW_BACKWARD, FFTW_ESTIMATE);
    if (plan != NULL)
        f->inverse[f->n_inverse++] = (inverse){ length, plan };
    return plan;
}

/* v and x are where the arrays will be as far as alignment is concerned, and not written to. */
static ss_status
make_plans(struct fft *f, size_t n_scales, fftw_complex *v, double *x)
{
    for (size_t i = 0; i < n_scales; i++) {
        route *r = &f->route[i];
        level *lev = &f->level[r->level];
        if (r->kind == BY_SUM)
            continue;
        r->inverse = inverse_plan(f, r->length, v);
        if (lev->forward == NULL)
            lev->forward = fftw_plan_dft_r2c_1d((int)lev->points, x, (fftw_complex *)x,
                                                FFTW_ESTIMATE);
        if (r->inverse == NULL || lev->forward == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

static ss_status
plan_all(struct fft *f, size_t n_scales)
{
    size_t longest = f->level[0].points > f->level[1].points ? f->level[0].points
        : f->level[1].points;
    for (size_t i = 0; i < n_scales; i++)
        if (f->route[i].kind != BY_SUM && f->route[i].length > f->longest)
            f->longest = f->route[i].length;
    longest = longest > f->longest ? longest : f->longest;
    f->inverse = calloc(n_scales, sizeof *f->inverse);
    double *v = fftw_malloc(2 * (longest + 2 * MARGIN) * sizeof *v);
    ss_status st = SS_ENOMEM;
    if (f->inverse != NULL && v != NULL) {
        pthread_mutex_lock(&planner);
        st = make_plans(f, n_scales, (fftw_complex *)(v + 2 * MARGIN), v);
        pthread_mutex_unlock(&planner);
    }
    fftw_free(v);
    return st;
}

static int
any_route(const struct fft *f, size_t n_scales)
{
    for (size_t i = 0; i < n_scales; i++)
        if (f->route[i].kind != BY_SUM)
            return 1;
    return 0;
}

ss_status
ss_fft_new(ss_morlet *plan)
{
    if (plan->opts.engine == SS_ENGINE_QUADRATURE || plan->n > INT_MAX / 2)
        return SS_OK;
    struct fft *f = plan->fft = calloc(1, sizeof *f);
    if (f == NULL || (f->route = calloc(plan->n_scales, sizeof *f->route)) == NULL)
        return SS_ENOMEM;
    double wc = plan->opts.center, shortest = plan->scale[plan->n_scales - 1].a * plan->rate;
    f->n = plan->n;
    f->rate = plan->rate;
    f->center = wc;
    f->second = plan->opts.admissible ? exp(-wc * wc / 2) : 0;
    f->log_factor = 1 + log1p((double)plan->n * (plan->window ? 2 : 1) / shortest / 2);
    f->bound[0] = fmax(plan->opts.accuracy / 1000, TAIL_FLOOR);
    f->bound[1] = TAIL_FLOOR;
    if (plan->window)
        choose_window(f, plan);
    else
        choose_levels(f, plan);
    choose_routes(f, plan);
    if (f->no_memory)
        return SS_ENOMEM;
    if (any_route(f, plan->n_scales))
        return plan_all(f, plan->n_scales);
    ss_fft_free(f);
    plan->fft = NULL;
    return SS_OK;
}

void
ss_fft_free(struct fft *fft)
{
    if (fft == NULL)
        return;
    pthread_mutex_lock(&planner);
    for (size_t i = 0; i < fft->n_inverse; i++)
        fftw_destroy_plan(fft->inverse[i].plan);
    for (int i = 0; i < fft->levels; i++)
        if (fft->level[i].forward != NULL)
            fftw_destroy_plan(fft->level[i].forward);
    pthread_mutex_unlock(&planner);
    for (int i = 0; i < KERNELS; i++) {
        free(fft->kernel[0][i]);
        free(fft->kernel[1][i]);
    }
    free(fft->inverse);
    free(fft->route);
    free(fft);
}

int
ss_fft_takes(const struct fft *fft, size_t i)
{
    return fft != NULL && fft->route[i].kind != BY_SUM;
}

double
ss_fft_cost(const struct fft *fft)
{
    return fft->cost;
}

size_t
ss_fft_unit(const ss_morlet *plan)
{
    double unit = 1;
    for (size_t i = 0; i < plan->n_scales && plan->fft != NULL; i++) {
        const route *r = &plan->fft->route[i];
        if (r->kind != LATTICE || plan->opts.dense)
            continue;
        double step = step_of(&plan->fft->level[r->level], r);
        while (step != floor(step))     /* a multiple of it that is a whole number */
            step *= 2;
        unit = fmax(unit, step);        /* they differ by powers of two */
    }
    return (size_t)unit;
}

size_t
ss_fft_places(const struct fft *fft, size_t i)
{
    const route *r = &fft->route[i];
    return r->kind == DENSE ? phases_of(&fft->level[r->level], r) : 1;
}
