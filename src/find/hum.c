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
 * sought as the one that gives the strongest harmonics most power.  Long records are treated in
 * parts, because a hum may drift.  What none of some parts has, here and there, is not steady, and is not
 * looked for in the others. */
#include "find/hum.h"

#include <gsl/gsl_min.h>
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/fft.h"
#include "base/versions.h"

#define BAND 0.5                /* part of the frequency that the band extends to either side */
#define BEYOND 0.1              /* the same for harmonics that the window brings into the band */
#define ABOVE 10.0              /* a line's power over all others */
#define REACH 4.0               /* bins about a line that its power may fill */
#define CLEAR 0.1               /* part of a line's power in free bins: with less it is not measured well */
#define SEEN 0.001              /* the same: with less it is not sought */
#define FAINT 1e-3              /* part of the strongest harmonic: a line below it disturbs no fit */
enum { LINES = 3, FEWEST = 6, FREE = 16, BATCH = 16, STRONGEST = BATCH };
enum { PART = 2048, LONGEST = 16384 };  /* oscillations in a part of a record */
enum { ENOUGH = 16 };           /* most parts without a hum after which there is none */

typedef struct zoomed {         /* x = Re z exp(i center t) in the band, at t = 0, step, 2 step ... */
    double complex *z;          /* under the window */
    size_t n;
    double step, center;        /* samples, rad a sample */
    double length;              /* of the window in samples: cycles periods */
    size_t cycles;
} zoomed;

typedef struct line {
    double at;                  /* [bins] */
    double complex amplitude;
    double seen;                /* of its power, in free bins */
} line;

/* Fourier sums at n angular frequencies, a batch: of lines there, their amplitudes. */
VERSIONS static void
sums_near(const zoomed *zoom, const double *w, size_t n, double complex *to)
{
    double re[BATCH] = { 0 }, im[BATCH] = { 0 }, c[BATCH] = { 0 }, s[BATCH] = { 0 };
    double at_c[BATCH], at_s[BATCH];
    for (size_t l = 0; l < BATCH; l++) {
        double turn = l < n ? (w[l] - zoom->center) * zoom->step : 0;
        c[l] = cos(turn), s[l] = sin(turn);
        at_c[l] = 1, at_s[l] = 0;
    }
    for (size_t i = 0; i < zoom->n; i++) {
        double a = creal(zoom->z[i]), b = cimag(zoom->z[i]);
        for (size_t l = 0; l < BATCH; l++) {
            double next = at_c[l] * c[l] - at_s[l] * s[l];
            re[l] += a * at_c[l] + b * at_s[l];
            im[l] += b * at_c[l] - a * at_s[l];
            at_s[l] = at_c[l] * s[l] + at_s[l] * c[l];
            at_c[l] = next;
        }
    }
    for (size_t l = 0; l < n; l++)
        to[l] = 2 * zoom->step / zoom->length * (re[l] + I * im[l]);
}

static double
power(double complex z)
{
    return creal(z) * creal(z) + cimag(z) * cimag(z);
}

/* What a line of amplitude 1 leaves x bins away is circle_of(x) / (x (1 - x^2)), and circle_of is the same
 * for all bins. */
static double complex
circle_of(double x)
{
    return sin(M_PI * x) / M_PI * cexp(-I * M_PI * x);
}

static double complex
shape(double x, double complex circle)
{
    if (fabs(x) < 1e-6 || fabs(fabs(x) - 1) < 1e-6)
        return (fabs(x) < 0.5 ? 1 : 0.5) * cexp(-I * M_PI * x);
    return circle / (x * (1 - x * x));
}

static size_t
power_of_two(double least)
{
    size_t size = 1;
    while ((double)size < least)
        size *= 2;
    return size;
}

/* The sums at n angular frequencies from w on, `by` apart, as one convolution: the phase k i of line k
 * at sample i is half of k^2 + i^2 - (k - i)^2 (Bluestein 1970). */
