/* slip.c -- the slip of a pulled slider, seen in the force of its spring, and whether a fall is one.
 *
 * A slider of mass m is held by friction up to f_s and braked by f_k while it slips.  A spring of
 * stiffness k, whose end moves at U, pulls it.  The force s of the spring rises at s' = k U in the
 * stick.  In the slip, with w = sqrt(k/m), s'' + 2 z w s' + w^2 (s - f_k) = 0, where z is the rig's damping
 * ratio, or the share of friction that grows with speed.  It begins at s = f_s with s' = k U, and ends when
 * s' is k U again.  The slip and the loadings on either side of it are fitted to the samples by least
 * squares.  The fit varies the onset, f_s, f_k, w and z.  Simpler readings err: noise and the momentum of
 * the drive raise the largest sample above f_s, a line that is followed to within the noise goes on into
 * the slip, and without damping f_k is the middle between the ends of the slip.
 *
 * The residual of a measured slip is not white, so errors count fewer samples (medians.c). */
#include "find/slip.h"

#include <float.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/least.h"
#include "find/medians.h"
#include "find/judgement.h"

enum { ONSET, TOP, MIDDLE, SPEED, DAMPING, FITTED };    /* onset behind the first sample used; SPEED: w */
#define DEEP 0.8                /* part of D: 10 and 90 % of the fall lie at f_k +- so much */

typedef struct fall {
    const double *x;            /* n samples */
    size_t n;
    double loading;
} fall;

/* In the slip the force is middle + exp(-decay u) (D cos(speed u) + B sin(speed u)), and its slope is
 * exp(-decay u) (loading cos(speed u) - C sin(speed u)). */
typedef struct motion {
    double top, middle, loading, speed, decay, D, B, C;
    double length, low;         /* of the slip; the force at its end */
} motion;

static double
force_at(const motion *m, double u)
{
    if (u < 0)
        return m->top + m->loading * u;
    if (u > m->length)
        return m->low + m->loading * (u - m->length);
    return m->middle + exp(-m->decay * u) * (m->D * cos(m->speed * u) + m->B * sin(m->speed * u));
}

static double
slope_at(const motion *m, double u)
{
    return exp(-m->decay * u) * (m->loading * cos(m->speed * u) - m->C * sin(m->speed * u));
}

/* The time between `from` and `to` at which f of the motion passes a level. */
static double
passes(double (*f)(const motion *m, double u), const motion *m, double level, double from, double to)
{
    int rises = f(m, to) > f(m, from);
    while (to - from > 4 * DBL_EPSILON * to) {
        double mid = 0.5 * (from + to);
        if ((f(m, mid) < level) == rises)
            from = mid;
        else
            to = mid;
    }
    return to;
}

/* Returns 0 if a slip with these parameters never ends: the slider goes on at the speed of the drive. */
static int
motion_of(motion *m, const double p[FITTED], double loading)
{
    double w = p[SPEED], D = p[TOP] - p[MIDDLE], decay = p[DAMPING] * w, speed = w * sqrt(1 - pow(p[DAMPING], 2));
    double B = (loading + decay * D) / speed, C = D * speed + decay * B;
    *m = (motion){ p[TOP], p[MIDDLE], loading, speed, decay, D, B, C, INFINITY, 0 };
    if (!(w > 0 && D > 0))
        return 0;
    double steep = (2 * M_PI - atan(decay / speed) - atan2(C, loading)) / speed, turn = M_PI / speed;
    if (!(steep > turn && slope_at(m, steep) > loading))
        return 0;
    double length = passes(slope_at, m, loading, turn, steep);
    m->low = force_at(m, length);
    m->length = length;
    return 1;
}

/* The force of the model less the samples. */
static ss_status
model(const double *p, double *residual, double *slopes, void *user)
{
    const fall *f = user;
    motion m;
    (void)slopes;
    if (!motion_of(&m, p, f->loading))
        return SS_EDATA;
    for (size_t i = 0; i < f->n; i++)
        residual[i] = force_at(&m, (double)i - p[ONSET]) - f->x[i];
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
    double w = (acos(-DEEP) - acos(DEEP)) / (to - from), reach = 3 * M_PI / 2 / w;
    ss_window used = { (size_t)fmax((double)room.first, centre - reach),
                       (size_t)fmin((double)room.end, centre + reach + 1) };
    memcpy(p, (double[FITTED]){ centre - M_PI / 2 / w - (double)used.first, middle + half, middle, w, p[DAMPING] },
           FITTED * sizeof *p);
    return used;
}

/* --- the numbers ----------------------------------------------------------------------------- */

