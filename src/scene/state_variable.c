/* state_variable.c -- f = theta, which relaxes towards f_k tanh(alpha v) at the rate gamma (or,
 * as the paper prints it, towards tanh(alpha v) at the rate gamma f_k).  Smooth: no events. */
#include "scene/models.h"

#include <string.h>

enum { ALPHA, GAMMA, LAW };
/* theta' = -gamma (theta - f_k tanh(alpha v)), or -gamma f_k (theta - tanh(alpha v)), (9) as printed */
enum { SCALED, LITERAL };

static const scene_key keys[] = {
    OWN_NUMBER("alpha", ALPHA, REQUIRED, POSITIVE, "s/m"),
    OWN_NUMBER("gamma", GAMMA, REQUIRED, POSITIVE, "1/s"),
    OWN_WORD("law", LAW, OPTIONAL, "scaled", "literal"),
};

/* theta' = -rate (theta - goal tanh(alpha v)). */
static void
law(const ss_scene *s, double *rate, double *goal)
{
    int literal = s->own[LAW] == LITERAL;
    *rate = literal ? s->own[GAMMA] * s->friction : s->own[GAMMA];
    *goal = literal ? 1 : s->friction;
}

/* Replace the law by the scaled one with the same rate and goal. */
static void
normalise(ss_scene *s)
{
    law(s, &s->own[GAMMA], &s->friction);
    s->own[LAW] = SCALED;
}

/* Replace the scene by its limit, the Coulomb friction to which the law settles. */
static void
limit(ss_scene *s)
{
    if (s->own[LAW] == LITERAL && s->friction > 0)
        s->friction = 1;
    s->static_friction = 0;
    ss_to_coulomb(s);
}

static int
start(state *m)
{
    m->mode = 0;
    m->q[0] = m->scene->x0;
    m->q[1] = m->scene->v0 - m->scene->surface_velocity;
    m->q[2] = 0;
    return 0;
}

/* Friction does not limit the steps, since the tolerance shortens them; spring, damper and base do. */
static double
fastest(const state *m, const char **what)
{
    double omega_n = own_frequency(m->scene), decay = m->scene->damping / m->scene->mass;
    double own = decay > omega_n ? decay : omega_n;
    if (what != NULL)
        *what = m->omega >= own ? "the base" : own > omega_n ? "the damper" : "the spring";
    return fmax(own, m->omega);
}

/* While v creeps within the front, the friction responds with the roots of s^2 + g s + g b,
 * b = goal alpha / m.  There a step of an explicit method is at most 5.2 / |s| (rk8pd, measured).  GSL's
 * implicit bsimp follows the creep in some 100 steps a period of the slow motion, and each costs as much
 * as 40 of rk8pd.  Both cost the same at |s| = 5.2 x 40 x 100 / (2 pi) times the slow frequency.  Roots
 * that swing far more than they decay slow down bsimp as well: at alpha = 1e9 it takes 1.6 times rk8pd's
 * work for a damping of 0.02, and a hundredth of it for 0.07.  (radau takes 1/2 to 1/7 of bsimp's.) */
#define STIFF_RATIO 3000
#define STIFF_DAMPING 0.03

/* The larger |s|; *damping becomes the damping ratio of the roots, over 1 if they do not swing. */
static double
front_rate(const ss_scene *s, double *damping)
{
    double g, goal;
    law(s, &g, &goal);
    double swing = sqrt(g) * sqrt(goal * s->own[ALPHA] / s->mass);
    *damping = g / 2 / swing;
    return g / 2 > swing ? g / 2 + sqrt((g / 2 - swing) * (g / 2 + swing)) : swing;
}

static double
quickest(const ss_scene *s)
{
    double damping;
    return front_rate(s, &damping);
}

static int
stiff(const ss_scene *s)
{
    double slow = fmax(own_frequency(s), 2 * M_PI * s->base_frequency), damping;
    return front_rate(s, &damping) > STIFF_RATIO * slow && damping > STIFF_DAMPING;
}

static void
rates(const state *m, double drive, const double q[], double dqdt[])
{
    const ss_scene *s = m->scene;
    double rate, goal;
    law(s, &rate, &goal);
    dqdt[0] = q[1];
    dqdt[1] = (drive - s->stiffness * q[0] - s->damping * q[1] - q[2]) / s->mass;
    dqdt[2] = -rate * (q[2] - goal * tanh(s->own[ALPHA] * q[1]));
}

