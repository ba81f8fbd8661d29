/* cycles.c -- whether a signal repeats itself from cycle to cycle, and how regularly.
 *
 * The autocorrelation of the whole record (period.c) proposes a period.  Its error is not known, since
 * it does not see single cycles, and it has peaks also where nothing repeats.  So each cycle is
 * compared with the next: the lag at which they differ least is the period of the cycle (de Cheveigne
 * and Kawahara 2002).  This lag is exact where the signal is periodic, and the length of the window
 * does not bias it, as it biases the peak of a correlation.  The result is the median of the cycles'
 * frequencies, which ramps at the ends of a record do not move.
 *
 * Its standard error is the root of the sum of the squares of five errors:
 * - the scatter of the cycles over the root of the number of independent ones.  The scatter is the
 *   median deviation where there are many cycles; Student's factor is applied where there are few.
 *   Neighbours that are correlated by rho count as (1 - rho) / (1 + rho);
 * - the drift of the waveform.  A change from cycle to cycle that doubles over two cycles is not noise
 *   and may shift the lags of all cycles alike, by its rms over the rms of the derivative;
 * - the difference of the median of the lags from their mean: lags from jump to jump are whole samples;
 * - the largest difference of a half, a quarter or an eighth of the lag over two, four or eight cycles from
 *   the lag over one: a steady hum pulls every lag towards a multiple of its own period;
 * - the error of the interpolation between samples, from the vertices of two parabolas.
 *
 * A signal does not repeat itself
 * - if the median cycle explains less of the variance of the next than is asked for;
 * - if more than BROKEN of the cycles have no best lag within CYCLE_WIDTH of the period, or are not like the
 *   next cycle at that lag.  Such is a signal that rings anew behind each slip;
 * - if it rings once: the effective number of cycles, (sum E)^2 / sum E^2 of their energies E, is less
 *   than LASTING of them, or the energy decays or grows exponentially, by more than FADE in all and
 *   by more than e in QUICK cycles;
 * - if the energies of the cycles repeat: the signal is modulated, and more than a cycle repeats; or if
 *   their means repeat: the cycle is that of a hum or a ringing.
 *
 * Where jumps lie between samples, the peak of the autocorrelation may be at the length of several
 * cycles.  Then a part of that length is the period, if the signal repeats after the part as well as
 * it does after the whole when it is shifted by a sample. */
#include "find/cycles.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/gauss.h"
#include "find/next_cycle.h"
#include "find/period.h"

#define POINTS 256.0            /* in a period while the lag is searched: more are averaged */
#define AGREES 0.5              /* the least correlation of a cycle that is like the next */
#define SPOILT 2                /* cycles that one gap may make unlike the next */
#define BROKEN 0.25             /* part of the cycles that may be unlike the next: see above */
#define ACTIVE 0.01             /* part of the mean energy: weaker cycles do not count */
#define LASTING 0.25            /* the least effective part of the cycles: see above */
#define FADE 10.0               /* factor of the energy from the first cycle to the last */
#define QUICK 16.0              /* cycles in which the energy falls by e: slower decays do not count */
#define STRAIGHT 0.95           /* the least r^2 of log energy on time in a decay */
#define DEPTH 0.1               /* the least relative scatter of energies or means that is modulation */
#define BETWEEN 0.5             /* the largest correlation with the cycles between two swells */
#define SLOWEST 512             /* the most cycles in a swell */
#define ROBUST 8                /* the fewest cycles whose scatter is found from the median deviation */
#define LATER 8.0               /* cycles: see lasting_of */
#define FEWEST 16               /* the fewest cycles that show modulation */

static double
median_of(double *v, size_t n)
{
    return gsl_stats_select(v, 1, n, n / 2);
}

/* Does the cycle have energy, and a lag? */
static int
is_known(const next_cycle *c, double least)
{
    return c->energy > least && !isnan(c->lag);
}

/* The effective number of cycles over their number: see above. */
static double
lasting(const next_cycle *c, size_t n)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < n; i++) {
        sum += c[i].energy;
        squares += c[i].energy * c[i].energy;
    }
    return sum * sum / (squares * (double)n);
}

/* Do the cycles with energy decay, or grow, along a straight line in log energy? */
static int
fades(const next_cycle *c, size_t n, double least)
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
    return m >= 4 && rate * QUICK > 1 && rate * m > log(FADE) && cov * cov > STRAIGHT * vt * vy;
}

/* Does a number of each cycle, v, repeat itself some cycles later with a correlation of more than like, after
 * it has been different between?  Not if its scatter is below DEPTH of a scale. */
static int
repeats(const double *v, size_t n, double scale, double like)
{
    const view of = { v, n };
    double power, other, product, least = 1;
    ss_view_difference(&of, 0, 0, n, &power, &other, &product);
    if (n < FEWEST || !(sqrt(power) > DEPTH * scale))
        return 0;
    for (size_t lag = 1; lag <= n / 2 && lag <= SLOWEST; lag++) {
        double r = ss_view_correlation(&of, 0, lag, n - lag);
        if (least < BETWEEN && r > like)
            return 1;
        least = fmin(least, r);
    }
    return 0;
}

