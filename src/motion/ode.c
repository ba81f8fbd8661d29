/* ode.c -- a motion carried by a GSL odeiv2 stepper.
 *
 * GSL cannot give the state inside a step.  In a linear mode this is the Taylor series from the start of the
 * step, whose error is less than rounding, whatever the method.
 *
 * For other models, such as stiff ones without this cap, one-step methods step again from the
 * start of the step.  A multistep method would lose its memory by this, so it steps to every
 * sample. */
#include "motion/method.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <string.h>
#include "base/error.h"

/* Beyond this way of the pull, in units of the scale of x, x - U t would lose digits. */
#define FAR 1e3

typedef struct ode {
    engine base;
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver;              /* owns the main stepper and its error control */
    gsl_odeiv2_step *side;                  /* NULL if not needed */
    double zero[MAX_DIM];                   /* GSL sees this in place of a y of 0 */
} ode;

static void
rates(ode *o, double u, const double q[], double dqdt[])
{
    const state *m = &o->base.m->now;
    o->base.rhs++;
    m->model->rates(m, base_force(m, u), q, dqdt);
}

/* GSL sees y = q / unit.  Implicit methods solve equations in which x, v and theta stand side by side.  In m, m/s
 * and N they can be 1e20 apart, and the solution would be nothing but rounding. */
static void
to_units(const ode *o, const double q[], double y[])
{
    for (size_t i = 0; i < o->system.dimension; i++)
        y[i] = q[i] / o->base.unit[i];
}

static void
from_units(const ode *o, const double y[], double q[])
{
    for (size_t i = 0; i < o->system.dimension; i++)
        q[i] = y[i] * o->base.unit[i];
}

/* Most of the time of a run goes into this function. */
static int
rhs(double u, const double y[], double dydt[], void *params)
{
    ode *o = params;
    double q[MAX_DIM], dqdt[MAX_DIM];
    from_units(o, y, q);
    rates(o, u, q, dqdt);
    to_units(o, dqdt, dydt);
    return GSL_SUCCESS;
}

static int
jacobian(double u, const double y[], double *dfdy, double dfdt[], void *params)
{
    const ode *o = params;
    size_t n = o->system.dimension;
    double q[MAX_DIM] = { 0 };
    from_units(o, y, q);
    o->base.m->now.model->jacobian(&o->base.m->now, u, q, dfdy, dfdt);
    to_units(o, dfdt, dfdt);
    for (size_t i = 0; i < n * n; i++)
        dfdy[i] *= o->base.unit[i % n] / o->base.unit[i / n];
    return GSL_SUCCESS;
}

static void
ode_begin(engine *e)
{
    ode *o = (ode *)e;
    gsl_odeiv2_step_reset(o->driver->s);
    if (o->side != NULL)
        gsl_odeiv2_step_reset(o->side);
    ss_engine_begin_steps(e);
}

static int
all_finite(const double q[], size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(q[i]))
            return 0;
    return 1;
}

/* GSL's bsimp gives up a step over which a part of the state grows 300-fold, and it treats 0 as 1.  So a
 * part that is 0 is replaced by BSIMP_ZERO times its scale, which is X, omega_n X or f_k: each of them
 * moves x by no more than BSIMP_ZERO X.  (Omega X as the scale of v moved x by 1e-11 X where Omega was a
 * thousand times omega_n.)  The numbers have the sign of the motion, so that a scene and its mirror image
 * move alike.  v' is at most omega_n^2 X, so v grows 300-fold in 300 BSIMP_ZERO / omega_n or more: the
 * first step is longer than the shortest allowed.  Linear modes start with steps long enough to need no such
 * replacement; but where a step ends just before its mode, what is left of v is rounding, so that a part that is
 * nearer to 0 is replaced by 0. */
#define BSIMP_ZERO 0x1p-46

/* One step over h from q, s after the start of the present step, in the units for GSL.  dydt, unless it is NULL,
 * becomes the rate of change at its end if the method knows it.  Returns 1 if its end is finite. */
