/* cost_cvode.c -- the paper's scenes with CVODE and its root finding: Adams and BDF.
 *
 * Written as CVODE's manual advises: one root function a mode, with its direction; steps free of the
 * samples, which are interpolated; after a root a new start in the next mode; absolute tolerances by
 * the scale of each state.  Only a Coulomb stick, in which nothing moves, gets a step cap: without
 * one CVODE sleeps through its end.  cost_cvode SECONDS prints rows as in bench.h. */
#include <math.h>
#include <stdlib.h>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "bench.h"

typedef struct motion {
    const ss_scene *s;
    double alpha, gamma, K_y, c;    /* of its model */
    int mode;                   /* 0 stick or microstick, else the sign of the slip */
    double x_stop, y_stop;      /* microstick: y = y_stop + x - x_stop */
} motion;

static double
drive(const ss_scene *s, double t)
{
    return s->stiffness * s->base_amplitude * cos(2 * M_PI * s->base_frequency * t + s->phase);
}

static double
friction(const motion *m, double x, double v)
{
    if (m->mode != 0)
        return m->mode * m->s->friction;
    return m->K_y * (m->y_stop + x - m->x_stop) + m->c * v;
}

static int
rhs(double t, N_Vector state, N_Vector rate, void *user)
{
    const motion *m = user;
    const ss_scene *s = m->s;
    const double *q = NV_DATA_S(state);
    double *d = NV_DATA_S(rate);
    d[0] = q[1];
    if (s->model == ss_model_named("state-variable")) {
        d[1] = (drive(s, t) - s->stiffness * q[0] - q[2]) / s->mass;
        d[2] = -m->gamma * (q[2] - s->friction * tanh(m->alpha * q[1]));
    } else if (s->model == ss_model_named("coulomb") && m->mode == 0) {
        d[0] = d[1] = 0;
    } else {
        d[1] = (drive(s, t) - s->stiffness * q[0] - friction(m, q[0], q[1])) / s->mass;
    }
    return 0;
}

static int
jacobian(double t, N_Vector state, N_Vector rate, SUNMatrix J, void *user, N_Vector a, N_Vector b,
         N_Vector c)
{
    const motion *m = user;
    const ss_scene *s = m->s;
    (void)t, (void)rate, (void)a, (void)b, (void)c;     /* J is zero on entry */
    if (s->model == ss_model_named("coulomb") && m->mode == 0)
        return 0;
    SM_ELEMENT_D(J, 0, 1) = 1;
    SM_ELEMENT_D(J, 1, 0) = -s->stiffness / s->mass;
    if (s->model == ss_model_named("state-variable")) {
        double sech = 1 / cosh(m->alpha * NV_DATA_S(state)[1]);
        SM_ELEMENT_D(J, 1, 2) = -1 / s->mass;
        SM_ELEMENT_D(J, 2, 1) = m->gamma * s->friction * m->alpha * sech * sech;
        SM_ELEMENT_D(J, 2, 2) = -m->gamma;
    } else if (m->mode == 0) {
        SM_ELEMENT_D(J, 1, 0) -= m->K_y / s->mass;
        SM_ELEMENT_D(J, 1, 1) = -m->c / s->mass;
    }
    return 0;
}

/* Crosses 0 downwards where the mode ends. */
static int
guard(double t, N_Vector state, double *g, void *user)
{
    const motion *m = user;
    const ss_scene *s = m->s;
    const double *q = NV_DATA_S(state);
    if (m->mode != 0)
        *g = m->mode * q[1];
    else if (s->model == ss_model_named("coulomb"))
        *g = s->friction - fabs(drive(s, t) - s->stiffness * q[0]);
    else
        *g = s->friction - m->K_y * fabs(m->y_stop + q[0] - m->x_stop);
    return 0;
}

/* The mode that follows at t; a start at rest comes here with mode 0 and x_stop = NAN. */
static void
next_mode(motion *m, double t, double *q)
{
    const ss_scene *s = m->s;
    double force = drive(s, t) - s->stiffness * q[0];
    if (s->model == ss_model_named("coulomb")) {
        int stuck = m->mode == 0 && !isnan(m->x_stop);
        m->mode = !stuck && fabs(force) <= s->friction ? 0 : force > 0 ? 1 : -1;
        q[1] = 0;
        m->x_stop = q[0];
    } else if (m->mode == 0 && !isnan(m->x_stop)) {
        m->mode = q[1] > 0 ? 1 : -1;
    } else {
        m->y_stop = m->mode * s->friction / m->K_y;
        m->x_stop = q[0];
        m->mode = 0;
        q[1] = 0;
    }
}

