/* cycles.c -- whether a signal repeats itself from cycle to cycle, and how regularly.
 *
 * The autocorrelation of the whole record proposes a period.  Its error is not known, since
 * it does not see single cycles, and it has peaks also where nothing repeats.  So each cycle is
 * compared with the next: the lag at which they differ least is the period of the cycle (de Cheveigne
 * and Kawahara 2002).  This lag is exact where the signal is periodic, and the length of the window
 * does not bias it, as it biases the peak of a correlation.  It is searched in averaged samples first, then
 * in all of them, and a parabola finds it between samples.  The result is the median of the cycles'
 * frequencies, which ramps at the ends of a record do not move.
 *
 * Its standard error is the root of the sum of the squares of five errors:
 * - the scatter of the cycles over the root of the number of independent ones.  The scatter is the
 *   median deviation where there are many cycles; Student's factor is applied where there are few.
 *   Neighbours that are correlated by rho count as (1 - rho) / (1 + rho);
 * - the drift of the waveform.  A change from cycle to cycle that doubles over two cycles is not noise
 *   and may shift the lags of all cycles alike, by its rms over the rms of the derivative;
 * - the difference of the median of the lags from their mean: lags from jump to jump are whole samples.  They
 *   may all be the same, so where the signal jumps, the first jump and the last may lie anywhere within a
 *   sample, over the number of cycles between them;
 * - the largest difference of a half, a quarter or an eighth of the lag over two, four or eight cycles from
 *   the lag over one: a steady hum pulls every lag towards a multiple of its own period;
 * - the error of the interpolation between samples, from the vertices of two parabolas, and FINEST.
 *
 * A signal does not repeat itself
 * - if the median cycle explains less of the variance of the next than is asked for;
 * - if more than a quarter of the cycles have no best lag within WIDTH of the period, or are not like the
 *   next cycle at that lag.  Such is a signal that rings anew behind each slip;
 * - if it rings once: the effective number of cycles, (sum E)^2 / sum E^2 of their energies E, is less
 *   than a quarter of them, or the energy decays or grows exponentially, by more than FADE in all and
 *   by more than e in MANY cycles;
 * - if the energies of the cycles repeat: the signal is modulated, and more than a cycle repeats; or if
 *   their means repeat: the cycle is that of a hum or a ringing.
 *
 * Where jumps lie between samples, the peak of the autocorrelation may be at the length of several
 * cycles.  Then a part of that length is the period, if the signal repeats after the part as well as after the whole.
 *
 * Cycles may differ in turn: then several of them repeat far better than one, and these are the period.  How well,
 * is judged between samples of a smoothed signal, and a jump that lies between two is no difference.  Samples are
 * compared with the mean of those as many cycles before and behind, as a waveform that drifts differs from both, but
 * not from that.
 *
 * A hum may make several cycles more alike than one.  What differs after a part of them is then its line alone.
 * It may also keep all lags at multiples of its own period: the rate of what is slow tells. */
#include "find/cycles.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/fft.h"
#include "base/gauss.h"
#include "base/versions.h"
#include "find/judgement.h"
#include "map/map.h"

#define POINTS 256.0            /* in a period while the lag is searched: more are averaged */
#define WIDTH 0.2               /* relative difference of a cycle's period from the record's, at most */
#define SPOILT 2                /* cycles that one gap may make unlike the next (gaps in test_transitions) */
#define FADE 10.0               /* factor of the energy from the first cycle to the last */
#define SLOWEST 512             /* the most cycles in a swell */
#define ROBUST 8                /* the fewest cycles whose scatter is found from the median deviation */
#define MANY 16                 /* cycles: fewer show no modulation; a decay that is slower does not count */
#define PULLED 16               /* a hum pulls the lag by less than one part in so many */
#define FINEST 0.03             /* of a sample: jumps that a filter has rounded draw lags to whole samples by so much */
#define ROUGH 4.0               /* times: see least_unlike */
#define ALIKE 2e-4              /* of the variance: cycles that differ by less are alike */
#define CLEARER 4.0             /* by chance, cycles with noise or a clock that wanders differ by a factor of 2 */
#define LOW 3.0                 /* times the frequency: the lines of a motion itself may be strong up to there */
#define SEEN 0.6                /* of the cycles: what repeats after more is seen by too few */
#define MOST 64.0               /* periods that are looked at for that */
#define ENOUGH 6.0              /* periods: a gap spoils three of those that are compared with two others, see CALM */
#define CALM 0.7                /* of the cycles: the rest may be spoilt */
#define SLOW 16.0               /* of a period: part of it that is averaged over */
enum { FEWEST_SAMPLES = 64 };   /* of a record: fewer are no longer than what is read about a lag */
enum { SHORTEST = 5 };          /* samples: a part that is shorter is not looked at */
enum { MULTIPLES = 6 };         /* cycles that may be taken for one beside a hum, or that differ in turn */
enum { PARTS = 16 };            /* cycles that may be taken for one, at most */
enum { LAGS = 3 };              /* lags over 2, 4 and 8 cycles, so long a signal must be like itself */

