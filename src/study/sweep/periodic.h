/* periodic.h -- the periodic state of a scene, found and measured. */
#ifndef PERIODIC_H
#define PERIODIC_H

#include "study/sweep/cycles.h"

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
