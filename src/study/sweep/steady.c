/* steady.c -- the measures of a periodic state: what has them, and what is said of those that are missing. */
#include <stickslip/sweep.h>

#include <math.h>
#include "base/options.h"
#include "motion/method.h"
#include "study/curve.h"
#include "study/sweep/grid.h"
#include "study/sweep/cycles.h"

const ss_range ss_steady_tolerances = { 1e-13, 0.1 };
static const ss_steady_opts usual = { .size = sizeof usual, .tol = 1e-9, .max_period = 8, .max_cycles = 10000,
                                      .max_steps = 10000000 };

SS_OPTIONS(ss_steady_opts, usual)

/* What a measure needs of a model. */
enum { STICKS = 1, RINGS = 2, DIFFERS = 4, LIMIT = 8, SLIDES = 16 };

static unsigned
what_has(const ss_model *m)
{
    return (ss_model_has_events(m) ? STICKS : 0u) | (m->in_transition != NULL ? RINGS : 0u)
        | (m->variation != NULL ? DIFFERS : 0u) | (m->limit != NULL ? LIMIT : 0u)
        | (m->equilibrium != NULL ? SLIDES : 0u);
}

static const struct {
    ss_label label;
    unsigned needs;
} measure[SS_MEASURES] = {
    [SS_STOPS] = { { "stops", "" }, STICKS },
    [SS_STICK_FRACTION] = { { "stick", "" }, STICKS },
    [SS_AMPLITUDE] = { { "amplitude", "m" }, 0 },
    [SS_X_MAX] = { { "x_max", "m" }, 0 },
    [SS_V_MAX] = { { "v_max", "m/s" }, 0 },
    [SS_A_MAX] = { { "a_max", "m/s^2" }, 0 },
    [SS_ENERGY] = { { "energy", "J" }, 0 },
    [SS_PERIOD] = { { "period", "" }, 0 },
    [SS_CYCLES] = { { "cycles", "" }, 0 },
    [SS_MICROSLIPS] = { { "microslips", "" }, STICKS },
    [SS_TRANSITION] = { { "transition", "Hz" }, RINGS },
    [SS_X_PHASE] = { { "x_phase", "m" }, 0 },
    [SS_V_PHASE] = { { "v_phase", "m/s" }, 0 },
    [SS_FLOQUET] = { { "floquet", "" }, DIFFERS },
    [SS_FLOQUET_2] = { { "floquet2", "" }, DIFFERS },
    [SS_FLOQUET_ANGLE] = { { "floquet_angle", "rad" }, DIFFERS },
    [SS_CYCLE_TIME] = { { "cycle_time", "s" }, 0 },
    [SS_MODEL_ERROR_X] = { { "model_error_x", "" }, LIMIT },
    [SS_MODEL_ERROR_X_RMS] = { { "model_error_x_rms", "" }, LIMIT },
    [SS_MODEL_ERROR_V] = { { "model_error_v", "" }, LIMIT },
    [SS_MODEL_ERROR_V_RMS] = { { "model_error_v_rms", "" }, LIMIT },
    [SS_MODEL_ERROR_A] = { { "model_error_a", "" }, LIMIT },
    [SS_MODEL_ERROR_A_RMS] = { { "model_error_a_rms", "" }, LIMIT },
    [SS_MODEL_ERROR_F] = { { "model_error_f", "" }, LIMIT },
    [SS_MODEL_ERROR_F_RMS] = { { "model_error_f_rms", "" }, LIMIT },
    [SS_LYAPUNOV] = { { "lyapunov", "1/s" }, DIFFERS },
    [SS_LYAPUNOV_ERROR] = { { "lyapunov_error", "1/s" }, DIFFERS },
    [SS_PEAK_VELOCITY] = { { "peak_velocity", "m/s" }, SLIDES },
    [SS_FORCE_DROP] = { { "force_drop", "N" }, SLIDES },
    [SS_GROWTH] = { { "growth", "1/s" }, SLIDES },
};

const ss_label *
ss_measure_label(ss_measure m)
{
    return (unsigned)m < SS_MEASURES ? &measure[m].label : NULL;
}

/* The method of a scene that has passed ss_steady_check. */
static const struct method *
method_of(const ss_steady_opts *opts, const ss_scene *scene)
{
    const struct method *how = ss_method_for(scene, BEST);
    if (opts->method != NULL)
        ss_method_named(&how, opts->method, scene, NULL);
    return how;
}