/* --- the period of the whole record ------------------------------------------------------------ */

/* The largest line of a spectrum may be any harmonic, and the fundamental may be missing; what all
 * of them share is the period. It is the lag of the first peak of the autocorrelation that is nearly
 * as high as the highest. The autocorrelation is that of the spectrum's magnitude instead of its
 * square (Tolonen and Karjalainen 2000, "compressed"): else one strong line makes peaks of its own
 * and a slow drift hides them all. Peaks at the multiples of the lag then refine it, and their
 * scatter is its error. */

/* The least correlation that counts, unless white noise, of standard deviation n^-1/2, reaches more at some of n
 * lags. Irregular slips reach 0.05, drifting ones that still repeat 0.3. */
#define LEAST 0.15
enum { AGAIN = 32 };        /* of a lag, at which a signal must still be like itself */

/* The autocorrelation of n samples, compressed, at lags 0 ... n - 1, 1 at 0: r->x, to be freed with r. */
static ss_status
autocorrelation(real_fft *r, const double *x, size_t n)
{
    double mean = 0, largest = 0;
    size_t rest = 0, size = 2 * (n + n / 8) - 2;    /* a circle, whose ends do not meet */
    while (rest != 1) {                 /* without a prime factor above 5 the FFT is fast */
        rest = size += 2;
        for (size_t prime = 2; prime <= 5; prime++)
            while (rest % prime == 0)
                rest /= prime;
    }
    if (ss_real_fft_new(r, size, 0) != SS_OK)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        mean += x[i] / (double)n;
        largest = fmax(largest, fabs(x[i]));
    }
    for (size_t i = 0; i < size; i++)
        r->x[i] = i < n && largest > 0 ? (x[i] - mean) / largest : 0;
    ss_real_fft_run(r);
    for (size_t i = 0; i < size + 2; i += 2) {
        r->x[i] = magnitude_of(r->x + i);
        r->x[i + 1] = 0;
    }
    if (ss_real_fft_turn(r, size) != SS_OK)
        return SS_ENOMEM;
    ss_real_fft_run(r);
    double factor = r->x[0] > 0 ? (double)n / r->x[0] : 0;
    for (size_t i = 0; i < n; i++)
        r->x[i] *= factor / (double)(n - i);
    return SS_OK;
}

static int
is_peak(const double *r, size_t i)
{
    return r[i] >= r[i - 1] && r[i] > r[i + 1];
}

/* The period that the peaks at the multiples of a lag have in common, up to last and as many as
 * most, and the height of the last of them. */
static double
follow(const double *r, size_t lag, double last, double most, double *height)
{
    double period = (double)lag, mm = 0, ml = 0;
    for (double m = 1; m <= most && (m + 0.25) * period < last; m++) {
        const double reach = fmax(1, JITTER * period / sqrt(m));
        size_t best = (size_t)ceil(m * period - reach);
        for (size_t i = best; (double)i <= m * period + reach; i++)
            best = r[i] > r[best] ? i : best;
        /* the vertex of the parabola through the highest there and its neighbours */
        double bend = r[best - 1] - 2 * r[best] + r[best + 1];
        double shift = bend < 0 ? 0.5 * (r[best - 1] - r[best + 1]) / bend : 0;
        double at = (double)best + fmax(-0.5, fmin(0.5, shift));
        mm += m * m;
        ml += m * at;
        period = ml / mm;
        *height = r[(size_t)(at + 0.5)];
    }
    return period;
}

/* The first peak behind the main one that is nearly the highest up to last and, if any peak lasts, lasts: an
 * oscillation that decays repeats itself, too, but not for long.  0: none. */
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
            double height = r[i];
            follow(r, i, (double)last, AGAIN, &height);
            if (height >= 0.5 * r[i])
                return i;
            first = first > 0 ? first : i;
        }
    return first;
}

ss_status
ss_period_find(const double *x, size_t n, double *period)
{
    real_fft r = { 0 };
    double height;
    *period = NAN;
    if (n < 8)
        return SS_OK;
    ss_status st = autocorrelation(&r, x, n);
    const double least = fmax(LEAST, sqrt(2 * log((double)n / FALSE_ALARMS) / (double)n));
    size_t peak = st == SS_OK ? first_peak(r.x, n / 2, least) : 0;
    if (peak > 0)
        *period = follow(r.x, peak, MOSTLY * (double)n, INFINITY, &height);
    ss_real_fft_free(&r);
    return st;
}

typedef struct view {           /* of the signal: all n samples, or averages of some */
    const double *x;
    size_t n;
} view;

