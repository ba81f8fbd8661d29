/* bernstein.c -- prove when a guard first becomes negative inside one step, or that it does not.
 *
 * A mode lasts while its guard is not negative.  Inside a step the guard is a polynomial, its
 * Taylor series.  In Bernstein's form a polynomial has at most as many zeros as its
 * coefficients have changes of sign, and exactly one zero if they have one change (Descartes'
 * rule; G. Farin, Curves and Surfaces for CAGD, 4 and 5).  So no change proves that there is no
 * event, and one change proves that there is one.  If there are more, the step is divided by two,
 * and the earlier half is examined first.  So every event is found, however many lie in a step.
 *
 * Error: the rounding of the coefficients, 2^-50 of the largest coefficient and of the terms of the
 * guard's derivatives.  They are sums of Taylor coefficients, at most 27.  A coefficient
 * that is smaller than its rounding has no sign.  If only such coefficients are left, the guard
 * touches 0 and rounding decides; the result says so. */
#include "motion/bernstein.h"

#include <float.h>
#include <string.h>

/* After 25 halvings a curve that touches 0 is flat to rounding: n halvings bring the coefficients
 * nearer to the curve by 4^-n. */
enum { HALVINGS = 30 };

#define ROUNDING 0x1p-50

/* The shortest time to an event, in units of the step: time must go on. */
#define EVENT_WIDTH 0x1p-50

/* The coefficients c over the binomial coefficients are the differences at the start; their sums are the
 * coefficients in Bernstein's form. */
void
ss_guard_by_series(step_guard *g, int degree, const double c[])
{
    double binomial = 1, size = 0;
    g->degree = degree;
    for (int i = 0; i <= degree; i++) {
        g->p[i] = c[i] / binomial;
        size += fabs(c[i]);
        binomial *= (double)(degree - i) / (i + 1);
    }
    for (int k = degree; k > 0; k--)
        for (int j = k; j <= degree; j++)
            g->p[j] += g->p[j - 1];
    g->rounding += (MOST_DEGREE + 1) / 8. * size;       /* half an ulp is an eighth of 2^-50 */
}

/* p lies above the line from c_0 to c_0 + c_1 - sum of the other |c_i|.  If its end is above rounding,
 * here 2^-40 of all terms, there is no zero: most steps need no coefficients in Bernstein's form. */
int
ss_guard_is_clear(const step_guard *g, int degree, const double c[])
{
    double rest = 0, doubt = 0x1p-40 * (g->level + g->rounding + fabs(c[0]) + fabs(c[1]));
    for (int i = 2; i <= degree; i++)
        rest += fabs(c[i]);
    for (int side = 1; side >= (g->either_side ? -1 : 1); side -= 2) {
        double first = g->level + side * c[0], last = first + side * c[1] - rest;
        if (!(first >= 0 && last > doubt))
            return 0;
    }
    return 1;
}

/* The value at x and the derivative there, by de Casteljau's scheme. */
static double
value(const double b[], int degree, double x, double *slope)
{
    double c[MOST_DEGREE + 1];
    memcpy(c, b, (size_t)(degree + 1) * sizeof *c);
    for (int n = degree; n > 1; n--)
        for (int i = 0; i < n; i++)
            c[i] += x * (c[i + 1] - c[i]);
    *slope = degree * (c[1] - c[0]);
    return c[0] + x * (c[1] - c[0]);
}

/* The only change to negative in [0, 1]: by Newton's steps from where the coefficients change sign, and by
 * bisection where these leave the bracket.  Coefficients within rounding of 0 get the sign that a single
 * change requires. */
