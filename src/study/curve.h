/* curve.h -- the distance of one curve from another, in units of the other's largest value. */
#ifndef CURVE_H
#define CURVE_H

#include <math.h>
#include <stddef.h>

static inline double
curve_largest(const double *x, size_t n)
{
    double max = 0;
    for (size_t i = 0; i < n; i++)
        max = fmax(max, fabs(x[i]));
    return max;
}

/* The largest and the root mean square error of n values. */
typedef struct curve_error {
    double largest, rms;
} curve_error;

static inline curve_error
curve_compare(const double *x, const double *ref, size_t n)
{
    double max = curve_largest(ref, n), largest = 0, squares = 0;
    for (size_t i = 0; i < n; i++) {
        double error = fabs(x[i] - ref[i]);
        largest = fmax(largest, error);
        squares += error / max * (error / max);
    }
    if (largest == 0)                   /* also where nothing moves */
        return (curve_error){ 0, 0 };
    if (max == 0)
        return (curve_error){ NAN, NAN };
    return (curve_error){ largest / max, sqrt(squares / (double)n) };
}

#endif
