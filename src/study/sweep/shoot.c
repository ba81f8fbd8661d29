/* shoot.c -- a periodic state by Newton's method on the map from one cycle to the next. */
#include "study/sweep/finder.h"

#include <math.h>
#include <string.h>

/* At most so many, of which so many may come no nearer by a quarter.  (At the end of a line of motions,
 * where the root is a double one, each comes nearer by half.) */
enum { NEWTON_STEPS = 20, MOST_IN_VAIN = 6 };
/* The part of a distance by which a motion may miss what the derivative at its limit says. */
#define NONLINEAR 0.3
/* The same for the change of the part that shrinks least: it must go the same way. */
#define SAME_WAY 0.8
/* So near 1, a multiplier says nothing of how a motion is approached, as at the end of a line of
 * motions. */
#define NEUTRAL 1e-6
/* And the part of the first distance that it may be off by, as walks are no more accurate. */
#define MEASURABLE 0.01
enum { REPETITIONS = 4 };

/* --- Newton's method ----------------------------------------------------------------------- */

/* One step, which moves *at, by *t if it is known, else by the derivative there, which *t becomes.
 * *off: the larger of the step and the miss; INFINITY if the step was shortened, unless the miss is
 * rounding. */
static ss_status
newton_step(finder *f, int period, motion *at, int known, tangent *t, double *off)
{
    double unit[D_MOST], from[D_MOST], r[D_MOST], d[D_MOST];
    ss_status st = ss_finder_begin_at(f, at);
    if (st == SS_OK)
        st = known ? ss_finder_go(f, period, NULL, NULL) : ss_finder_derive(f, period, NEWTON, t);
    if (st != SS_OK)
        return st;
    const motion end = f->w.m;
    motion moved = *at;
    double missed = ss_section_distance(f, ss_section_of(&end.now), ss_section_of(&at->now));
    int allowed = 0, halvings = 0;
    ss_finder_coordinates(at, from);
    ss_finder_coordinates(&end, r);
    ss_finder_coordinate_units(f, unit);
    for (int i = 0; i < D_MOST; i++)
        r[i] -= from[i];
    ss_tangent_solve(t, unit, r, d);
    if (end.now.mode == at->now.mode && isfinite(d[0] + d[1] + d[2]))
        for (; !(allowed = ss_finder_move(&moved, d)) && halvings < 8; halvings++) {
            moved = *at;
            for (int i = 0; i < D_MOST; i++)
                d[i] /= 2;
        }
    *off = missed <= ROUNDING ? missed : INFINITY;
    if (allowed && halvings == 0)
        *off = fmax(missed, ss_section_distance(f, ss_section_of(&moved.now), ss_section_of(&at->now)));
    *at = allowed ? moved : end;        /* no step to be had: simulate on */
    ss_motion_rebase(at);
    at->origin = (instant){ 0, 0 };
    return SS_OK;
}

/* --- which motion is approached ------------------------------------------------------------- */

static void
times(const tangent *t, const double d[D_MOST], double out[D_MOST])
{
    for (int i = 0; i < D_MOST; i++) {
        out[i] = 0;
        for (int j = 0; j < D_MOST; j++)
            out[i] += t->d[i][j] * d[j];
    }
}

static double
size_of(const double d[D_MOST])
{
    return fmax(fabs(d[D_REF]), fmax(fabs(d[D_Q]), fabs(d[D_V])));
}

/* What 2^30 repetitions leave of a difference, but for the factor exp(*scale): the part that shrinks
 * least. */
static tangent
slow_part(const tangent *t, double *scale)
{
    tangent power = *t;
    *scale = 0;
    for (int n = 0; n < 30; n++) {
        tangent square = { 0 };
        double size = 0;
        for (int i = 0; i < D_MOST; i++)
            for (int j = 0; j < D_MOST; j++) {
                for (int k = 0; k < D_MOST; k++)
                    square.d[i][j] += power.d[i][k] * power.d[k][j];
                size = fmax(size, fabs(square.d[i][j]));
            }
        *scale = 2 * *scale + log(size);
        for (int i = 0; i < D_MOST * D_MOST && size > 0; i++)
            square.d[i / D_MOST][i % D_MOST] /= size;
        power = square;
    }
    return power;
}

static void
away_from(const motion *centre, const motion *m, const double unit[D_MOST], double d[D_MOST])
{
    double c[D_MOST];
    ss_finder_coordinates(centre, c);
    ss_finder_coordinates(m, d);
    for (int i = 0; i < D_MOST; i++)
        d[i] = (d[i] - c[i]) / unit[i];
}

/* Have they the same coordinates?  Slips in either direction have. */
static int
alike(const motion *a, const motion *b)
{
    return (a->now.mode == 0) == (b->now.mode == 0);
}

/* Whether a difference has become after what the derivative makes of it, once.  Motions that lie
 * side by side are told apart by the part that shrinks least, of which little goes in a cycle: it
 * must shrink as the derivative says. */
