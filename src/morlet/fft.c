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
 * Error.  A scale is computed for the accuracy asked for, and then what was left out is bounded by
 * what the record's own spectrum holds: the cut leaves out at most
 *     C/P sum over |v_k| > R of |X_k| exp(-v_k^2/2),
 * and interpolation with images of size e at most C/P e sum over |v_k| <= R of |X_k|.  Sums of |X_k| over
 * ranges are differences of running sums, so that this costs next to nothing; R and e of the first
 * pass are what noise needs.  If the bound exceeds what the largest |W| allows (9/10 of it, the rest
 * being for lattices that are nearly met), the scale is done again with R and e that suffice for any
 * signal.  For these the sum over samples of the kernel's error is bounded by its size near b and
 * its decay, 1/|u|, away from it, in units of a^1/2 max|x|: for the cut
 *     2.4 exp(-R^2/2) (1 + log(1 + n d/(2 R))),   d = 1/(a rate),
 * and for images at most as much with 2 e in place of the exponential; both together TAIL_FLOOR.
 *
 * FFTW's planner is not safe for threads, so making and freeing of plans takes turns; other users
 * of FFTW in the program must not plan at the same time. */
#include <errno.h>
#include <fftw3.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "error.h"
#include "morlet/dense.h"
#include "morlet/kaiser.h"
#include "morlet/plan.h"
#include "morlet/versions.h"

#define EDGE_MAX 0.4                /* of a kernel's band, in cycles a point */
#define SPREAD_BETA (0.985 * M_PI * SPREAD_TAPS * 7 / 8)

/* [s], measured by tests/bench/bench_morlet: a point of an inverse FFT times log2 of its length, a
 * term of the series, a coefficient and a tap of it at places that repeat, and at others. */
#define COST_FFT 0.25e-9
#define COST_TERM 1.2e-9
#define COST_DENSE 1e-9
#define COST_DENSE_TAP 0.05e-9
#define COST_PLACE 50e-9
#define COST_TAP 1.5e-9

enum {
    SPREAD_TAPS = 16,
    BLOCKS = 32768,                 /* of terms, about */
    APART = 16384,                  /* to this length FFTW is faster from one array to another */
    TERMS = KAISER_AT_ONCE,         /* terms at a time */
    LANES = 8,                      /* samples at a time */
    MARGIN = DENSE_MARGIN,          /* points before and after the circle that repeat it */
    KERNELS = 40, STEPS = 4         /* kernels for bands apart by 2^(1/STEPS) */
};

/* A circle: its points, and how many samples a point stands for. */
typedef struct level {
    size_t points, samples;
    fftw_plan forward;
    size_t reach;                   /* samples that zeros allow a wavelet to reach beyond */
    size_t block;                   /* terms of the spectrum whose sizes are summed up together */
} level;

typedef struct route {
    enum { BY_SUM, LATTICE, DENSE, ANYWHERE } kind;
    int level;
    size_t length;                  /* L */
    fftw_plan inverse;              /* owned by the list of them */
    const weights *weights[2];          /* for each bound; owned likewise */
} route;

typedef struct table {
    const kaiser *kernel;
    size_t phases;
    weights *weights;
} table;

typedef struct inverse {
    size_t length;
    fftw_plan plan;
} inverse;

struct fft {
    size_t n;
    double rate;
    double center, second;          /* exp(-omega_c^2/2) if admissible, else 0 */
    double half[2];                 /* of the band, in 1/a: a scale is computed with the first, */
    double images[2];               /* again with the last; and of interpolation */
    level level[2];
    int levels;
    route *route;
    inverse *inverse;
    size_t n_inverse, longest;
    kaiser *kernel[2][KERNELS];     /* for each bound; NULL: none needed */
    double cost;                    /* of all that is done here, about [s] */
    int no_memory;                  /* for one of them */
    table *table;
    size_t tables;
};

static pthread_mutex_t planner = PTHREAD_MUTEX_INITIALIZER;

/* --- the series of a scale -------------------------------------------------------------------- */

