/* reversals.c -- see reversals.h.
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
#include "find/reversals.h"

#include <gsl/gsl_statistics_double.h>
#include <stdlib.h>
#include <string.h>
#include "find/medians.h"
#include "signal/gaps.h"

#define NEAR 0.05               /* part of the step, or of a level, within which a sample is near it */
#define STAYS 0.5               /* the least part of the time from one break-away to the next at or above the
                                   level */
#define SAMPLES 3               /* the fewest samples on the way */

typedef struct plateau {
    ss_window slip;
    double level, quartile;     /* quartile: on the side of the other level */
    int stays;
} plateau;

static double
select(const double *x, ss_window w, double part, double *copy)
{
    size_t n = ss_window_length(w);
    memcpy(copy, x + w.first, n * sizeof *copy);
    return gsl_stats_select(copy, 1, n, (size_t)(part * (double)(n - 1)));
}

/* Find the passes.  Break-aways and ends of half-cycles are found at half of the level; what only loads the
 * force is cut off by the median of all. */
static plateau
find_plateau(const search *s, const ss_transition *t, int is_last, const double *x, double *copy)
{
    plateau p = { { (size_t)(t->onset * s->rate + 0.5), (size_t)(t->end * s->rate + 0.5) + 1 }, 0, 0, 0 };
    double time = (is_last ? t->end : t[1].onset) - t->onset, there = 0;
    int sign = x[p.slip.first] > 0 ? 1 : -1;
    double least = (1 - NEAR) * sign * select(x, p.slip, 0.5, copy);
    while (p.slip.first > 0 && sign * x[p.slip.first - 1] >= least)     /* a level that rises breaks away late */
        p.slip.first--;
    while (sign * x[p.slip.first] < least)
        p.slip.first++;
    while (sign * x[p.slip.end - 1] < least)
        p.slip.end--;
    for (size_t i = p.slip.first; i < p.slip.end; i++)
        there += sign * x[i] >= least;
    p.stays = there > STAYS * time * s->rate;
    p.level = select(x, p.slip, 0.5, copy);
    p.quartile = select(x, p.slip, sign > 0 ? 0.25 : 0.75, copy);
    return p;
}

/* The value of z where x passes the goal between samples i - 1 and i. */
static double
at_goal(const double *z, const double *x, size_t i, double goal)
{
    return z[i - 1] + (goal - x[i - 1]) / (x[i] - x[i - 1]) * (z[i] - z[i - 1]);
}

/* The slope from a to b.  Its error is that of a sample at either end. */
static ss_value
find_stiffness(const double *x, const double *z, const plateau *a, const plateau *b)
{
    double step = b->level - a->level, begin = a->level + NEAR * step, end = b->level - NEAR * step;
    size_t to = a->slip.end, from;
    while (to < b->slip.end && (x[to] - end) * step < 0)
        to++;
    if (to == b->slip.end)
        return unknown;
    for (from = to; from > a->slip.first && (x[from - 1] - begin) * step > 0; from--)
        ;
    if (from == a->slip.first)
        return unknown;
    double way = at_goal(z, x, to, end) - at_goal(z, x, from, begin);
    double stiffness = fabs((1 - 2 * NEAR) * step / way);
    double error = hypot(z[to] - z[to - 1], z[from] - z[from - 1]) / fabs(way);
    return to - from >= SAMPLES && error < 1.0 / SAMPLES
        ? (ss_value){ stiffness, stiffness * error } : unknown;
}

static void
measure(const search *s, const double *x, const plateau *p, ss_value *friction, ss_value *stiffness)
{
    for (size_t i = 1; i < s->out->n; i++) {
        const plateau *a = &p[i - 1], *b = &p[i];
        double from = s->out->transition[i - 1].onset, to = s->out->transition[i].onset;
        double size = fabs(b->level - a->level) / 2;
        double off = (fabs(a->level - a->quartile) + fabs(b->level - b->quartile)) / 2;
        if (a->level * b->level >= 0 || !a->stays || !b->stays
            || ss_gaps_near(s->gap, s->n_gaps, 0.5 * (from + to), 0.5 * (to - from)))
            continue;
        friction[i] = (ss_value){ s->largest * size, s->largest * off };
        if (s->opts->displacement < 0)
            continue;
        stiffness[i] = find_stiffness(x, s->signal->values + (size_t)s->opts->displacement * s->n, a, b);
        stiffness[i].value *= s->largest;
        stiffness[i].error *= s->largest;
    }
}

static ss_number
known_median(const ss_value *v, size_t n, double *scratch)
{
    ss_number m = ss_median_of(v, n, scratch);
    return 3 * m.error < m.value ? m : no_number;
}

ss_status
ss_reversals_measure(search *s, const double *x)
{
    ss_features *out = s->out;
    size_t stay = 0;
    plateau *p = malloc((out->n + 1) * sizeof *p);
    ss_value *v = malloc((2 * out->n + 1) * sizeof *v);
    double *copy = malloc((s->n + 1) * sizeof *copy);
    ss_status st = p != NULL && v != NULL && copy != NULL ? SS_OK : SS_ENOMEM;
    for (size_t i = 0; st == SS_OK && i < out->n; i++) {
        p[i] = find_plateau(s, &out->transition[i], i + 1 == out->n, x, copy);
        stay += (size_t)p[i].stays;
        v[i] = v[out->n + i] = unknown;
    }
    out->reverses = st == SS_OK;
    if (st == SS_OK && 2 * stay > out->n) {
        measure(s, x, p, v, v + out->n);
        out->number[SS_FRICTION] = known_median(v, out->n, copy);
        out->number[SS_LOADING_STIFFNESS] = known_median(v + out->n, out->n, copy);
    }
    if (st == SS_OK && isnan(out->number[SS_FRICTION].value))
        say(out, SS_SLIPS, "between its reversals the force does not stay at a level, as friction does");
    free(p);
    free(v);
    free(copy);
    return st;
}
