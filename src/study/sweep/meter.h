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

/* Make an empty course with room for so many cycles; to be freed with ss_course_free. */
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
    int needs_course;               /* 1: the inside of the legs is needed, not only their ends */
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
void ss_meter_end(meter *r, int cycles, int closes, double value[]);

/* The derivative of (x_ref, q, v) now by (x_ref, q, v) at the start, for an engine that has a
 * response.  For a state with a third number, x_ref is this number. */
typedef struct tangent {
    double d[D_MOST][D_MOST];
    double later[D_MOST];           /* the delay of the last event, at which v became 0 [s] */
} tangent;

void ss_tangent_begin(tangent *t, const state *m);
/* Carry it along the present leg of w; then, if the leg ends in an event, across the event.  mode, q
 * and rates are the mode, the state and its rate of change before the event. */
void ss_tangent_leg(tangent *t, const walk *w);
void ss_tangent_event(tangent *t, const walk *w, int mode, const double q[], const double rates[]);
/* At an onset of microstick: change from neighbouring states at one time to neighbouring states at
 * their own onsets, where only x - U t differs. */
void ss_tangent_on_onset(tangent *t, const state *m);
/* d = (I - t)^-1 r, computed in these units; 0 in a direction that t does not change. */
void ss_tangent_solve(const tangent *t, const double unit[3], const double r[3], double d[3]);
/* The moduli of the largest and of the second multiplier, and the argument of the largest, 0 ... pi;
 * NaN if t is not finite.  SS_ENOMEM. */
ss_status ss_tangent_multipliers(const tangent *t, double *first, double *second, double *angle);

#endif