static int
goes_as_expected(const tangent *once, const tangent *slow, const double before[D_MOST],
                 const double after[D_MOST], double allowed, double allowed_slow)
{
    double off[D_MOST], change[D_MOST], slow_off[D_MOST], slow_change[D_MOST];
    times(once, before, off);
    for (int i = 0; i < D_MOST; i++) {
        change[i] = off[i] - before[i];
        off[i] = after[i] - off[i];
    }
    times(slow, off, slow_off);
    times(slow, change, slow_change);
    return size_of(off) <= NONLINEAR * size_of(before) + allowed
        && size_of(slow_off) <= SAME_WAY * size_of(slow_change) + allowed_slow;
}

/* Whether the motion from a state goes, in some repetitions of so many cycles, towards the periodic
 * one as its derivative says: otherwise that is another motion than the one which is approached, or
 * none is.  One repetition would not do: a chaotic motion comes near many that it leaves again. */
static ss_status
is_approached(finder *f, const motion *from, const motion *at, const tangent *t, int cycles, int *yes)
{
    double unit[D_MOST], before[D_MOST], after[D_MOST], left[D_MOST], scale, tol = f->opts->tol;
    tangent once = *t;
    ss_status st = ss_finder_begin_at(f, from);
    ss_finder_coordinate_units(f, unit);
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            once.d[i][j] *= unit[j] / unit[i];
    const tangent slow = slow_part(&once, &scale);
    away_from(at, from, unit, before);
    times(&slow, before, left);
    double size = size_of(before), shrinks = 1 - f->multiplier;
    double allowed_slow = shrinks > NEUTRAL ? MEASURABLE * size * shrinks + tol : INFINITY;
    ss_finder_keep(f, size);
    *yes = alike(from, at) && size_of(left) * exp(scale) <= tol;
    for (int n = 0; st == SS_OK && *yes && n < REPETITIONS; n++) {
        st = ss_finder_go(f, cycles, NULL, NULL);
        away_from(at, &f->w.m, unit, after);
        *yes = alike(&f->w.m, at)
            && goes_as_expected(&once, &slow, before, after, MEASURABLE * size + tol, allowed_slow);
        memcpy(before, after, sizeof before);
    }
    ss_finder_keep(f, 0);
    return st;
}

/* Without a closed form a derivative costs as much as three steps.  So close to the limit that of
 * the last step serves the next, unless such steps shrink too little; if it is near 1, they magnify
 * its error. */
#define CLOSE 0.05
#define SHRINKS 0.1

/* Newton's steps until one is within tol, which *found says. */
static ss_status
converge(finder *f, int cycles, motion *at, tangent *t, int *found)
{
    double off = INFINITY, nearest = off, second, angle;
    int serves = 0, is_fine = 0, in_vain = 0;
    ss_status st = SS_OK;
    for (int i = 0; st == SS_OK && !(is_fine && off <= f->opts->tol) && i < NEWTON_STEPS
             && in_vain < MOST_IN_VAIN; i++) {
        double last = off;
        int old = serves;
        is_fine = ss_finder_keep(f, nearest = fmin(nearest, off));
        st = newton_step(f, cycles, at, old, t, &off);
        if (st == SS_OK && !old && (!f->in_closed_form || off <= f->opts->tol))
            st = ss_tangent_multipliers(t, &f->multiplier, &second, &angle);
        in_vain += off > 0.75 * last;
        serves = !f->in_closed_form && off <= CLOSE * (1 - f->multiplier)
            && (!old || off <= SHRINKS * last);
    }
    *found = st == SS_OK && is_fine && off <= f->opts->tol;
    ss_finder_keep(f, 0);
    return st;
}

/* What Newton's method has found misses itself by a part of tol.  Where it is a limit at which a
 * contact only touches, and which the motion approaches from one side, only simulation can tell how
 * many events a cycle has. */
static ss_status
measure(finder *f, const motion *at, int cycles, int *period, ss_steady *out)
{
    double most = 2 * f->opts->tol;
    ss_status st = ss_finder_begin_at(f, at);
    *period = 1;
    if (st == SS_OK && cycles > 1)
        st = ss_finder_return(f, cycles, most, period);
    if (*period == 0 || st != SS_OK)
        return st;
    st = ss_finder_begin_at(f, at);
    if (st == SS_OK)
        st = ss_finder_measure(f, *period, *period, out);
    if (f->missed > most || f->unresolved > 0)
        *period = 0;
    return st;
}

static ss_status
look(finder *f, int approached, int *period, ss_steady *out)
{
    tangent t = { 0 };
    const motion from = f->w.m;
    motion at = from;
    int cycles = *period, wanted;
    *period = 0;
    ss_status st = converge(f, cycles, &at, &t, &wanted);
    if (wanted)
        wanted = f->multiplier <= 1 + (f->in_closed_form ? 1e-9 : 1e-5);
    if (wanted && approached)
        st = is_approached(f, &from, &at, &t, cycles, &wanted);
    return wanted && st == SS_OK ? measure(f, &at, cycles, period, out) : st;
}

ss_status
ss_finder_shoot(finder *f, int approached, int *period, ss_steady *out)
{
    ss_status st = look(f, approached, period, out);
    f->multiplier = 0;
    ss_finder_keep(f, 0);
    if (st != SS_EDATA)
        return st;
    *period = 0;                        /* a step has led to where there are no cycles */
    return SS_OK;
}
