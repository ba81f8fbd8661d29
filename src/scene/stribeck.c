/* stribeck.c -- friction that falls with speed, f = sgn(v) (f_k + (f_s - f_k) / (1 + |v| / v_s)) in
 * slip; true stick (stick.c). */
#include "scene/models.h"

enum { SPEED };                 /* v_s */

static const scene_key keys[] = {
    KEY_STATIC_FRICTION, KEYS_FRICTION_NEGATIVE,
    OWN_NUMBER("stribeck_velocity", SPEED, REQUIRED, POSITIVE, "m/s"),
};

static const ss_scene_range ranges[] = {
    { "v_s/(omega_n X)", "1", 1e-3, 1e3, 0, OWN_AT(SPEED), ss_unit_speed },
};

/* The part of f_s - f_k that remains at v. */
static double
part_at(const ss_scene *s, double v)
{
    return s->own[SPEED] / (s->own[SPEED] + fabs(v));
}

/* The friction in slip.  Its direction is that of the mode even where a step goes past v = 0, the end of
 * the slip. */
static double
friction_at(const state *m, double v)
{
    const ss_scene *s = m->scene;
    return m->mode * (s->friction + (static_friction(s) - s->friction) * part_at(s, v));
}

/* The derivative of the friction by v. */
static double
slope_at(const state *m, double v)
{
    const ss_scene *s = m->scene;
    double part = part_at(s, v), fall = static_friction(s) - s->friction;
    return -m->mode * sign(v) * fall * part * part / s->own[SPEED];
}

/* The rate at which v grows where the friction falls with speed. */
static double
quickest(const ss_scene *s)
{
    return (static_friction(s) - s->friction) / s->own[SPEED] / s->mass + own_frequency(s);
}

static void
rates(const state *m, double drive, const double q[], double dqdt[])
{
    dqdt[0] = q[1];
    dqdt[1] = (drive - friction_at(m, q[1]) - m->k * q[0] - m->c * q[1]) / m->scene->mass;
}

static void
jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    ss_linear_jacobian(m, u, q, dfdq, dfdt);
    dfdq[3] -= slope_at(m, q[1]) / m->scene->mass;
}

static double
sight(const state *m, const double dqdt[])
{
    double slope = slope_at(m, m->q[1]), front = m->scene->own[SPEED];
    return sight_of(m->q[1], front, dqdt[1], (base_force_rate(m, m->u) - m->k * dqdt[0]
                                              - (m->c + slope) * dqdt[1]) / m->scene->mass);
}

/* The coefficients of order n of p = 1 + |v| / v_s and of w = 1 / p, the part of f_s - f_k that remains. */
static void
next_fall(const state *m, const double c[], int n, double p[], double w[])
{
    p[n] = m->mode / m->scene->own[SPEED] * c[1] + (n == 0);
    w[n] = n == 0 ? 1 / p[0] : -w[0] * (w[0] * p[n] + inner_products(w, p, n));
}

static void
series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    enum { N = MOST_SERIES + 1 };
    const ss_scene *s = m->scene;
    double fall = m->mode * (static_friction(s) - s->friction), per_mass = 1 / s->mass;
    double force[N], w[N], p[N];
    base_force_series(m, step, order, force);
    force[0] -= m->f0;
    c[0][0] = m->q[0];
    c[0][1] = m->q[1];
    for (int n = 0; n < order; n++) {
        next_fall(m, c[n], n, p, w);
        c[n + 1][0] = step[n] * c[n][1];
        double a = per_mass * (force[n] - fall * w[n] - m->k * c[n][0] - m->c * c[n][1]);
        c[n + 1][1] = step[n] * a;
        c[n][MAX_DIM] = a;
    }
}

/* The derivative of f by v is -(f_s - f_k) w^2 / v_s. */
static void
slope(const state *m, const double step[], int order, double c[][SERIES_PARTS], double out[])
{
    enum { N = MOST_SERIES + 1 };
    const ss_scene *s = m->scene;
    double factor = (static_friction(s) - s->friction) / s->own[SPEED] / s->mass, w[N], p[N];
    (void)step;
    for (int n = 0; n <= order; n++) {
        next_fall(m, c[n], n, p, w);
        out[n] = factor * (n == 0 ? w[0] * w[0] : inner_products(w, w, n) + 2 * w[0] * w[n]);
    }
    out[0] -= m->c / s->mass;
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    ss_stick_sample(m, drive, q, dqdt, s);
    if (m->mode != 0)
        s->f = friction_at(m, q[1]);
}

static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    const double way = direction_of(memory, p);
    part[0] = way * s->friction;
    part[1] = way * (static_friction(s) - s->friction) * part_at(s, p->v);
}

MODEL(stribeck) = {
    .name = "stribeck",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .ranges = ranges, .n_ranges = sizeof ranges / sizeof *ranges,
    .parameter = { { .offset = OWN_AT(SPEED), .by_speed = -1 } },
    .n_parameters = 1,
    .limit = ss_to_coulomb, .dim = 2, .force_varies = IN_SLIP,
    .start = ss_stick_start, .fastest = ss_linear_fastest, .quickest = quickest, .sight = sight,
    .rates = rates, .jacobian = jacobian, .series = series, .slope = slope,
    .still = ss_stick_still, .next = ss_stick_next, .sample = sample, .variation = &ss_stick_variation,
    .drive = drive
};
