/* numbers.c -- the list of numbers, and those that follow from an oscillation and a mass, and from force over
 * displacement. */
#include "find/numbers.h"

#include <math.h>
#include <stdlib.h>

/* Those that are found together with the transitions. */
static ss_status
by_search(search *s)
{
    (void)s;
    return SS_OK;
}

#define DECLARATION(NAME, name, unit, about, needs, by) ss_status by(search *s);
SS_FEATURE_NUMBER_LIST(DECLARATION)

#define ROW(NAME, name, unit, about, needs, by) [NAME] = { { name, unit }, about, needs, by },
const feature_number ss_feature_numbers[SS_FEATURE_NUMBERS] = { SS_FEATURE_NUMBER_LIST(ROW) };

unsigned
ss_features_have(const ss_features *f, const ss_features_opts *opts)
{
    return (opts->displacement >= 0 ? WITH_X : 0) | (opts->force >= 0 ? WITH_F : 0)
        | (opts->mass > 0 ? WITH_MASS : 0) | (f->loading != NULL ? OF_FALLS : f->reverses ? OF_EVENTS : 0);
}

ss_status
ss_numbers_find(search *s)
{
    ss_status st = SS_OK;
    for (int k = 0; st == SS_OK && k < SS_FEATURE_NUMBERS; k++)
        st = ss_feature_numbers[k].by(s);
    return st;
}

/* --- by an oscillation and a mass ---------------------------------------------------------------- */

/* With r = hypot(omega, s), the total stiffness is K = m r^2 and the damping c = 2 m s.  Errors follow from those
 * of frequency and damping ratio as if these were independent. */

ss_status
ss_find_stiffness_raw(search *s)
{
    const ss_value f = known(s->out, SS_TRANSITION_FREQUENCY_RAW);
    double r = 2 * M_PI * f.value, total = s->opts->mass * r * r;
    if (s->opts->mass > 0)
        know(s->out, SS_TOTAL_STIFFNESS_RAW, (ss_value){ total, 2 * total * f.error / f.value });
    return SS_OK;
}

/* r from the damped frequency. */
static double
undamped(const search *s)
{
    double z = s->out->number[SS_DAMPING_RATIO].value;
    return 2 * M_PI * s->out->number[SS_TRANSITION_FREQUENCY].value / sqrt(1 - z * z);
}

ss_status
ss_find_stiffness(search *s)
{
    const ss_value f = known(s->out, SS_TRANSITION_FREQUENCY), z = known(s->out, SS_DAMPING_RATIO);
    double r = undamped(s), total = s->opts->mass * r * r;
    if (s->opts->mass > 0)
        know(s->out, SS_TOTAL_STIFFNESS, (ss_value){
             total, total * hypot(2 * f.error / f.value, 2 * z.value * z.error / (1 - z.value * z.value)) });
    return SS_OK;
}

ss_status
ss_find_contact_stiffness(search *s)
{
    const ss_value total = known(s->out, SS_TOTAL_STIFFNESS);
    double k = s->opts->stiffness;
    if (k > 0 && total.value > k)
        know(s->out, SS_CONTACT_STIFFNESS, (ss_value){ total.value - k, total.error });
    return SS_OK;
}

ss_status
ss_find_contact_damping(search *s)
{
    const ss_value f = known(s->out, SS_TRANSITION_FREQUENCY), z = known(s->out, SS_DAMPING_RATIO);
    double m = s->opts->mass, r = undamped(s);
    if (m > 0)
        know(s->out, SS_CONTACT_DAMPING, (ss_value){
             2 * m * r * z.value,
             2 * m * r * hypot(z.value * f.error / f.value, z.error / (1 - z.value * z.value)) });
    return SS_OK;
}

/* --- the slope of force over displacement ------------------------------------------------------ */

/* While the contact sticks, f = K_y x + c v + const.  Least squares of f on x would read K_y too low
 * where x is noisy, as the displacement in the stick is small.  So the signal y that shows the
 * oscillation and its slope serve as instruments, whose noise has nothing to do with that of x: the
 * sums of products of both with f, x and v, each window's means taken off, are two equations for K_y
 * and c.  (Without c, as v is in quadrature with x but for the decay, K_y is too large by an order of the
 * damping ratio squared, .4 % at a ratio of .056.)  v and the slope of y are differences over four
 * samples; by how much K_y moves with differences over two is an error.  So is by how much it moves when the
 * windows are cut at both ends, where a slip may reach into all of them. */
enum { F, X, V, ROUGH_V, OF };  /* what the instruments are multiplied with; ROUGH_V: over two samples */
enum { CUT = 8 };               /* of a window, at either end */
typedef struct sums {
    double by_y[OF], by_slope[OF];
} sums;

