/* fft.c -- wavelet coefficients from the spectrum of the record.
 *
 * On a circle of P samples, of which the record fills the first n and zeros the rest, the sum over
 * samples is, for any b = c/rate and with C = pi^-1/4 sqrt(2 pi), in units of a^1/2,
 *     C/P sum_k X_k exp(-v_k^2/2) exp(2 pi i k c/P),   v_k = 2 pi k a rate/P - omega_c,
 * over all integers k, X being periodic in k (Poisson): negative frequencies, the mean and aliases
 * are in it.  It is exact except for the part of the wavelet that reaches around the circle; the sum
 * is cut to |v| <= R.  A scale is then a Fourier series of few terms.
 *
 * Lattice: translations that divide the circle into L equal parts come from the terms folded modulo
 * L and one inverse FFT of that length, exactly.
 * Other translations: the terms, shifted to zero frequency, by an inverse FFT of a length L that
 * oversamples them, then interpolation between its points (kaiser.c) and the carrier's rotation.
 * With a coefficient a sample the positions between points repeat, and so do their weights; else
 * each position has its own, and b is exact to the last bit.
 *
 * On a circle of which a point stands for D samples, x is spread to its points by the same
 * interpolation, run backwards, with 16 taps and 8 points a cycle, which leaves an error below
 * rounding.
 *
 * Error.  A scale is computed for the given accuracy, and then the omitted part is bounded by the
 * record's own spectrum: the cut leaves out at most
 *     C/P sum over |v_k| > R of |X_k| exp(-v_k^2/2),
 * and interpolation with images of size e at most C/P e sum over |v_k| <= R of |X_k|.  Sums of
 * |X_k| over ranges are differences of running sums, which costs almost nothing.  If the bound
 * exceeds the one that the largest |W| allows (9/10 of it; the rest is for lattices that are met only
 * nearly), the scale is computed again with R and e that suffice for any signal. */
#include <fftw3.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include "base/versions.h"
#include "morlet/dense.h"
#include "morlet/fft/plan.h"
#include "morlet/fft/points.h"
#include "morlet/kaiser.h"
#include "morlet/plan.h"

#define SPREAD_BETA (0.985 * M_PI * SPREAD_TAPS * 7 / 8)

enum {
    TERMS = KAISER_AT_ONCE,         /* terms at a time */
    LANES = POINT_LANES             /* samples at a time */
};

/* --- the series of a scale -------------------------------------------------------------------- */

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

/* Terms in units of a^1/2, divided by the response of ker, unless that is NULL: term k at k - origin
 * modulo L of c. */
static void
terms(const struct fft *f, const route *r, const band *b, const double *x, ptrdiff_t origin,
      const kaiser *ker, double *c)
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
        ptrdiff_t rest = (k - origin) % length;
        size_t at = (size_t)(rest < 0 ? rest + length : rest);
        add_terms(x, lev->points, k, g, n, c, r->length, at);
        k += (ptrdiff_t)n;
    }
}

/* Make the points before and after the circle repeat it. */
static void
close_circle(double *v, size_t length)
{
    for (size_t i = 0; i < MARGIN; i++) {
        size_t left = length - 1 - i % length, right = i % length;
        memcpy(v - 2 * (i + 1), v + 2 * left, 2 * sizeof *v);
        memcpy(v + 2 * (length + i), v + 2 * right, 2 * sizeof *v);
    }
}

/* --- output ----------------------------------------------------------------------------------- */

/* ANYWHERE: each coefficient at its own b, tau samples after sample c. */
static double
write_anywhere(const struct fft *f, const route *r, const band *b, const ss_scale *scale,
               const kaiser *ker, const double *v, ptrdiff_t origin, span part, double factor,
               double *w)
{
    const level *lev = &f->level[r->level];
    size_t circle = circle_of(lev);
    double per_sample = (double)r->length / (double)circle, most = 0;
    for (size_t i = 0; i < part.n; i++) {
        spot at = ss_scale_spot(scale, part.first + i, f->rate);
        double c = at.c - (double)origin, tau = at.tau;
        double weight[KAISER_TAPS_MAX], re = 0, im = 0;
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
        double co = cos(phase), si = sin(phase), x = re * co - im * si, y = re * si + im * co;
        most = fmax(most, x * x + y * y);
        w[2 * i] = x * factor;
        w[2 * i + 1] = y * factor;
    }
    return most;
}

