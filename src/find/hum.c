/* hum.c -- steady lines in a signal that are no part of what repeats in it.
 *
 * Under a Hann window of m whole periods, a periodic signal has all its power in the bins m k - 1, m k
 * and m k + 1.  The other bins are free for lines that do not repeat with it.  A line fills the four
 * bins about it.  Where cycles differ by chance, the powers in the free bins are exponential, and the
 * largest of N is more than ten times the next with a chance below N^-9.  So lines that stand this far
 * above all other free bins are hum, if there are no more than three.  More lines are left alone: they
 * may be those of a signal that repeats after two periods or is forced twice.
 *
 * The band about the frequency is first shifted to zero and thinned, so that a bin costs little.  The
 * error of the period, over all m periods, must be a small part of an oscillation; so the period is
 * taken from the harmonics themselves.  Long records are treated in parts, because a hum may drift. */
#include "find/cycles.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/fft.h"
#include "base/list.h"
#include "find/judgement.h"

#define BAND 0.5                /* part of the frequency that the band extends to either side */
#define ABOVE 10.0              /* a line's power over all others */
#define SEEN 0.001              /* the same: with less it is not sought */
#define ROUNDING 1e-9              /* power re the strongest harmonic: rounding makes such lines */
enum { LINES = 3, CYCLES = 6, PART = 2048 };    /* most lines; fewest cycles, most oscillations in a part */
enum { REACH = 4 };             /* bins about a line that its power may fill */

typedef struct zoomed {         /* x = Re z exp(i center t) in the band, at t = 0, step, 2 step ... */
    double complex *z;
    size_t n;
    double step, center;        /* samples, rad a sample */
} zoomed;

typedef struct spectrum {       /* bins first ... first + n - 1 of a window of so many cycles */
    double complex *bin;
    size_t first, n, cycles;
} spectrum;

typedef struct line {
    double at;                  /* [bins] */
    double complex amplitude;
    double seen;                /* of its power, in free bins */
} line;

