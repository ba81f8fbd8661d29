/* ode.c -- a motion carried by a GSL odeiv2 stepper.
 *
 * One-step methods answer inside a step by stepping again from its start, since GSL has no dense
 * output.  Multistep methods have a memory that such a side step would spoil, so theirs are taken
 * with rk8pd: with the caps of sim.c it is at least as accurate there as the method itself.  Where
 * there is no cap (the state variable may be stiff) multistep methods land on every sample. */
#include "sim/engine.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <stdlib.h>
#include <string.h>
#include "error.h"

/* A step this much shorter than 1/40 of the fastest period means that the tolerance asks for more
 * digits than double precision has; a first-order start at 1e-14 needs about 1e-7. */
#define STEP_FLOOR 1e-12

typedef struct ode {
    engine base;
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver;              /* owns the main stepper and its error control */
    gsl_odeiv2_step *side;
    int multistep;
    double h_next;
    double error[MAX_DIM];
    double tol;
} ode;

static int
rhs(double u, const double q[], double dqdt[], void *params)
{
    ode *o = params;
    o->base.rhs++;
    return o->base.m->model->rhs(u, q, dqdt, o->base.m);
}

static int
jacobian(double u, const double q[], double *dfdq, double dfdt[], void *params)
{
    const ode *o = params;
    return o->base.m->model->jacobian(u, q, dfdq, dfdt, o->base.m);
}

static ss_status
ode_begin(engine *e)
{
    ode *o = (ode *)e;
    gsl_odeiv2_step_reset(o->driver->s);
    gsl_odeiv2_step_reset(o->side);
    rhs(e->m->u, e->m->q, e->dq0, o);
    return SS_OK;
}

static int
all_finite(const double q[], size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(q[i]))
            return 0;
    return 1;
}

/* Try steps of decreasing size from the start of the step until one keeps the tolerance. */
static ss_status
ode_step(engine *e, double h_max, ss_error *err)
{
    ode *o = (ode *)e;
    const motion *m = e->m;
    gsl_odeiv2_step *step = o->driver->s;
    size_t dim = o->system.dimension;
    double h = fmin(o->h_next, h_max), shortest = STEP_FLOOR * 2 * M_PI / (40 * m->model->fastest(m, NULL));

    for (;;) {
        double h_adjusted = h / 2;
        int verdict = GSL_ODEIV_HADJ_DEC;
        memcpy(e->q1, m->q, sizeof e->q1);
        int failed = gsl_odeiv2_step_apply(step, m->u, h, e->q1, o->error,
                                           step->type->can_use_dydt_in ? e->dq0 : NULL, e->dq1,
                                           &o->system);
        if (!failed && all_finite(e->q1, dim) && all_finite(o->error, dim)) {
            h_adjusted = h;
            verdict = gsl_odeiv2_control_hadjust(o->driver->c, step, e->q1, o->error, e->dq1,
                                                 &h_adjusted);
        }
        if (verdict != GSL_ODEIV_HADJ_DEC) {
            if (h >= o->h_next || h_adjusted > o->h_next)
                o->h_next = h_adjusted;     /* a step cut short by h_max says nothing */
            break;
        }
        if (!(h_adjusted >= shortest))
            return ss_fail(err, SS_ETOL, "%s cannot keep the tolerance %.3g at t = %.9g s: the "
                           "step fell below %.3g s", step->type->name, o->tol, m->origin.hi + m->u,
                           shortest);
        o->h_next = h = h_adjusted;
    }
    if (!step->type->gives_exact_dydt_out)
        rhs(m->u + h, e->q1, e->dq1, o);
    e->h = h;
    e->steps++;
    return SS_OK;
}

static void
ode_at(engine *e, double s, double q[], double dqdt[])
{
    ode *o = (ode *)e;
    double error[MAX_DIM];
    memcpy(q, s >= e->h ? e->q1 : e->m->q, sizeof e->q1);
    if (s > 0 && s < e->h)
        gsl_odeiv2_step_apply(o->side, e->m->u, s, q, error,
                              o->side->type->can_use_dydt_in ? e->dq0 : NULL, NULL, &o->system);
    rhs(e->m->u + s, q, dqdt, o);
}

