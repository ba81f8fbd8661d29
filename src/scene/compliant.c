/* compliant.c -- Coulomb friction through a massless contact of stiffness K_y and damping c.
 *
 * In slip the contact is deflected by Y_m = f_k / K_y; when v reaches 0 at x = X_s, microstick
 * begins with y = Y_m sgn(v before) + x - X_s and f = K_y y + c y'.  In microstick the state is y,
 * not x: a stiff contact has Y_m far below x, and x - X_s would cancel its digits away. */
#include "scene/model.h"

static double
deflection_limit(const motion *m)
{
    return m->scene->friction / m->scene->contact_stiffness;
}

static void
microstick(motion *m, double x, double y)
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
start_free(motion *m)
{
    double x = m->scene->x0, force = ss_motion_drive(m, m->u) - m->scene->stiffness * x;
    int way = force != 0 ? sign(force) : -sign(m->drive * m->omega * sin(m->theta));
    ss_linear_slip(m, x, 0, way != 0 ? way : 1);
    return 1;
}

static int
start(motion *m)
{
    const ss_scene *s = m->scene;
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
guard(const motion *m, const double q[], const double dqdt[], double *slope)
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
excess(const motion *m)
{
    double rate[MAX_DIM], v = m->q[1];
    ss_linear_rates(m, ss_motion_drive(m, m->u), m->q, rate);
    if (!(rate[1] * sign(m->q[0]) < 0))
        return INFINITY;
    double rest = v / (2 * fabs(rate[1])) * v;      /* v^2 may underflow */
    return fabs(m->q[0]) - deflection_limit(m) + rest;
}

/* Whether a contact at its limit only touches it: m->slack and m->graze beyond it at most (run.c says
 * how much that is).  An undamped contact comes back to its limit exactly, each period, and whether
 * it is then released would be the rounding's decision.  What it is beyond is taken as such and
 * subtracted; stopping it at the limit would turn an error of d into one of sqrt(d). */
static int
only_touches(motion *m)
{
    const ss_scene *s = m->scene;
    if (s->release == SS_RELEASE_TOTAL && s->contact_damping > 0)
        return 0;
    double beyond = excess(m);
    if (!(beyond <= m->slack + m->graze))
        return 0;
    m->q[0] -= sign(m->q[0]) * beyond;
    m->slack = m->graze;                /* it passes its peak without being asked again */
    m->unresolved++;
    return 1;
}

static int
next(motion *m, ss_event *e)
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
sample(const motion *m, double drive, const double q[], const double dqdt[], ss_sample *s)
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