static ss_status
sums_at(const zoomed *zoom, double w, double by, size_t n, double complex *to)
{
    double from = (w - zoom->center) * zoom->step, half = 0.5 * by * zoom->step;
    size_t size = power_of_two((double)(zoom->n + n));
    double complex *a = calloc(2 * size, sizeof *a);
    if (a == NULL)
        return SS_ENOMEM;
    double complex *chirp = a + size;
    for (size_t i = 0; i < zoom->n || i < n; i++) {
        double t = (double)i;
        double complex c = cexp(I * half * t * t);
        if (i < zoom->n)
            a[i] = zoom->z[i] * cexp(-I * (from + half * t) * t);
        if (i < n)
            chirp[i] = c;
        if (i > 0 && i < zoom->n)
            chirp[size - i] = c;
    }
    ss_status st = ss_complex_fft(a, size, 2, 1, 0);
    for (size_t i = 0; i < size; i++)
        a[i] *= chirp[i] / (double)size;
    if (st == SS_OK)
        st = ss_complex_fft(a, size, 1, 1, 1);
    for (size_t k = 0; k < n; k++)
        to[k] = 2 * zoom->step / zoom->length * cexp(-I * half * (double)k * (double)k) * a[k];
    free(a);
    return st;
}

static ss_status
zoom_in(zoomed *zoom, const double *x, size_t n, double f)
{
    size_t size = power_of_two((double)n), middle = (size_t)(f * (double)size);
    size_t half = (size_t)((BAND + BEYOND) * f * (double)size);
    size_t few = power_of_two(2. * (double)half + 1);
    real_fft whole;
    zoom->z = calloc(few, sizeof *zoom->z);
    if (zoom->z == NULL || ss_real_fft_new(&whole, size, 0) != SS_OK)
        return SS_ENOMEM;
    for (size_t i = 0; i < size; i++)
        whole.x[i] = i < n ? x[i] : 0;
    ss_real_fft_run(&whole);
    for (size_t j = middle - half; j <= middle + half && j < size / 2; j++)
        if (j > 0)
            zoom->z[(j + few - middle) % few] = 2 / (double)size * (whole.x[2 * j] + I * whole.x[2 * j + 1]);
    ss_real_fft_free(&whole);
    zoom->step = (double)size / (double)few;
    zoom->center = 2 * M_PI * (double)middle / (double)size;
    zoom->n = few;
    return ss_complex_fft(zoom->z, few, 1, 1, 1);
}

static void
apply_window(zoomed *zoom)
{
    size_t n = (size_t)fmin((double)zoom->n, ceil(zoom->length / zoom->step));
    memset(zoom->z + n, 0, (zoom->n - n) * sizeof *zoom->z);
    zoom->n = n;
    for (size_t i = 0; i < n; i++)
        zoom->z[i] *= 0.5 - 0.5 * cos(2 * M_PI * (double)i * zoom->step / zoom->length);
}

/* --- the period ------------------------------------------------------------------------------ */

typedef struct harmonics {
    const zoomed *zoom;
    size_t n, k[STRONGEST];
    double power[STRONGEST];
} harmonics;

/* Keep the line if it is one of the strongest. */
static void
insert(harmonics *h, size_t k, double strength)
{
    size_t i = h->n < STRONGEST ? h->n++ : STRONGEST - 1;
    if (i == STRONGEST - 1 && h->power[i] > strength)
        return;
    for (; i > 0 && h->power[i - 1] < strength; i--) {
        h->power[i] = h->power[i - 1];
        h->k[i] = h->k[i - 1];
    }
    h->power[i] = strength;
    h->k[i] = k;
}

static double
less_harmonic(double period, void *user)
{
    const harmonics *h = user;
    double sum = 0, w[STRONGEST] = { 0 };
    double complex at[STRONGEST];
    for (size_t i = 0; i < h->n; i++)
        w[i] = 2 * M_PI * (double)h->k[i] / period;
    sums_near(h->zoom, w, h->n, at);
    for (size_t i = 0; i < h->n; i++)
        sum -= sqrt(power(at[i]));
    return sum;
}

