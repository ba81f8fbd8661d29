/* settle.c -- find the periodic state to which a scene settles, by simulation.
 *
 * The states at the starts of cycles are the iterates of a map.  They have period p when they
 * repeat after p cycles.  They approach their limit geometrically, so the rate at which the last
 * differences shrink gives the remaining distance, and a slow approach is not mistaken for the
 * limit.  Shooting may replace the last part of the approach. */
#include "study/sweep/finder.h"

static void
record_section(finder *f)
{
    f->last[f->recorded++ % (SECTIONS)] = ss_section_of(&f->w.m.now);
}

/* The state so many cycles before the last one. */
static section
section_before(const finder *f, int cycles)
{
    return f->last[(f->recorded - 1 - (unsigned long)cycles) % SECTIONS];
}

static int
has_period(const finder *f, int p)
{
    if (f->recorded <= (unsigned long)p)
        return 0;
    double now = ss_section_distance(f, section_before(f, 0), section_before(f, p));
    if (now <= ROUNDING || !(now <= f->opts->tol))
        return now <= ROUNDING;
    if (f->recorded <= 2 * (unsigned long)p)
        return 0;
    double before = ss_section_distance(f, section_before(f, p), section_before(f, 2 * p)), ratio = now / before;
    return ratio < 1 && now * ratio / (1 - ratio) <= f->opts->tol;
}

/* The first period that the motion has; 0 if it has none yet.  A state within tol of its limit is within
 * 2 tol of itself after any multiple of its period.  So the search ends at a p after which the state is
 * near itself, but has not the period p: it may still come to have it. */
static int
find_period(const finder *f)
{
    for (int p = 1; p <= f->opts->max_period; p++) {
        if (has_period(f, p))
            return p;
        if (f->recorded > (unsigned long)p
            && ss_section_distance(f, section_before(f, 0), section_before(f, p)) <= 10 * f->opts->tol)
            return 0;
    }
    return 0;
}

/* Simulate the cycles that the options give.  Then find the period: the number of cycles after which the
 * motion returns to the same state. */
static ss_status
settle_as_asked(finder *f, int *period)
{
    ss_status st = SS_OK;
    for (unsigned long i = 0; st == SS_OK && i < f->opts->settle; i++)
        st = ss_finder_go(f, 1, NULL, NULL);
    const motion here = f->w.m;
    if (st == SS_OK)
        st = ss_finder_return(f, f->opts->max_period, f->opts->tol, period);
    return st == SS_OK ? ss_finder_begin_at(f, &here) : st;
}

/* --- the end of the approach by shooting ------------------------------------------------------- */

/* Newton's method is tried when the motion is this near to a period, in units of its own size, and comes
 * nearer.  It is tried again after twice as many cycles. */
#define NEAR 0.3
enum { FIRST_TRY = 2 };

static int
comes_near(const finder *f, int p)
{
    if (f->recorded <= 2 * (unsigned long)p)
        return 0;
    section now = section_before(f, 0), before = section_before(f, p);
    double difference = ss_section_distance(f, now, before);
    return difference <= NEAR * (1 + ss_section_distance(f, now, (section){ 0 }))
        && difference < ss_section_distance(f, before, section_before(f, 2 * p));
}

/* The first period that it comes near to; 0: none. */
static int
nearest_period(const finder *f)
{
    for (int p = 1; p <= f->opts->max_period; p++)
        if (comes_near(f, p))
            return p;
    return 0;
}

/* A motion that is still coming nearer after all cycles, and has changed by less than this in the last
 * period, crawls.  One without a period changes by about its own size. */
#define CRAWL 1e-4

static int
crawls(const finder *f, int p)
{
    return p > 0 && ss_section_distance(f, section_before(f, 0), section_before(f, p)) <= CRAWL;
}

static ss_status
try_to_shoot(finder *f, which_motion which, int p, ss_steady *out, int *period)
{
    const motion here = f->w.m;
    *period = p;
    ss_status st = ss_finder_shoot(f, which, period, out);
    return st == SS_OK && *period == 0 ? ss_finder_begin_at(f, &here) : st;
}

/* --- either ------------------------------------------------------------------------------------ */

/* Simulate until the period is known.  *measured becomes 1 if shooting has found and measured it. */
static ss_status
settle(finder *f, int may_shoot, int *period, int *measured, ss_steady *out)
{
    ss_status st = SS_OK;
    unsigned long next_try = FIRST_TRY;
    record_section(f);
    for (unsigned long i = 1; st == SS_OK && *period == 0 && i <= f->opts->max_cycles; i++) {
        st = ss_finder_go(f, 1, NULL, NULL);
        record_section(f);
        *period = find_period(f);
        if (!may_shoot || i < next_try || st != SS_OK)
            continue;
        int p = nearest_period(f);
        if (p == 0)
            continue;
        next_try = 2 * i;
        st = try_to_shoot(f, APPROACHED, p, out, period);
        *measured = *period > 0;
    }
    if (st == SS_OK && *period == 0 && may_shoot && crawls(f, nearest_period(f))) {
        st = try_to_shoot(f, CRAWLED_TO, nearest_period(f), out, period);
        *measured = *period > 0;
    }
    return st;
}

ss_status
ss_finder_settle(finder *f, int may_shoot, ss_steady *out)
{
    int period = 0, measured = 0, asked = f->opts->settle > 0;
    ss_status st = asked ? settle_as_asked(f, &period) : settle(f, may_shoot, &period, &measured, out);
    if (st != SS_OK || measured)
        return st;
    double cycles = asked ? (double)f->opts->settle : (double)(f->recorded - 1);
    st = ss_finder_measure(f, period > 0 ? period : f->opts->max_period, period, out);
    if (st == SS_OK && (period > 0 || asked))
        out->value[SS_CYCLES] = cycles;
    return st;
}
