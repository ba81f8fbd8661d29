/* shoot.c -- a periodic state by Newton's method on the map from one cycle to the next. */
#include "study/sweep/finder.h"

#include <math.h>
#include <string.h>

/* There are at most NEWTON_STEPS steps, and at most MOST_IN_VAIN of them may shorten the distance by less
 * than a quarter.  (At the end of a line of motions the root is a double one, and each step halves it.) */
enum { NEWTON_STEPS = 20, MOST_IN_VAIN = 6 };
/* A motion may differ by this part of its distance from what the derivative at its limit predicts. */
#define NONLINEAR 0.3
/* The part that shrinks least may differ by this part of its change: it must change in the same direction. */
#define SAME_WAY 0.8
/* A multiplier this near to 1, as at the end of a line of motions, does not show how a motion is
 * approached. */
#define NEUTRAL 1e-6
/* A difference of this part of the first distance is allowed, since walks are no more accurate. */
#define MEASURABLE 0.01
enum { REPETITIONS = 4 };

/* --- Newton's method ----------------------------------------------------------------------- */

/* Make one step of Newton's method, which moves *at.  The derivative is *t if it is known; else *t becomes
 * the derivative at *at.  *off becomes the larger of the step and of the distance by which the motion
 * misses its start; INFINITY if the step was shortened, unless this distance is rounding. */
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
    *at = allowed ? moved : end;        /* if no step is possible, simulate on */
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

/* The derivative of 2^30 repetitions, divided by exp(*scale): only the part of a difference that shrinks
 * least is left. */
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

/* 1 if two motions have the same coordinates, as slips in either direction do. */
static int
alike(const motion *a, const motion *b)
{
    return (a->now.mode == 0) == (b->now.mode == 0);
}

/* 1 if a difference `before` has become `after` as the derivative of one repetition predicts.  Motions that
 * lie side by side differ in the part that shrinks least, and little of it is lost in a cycle: this part,
 * too, must shrink as predicted. */
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

/* *yes becomes 1 if the motion from a state approaches the periodic motion `at`, in several repetitions of
 * its cycles, as its derivative predicts.  If not, another motion is approached, or none.  One repetition
 * would not suffice: a chaotic motion comes near many periodic ones that it leaves again. */
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

/* *yes becomes 1 if a motion that has crawled for all cycles that it was given crawls to `at`, which must
 * attract: from all the way between the two, neighbours come nearer to it, too, and none passes it.  Their
 * speed may change on the way, as it does far from the limit, by more than is_approached allows. */
static ss_status
crawls_to(finder *f, const motion *from, const motion *at, const tangent *t, int cycles, int *yes)
{
    enum { PLACES = 8 };
    double unit[D_MOST], all[D_MOST], scale;
    tangent once = *t;
    ss_finder_coordinate_units(f, unit);
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            once.d[i][j] *= unit[j] / unit[i];
    const tangent slow = slow_part(&once, &scale);
    away_from(at, from, unit, all);
    ss_status st = SS_OK;
    *yes = alike(from, at) && f->multiplier < 1 - NEUTRAL
        && pow(f->multiplier, (double)f->opts->max_cycles) > f->opts->tol;
    for (int k = 0; st == SS_OK && *yes && k < PLACES; k++) {
        motion here = *from;
        double by[D_MOST], d[D_MOST], before[D_MOST], after[D_MOST], part = 0, whole = 0;
        for (int i = 0; i < D_MOST; i++)
            by[i] = -all[i] * unit[i] * k / PLACES;
        *yes = ss_finder_move(&here, by);
        st = ss_finder_begin_at(f, &here);
        if (st == SS_OK)                /* what shrinks fast is gone after these */
            st = ss_finder_go(f, REPETITIONS * cycles, NULL, NULL);
        away_from(at, &f->w.m, unit, d);
        times(&slow, d, before);
        if (st == SS_OK)
            st = ss_finder_go(f, cycles, NULL, NULL);
        away_from(at, &f->w.m, unit, d);
        times(&slow, d, after);
        for (int i = 0; i < D_MOST; i++) {
            part += before[i] * after[i];
            whole += before[i] * before[i];
        }
        *yes = *yes && alike(&f->w.m, at) && part > 0 && part < whole;
    }
    return st;
}

/* Without a closed form a derivative costs as much as three steps.  When a step is as short as CLOSE, the
 * next one uses the derivative of the last, unless such steps shrink too little (SHRINKS).  Where the
 * multiplier is near 1, the error of the derivative is magnified, so CLOSE is multiplied by the rest. */
#define CLOSE 0.05
#define SHRINKS 0.1

/* Make Newton's steps until one is within tol; *found becomes 1 if there is one. */
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

/* Measure the motion that Newton's method has found, which misses its start by a part of tol.  *period
 * becomes 0 if it cannot be measured: at a limit where a contact only touches, which the motion approaches
 * from one side, only simulation shows how many events a cycle has. */
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
find_periodic(finder *f, which_motion which, int *period, ss_steady *out)
{
    tangent t = { 0 };
    const motion from = f->w.m;
    motion at = from;
    int cycles = *period, wanted;
    *period = 0;
    ss_status st = converge(f, cycles, &at, &t, &wanted);
    if (wanted)
        wanted = f->multiplier <= 1 + (f->in_closed_form ? 1e-9 : 1e-5);
    if (wanted && which == APPROACHED)
        st = is_approached(f, &from, &at, &t, cycles, &wanted);
    else if (wanted && which == CRAWLED_TO)
        st = crawls_to(f, &from, &at, &t, cycles, &wanted);
    return wanted && st == SS_OK ? measure(f, &at, cycles, period, out) : st;
}

ss_status
ss_finder_shoot(finder *f, which_motion which, int *period, ss_steady *out)
{
    ss_status st = find_periodic(f, which, period, out);
    f->multiplier = 0;
    ss_finder_keep(f, 0);
    if (st != SS_EDATA)
        return st;
    *period = 0;                        /* a step has led to a state without cycles */
    return SS_OK;
}