static double
power(double complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

static size_t
power_of_two(double least)
{
    size_t size = 1;
    while ((double)size < least)
        size *= 2;
    return size;
}

/* The band, and a fifth of it more on either side: a window brings harmonics from there into it. */
static ss_status
zoom_in(zoomed *zoom, const double *x, size_t n, double f)
{
    size_t size = power_of_two((double)n), middle = (size_t)(f * (double)size);
    size_t half = (size_t)(1.2 * BAND * f * (double)size), few = power_of_two(2. * (double)half + 1);
    real_fft whole;
    *zoom = (zoomed){ calloc(few, sizeof *zoom->z), few, (double)size / (double)few,
                      2 * M_PI * (double)middle / (double)size };
    if (zoom->z == NULL || ss_real_fft_new(&whole, size, 0) != SS_OK)
        return SS_ENOMEM;
    memset(whole.x, 0, size * sizeof *whole.x);
    memcpy(whole.x, x, n * sizeof *x);
    ss_real_fft_run(&whole);
    for (size_t j = middle - half; j <= middle + half && j < size / 2; j++)
        if (j > 0)
            zoom->z[(j + few - middle) % few] = 2 / (double)size * (whole.x[2 * j] + I * whole.x[2 * j + 1]);
    ss_real_fft_free(&whole);
    return ss_complex_fft(zoom->z, few, 1, 1);
}

/* The bins under a Hann window of length samples, in which a line of amplitude 1 is 1 high.  They are one
 * convolution: the phase k i of bin k at sample i is half of k^2 + i^2 - (k - i)^2 (Bluestein 1970). */
static ss_status
window(const spectrum *s, const zoomed *zoom, double length)
{
    double turn = 2 * M_PI / length * zoom->step, from = (double)s->first * turn - zoom->center * zoom->step;
    size_t under = (size_t)fmin((double)zoom->n, ceil(length / zoom->step));
    size_t size = power_of_two((double)(under + s->n));
    double complex *a = calloc(2 * size, sizeof *a);
    if (a == NULL)
        return SS_ENOMEM;
    /* by steps, which err by less than n^2 eps: exp(-i from t), exp(i turn t), exp(i turn t^2 / 2) */
    double complex *chirp = a + size, shift = 1, hann = 1, c = 1;
    const double complex by = cexp(-I * from), on = cexp(I * turn), half = cexp(I * turn / 2);
    for (size_t i = 0; i < under || i < s->n; i++) {
        if (i < s->n)
            chirp[i] = c;
        if (i < under) {
            a[i] = zoom->z[i] * (1 - creal(hann)) * shift * conj(c);
            chirp[(size - i) % size] = c;
        }
        c *= hann * half, shift *= by, hann *= on;
    }
    ss_status st = ss_complex_fft(a, size, 2, 0);
    for (size_t i = 0; i < size; i++)
        a[i] *= chirp[i] / (double)size;
    if (st == SS_OK)
        st = ss_complex_fft(a, size, 1, 1);
    for (size_t k = 0; k < s->n; k++)
        s->bin[k] = zoom->step / length * cexp(-I * turn / 2 * (double)k * (double)k) * a[k];
    free(a);
    return st;
}

/* The period whose harmonics would be at whole bins: the median of what each says, by its weight, as a hum
 * may be beside one.  A line x bins above bin k, and nothing else, gives
 * x = 2 (b[k-1] - b[k+1]) / (2 b[k] - b[k-1] - b[k+1]). */
static ss_status
refine(const spectrum *s, double *period)
{
    struct { double off, weight; } *says = malloc((s->n / s->cycles + 2) * sizeof *says);
    double total = 0, below = 0;
    size_t m = s->cycles, n = 0, i = 0;
    if (says == NULL)
        return SS_ENOMEM;
    for (size_t h = (s->first + m) / m; h * m + 1 < s->first + s->n; h++) {
        const double complex *b = s->bin + (h * m - s->first);
        if (h * m == s->first)
            continue;
        double complex top = 2 * b[0] - b[-1] - b[1];
        if (power(top) > 0) {
            says[n].off = 2 * creal((b[-1] - b[1]) / top) / (double)(h * m);
            total += says[n++].weight = (double)h * cabs(top);
        }
    }
    qsort(says, n, sizeof *says, ss_ascending);
    while (i < n && (below += says[i].weight) < total / 2)
        i++;
    if (i < n)
        *period /= 1 + says[i].off;
    free(says);
    return SS_OK;
}

/* --- the lines ------------------------------------------------------------------------------- */

static int
is_free(const spectrum *s, size_t i)
{
    size_t phase = (s->first + i) % s->cycles;
    return phase > 1 && phase < s->cycles - 1;
}

/* What a line of amplitude 1 leaves x bins away. */
static double complex
shape(double x)
{
    if (fabs(x) < 1e-6 || fabs(fabs(x) - 1) < 1e-6)
        return (fabs(x) < 0.5 ? 1 : 0.5) * cexp(-I * M_PI * x);
    return sin(M_PI * x) * cexp(-I * M_PI * x) / (M_PI * x * (1 - x * x));
}

/* The line that explains most in the free bins about bin i, on ever finer grids. */
static line
measure(const spectrum *s, size_t i)
{
    double best = 0;
    line found = { (double)(s->first + i), 0, 0 };
    for (double step = 0.25; step > 1e-4; step /= 4) {
        double middle = found.at;
        for (int l = -8; l <= 8; l++) {
            double complex sum = 0;
            double at = middle + l * step, norm = 0;
            for (size_t k = i > REACH ? i - REACH : 0; k < s->n && k <= i + REACH; k++)
                if (is_free(s, k)) {
                    double complex here = shape((double)(s->first + k) - at);
                    sum += conj(here) * s->bin[k];
                    norm += power(here);
                }
            if (norm > SEEN && power(sum) / norm > best) {
                best = power(sum) / norm;
                found = (line){ at, sum / norm, norm };
            }
        }
    }
    return found;
}

/* Subtract lines from the bins.  Returns how many stand above all that is left then. */
static size_t
find_lines(const spectrum *s, line found[LINES])
{
    double weakest = INFINITY, strongest = 0;
    size_t kept = 0;
    for (size_t i = 0; i < s->n; i++)
        strongest = fmax(strongest, power(s->bin[i]));
    for (size_t tried = 0;; tried++) {
        size_t at = s->n;
        double most = 0;
        for (size_t i = 0; i < s->n; i++) {
            int taken = !is_free(s, i);
            for (size_t l = 0; l < tried; l++)
                taken |= fabs((double)(s->first + i) - found[l].at) <= REACH;
            if (!taken && power(s->bin[i]) > most) {
                most = power(s->bin[i]);
                at = i;
            }
        }
        if (tried > 0 && most * ABOVE < weakest && weakest > ROUNDING * strongest)
            kept = tried;
        if (tried == LINES || at == s->n)
            return kept;
        weakest = fmin(weakest, most);
        found[tried] = measure(s, at);
        for (size_t i = 0; i < s->n; i++)
            s->bin[i] -= found[tried].amplitude * shape((double)(s->first + i) - found[tried].at);
    }
}

/* --- all of it ------------------------------------------------------------------------------- */

static ss_status
subtract_part(double *x, size_t n, double f, double period, ss_hum *found)
{
    spectrum s = { .cycles = (size_t)((double)n / period) };
    double cycles = (double)s.cycles, low = (1 - BAND) * f, high = fmin((1 + BAND) * f, 0.5);
    zoomed zoom = { 0 };
    line hum[LINES];
    s.first = (size_t)ceil(low * cycles * period + REACH);
    s.n = (size_t)fmax(0, high * cycles * period - REACH - (double)s.first);
    if (s.n == 0)
        return SS_OK;
    s.bin = malloc(s.n * sizeof *s.bin);
    ss_status st = s.bin != NULL ? zoom_in(&zoom, x, n, f) : SS_ENOMEM;
    for (int pass = 0; st == SS_OK && pass < 3; pass++) {   /* the first may be a bin off */
        st = pass > 0 ? refine(&s, &period) : SS_OK;
        if (st == SS_OK)
            st = window(&s, &zoom, cycles * period);
    }
    size_t lines = st == SS_OK ? find_lines(&s, hum) : 0;
    free(s.bin);
    free(zoom.z);
    for (size_t l = 0; l < lines; l++)
        if (hum[l].seen < LITTLE) {     /* of its power: it is not measured well */
            *found = SS_HUM_HIDDEN;
            return SS_OK;
        }
    for (size_t l = 0; l < lines; l++)
        for (size_t i = 0; i < n; i++)
            x[i] -= creal(hum[l].amplitude * cexp(2 * M_PI * I * hum[l].at / (cycles * period) * (double)i));
    if (lines > 0 && *found == SS_HUM_NONE)
        *found = SS_HUM_SUBTRACTED;
    return st;
}

ss_status
ss_hum_subtract(double *x, size_t n, double f, double period, ss_hum *found)
{
    size_t cycles = (size_t)((double)n / period), parts = 1 + (size_t)((double)n * f / PART);
    ss_status st = SS_OK;
    *found = SS_HUM_NONE;
    parts = parts < cycles / CYCLES ? parts : cycles / CYCLES;
    for (size_t i = 0; i < parts && st == SS_OK; i++) {
        size_t first = (size_t)((double)(i * (cycles / parts)) * period);
        size_t end = i + 1 < parts ? (size_t)((double)((i + 1) * (cycles / parts)) * period) : n;
        st = subtract_part(x + first, end - first, f, period, found);
    }
    return st;
}
