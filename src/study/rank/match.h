/* match.h -- the scene that moves as a record does, sample by sample, from any start. */
#ifndef MATCH_H
#define MATCH_H

#include <stddef.h>
#include <stickslip/status.h>
#include "base/progress.h"
#include "study/rank/candidate.h"
#include "study/rank/record.h"

/* The unknowns: the keys of the candidate, then these.  In a covariance keys, FREQUENCY and SIZE stand
 * as logarithms. */
enum { MATCH_FREQUENCY = CANDIDATE_KEYS, MATCH_PHASE, MATCH_X0, MATCH_V0, MATCH_SIZE, MATCH_OFFSET,
       MATCH_UNKNOWNS };

/* Twice a difference of logarithms of likelihood, or the square of one in standard errors, that is
 * no accident. */
#define MATCH_DECISIVE 25

#define MATCH_RUNS 150              /* of the motion that a match takes: 30 to 600 */

/* Of the power: methods of simulation differ by a tenth of it. */
#define MATCH_QUIET 1e-6

/* Where the motion begins: its unknowns and their units. */
typedef struct match_origin {
    double p[MATCH_SIZE];
    double frequency, lead;             /* [Hz], and from the start to the first sample [s] */
    double x_unit, v_unit;              /* 0: from rest */
} match_origin;

typedef struct match {
    match_origin origin;
    ss_scene scene;             /* its record is the one matched, but for offset and residual */
    double key[CANDIDATE_KEYS];
    double left;                /* mean square of the residual away from events */
    double left_all;            /* and over all samples that are not missing */
    double power;               /* of these about their mean */
    double white;               /* variance of the white noise in the residual, at most */
    size_t compared;            /* samples away from events */
    double covariance[MATCH_UNKNOWNS][MATCH_UNKNOWNS];  /* for noise of variance 1; NaN: no fit */
} match;

/* Adjust the scene of one start of a candidate, its keys within their ranges, to a record.  Where
 * the scene does not slip, cannot be run, or the candidate's budget is used up, all is left.
 * SS_STOP if the progress function stops it. */
ss_status ss_match_find(match *m, candidate *c, const candidate_start *start, double period,
                        const rank_record *record, const ss_stretch *progress);

/* Adjust the motion of a match to another record of the same time, of c->pick. */
ss_status ss_match_other(match *m, candidate *c, const match *from, const rank_record *record,
                         const ss_stretch *progress);

/* The residual of a match over noise of this variance, or of less if the residual is not white. */
double ss_match_excess(const match *m, double noise);
/* 1 if that is no more than noise, within the error of its estimate. */
int ss_match_explains(const match *m, double noise);

#endif
