/* descent.h -- least squares between a record and the motion of a scene, from any unknowns to the least
 * residual near them. */
#ifndef DESCENT_H
#define DESCENT_H

#include <stickslip/scene.h>
#include "fit/match.h"
#include "fit/normal.h"

typedef struct descent_point {
    double p[MATCH_SIZE];               /* see match */
    double size, offset;
    double left;                        /* mean square over the samples used; infinite: no motion */
} descent_point;

/* The samples of a motion, and the distance of each from an event: see ss_samples_run. */
typedef struct descent_course {
    double *motion, *clear;
} descent_course;

/* Slopes are kept as long as steps by them gain as much as they predict: a step by old slopes costs one
 * run of the motion, and new slopes cost one run for each unknown. */
enum { NO_SLOPES, OLD_SLOPES, FRESH_SLOPES };

typedef struct descent {
    candidate *c;
    const rank_record *r;
    const ss_stretch *progress;
    double runs;                        /* of the motion so far */
    ss_status status;                   /* SS_ENOMEM or SS_STOP */
    match_origin o;
    size_t n_moved, moved[MATCH_SIZE];  /* the unknowns that are adjusted; size and offset follow */
    double wide;                        /* weights grow from 0 to 1 over so many samples */
    descent_course here, tried;         /* of the present point, and of one that was tried from it */
    double *slope[MATCH_SIZE];          /* of the motion, by each of moved */
    int slopes;                         /* NO_SLOPES, OLD_SLOPES or FRESH_SLOPES */
    double *weight;                     /* of each sample, by the course compared last */
    double used;                        /* sum of the weights */
} descent;

/* Adjust all unknowns that have a range, and allocate all arrays: the result is to be freed; NULL: no
 * memory.  The candidate and the record are set before. */
double *ss_descent_prepare(descent *w);

/* The scene with the unknowns p. */
ss_scene ss_descent_scene(const descent *w, const double p[MATCH_SIZE]);
/* Run its motion; clear may be NULL.  0 if there is none. */
int ss_descent_run(descent *w, const double p[MATCH_SIZE], double *motion, double *clear);

/* Begin at a point, or where a match ended, with a free start if that had one.  0 if there is no motion. */
int ss_descent_begin(descent *w, const descent_point *at);
int ss_descent_resume(descent *w, descent_point *at, const match *m);
/* Weigh the samples of a course, and find size, offset and residual of its point. */
void ss_descent_compare(descent *w, const descent_course *c, descent_point *at);
/* The step of an unknown for the differences that give slopes. */
double ss_descent_step(const descent *w, size_t unknown);
/* Find the slopes at the present point.  0 if a motion cannot be run. */
int ss_descent_slopes(descent *w, const descent_point *at);
/* The normal equations by these slopes: of moved, size and offset. */
void ss_descent_normal(const descent *w, const descent_point *at, normal *e);
/* Move *at, the present point, to the least residual near it. */
void ss_descent_minimise(descent *w, descent_point *at);

#endif
