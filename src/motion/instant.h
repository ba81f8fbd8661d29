/* instant.h -- a time as an unevaluated sum of two doubles.
 *
 * At t = 1e6 s one double resolves 1e-10 s, which is 2e-9 rad of a 2.5 Hz base.  With two doubles,
 * the phase of the base and the position of a sample within a step keep their digits in long runs.
 */
#ifndef INSTANT_H
#define INSTANT_H

#include <math.h>

typedef struct instant {
    double hi, lo;                  /* |lo| <= ulp(hi) / 2 */
} instant;

static inline instant
instant_sum(double a, double b)     /* exact (Knuth, TAOCP 4.2.2) */
{
    double s = a + b, bb = s - a;
    return (instant){ s, (a - (s - bb)) + (b - bb) };
}

static inline instant
instant_add(instant t, double dt)
{
    instant s = instant_sum(t.hi, dt);
    return instant_sum(s.hi, s.lo + t.lo);
}

static inline double
instant_diff(instant a, instant b)
{
    return (a.hi - b.hi) + (a.lo - b.lo);
}

/* n / rate, to twice the digits of a double. */
static inline instant
instant_sample(double n, double rate)
{
    double hi = n / rate;
    return (instant){ hi, fma(-hi, rate, n) / rate };
}

/* The fraction, in [-1/2, 1/2], of the cycles that a frequency [Hz] has gone through at t. */
static inline double
instant_cycles(instant t, double frequency)
{
    double p = frequency * t.hi, e = fma(frequency, t.hi, -p) + frequency * t.lo;
    return (p - rint(p)) + e;
}

#endif
