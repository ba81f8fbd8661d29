/* reversals.c -- the reversals of a force that goes to and fro, and what they tell of friction.
 *
 * From a break-away to the next reversal the force stays at a level, which is read as the median.
 * Friction is half of the step from one level to the next, so that a constant in the force does not
 * count.  If the force is at its level for less than half of the time, as the force of a spring or of
 * a viscous damper is, there is no friction.  A sine is at its level for 0.4 of the time: the level is
 * the median of the part beyond half of it, and at the level means above 0.95 of it.
 *
 * The force goes from level to level while friction holds.  The stiffness is the secant of this step
 * without a small part at either end, because levels are noisy and break-aways ring.  It includes what
 * gives way only in a part of the step, as backlash does. */
#include "find/search.h"

#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>
#include <string.h>
#include "find/medians.h"
#include "signal/gaps.h"

/* --- reversals ------------------------------------------------------------------------------- */

/* A half-cycle that the record begins in has broken away before.  A half-cycle reaches from where x
 * passes half of the level, to either side of the middle, to where it does so for the last time
 * before the other side: ringing may go farther. */
static ss_status
find_reversals(search *s, const double *x, double *copy)
{
    ss_features *out = s->out;
    ss_status st = ss_transitions_new(out, s->n / 2 + 1);
    int sign = 0, open = 0;
    size_t last = 0, high = 0;
    for (size_t i = 0; i < s->n; i++)
        copy[i] = fabs(x[i]);
    const double half = 0.5 * ss_quantile(copy, (ss_window){ 0, s->n }, 1 - OUTLIERS, copy);
    for (size_t i = 0; i < s->n; i++)   /* the level is the median of what is above half of the largest */
        if (fabs(x[i]) > half)
            copy[high++] = fabs(x[i]);
    const double level = high > 0 ? gsl_stats_select(copy, 1, high, high / 2) : 0;
    out->n = 0;
    out->reverses = 1;
    for (size_t i = 0; st == SS_OK && i < s->n; i++) {
        int side = x[i] > 0.5 * level ? 1 : x[i] < -0.5 * level ? -1 : 0;
        if (side != 0 && side == sign)
            last = i;
        if (side == 0 || side == sign)
            continue;
        if (open)
            out->transition[out->n++].end = (double)last / s->rate;
        size_t at = i;          /* the first extreme that x leaves by a slight part of the level */
        for (size_t k = i; k < s->n && side * x[k] > side * x[at] - SLIGHT * level; k++)
            at = side * x[k] > side * x[at] ? k : at;
        open = i > 0 && !ss_gaps_near(s->gap, s->n_gaps, (double)at / s->rate, 1 / s->rate);
        out->transition[out->n].onset = (double)at / s->rate;
        sign = side;
        last = i;
    }
    if (open)
        out->transition[out->n++].end = (double)last / s->rate;
    return st;
}

/* --- friction and stiffness ----------------------------------------------------------------- */

typedef struct plateau {
    ss_window slip;
    double level, spread;       /* spread: from the level to the quartile on the side of the other */
    int stays;
} plateau;

/* Find the passes.  Break-aways and ends of half-cycles are found at half of the level; what only loads the
 * force is cut off by the median of all. */
static plateau
find_plateau(const search *s, const ss_transition *t, int is_last, const double *x, double *copy)
{
    plateau p = { { (size_t)(t->onset * s->rate + 0.5), (size_t)(t->end * s->rate + 0.5) + 1 }, 0, 0, 0 };
    double time = (is_last ? t->end : t[1].onset) - t->onset, there = 0;
    int sign = x[p.slip.first] > 0 ? 1 : -1;
    double least = (1 - SLIGHT) * sign * ss_quantile(x, p.slip, 0.5, copy);
    while (p.slip.first > 0 && sign * x[p.slip.first - 1] >= least)     /* a level that rises breaks away late */
        p.slip.first--;
    while (sign * x[p.slip.first] < least)
        p.slip.first++;
    while (sign * x[p.slip.end - 1] < least)
        p.slip.end--;
    for (size_t i = p.slip.first; i < p.slip.end; i++)
        there += sign * x[i] >= least;
    p.stays = there > 0.5 * time * s->rate;
    p.level = ss_quantile(x, p.slip, 0.5, copy);
    p.spread = fabs(p.level - ss_quantile(x, p.slip, 0.5 - 0.25 * sign, copy));
    return p;
}