/* How a cycle differs from the next one; NaN: not known. */
typedef struct cycle {
    double rate;                /* one over the lag to the next cycle [1/samples] */
    double pull[LAGS];          /* half of the lag over two cycles, a quarter of that over four ..., less the
                                   lag over one [samples] */
    double likeness;            /* correlation with the next cycle */
    double symmetry;            /* correlation with itself half a cycle later */
    double mean, energy;        /* energy: mean square of the signal, less its mean */
    double drift;               /* mean square of the shift that the drift of the waveform may make [samples^2] */
    double noise;               /* mean square of the shift that noise makes, as white as what the lag
                                   leaves [samples^2] */
    double bend;                /* error of the lag between samples, by two parabolas [samples] */
    double jump;                /* 1: the difference grows with the distance from the lag, as of a signal that
                                   jumps; 0: with its square */
} cycle;

/* --- one cycle and the next ------------------------------------------------------------------ */

/* Of m samples and those some lag later, each less their mean: mean squares and mean product. */
typedef struct moments {
    double a, b, ab;
} moments;

/* Sums are made in lanes, which do not wait for each other.  (gcc uses no vectors for 8 lanes.) */
VERSIONS static moments
moments_of(const view *v, size_t first, size_t lag, size_t m)
{
    enum { LANES = 16 };
    const double *p = v->x + first, *q = p + lag;
    double lane[5][LANES] = { { 0 } }, sum[5] = { 0 }, one = 1 / (double)m;
    size_t k = 0;
    for (; k + LANES <= m; k += LANES)
        for (size_t l = 0; l < LANES; l++) {
            double a = p[k + l], b = q[k + l];
            lane[0][l] += a, lane[1][l] += b;
            lane[2][l] += a * a, lane[3][l] += b * b, lane[4][l] += a * b;
        }
    for (int j = 0; j < 5; j++)
        for (size_t l = 0; l < LANES; l++)
            sum[j] += lane[j][l];
    for (; k < m; k++) {
        sum[0] += p[k], sum[1] += q[k];
        sum[2] += p[k] * p[k], sum[3] += q[k] * q[k], sum[4] += p[k] * q[k];
    }
    return (moments){ fmax(0, (sum[2] - sum[0] * sum[0] * one) * one),
                      fmax(0, (sum[3] - sum[1] * sum[1] * one) * one),
                      (sum[4] - sum[0] * sum[1] * one) * one };
}

/* The mean square difference of the m samples from `first` on and those lag later, each less their mean. */
static double
difference(const view *v, size_t first, size_t lag, size_t m)
{
    moments of = moments_of(v, first, lag, m);
    return fmax(0, of.a + of.b - 2 * of.ab);
}

/* The same over their mean squares. */
static double
relative(const view *v, size_t first, size_t lag, size_t m)
{
    moments of = moments_of(v, first, lag, m);
    return of.a + of.b > 0 ? fmax(0, of.a + of.b - 2 * of.ab) / (of.a + of.b) : 1;
}

static double
correlation(const view *v, size_t first, size_t lag, size_t m)
{
    moments of = moments_of(v, first, lag, m);
    return of.a > 0 && of.b > 0 ? of.ab / sqrt(of.a * of.b) : 0;
}

/* How far x lies above the range of three others; negative: below it. */
static double
beyond(double x, double a, double b, double c)
{
    return fmax(0, x - fmax(a, fmax(b, c))) - fmax(0, fmin(a, fmin(b, c)) - x);
}

/* The vertex of the parabola through the values at -step, 0, step. */
static double
vertex(double before, double at, double behind, double step)
{
    double bend = before - 2 * at + behind;
    return bend > 0 ? fmax(-1, fmin(1, 0.5 * (before - behind) / bend)) * step : 0;
}

/* The lag of least difference near one that is known to within reach, found with steps that are halved. */
static size_t
refine(const view *v, size_t first, size_t m, size_t lag, size_t reach)
{
    double least = relative(v, first, lag, m);
    for (size_t step = reach; step > 0; step /= 2)
        for (int sign = -1; sign <= 1; sign += 2)
            for (;;) {
                size_t next = sign > 0 ? lag + step : lag > step ? lag - step : 0;
                if (next < 2 || first + next + m + 2 > v->n)
                    break;
                double d = relative(v, first, next, m);
                if (!(d < least))
                    break;
                least = d;
                lag = next;
            }
    return lag;
}

/* The lag of least difference in steps from lo to hi. */
static size_t
best_lag(const view *v, size_t first, size_t m, size_t lo, size_t hi, size_t step)
{
    size_t best = lo;
    double least = INFINITY;
    for (size_t lag = lo; lag <= hi && first + lag + m <= v->n; lag += step) {
        double d = relative(v, first, lag, m);
        if (d < least) {
            least = d;
            best = lag;
        }
    }
    return best;
}

/* Measure the cycle that begins at sample `first`, and its lag, within WIDTH of the period [samples].  coarse
 * is fine averaged over q samples.  fine reaches (2 + WIDTH) periods and a few samples beyond. */
