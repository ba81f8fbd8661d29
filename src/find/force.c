/* force.c -- the slips of a force, read from the force itself.
 *
 * Friction has the sign of the slip.  So a force that never changes its sign belongs to motion in one
 * direction: each stick loads it, and each slip is a fall.  A force that changes its sign in every
 * cycle, whose second half mirrors the first, belongs to motion to and fro: it breaks away once after
 * each reversal, and whatever chatters until the next one is of the same slip.
 *
 * Falls need a height (drops.c) that separates them from the noise.  Reversals are counted with a
 * hysteresis of half the level at which the force stays, so that ramps in which nothing breaks away
 * are none. */
#include "find/force.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "find/drops.h"
#include "find/loading.h"
#include "find/reversals.h"
#include "signal/gaps.h"

#define OUTLIERS 0.02           /* part of the samples at either end of the range that may be wrong */
#define SLOWER 1.05             /* factor: less may be made by the sampling of turning points */
#define QUICK 2.0               /* factor by which all rises are slower than falls if there are few */
enum { FEW_RISES = 9 };
#define LEVEL 0.5               /* part of the level that a half-cycle passes */
#define RETREAT 0.05            /* part of the level by which a force that has broken away falls */

/* A quantile of n samples, which are copied. */
static double
quantile(const double *x, size_t n, double part, double *copy)
{
    memcpy(copy, x, n * sizeof *x);
    return gsl_stats_select(copy, 1, n, (size_t)(part * (double)(n - 1)));
}

/* The sign of nearly all samples, 1 or -1; 0: both signs are there. */
static int
one_sign(const double *x, size_t n, double *copy)
{
    return quantile(x, n, OUTLIERS, copy) > 0 ? 1 : quantile(x, n, 1 - OUTLIERS, copy) < 0 ? -1 : 0;
}

/* --- falls ----------------------------------------------------------------------------------- */

static ss_status
set_falls(search *s, const ss_drop *drop, size_t n)
{
    ss_status st = ss_transitions_new(s->out, n);
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        s->out->transition[i].onset = drop[i].t;
        s->out->transition[i].end = drop[i].end;
    }
    return st;
}

/* The time, in samples, that x spends between a quarter and three quarters of the way from one turning point
 * to the next, along lines from sample to sample.  It is the same for a signal that is reversed in time, or
 * upside down. */
static double
passage(const double *x, size_t from, size_t to)
{
    double a = x[from] + 0.25 * (x[to] - x[from]), b = x[to] - 0.25 * (x[to] - x[from]), sum = 0;
    double low = fmin(a, b), high = fmax(a, b);
    for (size_t i = from; i < to; i++) {
        double least = fmin(x[i], x[i + 1]), most = fmax(x[i], x[i + 1]);
        if (most > least)
            sum += fmax(0, fmin(most, high) - fmax(least, low)) / (most - least);
        else
            sum += least > low && least < high;
    }
    return sum;
}

/* 1: falls are quicker than the rises between them, so they are slips; -1: they are slower; 0: neither.  The
 * sign test decides at three standard deviations; if there are few, all must be quicker by a factor. */
static int
compare_falls(const double *x, double rate, const ss_drop *drop, size_t n)
{
    double signs = 0, clear = 0, all = 0;
    for (size_t i = 1; i < n; i++, all++) {
        size_t before = (size_t)(drop[i - 1].end * rate + 0.5), low = (size_t)(drop[i].end * rate + 0.5);
        size_t high = (size_t)(drop[i].t * rate + 0.5);
        double fall = passage(x, high, low), rise = passage(x, before, high);
        signs += (SLOWER * fall < rise) - (fall > SLOWER * rise);
        clear += (QUICK * fall < rise) - (fall > QUICK * rise);
    }
    if (all <= FEW_RISES)
        return (clear == all) - (clear == -all);
    return (signs > 3 * sqrt(all)) - (signs < -3 * sqrt(all));
}

/* Does x stay at its largest or its least value, time and again?  Then falls from above the one or to below
 * the other are not seen. */
static int
is_clipped(const double *x, size_t n)
{
    double top = x[0], bottom = x[0];
    size_t high = 0, low = 0, highs = 0, lows = 0;
    for (size_t i = 1; i < n; i++)
        top = fmax(top, x[i]), bottom = fmin(bottom, x[i]);
    for (size_t i = 0; i < n; i++) {
        high = x[i] >= top ? high + 1 : 0;
        low = x[i] <= bottom ? low + 1 : 0;
        highs += high == CLIPPED;
        lows += low == CLIPPED;
    }
    return highs >= FEW || lows >= FEW;
}

/* Find the falls of x that are higher than the height.  A force that falls slower than it rises is upside
 * down: its sign is that of an offset. */
static ss_status
find_falls(search *s, const double *x, double height, double reload, int named, int *decided)
{
    ss_drop *drop = NULL;
    size_t n = 0;
    double *y = malloc((s->n + 1) * sizeof *y);
    ss_status st = y == NULL ? SS_ENOMEM : ss_drops_find(&drop, &n, x, s->n, s->rate,
                                 &(ss_drop_opts){ height, reload, s->gap, s->n_gaps }, NULL);
    if (st == SS_OK)
        st = ss_drops_without_glitches(y, x, s->n, drop, n);
    int quicker = st != SS_OK ? 0 : s->opts->drop > 0 ? 1 : compare_falls(y, s->rate, drop, n);
    *decided = st == SS_OK && (named || quicker > 0);
    if (*decided && quicker < 0 && !s->has_offset)
        s->has_offset = 1;
    else if (*decided && s->opts->drop == 0 && is_clipped(x, s->n))
        say(s->out, SS_SLIPS, "the force is clipped: it stands still at its largest or least value");
    else if (*decided && quicker <= 0)
        say(s->out, SS_SLIPS, "the force falls no quicker than it rises");
    else if (*decided && (st = set_falls(s, drop, n)) == SS_OK)
        st = ss_loading_find(s, x, drop, n);
    free(y);
    free(drop);
    return st;
}