ss_status
ss_steady_check(const ss_steady_opts *opts, const ss_scene *scene, ss_error *err)
{
    const struct method *given;
    const ss_model *m = scene->model;
    if (m == NULL)
        return ss_fail(err, SS_EINVAL, "model is no known choice");
    for (int i = 0; i < SS_MEASURES; i++)
        if ((opts->measures & 1u << i) && (measure[i].needs & ~what_has(m)) != 0)
            return ss_fail(err, SS_EINVAL, "model %s has no measure '%s'", m->name,
                           measure[i].label.name);
    ss_status st = ss_range_check(opts->tol, ss_steady_tolerances, "tolerance", err);
    if (st != SS_OK)
        return st;
    if (opts->max_period < 1 || opts->max_period > SS_PERIOD_MAX)
        return ss_fail(err, SS_EINVAL, "the longest period is 1 ... %d cycles", SS_PERIOD_MAX);
    if (opts->max_cycles < 1)
        return ss_fail(err, SS_EINVAL, "no cycles to look for a period in");
    if (opts->strobe < 0 || opts->strobe > SS_STROBE_MAX)
        return ss_fail(err, SS_EINVAL, "starts of cycles: 1 ... %d", SS_STROBE_MAX);
    st = opts->method != NULL ? ss_method_named(&given, opts->method, scene, err) : SS_OK;
    if (st != SS_OK)
        return st;
    if (opts->search < SS_SEARCH_AUTO || opts->search > SS_SEARCH_SHOOT)
        return ss_fail(err, SS_EINVAL, "search is no known choice");
    if (opts->search == SS_SEARCH_SHOOT && !(what_has(m) & DIFFERS))
        return ss_fail(err, SS_EINVAL, "model %s has no neighbouring states to shoot with", m->name);
    if (opts->search == SS_SEARCH_SHOOT && (opts->settle > 0 || (opts->measures & 1u << SS_CYCLES)))
        return ss_fail(err, SS_EINVAL, "shooting does not wait for the motion to settle: it leaves "
                       "no cycles to count");
    return SS_OK;
}

/* --- the model in the limit ------------------------------------------------------------------ */

/* Compare the course with that of the model in the limit.  If one of them has one cycle, there is one way to lay
 * them side by side; two courses of several cycles each have no common phase. */
static ss_status
compare_with_limit(const finder *f)
{
    ss_error *err = f->c.err;
    ss_scene scene = *f->c.scene;
    ss_steady_opts opts = *f->c.opts;
    ss_steady limit;
    scene.model->limit(&scene);
    opts.measures = MODEL_ERRORS;
    finder g = { .c = { .scene = &scene, .opts = &opts, .err = err, .how = method_of(&opts, &scene) },
                 .out = &limit };
    ss_status st = ss_periodic_find(&g);
    if (st == SS_OK && limit.value[SS_PERIOD] == 0)
        st = ss_fail(err, SS_EDATA, "model %s in its place has no period up to %d within %lu cycles",
                     ss_model_name(scene.model), opts.max_period, opts.max_cycles);
    const course *ref = &f->course, *other = &g.course;
    if (st == SS_OK && other->cycles > 1 && ref->cycles > 1)
        st = ss_fail(err, SS_EDATA, "periods of %d cycles, and of %d in the limit, have no common phase", ref->cycles,
                     other->cycles);
    for (int c = 0; st == SS_OK && c < COURSE_COLUMNS; c++) {
        curve_error e = curve_compare(other->value[c], other->n, ref->value[c], ref->n);
        f->out->value[SS_MODEL_ERROR_X + 2 * c] = e.largest;
        f->out->value[SS_MODEL_ERROR_X + 2 * c + 1] = e.rms;
    }
    ss_periodic_free(&g);
    return st;
}

/* SS_EDATA, with the reason, if a measure is missing. */
static ss_status
check_complete(const finder *f)
{
    const ss_steady_opts *o = f->c.opts;
    const double *value = f->out->value;
    ss_error *err = f->c.err;
    if (value[SS_PERIOD] == 0 && o->settle > 0)
        return ss_fail(err, SS_EDATA, "no period up to %d after %lu cycles", o->max_period,
                       o->settle);
    if (value[SS_PERIOD] == 0)
        return ss_fail(err, SS_EDATA, "no period up to %d within %lu cycles", o->max_period,
                       o->max_cycles);
    if (f->unresolved > 0)
        return ss_fail(err, SS_EDATA, "%lu events a period within what rounding or tolerance "
                       "makes of them: not resolved", f->unresolved);
    for (int i = 0; i < SS_MEASURES; i++)
        if ((o->measures & 1u << i) && isnan(value[i]))
            return ss_fail(err, SS_EDATA, i == SS_TRANSITION
                           ? "%s: no oscillation, a has no three extrema in one" : "%s: not a number",
                           measure[i].label.name);
    return SS_OK;
}

