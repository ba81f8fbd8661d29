/* driven.h -- friction laws driven by a measured motion: what each makes of the force. */
#ifndef DRIVEN_H
#define DRIVEN_H

#include <stddef.h>
#include <stickslip/rank.h>
#include "fit/verdict.h"
#include "scene/model.h"

/* The unknowns on which the force does not depend linearly.  Lengths are in units of the rms motion, speeds in
 * units of the rms speed, DELAY in rows; all but BETA and DELAY are logarithms. */
enum { LENGTH, OTHER_LENGTH, GAP, EXPONENT, BETA, RISE, SPEED, SHAPE, DELAY, UNKNOWNS };
/* The columns of the force, which is linear in them.  The law's parts and the viscous part are not negative.  No rig
 * is as even as a law: its force may be larger on one side (UNEVEN), and grow with the place (PLACE). */
enum { PART, VISCOUS = PART + DRIVEN_PARTS, TILT, INERTIA, SINE, COSINE, BY_SIDE, UNEVEN, PLACE, OFFSET, DRIFT,
       COLUMNS };
enum { LAWS_MOST = 16, FOLDS = 2, ALL = FOLDS };
enum { DRIVEN_ROWS = 4000, DRIVEN_FEWEST = DRIVEN_ROWS / 20 };     /* rows that fits look at; to judge from */

/* A law that a motion may drive: a model, the unknowns that it frees, and the numbers that they make. */
enum { LAW_NUMBERS = 8 };
typedef struct driven_law {
    const char *name, *model;       /* model NULL: no law */
    const char *word[2];            /* a key of its scene, and its word; or NULL */
    unsigned free;                  /* a bit for each unknown that is free */
    double held[UNKNOWNS];          /* the others, as a larger law has them that this one is a limit of */
    int is_even;                    /* it is elastic, and has one size for both sides: a rig has two */
    size_t parts;                   /* forces whose amplitudes are its own; 1: the sum of the model's parts */
    struct { const char *name, *unit; } number[LAW_NUMBERS];    /* keys of scenes */
    void (*numbers)(double number[], const double u[], const double c[]);   /* c: amplitudes of its parts */
    const char *confounded;         /* what no motion separates; or NULL */
    unsigned contains;              /* a bit for each row that is a limit of this one */
} driven_law;
/* laws.c: the rows, from the simplest; the first is the null.  NULL after the last. */
const driven_law *ss_driven_law(size_t i);
/* Set the law's model and those of its numbers that are keys of it. */
void ss_driven_scene(ss_scene *scene, const driven_law *law, const double number[]);

/* A motion and a force; in units of the rms motion, of its rms speed, and of the rms force about its mean. */
typedef struct driven {
    size_t n;
    double *t, *x, *v, *a, *f;      /* the motion smoothed; f with its sign in the equation of motion */
    char *used;                     /* 0: the force of this row is left out */
    double least, slow;             /* a motion and a speed less than these are noise */
    double step;                    /* mean time between rows, before they were thinned */
    double length, speed, force, middle;    /* the units, and the mean of x, in those of the recording */
    int sign;                       /* of f in the recording */
    double code, codes;             /* the step of f's converter, and how many values f visits evenly */
    size_t clipped;
    double angle;                   /* radians in the recording's unit of motion; 0: it is no angle */
    double most_delay;              /* rows */
    double pieces;                  /* in a unit of time: every other is of one fold */
    double *room;
} driven;

/* driven.c: the record of n rows.  SS_ENOMEM. */
ss_status ss_driven_new(driven *d, const double t[], const double motion[], const double force[], size_t n,
                        const ss_motion_opts *opts);
/* Keep about so many rows, evenly, and at most as many at which the motion turns. */
ss_status ss_driven_thin(driven *thin, const driven *d, size_t most);
void ss_driven_free(driven *d);
/* Mark the rows at which the motion turns by more than so much; NULL: do not.  Returns their number.  (A contact
 * remembers turns that are not little beside the rms motion.) */
size_t ss_driven_turns(const driven *d, double least, char is_turn[]);

/* The line over time that suits the used rows of x: its value at the middle and its slope.  Returns the mean square
 * about it. */
double ss_driven_line(double line[2], const driven *d, const double x[]);

typedef struct driven_fit {
    double u[UNKNOWNS], c[COLUMNS];
    double loss;                    /* mean square of what it leaves of the rows fitted */
} driven_fit;

/* What a law makes of a record. */
typedef struct driven_result {
    const driven_law *law;
    driven_fit fit[FOLDS + 1];      /* each without the rows of a fold, and of all */
    double loss;                    /* mean square left of each row by the fit without its fold */
    double block[BLOCKS];           /* the parts of this of blocks of time */
    double *left, *own;             /* by the fit of all: what is left of each row, and the law's own force */
    double covariance[UNKNOWNS + COLUMNS][UNKNOWNS + COLUMNS];      /* of the fit of all */
} driven_result;

static inline int
driven_fold(const driven *d, size_t i)
{
    return (int)(d->t[i] * d->pieces) % FOLDS;
}

/* driven_fit.c: fit a law to a record.  coarse: the same record with fewer rows.  left is to be freed.  SS_ENOMEM. */
ss_status ss_driven_fit(driven_result *out, const driven_law *law, const driven *d, const driven *coarse);
/* Solve normal equations of m unknowns, whose lower half is given, scaled, for n right sides, which become the
 * solutions. */
void ss_driven_solve(double h[], size_t m, double right[][UNKNOWNS + COLUMNS], size_t n);
/* What a fit makes of each row. */
ss_status ss_driven_predict(double out[], const driven_law *law, const driven *d, const driven_fit *fit);

#endif
