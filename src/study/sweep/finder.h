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
    int in_closed_form;                 /* the walk and its tangent are */
    int autonomous;
    walk w;
    double n;                           /* cycles walked, from the walk's t = 0 */
    section unit;                       /* of a difference */
    section last[SECTIONS];             /* the latest, cycle after cycle, in a ring */
    unsigned long recorded;             /* of them */
    course course;                      /* of what was measured, where it is wanted */
    double multiplier;                  /* the largest of the period that Newton's method is near to; its
                                         * steps are off by what a walk is, over 1 - this */
    double missed;                      /* from the start of what was measured to its end */
    unsigned long unresolved;           /* events in it: see ss_sim_stats */
} finder;

section ss_section_of(const state *m);
/* The largest difference, in units of the finder. */
double ss_section_distance(const finder *f, section a, section b);
/* A difference within rounding says nothing of a rate. */
#define ROUNDING (64 * DBL_EPSILON)

/* At the scene's initial state, or where it is autonomous at its first onset of stick, by this method. */
ss_status ss_finder_begin(finder *f, const char *method);
/* At a state, where a cycle begins. */
ss_status ss_finder_begin_at(finder *f, const motion *from);
/* Let the engine, if it can, walk on with errors that are small beside this distance, in units of the
 * finder; 0: as small as the tolerance asks for.  1 if they are so. */
int ss_finder_keep(finder *f, double distance);
/* Walk so many cycles, with a meter and a tangent unless they are NULL.  SS_EDATA: an
 * autonomous scene slides on without a stick. */
ss_status ss_finder_go(finder *f, int cycles, meter *r, tangent *t);
/* The first number of cycles, `most` at most, after which the present state is within tol of itself; 0 if
 * it is after none. */
ss_status ss_finder_return(finder *f, int most, double tol, int *period);

/* --- derivative.c, period.c ---------------------------------------------------------------------- */

#define FLOQUET (1u << SS_FLOQUET | 1u << SS_FLOQUET_2 | 1u << SS_FLOQUET_ANGLE)

#define LYAPUNOV (1u << SS_LYAPUNOV | 1u << SS_LYAPUNOV_ERROR)

/* A state where a cycle begins or ends, and the units of its numbers. */
void ss_finder_coordinates(const motion *m, double c[D_MOST]);
void ss_finder_coordinate_units(const finder *f, double unit[D_MOST]);
/* Move it by d; 0 if its mode does not allow that. */
int ss_finder_move(motion *m, const double d[D_MOST]);

/* The derivative of so many cycles by the state that they begin with, the present one; then the finder
 * stands where they end. */
typedef enum derivative_use {
    NEWTON, MULTIPLIERS                 /* which want more digits where there is no closed form */
} derivative_use;
ss_status ss_finder_derive(finder *f, int cycles, derivative_use use, tangent *t);
/* lyapunov.c: the exponent over so many cycles from here on, and its standard error; NaN where a cycle has
 * no derivative. */
ss_status ss_finder_exponent(finder *f, unsigned long cycles, double *exponent, double *error);
/* Measure so many cycles from here on; period 0 if they do not close. */
ss_status ss_finder_measure(finder *f, int cycles, int period, ss_steady *out);

/* --- the searches ------------------------------------------------------------------------------ */

/* shoot.c: look by Newton's method, from the present state on, for one that repeats after *period cycles,
 * and measure it.  approached: only the one to which the motion goes from here.  *period becomes its
 * period, 0 if there is none or it is not stable. */
ss_status ss_finder_shoot(finder *f, int approached, int *period, ss_steady *out);
/* settle.c: simulate until the motion is periodic, or near enough to a period for shooting to find it
 * where that is allowed, and measure it. */
ss_status ss_finder_settle(finder *f, int may_shoot, ss_steady *out);

#endif
