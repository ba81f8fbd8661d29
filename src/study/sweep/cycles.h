/* cycles.h -- a motion cycle by cycle, its measures, and the periodic state.
 *
 * A cycle is a cycle of the forcing.  In a scene without forcing (autonomous), it goes from one
 * onset of stick to the next, or where nothing sticks from one time at which the mass becomes slower than
 * its pull to the next; its duration may vary. */
#ifndef CYCLES_H
#define CYCLES_H

#include <float.h>
#include <gsl/gsl_complex.h>
#include <stickslip/sweep.h>
#include "motion/method.h"
#include "motion/walk.h"

/* --- measures along a walk (meter.c) ------------------------------------------------------- */

#define MODEL_ERRORS (0xffu << SS_MODEL_ERROR_X)

/* x - U t, v, a and f at equal times over some cycles. */
enum { COURSE_COLUMNS = 4, COURSE_A_CYCLE = 2000 };
typedef struct course {
    int cycles;
    size_t n, done;                 /* of samples */
    double interval;                /* [s] */
    double **value;                 /* as ss_columns_new */
} course;

/* Extrema of a within one transition. */
typedef struct ring {
    size_t n;
    double first, last;             /* times */
} ring;

typedef struct meter {
    unsigned wanted;
    course *course;                 /* NULL: not wanted */
    int needs_course;               /* 1: the inside of the legs is needed, not only their ends */
    double stiffness;
    double time, stick, x_lo, x_hi, v_max, a_max, energy;
    size_t stops, microslips;
    int slip, first_slip;           /* directions of the last slip, and of the first one if the slip
                                       before it is unknown */
    ring now, begun_in;             /* begun_in: that of the transition in which the meter began */
    int in_first;
    double spacing;
    size_t spacings;
} meter;

void ss_meter_begin(meter *r, unsigned wanted, const state *m);
void ss_meter_leg(meter *r, walk *w);
void ss_meter_event(meter *r, const ss_event *event);
/* Compute the measures of so many cycles.  closes: 1 if they are a period.  A value that is not
 * wanted may be wrong. */
void ss_meter_end(meter *r, int n, int closes, double value[]);

/* --- cycles, and their derivative with respect to the state at their start (cycles.c) ------ */

/* The state at the start of a cycle: x - U t, v over the surface (the second number of a state that has none),
 * and y of the model (memory), 0 if it has none. */
typedef struct section {
    double x, v, y;
} section;

/* The derivative of (x_ref, q, v) now by (x_ref, q, v) at the start, x_ref being the third number
 * of a state that has one. */
typedef struct tangent {
    double d[D_MOST][D_MOST];
    double later[D_MOST];           /* the delay of the last event, at which v became 0 [s] */
} tangent;

typedef struct cycles {
    const ss_scene *scene;
    const ss_steady_opts *opts;
    const struct method *how;
    ss_error *err;
    ss_status status;                   /* that of the first failure, after which the walk stays where it is */
    int autonomous;                     /* 1: there is no forcing */
    int from_pull;                      /* 1: nor a stick; a cycle begins where it becomes slower than its pull */
    int was_faster;                     /* 1: it has been faster since the last of these */
    walk w;
    double n;                           /* cycles since the walk's t = 0 */
    section unit;                       /* the units of differences */
    double multiplier;                  /* the largest one of the period that Newton's method has found */
} cycles;

/* Begin at the scene's initial state, or if it is autonomous at its first onset of stick. */
void ss_cycles_begin(cycles *c);
/* Begin at a state at which a cycle begins. */
void ss_cycles_begin_at(cycles *c, const motion *from);
/* Walk so many cycles, with a meter unless it is NULL.  SS_EDATA: an autonomous scene slides on
 * without a stick. */
void ss_cycles_go(cycles *c, int n, meter *r);
/* The least number of cycles, at most `most`, after which the state returns to within tol of the
 * present one; 0 if there is none. */
int ss_cycles_return(cycles *c, int most, double tol);

section ss_section_of(const motion *m);
/* The largest of the three differences, in units of c.  One within rounding does not show a rate. */
double ss_section_distance(const cycles *c, section a, section b);
#define ROUNDING (64 * DBL_EPSILON)

/* --- derivatives --------------------------------------------------------------------------- */

/* The coordinates of a state at which a cycle begins or ends, and their units. */
void ss_cycles_coordinates(const motion *m, double at[D_MOST]);
void ss_cycles_units(const cycles *c, double unit[D_MOST]);
/* Move the state by d.  Returns 0 if its mode does not allow this. */
int ss_cycles_move(motion *m, const double d[D_MOST]);

/* Walk so many cycles, and compute the derivative of the state at their end by the present state. */
typedef enum derivative_use {
    NEWTON, MULTIPLIERS                 /* these need more digits if there is no closed form */
} derivative_use;
void ss_cycles_derive(cycles *c, int n, derivative_use use, tangent *t);
/* d = (I - t)^-1 r, computed in these units; 0 of a coordinate that t does not change, and in a direction to
 * which it adds nothing; NaN if t or r is not finite.  SS_ENOMEM. */
ss_status ss_tangent_solve(const tangent *t, const double unit[D_MOST], const double r[D_MOST], double d[D_MOST]);
/* The eigenvalues of a matrix of D_MOST rows and columns; the first is NaN if they are not known.  SS_ENOMEM. */
ss_status ss_eigenvalues(const double *matrix, gsl_complex value[D_MOST]);
/* The moduli of the largest and of the second multiplier, and the argument of the largest, 0 ... pi;
 * NaN if t is not finite.  SS_ENOMEM. */
ss_status ss_tangent_multipliers(const tangent *t, double *first, double *second, double *angle);
/* The largest Lyapunov exponent over so many further cycles, and its standard error; NaN if a cycle has no
 * derivative. */
void ss_cycles_exponent(cycles *c, unsigned long n, double *exponent, double *error);

/* --- the periodic state (periodic.c) ------------------------------------------------------- */

#define FLOQUET (1u << SS_FLOQUET | 1u << SS_FLOQUET_2 | 1u << SS_FLOQUET_ANGLE)
#define LYAPUNOV (1u << SS_LYAPUNOV | 1u << SS_LYAPUNOV_ERROR)

enum { SECTIONS = 2 * SS_PERIOD_MAX + 1 };

typedef struct finder {
    cycles c;
    section last[SECTIONS];             /* the latest sections, in a ring */
    unsigned long recorded;             /* sections so far */
    ss_steady *out;
    course course;                      /* of the cycles that were measured, if it is wanted */
    double missed;                      /* distance from the start to the end of the measured cycles */
    unsigned long unresolved;           /* events in these cycles: see ss_sim_stats */
} finder;

/* 1 if shooting is possible. */
int ss_periodic_can_shoot(const ss_scene *scene, const struct method *how);
/* Find the state, from f->c with scene, opts, how and err, and measure it into f->out.  Returns the
 * status of f->c.  f is to be freed even after a failure. */
ss_status ss_periodic_find(finder *f);
void ss_periodic_free(finder *f);

#endif
