/* motion.c -- a motion in time: its clock, the limit of its steps, its first mode, and chatter. */
#include "motion/motion.h"

#include <float.h>
#include "base/error.h"

double
ss_step_cap(const state *m)
{
    return 2 * M_PI / (STEPS_PER_PERIOD * m->model->fastest(m, NULL));
}

/* The shortest step, as a part of the longest and of the friction's own time.  The first step of a method
 * of order 1 at a tolerance of 1e-14 is about 1e-7 of these. */
#define STEP_FLOOR 1e-12

double
ss_step_floor(const state *m)
{
    double floor = STEP_FLOOR * ss_step_cap(m);
    if (m->model->quickest != NULL)
        floor = fmin(floor, STEP_FLOOR / m->model->quickest(m->scene));
    return fmax(floor, DBL_MIN);            /* above 0: a search for a step must end */
}

/* The scale of x is the scene's, about 1e-4 m; that of v is this times the larger of Omega and omega_n;
 * the model gives that of its third number. */
ss_status
ss_motion_scales(const state *m, double tol, double scale[MAX_DIM], ss_error *err)
{
    double memory = 0;
    if (m->model->memory != NULL)
        m->model->memory(m, &memory);
    scale[0] = m->x_scale > 0 ? m->x_scale : 1;     /* 1 where nothing moves */
    scale[1] = scale[0] * fmax(m->omega, own_frequency(m->scene));
    scale[2] = memory > 0 ? memory : 1;
    if (m->model->scales != NULL)
        m->model->scales(m, scale);
    for (size_t i = 0; i < MAX_DIM && m->model->scales != NULL; i++)
        scale[i] *= ss_motion_finer(tol);
    for (size_t i = 0; i < m->model->dim; i++)
        if (!(isfinite(scale[i]) && tol * scale[i] > 0))
            return ss_fail(err, SS_ERANGE, "amplitudes of this scene lie beyond double precision");
    return SS_OK;
}

double
ss_motion_finer(double tol)
{
    return fmax(1e-3, 8 * DBL_EPSILON / tol);
}

/* Logarithms as large as 100 keep the tolerance, as far as rounding lets them. */
double
ss_motion_relative(const state *m, double tol)
{
    return m->model->scales != NULL ? fmax(tol / 100, 32 * DBL_EPSILON) : tol;
}

/* Let u count from the start of the present step, and positions from where the pulled end of the spring
 * is then; the phase becomes the present one. */
void
ss_motion_rebase(motion *m)
{
    state *now = &m->now;
    if (now->ramp != 0) {
        m->x_begin -= pull_of(now->scene) * now->u;
        ss_state_follow(now);
    }
    m->origin = instant_add(m->origin, now->u);
    now->u = 0;
    now->theta = 2 * M_PI * instant_cycles(m->origin, now->scene->base_frequency) + m->phase;
    if (now->scene->base != NULL)
        ss_state_meet_base(now, m->origin.hi + m->origin.lo);
}

/* The rounding error of x in closed form: an ulp for each of its four terms. */
#define EXACT_DOUBT (4 * DBL_EPSILON)

motion
ss_motion_of(const ss_scene *scene, int exact, double tol)
{
    motion m = { .now = ss_state_of(scene, exact ? EXACT_DOUBT : tol) };
    m.phase = m.now.theta;
    m.doubt = m.now.x_scale * m.now.tol;
    return m;
}

int
ss_motion_start(motion *m)
{
    int slips = m->now.model->start(&m->now);
    m->x_begin = m->now.x_ref + m->now.q[0];
    return slips;
}

unsigned long
ss_motion_unresolved(const motion *m)
{
    return m->unresolved + m->now.touches;
}

int
ss_motion_fades(const motion *m)
{
    const state *now = &m->now;
    double rates[MAX_DIM], fastest = now->model->fastest(now, NULL);
    if (!ss_model_has_events(now->model) || now->mode == 0)
        return 0;
    now->model->rates(now, base_force(now, now->u), now->q, rates);
    return fmax(fabs(now->q[1]), fabs(rates[1]) / fastest) <= m->doubt * fastest;
}

turn
ss_motion_base(const motion *m, instant t)
{
    return turn_of(2 * M_PI * instant_cycles(t, m->now.scene->base_frequency) + m->phase);
}

double
ss_motion_x(const motion *m)
{
    return m->now.x_ref + m->now.q[0] + m->now.scene->base_velocity * m->origin.hi;
}

/* So many events in a row, each so soon after the one before in units of the fastest period, are chatter:
 * the rounding of one grazing contact, and no motion. */
enum { CHATTER_EVENTS = 1000 };
#define CHATTER_PART 1e-6

ss_status
ss_motion_chatters(const motion *m, double lasted, int *in_a_row, ss_error *err)
{
    if (m->now.over != NULL)
        return ss_fail(err, SS_EDATA, "%s: the motion ends at t = %.9g s", m->now.over, m->origin.hi);
    double period = 2 * M_PI / m->now.model->fastest(&m->now, NULL);
    *in_a_row = lasted > CHATTER_PART * period ? 0 : *in_a_row + 1;
    if (*in_a_row <= CHATTER_EVENTS)
        return SS_OK;
    return ss_fail(err, SS_ECHATTER, "more than %d events in a row at t = %.9g s, each within "
                   "%.2g s of the last: the contact grazes its limit", CHATTER_EVENTS,
                   m->origin.hi, CHATTER_PART * period);
}