/* Do the energies of the cycles repeat, from one swell to the next? */
static int
is_modulated(const next_cycle *c, size_t n, double *v)
{
    double mean = 0;
    for (size_t i = 0; i < n; i++)
        mean += (v[i] = c[i].energy) / (double)n;
    return repeats(v, n, mean, CYCLES_LIKE);
}

/* Do the means of the cycles repeat?  Then these are cycles of a hum, or of ringing, in a longer cycle. */
static int
is_in_longer(const next_cycle *c, size_t n, double *v)
{
    double power = 0;
    for (size_t i = 0; i < n; i++) {
        v[i] = c[i].mean;
        power += c[i].energy / (double)n;
    }
    return repeats(v, n, sqrt(power), CYCLES_ALIKE);
}

/* The number of parts of a cycle that repeat as well as the cycle does when it is shifted by a sample. */
static size_t
parts_of(const next_cycle *c, size_t n, double least)
{
    for (size_t p = CYCLE_PARTS; p > 1; p--) {
        size_t so = 0, all = 0;
        for (size_t i = 0; i < n; i++)
            if (is_known(&c[i], least)) {
                all++;
                so += c[i].parts >> p & 1;
            }
        if (all > 0 && 4 * so >= 3 * all)
            return p;
    }
    return 1;
}

/* The part of the variance of a period that a sinusoid of this period does not explain. */
static double
overtones(const double *x, size_t n, double period)
{
    double c = 0, s = 0, mean = 0, power = 0;
    for (size_t i = 0; i < n; i++)
        mean += x[i] / (double)n;
    for (size_t i = 0; i < n; i++) {
        double turn = 2 * M_PI * (double)i / period;
        c += (x[i] - mean) * cos(turn), s += (x[i] - mean) * sin(turn);
        power += (x[i] - mean) * (x[i] - mean);
    }
    return power > 0 ? fmax(0, 1 - 2 * (c * c + s * s) / ((double)n * power)) : 0;
}

/* The correlation of neighbours; 0 if they are too few. */
static double
neighbours(const double *v, size_t n, double mean, double variance)
{
    double sum = 0;
    for (size_t i = 1; i < n; i++)
        sum += (v[i] - mean) * (v[i - 1] - mean);
    return n < 5 || !(variance > 0) ? 0
        : fmax(0, fmin(0.9, sum / ((double)(n - 1) * variance)));
}

/* The largest difference of the lag over one cycle from those over more, if half of the cycles have these. */
static double
pull_of(const next_cycle *c, size_t n, double least, double *v)
{
    double most = 0;
    for (int k = 0; k < CYCLE_LAGS; k++) {
        size_t used = 0, known = 0;
        for (size_t i = 0; i < n; i++) {
            known += (size_t)is_known(&c[i], least);
            if (is_known(&c[i], least) && !isnan(c[i].later[k]))
                v[used++] = c[i].later[k] - c[i].lag;
        }
        if (used > 0 && 2 * used >= known)
            most = fmax(most, fabs(gsl_stats_median(v, 1, used)));
    }
    return most;
}

/* Find median and standard error of the frequencies of the cycles with energy. */
static void
summarise(const next_cycle *c, size_t n, double least, double *v, ss_cycles *out)
{
    size_t used = 0, drifting = 0;
    double mean = 0, variance = 0, drift = 0, bend = 0, lags = 0;
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least)) {
            mean += v[used++] = 1 / c[i].lag;
            bend += c[i].bend, lags += c[i].lag;
        }
    mean /= (double)used, bend /= (double)used;
    for (size_t i = 0; i < used; i++)
        variance += (v[i] - mean) * (v[i] - mean) / (double)(used - 1);
    double rho = neighbours(v, used, mean, variance), f = gsl_stats_median(v, 1, used);
    double free_ones = fmax(1, (double)used * (1 - rho) / (1 + rho));
    double student = gsl_cdf_tdist_Pinv(0.8413, fmax(1, fmin((double)used - 1, free_ones)));
    if (used >= ROBUST) {
        for (size_t i = 0; i < used; i++)
            v[i] = fabs(v[i] - f);
        variance = pow(median_of(v, used) / GAUSS_MEDIAN, 2);
    }
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least) && !isnan(c[i].twice) && c[i].slopes > 0)
            v[drifting++] = (c[i].twice - c[i].change) / 3 / c[i].slopes;
    if (drifting > 0)
        drift = sqrt(fmax(0, median_of(v, drifting)));
    double pull = pull_of(c, n, least, v), skew = fabs(lags / (double)used - 1 / f);
    double scatter = student * sqrt(M_PI / 2 * variance / free_ones);
    out->frequency = (ss_value){ f, hypot(scatter, hypot(hypot(pull, skew), hypot(drift, bend)) * f * f) };
    out->period = (ss_value){ 1 / f, out->frequency.error / (f * f) };
}

