/* steady.c -- the periodic state that a scene settles to, by simulation or by shooting.
 *
 * The state at the start of each forcing cycle is an iterated map.  It has period p when it repeats
 * after p cycles.  It approaches its limit geometrically, so the rate at which the last differences
 * shrink gives the distance that remains, and a slow approach is not mistaken for the limit.  Shooting is
 * Newton's method on that map, with its derivative from tangent.c. */
#include <stickslip/sweep.h>

#include <float.h>
#include <math.h>
#include <string.h>
#include "base/error.h"
#include "base/range.h"
#include "study/sweep/meter.h"

const ss_range ss_steady_tolerances = { 1e-13, 0.1 };
const ss_steady_opts ss_steady_defaults = { .tol = 1e-9, .max_period = 8, .max_cycles = 10000,
                                            .max_steps = 10000000 };

/* The condition of a measure on the model. */
static int
sticks(const struct model *model)
{
    return model->guard != NULL;
}

static int
rings(const struct model *model)
{
    return model->in_transition != NULL;
}

static int
differs(const struct model *model)
{
    return model->variation != NULL;
}

static const struct {
    const char *name, *unit;
    int (*has)(const struct model *model);      /* NULL: every model has it */
} measure[SS_MEASURES] = {
    [SS_STOPS] = { "stops", "", sticks },
    [SS_STICK_FRACTION] = { "stick", "", sticks },
    [SS_AMPLITUDE] = { "amplitude", "m", NULL },
    [SS_X_MAX] = { "x_max", "m", NULL },
    [SS_V_MAX] = { "v_max", "m/s", NULL },
    [SS_A_MAX] = { "a_max", "m/s^2", NULL },
    [SS_ENERGY] = { "energy", "J", NULL },
    [SS_PERIOD] = { "period", "", NULL },
    [SS_CYCLES] = { "cycles", "", NULL },
    [SS_MICROSLIPS] = { "microslips", "", sticks },
    [SS_TRANSITION] = { "transition", "Hz", rings },
    [SS_X_PHASE] = { "x_phase", "m", NULL },
    [SS_V_PHASE] = { "v_phase", "m/s", NULL },
    [SS_FLOQUET] = { "floquet", "", differs },
    [SS_FLOQUET_2] = { "floquet2", "", differs },
    [SS_FLOQUET_ANGLE] = { "floquet_angle", "rad", differs },
};

#define FLOQUET (1u << SS_FLOQUET | 1u << SS_FLOQUET_2 | 1u << SS_FLOQUET_ANGLE)

const char *
ss_measure_name(ss_measure m)
{
    return (unsigned)m < SS_MEASURES ? measure[m].name : NULL;
}

const char *
ss_measure_unit(ss_measure m)
{
    return (unsigned)m < SS_MEASURES ? measure[m].unit : NULL;
}

/* Without a closed form any method represents the one that suits the point. */
static const char *
method_of(const ss_steady_opts *opts, const struct model *model)
{
    return opts->method != NULL ? opts->method : model->linear ? EXACT : TAYLOR;
}

ss_status
ss_steady_check(const ss_steady_opts *opts, ss_model model, ss_error *err)
{
    if (opts == NULL)
        return SS_FAIL_NULL(err);
    const struct model *m = ss_model_at((unsigned)model);
    if (m == NULL)
        return ss_fail(err, SS_EINVAL, "model is no known choice");
    const char *method = method_of(opts, m);
    int exact = strcmp(method, EXACT) == 0, known = 0;
    for (size_t i = 0; ss_sim_method_name(i) != NULL; i++)
        known |= strcmp(method, ss_sim_method_name(i)) == 0;
    for (int i = 0; i < SS_MEASURES; i++)
        if ((opts->measures & 1u << i) && measure[i].has != NULL && !measure[i].has(m))
            return ss_fail(err, SS_EINVAL, "model %s has no measure '%s'", m->name,
                           measure[i].name);
    ss_status st = ss_range_check(opts->tol, ss_steady_tolerances, "tolerance", err);
    if (st != SS_OK)
        return st;
    if (opts->max_period < 1 || opts->max_period > SS_PERIOD_MAX)
        return ss_fail(err, SS_EINVAL, "the longest period is 1 ... %d cycles", SS_PERIOD_MAX);
    if (opts->max_cycles < 1)
        return ss_fail(err, SS_EINVAL, "no cycles to look for a period in");
    if (!known || (exact && !m->linear))
        return ss_fail(err, SS_EINVAL, "no method '%s' for model %s", method, m->name);
    if ((opts->shoot || (opts->measures & FLOQUET)) && !(exact && differs(m)))
        return ss_fail(err, SS_EINVAL, "shooting and multipliers need a closed form, method exact");
    if (opts->shoot && (opts->settle > 0 || (opts->measures & 1u << SS_CYCLES)))
        return ss_fail(err, SS_EINVAL, "shooting does not wait for the motion to settle: it leaves "
                       "no cycles to count");
    return SS_OK;
}

