/* walk.h -- a motion from event to event.
 *
 * A walk is a sequence of legs without an event inside.  ss_walk_leg finds a leg, ss_walk_at gives
 * the state within it, and ss_walk_on goes to its end. */
#ifndef WALK_H
#define WALK_H

#include "motion/engine.h"

/* A step that needs more right-hand sides than this counts as more than one step.  A step of rk8pd
 * with its events needs so many; a step of an implicit method may need hundreds. */
enum { RHS_PER_STEP = 20 };

typedef struct walk {
    motion m;                       /* at the start of the leg; engines point at it: do not copy */
    engine *e;
    const struct method *how;
    int slips;                      /* 1: it started in slip */
    int by_steps;                   /* 1: not ahead: the series of a step shows where a guard only touches 0 */
    double cap;                     /* the longest step in the present mode [s] */
    unsigned long max_steps;        /* 0: no limit */
    double lasted;                  /* duration of the present mode before the leg [s] */
    int in_a_row;                   /* events that follow each other at once */
    double h;                       /* length of the leg [s] */
    int still;                      /* 1: the mass stands still on it */
    int ends;                       /* 1: an event ends it */
} walk;

/* Begin at the start of a scene, which the caller keeps.  Of opts, method and tol count. */
ss_status ss_walk_begin(walk *w, const ss_scene *scene, const ss_sim_opts *opts, ss_error *err);
/* Begin at the state of a motion with the same scene; its time becomes t = 0. */
void ss_walk_begin_at(walk *w, const motion *from);
/* Find the next leg.  It lasts until the next event, but at most `longest` seconds; a stick may be
 * without end. */
ss_status ss_walk_leg(walk *w, double longest, ss_error *err);
/* The state and its rate of change at s after the start of the leg, 0 <= s <= h. */
void ss_walk_at(walk *w, double s, double q[], double dqdt[]);
/* Go to the end of the leg.  If this is an event, *is_event becomes 1 and *event the event. */
ss_status ss_walk_on(walk *w, int *is_event, ss_event *event, ss_error *err);
void ss_walk_end(walk *w);

#endif
