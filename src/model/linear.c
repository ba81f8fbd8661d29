/* linear.c -- the equation that Coulomb friction and compliant contact share within a mode. */
#include "model.h"

#include <gsl/gsl_errno.h>

double
motion_drive(const motion *m, double u)
{
    return m->drive * cos(m->theta + m->omega * u);
}

int
linear_rhs(double u, const double q[], double dqdt[], void *params)
{
    const motion *m = params;
    dqdt[0] = q[1];
    dqdt[1] = (motion_drive(m, u) - m->f0 - m->k * q[0] - m->c * q[1]) / m->scene->mass;
    return GSL_SUCCESS;
}

int
linear_jacobian(double u, const double q[], double *dfdq, double dfdt[], void *params)
{
    const motion *m = params;
    double mass = m->scene->mass;
    (void)q;
    dfdq[0] = 0;
    dfdq[1] = 1;
    dfdq[2] = -m->k / mass;
    dfdq[3] = -m->c / mass;
    dfdt[0] = 0;
    dfdt[1] = -m->drive * m->omega * sin(m->theta + m->omega * u) / mass;
    return GSL_SUCCESS;
}

/* The larger root of m s^2 + c s + k = 0 in modulus, or Omega. */
double
linear_fastest(const motion *m, const char **what)
{
    double half = m->c / (2 * m->scene->mass), omega0 = sqrt(m->k / m->scene->mass);
    double root = half <= omega0 ? omega0 : half + sqrt((half - omega0) * (half + omega0));
    if (what != NULL)
        *what = m->omega >= root ? "the base" : half > omega0 ? "the contact's damper"
            : m->k > m->scene->stiffness ? "the contact" : "the spring";
    return fmax(root, m->omega);
}

void
linear_slip(motion *m, double x, double v, int direction)
{
    m->mode = direction;
    m->k = m->scene->stiffness;
    m->c = 0;
    m->f0 = direction * m->scene->friction;
    m->x_ref = 0;
    m->q[0] = x;
    m->q[1] = v;
}

/* Slip lasts while the mass moves in its direction. */
double
linear_slip_guard(const motion *m, const double q[], const double dqdt[], double *slope)
{
    *slope = m->mode * dqdt[1];
    return m->mode * q[1];
}
