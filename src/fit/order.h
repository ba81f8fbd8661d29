/* order.h -- the rows of a ranking: how scenes that are forced fill them, and their order. */
#ifndef ORDER_H
#define ORDER_H

#include <math.h>
#include <stickslip/rank.h>

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

/* forced_rank.c: rank the scenes of r's rows, whose base moves. */
ss_status ss_forced_compare(ss_ranking *r, const ss_signal *signal, size_t column, const ss_scene *scene,
                            const ss_rank_opts *opts, ss_error *err);

#endif