/* --- states -------------------------------------------------------------------------------- */

/* At the start of a forcing cycle: x - U t, v over the surface, and y of the model (memory), 0 if it has
 * none. */
typedef struct section {
    double x, v, y;
} section;

typedef struct finder {
    const ss_scene *scene;
    const ss_steady_opts *opts;
    ss_error *err;
    walk w;
    double n;                           /* forcing cycles walked, from the walk's t = 0 */
    section unit;                         /* of a difference */
    section last[2 * SS_PERIOD_MAX + 1];  /* the latest, cycle after cycle, in a ring */
    unsigned long recorded;                /* of them */
    unsigned long unresolved;           /* events in what was measured: see ss_sim_stats */
} finder;

/* *unit: what y is measured by. */
static double
memory_of(const state *m, double *unit)
{
    *unit = 1;
    return m->model->memory != NULL ? m->model->memory(m, unit) : 0;
}

static section
section_of(const state *m)
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

static double
distance(const finder *f, section a, section b)
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

/* --- walking ------------------------------------------------------------------------------- */

/* A point takes many cycles: one that costs much more than the motion asks for is refused before it has
 * used up the steps of the point.  A cycle has a tenth of those, 10^6 at least, and always three times
 * what the fastest period of the mode asks for; each is worth RHS_PER_STEP right-hand sides, which
 * unlike steps cost about the same in every method. */
#define CYCLE_STEPS 1e6

static double
cycle_work(const finder *f)
{
    double tenth = (double)f->opts->max_steps / 10;
    double needed = 1 / f->scene->base_frequency / ss_step_cap(&f->w.m.now);
    return RHS_PER_STEP * fmax(fmax(CYCLE_STEPS, tenth), 3 * needed);
}

static ss_status
check_work(const finder *f, double since, int cycles)
{
    double most = cycles * cycle_work(f);
    if (f->opts->max_steps == 0 || (double)f->w.e->rhs - since <= most)
        return SS_OK;
    return ss_fail(f->err, SS_EBUDGET, "more than %.2g right-hand sides in a forcing cycle at t = %.9g s: "
                   "the tolerance forces short steps", most / cycles,
                   f->w.m.origin.hi + f->w.m.now.u);
}

/* Walk so many forcing cycles, with a meter and a tangent unless they are NULL. */
static ss_status
go(finder *f, int cycles, meter *r, tangent *t)
{
    walk *w = &f->w;
    double period = 1 / f->scene->base_frequency, none = 4 * DBL_EPSILON * period;
    instant end = instant_sample(f->n + cycles, f->scene->base_frequency);
    double since = (double)w->e->rhs;
    for (double left; (left = instant_diff(end, w->m.origin) - w->m.now.u) > none;) {
        ss_event event;
        double q[MAX_DIM], rates[MAX_DIM];
        int is_event, mode = w->m.now.mode;
        ss_status st = check_work(f, since, cycles);
        if (st == SS_OK)
            st = ss_walk_leg(w, fmin(left, period), f->err);
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
    }
    f->n += cycles;
    return SS_OK;
}

/* Measure so many cycles from here on; period 0 if they do not close. */
static ss_status
measure_cycles(finder *f, int cycles, int period, ss_steady *out)
{
    meter r;
    tangent t;
    section at = section_of(&f->w.m.now);
    int derive = period > 0 && (f->opts->measures & FLOQUET);
    ss_meter_begin(&r, f->opts->measures, &f->w.m.now);
    if (derive)
        ss_tangent_begin(&t, &f->w.m.now);
    unsigned long before = ss_motion_unresolved(&f->w.m);
    ss_status st = go(f, cycles, &r, derive ? &t : NULL);
    if (st != SS_OK)
        return st;
    f->unresolved = ss_motion_unresolved(&f->w.m) - before;
    ss_meter_end(&r, cycles, period > 0, out->value);
    out->value[SS_PERIOD] = period;
    out->value[SS_X_PHASE] = at.x;
    out->value[SS_V_PHASE] = at.v + f->scene->surface_velocity;
    if (derive)
        ss_tangent_multipliers(&t, &out->value[SS_FLOQUET], &out->value[SS_FLOQUET_2],
                               &out->value[SS_FLOQUET_ANGLE]);
    return SS_OK;
}

