/* verdict.h -- when a fit explains a record, when it is as good as another, what is then said; and the order of
 * scenes in a ranking. */
#ifndef VERDICT_H
#define VERDICT_H

#include <math.h>
#include <stddef.h>
#include <stickslip/rank.h>
#include "find/judgement.h"

/* What a fit leaves of the samples that it explains. */
typedef struct residue {
    double left;                /* mean square of the residuals */
    double power;               /* the same of the samples about their mean */
    double white;               /* variance of the white noise in the residuals: an upper bound */
    double compared;            /* samples; 0: there is no fit */
} residue;

/* Twice the difference of two log-likelihoods, or the square of a difference in standard errors, beyond
 * which it is significant. */
#define RESIDUE_DECISIVE 25
/* The part of the power below which a residual means nothing: simulation methods differ by a tenth of it. */
#define RESIDUE_QUIET 1e-6

/* The residual over noise of this variance, or over less if it is not white. */
double ss_residue_excess(const residue *r, double noise);
/* 1 if the residual is no more than noise, within the error of its estimate. */
int ss_residue_explains(const residue *r, double noise);
/* How much less than another leaves, in standard errors squared. */
double ss_residue_lead(const residue *r, const residue *other, double noise);
/* 1 if it explains the record, too, and leaves no more than another, to within the error. */
int ss_residue_equals(const residue *r, const residue *other, double noise);

/* A law that was fitted to a part of a record and judged by the rest; powers are parts of the record's. */
enum { BLOCKS = 24 };               /* of time, by whose scatter errors are found */
typedef struct candidate {
    const char *name;
    unsigned law, contains;         /* a bit of its own, and those of the laws that are limits of it */
    double left;                    /* where it was not fitted */
    const double *block;            /* the parts of this of each block, in units of the power */
    double fitted;                  /* left where it was fitted */
    double noise, rough;            /* bounds of the noise by that; rough: if it is the best law */
    double work;                    /* the part of the work that its force takes and does not give back */
    int tied;                       /* set: it is as good as the best, */
    double excess;                  /* and how many times the noise it leaves */
} candidate;

/* Find the answer; the first of the n candidates, simplest first, is the null, and another null, a spring of any
 * shape, stands behind them.  *best becomes the law that is named, or that explains most. */
ss_verdict ss_verdict_find(char *answer, size_t room, candidate c[], size_t n, double power, size_t *best);
/* The standard error of a sum over blocks, or of the difference of two; b may be NULL. */
double ss_verdict_error(const double a[BLOCKS], const double b[BLOCKS]);
/* Append a word to a list. */
void ss_verdict_append(char *text, size_t room, const char *word);

/* --- scenes, by several criteria ------------------------------------------------------------- */

/* A score is the distance over the threshold, at most SCORE_MOST.  If only one of signal and scene has the
 * number, the score is 1; if neither has it, 0.  The total is the sum of weight times score. */
typedef struct criterion_rule {
    const char *name, *unit;    /* "residual", "dB" */
    double threshold, weight;
} criterion_rule;
extern const criterion_rule ss_criterion_rules[SS_CRITERIA];
#define SCORE_MOST 3

/* Was anything compared? */
static inline int
is_compared(const ss_ranking *r)
{
    return r != NULL && !isnan(r->row[0].total);
}

/* The score of a row by one criterion. */
double ss_rank_score(const ss_rank_row *row, ss_criterion criterion);
/* Find the totals of the rows, and sort these by them. */
void ss_ranking_sort(ss_ranking *r);

#endif