static void
numbers_of(const double p[FITTED], double loading, double number[SLIP_NUMBERS])
{
    motion m;
    if (!motion_of(&m, p, loading)) {
        for (size_t k = 0; k < SLIP_NUMBERS; k++)
            number[k] = NAN;
        return;
    }
    double highest = atan2(loading, m.C) / m.speed, lowest = highest + M_PI / m.speed;
    double middle = 0.5 * (m.top + m.low), reach = DEEP * (m.top - middle);
    double duration = passes(force_at, &m, middle - reach, highest, lowest)
        - passes(force_at, &m, middle + reach, highest, lowest);
    memcpy(number, (double[SLIP_NUMBERS]){ p[ONSET], p[ONSET] + m.length, m.top - m.low, duration, p[TOP],
                                           p[MIDDLE], p[SPEED] * p[SPEED] }, SLIP_NUMBERS * sizeof *number);
}

/* Fill in the numbers, their errors by the covariance of the parameters for samples of variance 1, and, where
 * damping is free, how they change with it. */
static void
fill(ss_slip *s, const fall *f, const double p[FITTED], const double step[FITTED], const double *covariance)
{
    ss_value *const to[SLIP_NUMBERS] = { &s->onset, &s->end, &s->drop, &s->duration, &s->top, &s->middle,
                                         &s->k_over_m };
    const double *with = covariance + DAMPING * FITTED, of_damping = with[DAMPING];
    double value[SLIP_NUMBERS], moved[FITTED][SLIP_NUMBERS], other[FITTED];
    numbers_of(p, f->loading, value);
    for (size_t k = 0; k < FITTED; k++) {
        memcpy(other, p, sizeof other);
        other[k] += step[k];
        numbers_of(other, f->loading, moved[k]);
    }
    for (size_t i = 0; i < SLIP_NUMBERS; i++) {
        double variance = 0, shift = 0;
        for (size_t k = 0; k < FITTED; k++) {
            double slope = (moved[k][i] - value[i]) / step[k];
            shift += slope * with[k];
            for (size_t l = 0; l < FITTED; l++)
                variance += covariance[k * FITTED + l] * slope * (moved[l][i] - value[i]) / step[l];
        }
        *to[i] = (ss_value){ value[i], sqrt(s->variance * fmax(variance, 0)) };
        s->shift[i] = of_damping > 0 ? shift / of_damping : 0;
    }
    s->damping = (ss_value){ p[DAMPING], sqrt(s->variance * of_damping) };
}

