/* engine.h -- an engine carries a motion from one event to the next: a GSL stepper, a series, collocation or a
 * closed form. */
#ifndef ENGINE_H
#define ENGINE_H

#include <stickslip/sim.h>
#include "motion/motion.h"

typedef struct engine engine;

/* The purpose of reading a state.  In a run of samples, each one interval after the last, an
 * engine may compute a sample from the one before. */
typedef enum reading {
    ANYWHERE, FIRST_SAMPLE, NEXT_SAMPLE
} reading;

/* The state from the start of a step on: Taylor coefficients in s / unit, those of v' last. */
typedef struct series {
    int degree;                                 /* an odd number; 0: this step has none */
    double per_unit;                            /* [1/s] */
    double c[MOST_SERIES + 1][SERIES_PARTS];
} series;

/* With the step caps of motion.h the next term of a linear mode's series is (2 pi / 40)^12 / 12! = 5e-19 of the
 * amplitude. */
enum { CAPPED_DEGREE = 11 };

struct engine_type {
    size_t size;                                /* of the engine, which begins with a struct engine */
    int degree;                                 /* of the series of its longest steps in a linear mode */
    /* Fill in what is its own.  May be NULL. */
    ss_status (*make)(engine *e, ss_error *err);
    /* The motion has entered a mode: discard what belongs to the one before. */
    void (*begin)(engine *e);
    /* Take one step from now and fill h, q1, dq1.  The step is at most h_max long, but may be
     * longer if its series shows all events. */
    ss_status (*step)(engine *e, double h_max, ss_error *err);
    /* Search the end of the mode without steps, up to s_max from now.  Returns 1: it is at
     * *s_event; 0: it is later, and h, q1 and dq1 are those of s_max; -1: only steps can find it.
     * May be NULL. */
    int (*ahead)(engine *e, double s_max, double *s_event);
    /* The state at s from now, 0 <= s <= h, within the step just taken, and its rate of change, of
     * which a sample needs only the first two numbers; base is the phase of the base there. */
    void (*at)(engine *e, reading where, double s, turn base, double q[], double dqdt[]);
    /* The derivative of x_ref, q[0] and v at s from now, within that step, by the same three numbers now.  NULL
     * if the engine cannot compute it. */
    void (*response)(engine *e, double s, double d[D_MOST][D_MOST]);
    /* The motion has reached the end of the step: let u have a new origin if the engine needs one.  NULL: u counts
     * from there. */
    void (*go_on)(engine *e);
    /* Free all that the engine holds, but not the engine.  May be NULL. */
    void (*release)(engine *e);
};

struct engine {
    const struct engine_type *type;
    motion *m;
    const struct method *how;
    double tol;                             /* of steps, which the numbers that follow are for */
    double scale[MAX_DIM];                  /* of the parts of the state */
    double unit[MAX_DIM];                   /* powers of two near these: converting rounds nothing */
    double shortest;                        /* the shortest step allowed in the mode [s] */
    double next;                            /* the length of the next step, about [s] */
    double h;                               /* of the last step */
    double dq0[MAX_DIM];                    /* rate of change of the state at its start */
    double q1[MAX_DIM], dq1[MAX_DIM];       /* state and rate at its end */
    int ended;                              /* the number of the bound that ends the mode in this step */
    series series;                          /* of the last step */
    int lands_on_samples;                   /* 1: at() gives the state at the nearer end */
    int lost;                               /* 1: a guard within a step was NaN */
    unsigned long steps, rhs, events;
};

extern const struct engine_type ss_exact_engine, ss_taylor_engine, ss_radau_engine, ss_ode_engine;
void ss_engine_free(engine *e);                     /* NULL is allowed */

/* For engines that take steps: the rate of change at the start of a mode, and its shortest step; and SS_ETOL, as a
 * step would have to be shorter. */
void ss_engine_begin_steps(engine *e);
ss_status ss_engine_fail_short(const engine *e, ss_error *err);
/* Let the step have a series, if its mode is linear. */
void ss_engine_expand(engine *e);
/* taylor.c: the state at s by a series, and the rates of change of its first two parts. */
void ss_series_at(const series *of, double s, double q[], double dqdt[]);

/* run.c: own becomes the caller's options or the usual ones, see ss_options_take. */
ss_status ss_sim_opts_take(ss_sim_opts *own, const ss_sim_opts *given, ss_error *err);
/* SS_OK if the scene is valid and the samples of its record can be counted. */
ss_status ss_record_check(const ss_scene *scene, ss_error *err);

#endif
