/* match.h -- the scene whose motion fits a record sample by sample, from any start. */
#ifndef MATCH_H
#define MATCH_H

#include <stddef.h>
#include <stickslip/status.h>
#include "base/progress.h"
#include "fit/candidate.h"
#include "fit/record.h"

/* The unknowns: the keys of the candidate, then these.  In a covariance keys, FREQUENCY and SIZE stand
 * as logarithms. */
enum { MATCH_FREQUENCY = CANDIDATE_KEYS, MATCH_PHASE, MATCH_X0, MATCH_V0, MATCH_SIZE, MATCH_OFFSET,
       MATCH_UNKNOWNS };

/* Twice the difference of two log-likelihoods, or the square of a difference in standard errors, beyond
 * which it is significant. */
#define MATCH_DECISIVE 25

#define MATCH_RUNS 150              /* simulations that a match takes, typically; 30 to 600 */

/* The part of the power below which a residual means nothing: simulation methods differ by a tenth of
 * it. */
#define MATCH_QUIET 1e-6

/* The start of the motion, and the units of the unknowns. */
typedef struct match_origin {
    double lead;                /* time from the start to the first sample [s] */
    double frequency;           /* [Hz] */
    double turn;                /* unit of FREQUENCY: the relative change of the frequency that shifts
                                   the ends of the record by about a radian */
    double x_unit, v_unit;      /* 0: from rest */
} match_origin;

typedef struct match {
    match_origin origin;
    double p[MATCH_SIZE];       /* the unknowns that move the motion; the keys come first */
    ss_scene scene;             /* its motion is the record less offset and residual */
    double settled[CANDIDATE_KEYS];     /* the keys of the best settled motion */
    double left;                /* mean square of the residual away from events */
    double left_all;            /* the same over all samples that are not missing */
    double power;               /* variance of these samples */
    double white;               /* variance of the white noise in the residual: an upper bound */
    size_t compared;            /* samples away from events */
    double covariance[MATCH_UNKNOWNS][MATCH_UNKNOWNS];  /* for noise of variance 1; NaN: no fit */
} match;

/* Fit the scene of one start of a candidate, its keys within their ranges, to a record.  If the
 * scene does not slip, cannot be run, or the candidate's budget is used up, the residual is the
 * record.  If its settled motion is that of one of the n matches of other starts, it is that
 * match.  SS_STOP if the progress function stops it. */
ss_status ss_match_find(match *m, candidate *c, const candidate_start *start, double period,
                        const rank_record *record, const match *others, size_t n_others,
                        const ss_stretch *progress);

/* Fit the motion of a match to a record of another quantity, c->pick, of the same time. */
ss_status ss_match_other(match *m, candidate *c, const match *from, const rank_record *record,
                         const ss_stretch *progress);

/* Do two matches have the same keys, within MATCH_DECISIVE of the errors of the first? */
int ss_match_same(const match *a, const match *b);
/* The residual of a match over noise of this variance, or of less if the residual is not white. */
double ss_match_excess(const match *m, double noise);
/* 1 if the residual is no more than noise, within the error of its estimate. */
int ss_match_explains(const match *m, double noise);

#endif