static int
apply(ode *o, gsl_odeiv2_step *step, double s, const double q[], const double dqdt[], double h, double y[],
      double error[], double dydt[])
{
    double dydt_in[MAX_DIM], v = q[1] != 0 ? q[1] : dqdt[1];
    size_t dim = o->system.dimension;
    to_units(o, q, y);
    to_units(o, dqdt, dydt_in);
    const int is_linear = o->base.m->now.model->linear;
    for (size_t i = 0; i < dim; i++)
        if (is_linear ? fabs(y[i]) < o->zero[i] : y[i] == 0)
            y[i] = is_linear ? 0 : copysign(o->zero[i], v);
    int st = gsl_odeiv2_step_apply(step, o->base.m->now.u + s, h, y, error,
                                   step->type->can_use_dydt_in ? dydt_in : NULL, dydt, &o->system);
    return st == GSL_SUCCESS && all_finite(y, dim) && all_finite(error, dim);
}

/* Try steps of decreasing size from the start of the step until one keeps the tolerance. */
static ss_status
ode_step(engine *e, double h_max, ss_error *err)
{
    ode *o = (ode *)e;
    const state *m = &e->m->now;
    gsl_odeiv2_step *step = o->driver->s;
    size_t dim = o->system.dimension;
    double y[MAX_DIM], dydt[MAX_DIM], error[MAX_DIM];

    if (m->model->sight != NULL)
        h_max = fmin(h_max, m->model->sight(m, e->dq0));
    double h = fmin(e->next, h_max);
    if (!(h > 0))
        return ss_fail(err, SS_ERANGE, "no step from t = %.9g s is short enough: rates of change lie "
                       "beyond double precision", e->m->origin.hi + m->u);
    for (;;) {
        double h_adjusted = h / 2;
        int verdict = GSL_ODEIV_HADJ_DEC;
        if (apply(o, step, 0, m->q, e->dq0, h, y, error, dydt)) {
            h_adjusted = h;
            verdict = gsl_odeiv2_control_hadjust(o->driver->c, step, y, error, dydt, &h_adjusted);
        }
        if (verdict != GSL_ODEIV_HADJ_DEC) {
            from_units(o, y, e->q1);
            if (step->type->gives_exact_dydt_out)
                from_units(o, dydt, e->dq1);
            else
                rates(o, m->u + h, e->q1, e->dq1);
            if (h >= e->next || h_adjusted > e->next)
                e->next = h_adjusted;       /* one cut short by h_max does not show the next length */
            if (all_finite(e->dq1, dim))
                break;
            h_adjusted = h / 2;
        }
        if (!(h_adjusted >= e->shortest))
            return ss_engine_fail_short(e, err);
        e->next = h = h_adjusted;
    }
    e->h = h;
    e->steps++;
    return SS_OK;
}

/* The state at s by a step of its own, or by shorter ones where it fails. */
static void
step_to(ode *o, double s, double q[])
{
    const engine *e = &o->base;
    double y[MAX_DIM], error[MAX_DIM], dqdt[MAX_DIM], h = s;
    memcpy(q, e->m->now.q, sizeof e->q1);
    memcpy(dqdt, e->dq0, sizeof dqdt);
    for (double at = 0; at < s && h > e->shortest;) {
        if (!apply(o, o->side, at, q, dqdt, fmin(h, s - at), y, error, NULL)) {
            h /= 2;
            continue;
        }
        at += fmin(h, s - at);
        from_units(o, y, q);
        if (at < s)
            rates(o, e->m->now.u + at, q, dqdt);
    }
}

static void
ode_at(engine *e, reading where, double s, turn base, double q[], double dqdt[])
{
    ode *o = (ode *)e;
    const state *m = &e->m->now;
    (void)where;
    int inside = s > 0 && s < e->h && !e->lands_on_samples;
    if (inside && o->side != NULL) {
        step_to(o, s, q);
    } else if (inside) {
        ss_engine_expand(e);
        ss_series_at(&e->series, s, q, dqdt);
    } else {
        memcpy(q, s > e->h / 2 ? e->q1 : m->q, sizeof e->q1);
    }
    e->rhs++;
    m->model->rates(m, base_force_by(m, base, m->u + s), q, dqdt);
}