/* The value of z where x passes the goal between samples i - 1 and i. */
static double
at_goal(const double *z, const double *x, size_t i, double goal)
{
    return z[i - 1] + (goal - x[i - 1]) / (x[i] - x[i - 1]) * (z[i] - z[i - 1]);
}

/* The slope from a to b, without so much of the force at either end.  Its error is that of a sample at either end,
 * or of the displacement's least change. */
static ss_value
find_slope(const double *x, const double *z, double least, const plateau *a, const plateau *b,
           const double near[2])
{
    double sign = b->level > a->level ? 1 : -1, begin = a->level + sign * near[0], end = b->level - sign * near[1];
    size_t to = a->slip.end, from;
    while (to < b->slip.end && (x[to] - end) * sign < 0)
        to++;
    if (to == b->slip.end)
        return unknown;
    for (from = to; from > a->slip.first && (x[from - 1] - begin) * sign > 0; from--)
        ;
    if (from == a->slip.first || to - from < FEW)
        return unknown;
    double way = at_goal(z, x, to, end) - at_goal(z, x, from, begin), slope = fabs((end - begin) / way);
    double error = hypot(fmax(fabs(z[to] - z[to - 1]), least), fmax(fabs(z[from] - z[from - 1]), least));
    return (ss_value){ slope, slope * error / fabs(way) };
}

/* Friction and stiffness by the step from one plateau to the next; they stay as they are if there is none.  The
 * stiffness is the slope without a small part of the step at either end.  By how much it moves, if that part grows
 * by how far the levels spread, is in its error: where a level is not flat, the step has no clear end. */
static void
measure(const search *s, const double *x, const double least[2], size_t i, const plateau *p, ss_value *friction,
        ss_value *stiffness)
{
    const plateau *a = &p[i - 1], *b = &p[i];
    double from = s->out->transition[i - 1].onset, to = s->out->transition[i].onset;
    double size = fabs(b->level - a->level) / 2;
    double off = fmax((a->spread + b->spread) / 2, least[0] / sqrt(12));
    if (a->level * b->level >= 0 || !a->stays || !b->stays
        || ss_gaps_near(s->gap, s->n_gaps, 0.5 * (from + to), 0.5 * (to - from)))
        return;
    *friction = (ss_value){ s->largest * size, s->largest * off };
    if (s->opts->displacement < 0)
        return;
    const double part = 2 * SLIGHT * size, *z = s->signal->values + (size_t)s->opts->displacement * s->n;
    const ss_value slope = find_slope(x, z, least[1], a, b, (double[]){ part, part });
    const ss_value inner = find_slope(x, z, least[1], a, b, (double[]){ part + a->spread, part + b->spread });
    *stiffness = (ss_value){ s->largest * slope.value,
                             s->largest * hypot(slope.error, inner.value - slope.value) };
}

ss_status
ss_reversals_find(search *s, const double *x)
{
    ss_features *out = s->out;
    double *copy = malloc((s->n + 1) * sizeof *copy);
    ss_status st = copy != NULL ? find_reversals(s, x, copy) : SS_ENOMEM;
    size_t stay = 0, n = out->n;
    const double least[2] = { ss_smallest_change(x, s->n), s->opts->displacement < 0 ? 0
        : ss_smallest_change(s->signal->values + (size_t)s->opts->displacement * s->n, s->n) };
    plateau *p = malloc((n + 1) * sizeof *p);
    ss_value *friction = malloc(2 * (n + 1) * sizeof *friction), *stiffness = friction + n + 1;
    if (p == NULL || friction == NULL)
        st = SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < n; i++) {
        p[i] = find_plateau(s, &out->transition[i], i + 1 == n, x, copy);
        stay += (size_t)p[i].stays;
        friction[i] = stiffness[i] = unknown;
        if (i > 0)
            measure(s, x, least, i, p, &friction[i], &stiffness[i]);
    }
    if (st == SS_OK && 2 * stay > n) {
        const ss_number f = ss_median_of(friction, n, copy), k = ss_median_of(stiffness, n, copy);
        out->number[SS_FRICTION] = SIGMAS * f.error < f.value ? f : no_number;
        out->number[SS_LOADING_STIFFNESS] = SIGMAS * k.error < k.value ? k : no_number;
    }
    if (st == SS_OK && isnan(out->number[SS_FRICTION].value))
        say(out, SS_SLIPS, "between its reversals the force does not stay at a level, as friction does");
    free(p);
    free(friction);
    free(copy);
    return st;
}
