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
#include <float.h>
#include <limits.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "error.h"
#include "morlet/dense.h"
#include "morlet/kaiser.h"
#include "morlet/plan.h"
#include "morlet/versions.h"

#define UNDERFLOW 0x1p-126            /* of a point in single precision, a term */
#define EDGE_MAX 0.45                /* of a kernel's band, in cycles a point */
#define SPREAD_BETA (0.985 * M_PI * SPREAD_TAPS * 7 / 8)

/* [s], measured by tests/bench/bench_morlet: a point of an inverse FFT times log2 of its length, a
 * term of the series, a coefficient and a tap of it at places that repeat, and at others. */
#define COST_FFT 0.13e-9
#define COST_TERM 1.2e-9
#define COST_DENSE 0.5e-9
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

/* How a scale is computed: in one of these ways after the other, until the bound on its error lies
 * within the promise. */
typedef enum way { SINGLE, FIRST, LAST, WAYS } way;

typedef struct route {
    enum { BY_SUM, LATTICE, DENSE, ANYWHERE } kind;
    int level;
    size_t length;                  /* L */
    fftw_plan inverse;              /* owned by the list of them */
    fftwf_plan single;              /* NULL: never in single precision; owned likewise */
    double rounding;                /* that adds to a coefficient, over the sum of terms' sizes */
    const weights *weights[WAYS];     /* of those that are dense; owned likewise */
} route;

typedef struct table {
    const kaiser *kernel;
    size_t phases;
    int single;
    weights *weights;
} table;