static cycle
measure(const view *fine, const view *coarse, size_t q, size_t first, double period)
{
    cycle c = { .rate = NAN, .pull = { NAN, NAN, NAN }, .drift = NAN };
    size_t i = first / q, m = (size_t)(period / (double)q), whole = (size_t)period;
    size_t lo = (size_t)fmax(2, period * (1 - WIDTH) / (double)q);
    size_t hi = (size_t)(period * (1 + WIDTH) / (double)q) + 1;
    c.energy = moments_of(fine, first, whole, whole).a;
    for (size_t k = first; k < first + whole; k++)
        c.mean += fine->x[k] / (double)whole;

    size_t rough = best_lag(coarse, i, m, lo, hi, 1);
    if (rough == lo || rough == hi)
        return c;
    double before = correlation(coarse, i, rough - 1, m), at = correlation(coarse, i, rough, m);
    double behind = correlation(coarse, i, rough + 1, m);
    c.likeness = fmin(1, at - 0.25 * (before - behind) * vertex(-before, -at, -behind, 1));
    c.symmetry = correlation(coarse, i, rough / 2, m);

    size_t lag = refine(fine, first, whole, rough * q, q);
    const size_t likely = refine(fine, first, whole, (size_t)(period + 0.5), q);
    if (relative(fine, first, likely, whole) < relative(fine, first, lag, whole))
        lag = likely;           /* averages hide what rings within them */
    if (lag < 3 || first + lag + whole + 2 > fine->n)
        return c;
    double d[5];
    for (size_t k = 0; k < 5; k++)
        d[k] = relative(fine, first, lag + k - 2, whole);
    double near = vertex(d[1], d[2], d[3], 1), far = vertex(d[0], d[2], d[4], 2);
    c.rate = 1 / ((double)lag + near);
    c.bend = fabs(near - far) / 3;
    double by_one = d[1] + d[3] - 2 * d[2], by_two = d[0] + d[4] - 2 * d[2];
    c.jump = by_one > 0 ? fmax(0, fmin(1, 2 - 0.5 * by_two / by_one)) : 0;

    double slopes = difference(fine, first, 1, whole);      /* more than 0 in a cycle with energy */
    c.noise = difference(fine, first, lag, whole) / (slopes * (double)whole);
    if (first + 2 * lag + whole < fine->n)
        c.drift = (difference(fine, first, 2 * lag, whole) - difference(fine, first, lag, whole)) / 3 / slopes;
    /* a hum may pull the lag over twice as many cycles from twice the lag, by up to reach */
    size_t over = lag, reach = lag / PULLED, step = reach / 8 + 1;
    for (int k = 0; k < LAGS && first + 2 * over + whole + 4 < fine->n; k++) {
        over = best_lag(fine, first, whole, 2 * over - reach, 2 * over + reach, step);
        over = refine(fine, first, whole, over, step);
        double off = vertex(relative(fine, first, over - 1, whole), relative(fine, first, over, whole),
                            relative(fine, first, over + 1, whole), 1);
        c.pull[k] = ((double)over + off) / (2 << k) - (double)lag - near;
    }
    return c;
}

/* --- many cycles ----------------------------------------------------------------------------- */

/* The median over n cycles of a member, that of the first: field.  NaN: it is not known of half of them.  v has
 * room for n. */
static double
median_of(const cycle *c, size_t n, const double *field, double *v)
{
    size_t used = 0;
    for (size_t i = 0; i < n; i++) {
        double here = field[i * (sizeof *c / sizeof *field)];
        if (!isnan(here))
            v[used++] = here;
    }
    return used > 0 && 2 * used >= n ? gsl_stats_median(v, 1, used) : NAN;
}

/* Do the cycles with energy decay, or grow, along a straight line in log energy? */
static int
fades(const cycle *c, size_t n, double least)
{
    double m = 0, t = 0, y = 0, tt = 0, yy = 0, ty = 0;
    for (size_t i = 0; i < n; i++) {
        if (!(c[i].energy > least))
            continue;
        double e = log(c[i].energy), at = (double)i;
        m++, t += at, y += e, tt += at * at, yy += e * e, ty += at * e;
    }
    double vt = tt - t * t / m, vy = yy - y * y / m, cov = ty - t * y / m;
    double rate = vt > 0 ? fabs(cov / vt) : 0;
    return m >= 4 && rate * MANY > 1 && rate * m > log(FADE) && cov * cov > (1 - SLIGHT) * vt * vy;
}

/* Does a member of the cycles repeat itself some cycles later with a correlation of more than like, after
 * it has been different between?  Not if its scatter is below LITTLE of a scale. */
static int
repeats(const cycle *c, size_t n, const double *field, double scale, double like, double *v)
{
    const view of = { v, n };
    double least = 1;
    for (size_t i = 0; i < n; i++)
        v[i] = field[i * (sizeof *c / sizeof *field)];
    if (n < MANY || !(sqrt(moments_of(&of, 0, 0, n).a) > LITTLE * scale))
        return 0;
    for (size_t lag = 1; lag <= n / 2 && lag <= SLOWEST; lag++) {
        double r = correlation(&of, 0, lag, n - lag);
        if (least < CYCLES_UNLIKE && r > like)
            return 1;
        least = fmin(least, r);
    }
    return 0;
}