/* Find the falls of x, which is the signal or its negative, with the height that they have; or the falls of
 * -x, if x is upside down. */
static ss_status
find_typical_falls(search *s, double *x, int *decided)
{
    ss_typical typical;
    int named = s->quantity == QUANTITY_FORCE;
    ss_status st = ss_drops_typical(x, s->n, &typical);
    if (st != SS_OK || typical.height == 0) {
        *decided = st == SS_OK && named;
        if (*decided)
            say(s->out, SS_SLIPS, "the falls of the force have no typical height above its noise");
        return st;
    }
    int had_offset = s->has_offset;
    st = find_falls(s, x, typical.height, typical.height, named, decided);
    if (s->has_offset && !had_offset) {
        for (size_t i = 0; i < s->n; i++)
            x[i] = -x[i];
        return find_typical_falls(s, x, decided);
    }
    if (st == SS_OK && *decided)
        s->out->number[SS_SLIPS].error = 0.5 * fabs((double)typical.more - (double)typical.less);
    return st;
}

/* --- reversals ------------------------------------------------------------------------------- */

/* The level at which the force stays: the median of the samples above half of the largest. */
static double
level_of(const double *x, size_t n, double *copy)
{
    size_t high = 0;
    for (size_t i = 0; i < n; i++)
        copy[i] = fabs(x[i]);
    double half = 0.5 * gsl_stats_select(copy, 1, n, (size_t)((1 - OUTLIERS) * (double)(n - 1)));
    for (size_t i = 0; i < n; i++)
        if (fabs(x[i]) > half)
            copy[high++] = fabs(x[i]);
    return high > 0 ? gsl_stats_select(copy, 1, high, high / 2) : 0;
}

/* From sample i on, the first maximum of x, or minimum where sign is -1, that x leaves by retreat,
 * before end. */
static size_t
break_away(const double *x, int sign, size_t i, size_t end, double retreat)
{
    size_t top = i;
    for (; i < end && sign * x[i] > sign * x[top] - retreat; i++)
        top = sign * x[i] > sign * x[top] ? i : top;
    return top;
}

/* A half-cycle that the record begins in has broken away before.  A half-cycle reaches from where x
 * passes half of the level, to either side of the middle, to where it does so for the last time
 * before the other side: ringing may go farther. */
static ss_status
find_reversals(search *s, const double *x, double level)
{
    ss_features *out = s->out;
    ss_status st = ss_transitions_new(out, s->n / 2 + 1);
    int sign = 0, open = 0;
    size_t last = 0;
    out->n = 0;
    for (size_t i = 0; st == SS_OK && i < s->n; i++) {
        int side = x[i] > LEVEL * level ? 1 : x[i] < -LEVEL * level ? -1 : 0;
        if (side != 0 && side == sign)
            last = i;
        if (side == 0 || side == sign)
            continue;
        if (open)
            out->transition[out->n++].end = (double)last / s->rate;
        size_t at = break_away(x, side, i, s->n, RETREAT * level);
        open = i > 0 && !ss_gaps_near(s->gap, s->n_gaps, (double)at / s->rate, 1 / s->rate);
        out->transition[out->n].onset = (double)at / s->rate;
        sign = side;
        last = i;
    }
    if (open)
        out->transition[out->n++].end = (double)last / s->rate;
    return st;
}

/* --- all of it ------------------------------------------------------------------------------- */

static ss_status
find_by_itself(search *s, double *x, int *decided)
{
    int sign = one_sign(s->x, s->n, x);
    for (size_t i = 0; i < s->n; i++)
        x[i] = sign * s->x[i];
    if (sign != 0)
        return find_typical_falls(s, x, decided);
    if (s->quantity != QUANTITY_FORCE)
        return SS_OK;
    *decided = 1;
    if (isnan(s->cycles.period.value)
        || s->cycles.likeness < CYCLES_LIKE || s->cycles.symmetry > -CYCLES_ALIKE) {
        say(s->out, SS_SLIPS, "the force changes its sign, but not in mirrored half-cycles that repeat");
        return SS_OK;
    }
    double middle = 0.5 * (quantile(s->x, s->n, OUTLIERS, x) + quantile(s->x, s->n, 1 - OUTLIERS, x));
    double *y = malloc(s->n * sizeof *y);
    if (y == NULL)
        return SS_ENOMEM;
    for (size_t i = 0; i < s->n; i++)
        y[i] = s->x[i] - middle;
    ss_status st = find_reversals(s, y, level_of(y, s->n, x));
    if (st == SS_OK)
        st = ss_reversals_measure(s, y);
    free(y);
    return st;
}

ss_status
ss_force_find(search *s, int *decided)
{
    *decided = 0;
    if (s->opts->drop > 0) {
        double height = s->opts->drop / s->largest;
        return find_falls(s, s->x, height, DROPS_RELOAD * height, 1, decided);
    }
    if (s->quantity == QUANTITY_MOTION || s->n < 8)
        return SS_OK;
    double *x = malloc(s->n * sizeof *x);
    ss_status st = x != NULL ? find_by_itself(s, x, decided) : SS_ENOMEM;
    free(x);
    return st;
}
