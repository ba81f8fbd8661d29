/* inertia.c -- whether a fall of a force is the slip of a mass or a relaxation without one.
 *
 * A mass accelerates and comes to rest, so the force of its spring begins and ends to fall without a
 * corner.  What has no mass falls with a corner at either end, along a line (a saw-tooth generator, a
 * switch behind a filter) or quickest at first (a discharge through a resistor).  Both are fitted to the
 * same samples, between loadings whose slopes are free on either side, as neither a stick nor a charge
 * need be straight:
 *
 *     slip          p(v) = (1 - cos((pi + 2 a) v - a) / cos a) / 2,  tan a = k U / (D w) of slip.c,
 *     relaxation    p(v) = v + b v (1 - v),  0 <= b < 1,
 *
 * where v goes from 0 to 1 between the corners and p is the part of the fall that is behind it.  The
 * relaxation has one parameter more, so that it wins where the samples cannot tell. */
#include "find/slip.h"

#include <math.h>
#include "base/least.h"

enum { ONSET, END, TOP, BOTTOM, BEFORE, BEHIND, BEND, PARAMETERS };
enum { MOST = 256 };                    /* samples: more are averaged */

typedef struct fall {
    size_t n;
    double u[MOST], y[MOST];    /* time and force over the length and the drop of the slip, from its onset */
    double lead;                /* a */
    int relaxes;
} fall;

static ss_status
model(const double *p, double *residual, double *slopes, void *user)
{
    const fall *f = user;
    (void)slopes;
    for (size_t i = 0; i < f->n; i++) {
        double u = f->u[i], v = (u - p[ONSET]) / (p[END] - p[ONSET]);
        if (u <= p[ONSET])
            residual[i] = p[TOP] + p[BEFORE] * (u - p[ONSET]) - f->y[i];
        else if (u >= p[END])
            residual[i] = p[BOTTOM] + p[BEHIND] * (u - p[END]) - f->y[i];
        else {
            double fallen = f->relaxes ? v + p[BEND] * v * (1 - v)
                : 0.5 * (1 - cos((M_PI + 2 * f->lead) * v - f->lead) / cos(f->lead));
            residual[i] = p[TOP] - (p[TOP] - p[BOTTOM]) * fallen - f->y[i];
        }
    }
    return p[END] > p[ONSET] ? SS_OK : SS_EDATA;
}

ss_status
ss_inertia_sign(int *sign, const double *x, ss_window room, const ss_slip *slip, double loading)
{
    const ss_range free = { -INFINITY, INFINITY };
    const ss_range range[PARAMETERS] = { free, free, free, free, free, free, { 0, 1 } };
    const double step[PARAMETERS] = { 1e-7, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7, 1e-7 };
    double onset = slip->onset.value, length = slip->end.value - onset, drop = slip->drop.value;
    double slope = loading * length / drop, left[2];
    fall f = { .lead = atan(loading / ((slip->top.value - slip->middle.value) * sqrt(slip->k_over_m.value))) };
    /* from half a slip before it to half a slip behind it */
    size_t first = (size_t)fmax((double)room.first, onset - length / 2);
    size_t end = (size_t)fmin((double)room.end, slip->end.value + length / 2 + 1), each = (end - first) / MOST + 1;
    f.n = (end - first) / each;
    for (size_t i = 0; i < f.n; i++) {
        double mean = 0;
        for (size_t k = first + i * each; k < first + (i + 1) * each; k++)
            mean += x[k] / (double)each;
        f.u[i] = ((double)(first + i * each) + 0.5 * (double)(each - 1) - onset) / length;
        f.y[i] = (mean - slip->top.value) / drop;
    }
    *sign = 0;
    if (f.n <= PARAMETERS)
        return SS_OK;
    for (f.relaxes = 0; f.relaxes < 2; f.relaxes++) {
        double corner = f.relaxes ? 0.25 : 0;   /* the corners of a relaxation lie inside the slip's */
        double p[PARAMETERS] = { corner, 1 - corner, 0, -1, slope, slope, 0.5 };
        least_end ended;
        ss_status st = ss_least_fit(&ended, &(least){ .rows = f.n, .unknowns = f.relaxes ? PARAMETERS : BEND,
                                                      .model = model, .user = &f, .range = range,
                                                      .difference = step, .tol = 1e-6 },
                                    p, NULL, NULL);
        if (st != SS_OK)
            return st;
        left[f.relaxes] = ended.squares;
    }
    *sign = (left[0] < left[1]) - (left[0] > left[1]);
    return SS_OK;
}