/* --- the omitted part ------------------------------------------------------------------------- */

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

/* Bound on the error of any coefficient of a scale by the cut and by interpolation. */
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

/* The terms of a short series, after its values v. */
static double *
terms_of(const struct fft *f, double *v)
{
    return v + 2 * (f->longest + MARGIN);
}

/* One pass over part of a scale, with the first cut or the last.  Returns the largest |W|. */
static double
pass(const ss_morlet *plan, size_t i, const record *rec, const double *x, span part, int last,
     double *v, double factor, double *w)
{
    const struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const ss_scale *scale = &plan->scale[i];
    const level *lev = &f->level[r->level];
    band b = band_of(f, lev, scale->a, f->half[last]);
    const kaiser *ker = r->kind == LATTICE ? NULL : kernel_of(f, r, &b, last);
    double *c = r->length > APART ? v : terms_of(f, v);
    terms(f, r, &b, x, r->kind == LATTICE ? 0 : b.mid, ker, c);
    fftw_execute_dft(r->inverse, (fftw_complex *)c, (fftw_complex *)v);
    if (r->kind == LATTICE) {
        ptrdiff_t before = (ptrdiff_t)rint((double)rec->origin / step_of(lev, r));
        return sqrt(write_points(v + 2 * ((ptrdiff_t)part.first - before), part.n, factor, w));
    }
    close_circle(v, r->length);
    if (r->kind == ANYWHERE)
        return sqrt(write_anywhere(f, r, &b, scale, ker, v, rec->origin, part, factor, w));
    return sqrt(ss_dense_write(r->weights[last], v, (size_t)b.mid, circle_of(lev),
                               (size_t)((ptrdiff_t)part.first - rec->origin), part.n, factor,
                               terms_of(f, v) + 2 * APART, w));
}

void
ss_fft_scale(const ss_morlet *plan, size_t i, const record *rec, const spectra *s, double *scratch,
             span part, double factor, double *most, double *w)
{
    const struct fft *f = plan->fft;
    const route *r = &f->route[i];
    const level *lev = &f->level[r->level];
    const double *x = s->level[r->level];
    double *v = scratch + 2 * MARGIN, before = *most;
    *most = fmax(before, pass(plan, i, rec, x, part, 0, v, factor, w));
    if (f->half[0] == f->half[1] || rec->x_max == 0)
        return;
    band b = band_of(f, lev, plan->scale[i].a, f->half[0]);
    double error = left_out(f, lev, &b, s->size[r->level], r->kind != LATTICE);
    if (error > TAIL_FLOOR * rec->x_max + 0.9 * plan->opts.accuracy * fmax(0, *most - error))
        *most = fmax(before, pass(plan, i, rec, x, part, 1, v, factor, w));
}

size_t
ss_fft_room(const struct fft *fft)
{
    return 2 * (fft->longest + 2 * MARGIN + APART) + ss_dense_room(fft->n);
}

double *
ss_fft_doubles(size_t n)
{
    return fftw_malloc(n * sizeof(double));
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

/* Undo the effect of spreading on low frequencies. */
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
    if (x == NULL)
        return SS_ENOMEM;
    if (lev->samples == 1) {
        memcpy(x, rec->x, rec->n * sizeof *x);
        memset(x + rec->n, 0, (lev->points - rec->n) * sizeof *x);
    } else if (spread_record(lev, rec, x) != SS_OK)
        return SS_ENOMEM;
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
    for (int i = 0; st == SS_OK && i < fft->levels; i++) {
        if (fft->level[i].forward == NULL)
            continue;
        st = forward_level(&fft->level[i], rec, &out->level[i]);
        if (st == SS_OK && fft->half[0] < fft->half[1])
            st = sizes_of_level(&fft->level[i], out->level[i], &out->size[i]);
    }
    return st;
}

void
ss_spectra_free(spectra *s)
{
    for (int i = 0; i < 2; i++) {
        fftw_free(s->level[i]);
        free(s->size[i]);
    }
}
