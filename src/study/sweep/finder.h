/* finder.h -- a search for the periodic state of a scene, cycle by cycle.
 *
 * A cycle is a cycle of the forcing.  In a scene without forcing (autonomous), it goes from one
 * onset of stick to the next, and its duration may vary. */
#ifndef FINDER_H
#define FINDER_H

#include <float.h>
#include "study/sweep/meter.h"

/* The state at the start of a cycle: x - U t, v over the surface, and y of the model (memory), 0
 * if it has none. */
typedef struct section {
    double x, v, y;
} section;

enum { SECTIONS = 2 * SS_PERIOD_MAX + 1 };

typedef struct finder {
    const ss_scene *scene;
    const ss_steady_opts *opts;
    ss_error *err;
    int in_closed_form;                 /* 1: the walk and its tangent have a closed form */
    int autonomous;                     /* 1: there is no forcing */
    walk w;
    double n;                           /* cycles since the walk's t = 0 */
    section unit;                       /* the units of differences */
    section last[SECTIONS];             /* the latest sections, in a ring */
    unsigned long recorded;             /* sections so far */
    course course;                      /* of the cycles that were measured, if it is wanted */
    double multiplier;                  /* the largest one of the period that Newton's method is near to;
                                         * the error of its steps is that of a walk over 1 - this */
    double missed;                      /* distance from the start to the end of the measured cycles */
    unsigned long unresolved;           /* events in these cycles: see ss_sim_stats */
} finder;

section ss_section_of(const state *m);
/* The largest of the three differences, in units of the finder. */
double ss_section_distance(const finder *f, section a, section b);
/* A difference within rounding does not show a rate. */
#define ROUNDING (64 * DBL_EPSILON)

/* Begin at the scene's initial state, or if it is autonomous at its first onset of stick. */
ss_status ss_finder_begin(finder *f, const char *method);
/* Begin at a state at which a cycle begins. */
ss_status ss_finder_begin_at(finder *f, const motion *from);
/* Let the engine, if it can, continue with errors that are small beside this distance, in units of
 * the finder; 0: with errors within the tolerance.  Returns 1 if the errors are so small. */
int ss_finder_keep(finder *f, double distance);
/* Walk so many cycles, with a meter and a tangent unless they are NULL.  SS_EDATA: an
 * autonomous scene slides on without a stick. */
ss_status ss_finder_go(finder *f, int cycles, meter *r, tangent *t);
/* *period becomes the least number of cycles, at most `most`, after which the state returns to
 * within tol of the present one; 0 if there is none. */
ss_status ss_finder_return(finder *f, int most, double tol, int *period);

/* --- derivative.c, period.c ---------------------------------------------------------------------- */

#define FLOQUET (1u << SS_FLOQUET | 1u << SS_FLOQUET_2 | 1u << SS_FLOQUET_ANGLE)

#define LYAPUNOV (1u << SS_LYAPUNOV | 1u << SS_LYAPUNOV_ERROR)

/* The coordinates of a state at which a cycle begins or ends, and their units. */
void ss_finder_coordinates(const motion *m, double c[D_MOST]);
void ss_finder_coordinate_units(const finder *f, double unit[D_MOST]);
/* Move the state by d.  Returns 0 if its mode does not allow this. */
int ss_finder_move(motion *m, const double d[D_MOST]);

/* Walk so many cycles, and compute the derivative of the state at their end by the present state. */
typedef enum derivative_use {
    NEWTON, MULTIPLIERS                 /* these need more digits if there is no closed form */
} derivative_use;
ss_status ss_finder_derive(finder *f, int cycles, derivative_use use, tangent *t);
/* lyapunov.c: the exponent over so many further cycles, and its standard error; NaN if a cycle has
 * no derivative. */
ss_status ss_finder_exponent(finder *f, unsigned long cycles, double *exponent, double *error);
/* Measure so many further cycles; period is 0 if the motion does not return. */
ss_status ss_finder_measure(finder *f, int cycles, int period, ss_steady *out);

/* --- the searches ------------------------------------------------------------------------------ */

/* Of the motions that Newton's method may find, accept a stable one; the one that the motion approaches as
 * its derivative predicts; or one that it crawls to, too slowly for the cycles that there are. */
typedef enum which_motion { STABLE, APPROACHED, CRAWLED_TO } which_motion;

/* shoot.c: from the present state, find by Newton's method a state that repeats after *period
 * cycles, and measure it, if it is one that is accepted.
 * *period becomes its period; 0 if there is none or it is not stable. */
ss_status ss_finder_shoot(finder *f, which_motion which, int *period, ss_steady *out);
/* settle.c: simulate until the motion is periodic, or if shooting is allowed, until it is near
 * enough to a period for shooting; and measure it. */
ss_status ss_finder_settle(finder *f, int may_shoot, ss_steady *out);

#endif