static void
ode_accept(engine *e)
{
    motion *m = e->m;
    memcpy(m->q, e->q1, sizeof m->q);
    memcpy(e->dq0, e->dq1, sizeof e->dq0);
    m->u += e->h;
    if (!((ode *)e)->multistep)             /* GSL's multistep methods must see time go on */
        motion_rebase(m);
}

static void
ode_free(engine *e)
{
    ode *o = (ode *)e;
    if (o->driver != NULL)
        gsl_odeiv2_driver_free(o->driver);
    if (o->side != NULL)
        gsl_odeiv2_step_free(o->side);
    free(o);
}

static const struct engine_type ode_type = {
    .begin = ode_begin, .step = ode_step, .at = ode_at, .accept = ode_accept, .free = ode_free
};

/* GSL's methods; the address of each is known at run time only. */
static const struct { const char *name; const gsl_odeiv2_step_type **type; int multistep; }
method[] = {
    { "rk8pd", &gsl_odeiv2_step_rk8pd, 0 },
    { "rkf45", &gsl_odeiv2_step_rkf45, 0 },
    { "rkck", &gsl_odeiv2_step_rkck, 0 },
    { "rk4", &gsl_odeiv2_step_rk4, 0 },
    { "rk2", &gsl_odeiv2_step_rk2, 0 },
    { "rk1imp", &gsl_odeiv2_step_rk1imp, 0 },
    { "rk2imp", &gsl_odeiv2_step_rk2imp, 0 },
    { "rk4imp", &gsl_odeiv2_step_rk4imp, 0 },
    { "bsimp", &gsl_odeiv2_step_bsimp, 0 },
    { "msadams", &gsl_odeiv2_step_msadams, 1 },
    { "msbdf", &gsl_odeiv2_step_msbdf, 1 },
};
enum { METHODS = sizeof method / sizeof *method };

const char *
ode_method_name(size_t i)
{
    return i < METHODS ? method[i].name : NULL;
}

/* Absolute tolerances in the scene's own measure, since x is about 1e-4 m: x by the largest of
 * Z_e, |x0|, |v0| / omega_n and f_k / k, v by that times the larger of Omega and omega_n, theta
 * by f_k. */
static void
absolute_scales(const motion *m, double scale[MAX_DIM])
{
    const ss_scene *s = m->scene;
    double omega_n = sqrt(s->stiffness / s->mass);
    double x = fmax(fmax(s->base_amplitude, fabs(s->x0)),
                    fmax(fabs(s->v0) / omega_n, s->friction / s->stiffness));
    scale[0] = x > 0 ? x : 1;               /* nothing moves */
    scale[1] = scale[0] * fmax(m->omega, omega_n);
    scale[2] = s->friction > 0 ? s->friction : 1;
}

ss_status
ode_new(engine **out, motion *m, const ss_sim_opts *opts, ss_error *err)
{
    size_t i = 0;
    double scale[MAX_DIM];
    while (i < METHODS && strcmp(opts->method, method[i].name) != 0)
        i++;
    if (i == METHODS)
        return ss_fail(err, SS_EINVAL, "unknown method '%.32s'", opts->method);
    ode *o = calloc(1, sizeof *o);
    if (o == NULL)
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    o->base = (engine){ .type = &ode_type, .m = m,
                        .lands_on_samples = method[i].multistep && m->model->guard == NULL };
    o->system = (gsl_odeiv2_system){ rhs, jacobian, m->model->dim, o };
    o->multistep = method[i].multistep;
    o->tol = opts->tol;
    o->h_next = 2 * M_PI / (40 * m->model->fastest(m, NULL));
    absolute_scales(m, scale);
    o->driver = gsl_odeiv2_driver_alloc_scaled_new(&o->system, *method[i].type, o->h_next,
                                                   opts->tol, opts->tol, 1, 0, scale);
    o->side = gsl_odeiv2_step_alloc(o->multistep ? gsl_odeiv2_step_rk8pd : *method[i].type,
                                    m->model->dim);
    if (o->driver == NULL || o->side == NULL
        || gsl_odeiv2_step_set_driver(o->side, o->driver) != GSL_SUCCESS) {
        ode_free(&o->base);
        return ss_fail(err, SS_ENOMEM, "%s", ss_strerror(SS_ENOMEM));
    }
    *out = &o->base;
    return SS_OK;
}
