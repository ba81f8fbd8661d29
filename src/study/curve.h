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

/* Over the longer of the two, the shorter being repeated. */
static inline curve_error
curve_compare(const double *x, size_t n_x, const double *ref, size_t n_ref)
{
    size_t n = n_x > n_ref ? n_x : n_ref;
    double max = curve_largest(ref, n_ref), largest = 0, squares = 0;
    for (size_t i = 0; i < n; i++) {
        double error = fabs(x[i % n_x] - ref[i % n_ref]);
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
