/* event.h -- find when a guard becomes negative inside one step. */
#ifndef EVENT_H
#define EVENT_H

typedef struct guard_value {
    double g, slope;
} guard_value;

/* The guard and its rate of change at time s after the start of the step. */
typedef guard_value guard_fn(double s, void *user);

int ss_event_find(guard_fn *guard, void *user, double h, guard_value at_0, guard_value at_h,
                  double *s_event);

#endif
