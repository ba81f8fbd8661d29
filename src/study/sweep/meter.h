/* meter.h -- measures along a walk. */
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
void ss_meter_end(meter *r, int cycles, int closes, double value[]);

#endif
