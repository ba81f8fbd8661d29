/* walk.h -- a motion from event to event, for callers that need no samples.
 *
 * A walk is a sequence of legs without an event inside.  ss_walk_leg finds a leg, ss_walk_at gives
 * the state within it, and ss_walk_on goes to its end. */
#ifndef WALK_H
#define WALK_H

#include "motion/engine.h"

/* A step that takes more right-hand sides than this counts as more than one: rk8pd with its events
 * takes so many, while a step of an implicit method may take hundreds. */
enum { RHS_PER_STEP = 20 };

typedef struct walk {
    motion m;                       /* at the start of the leg; engines point at it: do not copy */
    engine *e;
    unsigned long max_steps;        /* 0: as many as it takes */
    double lasted;                  /* of the present mode, before the leg */
    int in_a_row;                   /* events that follow each other at once */
    double h;                       /* length of the leg */
    int still;                      /* the mass stands still on it */
    int ends;                       /* an event ends it */
} walk;

/* At the start of the scene, which stays the caller's.  opts: method, tol and max_steps count. */
ss_status ss_walk_begin(walk *w, const ss_scene *scene, const ss_sim_opts *opts, ss_error *err);
/* At the state of a motion with the same scene, whose instant becomes t = 0. */
void ss_walk_begin_at(walk *w, const motion *from);
/* Find the next leg: until the next event, for at most `longest` seconds. */
ss_status ss_walk_leg(walk *w, double longest, ss_error *err);
/* State and rate of change s after its start, 0 <= s <= h. */
void ss_walk_at(walk *w, double s, double q[], double dqdt[]);
/* Go to the end of the leg.  *is_event says whether that is an event, which *event then holds. */
ss_status ss_walk_on(walk *w, int *is_event, ss_event *event, ss_error *err);
void ss_walk_end(walk *w);

#endif
