/* finder.c -- see finder.h. */
#include "study/sweep/finder.h"

#include <float.h>
#include <math.h>
#include "base/error.h"

/* --- states -------------------------------------------------------------------------------- */

/* The third number of the state, y; *unit becomes its scale. */
static double
memory_of(const state *m, double *unit)
{
    *unit = 1;
    return m->model->memory != NULL ? m->model->memory(m, unit) : 0;
}

section
ss_section_of(const state *m)
{
    double unit;
    double x = m->x_ref + m->q[0] - pull_of(m->scene) * m->u;
    return (section){ x, m->q[1], memory_of(m, &unit) };
}

static double
part(double difference, double unit)
{
    return difference == 0 ? 0 : fabs(difference) / unit;
}

double
ss_section_distance(const finder *f, section a, section b)
{
    return fmax(fmax(part(a.x - b.x, f->unit.x), part(a.v - b.v, f->unit.v)),
                part(a.y - b.y, f->unit.y));
}

static section
section_units(const state *m)
{
    section unit = { m->x_scale, m->x_scale * fmax(m->omega, own_frequency(m->scene)), 1 };
    memory_of(m, &unit.y);
    return unit;
}

/* Walks keep this part of the tolerance. */
static double
tolerance_of_walks(const finder *f)
{
    return fmax(1e-14, f->opts->tol / 1000);
}

ss_status
ss_finder_begin(finder *f, const char *method)
{
    const ss_sim_opts sim = { .method = method, .tol = tolerance_of_walks(f),
                              .max_steps = f->opts->max_steps };
    ss_status st = ss_walk_begin(&f->w, f->scene, &sim, f->err);
    f->unit = section_units(&f->w.m.now);
    return st == SS_OK && f->autonomous ? ss_finder_go(f, 1, NULL, NULL) : st;
}

ss_status
ss_finder_begin_at(finder *f, const motion *from)
{
    const motion copy = *from;          /* from may be the walk's own motion */
    f->n = 0;
    ss_walk_begin_at(&f->w, &copy);
    return SS_OK;
}

/* A rough tolerance is this part of a distance, and at most ROUGHEST: where v passes 0 steeply, an error
 * grows a hundredfold in a cycle. */
#define ROUGH 1e-4
#define ROUGHEST 1e-6

int
ss_finder_keep(finder *f, double distance)
{
    double magnified = fmax(1 - f->multiplier, 0), tol = fmin(ROUGH * distance, ROUGHEST) * magnified;
    double finest = fmax(1e-14, tolerance_of_walks(f) * magnified);
    if (f->w.e->type->keep == NULL)
        return 1;
    f->w.e->type->keep(f->w.e, fmax(tol, finest));
    return tol <= finest;
}

/* --- walking ------------------------------------------------------------------------------- */

/* A point takes many cycles.  A cycle that costs much more than its motion needs is refused before it has
 * used up the steps of the point.  It may take a tenth of these steps, at least 10^6, and always three
 * times as many as the fastest period of the mode needs.  The limit is in right-hand sides, RHS_PER_STEP
 * for each step, since they cost about the same in every method. */
#define CYCLE_STEPS 1e6

static double
cycle_work(const finder *f)
{
    double tenth = (double)f->opts->max_steps / 10;
    double needed = f->autonomous ? 0 : 1 / f->scene->base_frequency / ss_step_cap(&f->w.m.now);
    return RHS_PER_STEP * fmax(fmax(CYCLE_STEPS, tenth), 3 * needed);
}

static ss_status
check_work(const finder *f, double since, int cycles)
{
    double most = cycles * cycle_work(f);
    if (f->opts->max_steps == 0 || (double)f->w.e->rhs - since <= most)
        return SS_OK;
    return ss_fail(f->err, SS_EBUDGET, "more than %.2g right-hand sides in a %scycle at t = %.9g s: "
                   "the tolerance forces short steps", most / cycles, f->autonomous ? "" : "forcing ",
                   f->w.m.origin.hi + f->w.m.now.u);
}

/* Walk one leg.  *sticks becomes 1 if a stick begins at its end. */
static ss_status
go_leg(finder *f, double longest, meter *r, tangent *t, int *sticks)
{
    walk *w = &f->w;
    ss_event event;
    double q[MAX_DIM], rates[MAX_DIM];
    int is_event, mode = w->m.now.mode;
    ss_status st = ss_walk_leg(w, longest, f->err);
    if (st != SS_OK)
        return st;
    if (r != NULL)
        ss_meter_leg(r, w);
    if (t != NULL) {
        ss_tangent_leg(t, w);
        ss_walk_at(w, w->h, q, rates);
    }
    int ends = w->ends;
    st = ss_walk_on(w, &is_event, &event, f->err);
    if (st != SS_OK)
        return st;
    if (t != NULL && ends && is_event)
        ss_tangent_event(t, w, mode, q, rates);
    if (r != NULL && is_event)
        ss_meter_event(r, &event);
    *sticks = is_event && event.kind == SS_STICK;
    return SS_OK;
}

/* Walk to the onset of stick that is `cycles` onsets ahead.  A true stick is one leg.  All other legs last
 * at most one period of the free mass, so that a slip without end is noticed. */
static ss_status
go_to_onset(finder *f, int cycles, meter *r, tangent *t)
{
    const state *m = &f->w.m.now;
    double own = 2 * M_PI / own_frequency(f->scene), slipped = 0, since = (double)f->w.e->rhs;
    for (int n = 0, sticks; n < cycles; n += sticks) {
        int slips = m->mode != 0, is_still = !slips && m->model->still != NULL;
        ss_status st = check_work(f, since, cycles);
        if (st == SS_OK)
            st = go_leg(f, is_still ? INFINITY : own, r, t, &sticks);
        if (st != SS_OK)
            return st;
        slipped = slips && !sticks ? slipped + f->w.h : 0;
        if (slipped > (double)f->opts->max_cycles * own)
            return ss_fail(f->err, SS_EDATA, "it slides on: no stick within %.9g s, %lu own periods",
                           slipped, f->opts->max_cycles);
    }
    if (t != NULL)
        ss_tangent_on_onset(t, m);
    return SS_OK;
}

ss_status
ss_finder_go(finder *f, int cycles, meter *r, tangent *t)
{
    walk *w = &f->w;
    if (f->autonomous)
        return go_to_onset(f, cycles, r, t);
    double period = 1 / f->scene->base_frequency, none = 4 * DBL_EPSILON * period;
    instant end = instant_sample(f->n + cycles, f->scene->base_frequency);
    double since = (double)w->e->rhs;
    for (double left; (left = instant_diff(end, w->m.origin) - w->m.now.u) > none;) {
        int sticks;
        ss_status st = check_work(f, since, cycles);
        if (st == SS_OK)
            st = go_leg(f, fmin(left, period), r, t, &sticks);
        if (st != SS_OK)
            return st;
    }
    f->n += cycles;
    return SS_OK;
}

ss_status
ss_finder_return(finder *f, int most, double tol, int *period)
{
    const section at = ss_section_of(&f->w.m.now);
    ss_status st = SS_OK;
    *period = 0;
    for (int p = 1; st == SS_OK && *period == 0 && p <= most; p++) {
        st = ss_finder_go(f, 1, NULL, NULL);
        if (ss_section_distance(f, ss_section_of(&f->w.m.now), at) <= tol)
            *period = p;
    }
    return st;
}
