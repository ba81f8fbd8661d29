/* shoot.c -- a periodic state by Newton's method on the map from one forcing cycle to the next.
 *
 * Its derivative comes from the closed form and the saltation matrices of events (tangent.c); where there
 * is no closed form, from walks of neighbouring states. */
#include "study/sweep/finder.h"

#include <float.h>
#include <math.h>

enum { NEWTON_STEPS = 20 };

/* --- the derivative ------------------------------------------------------------------------ */

/* Move a state by d; 0 if its mode does not allow that. */
static int
move(motion *m, const double d[D_MOST])
{
    ss_motion_rebase(m);
    return m->now.model->variation->move(&m->now, d);
}

/* What move changes, where a cycle begins or ends. */
static void
coordinates(const motion *m, double c[D_MOST])
{
    motion here = *m;
    ss_motion_rebase(&here);
    c[D_REF] = here.now.model->dim > 2 ? here.now.q[2] : here.now.x_ref;
    c[D_Q] = here.now.q[0];
    c[D_V] = here.now.q[1];
}

static void
coordinate_units(const finder *f, double unit[D_MOST])
{
    unit[D_REF] = f->w.m.now.model->dim > 2 ? f->unit.y : f->unit.x;
    unit[D_Q] = f->unit.x;
    unit[D_V] = f->unit.v;
}

/* Where so many cycles lead from a state that is moved by `by` along one coordinate, on the other side
 * if its mode forbids this one; *by becomes what it was moved.  An end in another mode is NaN. */
static ss_status
neighbour(finder *f, const motion *start, int cycles, int coordinate, double *by, double end[D_MOST])
{
    motion moved = *start;
    double d[D_MOST] = { 0 };
    d[coordinate] = *by;
    if (!move(&moved, d)) {
        moved = *start;
        *by = d[coordinate] = -*by;
        if (!move(&moved, d))
            *by = NAN;
    }
    int mode = f->w.m.now.mode;
    ss_status st = ss_finder_begin_at(f, &moved);
    if (st == SS_OK)
        st = ss_finder_go(f, cycles, NULL, NULL);
    coordinates(&f->w.m, end);
    if (f->w.m.now.mode != mode)
        *by = NAN;
    return st;
}

static ss_status
differences(finder *f, int cycles, derivative_use use, tangent *t)
{
    /* in units of each coordinate: the error of a one-sided difference is the size, that of a central
     * one its square, and what tolerance leaves of a walk is divided by it */
    const double size = use == MULTIPLIERS ? 1e-4 : 1e-6;
    const motion start = f->w.m;
    double unit[D_MOST], centre[D_MOST];
    int is_free[D_MOST];
    ss_status st = ss_finder_go(f, cycles, NULL, NULL);
    const motion end = f->w.m;
    coordinates(&end, centre);
    coordinate_units(f, unit);
    start.now.model->variation->free(&start.now, is_free);
    *t = (tangent){ 0 };
    for (int j = 0; st == SS_OK && j < D_MOST; j++) {
        double up[D_MOST], by = size * unit[j], down[D_MOST], back = 0;
        if (!is_free[j])
            continue;
        st = neighbour(f, &start, cycles, j, &by, up);
        for (int i = 0; i < D_MOST; i++)
            down[i] = centre[i];
        if (st == SS_OK && use == MULTIPLIERS) {
            back = -size * unit[j];
            st = neighbour(f, &start, cycles, j, &back, down);
        }
        for (int i = 0; i < D_MOST; i++)
            t->d[i][j] = (up[i] - down[i]) / (by - back);
    }
    return st == SS_OK ? ss_finder_begin_at(f, &end) : st;
}

ss_status
ss_finder_derive(finder *f, int cycles, derivative_use use, tangent *t)
{
    if (!f->in_closed_form)
        return differences(f, cycles, use, t);
    ss_tangent_begin(t, &f->w.m.now);
    return ss_finder_go(f, cycles, NULL, t);
}

/* --- Newton's method ----------------------------------------------------------------------- */

/* One step, which moves *at.  *off: the larger of the step and the miss; INFINITY if the step was
 * shortened, unless the miss is rounding. */
static ss_status
newton_step(finder *f, int period, motion *at, tangent *t, double *off)
{
    double unit[D_MOST], from[D_MOST], r[D_MOST], d[D_MOST];
    ss_status st = ss_finder_begin_at(f, at);
    if (st == SS_OK)
        st = ss_finder_derive(f, period, NEWTON, t);
    if (st != SS_OK)
        return st;
    const motion end = f->w.m;
    motion moved = *at;
    double missed = ss_section_distance(f, ss_section_of(&end.now), ss_section_of(&at->now));
    int allowed = 0, halvings = 0;
    coordinates(at, from);
    coordinates(&end, r);
    coordinate_units(f, unit);
    for (int i = 0; i < D_MOST; i++)
        r[i] -= from[i];
    ss_tangent_solve(t, unit, r, d);
    if (end.now.mode == at->now.mode && isfinite(d[0] + d[1] + d[2]))
        for (; !(allowed = move(&moved, d)) && halvings < 8; halvings++) {
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

/* The first multiple of a cycle after which the present state returns to itself, `most` at most; 0 if
 * it does not.  Newton's method has left a part of the tolerance. */
static ss_status
first_return(finder *f, int most, int *period)
{
    const section at = ss_section_of(&f->w.m.now);
    ss_status st = SS_OK;
    *period = 0;
    for (int p = 1; st == SS_OK && *period == 0 && p <= most; p++) {
        st = ss_finder_go(f, 1, NULL, NULL);
        if (ss_section_distance(f, ss_section_of(&f->w.m.now), at) <= 2 * f->opts->tol)
            *period = p;
    }
    return st;
}

ss_status
ss_finder_shoot(finder *f, int *period, ss_steady *out, section *at)
{
    tangent t;
    double off = INFINITY, first, second, angle;
    motion here = f->w.m;
    ss_status st = SS_OK;
    for (int i = 0; st == SS_OK && off > f->opts->tol && i < NEWTON_STEPS; i++)
        st = newton_step(f, *period, &here, &t, &off);
    if (st == SS_OK && off <= f->opts->tol)
        st = ss_tangent_multipliers(&t, &first, &second, &angle);
    if (st != SS_OK || off > f->opts->tol || !(first <= 1 + (f->in_closed_form ? 1e-9 : 1e-5))) {
        *period = 0;
        return st;
    }
    *at = ss_section_of(&here.now);
    st = ss_finder_begin_at(f, &here);
    if (st == SS_OK)
        st = first_return(f, *period, period);
    if (st == SS_OK)
        st = ss_finder_begin_at(f, &here);
    return st == SS_OK && *period > 0 ? ss_finder_measure(f, *period, *period, out) : st;
}