static double
only_zero(double b[], int degree, double error)
{
    enum { PASSES = 100 };
    double lo = 0, hi = 1;
    int i = 0;
    for (int j = 0; fabs(b[j]) <= error; j++)
        b[j] = fmax(b[j], 0);
    for (int j = degree; fabs(b[j]) <= error; j--)
        b[j] = fmin(b[j], 0);
    if (b[0] < 0)
        return 0;
    while (i < degree - 1 && !(b[i + 1] < -error))
        i++;
    double x = (i + fmax(b[i], 0) / (fmax(b[i], 0) - b[i + 1])) / degree;
    for (int pass = 0; pass < PASSES; pass++) {
        double slope, g = value(b, degree, x, &slope), next = x - g / slope;
        if (g < 0)
            hi = x;
        else
            lo = x;
        if (!(next >= lo && next <= hi))
            next = lo + (hi - lo) / 2;
        if (fabs(next - x) <= DBL_EPSILON)
            return next;
        x = next;
    }
    return hi;
}

/* The first x in [0, 1] after which b is negative; 0 if there is none.  At the start of a step b may
 * be 0. */
static int
first_zero(double b[], int degree, double error, int at_start, int halvings, double *x,
           int *unresolved)
{
    double left[MOST_DEGREE + 1], right[MOST_DEGREE + 1];
    int first = 0, last = 0, changes = 0, undecided = 0;    /* first: the sign of the first beyond rounding of 0 */
    int flat = 0;                       /* the guard may touch 0 after its start and before its end */
    for (int i = 0; i <= degree; i++) {
        int now = fabs(b[i]) <= error ? 0 : sign(b[i]);
        undecided = now == 0 ? undecided + 1 : 0;
        flat |= now == 0 && last > 0 && (i < degree || undecided > 1);
        changes += now != 0 && last != 0 && now != last;
        first = first == 0 ? now : first;
        last = now != 0 ? now : last;
    }
    if (changes == 0 && first >= 0 && !flat) {
        *unresolved |= first == 0 && !at_start;
        return 0;
    }
    if (changes == (first > 0)) {
        *x = only_zero(b, degree, error);
        return 1;
    }
    if (halvings == 0) {
        *unresolved = 1;
        *x = 1;
        return changes > 0;
    }
    memcpy(right, b, (size_t)(degree + 1) * sizeof *b);
    for (int n = degree; n >= 0; n--) {
        left[degree - n] = right[0];
        for (int i = 0; i < n; i++)
            right[i] = (right[i] + right[i + 1]) / 2;
    }
    if (first_zero(left, degree, error, at_start, halvings - 1, x, unresolved)) {
        *x /= 2;
        return 1;
    }
    if (!first_zero(right, degree, error, 0, halvings - 1, x, unresolved))
        return 0;
    *x = 0.5 + *x / 2;
    return 1;
}

/* The first s in (0, h] after which the guard is negative.
 *
 * needs:  h > 0; a guard that is not negative at 0 but for rounding
 * gives:  1 and *s_event, to about 4e-15 h; 0 if there is none; -1 if a number is not finite
 * blind:  to values within rounding of 0: a guard that starts there and rises belongs to a mode that
 *         has just begun; one that gets there later is *unresolved
 * cost:   the coefficients and their signs; halvings where there are two zeros or almost two; some
 *         five values of the polynomial an event */
int
ss_first_zero(const step_guard *g, double *s_event, int *unresolved)
{
    double b[MOST_DEGREE + 1], least = INFINITY, most = -INFINITY, sum = 0, x = 1;
    const double *p = g->p;
    for (int i = 0; i <= g->degree; i++) {
        least = p[i] < least ? p[i] : least;
        most = p[i] > most ? p[i] : most;
        sum += p[i];
    }
    double error = ROUNDING * (g->level + fmax(-least, most) + g->rounding);
    int found = 0;
    if (!isfinite(sum) || !isfinite(error))
        return -1;
    for (int side = 1; side >= (g->either_side ? -1 : 1); side -= 2) {
        double first, lowest = g->level + (side > 0 ? least : -most);
        if (lowest > error)
            continue;
        for (int i = 0; i <= g->degree; i++)
            b[i] = g->level + side * p[i];
        if (first_zero(b, g->degree, error, 1, HALVINGS, &first, unresolved)) {
            x = fmin(x, first);
            found = 1;
        }
    }
    *s_event = fmax(x, EVENT_WIDTH) * g->h;
    return found;
}
