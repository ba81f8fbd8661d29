/* plan.h -- the tables that plan.c makes for fft.c, and the lock around FFTW's planner. */
#ifndef FFT_PLAN_H
#define FFT_PLAN_H

#include <fftw3.h>
#include <math.h>
#include <pthread.h>
#include <stddef.h>
#include "morlet/dense.h"
#include "morlet/kaiser.h"
#include "morlet/plan.h"

#define EDGE_MAX 0.45                /* of a kernel's band, in cycles a point */

enum {
    SPREAD_TAPS = 16,               /* of what brings samples to points that stand for several */
    APART = 16384,                  /* to this length FFTW is faster from one array to another */
    MARGIN = DENSE_MARGIN,          /* points before and after the circle that repeat it */
    KERNELS = 40, STEPS = 4         /* kernels for bands apart by 2^(1/STEPS) */
};

/* FFTW's planner is not safe for threads: making and freeing of plans, and wisdom, take turns.
 * Other users of FFTW in the program must not plan at the same time. */
extern pthread_mutex_t ss_fftw_planner;

/* A circle: its points, and how many samples a point stands for. */
typedef struct level {
    size_t points, samples;
    fftw_plan forward;
    size_t reach;                   /* samples that zeros allow a wavelet to reach beyond */
    size_t block;                   /* terms of the spectrum whose sizes are summed up together */
} level;

/* A scale is computed with the first cut, and again with the last unless the bound on its error lies
 * within the promise. */
enum { CUTS = 2 };

/* The way in which a scale is computed: not by FFT; at points of its series; or between them, at
 * positions that repeat or anywhere. */
typedef struct route {
    enum { BY_SUM, LATTICE, DENSE, ANYWHERE } kind;
    int level;
    size_t length;                  /* L */
    fftw_plan inverse;              /* owned by the list of them */
    const weights *weights[CUTS];   /* of those that are dense; owned likewise */
} route;

/* Weights that dense scales of one kernel and as many phases share. */
typedef struct shared_weights {
    const kaiser *kernel;
    size_t phases;
    weights *weights;
} shared_weights;

/* FFTW's plans of one length, which scales share. */
typedef struct inverse {
    size_t length;
    fftw_plan plan;
} inverse;

/* All of it, constant while scales are computed. */
struct fft {
    size_t n;                       /* samples */
    double rate;                    /* [Hz] */
    double center, second;          /* exp(-omega_c^2/2) if admissible, else 0 */
    double half[CUTS];              /* of the band, in 1/a */
    double images[CUTS];            /* of interpolation */
    level level[2];
    int levels;
    route *route;
    inverse *inverse;
    size_t n_inverse, longest;      /* longest of their lengths; 0: none */
    kaiser *kernel[CUTS][KERNELS];  /* NULL: none needed */
    double cost;                    /* of all that is done here, about [s] */
    int no_memory;                  /* for one of them */
    shared_weights *shared;
    size_t n_shared;
};

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

/* Samples around a circle. */
static inline size_t
circle_of(const level *lev)
{
    return lev->points * lev->samples;
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

static inline band
band_of(const struct fft *f, const level *lev, double a, double half)
{
    return band_around(f->center, half, a, f->rate, (double)circle_of(lev));
}

/* Cycles a point that the band reaches from its middle with L points. */
static inline double
edge_of(const band *b, size_t length)
{
    double most = (double)(b->hi - b->mid > b->mid - b->lo ? b->hi - b->mid : b->mid - b->lo);
    return most / (double)length;
}

/* Samples between the translations of a lattice. */
static inline double
step_of(const level *lev, const route *r)
{
    return (double)circle_of(lev) / (double)r->length;
}

/* The index of the kernel made in advance for this band, and the edge for which it is made. */
static inline int
kernel_index(double edge, double *made_for)
{
    int i = (int)floor(STEPS * log2(EDGE_MAX / edge) + 1e-9);
    i = i < 0 ? 0 : i < KERNELS ? i : KERNELS - 1;
    *made_for = EDGE_MAX * exp2(-(double)i / STEPS);
    return i;
}

/* The kernel that a scale needs with a cut. */
static inline kaiser *
kernel_of(const struct fft *f, const route *r, const band *b, int cut)
{
    double made_for;
    return f->kernel[cut][kernel_index(edge_of(b, r->length), &made_for)];
}

#endif