/* Move *at to where f is least, to a thousandth of a bin (Brent), unless f is less at an end. */
static ss_status
narrow(gsl_function *f, double bin, double *at)
{
    double low = *at - 0.3 * bin, high = *at + 0.3 * bin;
    double f_at = GSL_FN_EVAL(f, *at), f_low = GSL_FN_EVAL(f, low), f_high = GSL_FN_EVAL(f, high);
    if (!(f_at < f_low && f_at < f_high))
        return SS_OK;
    gsl_min_fminimizer *m = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
    if (m == NULL)
        return SS_ENOMEM;
    int failed = gsl_min_fminimizer_set_with_values(m, f, *at, f_at, low, f_low, high, f_high);
    double wide = 0.6 * bin;
    for (int i = 0; i < 30 && !failed && wide > 1e-3 * bin; i++) {
        failed = gsl_min_fminimizer_iterate(m);
        *at = gsl_min_fminimizer_x_minimum(m);
        wide = gsl_min_fminimizer_x_upper(m) - gsl_min_fminimizer_x_lower(m);
    }
    gsl_min_fminimizer_free(m);
    return SS_OK;
}

/* Find the strongest harmonics of a period in the band. */
static void
find_harmonics(harmonics *h, double low, double high, double period)
{
    double w[BATCH] = { 0 };
    double complex at[BATCH];
    size_t k = (size_t)ceil(low * period);
    while ((double)k <= high * period) {
        size_t n = 0;
        for (; n < BATCH && (double)(k + n) <= high * period; n++)
            w[n] = 2 * M_PI * (double)(k + n) / period;
        sums_near(h->zoom, w, n, at);
        for (size_t i = 0; i < n; i++)
            insert(h, k + i, power(at[i]));
        k += n;
    }
}

/* The period at which the strongest harmonics have most power, to a thousandth of a bin; the given one if
 * there is no maximum near it. */
static ss_status
refine_period(const zoomed *zoom, double low, double high, double *period)
{
    harmonics h = { .zoom = zoom };
    find_harmonics(&h, low, high, *period);
    if (h.n == 0)
        return SS_OK;
    double bin = *period * *period / (zoom->length * (double)h.k[0]), best = *period;
    double least = less_harmonic(best, &h);
    gsl_function f = { less_harmonic, &h };
    for (int i = -4; i <= 4; i++) {     /* quarters of a bin */
        double at = *period + 0.25 * i * bin, found = less_harmonic(at, &h);
        if (found < least) {
            least = found;
            best = at;
        }
    }
    *period = best;
    return narrow(&f, bin, period);
}

/* --- the lines ------------------------------------------------------------------------------- */

typedef struct comb {
    size_t first, n, cycles;
    double complex *bin;        /* [n] from the bin first on */
    line line[LINES];
    size_t n_lines;
} comb;

static int
is_free(const comb *c, size_t i)
{
    size_t phase = (c->first + i) % c->cycles;
    return phase > 1 && phase < c->cycles - 1;
}

/* The strongest free bin away from the known lines, and its power in *most.  c->n: there is none. */
static size_t
strongest(const comb *c, double *most)
{
    size_t best = c->n;
    *most = 0;
    for (size_t i = 0; i < c->n; i++) {
        int is_known = 0;
        for (size_t l = 0; l < c->n_lines; l++)
            is_known |= fabs((double)(c->first + i) - c->line[l].at) <= REACH;
        if (!is_known && is_free(c, i) && power(c->bin[i]) > *most) {
            *most = power(c->bin[i]);
            best = i;
        }
    }
    return best;
}

/* The part of the power in the free bins near bin i that a line at a place explains. */
static double
explained(const comb *c, size_t i, double at, line *fitted)
{
    double complex sum = 0, circle = circle_of((double)(c->first + i) - at);
    double norm = 0;
    for (size_t k = i > REACH ? i - (size_t)REACH : 0; k < c->n && (double)k <= (double)i + REACH; k++)
        if (is_free(c, k)) {
            double complex s = shape((double)(c->first + k) - at, circle);
            sum += conj(s) * c->bin[k];
            norm += power(s);
        }
    *fitted = (line){ at, sum / norm, norm };
    return norm > SEEN ? power(sum) / norm : 0;
}

/* Find the line that explains most about bin i, on ever finer grids. */
static line
measure(const comb *c, size_t i)
{
    double best = 0;
    line found = { (double)(c->first + i), 0, 0 }, here;
    for (double step = 0.25; step > 1e-4; step /= 4) {
        double middle = found.at;
        for (int l = -8; l <= 8; l++) {
            double now = explained(c, i, middle + l * step, &here);
            if (now > best) {
                best = now;
                found = here;
            }
        }
    }
    return found;
}

