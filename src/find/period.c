/* period.c -- the time after which a signal repeats itself.
 *
 * The largest line of a spectrum may be any harmonic, and the fundamental may be missing; what all
 * of them share is the period. It is the lag of the first peak of the autocorrelation that is nearly
 * as high as the highest. The autocorrelation is that of the spectrum's magnitude instead of its
 * square (Tolonen and Karjalainen 2000, "compressed"): else one strong line makes peaks of its own
 * and a slow drift hides them all. Peaks at the multiples of the lag then refine it, and their
 * scatter is its error. */
#include "find/period.h"

#include <complex.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "base/fft.h"
#include "map/map.h"

#define NEARLY 0.9              /* part of the highest peak: the first peak that is so high is that of the
                                   period */
/* The least correlation that counts. That of white noise has the standard deviation n^-1/2: SIGMAS
 * of them are not reached by chance at any of 1e6 lags. Irregular slips reach 0.05, drifting ones
 * that still repeat 0.3. */
#define LEAST 0.15
#define SIGMAS 5.5

/* --- the autocorrelation -----------------------------------------------------------------------
 *
 * Two real samples are one complex one, and these stand in rows and columns: FFTs of all columns, a twist,
 * and FFTs of all rows leave term r + rows c in row r and column c.  Back they need not be put in order, as
 * a magnitude needs only its own term and the mirrored one.  So no FFT, and no table of FFTW's, is longer
 * than about the root of the record. */

typedef struct grid {
    size_t rows, columns;
    double complex *z;          /* row by row */
} grid;

/* Has n no prime factor above 5, so that its FFT is fast? */
static int
is_smooth(size_t n)
{
    static const size_t prime[] = { 2, 3, 5 };
    for (int i = 0; i < 3; i++)
        while (n % prime[i] == 0)
            n /= prime[i];
    return n == 1;
}

/* The least grid of more than n places, about a square.  Columns are an odd number of cache lines apart: in a
 * power of two, terms of one column would all take the same places of the cache. */
static void
choose_size(size_t n, size_t *rows, size_t *columns)
{
    enum { LINE = 4 };          /* complex numbers in a line */
    const size_t root = (size_t)sqrt((double)n);
    size_t least = SIZE_MAX;
    *rows = *columns = 0;
    for (size_t lines = root / (2 * LINE) | 1; lines <= root / LINE * 2 + 1; lines += 2) {
        size_t down = n / (LINE * lines) + 1;
        if (!is_smooth(lines))
            continue;
        while (!is_smooth(down))
            down++;
        if (down * LINE * lines < least) {
            *rows = down;
            *columns = LINE * lines;
            least = *rows * *columns;
        }
    }
}

/* exp(-2 pi i k / n). */
static double complex
turn(double k, double n)
{
    return cexp(-2 * M_PI * I * k / n);
}

static void
twist(const grid *g, int back)
{
    for (size_t r = 1; r < g->rows; r++) {
        double complex step = turn((double)r, (double)(g->rows * g->columns)), at = 1;
        double complex *z = g->z + r * g->columns;
        step = back ? conj(step) : step;
        for (size_t c = 0; c < g->columns; c++, at *= step)
            z[c] *= at;
    }
}

/* Replace two terms of the complex samples, one mirrored, by those of the samples that the magnitudes of
 * the terms of the real ones are of; turned: exp(-2 pi i k / n) of the first. */
static void
compress(double complex *a, double complex *b, double complex turned)
{
    double complex even = (*a + conj(*b)) / 2, odd = (*a - conj(*b)) * (-0.5 * I) * turned;
    double complex sum = even + odd, rest = even - odd;
    double p = magnitude_of((double[]){ creal(sum), cimag(sum) });
    double q = magnitude_of((double[]){ creal(rest), cimag(rest) });
    *a = (p + q) / 2 + (p - q) / 2 * I * conj(turned);
    *b = (p + q) / 2 + (p - q) / 2 * I * turned;
}

static void
compress_all(const grid *g)
{
    const double n = 2 * (double)(g->rows * g->columns);
    double complex step = turn((double)g->rows, n);
    for (size_t r = 0; 2 * r <= g->rows; r++) {
        size_t mirrored = r > 0 ? g->rows - r : 0;
        double complex *z = g->z + r * g->columns, *other = g->z + mirrored * g->columns;
        double complex turned = turn((double)r, n);
        for (size_t c = 0; c < g->columns; c++, turned *= step) {
            size_t to = r > 0 ? g->columns - 1 - c : (g->columns - c) % g->columns;
            if (other + to >= z + c)
                compress(z + c, other + to, turned);
        }
    }
}

/* x to its autocorrelation, compressed, at lags 0 ... n - 1, 1 at 0.  x has n samples less
 * their mean, then zeros up to 2 rows columns. */
