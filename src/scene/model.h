/* model.h -- a friction model as a table of functions, and the motion that it moves.
 *
 * A model is smooth within a mode (stick or microstick 0, slip +1, slip -1); everything non-smooth
 * happens where the mode changes.  Coulomb and compliant contact are linear within a mode and
 * share one equation, m q'' = drive - f0 - k q - c q', whose coefficients the mode sets. */
#ifndef MODEL_H
#define MODEL_H

#include <stddef.h>
#include <stickslip/sim.h>
#include "motion/instant.h"

enum { MAX_DIM = 3, ORDERS = 4 };

typedef struct motion {
    const ss_scene *scene;
    const struct model *model;
    double omega;                   /* Omega [rad/s] */
    double drive;                   /* k Z_e [N] */
    double phase;                   /* of the scene, reduced to [-pi, pi] */
    double x_scale;                 /* what x is measured by: absolute tolerances are tol times it */
    double graze;                   /* a contact this far beyond its limit only touches it [m] */
    double slack;                   /* graze once it has in this microstick, else 0 */
    double doubt;                   /* what tolerance or rounding leaves of x in a step [m] */
    double x_begin;                 /* where the mode began */
    unsigned long unresolved;       /* touches, and slips over no more than the doubt */

    int mode;
    double k, c, f0;                /* of the mode, see above */
    double x_ref;                   /* x = x_ref + q[0]: q[0] is the contact's y in microstick */

    instant origin;                 /* u, the time within a mode, counts from here */
    double theta;                   /* phase of the base at the origin [rad] */
    double u;                       /* start of the present step */
    double q[MAX_DIM];              /* state there: x or y, v, theta */
} motion;

struct model {
    size_t dim;
    /* Enter the first mode at the scene's initial state; 1 if it starts in slip. */
    int (*start)(motion *m);
    /* Largest angular frequency or rate of decay of the mode, which caps the steps [rad/s], and
     * what it is in the words of a diagnosis; what may be NULL. */
    double (*fastest)(const motion *m, const char **what);
    /* What the tolerance may shorten steps for beyond that [rad/s]; NULL if nothing. */
    double (*quickest)(const ss_scene *scene);
    /* The longest step from the present state whose error an integrator can still judge; NULL if
     * fastest says it all. */
    double (*sight)(const motion *m, const double dqdt[]);
    /* 1 if an implicit method is the cheaper one; NULL if that cannot be. */
    int (*stiff)(const ss_scene *scene);
    /* The state's rate of change under the force of the base. */
    void (*rates)(const motion *m, double drive, const double q[], double dqdt[]);
    /* Its derivatives by the state (row after row) and by time. */
    void (*jacobian)(const motion *m, double u, const double q[], double *dfdq, double dfdt[]);
    /* The ORDERS - 1 rates of change after dqdt of a state at u; NULL if steps are to be repeated
     * for what lies inside them. */
    void (*derivatives)(const motion *m, double u, const double q[], const double dqdt[],
                        double higher[][MAX_DIM]);
    /* Not negative within the mode, and its rate of change; NULL if the model has no events. */
    double (*guard)(const motion *m, const double q[], const double dqdt[], double *slope);
    /* 1 if the mass stands still in this mode, until *u_end (INFINITY: for ever). */
    int (*still)(const motion *m, double *u_end);
    /* The mode ends at m->u in state m->q: enter the next.  1 if that is an event, put into *e. */
    int (*next)(motion *m, ss_event *e);
    /* What state, rate of change and force of the base say, except t and z. */
    void (*sample)(const motion *m, double drive, const double q[], const double dqdt[],
                   ss_sample *s);
};

extern const struct model ss_coulomb_model, ss_state_variable_model, ss_compliant_model;

static inline int
sign(double x)
{
    return (x > 0) - (x < 0);
}

typedef struct turn {
    double co, si;                  /* cosine and sine of an angle */
} turn;

static inline turn
turn_of(double angle)
{
    return (turn){ cos(angle), sin(angle) };
}

static inline turn
turn_further(turn a, turn b)
{
    return (turn){ a.co * b.co - a.si * b.si, a.co * b.si + a.si * b.co };
}

turn ss_motion_base(const motion *m, double u);        /* the phase Omega t + phase */
double ss_motion_drive(const motion *m, double u);     /* k Z_e times its cosine [N] */
double ss_motion_step_cap(const motion *m);         /* the longest step in the present mode: run.c */
void ss_motion_rebase(motion *m);                   /* let u count from the present step: run.c */

/* linear.c: what Coulomb and compliant contact share. */
void ss_linear_rates(const motion *m, double drive, const double q[], double dqdt[]);
void ss_linear_jacobian(const motion *m, double u, const double q[], double *dfdq, double dfdt[]);
void ss_linear_derivatives(const motion *m, double u, const double q[], const double dqdt[],
                           double higher[][MAX_DIM]);
double ss_linear_fastest(const motion *m, const char **what);
void ss_linear_slip(motion *m, double x, double v, int direction);
double ss_linear_slip_guard(const motion *m, const double q[], const double dqdt[], double *slope);

#endif
