/* event.c -- find when a guard becomes negative inside one step, if its derivatives are not known.
 * (If they are known, bernstein.c proves it.)
 *
 * A mode lasts while its guard is not negative.  To know the guard at a time s, the engine steps
 * again from the start of the step to s, so the guard is as accurate as the step.  (The cubic
 * through the ends of a step costs less, but limits event times to 1e-5 s with rk8pd; stepping
 * again gives 1e-13 s.)
 *
 * A guard that is negative at the end of the step has crossed 0.  A guard that falls at the start
 * and rises at the end has a minimum between, which may be negative: the signs at the two ends do
 * not show this pair of crossings.  The step caps (motion.h) allow no more than one minimum in a
 * step. */
#include "motion/event.h"

#include <math.h>

/* The width to which a bracket is halved, in units of the step.  Steps are at most 1/40 period long, and
 * over one of these the state is rounded to about 1e-16 of its size: a narrower bracket would be noise. */
#define EVENT_WIDTH 0x1p-50

/* Look for a negative guard in (0, *h), where the slope goes from falling to rising.  Returns 1 if
 * there is one; *h becomes its time.  The search ends early where the steeper of the two slopes
 * could not carry the guard down to 0 over the whole bracket. */
static int
dips_below(guard_fn *guard, void *user, guard_value at_0, guard_value at_h, double *h)
{
    double left = 0, right = *h, width = *h * EVENT_WIDTH;
    double steepest = fmax(-at_0.slope, at_h.slope);
    double lowest = fmin(at_0.g, at_h.g);

    while (right - left > width && lowest <= steepest * (right - left)) {
        double mid = left + (right - left) / 2;
        guard_value at = guard(mid, user);
        if (at.g < 0) {
            *h = mid;
            return 1;
        }
        lowest = fmin(lowest, at.g);
        if (at.slope < 0)
            left = mid;
        else
            right = mid;
    }
    return 0;
}

/* Narrow (lo, hi], with the guard negative at hi and not at lo, to the width; hi is the answer.
 *
 * Bisection, sped up by the slope that comes with every guard: each point is followed by its
 * Newton step, carried half a width past the root so that the bracket closes from both sides.  A
 * step that leaves the bracket, and every third one, is the middle: whatever the guard's shape,
 * the bracket is halved at least every third time. */
static double
close_bracket(guard_fn *guard, void *user, double lo, double hi, guard_value at_hi, double width)
{
    double from = hi;
    guard_value at = at_hi;
    for (int i = 1; hi - lo > width; i++) {
        double next = from - at.g / at.slope + (at.g < 0 ? -width / 2 : width / 2);
        if (i % 3 == 0 || !(next > lo && next < hi))
            next = lo + (hi - lo) / 2;
        from = next;
        at = guard(from, user);
        if (at.g < 0)
            hi = from;
        else
            lo = from;
    }
    return hi;
}

/* The first s in (0, h] at which the guard is negative.
 *
 * needs:  h > 0; at_0.g >= 0 but for rounding; at most one minimum inside
 * gives:  1 and *s_event, the late end of a bracket EVENT_WIDTH of the step wide: the guard has
 *         crossed there, so the next step cannot find the same event again; 0 if there is none
 * blind:  to a guard that starts at 0 and rises: the mode has just begun, even if rounding gave its
 *         guard a first slope below 0
 * cost:   about 8 guards an event, 150 at most; a few for a minimum that stays above 0 */
int
ss_event_find(guard_fn *guard, void *user, double h, guard_value at_0, guard_value at_h,
              double *s_event)
{
    double hi = h;
    int falls = at_0.g > 0 && at_0.slope < 0;

    if (!(at_h.g < 0)
        && !(falls && at_h.slope > 0 && dips_below(guard, user, at_0, at_h, &hi)))
        return 0;
    if (hi < h)
        at_h = guard(hi, user);
    *s_event = close_bracket(guard, user, 0, hi, at_h, h * EVENT_WIDTH);
    return 1;
}