/* GSL's multistep methods need a time that goes on; they begin anew where a pull has gone far. */
static void
ode_go_on(engine *e)
{
    const state *m = &e->m->now;
    if (e->how->kind != MULTISTEP) {
        ss_motion_rebase(e->m);
    } else if ((m->scene->base != NULL && m->u >= m->u_knot)
               || fabs(m->ramp * m->u) > FAR * m->scene->stiffness * m->x_scale) {
        ss_motion_rebase(e->m);
        e->type->begin(e);
    }
}

static void
ode_release(engine *e)
{
    ode *o = (ode *)e;
    if (o->driver != NULL)
        gsl_odeiv2_driver_free(o->driver);
    if (o->side != NULL)
        gsl_odeiv2_step_free(o->side);
}

/* GSL's methods, which know their names.  The linker knows their addresses only at run time, so this is a
 * table of pointers to them. */
static const gsl_odeiv2_step_type **const steppers[] = {
    &gsl_odeiv2_step_rk8pd, &gsl_odeiv2_step_rkf45, &gsl_odeiv2_step_rkck, &gsl_odeiv2_step_rk4,
    &gsl_odeiv2_step_rk2, &gsl_odeiv2_step_rk1imp, &gsl_odeiv2_step_rk2imp, &gsl_odeiv2_step_rk4imp,
    &gsl_odeiv2_step_bsimp, &gsl_odeiv2_step_msadams, &gsl_odeiv2_step_msbdf,
};
enum { STEPPERS = sizeof steppers / sizeof *steppers };

static void
set_zeros(ode *o)
{
    const state *m = &o->base.m->now;
    double omega_n = own_frequency(m->scene), memory = 0;
    if (m->model->memory != NULL)
        m->model->memory(m, &memory);
    o->zero[0] = BSIMP_ZERO * (m->x_scale / o->base.unit[0]);
    o->zero[1] = BSIMP_ZERO * (m->x_scale * omega_n / o->base.unit[1]);
    o->zero[2] = BSIMP_ZERO * (memory / o->base.unit[2]);
}

static ss_status
ode_make(engine *e, ss_error *err)
{
    ode *o = (ode *)e;
    const state *m = &e->m->now;
    size_t i = 0;
    double scale[MAX_DIM];
    while (i < STEPPERS && strcmp(e->how->name, (*steppers[i])->name) != 0)
        i++;
    if (i == STEPPERS)
        return ss_fail(err, SS_EINVAL, "GSL has no stepper '%s'", e->how->name);
    const gsl_odeiv2_step_type *type = *steppers[i];
    int multistep = e->how->kind == MULTISTEP, sides = !m->model->linear && !multistep;
    e->lands_on_samples = multistep && m->model->next == NULL;
    o->system = (gsl_odeiv2_system){ rhs, jacobian, m->model->dim, o };
    for (size_t k = 0; k < m->model->dim; k++)
        scale[k] = e->scale[k] / e->unit[k];
    if (type == gsl_odeiv2_step_bsimp && m->x_scale > 0 && m->model->scales == NULL)
        set_zeros(o);
    o->driver = gsl_odeiv2_driver_alloc_scaled_new(&o->system, type, e->next,
                                                   e->tol, ss_motion_relative(m, e->tol), 1, 0, scale);
    if (sides)
        o->side = gsl_odeiv2_step_alloc(type, m->model->dim);
    int made = o->driver != NULL && (!sides || o->side != NULL)
        && (!sides || gsl_odeiv2_step_set_driver(o->side, o->driver) == GSL_SUCCESS);
    return made ? SS_OK : ss_fail_memory(err, NULL);
}

const struct engine_type ss_ode_engine = {
    .size = sizeof(ode), .degree = CAPPED_DEGREE,
    .make = ode_make, .begin = ode_begin, .step = ode_step, .at = ode_at, .go_on = ode_go_on,
    .release = ode_release
};