/* Check that the scene has cycles.  Without forcing, a cycle begins with a stick, and another follows only
 * if something pulls. */
static ss_status
check_cycle(const ss_scene *scene, const ss_steady_opts *opts, const struct method *how, ss_error *err)
{
    int asks = opts->search == SS_SEARCH_SHOOT || (opts->measures & (FLOQUET | LYAPUNOV));
    if (scene->base_frequency > 0 && isfinite(1 / scene->base_frequency))
        return SS_OK;
    if (scene->base_frequency > 0)
        return ss_fail(err, SS_ERANGE, "base_frequency is too low: the time of a forcing cycle lies beyond "
                       "double precision");
    if (scene->base != NULL)
        return ss_fail(err, SS_EINVAL, "base_frequency is 0: there is no forcing cycle");
    if (scene->base_velocity == scene->surface_velocity)
        return ss_fail(err, SS_EINVAL, "base_frequency is 0 and base_velocity is surface_velocity: nothing "
                       "keeps it moving");
    if (opts->measures & MODEL_ERRORS)
        return ss_fail(err, SS_EINVAL, "base_frequency is 0: without forcing, two models have no common phase");
    if (!asks || ss_periodic_can_shoot(scene, how))
        return SS_OK;
    return ss_fail(err, SS_EINVAL, "base_frequency is 0: without forcing, shooting, multipliers and "
                   "exponents of model %s need method %s", scene->model->name, ss_method_for(scene, BEST)->name);
}

/* The rate at which the fastest growing difference from a steady slide grows; negative: it dies out. */
static ss_status
find_growth(const ss_scene *scene, double *growth)
{
    state m = ss_state_of(scene, 1);
    double d[MAX_DIM * MAX_DIM], by_time[MAX_DIM];
    gsl_complex value[MAX_DIM];
    m.model->equilibrium(&m);
    m.model->jacobian(&m, 0, m.q, d, by_time);
    ss_status st = ss_eigenvalues(d, value);
    *growth = GSL_REAL(value[0]);
    for (int i = 1; i < MAX_DIM; i++)
        *growth = fmax(*growth, GSL_REAL(value[i]));
    return st;
}

ss_status
ss_steady_find(ss_steady *out, const ss_scene *scene, const ss_steady_opts *given, ss_error *err)
{
    ss_steady_opts own, *opts = &own;
    if (out == NULL || scene == NULL)
        return SS_FAIL_NULL(err);
    double growth = NAN;
    ss_status limit = SS_OK, st = ss_options_take(&own, sizeof own, &usual, given, err);
    if (st != SS_OK)
        return st;
    if (opts->strobe > 0 && out->strobe == NULL)
        return SS_FAIL_NULL(err);
    for (int i = 0; i < SS_MEASURES; i++)
        out->value[i] = NAN;
    out->n_strobes = 0;
    st = ss_scene_check(scene, err);
    if (st == SS_OK)
        st = ss_steady_check(opts, scene, err);
    if (st != SS_OK)
        return st;
    finder f = { .c = { .scene = scene, .opts = opts, .err = err, .how = method_of(opts, scene) }, .out = out };
    st = check_cycle(scene, opts, f.c.how, err);
    if (st == SS_OK && (opts->measures & 1u << SS_GROWTH) && find_growth(scene, &growth) != SS_OK)
        st = ss_fail_memory(err, NULL);
    out->value[SS_GROWTH] = growth;
    if (st != SS_OK || opts->measures == 1u << SS_GROWTH)
        return st;
    st = ss_periodic_find(&f);
    if (st == SS_OK && (opts->measures & MODEL_ERRORS) && out->value[SS_PERIOD] > 0)
        limit = compare_with_limit(&f);
    ss_periodic_free(&f);
    for (int i = 0; i < SS_MEASURES; i++)
        if (st != SS_OK || !(opts->measures & 1u << i)
            || !(isfinite(out->value[i]) || (i == SS_LYAPUNOV && out->value[i] < 0)))
            out->value[i] = i == SS_PERIOD && st == SS_OK ? out->value[i] : NAN;
    out->value[SS_GROWTH] = growth;
    if (limit != SS_OK)
        return limit == SS_ENOMEM ? ss_fail_memory(err, NULL) : SS_EDATA;
    return st == SS_OK ? check_complete(&f) : st;
}
