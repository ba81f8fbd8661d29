/* cycles.c -- walk from cycle to cycle, and carry the derivative of the walk along.
 *
 * Within a mode the closed form has a derivative.  Another initial state reaches an event at another
 * time, so the derivative jumps there, by the saltation matrix (Aizerman and Gantmakher 1958; Leine and
 * Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 2004, ch. 7).  The motion
 * after a Coulomb stick does not depend on v and on the time at which the stick began, so a stick
 * removes one direction of the derivative.  Elsewhere walks that start at neighbouring states give it.
 * Without forcing and with true sticks it is 0: a stick lasts until the pull has raised the force to f_s, and
 * this happens at the same x - U t wherever the stick began. */
#include "study/sweep/cycles.h"

#include <math.h>
#include <string.h>
#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include "base/error.h"
#include "base/least.h"

/* --- states -------------------------------------------------------------------------------- */

/* The third number of the state, y; *unit becomes its scale. */
static double
memory_of(const state *m, double *unit)
{
    *unit = 1;
    return m->model->memory != NULL ? m->model->memory(m, unit) : 0;
}

section
ss_section_of(const motion *at)
{
    const state *m = &at->now;
    double unit;
    double x = m->x_ref + m->q[0] - frame_pull(m) * m->u;
    return (section){ x, m->q[1], memory_of(m, &unit) };
}

static double
part(double difference, double unit)
{
    return difference == 0 ? 0 : fabs(difference) / unit;
}

double
ss_section_distance(const cycles *c, section a, section b)
{
    return fmax(fmax(part(a.x - b.x, c->unit.x), part(a.v - b.v, c->unit.v)), part(a.y - b.y, c->unit.y));
}

/* A cycle from the pull begins where v falls below it by a part of it, after it has been above it by as much.  It
 * is not the pull itself, at which a steady slide stays. */
#define ASIDE 0.01

void
ss_cycles_begin(cycles *c)
{
    const ss_sim_opts sim = { .method = c->how->name, .tol = fmax(1e-14, c->opts->tol / 1000) };
    const state *m = &c->w.m.now;
    c->n = 0;
    c->status = ss_walk_begin(&c->w, c->scene, &sim, c->err);
    c->w.max_steps = c->opts->max_steps;
    double scale[MAX_DIM] = { m->x_scale, m->x_scale * fmax(m->omega, own_frequency(m->scene)), 1 };
    memory_of(m, &scale[2]);
    if (m->model->scales != NULL)
        m->model->scales(m, scale);
    c->unit = (section){ scale[0], scale[1], scale[2] };
    c->from_pull = c->autonomous && !ss_model_has_events(m->model);
    c->was_faster = c->from_pull && speed_of(m) / pull_of(c->scene) - 1 > -ASIDE;
    if (c->autonomous)
        ss_cycles_go(c, 1, NULL);
}

void
ss_cycles_begin_at(cycles *c, const motion *from)
{
    const motion copy = *from;          /* from may be the walk's own motion */
    c->n = c->was_faster = 0;
    ss_walk_begin_at(&c->w, &copy);
}

/* --- walking ------------------------------------------------------------------------------- */

/* A point takes many cycles.  A cycle that costs much more than its motion needs is refused before it has
 * used up the steps of the point.  It may take a tenth of these steps, at least 10^6, and always three
 * times as many as the fastest period of the mode needs.  The limit is in right-hand sides, RHS_PER_STEP
 * for each step, since they cost about the same in every method. */
#define CYCLE_STEPS 1e6

/* Check what n cycles have cost since there were so many right-hand sides. */
static void
check_work(cycles *c, double since, int n)
{
    double tenth = (double)c->opts->max_steps / 10;
    double needed = c->autonomous ? 0 : 1 / c->scene->base_frequency / ss_step_cap(&c->w.m.now);
    double a_cycle = RHS_PER_STEP * fmax(fmax(CYCLE_STEPS, tenth), 3 * needed);
    if (c->opts->max_steps > 0 && (double)c->w.e->rhs - since > n * a_cycle)
        c->status = ss_fail(c->err, SS_EBUDGET, "more than %.2g right-hand sides in a %scycle at t = %.9g s: "
                            "the tolerance forces short steps", a_cycle, c->autonomous ? "" : "forcing ",
                            c->w.m.origin.hi + c->w.m.now.u);
}