static ss_cycles
repeats_not(const char *why)
{
    return (ss_cycles){ .period = { NAN, NAN }, .frequency = { NAN, NAN }, .why = why };
}

/* Find median and standard error of the frequencies of n cycles. */
static void
summarise(const cycle *c, size_t n, double *v, ss_cycles *out)
{
    double f = median_of(c, n, &c->rate, v), drift = median_of(c, n, &c->drift, v);
    double jump = median_of(c, n, &c->jump, v) * sqrt(1. / 6) / (double)n;      /* 1/12 for each end */
    double bend = 0, lags = 0, pull = 0;
    for (int k = 0; k < LAGS; k++)
        pull = fmax(pull, fabs(median_of(c, n, &c->pull[k], v)));
    for (size_t i = 0; i < n; i++) {
        v[i] = c[i].rate;
        lags += 1 / c[i].rate / (double)n;
        bend += c[i].bend / (double)n;
    }
    double variance = gsl_stats_variance(v, 1, n);
    double rho = n < 5 || !(variance > 0) ? 0 : fmax(0, fmin(NEARLY, gsl_stats_lag1_autocorrelation(v, 1, n)));
    double free_ones = fmax(1, (double)n * (1 - rho) / (1 + rho));
    double student = gsl_cdf_tdist_Pinv(gsl_cdf_ugaussian_P(1), fmax(1, fmin((double)n - 1, free_ones)));
    if (n >= ROBUST) {
        for (size_t i = 0; i < n; i++)
            v[i] = fabs(v[i] - f);
        variance = pow(gsl_stats_median(v, 1, n) / GAUSS_MEDIAN, 2);
    }
    double by_noise = median_of(c, n, &c->noise, v) * pow(f, 4);
    double scatter = student * sqrt(M_PI / 2 * variance / free_ones), skew = hypot(lags - 1 / f, jump);
    drift = drift > 0 ? sqrt(drift) : 0;
    bend = hypot(bend, FINEST);
    out->frequency = (ss_value){ f, hypot(scatter, hypot(hypot(pull, skew), hypot(drift, bend)) * f * f) };
    out->wander = variance > SIGMAS * SIGMAS * by_noise ? scatter / f : 0;
    out->period = (ss_value){ 1 / f, out->frequency.error / (f * f) };
}

/* Describe n cycles; known and v have room for n. */
static void
describe(const cycle *c, size_t n, cycle *known, double *v, ss_cycles *out)
{
    double energy = 0, squares = 0;
    size_t n_known = 0, alike = 0;
    for (size_t i = 0; i < n; i++) {
        energy += c[i].energy / (double)n;
        squares += c[i].energy * c[i].energy / (double)n;
    }
    for (size_t i = 0; i < n; i++) {
        if (!(c[i].energy > FAINT * energy))
            continue;
        out->n++;
        if (isnan(c[i].rate))
            continue;
        known[n_known++] = c[i];
        alike += c[i].likeness > CYCLES_UNLIKE;
    }
    out->symmetry = n_known > 0 ? median_of(known, n_known, &known->symmetry, v) : 0;
    out->likeness = n_known > 0 ? median_of(known, n_known, &known->likeness, v) : 0;
    if (out->n < 2)
        out->why = "under three cycles of what may repeat are in the record";
    else if ((double)(out->n - alike) > fmax(SPOILT, (1 - MOSTLY) * (double)out->n) || n_known < 2
             || !(out->likeness >= CYCLES_ALIKE))
        out->why = "no cycle resembles the next one";
    else if (energy * energy < (1 - MOSTLY) * squares || fades(c, n, FAINT * energy))
        out->why = "it rings once, or sounds in a small part of the record only";
    else if (repeats(c, n, &c->mean, sqrt(energy), CYCLES_ALIKE, v))
        out->why = "what hums or rings repeats sooner than the rest";
    else if ((out->modulated = repeats(c, n, &c->energy, energy, CYCLES_LIKE, v)) != 0)
        out->why = "its cycles swell and fade in turn: it is modulated";
    else
        summarise(known, n_known, v, out);
}

/* Means of q samples each, m of them; NULL: no memory. */
static double *
block_means(const double *x, size_t m, size_t q)
{
    double *out = calloc(m + 1, sizeof *out);
    for (size_t i = 0; out != NULL && i < m * q; i++)
        out[i / q] += x[i] / (double)q;
    return out;
}

/* Describe the cycles of this period. */
static ss_status
find_at(const double *x, size_t n, double period, ss_cycles *out)
{
    size_t q = period > POINTS ? (size_t)(period / POINTS) : 1, step = (size_t)period, found = 0;
    size_t reach = step + (size_t)(period * (1 + WIDTH)) + 2 * q + 4, most = n / step + 1;
    double *averaged = block_means(x, n / q, q), *room = malloc(most * sizeof *room);
    cycle *c = malloc(2 * most * sizeof *c);
    *out = repeats_not(NULL);
    const int is_room = averaged != NULL && room != NULL && c != NULL;
    if (is_room) {
        const view fine = { x, n }, coarse = { averaged, n / q };
        for (size_t i = 0; i + reach < n; i += step)
            c[found++] = measure(&fine, &coarse, q, i, period);
        describe(c, found, c + most, room, out);
    }
    free(averaged);
    free(room);
    free(c);
    return is_room ? SS_OK : SS_ENOMEM;
}