static double
slope_at(const double *v)
{
    return (8 * (v[1] - v[-1]) - (v[2] - v[-2])) / 12;
}

/* A window's means are those of samples with two neighbours on either side; slopes are not centred, as the
 * instruments are. */
static sums
sums_over(const double *f, const double *x, const double *y, ss_window span)
{
    sums s = { { 0 }, { 0 } };
    ss_window inner = { span.first + 2, span.end - 2 };
    if (span.end < span.first + 5)
        return s;
    const double n = (double)ss_window_length(inner);
    double f0 = 0, x0 = 0, y0 = 0, d0 = 0;
    for (size_t i = inner.first; i < inner.end; i++) {
        f0 += f[i], x0 += x[i], y0 += y[i];
        d0 += slope_at(y + i) / n;
    }
    f0 /= n, x0 /= n, y0 /= n;
    for (size_t i = inner.first; i < inner.end; i++) {
        const double of[OF] = { f[i] - f0, x[i] - x0, slope_at(x + i), (x[i + 1] - x[i - 1]) / 2 };
        for (int k = 0; k < OF; k++) {
            s.by_y[k] += (y[i] - y0) * of[k];
            s.by_slope[k] += (slope_at(y + i) - d0) * of[k];
        }
    }
    return s;
}

/* K_y by all sums less those of one window; v: which differences. */
static double
stiffness_of(const sums *all, const sums *less, int v)
{
    double y[OF], d[OF];
    for (int k = 0; k < OF; k++) {
        y[k] = all->by_y[k] - less->by_y[k];
        d[k] = all->by_slope[k] - less->by_slope[k];
    }
    return (y[F] * d[v] - d[F] * y[v]) / (y[X] * d[v] - d[X] * y[v]);
}

ss_status
ss_slope_find(const double *f, const double *x, const double *y, const ss_window *span, size_t n,
              ss_value *slope)
{
    const sums none = { { 0 }, { 0 } };
    sums *each = malloc((n + 1) * sizeof *each), all = none, inner = none;
    double mean = 0, scatter = 0, m = (double)n;
    *slope = (ss_value){ NAN, NAN };
    if (each == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < n; i++) {
        size_t off = ss_window_length(span[i]) / CUT;
        const sums cut = sums_over(f, x, y, (ss_window){ span[i].first + off, span[i].end - off });
        each[i] = sums_over(f, x, y, span[i]);
        for (int k = 0; k < OF; k++) {
            all.by_y[k] += each[i].by_y[k], all.by_slope[k] += each[i].by_slope[k];
            inner.by_y[k] += cut.by_y[k], inner.by_slope[k] += cut.by_slope[k];
        }
    }
    for (size_t i = 0; i < n; i++)
        mean += stiffness_of(&all, &each[i], V) / m;
    for (size_t i = 0; i < n; i++)
        scatter += pow(stiffness_of(&all, &each[i], V) - mean, 2);
    double value = stiffness_of(&all, &none, V), rough = stiffness_of(&all, &none, ROUGH_V);
    double moved = stiffness_of(&inner, &none, V) - value;
    double error = hypot(hypot(sqrt(scatter * (m - 1) / m), rough - value), moved);
    if (n >= 2 && isfinite(value) && SIGMAS * error < fabs(value))
        *slope = (ss_value){ fabs(value), error };
    free(each);
    return SS_OK;
}

/* Find the slope over the spans in which oscillations are fitted. */
ss_status
ss_find_contact_slope(search *s)
{
    ss_features *out = s->out;
    const double *values = s->signal->values;
    size_t x = (size_t)s->opts->displacement, f = (size_t)s->opts->force, n = 0;
    ss_value slope = unknown;
    if (s->opts->displacement < 0 || s->opts->force < 0 || isnan(out->number[SS_TRANSITION_FREQUENCY].value))
        return SS_OK;
    if (out->reverses && isfinite(out->number[SS_FRICTION].value))
        return SS_OK;                   /* its loading gives the stiffness */
    ss_window *span = malloc((out->n + 1) * sizeof *span);
    if (span == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < out->n; i++)
        if (!isnan(out->transition[i].from))
            span[n++] = (ss_window){ (size_t)(out->transition[i].from * s->rate + 0.5),
                                   (size_t)(out->transition[i].to * s->rate + 0.5) };
    ss_status st = ss_slope_find(values + f * s->n, values + x * s->n, s->x, span, n, &slope);
    free(span);
    know(out, SS_CONTACT_STIFFNESS_SLOPE, slope);
    return st;
}
