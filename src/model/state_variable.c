/* state_variable.c -- f = theta, which relaxes towards f_k tanh(alpha v) at the rate gamma (or,
 * as the paper prints it, towards tanh(alpha v) at the rate gamma f_k).  Smooth: no events. */
#include "model.h"

static int
start(motion *m)
{
    m->mode = 0;
    m->q[0] = m->scene->x0;
    m->q[1] = m->scene->v0;
    m->q[2] = 0;
    return 0;
}

/* theta' = -rate (theta - goal tanh(alpha v)). */
static void
law(const ss_scene *s, double *rate, double *goal)
{
    int literal = s->law == SS_LAW_LITERAL;
    *rate = literal ? s->gamma * s->friction : s->gamma;
    *goal = literal ? 1 : s->friction;
}

/* The steps follow the tolerance; only base and spring cap them. */
static double
fastest(const motion *m, const char **what)
{
    double omega_n = sqrt(m->scene->stiffness / m->scene->mass);
    if (what != NULL)
        *what = m->omega >= omega_n ? "the base" : "the spring";
    return fmax(omega_n, m->omega);
}

static void
rates(const motion *m, double drive, const double q[], double dqdt[])
{
    const ss_scene *s = m->scene;
    double rate, goal;
    law(s, &rate, &goal);
    dqdt[0] = q[1];
    dqdt[1] = (drive - s->stiffness * q[0] - q[2]) / s->mass;
    dqdt[2] = -rate * (q[2] - goal * tanh(s->alpha * q[1]));
}

static void
jacobian(const motion *m, double u, const double q[], double *dfdq, double dfdt[])
{
    const ss_scene *s = m->scene;
    double rate, goal, sech = 1 / cosh(s->alpha * q[1]);
    law(s, &rate, &goal);
    const double row[9] = {
        0, 1, 0,
        -s->stiffness / s->mass, 0, -1 / s->mass,
        0, rate * goal * s->alpha * sech * sech, -rate
    };
    for (int i = 0; i < 9; i++)
        dfdq[i] = row[i];
    dfdt[0] = dfdt[2] = 0;
    dfdt[1] = -m->drive * m->omega * sin(m->theta + m->omega * u) / s->mass;
}

static void
sample(const motion *m, double drive, const double q[], const double dqdt[], ss_sample *s)
{
    (void)m, (void)drive;
    s->x = q[0];
    s->v = q[1];
    s->a = dqdt[1];
    s->f = q[2];
    s->y = 0;
    s->mode = sign(q[1]);
}

const struct model ss_state_variable_model = {
    .dim = 3, .start = start, .fastest = fastest, .rates = rates, .jacobian = jacobian,
    .sample = sample
};