/* Subtract lines from the bins, and keep those that stand above all that is left then. */
static void
find_lines(comb *c)
{
    size_t kept = 0, n_free = 0;
    double weakest = INFINITY, rest, least = 0;
    for (size_t i = 0; i < c->n; i++) {
        n_free += (size_t)is_free(c, i);
        least = fmax(least, SEEN * FAINT * FAINT * power(c->bin[i]));
    }
    size_t at = strongest(c, &rest);
    while (n_free >= FREE && c->n_lines < LINES && at < c->n) {
        line found = c->line[c->n_lines++] = measure(c, at);
        double complex circle = circle_of((double)(c->first + at) - found.at);
        for (size_t i = 0; i < c->n; i++)
            c->bin[i] -= found.amplitude * shape((double)(c->first + i) - found.at, circle);
        weakest = fmin(weakest, rest);
        at = strongest(c, &rest);
        if (rest * ABOVE < weakest && weakest > least)
            kept = c->n_lines;
    }
    c->n_lines = kept;
}

/* --- all of it ------------------------------------------------------------------------------- */

static ss_status
subtract_zoomed(zoomed *zoom, double *x, size_t n, double f, double period, ss_hum *found)
{
    double low = (1 - BAND) * f, high = fmin((1 + BAND) * f, 0.5);
    comb c = { .cycles = zoom->cycles };
    zoom->length = (double)zoom->cycles * period;
    apply_window(zoom);
    ss_status st = refine_period(zoom, low, high, &period);
    double length = (double)zoom->cycles * period;
    c.first = (size_t)ceil(low * length + REACH);
    c.n = (size_t)fmax(0, high * length - REACH - (double)c.first);
    c.bin = malloc((c.n + 1) * sizeof *c.bin);
    if (st == SS_OK && c.bin == NULL)
        st = SS_ENOMEM;
    if (st == SS_OK)
        st = sums_at(zoom, 2 * M_PI * (double)c.first / length, 2 * M_PI / length, c.n, c.bin);
    if (st == SS_OK)
        find_lines(&c);
    free(c.bin);
    if (st != SS_OK)
        return st;
    for (size_t l = 0; l < c.n_lines; l++)
        if (c.line[l].seen < CLEAR) {
            *found = SS_HUM_HIDDEN;
            return SS_OK;
        }
    for (size_t l = 0; l < c.n_lines; l++) {
        double w = 2 * M_PI * c.line[l].at / length;
        for (size_t i = 0; i < n; i++)
            x[i] -= creal(c.line[l].amplitude * cexp(I * w * (double)i));
    }
    if (c.n_lines > 0 && *found == SS_HUM_NONE)
        *found = SS_HUM_SUBTRACTED;
    return SS_OK;
}

static ss_status
subtract_part(double *x, size_t n, double f, double period, ss_hum *found)
{
    zoomed zoom = { .cycles = (size_t)((double)n / period) };
    ss_status st = zoom_in(&zoom, x, n, f);
    if (st == SS_OK)
        st = subtract_zoomed(&zoom, x, n, f, period, found);
    free(zoom.z);
    return st;
}

ss_status
ss_hum_subtract(double *x, size_t n, double f, double period, ss_hum *found)
{
    size_t cycles = (size_t)((double)n / period);
    size_t parts = 1 + (size_t)((double)n * f / PART), each = cycles / parts;
    ss_status st = SS_OK;
    *found = SS_HUM_NONE;
    if (each < FEWEST) {
        each = FEWEST;
        parts = cycles / FEWEST;
    }
    if ((double)each * period * f > LONGEST)
        return SS_OK;
    size_t every = 1 + parts / ENOUGH;
    for (int others = 0; others < 2 && !(others && *found == SS_HUM_NONE); others++)
        for (size_t i = 0; i < parts && st == SS_OK; i++) {
            size_t first = (size_t)((double)(i * each) * period);
            size_t end = i + 1 < parts ? (size_t)((double)((i + 1) * each) * period) : n;
            if ((i % every > 0) == others)
                st = subtract_part(x + first, end - first, f, period, found);
        }
    return st;
}