/* --- by simulation ------------------------------------------------------------------------- */

static void
record_section(finder *f)
{
    f->last[f->recorded++ % (2 * SS_PERIOD_MAX + 1)] = section_of(&f->w.m.now);
}

/* The state so many cycles before the latest. */
static section
section_before(const finder *f, int cycles)
{
    return f->last[(f->recorded - 1 - (unsigned long)cycles) % (2 * SS_PERIOD_MAX + 1)];
}

/* A difference within rounding gives no rate of shrinking. */
#define ROUNDING (64 * DBL_EPSILON)

static int
has_period(const finder *f, int p)
{
    if (f->recorded <= (unsigned long)p)
        return 0;
    double now = distance(f, section_before(f, 0), section_before(f, p));
    if (now <= ROUNDING || !(now <= f->opts->tol))
        return now <= ROUNDING;
    if (f->recorded <= 2 * (unsigned long)p)
        return 0;
    double before = distance(f, section_before(f, p), section_before(f, 2 * p)), ratio = now / before;
    return ratio < 1 && now * ratio / (1 - ratio) <= f->opts->tol;
}

/* The state within tol of its limit is within 2 tol of itself after any multiple of its period, so
 * a state that is as near after fewer cycles has not reached the shorter period yet. */
static int
find_period(const finder *f)
{
    for (int p = 1; p <= f->opts->max_period; p++) {
        if (has_period(f, p))
            return p;
        if (f->recorded > (unsigned long)p
            && distance(f, section_before(f, 0), section_before(f, p)) <= 10 * f->opts->tol)
            return 0;
    }
    return 0;
}

/* Settle for the given cycles; then find the first cycle that returns to its first state. */
static ss_status
settle_and_look(finder *f, int *period)
{
    ss_status st = SS_OK;
    for (unsigned long i = 0; st == SS_OK && i < f->opts->settle; i++)
        st = go(f, 1, NULL, NULL);
    const motion here = f->w.m;
    for (int p = 1; st == SS_OK && *period == 0 && p <= f->opts->max_period; p++) {
        st = go(f, 1, NULL, NULL);
        if (distance(f, section_of(&f->w.m.now), section_of(&here.now)) <= f->opts->tol)
            *period = p;
    }
    if (st != SS_OK)
        return st;
    f->n = 0;
    return ss_walk_begin_at(&f->w, &here);
}

static ss_status
settle(finder *f, int *period)
{
    ss_status st = SS_OK;
    record_section(f);
    for (unsigned long i = 0; st == SS_OK && *period == 0 && i < f->opts->max_cycles; i++) {
        st = go(f, 1, NULL, NULL);
        record_section(f);
        *period = find_period(f);
    }
    return st;
}

static ss_status
simulate(finder *f, ss_steady *out)
{
    int period = 0, asked = f->opts->settle > 0;
    ss_status st = asked ? settle_and_look(f, &period) : settle(f, &period);
    double cycles = asked ? (double)f->opts->settle : f->n;
    if (st == SS_OK)
        st = measure_cycles(f, period > 0 ? period : f->opts->max_period, period, out);
    if (st != SS_OK)
        return st;
    if (period > 0 || asked)
        out->value[SS_CYCLES] = cycles;
    return SS_OK;
}

/* --- by shooting --------------------------------------------------------------------------- */

/* Cycles simulated before the first of Newton's steps, and how many of those there are. */
enum { APPROACH = 4, NEWTON_STEPS = 20 };

/* Move a state by d; 0 if its mode does not allow that. */
static int
move(motion *m, const double d[D_MOST])
{
    ss_motion_rebase(m);
    return m->now.model->variation->move(&m->now, d);
}

/* One of Newton's steps, which moves *at.  *off: the larger of the step and the miss; INFINITY if the
 * step was shortened, unless the miss is rounding. */
static ss_status
newton_step(finder *f, motion *at, tangent *t, double *off)
{
    const double unit[3] = { f->unit.x, f->unit.x, f->unit.v };
    ss_status st = ss_walk_begin_at(&f->w, at);
    f->n = 0;
    ss_tangent_begin(t, &at->now);
    if (st == SS_OK)
        st = go(f, 1, NULL, t);
    if (st != SS_OK)
        return st;
    motion end = f->w.m, moved = *at;
    const state *a = &at->now, *b = &end.now;
    ss_motion_rebase(&end);
    double d[3], r[3] = { b->x_ref - a->x_ref, b->q[0] - a->q[0], b->q[1] - a->q[1] };
    double missed = distance(f, section_of(b), section_of(a));
    int allowed = 0, halvings = 0;
    ss_tangent_solve(t, unit, r, d);
    if (b->mode == a->mode && isfinite(d[0] + d[1] + d[2]))
        for (; !(allowed = move(&moved, d)) && halvings < 8; halvings++) {
            moved = *at;
            for (int i = 0; i < 3; i++)
                d[i] /= 2;
        }
    *off = missed <= ROUNDING ? missed : INFINITY;
    if (allowed && halvings == 0)
        *off = fmax(missed, distance(f, section_of(&moved.now), section_of(a)));
    *at = allowed ? moved : end;        /* no step to be had: simulate on */
    at->origin = (instant){ 0, 0 };
    at->now.u = 0;
    return SS_OK;
}