/* Carry a derivative along the present leg. */
static void
carry(tangent *t, const walk *w)
{
    double leg[D_MOST][D_MOST];
    const tangent before = *t;
    if (w->still)
        return;
    w->e->type->response(w->e, w->h, leg);
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            t->d[i][j] = leg[i][D_REF] * before.d[D_REF][j] + leg[i][D_Q] * before.d[D_Q][j]
                + leg[i][D_V] * before.d[D_V][j];
}

/* By what part of the pull's speed the mass is faster, s after the start of the leg. */
static double
faster(cycles *c, double s)
{
    state at = c->w.m.now;
    double rates[MAX_DIM];
    if (s == c->w.e->h)
        memcpy(at.q, c->w.e->q1, sizeof at.q);
    else
        ss_walk_at(&c->w, s, at.q, rates);
    return speed_of(&at) / pull_of(c->scene) - 1;
}

/* Returns 1 if a cycle from the pull begins in the leg, which then ends there. */
static int
crosses_pull(cycles *c)
{
    walk *w = &c->w;
    double end = faster(c, w->h), lo = 0, hi = w->h, s;
    if (!c->was_faster || end > -ASIDE) {
        c->was_faster |= end > ASIDE;
        return 0;
    }
    while ((s = lo + (hi - lo) / 2) > lo && s < hi)
        *(faster(c, s) > -ASIDE ? &lo : &hi) = s;
    w->h = hi;
    w->ends = c->was_faster = 0;
    return 1;
}

/* Let the motion begin anew at the end of the leg. */
static void
cut(walk *w)
{
    double q[MAX_DIM], rates[MAX_DIM];
    ss_walk_at(w, w->h, q, rates);
    memcpy(w->m.now.q, q, sizeof q);
    w->m.now.u += w->h;
    w->lasted += w->h;
    ss_motion_rebase(&w->m);
    w->e->type->begin(w->e);
}

/* Walk one leg.  Returns 1 if at its end a stick begins, or the mass becomes slower than its pull. */
static int
go_leg(cycles *c, double longest, meter *r, tangent *t)
{
    walk *w = &c->w;
    ss_event event;
    double q[MAX_DIM], rates[MAX_DIM];
    int is_event = 0, mode = w->m.now.mode;
    c->status = ss_walk_leg(w, longest, c->err);
    if (c->status == SS_OK && isinf(w->h))
        c->status = ss_fail(c->err, SS_EDATA, "the stick at t = %.9g s is without end: no slip comes within a "
                            "time that a double holds", w->m.origin.hi + w->m.now.u);
    if (c->status != SS_OK)
        return 0;
    int crosses = c->from_pull && crosses_pull(c);
    if (r != NULL)
        ss_meter_leg(r, w);
    if (crosses) {
        cut(w);
        return 1;
    }
    if (t != NULL) {
        carry(t, w);
        ss_walk_at(w, w->h, q, rates);
    }
    int ends = w->ends;
    const bound by = w->m.now.bound[w->e->ended];
    const struct variation *variation = w->m.now.model->variation;
    c->status = ss_walk_on(w, &is_event, &event, c->err);
    if (c->status != SS_OK)
        return 0;
    if (t != NULL && ends) {
        for (int i = 0; i < D_MOST; i++)
            t->later[i] = -t->d[D_V][i] / rates[1];
        variation->cross(&w->m.now, mode, &by, q, rates, w->e->dq0, t->d);
    }
    if (!is_event)
        return 0;
    if (r != NULL)
        ss_meter_event(r, &event);
    return event.kind == SS_STICK;
}

/* At an onset of microstick: change from neighbouring states at one time to neighbouring states at their own
 * onsets, where only x - U t differs. */
static void
take_on_onset(tangent *t, const state *m)
{
    for (int i = 0; i < D_MOST; i++)
        for (int j = 0; j < D_MOST; j++)
            t->d[i][j] = i == D_REF && j == D_REF ? t->d[i][j] - pull_of(m->scene) * t->later[j] : 0;
}

