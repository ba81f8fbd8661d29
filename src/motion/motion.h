/* motion.h -- the state of a scene as it moves in time. */
#ifndef MOTION_H
#define MOTION_H

#include "motion/instant.h"
#include "scene/model.h"

typedef struct motion {
    state now;                      /* at the start of the present step */
    instant origin;                 /* now.u, the time within a mode, counts from here */
    double phase;                   /* of the base at t = 0, in [-pi, pi] */
    double doubt;                   /* the error of x in a step by tolerance or rounding [m] */
    double x_begin;                 /* the position at which the mode began */
    unsigned long unresolved;       /* slips no longer than doubt */
} motion;

/* Steps per period of the mode's fastest motion.  With 40, the terms that rk8pd neglects are below
 * (2 pi / 40)^9 / 9! = 2e-13 of the change in a step, and a short Taylor series gives
 * the state inside a step of a linear mode (engine.c). */
enum { STEPS_PER_PERIOD = 40 };

double ss_step_cap(const state *m);                 /* the longest step in the mode */

/* The shortest step that double precision can resolve. */
double ss_step_floor(const state *m);
/* The scales of the parts of the state: absolute tolerances are tol times these.  SS_ERANGE if
 * such a tolerance is not above 0. */
ss_status ss_motion_scales(const state *m, double tol, double scale[MAX_DIM], ss_error *err);

/* The part of the tolerance that steps of a state of logarithms may take, of what rounding leaves; what is read
 * within them may take all: beside an unstable steady slide the motion is a small part of an e-fold, which grows. */
double ss_motion_finer(double tol);

/* The tolerances are relative to these, times the tolerance, and this part of the state's size: the tolerance
 * itself, unless the state is logarithms, of which a difference counts however large they are. */
double ss_motion_relative(const state *m, double tol);

/* The motion at t = 0, before its first mode; exact is 1 if a closed form moves it. */
motion ss_motion_of(const ss_scene *scene, int exact, double tol);
int ss_motion_start(motion *m);                     /* enter the first mode; 1 if that is slip */
void ss_motion_rebase(motion *m);                   /* let u count from the present step */
turn ss_motion_base(const motion *m, instant t);    /* the phase of the base */
double ss_motion_x(const motion *m);                /* now, at u = 0 */
unsigned long ss_motion_unresolved(const motion *m);    /* see ss_sim_stats */
/* 1 if damping has made a slip so slow that the error of x hides its end. */
int ss_motion_fades(const motion *m);
/* Call after a mode that has lasted so long [s].  SS_ECHATTER: too many short modes in a row. */
ss_status ss_motion_chatters(const motion *m, double lasted, int *in_a_row, ss_error *err);

/* Fill in a sample, except its time, from state, rate of change and phase of the base at u. */
static inline void
motion_sample(const motion *m, turn base, double u, const double q[], const double dqdt[],
              ss_sample *s)
{
    const state *now = &m->now;
    const ss_scene *scene = now->scene;
    double force = base_force_by(now, base, u);
    now->model->sample(now, force, q, dqdt, s);
    s->s = force - scene->stiffness * s->x;
    s->z = scene->base_amplitude * base.co;
    if (!now->moves)
        return;
    s->s += now->drag;
    double pulled = scene->base_velocity * m->origin.hi;
    s->x += pulled + (now->model->from_pull ? scene->base_velocity : scene->surface_velocity) * u;
    s->v += scene->surface_velocity;
    s->z += pulled + scene->base_velocity * u + (scene->base != NULL ? measured_base(now, u) : 0);
}

#endif
