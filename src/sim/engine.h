/* engine.h -- what carries a motion from one event to the next: a GSL stepper or a closed form. */
#ifndef ENGINE_H
#define ENGINE_H

#include "model/model.h"

typedef struct engine engine;

/* Where a state is asked for.  A run of samples, each one interval after the last, may be carried on
 * from one to the next. */
typedef enum place {
    ANYWHERE, FIRST_SAMPLE, NEXT_SAMPLE
} place;

struct engine_type {
    /* The motion has entered a mode: forget what belonged to the last one. */
    ss_status (*begin)(engine *e);
    /* Take one step from m->u: fills h, q1, dq1.  It is at most h_max long, or longer where the guard
     * cannot reach 0 within it. */
    ss_status (*step)(engine *e, double h_max, ss_error *err);
    /* The state at m->u + s, 0 <= s <= h, within the step just taken, and its rate of change; base
     * is the phase there. */
    void (*at)(engine *e, place where, double s, turn base, double q[], double dqdt[]);
    /* The motion has come to the end of the step: count u from a new origin if it is time to. */
    void (*go_on)(engine *e);
    void (*free)(engine *e);
};

struct engine {
    const struct engine_type *type;
    motion *m;
    double h;                               /* of the last step */
    double dq0[MAX_DIM];                    /* rate of change of the state at its start */
    double q1[MAX_DIM], dq1[MAX_DIM];       /* state and rate at its end */
    int lands_on_samples;                   /* at() answers at the nearer end */
    unsigned long steps, rhs, events;
};

const char *ss_ode_method_name(size_t i);      /* NULL after the last */
ss_status ss_ode_new(engine **out, motion *m, const char *name, double tol, ss_error *err);
ss_status ss_exact_new(engine **out, motion *m, ss_error *err);

#endif
