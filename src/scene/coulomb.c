/* coulomb.c -- f = f_k sgn(v) in slip; in stick v is exactly 0 and x does not change, until the
 * base has carried the spring's force k (z - x) beyond f_k. */
#include "scene/model.h"

#include <float.h>

static double
spring_force(const state *m, double drive, double x)
{
    return drive - m->scene->stiffness * x;
}

/* Enter stick if friction can hold the mass, else slip where the spring pulls it. */
static int
stop_or_go(state *m, double x)
{
    double force = spring_force(m, base_force(m, m->u), x);
    ss_linear_slip(m, x, 0, fabs(force) > m->scene->friction ? sign(force) : 0);
    return m->mode;
}

static int
start(state *m)
{
    const ss_scene *s = m->scene;
    if (s->v0 == 0)
        return stop_or_go(m, s->x0) != 0;
    ss_linear_slip(m, s->x0, s->v0, sign(s->v0));
    return 1;
}

/* The first angle after from that differs from angle by whole turns. */
static double
next_turn(double angle, double from)
{
    const double round = 2 * M_PI;
    double ahead = fmod(angle - from, round);
    return from + (ahead <= 0 ? ahead + round : ahead);
}

/* The end of a stick in closed form: k Z_e cos(theta) - k x leaves [-f_k, f_k] upwards where the
 * cosine rises, downwards where it falls.  Touching a limit is not leaving it.  A stick that
 * begins at its limit, within rounding, with the force on its way out, ends at once; without this
 * the crossing would be in the past, and the stick would last a whole turn. */
static int
still(const state *m, double *u_end)
{
    const ss_scene *s = m->scene;
    double x = m->q[0], z = s->base_amplitude, limit = s->friction;

    if (m->mode != 0)
        return 0;
    *u_end = INFINITY;
    if (m->omega == 0 || z == 0)
        return 1;
    double theta = m->theta + m->omega * m->u, force = spring_force(m, base_force(m, m->u), x);
    if (force * base_force_rate(m, m->u) > 0
        && limit - fabs(force) <= 8 * DBL_EPSILON * (m->drive + s->stiffness * fabs(x) + limit)) {
        *u_end = m->u;
        return 1;
    }
    double upper = (x + limit / s->stiffness) / z, lower = (x - limit / s->stiffness) / z;
    if (fabs(upper) < 1)
        *u_end = m->u + (next_turn(-acos(upper), theta) - theta) / m->omega;
    if (fabs(lower) < 1)
        *u_end = fmin(*u_end, m->u + (next_turn(acos(lower), theta) - theta) / m->omega);
    return 1;
}

static int
next(state *m, ss_event *e)
{
    double x = m->q[0];
    int before = m->mode;
    if (before == 0) {                  /* the force has reached its limit and grows */
        ss_linear_slip(m, x, 0, sign(base_force_rate(m, m->u)));
        e->kind = SS_SLIP;
        e->direction = m->mode;
        return 1;
    }
    int now = stop_or_go(m, x);
    e->kind = now == 0 ? SS_STICK : SS_REVERSE;
    e->direction = now == 0 ? before : now;
    return now != before;               /* else v has touched 0 and keeps its sign */
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    int still = m->mode == 0;
    s->x = q[0];
    s->v = q[1];
    s->a = still ? 0 : dqdt[1];
    s->f = still ? spring_force(m, drive, q[0]) : m->f0;
    s->y = 0;
    s->mode = m->mode;
}

static void
free_differences(const state *m, int is_free[D_MOST])
{
    is_free[D_REF] = 0;
    is_free[D_Q] = 1;
    is_free[D_V] = m->mode != 0;
}

/* A stick forgets v and the time at which it began, so its end changes nothing. */
static void
cross(const state *m, int mode, const double q[], const double before[], const double after[],
      double d[D_MOST][D_MOST])
{
    (void)q;
    for (int i = 0; i < D_MOST && mode != 0; i++)
        d[D_V][i] *= m->mode == 0 ? 0 : after[1] / before[1];
}

static int
move(state *m, const double d[D_MOST])
{
    double rates[MAX_DIM], slope;
    m->q[0] += d[D_Q];
    m->q[1] += d[D_V];
    double drive = base_force(m, m->u);
    if (m->mode == 0)
        return fabs(spring_force(m, drive, m->q[0])) <= m->scene->friction;
    ss_linear_rates(m, drive, m->q, rates);
    return ss_linear_slip_guard(m, m->q, rates, &slope) > 0;
}

static const struct variation variation = { free_differences, cross, move };

const struct model ss_coulomb_model = {
    .name = "coulomb", .dim = 2, .linear = 1,
    .start = start, .fastest = ss_linear_fastest, .rates = ss_linear_rates,
    .jacobian = ss_linear_jacobian, .derivatives = ss_linear_derivatives,
    .guard = ss_linear_slip_guard, .still = still, .next = next, .sample = sample,
    .variation = &variation
};