typedef struct inverse {
    size_t length;
    fftw_plan plan;
    fftwf_plan single;
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
    atomic_size_t singles;          /* scales computed in single precision so far */
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

#define REAL double
#define NAMED(name) name
#include "morlet/points.h"

#define REAL float
#define NAMED(name) name##_single
#include "morlet/points.h"

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

/* Terms in units of a^1/2 times unit, divided by the response of ker, unless that is NULL: term k at
 * k - origin modulo L of c. */
static void
terms(const struct fft *f, const route *r, const band *b, const double *x, ptrdiff_t origin,
      const kaiser *ker, int single, double unit, void *c)
{
    const level *lev = &f->level[r->level];
    ptrdiff_t length = (ptrdiff_t)r->length, k = b->lo;
    double scale = PI_M14 * sqrt(2 * M_PI) / (double)lev->points / (double)lev->samples / unit;
    memset(c, 0, 2 * r->length * (single ? sizeof(float) : sizeof(double)));
    while (k <= b->hi) {
        double g[TERMS], y[TERMS], first = fma((double)k, b->h, -f->center) + (double)k * b->h_low;
        size_t n = b->hi - k < TERMS ? (size_t)(b->hi - k) + 1 : TERMS;
        exponents(first, b->h, y);
        if (ker != NULL)
            ss_kaiser_correct(ker, (double)(k - b->mid), 1 / (double)length, y);
        exponentials(y, scale, g);
        if (f->second > 0)
            subtract_second(f, (double)k * b->h, b->h, first, y, scale, g);
        ptrdiff_t rest = (k - origin) % length;
        size_t at = (size_t)(rest < 0 ? rest + length : rest);
        if (single)
            add_terms_single(x, lev->points, k, g, n, c, r->length, at);
        else
            add_terms(x, lev->points, k, g, n, c, r->length, at);
        k += (ptrdiff_t)n;
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

/* --- single precision ------------------------------------------------------------------------- */

/* What rounding in single precision adds to any coefficient, over the sum of the sizes of the terms.
 *
 * With u = 2^-24, to first order, as a part of that sum: u for the terms themselves.  In the FFT
 * every point is a sum of all terms times roots of unity, which passes one butterfly for each prime
 * p of L.  Such a butterfly of 2 adds a term, u, after it has been multiplied by a root, which is
 * sqrt(5) u (Brent, Percival and Zimmermann 2007) and u for the root's own rounding; where FFTW keeps
 * few roots and multiplies them, some of them have 3 u more for each product, and one product per
 * codelet of 8 or more: 6 u for each 2 in L is more than all of that.  Butterflies of 3, 5 and 7 add
 * pairs and multiply them by sines and cosines, which for 5 are taken apart once more: with k
 * operations in a row and coefficients whose sizes add up to s, s k u and the root, with 3: s = 1.37
 * and k = 4; 5: 1.76 and 6.5; 7: 1.42 and 7, and the root: below 11, 17 and 19 u.  (Higham 2002,
 * section 24.1, has the like for the 2-norm, which for the largest error gives no more.)
 * Interpolation rounds weights, products and sums of taps, and two products with carriers: the
 * weights are positive and their sum is 1 but for images.  2 % are more than the higher orders.
 *
 * Other primes: there is no such bound, infinity. */
static double
single_rounding(size_t length, int taps)
{
    static const struct { size_t prime; double u; } butterfly[] = {
        { 2, 5 }, { 3, 11 }, { 5, 17 }, { 7, 19 }
    };
    double sum = taps > 0 ? taps + 10 : 1;
    for (size_t i = 0; i < sizeof butterfly / sizeof *butterfly; i++)
        for (; length % butterfly[i].prime == 0; length /= butterfly[i].prime)
            sum += butterfly[i].u;
    return length == 1 ? 1.02 * sum * FLT_EPSILON / 2 : INFINITY;
}

/* Add sums of |c|, up to 8 % too large, and |c|^2. */
VERSIONS static void
sum_terms(const float *restrict c, size_t n, double *size, double *square)
{
    enum { MANY = 2 * LANES, BLOCK = 64 * MANY };   /* sums in single precision of a block only */
    for (size_t i = 0; i < n; i += BLOCK) {
        float sizes[MANY] = { 0 }, squares[MANY] = { 0 };
        size_t end = n - i < BLOCK ? n : i + BLOCK, j = i;
        for (; j + MANY <= end; j += MANY)
            for (size_t l = 0; l < MANY; l++) {
                float re = fabsf(c[2 * (j + l)]), im = fabsf(c[2 * (j + l) + 1]);
                float more = re > im ? re : im, less = re > im ? im : re;
                sizes[l] += more + 0.4142136f * less;
                squares[l] += re * re + im * im;
            }
        for (; j < end; j++) {
            sizes[0] += fabsf(c[2 * j]) + fabsf(c[2 * j + 1]);
            squares[0] += c[2 * j] * c[2 * j] + c[2 * j + 1] * c[2 * j + 1];
        }
        for (size_t l = 0; l < MANY; l++) {
            *size += (double)sizes[l];
            *square += (double)squares[l];
        }
    }
}

/* What rounding may add to a coefficient.  *likely: the largest |W| of noise of this power. */
static double
rounding_of(const route *r, const band *b, ptrdiff_t origin, const float *c, double *likely)
{
    double size = 0, square = 0;
    ptrdiff_t length = (ptrdiff_t)r->length, rest = (b->lo - origin) % length;
    size_t at = (size_t)(rest < 0 ? rest + length : rest), n = (size_t)(b->hi - b->lo) + 1;
    n = n < r->length ? n : r->length;
    size_t first = n < r->length - at ? n : r->length - at;
    sum_terms(c + 2 * at, first, &size, &square);
    sum_terms(c, n - first, &size, &square);
    *likely = 3 * sqrt(square);
    return r->rounding * size + UNDERFLOW * (double)r->length;
}

/* One pass over part of a scale.  Returns the largest |W|; *rounding is what single precision may
 * have added, or infinity if it is too much: then nothing is done. */
static double
pass(const ss_morlet *plan, size_t i, const record *rec, const double *x, span part, way how,
     double *v, double factor, double *w, double *rounding)
{
    const struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const ss_scale *scale = &plan->scale[i];
    const level *lev = &f->level[r->level];
    int single = how == SINGLE, bound = how == LAST;
    band b = band_of(f, lev, scale->a, f->half[bound]);
    const kaiser *ker = r->kind == LATTICE ? NULL : kernel_of(f, r, &b, bound);
    double unit = single ? ldexp(1, ilogb(rec->x_max)) : 1;
    double *c = r->length > APART ? v : terms_of(f, v);
    ptrdiff_t origin = r->kind == LATTICE ? 0 : b.mid;
    terms(f, r, &b, x, origin, ker, single, unit, c);
    *rounding = 0;
    if (single) {
        double likely;
        *rounding = unit * rounding_of(r, &b, origin, (void *)c, &likely);
        if (*rounding > plan->opts.accuracy * unit * likely * 0.7)
            *rounding = INFINITY;
        if (isinf(*rounding))
            return 0;
        fftwf_execute_dft(r->single, (fftwf_complex *)c, (fftwf_complex *)v);
    } else
        fftw_execute_dft(r->inverse, (fftw_complex *)c, (fftw_complex *)v);
    factor *= unit;
    if (r->kind == LATTICE) {
        double before = rint((double)rec->origin / step_of(lev, r));
        ptrdiff_t first = (ptrdiff_t)part.first - (ptrdiff_t)before;
        double most = single ? put_lattice_single((float *)(void *)v + 2 * first, part.n, factor, w)
            : put_lattice(v + 2 * first, part.n, factor, w);
        return unit * sqrt(most);
    }
    if (single)
        close_circle_single((void *)v, r->length);
    else
        close_circle(v, r->length);
    if (r->kind == ANYWHERE)
        return sqrt(put_anywhere(f, r, &b, scale, ker, v, rec->origin, part, factor, w));
    return unit * sqrt(ss_dense_put(r->weights[how], v, (size_t)b.mid, circle_of(lev),
                                    (size_t)((ptrdiff_t)part.first - rec->origin), part.n, factor,
                                    terms_of(f, v) + 2 * APART, w));
}

void
ss_fft_scale(const ss_morlet *plan, size_t i, const record *rec, const spectra *s, double *scratch,
             span part, double factor, double *most, double *w)
{
    struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const level *lev = &f->level[r->level];
    double before = *most, rounding;
    for (way how = r->single != NULL && rec->x_max > 0 ? SINGLE : FIRST; how < WAYS; how++) {
        double largest = pass(plan, i, rec, s->level[r->level], part, how, scratch + 2 * MARGIN,
                              factor, w, &rounding);
        if (isinf(rounding))
            continue;
        *most = fmax(before, largest);
        if (how == LAST || f->half[0] == f->half[1] || rec->x_max == 0)
            return;
        band b = band_of(f, lev, plan->scale[i].a, f->half[0]);
        double error = rounding + left_out(f, lev, &b, s->size[r->level], r->kind != LATTICE);
        if (error <= TAIL_FLOOR * rec->x_max + 0.9 * plan->opts.accuracy * fmax(0, *most - error)) {
            f->singles += how == SINGLE;
            return;
        }
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

/* Powers of two are fastest; short series stay in the first cache, long ones in none. */
static double
inverse_cost(size_t length)
{
    double cost = COST_FFT * (double)length * log2((double)length + 1);
    cost = (length & (length - 1)) == 0 ? cost : 1.4 * cost;
    return length < 1 << 12 ? cost : length < 1 << 18 ? 1.6 * cost : 3.5 * cost;
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
table_of(struct fft *f, const kaiser *kernel, size_t phases, int single)
{
    table *t = f->table;
    for (; t < f->table + f->tables; t++)
        if (t->kernel == kernel && t->phases == phases && t->single == single)
            return t->weights;
    *t = (table){ kernel, phases, single, ss_dense_new(kernel, phases, single) };
    f->tables += t->weights != NULL;
    return t->weights;
}

static ss_status
make_tables(struct fft *f, const ss_morlet *plan)
{
    f->table = calloc(WAYS * plan->n_scales, sizeof *f->table);
    if (f->table == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < WAYS * plan->n_scales; i++) {
        route *r = &f->route[i / WAYS];
        way how = i % WAYS;
        if ((r->kind != DENSE && r->kind != ANYWHERE) || (how == SINGLE && r->single == NULL))
            continue;
        const level *lev = &f->level[r->level];
        band b = band_of(f, lev, plan->scale[i / WAYS].a, f->half[how == LAST]);
        kaiser *kernel = kernel_of(f, r, &b, how == LAST);
        if (!kernel->prepared)
            ss_kaiser_prepare(kernel);
        if (r->kind != DENSE)
            continue;
        r->weights[how] = table_of(f, kernel, phases_of(lev, r), how == SINGLE);
        if (r->weights[how] == NULL)
            return SS_ENOMEM;
    }
    return SS_OK;
}

/* --- FFTW's plans, made while planner is held --- */

static inverse *
inverse_of_length(struct fft *f, size_t length, fftw_complex *v, fftw_complex *c, unsigned how)
{
    inverse *of = f->inverse;
    for (; of < f->inverse + f->n_inverse; of++)
        if (of->length == length)
            return of;
    c = length > APART ? v : c;
    of->length = length;
    of->plan = fftw_plan_dft_1d((int)length, c, v, FFTW_BACKWARD, how);
    f->n_inverse++;
    return of;
}

/* For scales of which single precision may be good enough: those for which a tone's would be. */
static void
plan_single(const struct fft *f, const ss_morlet *plan, size_t i, inverse *of, fftwf_complex *v,
            fftwf_complex *c, unsigned how)
{
    route *r = &f->route[i];
    band b = band_of(f, &f->level[r->level], plan->scale[i].a, f->half[0]);
    int taps = r->kind == DENSE ? kernel_of(f, r, &b, 0)->taps : 0;
    r->rounding = single_rounding(r->length, taps);
    if (r->kind == ANYWHERE || f->half[0] == f->half[1] || r->rounding > plan->opts.accuracy / 2)
        return;
    if (of->single == NULL)
        of->single = fftwf_plan_dft_1d((int)r->length, r->length > APART ? v : c, v, FFTW_BACKWARD,
                                       how);
    r->single = of->single;
}

/* v, c and x are where the arrays will be as far as alignment is concerned. */
static ss_status
make_plans(struct fft *f, const ss_morlet *plan, double *v, double *c, double *x)
{
    static const unsigned flags[] = { FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT };
    unsigned how = flags[plan->opts.planner];
    for (size_t i = 0; i < plan->n_scales; i++) {
        route *r = &f->route[i];
        level *lev = &f->level[r->level];
        if (r->kind == BY_SUM)
            continue;
        inverse *of = inverse_of_length(f, r->length, (fftw_complex *)v, (fftw_complex *)c, how);
        r->inverse = of->plan;
        plan_single(f, plan, i, of, (fftwf_complex *)v, (fftwf_complex *)c, how);
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
        st = make_plans(f, plan, v + 2 * MARGIN, v + 2 * (longest + 2 * MARGIN), v);
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
    for (size_t i = 0; i < fft->n_inverse; i++) {
        fftw_destroy_plan(fft->inverse[i].plan);
        if (fft->inverse[i].single != NULL)
            fftwf_destroy_plan(fft->inverse[i].single);
    }
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

/* Wisdom is a list of (name number #xflags #xflags #xflags ...), itself in brackets.  FFTW aborts
 * the program over flags that do not fit where it keeps them, in 20, 20 and 9 bits. */
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

/* A file has wisdom in double precision, then, unless it is an old one, in single. */
static int
import_wisdom(char *text)
{
    char *single = strstr(text, "fftwf_wisdom");
    while (single != NULL && single > text && *single != '(')
        single--;
    if (single != NULL && single > text && single[-1] == '\n')
        single[-1] = '\0';
    if (!flags_fit(text) || (single != NULL && !flags_fit(single)))
        return 0;
    pthread_mutex_lock(&planner);
    int good = fftw_import_wisdom_from_string(text)
        && (single == NULL || fftwf_import_wisdom_from_string(single));
    pthread_mutex_unlock(&planner);
    return good;
}

ss_status
ss_wisdom_read(FILE *in, ss_error *err)
{
    if (in == NULL)
        return SS_FAIL_NULL(err);
    char *wisdom = malloc(WISDOM_ROOM);
    if (wisdom == NULL)
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    size_t n = fread(wisdom, 1, WISDOM_ROOM - 1, in);
    int read = !ferror(in), why = errno;
    wisdom[n] = '\0';
    int good = read && n < WISDOM_ROOM - 1 && import_wisdom(wisdom);
    free(wisdom);
    return good ? SS_OK : !read ? ss_fail_errno(err, "wisdom", why)
        : ss_fail(err, SS_EINVAL, "this is no wisdom of %s on this machine", fftw_version);
}

ss_status
ss_wisdom_write(FILE *out)
{
    if (out == NULL)
        return SS_EINVAL;
    pthread_mutex_lock(&planner);
    fftw_export_wisdom_to_file(out);
    fftwf_export_wisdom_to_file(out);
    pthread_mutex_unlock(&planner);
    return fflush(out) == 0 && !ferror(out) ? SS_OK : SS_EIO;
}

size_t
ss_fft_singles(const struct fft *fft)
{
    return fft->singles;
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
