/* slip.c -- the slip of a pulled slider, seen in the force of its spring.
 *
 * A slider of mass m is held by friction up to f_s and braked by f_k while it slips.  A spring of
 * stiffness k, whose end moves at U, pulls it.  The force s of the spring rises at s' = k U in the
 * stick.  In the slip, at time u after its onset, it is
 *
 *     s = f_k + D cos(w u) + (k U / w) sin(w u),    D = f_s - f_k, w = sqrt(k/m), q = D w / (k U).
 *
 * The slip ends when s' is k U again, at u = 2 (pi - atan q) / w, where s = f_k - D.  The slip and the
 * loadings on either side of it are fitted to the samples by least squares.  The fit varies the onset,
 * f_s, f_k and w.  Simpler readings err: noise and the momentum of the drive raise the largest sample
 * above f_s, and a line that is followed to within the noise goes on into the slip.
 *
 * The residual of a measured slip is not white, so errors count fewer samples (colour.c). */
#include "find/slip.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"
#include "find/colour.h"
#include "find/judgement.h"

enum { ONSET, TOP, MIDDLE, SPEED, FITTED };     /* onset behind the first sample used; SPEED: of the phase, w */
enum { STEPS = 60 };                            /* most iterations */
#define EXPLAINED 0.98          /* part of the sum of squares about the mean: a fit that explains less is
                                   another shape */
#define DEEP 0.8                /* part of D: 10 and 90 % of the fall lie at f_k +- so much */

typedef struct fall {
    const double *x;            /* n samples */
    size_t n;
    double loading;
} fall;

static double
length_of(const double p[FITTED], double loading)
{
    double w = p[SPEED], q = (p[TOP] - p[MIDDLE]) * w / loading;
    return 2 * (M_PI - atan(q)) / w;
}

/* The force of the model less the samples, and its slopes by the parameters. */
static ss_status
model(const double *p, double *residual, double *slopes, void *user)
{
    const fall *f = user;
    double w = p[SPEED], D = p[TOP] - p[MIDDLE], a = f->loading, r = a / w, q = D / r;
    double length = length_of(p, a), by_D = -2 / (1 + q * q) / a, by_w = (by_D * D - length) / w;
    if (!(w > 0))
        return SS_EDATA;
    for (size_t i = 0; i < f->n; i++) {
        double u = (double)i - p[ONSET], c = cos(w * u), s = sin(w * u), force;
        double d[FITTED] = { -a, 1, 0, 0 };
        if (u < 0) {
            force = p[TOP] + a * u;
        } else if (u < length) {
            force = p[MIDDLE] + D * c + r * s;
            d[ONSET] = D * w * s - a * c;
            d[TOP] = c;
            d[MIDDLE] = 1 - c;
            d[SPEED] = -D * u * s - r * s / w + r * u * c;
        } else {
            force = p[MIDDLE] - D + a * (u - length);
            d[TOP] = -1 - a * by_D;
            d[MIDDLE] = 2 + a * by_D;
            d[SPEED] = -a * by_w;
        }
        if (residual != NULL)
            residual[i] = force - f->x[i];
        if (slopes != NULL)
            memcpy(slopes + i * FITTED, d, sizeof d);
    }
    return SS_OK;
}

/* The first sample, forwards or backwards from where x passes the middle of the fall, that is past a level
 * near its end; `end`: none is. */
static size_t
walk(const double *x, size_t i, size_t end, double level)
{
    int above = x[i] > level, step = end > i ? 1 : -1;
    while (i != end && (x[i] > level) == above)
        i = step > 0 ? i + 1 : i - 1;
    return i;
}

/* Find the parameters to start from, by the times at which x passes 10, 50 and 90 % of the fall.  Returns
 * the samples to use, up to about half a slip on either side; empty: it is no fall. */
static ss_window
start(double p[FITTED], const double *x, ss_window room, size_t high, size_t low)
{
    double middle = 0.5 * (x[high] + x[low]), half = 0.5 * (x[high] - x[low]);
    size_t at = walk(x, high, low, middle);
    double from = (double)walk(x, at, high, middle + DEEP * half);
    double to = (double)walk(x, at, low, middle - DEEP * half), centre = 0.5 * (from + to);
    if (!(half > 0 && to > from))
        return (ss_window){ 0, 0 };
    double w = (acos(-DEEP) - acos(DEEP)) / (to - from), reach = 1.5 * M_PI / w;
    ss_window used = { (size_t)fmax((double)room.first, centre - reach),
                       (size_t)fmin((double)room.end, centre + reach + 1) };
    memcpy(p, (double[FITTED]){ centre - M_PI / 2 / w - (double)used.first, middle + half, middle, w },
           FITTED * sizeof *p);
    return used;
}

