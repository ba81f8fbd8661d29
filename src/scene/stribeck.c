/* stribeck.c -- friction that falls with speed, in slip; true stick (stick.c):
 * f = sgn(v) (f_k + (f_s - f_k) p(u)), u = |v / v_s|^delta, p = 1 / (1 + u) or exp(-u). */
#include <string.h>
#include "scene/models.h"

enum { SPEED, EXPONENT, SHAPE };        /* v_s; delta, 0: it is 1; p */
enum { HYPERBOLIC, EXPONENTIAL };

static const scene_key keys[] = {
    KEY_STATIC_FRICTION, KEYS_FRICTION_NEGATIVE,
    OWN_NUMBER("stribeck_velocity", SPEED, REQUIRED, POSITIVE, "m/s"),
    OWN_WORD("stribeck_shape", SHAPE, TERM, "hyperbolic", "exponential"),
    OWN_NUMBER("stribeck_exponent", EXPONENT, TERM, FROM_ONE, "1"),
};

static double
exponent(const ss_scene *s)
{
    return s->own[EXPONENT] > 0 ? s->own[EXPONENT] : 1;
}

/* The part of f_s - f_k that remains at v; *fall becomes its derivative by |v|, with the sign changed. */
static double
part_at(const ss_scene *s, double v, double *fall)
{
    double delta = exponent(s), v_s = s->own[SPEED], w = fabs(v) / v_s;
    double below = delta == 1 ? 1 : pow(w, delta - 1);          /* w^(delta - 1) */
    int is_exponential = s->own[SHAPE] == EXPONENTIAL;
    double part = is_exponential ? exp(-w * below) : delta == 1 ? v_s / (v_s + fabs(v)) : 1 / (1 + w * below);
    *fall = (is_exponential ? part : part * part) * delta * below / v_s;
    return part;
}

/* The friction in slip.  Its direction is that of the mode even where a step goes past v = 0, the end of
 * the slip. */
static double
friction_at(const state *m, double v)
{
    const ss_scene *s = m->scene;
    double slope, f_k = kinetic_friction(s, m->mode);
    return m->mode * (f_k + (holding_friction(s, m->mode) - f_k) * part_at(s, v, &slope));
}

/* The derivative of the friction by v. */
static double
slope_at(const state *m, double v)
{
    const ss_scene *s = m->scene;
    double fall, drop = holding_friction(s, m->mode) - kinetic_friction(s, m->mode);
    part_at(s, v, &fall);
    return -m->mode * sign(v) * drop * fall;
}

/* The rate at which v grows where the friction falls with speed. */
static double
quickest(const ss_scene *s)
{
    double drop = fmax(holding_friction(s, 1) - s->friction, holding_friction(s, -1) - kinetic_friction(s, -1));
    return exponent(s) * drop / s->own[SPEED] / s->mass + own_frequency(s);
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

/* u is a product of series if delta is 1 or 2. */
static int
analytic(const ss_scene *s)
{
    return exponent(s) == 1 || exponent(s) == 2;
}

static void
series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    const ss_scene *s = m->scene;
    double drop = m->mode * (holding_friction(s, m->mode) - kinetic_friction(s, m->mode)), per_mass = 1 / s->mass;
    enum { N = MOST_SERIES + 1 };
    double force[N], w[N], u[N], p[N];          /* w = |v| / v_s */
    base_force_series(m, step, order, force);
    force[0] -= m->f0;
    c[0][0] = m->q[0];
    c[0][1] = m->q[1];
    for (int n = 0; n < order; n++) {
        w[n] = m->mode / s->own[SPEED] * c[n][1];
        u[n] = exponent(s) == 1 ? w[n] : product_term(w, w, n);
        if (s->own[SHAPE] == EXPONENTIAL)
            p[n] = n == 0 ? exp(-u[0]) : next_of_exp(u, p, n);
        else
            p[n] = n == 0 ? 1 / (1 + u[0]) : -p[0] * (p[0] * u[n] + inner_products(p, u, n));
        c[n + 1][0] = step[n] * c[n][1];
        double a = per_mass * (force[n] - drop * p[n] - m->k * c[n][0] - m->c * c[n][1]);
        c[n + 1][1] = step[n] * a;
        c[n][MAX_DIM] = a;
    }
}

/* In a step v may change by this part of itself and v_s, as in lugre.c; the first shape needs no such limit. */
#define WAY_TO_FALL 0.4

static double
reach(const state *m, double c[][SERIES_PARTS], double step)
{
    const ss_scene *s = m->scene;
    if (exponent(s) == 1 && s->own[SHAPE] == HYPERBOLIC)
        return step;
    return step_within(c, step, WAY_TO_FALL * (fabs(m->q[1]) + s->own[SPEED]));
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
    double f_k = kinetic_friction(s, (int)way), slope;
    part[0] = way * f_k;
    part[1] = way * (holding_friction(s, (int)way) - f_k) * part_at(s, p->v, &slope);
}

MODEL(stribeck) = {
    .name = "stribeck",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .parameter = { { .offset = OWN_AT(SPEED), .by_speed = -1 } },
    .n_parameters = 1,
    .limit = ss_to_coulomb, .dim = 2, .force_varies = IN_SLIP,
    .start = ss_stick_start, .fastest = ss_linear_fastest, .quickest = quickest, .sight = sight,
    .rates = rates, .jacobian = jacobian, .series = series, .reach = reach,
    .analytic = analytic,
    .still = ss_stick_still, .next = ss_stick_next, .sample = sample, .variation = &ss_stick_variation,
    .drive = drive
};

void
ss_to_stribeck(ss_scene *scene, double speed)
{
    scene->model = &ss_stribeck_model;
    memset(scene->own, 0, sizeof scene->own);
    scene->own[SPEED] = speed;
}