/* Walk to the onset of stick that is n onsets ahead.  A true stick is one leg.  All other legs last at most
 * one period of the free mass, so that a slip without end is noticed. */
static void
go_to_onset(cycles *c, int n, meter *r, tangent *t)
{
    const state *m = &c->w.m.now;
    double own = 2 * M_PI / fmin(own_frequency(c->scene), m->model->fastest(m, NULL)), slipped = 0;
    double most = (double)c->opts->max_cycles * own, since = (double)c->w.e->rhs;
    if (c->from_pull)                   /* the pull first loads the spring, or a steady slide is slowly left */
        most = m->model->equilibrium != NULL ? most / 60
            : most / 600 + 2 * static_friction(c->scene) / c->scene->stiffness / fabs(pull_of(c->scene));
    for (int onsets = 0; onsets < n;) {
        int slips = m->mode != 0 || c->from_pull, is_still = !slips && m->model->still != NULL;
        check_work(c, since, n);
        int sticks = c->status == SS_OK && go_leg(c, is_still ? INFINITY : own, r, t);
        if (c->status != SS_OK)
            return;
        onsets += sticks;
        slipped = slips && !sticks ? slipped + c->w.h : 0;
        if (slipped > most) {
            c->status = c->from_pull
                ? ss_fail(c->err, SS_EDATA, "it slides on with the pull: no cycle within %.9g s", slipped)
                : ss_fail(c->err, SS_EDATA, "it slides on: no stick within %.9g s, %lu own periods", slipped,
                          c->opts->max_cycles);
            return;
        }
    }
    if (t != NULL)
        take_on_onset(t, m);
}

static void
go(cycles *c, int n, meter *r, tangent *t)
{
    if (c->status != SS_OK)
        return;
    if (c->autonomous) {
        go_to_onset(c, n, r, t);
        return;
    }
    const walk *w = &c->w;
    double period = 1 / c->scene->base_frequency, none = 4 * DBL_EPSILON * period, since = (double)w->e->rhs;
    instant end = instant_sample(c->n + n, c->scene->base_frequency);
    for (double left; (left = instant_diff(end, w->m.origin) - w->m.now.u) > none;) {
        check_work(c, since, n);
        if (c->status == SS_OK)
            go_leg(c, fmin(left, period), r, t);
        if (c->status != SS_OK)
            return;
    }
    c->n += n;
}

void
ss_cycles_go(cycles *c, int n, meter *r)
{
    go(c, n, r, NULL);
}

int
ss_cycles_return(cycles *c, int most, double tol)
{
    const section at = ss_section_of(&c->w.m);
    for (int p = 1; p <= most; p++) {
        ss_cycles_go(c, 1, NULL);
        if (c->status != SS_OK)
            return 0;
        if (ss_section_distance(c, ss_section_of(&c->w.m), at) <= tol)
            return p;
    }
    return 0;
}

/* --- derivatives --------------------------------------------------------------------------- */

/* The numbers in which neighbours can differ at the start of a cycle. */
static void
find_free(const cycles *c, const state *m, int is_free[D_MOST])
{
    m->model->variation->free(m, is_free);
    if (c->from_pull)
        is_free[D_V] = 0;
}

int
ss_cycles_move(motion *m, const double d[D_MOST])
{
    ss_motion_rebase(m);
    return m->now.model->variation->move(&m->now, d);
}

void
ss_cycles_coordinates(const motion *m, double at[D_MOST])
{
    motion here = *m;
    ss_motion_rebase(&here);
    at[D_REF] = here.now.model->dim > 2 ? here.now.q[2] : here.now.x_ref;
    at[D_Q] = here.now.q[0];
    at[D_V] = here.now.q[1];
}

void
ss_cycles_units(const cycles *c, double unit[D_MOST])
{
    unit[D_REF] = c->w.m.now.model->dim > 2 ? c->unit.y : c->unit.x;
    unit[D_Q] = c->unit.x;
    unit[D_V] = c->unit.v;
}

/* Go on for n cycles from a state that is moved by *by along one coordinate, or by -*by if its mode forbids
 * that.  end becomes the coordinates at the end, *by the distance moved; it is NaN if the mode at the end is
 * another. */
