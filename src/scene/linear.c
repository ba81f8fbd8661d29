/* linear.c -- the equation that Coulomb friction and compliant contact share within a mode. */
#include "scene/model.h"

void
ss_linear_rates(const state *m, double drive, const double q[], double dqdt[])
{
    dqdt[0] = q[1];
    dqdt[1] = (drive - m->f0 - m->k * q[0] - m->c * q[1]) / m->scene->mass;
}

void
ss_linear_jacobian(const state *m, double u, const double q[], double *dfdq, double dfdt[])
{
    double mass = m->scene->mass;
    (void)q;
    dfdq[0] = 0;
    dfdq[1] = 1;
    dfdq[2] = -m->k / mass;
    dfdq[3] = -m->c / mass;
    dfdt[0] = 0;
    dfdt[1] = base_force_rate(m, u) / mass;
}

void
ss_linear_series(const state *m, const double step[], int order, double c[][SERIES_PARTS])
{
    double force[MOST_SERIES + 1], per_mass = 1 / m->scene->mass, k = m->k * per_mass, damping = m->c * per_mass;
    double x = c[0][0] = m->q[0], v = c[0][1] = m->q[1];
    base_force_series(m, step, order, force);
    force[0] -= m->f0;
    for (int n = 0; n < order; n++) {
        double a = c[n][MAX_DIM] = force[n] * per_mass - k * x - damping * v;
        c[n + 1][0] = x = step[n] * v;
        c[n + 1][1] = v = step[n] * a;
    }
}

/* The larger |root| of m s^2 + c s + k = 0, or Omega if that is larger still. */
double
ss_linear_fastest(const state *m, const char **what)
{
    double half = m->c / (2 * m->scene->mass), omega0 = sqrt(m->k / m->scene->mass);
    double root = half <= omega0 ? omega0 : half + sqrt((half - omega0) * (half + omega0));
    if (what != NULL)
        *what = m->omega >= root ? "the base" : half > omega0 ? "the damper"
            : m->k > m->scene->stiffness ? "the contact" : "the spring";
    return fmax(root, m->omega);
}

/* Slip lasts while the mass moves in its direction. */
void
ss_linear_slip(state *m, double x, double v, int direction)
{
    m->mode = direction;
    m->n_bounds = direction != 0;
    m->bound[0] = (bound){ .of = { 0, direction } };
    m->k = m->scene->stiffness;
    m->c = m->scene->damping;
    m->f0 = direction * kinetic_friction(m->scene, direction);
    m->x_ref = 0;
    m->q[0] = x;
    m->q[1] = v;
}
