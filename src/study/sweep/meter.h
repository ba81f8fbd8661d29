/* meter.h -- measures along a walk, and its derivative with respect to its initial state. */
#ifndef METER_H
#define METER_H

#include <stickslip/sweep.h>
#include "motion/walk.h"

#define MODEL_ERRORS (0xffu << SS_MODEL_ERROR_X)

/* x - U t, v, a and f at equal times over some cycles. */
enum { COURSE_COLUMNS = 4, COURSE_A_CYCLE = 2000 };
typedef struct course {
    int cycles;
    size_t n, done;                 /* of samples */
    double interval;                /* [s] */
    double *value[COURSE_COLUMNS];
} course;

/* Room for so many cycles, nothing done; to be freed with ss_course_free. */
ss_status ss_course_begin(course *c, int cycles, double cycle);
void ss_course_free(course *c);

/* Extrema of a within one transition. */
typedef struct ring {
    size_t n;
    double first, last;             /* times */
} ring;

typedef struct meter {
    unsigned wanted;
    course *course;                 /* NULL: not wanted */
    int needs_course;               /* the inside of the legs is needed, not only their ends */
    double time, stick, x_lo, x_hi, v_max, a_max, energy;
    size_t stops, microslips;
    int slip, first_slip;           /* directions; first_slip: if that before it is unknown */
    ring now, begun_in;             /* begun_in: of the transition that the meter began in */
    int in_first;
    double spacing;
    size_t spacings;
} meter;

void ss_meter_begin(meter *r, unsigned wanted, const state *m);
void ss_meter_leg(meter *r, walk *w);
void ss_meter_event(meter *r, const ss_event *event);
/* The measures of so many cycles, which close to a period or do not; those that are not wanted
 * may be wrong. */
void ss_meter_end(meter *r, int cycles, int closes, double value[]);

/* d(x_ref, q, v) now by d(x_ref, q, v) at the start, on an engine that knows its response; x_ref is
 * the third number of a state that has one. */
typedef struct tangent {
    double d[D_MOST][D_MOST];
    double later[D_MOST];           /* by which the last event, where v has become 0, comes later [s] */
} tangent;

void ss_tangent_begin(tangent *t, const state *m);
/* Along the leg that w stands on; then, if it ends in an event, across it: rates are those before,
 * and mode, whether that was an event. */
void ss_tangent_leg(tangent *t, const walk *w);
void ss_tangent_event(tangent *t, const walk *w, int mode, const double q[], const double rates[]);
/* At an onset of microstick: from neighbouring states at one time to those at their own onsets, where
 * only x - U t differs. */
void ss_tangent_on_onset(tangent *t, const state *m);
/* d = (I - t)^-1 r, in units in which 1 is a change of each; 0 where t leaves a direction as it
 * is. */
void ss_tangent_solve(const tangent *t, const double unit[3], const double r[3], double d[3]);
/* Modulus of the largest and of the next multiplier, argument of the largest in 0 ... pi; NaN where
 * t is not finite.  SS_ENOMEM. */
ss_status ss_tangent_multipliers(const tangent *t, double *first, double *second, double *angle);

#endif