/* Whether it ran through; x of each sample and the events' number are filled. */
static int
simulate(const ss_scene *s, int lmm, double tol, double *x, size_t *events)
{
    SUNContext context;
    size_t n = ss_scene_samples(s), dim = s->model == ss_model_named("state-variable") ? 3 : 2;
    motion m = { .s = s, .x_stop = NAN,
                 .alpha = ss_scene_get(s, "alpha"), .gamma = ss_scene_get(s, "gamma"),
                 .K_y = ss_scene_get(s, "contact_stiffness"), .c = ss_scene_get(s, "contact_damping") };
    int direction = -1, failed = 0;
    double z = s->base_amplitude, omega = 2 * M_PI * s->base_frequency, t = 0;
    const double scale[3] = { z, z * omega, s->friction };

    SUNContext_Create(NULL, &context);
    N_Vector q = N_VNew_Serial((sunindextype)dim, context), abstol = N_VClone(q);
    SUNMatrix J = SUNDenseMatrix((sunindextype)dim, (sunindextype)dim, context);
    SUNLinearSolver linear = SUNLinSol_Dense(q, J, context);
    SUNNonlinearSolver fixed = SUNNonlinSol_FixedPoint(q, 0, context);
    void *cvode = CVodeCreate(lmm, context);
    *events = 0;
    for (size_t i = 0; i < dim; i++) {
        NV_DATA_S(q)[i] = 0;
        NV_DATA_S(abstol)[i] = tol * scale[i];
    }
    if (s->model != ss_model_named("state-variable")) {
        next_mode(&m, 0, NV_DATA_S(q));
        *events += m.mode != 0;
    }
    failed |= CVodeInit(cvode, rhs, 0, q);
    failed |= CVodeSVtolerances(cvode, tol, abstol);
    failed |= CVodeSetUserData(cvode, &m);
    failed |= CVodeSetMaxNumSteps(cvode, -1);
    if (lmm == CV_ADAMS) {
        failed |= CVodeSetNonlinearSolver(cvode, fixed);
    } else {
        failed |= CVodeSetLinearSolver(cvode, linear, J);
        failed |= CVodeSetJacFn(cvode, jacobian);
    }
    if (s->model != ss_model_named("state-variable")) {
        failed |= CVodeRootInit(cvode, 1, guard);
        failed |= CVodeSetRootDirection(cvode, &direction);
        failed |= CVodeSetNoInactiveRootWarn(cvode);
    }
    x[0] = 0;
    for (size_t i = 1; i < n && !failed; i++) {
        double sample = (double)i / s->rate;
        int status;
        while ((status = CVode(cvode, sample, q, &t, CV_NORMAL)) == CV_ROOT_RETURN) {
            next_mode(&m, t, NV_DATA_S(q));
            ++*events;
            failed |= CVodeReInit(cvode, t, q);
            failed |= CVodeSetMaxStep(cvode, s->model == ss_model_named("coulomb") && m.mode == 0
                                      ? 2 * M_PI / omega / 40 : 0);
        }
        failed |= status < 0;
        x[i] = NV_DATA_S(q)[0];
    }
    CVodeFree(&cvode);
    SUNNonlinSolFree(fixed);
    SUNLinSolFree(linear);
    SUNMatDestroy(J);
    N_VDestroy(abstol);
    N_VDestroy(q);
    SUNContext_Free(&context);
    return !failed;
}

static void
row(const bench_scene *b, const char *method, int lmm, double tol)
{
    size_t events = 0, n = ss_scene_samples(&b->scene);
    double *x = bench_alloc(n), seconds[9];
    int repeats = b->scene.duration > 100 ? 1 : 5, ok = 1;
    for (int i = 0; i < repeats && ok; i++) {
        double began = bench_seconds();
        ok = simulate(&b->scene, lmm, tol, x, &events);
        seconds[i] = bench_seconds() - began;
    }
    if (ok)
        bench_row(b, method, tol, x, events, bench_median(seconds, repeats));
    free(x);
}

int
main(int argc, char *argv[])
{
    double duration = argc > 1 ? atof(argv[1]) : 10;
    for (const ss_shipped_scene *s = ss_shipped_scenes; s->name != NULL; s++) {
        bench_scene b = bench_scene_new(s, duration);
        for (double tol = 1e-4; tol > (duration > 100 ? 1e-11 : 1e-13); tol /= 100) {
            row(&b, "CVODE Adams", CV_ADAMS, tol);
            row(&b, "CVODE BDF", CV_BDF, tol);
        }
        bench_scene_free(&b);
    }
    return 0;
}