/* --- what differs ---------------------------------------------------------------------------- */

/* Means over m of means over m of the n means of q samples each; NULL: no memory. */
static double *
smoothed(const double *x, size_t n, size_t q, size_t m)
{
    double *out = block_means(x, n, q);
    for (size_t pass = 0; out != NULL && pass < 2; pass++) {
        double sum = 0;
        for (size_t i = 0; i < n - pass * (m - 1); i++) {
            sum += out[i];
            if (i + 1 < m)
                continue;
            const double oldest = out[i + 1 - m];
            out[i + 1 - m] = sum / (double)m;
            sum -= oldest;
        }
    }
    return out;
}

/* The signal some lag later, and as much earlier where ENOUGH periods have both. */
enum { TAPS = 8, BEFORE = TAPS / 2 - 1 };
typedef struct later {
    size_t lag;                 /* in whole samples */
    double tap[TAPS];           /* Lanczos's, for a value between samples */
    int has_both;
    size_t first, end;          /* of the samples that have one, or both */
} later;

static later
later_by(const view *v, double lag, double period)
{
    later by = { .lag = (size_t)lag, .has_both = 2 * (lag + TAPS) + ENOUGH * period < (double)v->n };
    by.first = by.has_both ? by.lag + TAPS : BEFORE;
    by.end = v->n - by.lag - TAPS;
    for (int k = 0; k < TAPS; k++) {
        double t = M_PI * (lag - (double)by.lag - (k - BEFORE));
        by.tap[k] = t == 0 ? 1 : sin(t) / t * sin(2 * t / TAPS) / (2 * t / TAPS);
    }
    return by;
}

/* What a sample differs by from what is there later, or from the mean of that and what is there earlier, which
 * stays the same while a waveform drifts.  A jump between two samples there is no difference.  As large in white
 * noise. */
static double
off(const double *x, const later *by)
{
    const double *behind = x + by->lag, *before = x - by->lag;
    double at = 0, low = fmin(behind[0], behind[1]), high = fmax(behind[0], behind[1]);
    for (int k = 0; k < TAPS; k++)
        at += by->tap[k] * (by->has_both ? 0.5 * (behind[k - BEFORE] + before[BEFORE - k]) : behind[k - BEFORE]);
    if (!by->has_both)
        return beyond(x[0], low, high, at);
    low = 0.5 * (low + fmin(before[0], before[-1]));
    high = 0.5 * (high + fmax(before[0], before[-1]));
    return sqrt(4 / 3.) * beyond(x[0], low, high, at);
}

/* The frequency of the one line that is half of what differs after a lag [per sample], or 0. */
static ss_status
line_between(const view *v, double lag, double period, double *f)
{
    const later by = later_by(v, lag, period);
    const size_t m = (by.end - by.first) / 2 * 2;
    real_fft r;
    double all = 0, line = 0, at = 0;
    size_t top = 1;
    if (ss_real_fft_new(&r, m, 0) != SS_OK)
        return SS_ENOMEM;
    for (size_t i = 0; i < m; i++)
        r.x[i] = off(v->x + by.first + i, &by) * (1 - cos(2 * M_PI * (double)i / (double)m));
    ss_real_fft_run(&r);
    for (size_t k = 0; k <= m / 2; k++) {
        r.x[k] = r.x[2 * k] * r.x[2 * k] + r.x[2 * k + 1] * r.x[2 * k + 1];
        all += r.x[k];
        top = k > 1 && k + 2 <= m / 2 && r.x[k] > r.x[top] ? k : top;
    }
    for (size_t k = top - 1; k <= top + 1; k++)
        line += r.x[k], at += (double)k * r.x[k];
    *f = line > 0.5 * all ? at / line / (double)m : 0;
    ss_real_fft_free(&r);
    return SS_OK;
}

/* How unlike samples and those some lag later may be where a signal repeats: ROUGH times as unlike as samples are to
 * their neighbours with cubes through these, or ALIKE. */
static double
least_unlike(const view *v)
{
    double sum = 0;
    for (size_t i = 3; i + 3 < v->n; i++) {
        const double *x = v->x + i;
        sum += pow(beyond(x[0], x[-1], x[1], (9 * (x[-1] + x[1]) - (x[-3] + x[3])) / 16), 2);
    }
    return fmax(ROUGH * sum / (double)v->n, ALIKE * moments_of(v, 0, 0, v->n).a);
}

/* The mean square by which samples and those some lag away differ, in a cycle that but three in ten are more unlike, so
 * that glitches and a gap do not count.  Of at most MOST cycles. */
