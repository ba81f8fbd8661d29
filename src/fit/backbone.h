/* backbone.h -- free decays: blocks of a few periods, what is smooth through them, and what they tell. */
#ifndef BACKBONE_H
#define BACKBONE_H

#include <math.h>
#include <stddef.h>
#include <stickslip/backbone.h>
#include "fit/verdict.h"

/* An oscillation about the middle of a block, per sample: ln A falls by s t + ds t^2/2 + dds t^3/6, the phase
 * grows by w t + dw t^2/2 + ddw t^3/6. */
typedef struct bend {
    double s, w, ds, dw, dds, ddw;
} bend;

/* What stands beside the decay: lines of a hum or of other modes, exp(-s t) cos(w t + p) each. */
enum { LINES_MAX = 3 };
typedef struct lines {
    size_t n;
    double w[LINES_MAX], s[LINES_MAX];
} lines;

/* The two things that are tracked: ln A, whose rate is -s, and the phase, whose rate is w. */
enum { LEVEL, PHASE, TRACKS };

typedef struct block {
    size_t first, end;          /* samples */
    double t;                   /* its middle, in samples */
    double y[TRACKS], rate[TRACKS];
    double cov[TRACKS][3];      /* variance of y, covariance, that of the rate; for white noise of variance 1 */
    double left, free;          /* sum of squares of the residuals, and degrees of freedom */
    double noise;               /* variance of the residuals here */
    bend about;                 /* what it was fitted from, in so many steps */
    int steps;
    bend at;                    /* what is smooth through the blocks, at t */
    double error[TRACKS];       /* of its rates */
    double lag, lag_error;      /* what damping takes from the square of w */
    double level, phase;        /* ln A of it, and the phase, at t */
} block;

/* Fit samples first ... end - 1 of x, NaN where they are missing, starting from a bend, beside a line, the second
 * and third harmonic and the lines; in so many steps, or steps 0: until it is near.  0: there are too few samples,
 * or no oscillation is found. */
int ss_block_fit(block *b, const double *x, size_t first, size_t end, bend start, const lines *beside,
                 int steps);

/* What the smooth oscillation leaves of a block's samples, 0 for those that are missing. */
void ss_block_leave(const block *b, const double *x, double *left);

/* What is tracked through blocks: (y, rate, p) and constants. */
enum { STATES = 10, WALKS = 12 };       /* WALKS: strengths of the random walk */

typedef struct place {          /* of a block */
    double see[3][STATES];      /* y, its rate and its bend, of the states */
    double seen[2], tie, variance[2];   /* y, and the rate less tie times y, whose errors are independent */
    double turn[3][3], shift[3], walk[3][3];    /* to the next place: x becomes turn x + shift, variance q walk */
    double x[STATES], p[STATES][STATES];        /* mean and variance by what this place and those before tell */
    double h[2][STATES], gain[2][STATES], news[2], sure[2];     /* of the filter's steps */
    double of_walk[STATES][WALKS][2];   /* of y, its rate, its bend and constants: mean, standard deviation */
    double mean[STATES], error[STATES];     /* over all walks, by likelihood: mean, and 68 % lie within it */
} place;

/* What a block tells of y and of its rate [unit/sample], each less what the states do not hold. */
void ss_place_see(place *at, const block *b, int track, double y, double rate, double unit);
/* The walk over v e-folds, by turn. */
void ss_place_walk(place *at, double v);
/* From a mean and a variance at the first one, set mean and error of all places, if is_smooth; end takes x and p of
 * the last, over all walks, and mean and error of its states.
 * Returns the ln likelihood of what is seen. */
double ss_blocks_track(place *at, size_t n, size_t states, const double x[], double start[STATES][STATES],
                       place *end, int is_smooth);

/* What a derivative of x gives back of what damping takes from w^2, as it turns the phase by atan(s/w). */
static inline double
given_back(int derivative, double ds)
{
    return derivative > 0 ? 2 * derivative * ds : 0;
}

/* How far what damping takes is unknown where the derivative is. */
static inline double
not_known(int derivative, double ds)
{
    return derivative < 0 ? 2 * fabs(ds) : 0;
}

/* Where the blocks come from. */
typedef struct decay_source {
    double rate;                /* samples a second */
    const ss_span *gap;         /* of the record, in seconds from its first sample */
    size_t n_gaps;
    int has_phase;
    const char *column;         /* its unit */
    double size;                /* of that in SI units; 0: it is no motion of a mass */
    int derivative;             /* of a displacement or an angle, by its unit or its name; -1: it is not known */
    double mass;                /* [kg]; 0: unknown */
    double unit;                /* of amplitudes in the column's unit: a power of 2, near the largest */
    lines beside;               /* in all blocks */
    size_t behind;              /* blocks behind the last, which are fitted once: their y alone counts */
    const char *beats;          /* not NULL: no mechanism, as the amplitude grows again */
} decay_source;

/* Draw smooth s and, if there is a phase, w, with errors, through n blocks whose noise is known: at, error and level;
 * at.s and at.w must be near. */
ss_status ss_blocks_smooth(block *b, size_t n, const decay_source *source);
extern const char *const ss_mechanism_names[SS_MECHANISMS];     /* "viscous", ... */
/* 0, 1, 2 for a unit of x, x' or x'', a length or an angle, -1: it is none; and its size in SI units, 0 of an
 * angle. */
int ss_motion_order(const char *unit, double *size);
/* Name the mechanism that n blocks, drawn smooth, and those behind them show: mechanism, chi2_dof and number of
 * *out.  What a block leaves becomes what a slider's exact motion, if it is named, does not explain. */
ss_status ss_mechanism_find(ss_backbone *out, block *b, size_t n, const decay_source *source);

#endif