static double
sight(const state *m, const double dqdt[])
{
    const ss_scene *s = m->scene;
    return sight_of(m->q[1], 1 / s->own[ALPHA], dqdt[1],
                    (base_force_rate(m, m->u) - s->stiffness * dqdt[0] - s->damping * dqdt[1]
                     - dqdt[2]) / s->mass);
}

static void
jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    const ss_scene *s = m->scene;
    double rate, goal, sech = 1 / cosh(s->own[ALPHA] * q[1]);
    law(s, &rate, &goal);
    const double row[9] = {
        0, 1, 0,
        -s->stiffness / s->mass, -s->damping / s->mass, -1 / s->mass,
        0, rate * goal * s->own[ALPHA] * sech * sech, -rate
    };
    ss_kink_jacobian(m, u, row, dfdq, dfdt);
}

/* Beyond this |alpha v| tanh is 1 to rounding over a whole step within reach: 4 exp(-1.2 x 35) =
 * 2e-18. */
#define SATURATED 35

/* u = tanh(alpha v) has u' = alpha R v' with R = 1 - u^2; the first coefficient of R is computed from e,
 * because 1 - u^2 would lose its digits where u is almost 1.  The present coefficients have variables of
 * their own: each depends on the one before, which then need not be loaded from memory. */
static void
series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    enum { N = MOST_SERIES + 1 };
    const ss_scene *s = m->scene;
    double rate, goal, force[N], a[N], R[N], u[N], per_mass = 1 / s->mass;
    double x = m->q[0], v = m->q[1], theta = m->q[2];
    double speed = s->own[ALPHA] * fabs(v), e = exp(-2 * speed), tanh_v = copysign((1 - e) / (1 + e), v);
    law(s, &rate, &goal);
    base_force_series(m, step, order, force);
    memcpy(c[0], m->q, sizeof m->q);
    u[0] = tanh_v;
    R[0] = 4 * e / ((1 + e) * (1 + e));
    for (int n = 0; n < order; n++) {
        double h = step[n], A = (force[n] - s->stiffness * x - s->damping * v - theta) * per_mass;
        c[n][MAX_DIM] = a[n] = A;
        c[n + 1][0] = x = h * v;
        c[n + 1][1] = v = h * A;
        c[n + 1][2] = theta = h * rate * (goal * tanh_v - theta);
        tanh_v = 0;
        if (speed > SATURATED || n + 1 == order)
            continue;
        double Ra = inner_products(R, a, n) + R[0] * A;
        if (n > 0) {
            R[n] = -inner_products(u, u, n) - 2 * u[0] * u[n];
            Ra += R[n] * a[0];
        }
        u[n + 1] = tanh_v = s->own[ALPHA] * h * Ra;
    }
}

/* In a step v may change by this part of its distance from the poles of tanh, which lie i pi / (2 alpha)
 * from v = 0: where tanh is saturated, its series does not show them. */
#define WAY_TO_POLE 0.4

static double
reach(const state *m, double c[][SERIES_PARTS], double step)
{
    return step_within(c, step, WAY_TO_POLE * (fabs(m->q[1]) + M_PI / 2 / m->scene->own[ALPHA]));
}

static void
sample(const state *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    (void)m, (void)drive;
    ss_kink_sample(q, dqdt, s);
    s->f = q[2];
    s->y = 0;
}

static double
memory(const state *m, double *unit)
{
    *unit = m->scene->friction;
    return m->q[2];
}

/* 1 where the friction law is steep. */
static int
in_transition(const state *m, double v)
{
    return fabs(m->scene->own[ALPHA] * v) < 1;
}

MODEL(state_variable) = {
    .name = "state-variable",
    .keys = keys, .n_keys = sizeof keys / sizeof *keys,
    .parameter = { { .offset = OWN_AT(GAMMA) },
                   { .offset = OWN_AT(ALPHA), .by_speed = 1 } },
    .n_parameters = 2, .normalise = normalise, .limit = limit,
    .dim = 3, .force_varies = IN_STICK | IN_SLIP,
    .start = start, .fastest = fastest, .quickest = quickest, .sight = sight, .stiff = stiff,
    .rates = rates, .jacobian = jacobian, .series = series, .reach = reach,
    .sample = sample,
    .memory = memory, .in_transition = in_transition, .variation = &ss_kink_variation
};