static double
unlikeness(const view *v, double lag, double period)
{
    const later by = later_by(v, lag, period);
    const size_t last = (size_t)fmin((double)by.end, (double)by.first + MOST * period);
    double sum[(size_t)MOST] = { 0 };
    size_t n = 0;
    for (size_t i = by.first; i < last; n++) {
        const size_t from = i, end = (size_t)fmin((double)last, (double)by.first + (double)(n + 1) * period);
        for (; i < end; i++)
            sum[n] += pow(off(v->x + i, &by), 2) / (double)(end - from);
    }
    gsl_sort(sum, 1, n);
    return gsl_stats_quantile_from_sorted_data(sum, 1, n, CALM);
}

/* The lag after which it is most like itself, near one that a hum may have pulled by a part of the period. */
static double
lag_near(const view *v, double about, double period)
{
    const size_t off = (size_t)(period / PULLED) + 1, step = off / 8 + 1, m = v->n - (size_t)about - 2 * off - 4;
    size_t lag = refine(v, 0, m, best_lag(v, 0, m, (size_t)about - off, (size_t)about + off, step), step);
    size_t likely = refine(v, 0, m, (size_t)(about + 0.5), 1);
    if (relative(v, 0, likely, m) < relative(v, 0, lag, m))
        lag = likely;
    if (fabs((double)lag - about) > (double)off)        /* where all is smooth, it is most like itself at once */
        return about;
    return (double)lag + vertex(relative(v, 0, lag - 1, m), relative(v, 0, lag, m), relative(v, 0, lag + 1, m), 1);
}

/* --- in turn, or beside a hum ---------------------------------------------------------------- */

/* How a signal is like itself after one period: the lag, how unlike it is to itself then, and what is the
 * least. */
typedef struct once {
    double period, lag, unlike, least;
} once;

static once
compare_once(const view *v, double period)
{
    const double lag = lag_near(v, period, period);
    return (once){ period, lag, unlikeness(v, lag, period), least_unlike(v) };
}

/* After how many cycles of this period does it repeat itself CLEARER times better than after one?  After twice as many,
 * and many, too, and not after others.  If half of what differs is one line far above what repeats, it is a hum's.
 * 0: cycles may differ in turn, or beside a hum or by chance: the line is not so far above, the record shows so many
 * once, or more differs the longer one waits. */
static ss_status
cycles_in_turn(const view *v, const once *one, size_t *in_turn)
{
    enum { LOOKED_AT = 2 * MULTIPLES + 2 };
    const double period = one->period, most = (double)v->n / period;
    double unlike[LOOKED_AT] = { 0, one->unlike }, f = 0, each = period;
    size_t known = 2, best = 1;
    *in_turn = 1;
    if (!(one->unlike > one->least))
        return SS_OK;
    ss_status st = line_between(v, one->lag, period, &f);
    for (; known < LOOKED_AT && (double)known < SEEN * most; known++) {
        const double lag = lag_near(v, (double)known * each, period);
        unlike[known] = unlikeness(v, lag, period);
        if (unlike[known] < unlike[best]) {     /* it tells best how long the cycles are */
            best = known;
            each = lag / (double)known;
        }
    }
    for (size_t p = 2; p <= MULTIPLES && p + 1 < known && *in_turn == 1; p++) {
        double bound = unlike[1] / CLEARER, many = fmax(1, floor((1 - SEEN) * most / (double)p)) * (double)p;
        double last = unlikeness(v, lag_near(v, many * each, period), period);
        int agree = f * period < LOW;
        for (size_t q = 2; agree && q <= 2 * p + 1 && q < known; q++)
            agree = q % p == 0 ? unlike[q] < unlike[q - 1] / CLEARER : unlike[q] >= bound;
        if (agree)
            *in_turn = f * period < 1 && 2 * p < known && last < bound
                       && unlike[2 * p] < fmax(pow(CLEARER, 2) * unlike[p], one->least) ? p : 0;
    }
    return st;
}

/* The largest number of parts of the period after which the signal repeats itself as well as after all of it; else 1.
 * *some: 1 if it is at least alike after some part. */
static size_t
parts_of(const view *v, const once *one, int *some)
{
    const double as_well = fmax(one->least, LARGER * one->unlike);
    *some = 0;
    for (size_t p = PARTS; p > 1; p--) {
        const double lag = one->period / (double)p, near = lag < SHORTEST ? lag : lag_near(v, lag, lag);
        if (near == lag)                        /* it is no more alike there than sooner or later */
            continue;
        if (unlikeness(v, near, one->period) <= as_well)
            return p;
        *some |= relative(v, 0, (size_t)(near + 0.5), v->n - (size_t)(near + 0.5)) < 1 - CYCLES_ALIKE;
    }
    return 1;
}

/* The largest number of parts of the period after which the signal repeats itself but for a hum, whose frequency *hum
 * becomes; else 1.  A hum is a line that is high, or no multiple of what repeats as far as can be told. */
