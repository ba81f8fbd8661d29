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
    [SS_BY_DAMPING]    = { "damping", "", 0.693, 1 },
    [SS_BY_JUMP]       = { "jump", "dB", 6, 1 },
    [SS_BY_SPIKES]     = { "spikes", "", 1, 1 },
    [SS_BY_SLOPE]      = { "slope", "dB/octave", 6, 1 },
    [SS_BY_STIFFNESS]  = { "stiffness", "N/m", 0.693, 1 },
    [SS_BY_MAP]        = { "map", "dB", 80. / 18, 0.25 },
};

double
ss_rank_score(const ss_rank_row *row, ss_criterion criterion, double factor)
{
    double d = row->distance[criterion];
    double threshold = factor * ss_criterion_rules[criterion].threshold;
    return isnan(d) ? 1 : fmin(d / threshold, SCORE_MOST);
}

static double
total(const ss_rank_row *row, ss_criterion moved, double factor)
{
    double sum = 0;
    for (int i = 0; i < SS_CRITERIA; i++)
        sum += ss_criterion_rules[i].weight
               * ss_rank_score(row, (ss_criterion)i, (ss_criterion)i == moved ? factor : 1);
    return sum;
}

static int
less_first(const void *a, const void *b)
{
    const ss_rank_row *p = a, *q = b;
    if (p->total != q->total)
        return p->total > q->total ? 1 : -1;
    return (p->scene > q->scene) - (p->scene < q->scene);
}

int
ss_ranking_order(const ss_ranking *ranking, ss_criterion criterion, double factor, size_t *order)
{
    int changed = 0;
    for (size_t i = 0; i < ranking->n; i++) {       /* insertion */
        double t = total(&ranking->row[i], criterion, factor);
        size_t k = i;
        while (k > 0 && total(&ranking->row[order[k - 1]], criterion, factor) > t) {
            order[k] = order[k - 1];
            k--;
        }
        order[k] = i;
    }
    for (size_t i = 0; i < ranking->n; i++)
        changed |= order[i] != i;
    return changed;
}

void
ss_ranking_sort(ss_ranking *r)
{
    for (size_t i = 0; i < r->n; i++)
        r->row[i].total = total(&r->row[i], SS_BY_RESIDUAL, 1);
    qsort(r->row, r->n, sizeof *r->row, less_first);
}
