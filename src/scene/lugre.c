/* lugre.c -- bristles that bend and slip (Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE Trans. Automatic
 * Control 40, 419, 1995): z' = v - sigma_0 |v| z / g(v), f = sigma_0 z + sigma_1 z' + sigma_2 v, with
 * g(v) = f_k + (f_s - f_k) exp(-(v/v_s)^2).
 *
 * There is no stick and no event.  |v| has a kink at v = 0, so modes are the signs of v, and the law is
 * smooth within each.  Where g is 0 there are no bristles: z stays 0. */
#include <string.h>
#include "scene/models.h"

enum { STIFFNESS, DAMPING, VISCOUS, SPEED };    /* sigma_0, sigma_1, sigma_2, v_s */

static const scene_key keys[] = {
    KEY_STATIC_FRICTION,
    OWN_NUMBER("bristle_stiffness", STIFFNESS, REQUIRED, POSITIVE, "N/m"),
    OWN_NUMBER("bristle_damping", DAMPING, TERM, NOT_NEGATIVE, "N s/m"),
    OWN_NUMBER("viscous_friction", VISCOUS, TERM, NOT_NEGATIVE, "N s/m"),
    OWN_NUMBER("stribeck_velocity", SPEED, REQUIRED, POSITIVE, "m/s"),
};

static const vanishing vanishing_terms[] = {
    { "bristle_damping=0", OWN_AT(DAMPING) },
    { "viscous_friction=0", OWN_AT(VISCOUS) },
};

/* --- the law ------------------------------------------------------------------------------------ */

/* sigma_0 |v| / g(v), the rate at which bristles slip, in motion in direction `way`; *slope becomes its
 * derivative by v. */
static double
slip_rate(const ss_scene *s, int way, double v, double *slope)
{
    double fall = static_friction(s) - s->friction, w = v / s->own[SPEED];
    double part = fall * exp(-w * w), g = s->friction + part, rate = g > 0 ? way * s->own[STIFFNESS] / g : 0;
    *slope = rate * (1 + 2 * w * w * (g > 0 ? part / g : 0));
    return rate * v;
}

static double
bristle_rate(const ss_scene *s, int way, double v, double z)
{
    double slope, rate = slip_rate(s, way, v, &slope);
    return slope != 0 ? v - rate * z : 0;
}

static double
force(const ss_scene *s, double v, double z, double z_rate)
{
    return s->own[STIFFNESS] * z + s->own[DAMPING] * z_rate + s->own[VISCOUS] * v;
}

/* --- the motion --------------------------------------------------------------------------------- */

static double
fastest(const state *m, const char **what)
{
    return ss_kink_fastest(m, m->scene->own[STIFFNESS], m->scene->own[VISCOUS], what);
}

static void
rates(const state *m, double drive, const double q[], double dqdt[])
{
    const ss_scene *s = m->scene;
    dqdt[0] = q[1];
    dqdt[2] = bristle_rate(s, m->mode, q[1], q[2]);
    dqdt[1] = (drive - s->stiffness * q[0] - s->damping * q[1] - force(s, q[1], q[2], dqdt[2])) / s->mass;
}

static void
jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    const ss_scene *s = m->scene;
    double slope, by_z = -slip_rate(s, m->mode, q[1], &slope), by_v = slope != 0 ? 1 - slope * q[2] : 0;
    const double row[9] = {
        0, 1, 0,
        -s->stiffness / s->mass, -(s->damping + force(s, 1, 0, by_v)) / s->mass, -force(s, 0, 1, by_z) / s->mass,
        0, by_v, by_z
    };
    ss_kink_jacobian(m, u, row, dfdq, dfdt);
}

static void
series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    enum { N = MOST_SERIES + 1 };
    const ss_scene *s = m->scene;
    double fall = static_friction(s) - s->friction, force_of_base[N], v[N], z[N], u[N], e[N], g[N], rate[N];
    base_force_series(m, step, order, force_of_base);
    memcpy(c[0], m->q, sizeof m->q);
    for (int n = 0; n < order; n++) {
        v[n] = c[n][1];
        z[n] = c[n][2];
        u[n] = product_term(v, v, n) / (s->own[SPEED] * s->own[SPEED]);
        e[n] = n == 0 ? exp(-u[0]) : next_of_exp(u, e, n);
        g[n] = fall * e[n] + (n == 0 ? s->friction : 0);
        rate[n] = m->mode * s->own[STIFFNESS] * v[n];
        if (n > 0)
            rate[n] -= inner_products(g, rate, n) + g[n] * rate[0];
        rate[n] /= g[0];
        double by_time = g[0] > 0 ? v[n] - product_term(rate, z, n) : 0;
        double a = (force_of_base[n] - s->stiffness * c[n][0] - s->damping * v[n]
                    - force(s, v[n], z[n], by_time)) / s->mass;
        c[n][MAX_DIM] = a;
        c[n + 1][0] = step[n] * v[n];
        c[n + 1][1] = step[n] * a;
        c[n + 1][2] = step[n] * by_time;
    }
}

/* In a step v may change by this part of itself and v_s: behind the Stribeck range the terms of exp(-(v/v_s)^2)
 * do not show it. */
#define WAY_TO_FALL 0.4

static double
reach(const state *m, double c[][SERIES_PARTS], double step)
{
    return step_within(c, step, WAY_TO_FALL * (fabs(m->q[1]) + m->scene->own[SPEED]));
}

static double
sight(const state *m, const double dqdt[])
{
    const ss_scene *s = m->scene;
    double jerk = (base_force_rate(m, m->u) - s->stiffness * dqdt[0] - s->damping * dqdt[1]
                   - force(s, dqdt[1], dqdt[2], 0)) / s->mass;
    return sight_of(m->q[1], s->own[SPEED], dqdt[1], jerk);
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    (void)drive;
    ss_kink_sample(q, dqdt, s);
    s->f = force(m->scene, q[1], q[2], bristle_rate(m->scene, m->mode, q[1], q[2]));
}

static double
memory(const state *m, double *unit)
{
    *unit = static_friction(m->scene) / m->scene->own[STIFFNESS];
    return m->q[2];
}

/* z follows Dahl's exponential, with g at the mean speed; then z' is that of the speed at the end. */
static void
drive(const ss_scene *s, double *memory, const piece *p, double part[])
{
    const double mean = p->h > 0 ? p->dx / p->h : 0;
    double slope;
    if (mean != 0) {
        const double end = mean / slip_rate(s, sign(mean), mean, &slope);
        *memory = end + (*memory - end) * exp(-fabs(p->dx / end));
    }
    part[0] = s->own[STIFFNESS] * *memory;
    part[1] = s->own[DAMPING] * bristle_rate(s, sign(p->v), p->v, *memory);
}

MODEL(lugre) = {
    .name = "lugre",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .parameter = { { .offset = OWN_AT(STIFFNESS), .by_mass = 1 },
                   { .offset = OWN_AT(DAMPING), .by_mass = 1 } },
    .n_parameters = 2,
    .vanishing = vanishing_terms, .n_vanishing = sizeof vanishing_terms / sizeof *vanishing_terms,
    .limit = ss_to_coulomb, .dim = 3, .kinks = 1, .force_varies = IN_STICK | IN_SLIP,
    .start = ss_kink_start, .fastest = fastest, .sight = sight,
    .rates = rates, .jacobian = jacobian, .series = series, .reach = reach, .next = ss_kink_next,
    .sample = sample, .memory = memory, .variation = &ss_kink_variation,
    .drive = drive
};