/* Measure the period found; 0 in *found if there is none, or none that is stable. */
static ss_status
shoot(finder *f, ss_steady *out, int *found)
{
    tangent t;
    double off = INFINITY, first, second, angle;
    ss_status st = go(f, APPROACH, NULL, NULL);
    motion at = f->w.m;
    for (int i = 0; st == SS_OK && off > f->opts->tol && i < NEWTON_STEPS; i++)
        st = newton_step(f, &at, &t, &off);
    *found = 0;
    if (st != SS_OK || off > f->opts->tol)
        return st;
    ss_tangent_multipliers(&t, &first, &second, &angle);
    if (!(first <= 1 + 1e-9))
        return SS_OK;
    *found = 1;
    f->n = 0;
    st = ss_walk_begin_at(&f->w, &at);
    return st == SS_OK ? measure_cycles(f, 1, 1, out) : st;
}

/* --- either -------------------------------------------------------------------------------- */

static ss_status
begin(finder *f)
{
    const struct model *model = ss_model_of(f->scene);
    int is_free = f->opts->method == NULL && !model->linear;
    const ss_sim_opts sim = { .method = is_free ? NULL : method_of(f->opts, model),
                              .tol = fmax(1e-14, f->opts->tol / 1000),
                              .max_steps = f->opts->max_steps };
    ss_walk_end(&f->w);
    f->n = 0;
    f->recorded = 0;
    return ss_walk_begin(&f->w, f->scene, &sim, f->err);
}

/* The reason for a missing measure, if one is missing. */
static ss_status
complete(const finder *f, const ss_steady *out)
{
    const ss_steady_opts *o = f->opts;
    if (out->value[SS_PERIOD] == 0 && o->settle > 0)
        return ss_fail(f->err, SS_EDATA, "no period up to %d after %lu cycles", o->max_period,
                       o->settle);
    if (out->value[SS_PERIOD] == 0)
        return ss_fail(f->err, SS_EDATA, "no period up to %d within %lu cycles", o->max_period,
                       o->max_cycles);
    if (f->unresolved > 0)
        return ss_fail(f->err, SS_EDATA, "%lu events a period within what rounding or tolerance "
                       "makes of them: not resolved", f->unresolved);
    for (int i = 0; i < SS_MEASURES; i++)
        if ((o->measures & 1u << i) && isnan(out->value[i]))
            return ss_fail(f->err, SS_EDATA, i == SS_TRANSITION
                           ? "%s: no oscillation, a has no three extrema in one"
                           : "%s: not a number",
                           measure[i].name);
    return SS_OK;
}

ss_status
ss_steady_find(ss_steady *out, const ss_scene *scene, const ss_steady_opts *opts, ss_error *err)
{
    if (out == NULL || scene == NULL || opts == NULL)
        return SS_FAIL_NULL(err);
    finder f = { .scene = scene, .opts = opts, .err = err };
    int found = 0;
    for (int i = 0; i < SS_MEASURES; i++)
        out->value[i] = NAN;
    ss_status st = ss_scene_check(scene, err);
    if (st == SS_OK)
        st = ss_steady_check(opts, scene->model, err);
    if (st != SS_OK)
        return st;
    if (scene->base_frequency == 0)
        return ss_fail(err, SS_EINVAL, "base_frequency is 0: there is no forcing cycle");
    st = begin(&f);
    f.unit = section_units(&f.w.m.now);
    if (st == SS_OK && opts->shoot)
        st = shoot(&f, out, &found);
    if (st == SS_OK && opts->shoot && !found)
        st = begin(&f);
    if (st == SS_OK && !found)
        st = simulate(&f, out);
    ss_walk_end(&f.w);
    for (int i = 0; i < SS_MEASURES; i++)
        if (st != SS_OK || !(opts->measures & 1u << i))
            out->value[i] = i == SS_PERIOD && st == SS_OK ? out->value[i] : NAN;
    return st == SS_OK ? complete(&f, out) : st;
}