/* --- the numbers ----------------------------------------------------------------------------- */

enum { NUMBERS = 7 };

static void
numbers_of(const double p[FITTED], double loading, double number[NUMBERS])
{
    double D = p[TOP] - p[MIDDLE], w = p[SPEED], length = length_of(p, loading);
    double peak = hypot(D, loading / w);        /* amplitude of the oscillation, whose phase is 0 there */
    double duration = (acos(-DEEP * D / peak) - acos(DEEP * D / peak)) / w;
    memcpy(number, (double[NUMBERS]){ p[ONSET], p[ONSET] + length, 2 * D, duration, p[TOP], p[MIDDLE],
                                      w * w }, NUMBERS * sizeof *number);
}

/* Fill in the numbers, and their errors by the covariance of the parameters for samples of variance 1. */
static void
fill(ss_slip *s, const fall *f, const double p[FITTED], const double *covariance)
{
    const double D = p[TOP] - p[MIDDLE], step[FITTED] = { 1e-4 / p[SPEED], 1e-4 * D, 1e-4 * D, 1e-4 * p[SPEED] };
    ss_value *const to[NUMBERS] = { &s->onset, &s->end, &s->drop, &s->duration, &s->top, &s->middle,
                                    &s->k_over_m };
    double value[NUMBERS], above[FITTED][NUMBERS], below[FITTED][NUMBERS], moved[FITTED];
    numbers_of(p, f->loading, value);
    for (size_t k = 0; k < FITTED; k++) {
        memcpy(moved, p, sizeof moved);
        moved[k] = p[k] + step[k];
        numbers_of(moved, f->loading, above[k]);
        moved[k] = p[k] - step[k];
        numbers_of(moved, f->loading, below[k]);
    }
    for (size_t i = 0; i < NUMBERS; i++) {
        double variance = 0;
        for (size_t k = 0; k < FITTED; k++)
            for (size_t l = 0; l < FITTED; l++)
                variance += covariance[k * FITTED + l] * (above[k][i] - below[k][i]) / (2 * step[k])
                    * (above[l][i] - below[l][i]) / (2 * step[l]);
        *to[i] = (ss_value){ value[i], sqrt(s->variance * fmax(variance, 0)) };
    }
}

/* left: model less sample. */
static void
fill_residual(ss_slip *s, const double *left, size_t n)
{
    double length = s->end.value - s->onset.value, samples[SLIP_PARTS] = { 0 };
    for (size_t i = 0; i < n; i++) {
        double part = SLIP_PARTS * (((double)i - s->onset.value) / length + 1) / 3;
        if (!(part >= 0 && part < SLIP_PARTS))
            continue;
        s->residual[(size_t)part] -= left[i];
        samples[(size_t)part]++;
    }
    for (size_t k = 0; k < SLIP_PARTS; k++)
        s->residual[k] /= samples[k] * s->drop.value;
}

ss_status
ss_slip_fit(ss_slip *out, const double *x, ss_window room, size_t high, size_t low, double loading)
{
    const ss_value none = { NAN, NAN };
    double p[FITTED], covariance[FITTED * FITTED];
    *out = (ss_slip){ none, none, none, none, none, none, none, NAN, NAN, 0, NAN, { 0 } };
    if (!(loading > 0) || low < high + FEWEST)
        return SS_OK;
    ss_window used = start(p, x, room, high, low);
    fall f = { x + used.first, ss_window_length(used), loading };
    if (f.n < FEWEST)
        return SS_OK;
    double *left = malloc(f.n * sizeof *left);
    if (left == NULL)
        return SS_ENOMEM;
    least_end end;
    ss_slip s = { .power = gsl_stats_tss(f.x, 1, f.n), .n = (double)f.n };
    ss_status st = ss_least_fit(&end, &(least){ .rows = f.n, .unknowns = FITTED, .model = model, .user = &f,
                                                .steps = STEPS, .tol = 1e-8 }, p, left, covariance);
    if (st == SS_OK && end.converged && end.squares <= (1 - EXPLAINED) * s.power) {
        s.left = end.squares;
        s.variance = end.squares / (double)(f.n - FITTED) * ss_colour(left, NULL, f.n, 0);
        fill(&s, &f, p, covariance);
        fill_residual(&s, left, f.n);
        if (s.onset.value >= 0 && s.end.value > s.onset.value && s.end.value <= (double)f.n
            && SIGMAS * s.drop.error <= s.drop.value && SIGMAS * s.k_over_m.error <= s.k_over_m.value) {
            s.onset.value += (double)used.first;
            s.end.value += (double)used.first;
            *out = s;
        }
    }
    free(left);
    return st;
}