static ss_status
parts_beside_hum(const view *v, double period, double *hum, size_t *parts)
{
    ss_status st = SS_OK;
    for (*parts = MULTIPLES + 1; st == SS_OK && *hum == 0 && *parts > 1;) {
        double f = 0, lag = period / (double)--*parts;
        if (lag >= SHORTEST && relative(v, 0, (size_t)(lag + 0.5), v->n - (size_t)(lag + 0.5)) < 1 - CYCLES_ALIKE)
            st = line_between(v, lag, lag, &f);
        double multiple = f * period, off = fabs(multiple - round(multiple)) * ((double)v->n - lag) / period;
        *hum = f * lag > LOW || (multiple > LOW && off > 0.5) ? f : 0;
    }
    return st;
}

/* A strong hum may keep all lags at multiples of its own period.  What is slow in the signal tells of that: where
 * it has another rate, that is the rate. */
static ss_status
compare_slow(const double *x, size_t n, ss_cycles *found)
{
    const size_t m = 1 + (size_t)(found->period.value / SLOW);
    double *slow = smoothed(x, n, 1, m);
    ss_cycles other;
    if (slow == NULL)
        return SS_ENOMEM;
    ss_status st = find_at(slow, n - 2 * m + 2, found->period.value, &other);
    free(slow);
    if (st == SS_OK && fabs(other.frequency.value - found->frequency.value)
        > SIGMAS * hypot(other.frequency.error, found->frequency.error)) {
        found->frequency = other.frequency;
        found->period = other.period;
    }
    return st;
}

/* Is the period one of several cycles that differ in turn, or are several cycles taken for one?  A sensor may hold its
 * samples: one of each is looked at. */
static ss_status
compare_cycles(const double *x, size_t n, double period, ss_cycles *out)
{
    size_t seen = (size_t)fmin((double)n, MOST * period), changes = 1, in_turn = 1;
    for (size_t i = 1; i < seen; i++)
        changes += x[i] != x[i - 1];
    const size_t held = (size_t)fmin((double)seen / (double)changes, 1 + period / SLOW), m = seen / held;
    if (m < FEWEST_SAMPLES || (double)seen < 2.5 * period)
        return SS_OK;
    double *smooth = smoothed(x, m, held, 2), hum = 0;
    const view v = { smooth, m - 2 };
    int some = 0;
    if (smooth == NULL)
        return SS_ENOMEM;
    once one = compare_once(&v, period / (double)held);
    size_t parts = parts_of(&v, &one, &some);
    ss_status st = parts > 1 ? find_at(x, n, period / (double)parts, out) : SS_OK;
    if (st == SS_OK && parts > 1 && isfinite(out->period.value))
        one = compare_once(&v, out->period.value / (double)held);
    if (st == SS_OK && some && parts == 1 && out->n <= FEW && isfinite(out->period.value))
        *out = repeats_not("what repeats may repeat sooner: in so few cycles, several may be alike by chance");
    if (st == SS_OK && isfinite(out->period.value))
        st = cycles_in_turn(&v, &one, &in_turn);
    if (st == SS_OK && in_turn > 1)
        st = find_at(x, n, out->period.value * (double)in_turn, out);
    if (in_turn == 0)
        *out = repeats_not("cycles may differ in turn, or beside a hum, or by chance");
    else if (in_turn > 1 && fabs(out->period.value - round(out->period.value)) < 2 * FINEST)
        *out = repeats_not("several cycles are a whole number of samples: it may repeat after one");
    parts = 1;
    if (st == SS_OK && isfinite(out->period.value))
        st = parts_beside_hum(&v, out->period.value / (double)held, &hum, &parts);
    free(smooth);
    if (st == SS_OK && parts > 1)
        st = find_at(x, n, out->period.value / (double)parts, out);
    out->hum = isfinite(out->period.value) ? hum / (double)held : 0;
    return st;
}

ss_status
ss_cycles_find(const double *x, size_t n, double about, ss_cycles *out)
{
    double start = about;
    *out = repeats_not(NULL);
    ss_status st = about == 0 ? ss_period_find(x, n, &start) : SS_OK;
    if (st != SS_OK)
        return st;
    if (isnan(start) || start < 4) {
        out->why = "no cycle resembles the next one";
        return SS_OK;
    }
    st = find_at(x, n, start, out);
    if (st == SS_OK && about == 0)
        st = compare_cycles(x, n, isfinite(out->period.value) ? out->period.value : start, out);
    if (st == SS_OK && about == 0 && isfinite(out->period.value))
        st = compare_slow(x, n, out);
    double behind = fmax(1, fmin(1 << LAGS, floor(0.25 * (double)n / out->period.value))) * out->period.value;
    if (behind + 0.5 < (double)n)       /* not NaN */
        out->lasting = correlation(&(view){ x, n }, 0, (size_t)(behind + 0.5), n - (size_t)(behind + 0.5));
    return st;
}
