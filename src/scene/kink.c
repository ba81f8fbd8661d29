/* kink.c -- friction with a third number z in the state, whose law is smooth but for kinks where v, or z, passes
 * through 0.  A mode is a sign of v; at a kink the next begins, without an event. */
#include "scene/model.h"

int
ss_kink_start(state *m)
{
    m->q[0] = m->scene->x0;
    m->q[1] = m->scene->v0 - m->scene->surface_velocity;
    m->q[2] = 0;
    m->mode = 1;                        /* rates need one; at v = 0 either will do */
    ss_kink_turn(m);
    return 0;
}

/* The mode is the sign that v will have: that of v, of v', of the base's push, or +1. */
void
ss_kink_turn(state *m)
{
    double rates[MAX_DIM];
    m->model->rates(m, base_force(m, m->u), m->q, rates);
    int way = m->q[1] != 0 ? sign(m->q[1]) : sign(rates[1]);
    m->mode = way != 0 ? way : base_force_rate(m, m->u) < 0 ? -1 : 1;
    m->n_bounds = 1;
    m->bound[0] = (bound){ .of = { 0, m->mode } };
}

int
ss_kink_next(state *m, ss_event *e)
{
    (void)e;
    m->q[1] = 0;
    ss_kink_turn(m);
    return 0;
}

double
ss_kink_fastest(const state *m, double stiffness, double viscous, const char **what)
{
    const ss_scene *s = m->scene;
    double contact = sqrt((s->stiffness + stiffness) / s->mass), decay = (s->damping + viscous) / s->mass;
    if (what != NULL)
        *what = m->omega >= fmax(contact, decay) ? "the base" : decay > contact ? "the damper" : "the contact";
    return fmax(fmax(contact, decay), m->omega);
}

void
ss_kink_jacobian(const state *m, double u, const double row[9], double *dfdq, double dfdt[])
{
    for (int i = 0; i < 9; i++)
        dfdq[i] = row[i];
    dfdt[0] = dfdt[2] = 0;
    dfdt[1] = base_force_rate(m, u) / m->scene->mass;
}

void
ss_kink_sample(const double q[], const double dqdt[], ss_sample *s)
{
    s->x = q[0];
    s->v = q[1];
    s->a = dqdt[1];
    s->y = q[2];
    s->mode = sign(q[1]);
}

static void
all_free(const state *m, int is_free[D_MOST])
{
    (void)m;
    is_free[D_REF] = is_free[D_Q] = is_free[D_V] = 1;
}

static int
move(state *m, const double d[D_MOST])
{
    m->q[0] += d[D_Q];
    m->q[1] += d[D_V];
    m->q[2] += d[D_REF];
    return m->n_bounds == 0 || within_bounds(m, m->q);
}

const struct variation ss_kink_variation = { .free = all_free, .move = move };
