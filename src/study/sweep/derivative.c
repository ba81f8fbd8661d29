/* derivative.c -- the derivative of the state after cycles with respect to the state before them.
 *
 * It is computed by the engine and the saltation matrices of events (tangent.c); if the engine
 * cannot, from walks that start at neighbouring states.  Without forcing and with true sticks it
 * is 0: a stick lasts until the pull has raised the force to f_s, and this happens at the same x -
 * U t wherever the stick began. */
#include "study/sweep/finder.h"

#include <math.h>

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

/* Go on for so many cycles from a state that is moved by *by along one coordinate, or by -*by if its mode
 * forbids that.  end becomes the coordinates at the end, *by the distance moved; it is NaN if the mode at
 * the end is another. */
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
    /* in units of each coordinate: a one-sided difference has an error of this size, a central one of its
     * square, and the error that the tolerance allows a walk is divided by it */
    const double size = use == MULTIPLIERS ? 1e-4 : 1e-6;
    const motion start = f->w.m;
    double unit[D_MOST], centre[D_MOST];
    int is_free[D_MOST];
    ss_status st = ss_finder_go(f, cycles, NULL, NULL);
    const motion end = f->w.m;
    ss_finder_coordinates(&end, centre);
    ss_finder_coordinate_units(f, unit);
    if (start.now.model->memory != NULL && start.now.model->dim < D_MOST && start.now.mode == 0) {
        unit[D_Q] = f->unit.y;          /* q is a contact's deflection, much smaller than x perhaps */
        unit[D_V] = f->unit.y * sqrt(start.now.k / f->scene->mass);
    }
    start.now.model->variation->free(&start.now, is_free);
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
    *t = (tangent){ 0 };
    if (f->autonomous && f->w.m.now.model->still != NULL)
        return ss_finder_go(f, cycles, NULL, NULL);
    if (f->w.e->type->response == NULL)
        return differences(f, cycles, use, t);
    ss_tangent_begin(t, &f->w.m.now);
    if (f->autonomous)
        ss_tangent_on_onset(t, &f->w.m.now);
    return ss_finder_go(f, cycles, NULL, t);
}
