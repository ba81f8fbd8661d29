/* plan.h -- the flags of FFTW's planner, and the terms of the series that a scale is. */
#ifndef FFT_PLAN_H
#define FFT_PLAN_H

#include <fftw3.h>
#include <math.h>
#include <stddef.h>
#include "base/fft.h"
#include "map/plan.h"

/* The terms of the spectrum that a scale consists of. */
typedef struct band {
    double h, h_low;                /* v_k = k h - omega_c */
    ptrdiff_t lo, mid, hi;          /* k */
} band;

/* FFTW's flag for a planner. */
static inline unsigned
flag_of(ss_planner planner)
{
    static const unsigned flags[] = { FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT };
    return flags[planner];
}

/* The distance from omega_c to either end of a band that has |v| <= reach.  The admissible wavelet has
 * a hump about v = -omega_c, which must be inside, too. */
static inline double
half_band(double center, double second, double reach)
{
    return second > 0 && reach > center ? center + sqrt(reach * reach - center * center) : reach;
}

/* The terms |v| <= half of a circle of so many samples.  h in two parts: k h is needed to the last
 * bit where k is large. */
static inline band
band_around(double center, double half, double a, double rate, double points)
{
    const double two_pi = 6.2831853071795865, two_pi_low = 2.4492935982947064e-16;
    double p = a * rate, p_low = fma(a, rate, -p);
    double s = two_pi * p, s_low = fma(two_pi, p, -s) + two_pi * p_low + two_pi_low * p;
    band b = { .h = s / points };
    b.h_low = (fma(-b.h, points, s) + s_low) / points;
    b.lo = (ptrdiff_t)ceil((center - half) / b.h);
    b.mid = (ptrdiff_t)rint(center / b.h);
    b.hi = (ptrdiff_t)floor((center + half) / b.h);
    return b;
}

/* Cycles a point that the band reaches from its middle with L points. */
static inline double
edge_of(const band *b, size_t length)
{
    double most = (double)(b->hi - b->mid > b->mid - b->lo ? b->hi - b->mid : b->mid - b->lo);
    return most / (double)length;
}

#endif