static void
go_beside(cycles *c, const motion *start, int n, int coordinate, double *by, double end[D_MOST])
{
    motion moved = *start;
    double d[D_MOST] = { 0 };
    d[coordinate] = *by;
    if (!ss_cycles_move(&moved, d)) {
        moved = *start;
        *by = d[coordinate] = -*by;
        if (!ss_cycles_move(&moved, d))
            *by = NAN;
    }
    int mode = c->w.m.now.mode;
    ss_cycles_begin_at(c, &moved);
    ss_cycles_go(c, n, NULL);
    ss_cycles_coordinates(&c->w.m, end);
    if (c->w.m.now.mode != mode)
        *by = NAN;
}

static void
differences(cycles *c, int n, derivative_use use, tangent *t)
{
    /* in units of each coordinate: a one-sided difference has an error of this size, a central one of its
     * square, and the error that the tolerance allows a walk is divided by it */
    const double size = use == MULTIPLIERS ? 1e-4 : 1e-6;
    const motion start = c->w.m;
    const state *from = &start.now;
    double unit[D_MOST], centre[D_MOST];
    int is_free[D_MOST];
    ss_cycles_go(c, n, NULL);
    const motion end = c->w.m;
    ss_cycles_coordinates(&end, centre);
    ss_cycles_units(c, unit);
    if (from->model->memory != NULL && from->model->dim < D_MOST && from->mode == 0) {
        unit[D_Q] = c->unit.y;          /* q is a contact's deflection, much smaller than x perhaps */
        unit[D_V] = c->unit.y * sqrt(from->k / c->scene->mass);
    }
    find_free(c, from, is_free);
    for (int j = 0; j < D_MOST; j++) {
        double up[D_MOST], by = size * unit[j], down[D_MOST], back = 0;
        if (!is_free[j])
            continue;
        go_beside(c, &start, n, j, &by, up);
        memcpy(down, centre, sizeof down);
        if (use == MULTIPLIERS) {
            back = -size * unit[j];
            go_beside(c, &start, n, j, &back, down);
        }
        for (int i = 0; i < D_MOST; i++)
            t->d[i][j] = (up[i] - down[i]) / (by - back);
    }
    ss_cycles_begin_at(c, &end);
    if (c->autonomous)
        c->w.m.origin = end.origin;     /* so that the time of several cycles is known */
}

void
ss_cycles_derive(cycles *c, int n, derivative_use use, tangent *t)
{
    const state *m = &c->w.m.now;
    int is_free[D_MOST];
    *t = (tangent){ 0 };
    if (c->autonomous && m->model->still != NULL) {
        ss_cycles_go(c, n, NULL);
        return;
    }
    if (c->w.e->type->response == NULL) {
        differences(c, n, use, t);
        return;
    }
    find_free(c, m, is_free);
    for (int i = 0; i < D_MOST; i++)
        t->d[i][i] = is_free[i];
    if (c->autonomous)
        take_on_onset(t, m);
    go(c, n, NULL, t);
}

ss_status
ss_tangent_solve(const tangent *t, const double unit[D_MOST], const double r[D_MOST], double d[D_MOST])
{
    double a[D_MOST][D_MOST], y[D_MOST], sum = 0, squares;
    for (int i = 0; i < D_MOST; i++) {
        double most = 0;
        sum += y[i] = r[i] / unit[i];
        for (int j = 0; j < D_MOST; j++) {
            sum += a[i][j] = (i == j) - t->d[i][j] * unit[j] / unit[i];
            most = fmax(most, fabs(a[i][j]));
        }
        if (most <= ROUNDING) {         /* as the place of a contact that sticks throughout: it stays */
            a[i][i] = 1;
            y[i] = 0;
        }
    }
    ss_status st = isfinite(sum) ? ss_least_linear(a[0], y, D_MOST, D_MOST, d, &squares, NULL) : SS_OK;
    for (int i = 0; i < D_MOST; i++)
        d[i] = isfinite(sum) ? d[i] * unit[i] : NAN;
    return st;
}