static ss_status
autocorrelation(double *x, size_t n, size_t rows, size_t columns)
{
    grid g = { rows, columns, (double complex *)x };
    ss_status st = ss_complex_fft(g.z, rows, columns, columns, 0);
    twist(&g, 0);
    if (st == SS_OK)
        st = ss_complex_fft(g.z, columns, rows, 1, 0);
    compress_all(&g);
    if (st == SS_OK)
        st = ss_complex_fft(g.z, columns, rows, 1, 1);
    twist(&g, 1);
    if (st == SS_OK)
        st = ss_complex_fft(g.z, rows, columns, columns, 1);
    double factor = x[0] > 0 ? (double)n / x[0] : 0;
    for (size_t i = 0; st == SS_OK && i < n; i++)
        x[i] *= factor / (double)(n - i);
    return st;
}

/* x less its mean, over its largest |value|, then zeros up to size. */
static double *
centred(const double *x, size_t n, size_t size)
{
    double mean = 0, largest = 0;
    double *r = calloc(size, sizeof *r);
    if (r == NULL)
        return NULL;
    for (size_t i = 0; i < n; i++) {
        mean += x[i] / (double)n;
        largest = fmax(largest, fabs(x[i]));
    }
    for (size_t i = 0; i < n; i++)
        r[i] = largest > 0 ? (x[i] - mean) / largest : 0;
    return r;
}

static int
is_peak(const double *r, size_t i)
{
    return r[i] >= r[i - 1] && r[i] > r[i + 1];
}

/* The top of the parabola through the highest of the lags within reach of `at`, and its neighbours. */
static double
peak_near(const double *r, double at, double reach)
{
    size_t best = (size_t)ceil(at - reach);
    for (size_t i = best; (double)i <= at + reach; i++)
        best = r[i] > r[best] ? i : best;
    double bend = r[best - 1] - 2 * r[best] + r[best + 1];
    double shift = bend < 0 ? 0.5 * (r[best - 1] - r[best + 1]) / bend : 0;
    return (double)best + fmax(-0.5, fmin(0.5, shift));
}

/* The period that the peaks at the multiples of a lag have in common, up to last and as many as
 * most, and the height of the last of them. In *error its standard error: alone, a peak is known to
 * the sample. */
static double
follow(const double *r, size_t lag, double last, double most, double *height, double *error)
{
    double period = (double)lag, mm = 0, ml = 0, ll = 0, count = 0;
    for (double m = 1; m <= most && (m + 0.25) * period < last; m++) {
        double at = peak_near(r, m * period, fmax(1, 0.125 * period / sqrt(m)));
        mm += m * m, ml += m * at, ll += at * at, count++;
        period = ml / mm;
        *height = r[(size_t)(at + 0.5)];
    }
    double scatter = count > 1 ? fmax(0, ll - ml * ml / mm) / (count - 1) : 1. / 12;
    *error = sqrt(scatter / mm);
    return period;
}

/* Does it last?  An oscillation that decays repeats itself, too, but not for long. */
static int
lasts(const double *r, size_t lag, size_t last)
{
    enum { MULTIPLES = 32 };
    double height = r[lag], error;
    follow(r, lag, (double)last, MULTIPLES, &height, &error);
    return height >= 0.5 * r[lag];
}

/* The first peak behind the main one that is nearly the highest up to last and, if any peak lasts, lasts; 0:
 * none. */
static size_t
first_peak(const double *r, size_t last, double least)
{
    size_t from = 1;
    double highest = 0;
    while (from < last && r[from] > 0)
        from++;
    for (size_t i = from; i < last; i++)
        highest = is_peak(r, i) ? fmax(highest, r[i]) : highest;
    if (highest < least)
        return 0;
    size_t first = 0;
    for (size_t i = from; i < last; i++)
        if (is_peak(r, i) && r[i] >= NEARLY * highest) {
            if (lasts(r, i, last))
                return i;
            first = first > 0 ? first : i;
        }
    return first;
}

ss_status
ss_period_find(const double *x, size_t n, ss_value *period)
{
    size_t rows, columns;
    double height;
    *period = (ss_value){ NAN, NAN };
    if (n < 8)
        return SS_OK;
    if (n > SIZE_MAX / 8 / sizeof *x)
        return SS_ENOMEM;
    choose_size(n + n / 4, &rows, &columns);    /* the compressed samples are a circle, whose ends meet where
                                                   they are low */
    double *r = centred(x, n, 2 * rows * columns);
    ss_status st = r != NULL ? autocorrelation(r, n, rows, columns) : SS_ENOMEM;
    size_t peak = st != SS_OK ? 0 : first_peak(r, n / 2, fmax(LEAST, SIGMAS / sqrt((double)n)));
    if (peak > 0)
        period->value = follow(r, peak, 0.75 * (double)n, INFINITY, &height, &period->error);
    free(r);
    return st;
}
