/* force.c -- the slips of a force, read from the force itself.
 *
 * Friction has the sign of the slip.  So a force that never changes its sign belongs to motion in one
 * direction: each stick loads it, and each slip is a fall.  A force that changes its sign in every
 * cycle, whose second half mirrors the first, belongs to motion to and fro: it breaks away once after
 * each reversal, and whatever chatters until the next one is of the same slip.  Any other force of both signs
 * has an offset, or dips below zero in its slips: it is read by its falls, if they are clearly quicker than its
 * rises.
 *
 * Falls need a height (drops.c) that separates them from the noise.  Reversals are counted with a
 * hysteresis of half the level at which the force stays, so that ramps in which nothing breaks away
 * are none. */
#include "find/search.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "find/medians.h"
#include "signal/gaps.h"

#define SLOWER 1.05             /* factor: less may be made by the sampling of turning points */

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

/* 1: falls are quicker than the rises between them by a factor, so they are slips; -1: slower; 0: neither.
 * The sign test decides at three standard deviations; if there are few, all must be quicker by TWICE. */
static int
compare_falls(const double *x, const ss_drop *drop, size_t n, double factor)
{
    double signs = 0, clear = 0, all = 0;
    for (size_t i = 1; i < n; i++, all++) {
        double fall = passage(x, drop[i].high, drop[i].low), rise = passage(x, drop[i - 1].low, drop[i].high);
        signs += (factor * fall < rise) - (fall > factor * rise);
        clear += (TWICE * fall < rise) - (fall > TWICE * rise);
    }
    if (all <= SIGMAS * SIGMAS)         /* the test cannot decide */
        return (clear == all) - (clear == -all);
    return (signs > SIGMAS * sqrt(all)) - (signs < -SIGMAS * sqrt(all));
}

/* Does x stay at its largest or its least value, time and again?  Then falls from above the one or to below
 * the other are not seen. */
static int
is_clipped(const double *x, size_t n)
{
    double top, bottom;
    size_t high = 0, low = 0, highs = 0, lows = 0;
    gsl_stats_minmax(&bottom, &top, x, 1, n);
    for (size_t i = 0; i < n; i++) {
        high = x[i] >= top ? high + 1 : 0;
        low = x[i] <= bottom ? low + 1 : 0;
        highs += high == FEWEST;
        lows += low == FEWEST;
    }
    return highs >= FEW || lows >= FEW;
}

/* Find the falls of x, which is the signal or its negative: those by the height that is asked for, or else by the
 * height that falls have.  Where they are slower than the rises, x is upside down, as its sign is that of an
 * offset: then it is turned, once.  So is a force of both signs.  A column of unknown quantity
 * is a force only if its falls are quicker. */
static ss_status
find_falls(search *s, double *x, int *decided)
{
    const double asked = s->opts->drop / s->largest;
    const int named = asked > 0 || s->quantity == QUANTITY_FORCE;
    double *y = malloc((s->n + 1) * sizeof *y);
    ss_drop *drop = NULL;
    ss_typical typical = { asked, 0, 0 };
    size_t n = 0;
    const int has_both = s->has_offset;
    int quicker = !has_both, is_turned = 0;
    ss_status st = y != NULL ? SS_OK : SS_ENOMEM;
    for (;;) {
        if (st == SS_OK && asked == 0)
            st = ss_drops_typical(x, s->n, &typical);
        if (st != SS_OK || typical.height == 0)
            break;
        double reload = asked > 0 ? DROPS_RELOAD * asked : typical.height;
        free(drop);
        drop = NULL;
        st = ss_drops_find(&drop, &n, x, s->n, typical.height, reload);
        size_t kept = 0;
        for (size_t i = 0; st == SS_OK && i < n; i++) {         /* those that no gap cuts */
            double t = (double)drop[i].high / s->rate, end = (double)drop[i].low / s->rate;
            if (!ss_gaps_near(s->gap, s->n_gaps, 0.5 * (t + end), 0.5 * (end - t)))
                drop[kept++] = drop[i];
        }
        n = kept;
        if (st == SS_OK)
            st = ss_drops_without_glitches(y, x, s->n, drop, n);
        if (st == SS_OK && asked == 0)
            quicker = compare_falls(y, drop, n, has_both ? TWICE : SLOWER);
        if (st != SS_OK || quicker >= 0 || !named || is_turned)
            break;
        is_turned = 1;
        s->has_offset = -1;
        for (size_t i = 0; i < s->n; i++)
            x[i] = -x[i];
    }
    *decided = st == SS_OK && (named || (typical.height > 0 && quicker > 0));
    if (*decided && has_both && quicker <= 0)
        say(s->out, SS_SLIPS,
            "the force changes its sign, but neither in mirrored half-cycles that repeat nor in quick falls");
    else if (*decided && typical.height == 0)
        say(s->out, SS_SLIPS, "the falls of the force have no typical height above its noise");
    else if (*decided) {
        if (asked == 0 && is_clipped(x, s->n))
            say(s->out, SS_SLIPS, "the force is clipped: it stands still at its largest or least value");
        else if (quicker <= 0)
            say(s->out, SS_SLIPS, "the force falls no quicker than it rises");
        else
            st = ss_loading_find(s, y, drop, n);
        if (asked == 0)
            s->out->number[SS_SLIPS].error = 0.5 * fabs((double)typical.more - (double)typical.less);
    }
    free(y);
    free(drop);
    return st;
}

ss_status
ss_force_find(search *s, int *decided)
{
    *decided = 0;
    if (s->opts->drop == 0 && (s->quantity >= QUANTITY_DISPLACEMENT || s->n < 8))
        return SS_OK;
    double *x = malloc(s->n * sizeof *x);
    if (x == NULL)
        return SS_ENOMEM;
    /* the sign of nearly all samples; 0: both signs are there */
    const ss_window all = { 0, s->n };
    double low = ss_quantile(s->x, all, OUTLIERS, x), high = ss_quantile(s->x, all, 1 - OUTLIERS, x);
    double sign = s->opts->drop > 0 || low > 0 ? 1 : high < 0 ? -1 : 0;
    ss_status st = SS_OK;
    for (size_t i = 0; i < s->n; i++)
        x[i] = sign != 0 ? sign * s->x[i] : s->x[i] - 0.5 * (low + high);
    int is_force = s->quantity == QUANTITY_FORCE, is_mirrored = isfinite(s->cycles.period.value)
        && s->cycles.likeness >= CYCLES_LIKE && s->cycles.symmetry <= -CYCLES_ALIKE;
    *decided = sign == 0 && is_force && is_mirrored;
    s->has_offset = sign == 0;
    if (*decided)
        st = ss_reversals_find(s, x);
    else if (sign != 0 || is_force)
        st = find_falls(s, x, decided);
    free(x);
    return st;
}