ss_status
ss_eigenvalues(const double *matrix, gsl_complex value[D_MOST])
{
    double d[D_MOST * D_MOST], sum = 0;
    gsl_matrix_view of = gsl_matrix_view_array(d, D_MOST, D_MOST);
    gsl_vector_complex_view values = gsl_vector_complex_view_array((double *)value, D_MOST);
    for (int i = 0; i < D_MOST * D_MOST; i++)
        sum += d[i] = matrix[i];
    for (int i = 0; i < D_MOST; i++)
        value[i] = gsl_complex_rect(NAN, NAN);
    if (!isfinite(sum))
        return SS_OK;
    gsl_eigen_nonsymm_workspace *w = gsl_eigen_nonsymm_alloc(D_MOST);
    if (w == NULL)
        return SS_ENOMEM;
    gsl_eigen_nonsymm_params(0, 1, w);          /* balanced: x and v differ by powers of ten */
    if (gsl_eigen_nonsymm(&of.matrix, &values.vector, w) != 0)
        value[0] = gsl_complex_rect(NAN, NAN);
    gsl_eigen_nonsymm_free(w);
    return SS_OK;
}

ss_status
ss_tangent_multipliers(const tangent *t, double *first, double *second, double *angle)
{
    gsl_complex value[D_MOST];
    ss_status st = ss_eigenvalues(t->d[0], value);
    *first = *second = *angle = NAN;
    if (st != SS_OK || isnan(GSL_REAL(value[0])))
        return st;
    *first = -1;
    for (int i = 0; i < D_MOST; i++) {
        double modulus = gsl_complex_abs(value[i]);
        if (modulus > *first) {
            *second = *first;
            *first = modulus;
            *angle = modulus > 0 ? fabs(gsl_complex_arg(value[i])) : 0;
        } else {
            *second = fmax(*second, modulus);
        }
    }
    return SS_OK;
}

/* --- the Lyapunov exponent ----------------------------------------------------------------- */

/* The derivative of each cycle carries a difference of neighbouring states to the next cycle, where its length
 * is set to one again (Benettin, Galgani, Giorgilli and Strelcyn, Meccanica 15, 1980).  Events act by their
 * saltation matrices, and a stick removes one direction (Mueller, Chaos Solitons Fractals 5, 1995).  The
 * exponent is the sum of the logarithms of the lengths over time.  The scatter of parts of this mean tells its
 * error; the parts are long compared with the memory of the motion. */

enum { PARTS = 20 };

typedef struct growth {
    double log, time;               /* the logarithm of a difference's growth, in this time [s] */
} growth;

static growth
follow(cycles *c, unsigned long n, double difference[D_MOST])
{
    double unit[D_MOST], begun = c->w.m.origin.hi + c->w.m.now.u;
    growth all = { 0, 0 };
    ss_cycles_units(c, unit);
    for (unsigned long i = 0; c->status == SS_OK && i < n; i++) {
        const state *m = &c->w.m.now;
        tangent t;
        int is_free[D_MOST];
        double next[D_MOST], size = 0;
        ss_cycles_derive(c, 1, NEWTON, &t);
        find_free(c, m, is_free);
        for (int k = 0; k < D_MOST; k++) {
            next[k] = 0;
            for (int j = 0; j < D_MOST && is_free[k]; j++)
                next[k] += t.d[k][j] * unit[j] / unit[k] * difference[j];
            size += next[k] * next[k];
        }
        size = sqrt(size);
        for (int k = 0; k < D_MOST; k++)
            difference[k] = next[k] / size;
        all.log += log(size);
    }
    all.time = c->autonomous ? c->w.m.origin.hi + c->w.m.now.u - begun
        : (double)n / c->scene->base_frequency;
    return all;
}

void
ss_cycles_exponent(cycles *c, unsigned long n, double *exponent, double *error)
{
    double difference[D_MOST] = { 1, 1, 1 }, log = 0, time = 0, scatter = 0;
    growth parts[PARTS];
    follow(c, n / 10, difference);      /* it turns to where it grows most */
    for (int i = 0; i < PARTS; i++) {
        parts[i] = follow(c, (n + PARTS - 1) / PARTS, difference);
        log += parts[i].log;
        time += parts[i].time;
    }
    *exponent = log / time;
    for (int i = 0; i < PARTS; i++)
        scatter += pow(parts[i].log - *exponent * parts[i].time, 2);
    *error = sqrt(scatter * PARTS / (PARTS - 1)) / time;
}
