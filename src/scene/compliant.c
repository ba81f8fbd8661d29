/* compliant.c -- Coulomb friction through a massless contact of stiffness K_y and damping c.
 *
 * In slip the contact is deflected by Y_m = f_k / K_y; when v reaches 0 at x = X_s, microstick
 * begins with y = Y_m sgn(v before) + x - X_s and f = K_y y + c y'.  In microstick the state is y,
 * not x: a stiff contact has Y_m far below x, and x - X_s would cancel its digits away. */
#include "scene/model.h"

static double
deflection_limit(const state *m)
{
    return m->scene->friction / m->scene->contact_stiffness;
}

static void
microstick(state *m, double x, double y)
{
    const ss_scene *s = m->scene;
    m->mode = 0;
    m->k = s->stiffness + s->contact_stiffness;
    m->c = s->contact_damping;
    m->x_ref = x - y;
    m->f0 = s->stiffness * m->x_ref;
    m->slack = 0;
    m->q[0] = y;
    m->q[1] = 0;
}

/* Without friction there is nothing to stick to: the mass goes where it is pulled, or will be. */
static int
start_free(state *m)
{
    double x = m->scene->x0, force = base_force(m, m->u) - m->scene->stiffness * x;
    int way = force != 0 ? sign(force) : sign(base_force_rate(m, m->u));
    ss_linear_slip(m, x, 0, way != 0 ? way : 1);
    return 1;
}

/* What counts as touching the contact's limit: ten times the absolute tolerance of x, which is what
 * an integrator's error makes of the limit in the course of a stick; in units of the limit no less
 * than 1e-10, and no more than 1e-6, a hundredth of the excursion of the shortest micro-slips (2e-4
 * for one of 0.1 ms in the light scene). */
#define GRAZE_TOL 10
#define GRAZE_LEAST 1e-10
#define GRAZE_MOST 1e-6

static int
start(state *m)
{
    const ss_scene *s = m->scene;
    double limit = deflection_limit(m);
    m->graze = fmin(fmax(GRAZE_TOL * m->tol * m->x_scale, GRAZE_LEAST * limit), GRAZE_MOST * limit);
    if (s->v0 == 0 && s->friction == 0)
        return start_free(m);
    if (s->v0 == 0) {
        microstick(m, s->x0, 0);
        return 0;
    }
    ss_linear_slip(m, s->x0, s->v0, sign(s->v0));
    return 1;
}

/* Microstick lasts while the spring's force, or that of spring and damper, is within f_k. */
static double
guard(const state *m, const double q[], const double dqdt[], double *slope)
{
    if (m->mode != 0)
        return ss_linear_slip_guard(m, q, dqdt, slope);
    double limit = deflection_limit(m), ratio = m->scene->contact_damping
        / m->scene->contact_stiffness;
    if (m->scene->release == SS_RELEASE_SPRING)
        ratio = 0;
    double force = q[0] + ratio * q[1];         /* in units of K_y */
    *slope = -sign(force) * (dqdt[0] + ratio * dqdt[1]);
    return limit + m->slack - fabs(force);
}

/* How far beyond its limit a contact would go, v' as it is, before it turns round. */
static double
excess(const state *m)
{
    double rate[MAX_DIM], v = m->q[1];
    ss_linear_rates(m, base_force(m, m->u), m->q, rate);
    if (!(rate[1] * sign(m->q[0]) < 0))
        return INFINITY;
    double rest = v / (2 * fabs(rate[1])) * v;      /* v^2 may underflow */
    return fabs(m->q[0]) - deflection_limit(m) + rest;
}

/* Whether a contact at its limit only touches it: m->slack and m->graze beyond it at most.  An
 * undamped contact comes back to its limit exactly, each period, and whether it is then released
 * would be the rounding's decision.  What it is beyond is taken as such and subtracted; stopping it
 * at the limit would turn an error of d into one of sqrt(d). */
static int
only_touches(state *m)
{
    const ss_scene *s = m->scene;
    if (s->release == SS_RELEASE_TOTAL && s->contact_damping > 0)
        return 0;
    double beyond = excess(m);
    if (!(beyond <= m->slack + m->graze))
        return 0;
    m->q[0] -= sign(m->q[0]) * beyond;
    m->slack = m->graze;                /* it passes its peak without being asked again */
    m->touches++;
    return 1;
}

static int
next(state *m, ss_event *e)
{
    double x = m->x_ref + m->q[0], v = m->q[1];
    if (m->mode == 0 && only_touches(m))
        return 0;
    if (m->mode == 0) {
        ss_linear_slip(m, x, v, v != 0 ? sign(v) : sign(m->q[0]));
        e->kind = SS_SLIP;
        e->direction = m->mode;
    } else if (m->scene->friction == 0) {       /* nothing to stick to: v passes through 0 */
        ss_linear_slip(m, x, 0, -m->mode);
        e->kind = SS_REVERSE;
        e->direction = m->mode;
    } else {
        e->kind = SS_STICK;
        e->direction = m->mode;
        microstick(m, x, m->mode * deflection_limit(m));
    }
    return 1;
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    (void)drive;
    s->x = m->x_ref + q[0];
    s->v = q[1];
    s->a = dqdt[1];
    s->mode = m->mode;
    s->y = m->mode == 0 ? q[0] : m->mode * deflection_limit(m);
    s->f = m->mode == 0 ? m->scene->contact_stiffness * q[0] + m->scene->contact_damping * q[1]
        : m->f0;
}

const struct model ss_compliant_model = {
    .dim = 2, .start = start, .fastest = ss_linear_fastest, .rates = ss_linear_rates,
    .jacobian = ss_linear_jacobian, .derivatives = ss_linear_derivatives, .guard = guard,
    .next = next,
    .sample = sample
};