/* Count the cycles, and find how alike they are, or why they do not repeat. */
static void
judge(const next_cycle *c, size_t n, double least, double *v, ss_cycles *out)
{
    size_t used = 0, alike = 0;
    for (size_t i = 0; i < n; i++)
        if (is_known(&c[i], least))
            v[used++] = c[i].symmetry;
    out->symmetry = used > 0 ? median_of(v, used) : 0;
    used = 0;
    for (size_t i = 0; i < n; i++) {
        out->n += c[i].energy > least;
        alike += is_known(&c[i], least) && c[i].likeness > AGREES;
        if (is_known(&c[i], least))
            v[used++] = c[i].likeness;
    }
    out->likeness = used > 0 ? median_of(v, used) : 0;
    if (out->n < 2)
        out->why = "under three cycles of what may repeat are in the record";
    else if ((double)(out->n - alike) > fmax(SPOILT, BROKEN * (double)out->n) || used < 2
             || !(out->likeness >= CYCLES_ALIKE))
        out->why = "no cycle resembles the next one";
    else if (lasting(c, n) < LASTING || fades(c, n, least))
        out->why = "it rings once, or sounds in a small part of the record only";
    else if (is_in_longer(c, n, v))
        out->why = "what hums or rings repeats sooner than the rest";
    else if ((out->modulated = is_modulated(c, n, v)) != 0)
        out->why = "its cycles swell and fade in turn: it is modulated";
}

/* Describe the n cycles of x, which begin step samples apart. */
static void
describe(const next_cycle *c, size_t n, const double *x, size_t step, double least, double *v, ss_cycles *out)
{
    judge(c, n, least, v, out);
    if (out->why != NULL)
        return;
    summarise(c, n, least, v, out);
    size_t first = 0, last = n - 1;
    while (!(c[first].energy > least))
        first++;
    while (!(c[last].energy > least))
        last--;
    out->overtones = overtones(x + (first + last) / 2 * step, step, out->period.value);
}

/* Describe the cycles of this period.  *parts becomes the number of shorter cycles in each of them. */
static ss_status
find_at(const double *x, size_t n, double period, ss_cycles *out, size_t *parts)
{
    size_t q = period > POINTS ? (size_t)(period / POINTS) : 1, step = (size_t)period, found = 0;
    size_t reach = step + (size_t)(period * (1 + CYCLE_WIDTH)) + 2 * q + 4, most = n / step + 1;
    double *averaged = calloc(n / q + 1, sizeof *averaged), *v = malloc(most * sizeof *v);
    next_cycle *c = malloc(most * sizeof *c);
    *out = (ss_cycles){ .period = { NAN, NAN }, .frequency = { NAN, NAN } };
    if (averaged != NULL && v != NULL && c != NULL) {
        const view fine = { x, n }, coarse = { averaged, n / q };
        double least = 0;
        for (size_t i = 0; i < n / q * q; i++)
            averaged[i / q] += x[i] / (double)q;
        for (size_t i = 0; i + reach < n; i += step) {
            c[found] = ss_next_cycle(&fine, &coarse, q, i, period);
            least += c[found++].energy;
        }
        least *= ACTIVE / (double)found;
        *parts = parts_of(c, found, least);
        describe(c, found, x, step, least, v, out);
    }
    free(averaged);
    free(v);
    free(c);
    return averaged != NULL && v != NULL && c != NULL ? SS_OK : SS_ENOMEM;
}

/* The correlation of the record with itself LATER cycles later, or fewer if a quarter of it has fewer. */
static double
lasting_of(const double *x, size_t n, double period)
{
    const view of = { x, n };
    double cycles = fmax(1, fmin(LATER, floor(0.25 * (double)n / period)));
    size_t lag = (size_t)(cycles * period + 0.5);
    return lag < n ? ss_view_correlation(&of, 0, lag, n - lag) : 0;
}

ss_status
ss_cycles_find(const double *x, size_t n, ss_cycles *out)
{
    ss_value start;
    size_t parts = 1;
    *out = (ss_cycles){ .period = { NAN, NAN }, .frequency = { NAN, NAN } };
    ss_status st = ss_period_find(x, n, &start);
    if (st != SS_OK)
        return st;
    if (isnan(start.value) || start.value < 4) {
        out->why = "no cycle resembles the next one";
        return SS_OK;
    }
    do {
        start.value /= (double)parts;
        st = find_at(x, n, start.value, out, &parts);
    } while (st == SS_OK && parts > 1);
    if (!isnan(out->period.value))
        out->lasting = lasting_of(x, n, out->period.value);
    return st;
}