ss_status
ss_slip_fit(ss_slip *out, const double *x, ss_window room, size_t high, size_t low, double loading,
            ss_range damping)
{
    const ss_value none = { NAN, NAN };
    const ss_range any = { -INFINITY, INFINITY }, range[] = { any, any, any, any, damping };
    double p[FITTED] = { [DAMPING] = 0.5 * (damping.from + damping.to) }, covariance[FITTED * FITTED];
    *out = (ss_slip){ none, none, none, none, none, none, none, none, { 0 }, NAN, NAN, 0, NAN, { 0 } };
    if (!(loading > 0) || low < high + FEWEST)
        return SS_OK;
    ss_window used = start(p, x, room, high, low);
    fall f = { x + used.first, ss_window_length(used), loading };
    if (f.n < FEWEST)
        return SS_OK;
    const double D = p[TOP] - p[MIDDLE], w = p[SPEED];
    const double step[FITTED] = { PRECISION / w, PRECISION * D, PRECISION * D, PRECISION * w, PRECISION };
    double *left = malloc(f.n * sizeof *left);
    if (left == NULL)
        return SS_ENOMEM;
    least_end end;
    ss_slip s = { .power = gsl_stats_tss(f.x, 1, f.n), .n = (double)f.n };
    ss_status st = ss_least_fit(&end, &(least){ .rows = f.n, .unknowns = FITTED, .model = model, .user = &f,
                                                .range = range, .difference = step, .tol = 1e-8 },
                               p, left, covariance);
    if (st == SS_OK && end.converged && end.squares <= (1 - SLIP_EXPLAINED) * s.power) {
        s.left = end.squares;
        s.variance = end.squares / (double)(f.n - FITTED) * ss_colour(left, NULL, f.n, 0);
        fill(&s, &f, p, step, covariance);
        double samples[SLIP_PARTS] = { 0 };
        for (size_t i = 0; i < f.n; i++) {      /* left: model less sample */
            double part = SLIP_PARTS * (((double)i - s.onset.value) / (s.end.value - s.onset.value) + 1) / 3;
            if (!(part >= 0 && part < SLIP_PARTS))
                continue;
            s.residual[(size_t)part] -= left[i];
            samples[(size_t)part]++;
        }
        for (size_t k = 0; k < SLIP_PARTS; k++)
            s.residual[k] /= samples[k] * s.drop.value;
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

/* --- slip of a mass or relaxation without one ------------------------------------------------- */

/* A mass accelerates and comes to rest, so the force of its spring begins and ends to fall without a
 * corner.  What has no mass falls with a corner at either end, along a line (a saw-tooth generator, a
 * switch behind a filter) or quickest at first (a discharge through a resistor).  Both are fitted to the
 * same samples, between loadings whose slopes are free on either side, as neither a stick nor a charge
 * need be straight:
 *
 *     slip          p(v) = (1 - cos((pi + 2 a) v - a) / cos a) / 2,  tan a = k U / (D w) as above,
 *     relaxation    p(v) = v + b v (1 - v),  0 <= b < 1,
 *
 * where v goes from 0 to 1 between the corners and p is the part of the fall that is behind it.  The
 * relaxation has one parameter more, so that it wins where the samples cannot tell. */
enum { FROM, TO, HIGH, LOW, BEFORE, BEHIND, BEND, PARAMETERS };
enum { MOST = 256 };                    /* samples: more are averaged */

typedef struct pattern {
    size_t n;
    double u[MOST], y[MOST];    /* time and force over the length and the drop of the slip, from its onset */
    double lead;                /* a */
    int relaxes;
} pattern;

static ss_status
both_models(const double *p, double *residual, double *slopes, void *user)
{
    const pattern *f = user;
    (void)slopes;
    for (size_t i = 0; i < f->n; i++) {
        double u = f->u[i], v = (u - p[FROM]) / (p[TO] - p[FROM]);
        if (u <= p[FROM])
            residual[i] = p[HIGH] + p[BEFORE] * (u - p[FROM]) - f->y[i];
        else if (u >= p[TO])
            residual[i] = p[LOW] + p[BEHIND] * (u - p[TO]) - f->y[i];
        else {
            double fallen = f->relaxes ? v + p[BEND] * v * (1 - v)
                : 0.5 * (1 - cos((M_PI + 2 * f->lead) * v - f->lead) / cos(f->lead));
            residual[i] = p[HIGH] - (p[HIGH] - p[LOW]) * fallen - f->y[i];
        }
    }
    return p[TO] > p[FROM] ? SS_OK : SS_EDATA;
}

ss_status
ss_inertia_sign(int *sign, const double *x, ss_window room, const ss_slip *slip, double loading)
{
    const ss_range any = { -INFINITY, INFINITY };
    const ss_range range[PARAMETERS] = { any, any, any, any, any, any, { 0, 1 } };
    double step[PARAMETERS], left[2];
    double onset = slip->onset.value, length = slip->end.value - onset, drop = slip->drop.value;
    double slope = loading * length / drop;
    for (size_t i = 0; i < PARAMETERS; i++)
        step[i] = PRECISION;
    pattern f = { .lead = atan(loading / ((slip->top.value - slip->middle.value) * sqrt(slip->k_over_m.value))) };
    /* from half a slip before it to half a slip behind it */
    size_t first = (size_t)fmax((double)room.first, onset - length / 2);
    size_t end = (size_t)fmin((double)room.end, slip->end.value + length / 2 + 1), each = (end - first) / MOST + 1;
    f.n = (end - first) / each;
    for (size_t i = 0; i < f.n; i++) {
        double mean = 0;
        for (size_t k = first + i * each; k < first + (i + 1) * each; k++)
            mean += x[k] / (double)each;
        f.u[i] = ((double)(first + i * each) + 0.5 * (double)(each - 1) - onset) / length;
        f.y[i] = (mean - slip->top.value) / drop;
    }
    *sign = 0;
    if (f.n <= PARAMETERS)
        return SS_OK;
    for (f.relaxes = 0; f.relaxes < 2; f.relaxes++) {
        double corner = f.relaxes ? 0.25 : 0;   /* the corners of a relaxation lie inside the slip's */
        double p[PARAMETERS] = { corner, 1 - corner, 0, -1, slope, slope, 0.5 };
        least_end ended;
        ss_status st = ss_least_fit(&ended, &(least){ .rows = f.n, .unknowns = f.relaxes ? PARAMETERS : BEND,
                                                      .model = both_models, .user = &f, .range = range,
                                                      .difference = step, .tol = 1e-6 },
                                    p, NULL, NULL);
        if (st != SS_OK)
            return st;
        left[f.relaxes] = ended.squares;
    }
    *sign = (left[0] < left[1]) - (left[0] > left[1]);
    return SS_OK;
}
