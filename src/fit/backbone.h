/* backbone.h -- free decays: blocks of a few periods, what is smooth through them, and what they tell. */
#ifndef BACKBONE_H
#define BACKBONE_H

#include <stddef.h>
#include <stickslip/backbone.h>

/* An oscillation about the middle of a block, per sample: ln A falls by s t + ds t^2/2, the phase grows by
 * w t + dw t^2/2. */
typedef struct bend {
    double s, w, ds, dw;
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
    bend at;                    /* what is smooth through the blocks, at t */
    double error[TRACKS], bend_error;   /* of its rates, and of ds */
    double level, phase;        /* ln A of it, and the phase, at t */
} block;

/* Fit samples first ... end - 1 of x, NaN where they are missing, starting from a bend, beside a line, the second
 * and third harmonic and the lines; is_near: in one step.  0: there are too few samples, or no oscillation is
 * found. */
int ss_block_fit(block *b, const double *x, size_t first, size_t end, bend start, const lines *beside,
                 int is_near);

/* Draw smooth s and w, with errors, through n blocks whose noise is known: at, error and level; at.s and at.w
 * must be near.  has_phase 0: there is no w. */
ss_status ss_blocks_smooth(block *b, size_t n, int has_phase);

/* Where the blocks come from. */
typedef struct decay_source {
    double rate;                /* samples a second */
    int has_phase;
    const char *column;         /* its unit */
    int order;                  /* of the derivative of x in SI units that it is; -1: it is none */
    double mass;                /* [kg]; 0: unknown */
} decay_source;

/* 0, 1, 2 for a unit of x, x' or x'' in SI units; -1: it is none. */
int ss_motion_order(const char *unit);
/* Name the mechanism that n blocks show, drawn smooth: mechanism, chi2_dof and number of *out. */
ss_status ss_mechanism_find(ss_backbone *out, const block *b, size_t n, const decay_source *source);

#endif
