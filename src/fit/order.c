/* order.c -- scores of scenes by each criterion, and the order of their totals. */
#include "fit/order.h"

#include <math.h>
#include <stdlib.h>

/* A threshold is a difference that can be resolved, not one that was seen in some signal: twice the
 * power; the spread itself; one of two transitions; one wavelet bandwidth, 1/6 of the frequency; twice
 * the damping or stiffness; half the amplitude; one spike; one order of smoothness, jump to kink; one
 * contour. */
const criterion_rule ss_criterion_rules[SS_CRITERIA] = {
    [SS_BY_RESIDUAL]   = { "residual", "dB", 3, 1 },
    [SS_BY_ADJUSTMENT] = { "adjustment", "", 1, 1 },
    [SS_BY_MAXIMUM]    = { "maximum", "", 0.5, 1 },
    [SS_BY_FREQUENCY]  = { "frequency", "Hz", 0.154, 1 },
    [SS_BY_DAMPING]    = { "damping", "", M_LN2, 1 },
    [SS_BY_JUMP]       = { "jump", "dB", 6, 1 },
    [SS_BY_SPIKES]     = { "spikes", "", 1, 1 },
    [SS_BY_SLOPE]      = { "slope", "dB/octave", 6, 1 },
    [SS_BY_STIFFNESS]  = { "stiffness", "N/m", M_LN2, 1 },
    [SS_BY_MAP]        = { "map", "dB", 80. / 18, 0.25 },
};

double
ss_rank_score(const ss_rank_row *row, ss_criterion criterion)
{
    double d = row->distance[criterion];
    return isnan(d) ? 1 : fmin(d / ss_criterion_rules[criterion].threshold, SCORE_MOST);
}

static int
less_first(const void *a, const void *b)
{
    const ss_rank_row *p = a, *q = b;
    if (p->total != q->total)
        return p->total > q->total ? 1 : -1;
    return (p->scene > q->scene) - (p->scene < q->scene);
}

void
ss_ranking_sort(ss_ranking *r)
{
    for (size_t i = 0; i < r->n; i++) {
        r->row[i].total = 0;
        for (int k = 0; k < SS_CRITERIA; k++)
            r->row[i].total += ss_criterion_rules[k].weight * ss_rank_score(&r->row[i], (ss_criterion)k);
    }
    qsort(r->row, r->n, sizeof *r->row, less_first);
}