/* The admissible wavelet has a hump about v = -omega_c, which must be inside, too. */
static double
half_width(const struct fft *f, double reach)
{
    double c = f->center;
    return f->second > 0 && reach > c ? c + sqrt(reach * reach - c * c) : reach;
}

typedef struct band {
    double h, h_low;                /* v_k = k h - omega_c */
    ptrdiff_t lo, mid, hi;          /* k */
} band;

/* Samples around it. */
static size_t
circle_of(const level *lev)
{
    return lev->points * lev->samples;
}

static band
band_of(const struct fft *f, const level *lev, double a, double half)
{
    const double two_pi = 6.2831853071795865, two_pi_low = 2.4492935982947064e-16;
    double points = (double)circle_of(lev);
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

static const double inverse_of[] = { 0, 1, 1 / 2., 1 / 3., 1 / 4., 1 / 5., 1 / 6., 1 / 7., 1 / 8.,
    1 / 9., 1 / 10., 1 / 11., 1 / 12., 1 / 13. };

/* y = -(v + i h)^2/2 for i < TERMS */
VERSIONS static void
exponents(double v, double h, double *restrict y)
{
    for (int i = 0; i < TERMS; i++) {
        double u = v + h * i;
        y[i] = -u * u / 2;
    }
}

/* g = scale exp(y), y being above -690 or taken for that: 2^k times a Taylor polynomial about 0 of
 * what is left of the logarithm, |r| <= log(2)/2. */
VERSIONS static void
exponentials(const double *restrict y, double scale, double *restrict g)
{
    const double ln2 = 0x1.62e42fefa0000p-1, ln2_low = 0x1.cf79abc9e3b3ap-40, shift = 0x1.8p52;
    double r[TERMS], k[TERMS];
    uint64_t bits[TERMS];
    for (int i = 0; i < TERMS; i++) {
        double z = y[i] < -690 ? -690 : y[i];
        k[i] = z * (1 / M_LN2) + shift;
        r[i] = z - (k[i] - shift) * ln2 - (k[i] - shift) * ln2_low;
    }
    memcpy(bits, k, sizeof bits);
    for (int i = 0; i < TERMS; i++)
        bits[i] = (bits[i] + 1023) << 52;
    memcpy(k, bits, sizeof bits);
    for (int i = 0; i < TERMS; i++)
        g[i] = 1;
    for (int n = 13; n > 0; n--)
        for (int i = 0; i < TERMS; i++)
            g[i] = 1 + g[i] * r[i] * inverse_of[n];
    for (int i = 0; i < TERMS; i++)
        g[i] *= k[i] * scale;
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

/* The admissible wavelet's second term, v being that of the first: y becomes its exponents. */
static void
subtract_second(const struct fft *f, double u, double h, double v, double *y, double scale,
                double *g)
{
    double of_first[TERMS], of_second[TERMS], second[TERMS];
    exponents(v, h, of_first);
    exponents(u, h, of_second);
    for (size_t i = 0; i < TERMS; i++)
        y[i] += of_second[i] - of_first[i];
    exponentials(y, scale * f->second, second);
    for (size_t i = 0; i < TERMS; i++)
        g[i] -= second[i];
}

/* The L values of the series in units of a^1/2: term k at k - origin modulo L of c, which may be v,
 * divided by the response of ker, unless that is NULL. */
static void
series(const struct fft *f, const route *r, const band *b, const double *x, ptrdiff_t origin,
       const kaiser *ker, double *v, double *c)
{
    const level *lev = &f->level[r->level];
    ptrdiff_t length = (ptrdiff_t)r->length, k = b->lo;
    double scale = PI_M14 * sqrt(2 * M_PI) / (double)lev->points / (double)lev->samples;
    memset(c, 0, 2 * r->length * sizeof *c);
    while (k <= b->hi) {
        double g[TERMS], y[TERMS], first = fma((double)k, b->h, -f->center) + (double)k * b->h_low;
        size_t n = b->hi - k < TERMS ? (size_t)(b->hi - k) + 1 : TERMS;
        exponents(first, b->h, y);
        if (ker != NULL)
            ss_kaiser_correct(ker, (double)(k - b->mid), 1 / (double)length, y);
        exponentials(y, scale, g);
        if (f->second > 0)
            subtract_second(f, (double)k * b->h, b->h, first, y, scale, g);
        ptrdiff_t at = (k - origin) % length;
        add_terms(x, lev->points, k, g, n, c, r->length, (size_t)(at < 0 ? at + length : at));
        k += (ptrdiff_t)n;
    }
    fftw_execute_dft(r->inverse, (fftw_complex *)c, (fftw_complex *)v);
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

/* Samples between the translations of a lattice. */
static double
step_of(const level *lev, const route *r)
{
    return (double)circle_of(lev) / (double)r->length;
}

/* How many places between points repeat. */
static size_t
phases_of(const level *lev, const route *r)
{
    return circle_of(lev) / r->length;
}

/* LATTICE: values of the series as they are.  Returns the largest |w|^2 in units of factor. */
VERSIONS static double
put_lattice(const double *restrict v, size_t n, double factor, double *restrict w)
{
    double most[LANES] = { 0 };
    size_t i = 0;
    for (; i + LANES <= n; i += LANES)
        for (size_t l = 0; l < LANES; l++) {
            double re = v[2 * (i + l)], im = v[2 * (i + l) + 1], size = re * re + im * im;
            most[l] = size > most[l] ? size : most[l];
            w[2 * (i + l)] = re * factor;
            w[2 * (i + l) + 1] = im * factor;
        }
    for (; i < n; i++) {
        most[0] = fmax(most[0], v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]);
        w[2 * i] = v[2 * i] * factor;
        w[2 * i + 1] = v[2 * i + 1] * factor;
    }
    for (size_t l = 1; l < LANES; l++)
        most[0] = fmax(most[0], most[l]);
    return most[0];
}

/* ANYWHERE: each coefficient at its own b, tau samples after sample c. */
static double
put_anywhere(const struct fft *f, const route *r, const band *b, const ss_scale *scale,
             const kaiser *ker, const double *v, ptrdiff_t origin, span part, double factor,
             double *w)
{
    const level *lev = &f->level[r->level];
    double per_sample = (double)r->length / (double)circle_of(lev), most = 0;
    size_t circle = circle_of(lev);
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

/* --- what is left out ------------------------------------------------------------------------- */

/* sums[i] = sum of |Re X_k| + |Im X_k|, which is no less than |X_k|, over k < i block. */
VERSIONS static void
sum_sizes(const double *restrict x, size_t terms, size_t block, double *restrict sums)
{
    double sum = 0;
    size_t at = 0;
    for (size_t k = 0; k < terms; k += block) {
        size_t n = terms - k < block ? terms - k : block;
        double part[LANES] = { 0 };
        sums[at++] = sum;
        size_t i = 2 * k, end = 2 * (k + n);
        for (; i + LANES <= end; i += LANES)
            for (size_t l = 0; l < LANES; l++)
                part[l] += fabs(x[i + l]);
        for (; i < end; i++)
            part[0] += fabs(x[i]);
        for (size_t l = 0; l < LANES; l++)
            sum += part[l];
    }
    sums[at] = sum;
}

/* Sum over terms 0 to k, or less k to 0, of the periodic spectrum; up to a block too much or, if
 * not up, too little. */
static double
sum_to(const level *lev, const double *sums, ptrdiff_t k, int up)
{
    ptrdiff_t m = (ptrdiff_t)lev->points, turns = k >= 0 ? k / m : -((m - 1 - k) / m);
    size_t rest = (size_t)(k - turns * m), blocks = (lev->points / 2) / lev->block + 1;
    double half = sums[blocks], all = 2 * half;
    int mirrored = rest > lev->points / 2;
    size_t to = mirrored ? lev->points - rest + 1 : rest;
    size_t i = (to + (up != mirrored ? lev->block - 1 : 0)) / lev->block;
    double sum = sums[i < blocks ? i : blocks];
    return (double)turns * all + (mirrored ? all - sum : sum);
}

/* No less than the sum of |X_k| over lo <= k < hi.  (The mean and Nyquist count twice.) */
static double
size_of(const level *lev, const double *sums, ptrdiff_t lo, ptrdiff_t hi)
{
    return sum_to(lev, sums, hi, 1) - sum_to(lev, sums, lo, 0);
}

/* Bound on what the cut, and interpolation, leave out of any coefficient of a scale. */
static double
left_out(const struct fft *f, const level *lev, const band *b, const double *sums, int images)
{
    static const double beyond[] = { 0, 0.1, 0.2, 0.4, 0.7, 1, 1.5, 2, 3 };
    enum { STEPS_BEYOND = sizeof beyond / sizeof *beyond };
    double sum = images ? f->images[0] * size_of(lev, sums, b->lo, b->hi + 1) : 0;
    ptrdiff_t lo = b->lo, hi = b->hi + 1;
    for (int i = 0; i < STEPS_BEYOND; i++) {
        double v = f->half[0] + beyond[i], u = fmax(0, v - f->center);
        double most = exp(-v * v / 2) + f->second * exp(-u * u / 2), part;
        if (i + 1 < STEPS_BEYOND) {
            double far = f->half[0] + beyond[i + 1];
            ptrdiff_t next_lo = (ptrdiff_t)ceil((f->center - far) / b->h);
            ptrdiff_t next_hi = (ptrdiff_t)floor((f->center + far) / b->h) + 1;
            part = size_of(lev, sums, next_lo, lo) + size_of(lev, sums, hi, next_hi);
            lo = next_lo;
            hi = next_hi;
        } else      /* the circle twice, and once more for all turns after that */
            part = 3 * size_of(lev, sums, 0, (ptrdiff_t)lev->points);
        sum += most * part;
    }
    return PI_M14 * sqrt(2 * M_PI) / (double)circle_of(lev) * sum;
}

/* --- a scale ---------------------------------------------------------------------------------- */

/* A kernel for a band to edge <= EDGE_MAX in this round; 0 if none is good enough. */
static int
kernel_for(const struct fft *f, double edge, int round, kaiser *out)
{
    kaiser_band shape = { .edge = edge, .reach = f->half[round], .center = f->center,
                          .second = f->second };
    return ss_kaiser_choose(out, &shape, f->images[round]);
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

/* The kernel that a scale needs in a round. */
static kaiser *
kernel_of(const struct fft *f, const route *r, const band *b, int round)
{
    double made_for;
    return f->kernel[round][kernel_index(edge_of(b, r->length), &made_for)];
}

/* Where the terms of a short series are put, after its values v. */
static double *
terms_of(const struct fft *f, double *v)
{
    return v + 2 * (f->longest + MARGIN);
}

/* One pass over part of a scale at one of the bounds.  Returns the largest |W|^2. */
static double
pass(const ss_morlet *plan, size_t i, const double *x, ptrdiff_t origin, span part, int round,
     double *v, double factor, double *w)
{
    const struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const ss_scale *scale = &plan->scale[i];
    const level *lev = &f->level[r->level];
    band b = band_of(f, lev, scale->a, f->half[round]);
    const kaiser *ker = r->kind == LATTICE ? NULL : kernel_of(f, r, &b, round);
    series(f, r, &b, x, r->kind == LATTICE ? 0 : b.mid, ker, v,
           r->length > APART ? v : terms_of(f, v));
    if (r->kind == LATTICE) {
        double before = rint((double)origin / step_of(lev, r));
        ptrdiff_t first = (ptrdiff_t)part.first - (ptrdiff_t)before;
        return put_lattice(v + 2 * first, part.n, factor, w);
    }
    close_circle(v, r->length);
    if (r->kind == ANYWHERE)
        return put_anywhere(f, r, &b, scale, ker, v, origin, part, factor, w);
    return ss_dense_put(r->weights[round], v, (size_t)b.mid, circle_of(lev),
                        (size_t)((ptrdiff_t)part.first - origin), part.n, factor,
                        terms_of(f, v) + 2 * APART, w);
}

void
ss_fft_scale(const ss_morlet *plan, size_t i, const record *rec, const spectra *s, double *scratch,
             span part, double factor, double *most, double *w)
{
    const struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const level *lev = &f->level[r->level];
    double before = *most;
    for (int round = 0; round < 2; round++) {
        *most = fmax(before, sqrt(pass(plan, i, s->level[r->level], rec->origin, part, round,
                                       scratch + 2 * MARGIN, factor, w)));
        if (round == 1 || f->half[0] == f->half[1] || rec->x_max == 0)
            return;
        band b = band_of(f, lev, plan->scale[i].a, f->half[0]);
        double error = left_out(f, lev, &b, s->size[r->level], r->kind != LATTICE);
        if (error <= TAIL_FLOOR * rec->x_max + 0.9 * plan->opts.accuracy * fmax(0, *most - error))
            return;
    }
}

double *
ss_fft_scratch(const struct fft *fft)
{
    size_t room = 2 * (fft->longest + 2 * MARGIN + APART) + ss_dense_room(fft->n);
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

static ss_status
sizes_of_level(const level *lev, const double *x, double **out)
{
    size_t terms = lev->points / 2 + 1;
    *out = malloc((terms / lev->block + 2) * sizeof **out);
    if (*out == NULL)
        return SS_ENOMEM;
    sum_sizes(x, terms, lev->block, *out);
    return SS_OK;
}

ss_status
ss_fft_forward(const struct fft *fft, const record *rec, spectra *out)
{
    ss_status st = SS_OK;
    for (int i = 0; st == SS_OK && i < fft->levels; i++)
        if (fft->level[i].forward != NULL) {
            st = forward_level(&fft->level[i], rec, &out->level[i]);
            if (st == SS_OK && fft->half[0] < fft->half[1])
                st = sizes_of_level(&fft->level[i], out->level[i], &out->size[i]);
        }
    return st;
}

void
ss_fft_release(spectra *s)
{
    for (int i = 0; i < 2; i++) {
        fftw_free(s->level[i]);
        free(s->size[i]);
    }
}

/* --- planning --------------------------------------------------------------------------------- */

/* in a circle's points; gaps of 12 % */
static const size_t odd_part[] = { 1, 9, 5, 21, 45, 3, 7, 15 };
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

/* See above; nd is the record's length in units of the shortest scale. */
static void
choose_bounds(struct fft *f, double nd, double accuracy)
{
    double factor = 2.4 * (1 + log1p(nd / 2)), hump = f->second > 0 ? 2 : 1;
    double cut = TAIL_FLOOR / 2 / (factor * hump), images = TAIL_FLOOR / 2 / (2 * factor);
    double first = accuracy * 4 / hump / sqrt(nd);
    f->half[1] = half_width(f, sqrt(-2 * log(cut)));
    f->half[0] = half_width(f, sqrt(-2 * log(fmin(0.1, fmax(cut, first)))));
    f->images[1] = images;
    f->images[0] = fmin(0.01, fmax(images, accuracy * 0.16 / sqrt(nd)));
    if (f->half[0] == f->half[1])
        f->images[0] = images;
}

/* Samples that a point may stand for, the shortest scale being so many samples. */
static size_t
samples_for(const struct fft *f, double shortest, size_t most)
{
    double omega = (f->center + f->half[1]) / shortest;
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
    double circle = (double)circle_of(lev);
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
    double cost = COST_FFT * (double)length * log2((double)length + 1);
    return length < 4096 ? cost : 1.6 * cost;
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
    if (*at != NULL || !kernel_for(f, made_for, round, &ker))
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
        b = band_of(f, lev, scale->a, f->half[round]);
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
    band fine = band_of(f, lev, scale->a, f->half[1]);
    double best = INFINITY, terms = (double)(fine.hi - fine.lo) + 1;
    size_t length = lattice_length(f, lev, scale, plan->opts.accuracy, plan->window && !dense);
    if (terms > (double)lev->points)
        return best;
    if (length > 0) {
        r->kind = LATTICE;
        r->length = length;
        double half = f->half[0] / f->half[1];
        best = inverse_cost(length) + COST_TERM * terms * half + COST_DENSE * (double)scale->n;
    }
    for (int o = 0; o < ODD_PARTS; o++)     /* twice as many points as the circle has, or fewer */
        for (size_t two = 1; 2 * lev->points >= two * odd_part[o]; two *= 2) {
            size_t part = two * odd_part[o], phases = part / 2 * lev->samples;
            size_t points = 2 * lev->points / part;
            if (2 * lev->points % part != 0 || points > INT_MAX || points < 8
                || (dense && (part % 2 != 0 || phases > DENSE_PHASES_MAX)))
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

/* --- weights of dense scales --- */

static const weights *
table_of(struct fft *f, const kaiser *kernel, size_t phases)
{
    table *t = f->table;
    for (; t < f->table + f->tables; t++)
        if (t->kernel == kernel && t->phases == phases)
            return t->weights;
    *t = (table){ kernel, phases, ss_dense_new(kernel, phases) };
    f->tables += t->weights != NULL;
    return t->weights;
}

static ss_status
make_tables(struct fft *f, const ss_morlet *plan)
{
    f->table = calloc(2 * plan->n_scales, sizeof *f->table);
    if (f->table == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < 2 * plan->n_scales; i++) {
        route *r = &f->route[i / 2];
        if (r->kind != DENSE && r->kind != ANYWHERE)
            continue;
        const level *lev = &f->level[r->level];
        band b = band_of(f, lev, plan->scale[i / 2].a, f->half[i % 2]);
        kaiser *kernel = kernel_of(f, r, &b, (int)(i % 2));
        if (!kernel->prepared)
            ss_kaiser_prepare(kernel);
        if (r->kind == DENSE)
            r->weights[i % 2] = table_of(f, kernel, circle_of(lev) / r->length);
        if (r->kind == DENSE && r->weights[i % 2] == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

/* --- FFTW's plans, made while planner is held --- */

static fftw_plan
inverse_plan(struct fft *f, size_t length, fftw_complex *v, fftw_complex *terms, unsigned how)
{
    for (size_t i = 0; i < f->n_inverse; i++)
        if (f->inverse[i].length == length)
            return f->inverse[i].plan;
    fftw_plan plan = fftw_plan_dft_1d((int)length, length > APART ? v : terms, v,
                                      FFTW_BACKWARD, how);
    if (plan != NULL)
        f->inverse[f->n_inverse++] = (inverse){ length, plan };
    return plan;
}

/* v, terms and x are where the arrays will be as far as alignment is concerned. */
static ss_status
make_plans(struct fft *f, const ss_morlet *plan, fftw_complex *v, fftw_complex *terms, double *x)
{
    static const unsigned flags[] = { FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT };
    unsigned how = flags[plan->opts.planner];
    for (size_t i = 0; i < plan->n_scales; i++) {
        route *r = &f->route[i];
        level *lev = &f->level[r->level];
        if (r->kind == BY_SUM)
            continue;
        r->inverse = inverse_plan(f, r->length, v, terms, how);
        if (lev->forward == NULL)
            lev->forward = fftw_plan_dft_r2c_1d((int)lev->points, x, (fftw_complex *)x, how);
        if (r->inverse == NULL || lev->forward == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

static ss_status
plan_all(struct fft *f, const ss_morlet *plan)
{
    size_t n_scales = plan->n_scales;
    size_t longest = f->level[0].points > f->level[1].points ? f->level[0].points
        : f->level[1].points;
    for (size_t i = 0; i < n_scales; i++)
        if (f->route[i].kind != BY_SUM && f->route[i].length > f->longest)
            f->longest = f->route[i].length;
    longest = longest > f->longest ? longest : f->longest;
    f->inverse = calloc(n_scales, sizeof *f->inverse);
    double *v = fftw_malloc(2 * (longest + 2 * MARGIN + APART) * sizeof *v);
    ss_status st = SS_ENOMEM;
    if (f->inverse != NULL && v != NULL) {
        pthread_mutex_lock(&planner);
        st = make_plans(f, plan, (fftw_complex *)(v + 2 * MARGIN),
                        (fftw_complex *)(v + 2 * (longest + 2 * MARGIN)), v);
        pthread_mutex_unlock(&planner);
    }
    fftw_free(v);
    for (int i = 0; i < f->levels; i++)
        f->level[i].block = f->level[i].points / 2 / BLOCKS + 1;
    return st == SS_OK ? make_tables(f, plan) : st;
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
    double wc = plan->opts.center;
    double shortest = plan->scale[plan->n_scales - 1].a * plan->rate;
    f->n = plan->n;
    f->rate = plan->rate;
    f->center = wc;
    f->second = plan->opts.admissible ? exp(-wc * wc / 2) : 0;
    choose_bounds(f, (double)plan->n * (plan->window ? 2 : 1) / shortest, plan->opts.accuracy);
    if (plan->window)
        choose_window(f, plan);
    else
        choose_levels(f, plan);
    choose_routes(f, plan);
    if (f->no_memory)
        return SS_ENOMEM;
    if (any_route(f, plan->n_scales))
        return plan_all(f, plan);
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
    for (size_t i = 0; i < fft->tables; i++)
        ss_dense_free(fft->table[i].weights);
    free(fft->table);
    free(fft->inverse);
    free(fft->route);
    free(fft);
}

/* Wisdom is a list of (name number #xflags #xflags #xflags ...), itself in brackets.  FFTW aborts the
 * program over flags that do not fit where it keeps them, in 20, 20 and 9 bits. */
static int
flags_fit(const char *wisdom)
{
    static const unsigned long most[] = { 0xfffff, 0xfffff, 0x1ff };
    const char *entry = strchr(wisdom, '(');
    while (entry != NULL && (entry = strchr(entry + 1, '(')) != NULL) {
        const char *name = entry + 1 + strspn(entry + 1, " \t\r\n\v\f");
        char *p = (char *)name + strcspn(name, " \t\r\n\v\f");
        for (int i = 0; i < 3; i++)
            if ((p = strstr(p, "#x")) == NULL || strtoul(p + 2, &p, 16) > most[i])
                return 0;
    }
    return 1;
}

enum { WISDOM_ROOM = 1 << 24 };         /* a hundred thousand plans */

ss_status
ss_wisdom_read(FILE *in, ss_error *err)
{
    if (in == NULL)
        return SS_FAIL_NULL(err);
    char *wisdom = malloc(WISDOM_ROOM);
    if (wisdom == NULL)
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    size_t n = fread(wisdom, 1, WISDOM_ROOM - 1, in);
    int read = !ferror(in), why = errno, good = 0;
    wisdom[n] = '\0';
    if (read && n < WISDOM_ROOM - 1 && flags_fit(wisdom)) {
        pthread_mutex_lock(&planner);
        good = fftw_import_wisdom_from_string(wisdom);
        pthread_mutex_unlock(&planner);
    }
    free(wisdom);
    return good ? SS_OK : !read ? ss_fail(err, SS_EIO, "%s", strerror(why))
        : ss_fail(err, SS_EINVAL, "this is no wisdom of %s on this machine", fftw_version);
}

ss_status
ss_wisdom_write(FILE *out)
{
    if (out == NULL)
        return SS_EINVAL;
    pthread_mutex_lock(&planner);
    fftw_export_wisdom_to_file(out);
    pthread_mutex_unlock(&planner);
    return fflush(out) == 0 && !ferror(out) ? SS_OK : SS_EIO;
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
