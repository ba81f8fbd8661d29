/* period.c -- a period that begins where the finder stands: its derivative by that state, and its measures.
 *
 * The derivative comes from the closed form and the saltation matrices of events (tangent.c); where there
 * is no closed form, from walks of neighbouring states. */
#include "study/sweep/finder.h"

#include <math.h>

/* --- the derivative ------------------------------------------------------------------------ */

int
ss_finder_move(motion *m, const double d[D_MOST])
{
    ss_motion_rebase(m);
    return m->now.model->variation->move(&m->now, d);
}

void
ss_finder_coordinates(const motion *m, double c[D_MOST])
{
    motion here = *m;
    ss_motion_rebase(&here);
    c[D_REF] = here.now.model->dim > 2 ? here.now.q[2] : here.now.x_ref;
    c[D_Q] = here.now.q[0];
    c[D_V] = here.now.q[1];
}

void
ss_finder_coordinate_units(const finder *f, double unit[D_MOST])
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
    if (!ss_finder_move(&moved, d)) {
        moved = *start;
        *by = d[coordinate] = -*by;
        if (!ss_finder_move(&moved, d))
            *by = NAN;
    }
    int mode = f->w.m.now.mode;
    ss_status st = ss_finder_begin_at(f, &moved);
    if (st == SS_OK)
        st = ss_finder_go(f, cycles, NULL, NULL);
    ss_finder_coordinates(&f->w.m, end);
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
    ss_finder_coordinates(&end, centre);
    ss_finder_coordinate_units(f, unit);
    if (start.now.model->memory != NULL && start.now.model->dim < D_MOST && start.now.mode == 0) {
        unit[D_Q] = f->unit.y;          /* q is the deflection of a contact, which may be small beside x */
        unit[D_V] = f->unit.y * sqrt(start.now.k / f->scene->mass);
    }
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
    if (f->autonomous)
        ss_tangent_on_onset(t, &f->w.m.now);
    return ss_finder_go(f, cycles, NULL, t);
}

/* --- measures ------------------------------------------------------------------------------ */

/* A multiplier that rounding, or what tolerance leaves of a difference, may have made is no multiplier. */
static double
exponent_of(const finder *f, double multiplier, double time)
{
    return multiplier > (f->in_closed_form ? 1e-10 : 1e-6) ? log(multiplier) / time : NAN;
}

static ss_status
find_multipliers(finder *f, const motion *start, int period, ss_steady *out)
{
    tangent t;
    ss_status st = ss_finder_begin_at(f, start);
    if (st == SS_OK)
        st = ss_finder_derive(f, period, MULTIPLIERS, &t);
    if (st == SS_OK)
        st = ss_tangent_multipliers(&t, &out->value[SS_FLOQUET], &out->value[SS_FLOQUET_2],
                                    &out->value[SS_FLOQUET_ANGLE]);
    out->value[SS_LYAPUNOV] = exponent_of(f, out->value[SS_FLOQUET], period * out->value[SS_CYCLE_TIME]);
    out->value[SS_LYAPUNOV_ERROR] = 0;
    return st;
}

static ss_status
find_exponent(finder *f, const motion *start, ss_steady *out)
{
    const ss_steady_opts *o = f->opts;
    ss_status st = ss_finder_begin_at(f, start);
    return st != SS_OK ? st : ss_finder_exponent(f, o->settle > 0 ? o->settle : o->max_cycles,
                                                 &out->value[SS_LYAPUNOV], &out->value[SS_LYAPUNOV_ERROR]);
}

static ss_status
record_strobes(finder *f, const motion *start, int cycles, ss_steady *out)
{
    ss_status st = ss_finder_begin_at(f, start);
    for (int i = 0; st == SS_OK && i < cycles; i++) {
        section at = ss_section_of(&f->w.m.now);
        out->strobe[out->n_strobes++] = (ss_strobe){ at.x, at.v + f->scene->surface_velocity };
        st = ss_finder_go(f, 1, NULL, NULL);
    }
    return st;
}

ss_status
ss_finder_measure(finder *f, int cycles, int period, ss_steady *out)
{
    meter r;
    const motion start = f->w.m;
    section at = ss_section_of(&start.now);
    ss_meter_begin(&r, f->opts->measures, &start.now);
    ss_status st = SS_OK;
    if (f->opts->measures & MODEL_ERRORS) {
        st = ss_course_begin(&f->course, cycles, 1 / f->scene->base_frequency);
        r.course = &f->course;
    }
    if (st == SS_OK)
        st = ss_finder_go(f, cycles, &r, NULL);
    if (st != SS_OK)
        return st;
    f->unresolved = ss_motion_unresolved(&f->w.m) - ss_motion_unresolved(&start);
    ss_meter_end(&r, cycles, period > 0, out->value);
    out->value[SS_PERIOD] = period;
    out->value[SS_X_PHASE] = at.x;
    out->value[SS_V_PHASE] = at.v + f->scene->surface_velocity;
    if (period > 0 && (f->opts->measures & (FLOQUET | LYAPUNOV)))
        st = find_multipliers(f, &start, period, out);
    else if (f->opts->measures & LYAPUNOV)
        st = find_exponent(f, &start, out);
    out->n_strobes = 0;
    if (st == SS_OK && f->opts->strobe > 0)
        st = record_strobes(f, &start, period > 0 ? period : f->opts->strobe, out);
    return st;
}
