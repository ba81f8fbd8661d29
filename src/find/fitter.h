/* fitter.h -- what the parts of the fit of a damped oscillation share; see ringdown.c. */
#ifndef FITTER_H
#define FITTER_H

#include <math.h>
#include <stickslip/features.h>
#include "find/ringdown.h"
#include "find/window.h"

/* --- varpro.c: a damped oscillation fitted to windows; its linear parameters are projected out ----- */

/* What a window consists of, t samples behind an origin: m columns, which are a slow part (1, t, t^2,
 * t^3, or the forcing), exp(-s t) cos(w t) and exp(-s t) sin(w t); and t times these two, the derivatives,
 * behind them.  Columns behind these are 0. */
enum { VARPRO_COLUMNS = 8 };    /* the largest m is 6 */

/* Sums over samples of products: of columns with each other and with x, and of x with itself; x less
 * level. */
typedef struct varpro_sums {
    size_t origin, m;
    double level;
    double g[VARPRO_COLUMNS][VARPRO_COLUMNS], x[VARPRO_COLUMNS], xx;
} varpro_sums;

/* g = l l', l lower triangular; y = l^-1 x. */
typedef struct varpro_factor {
    size_t m;
    double l[VARPRO_COLUMNS][VARPRO_COLUMNS], y[VARPRO_COLUMNS];
} varpro_factor;

/* The first n rows of the columns, and, at regular places, the sums of products over all rows
 * before. */
typedef struct varpro_table {
    double w, s, forcing;
    int is_bent;
    size_t n;
    double (*row)[VARPRO_COLUMNS];
    double (*sum)[VARPRO_COLUMNS][VARPRO_COLUMNS];
} varpro_table;

typedef struct varpro {
    const double *x;
    /* these may be changed at any time: */
    double w, s;                /* of the oscillation, per sample */
    double forcing;             /* per sample: 1, cos, sin are the slow part; 0: 1 and t */
    int is_bent;                /* t^2 and t^3, or t beside the forcing, are in the slow part, too */
    /* computed for them: */
    varpro_table table;
    size_t factored;            /* length of the window whose factor is known; 0: none */
    varpro_factor factor;
} varpro;

/* J'J and J'r of a window, r the residual and J its derivatives by w and s. */
typedef struct normal {
    double ww, ws, ss, w, s;
} normal;

typedef struct linear {         /* the fit of the amplitudes to one window, or to several */
    size_t windows, samples;
    double whole;               /* sum of squares of the samples less the first */
    double rss;                 /* sum of squares of the residuals */
    double ring;                /* sum of squares that the oscillation explains */
    double a, b;                /* of cos and sin */
    normal normal;
} linear;

/* Prepare fits to windows of up to room samples of x, which stays the caller's. */
ss_status ss_varpro_init(varpro *v, const double *x, size_t room);
void ss_varpro_free(varpro *v);

/* m: the number of columns of the slow part and the oscillation. */
size_t ss_varpro_columns(const varpro *v);

/* Fit the amplitudes to a window of more samples than columns. */
linear ss_varpro_project(varpro *v, ss_window win);

/* Fit the amplitudes to all windows that are not empty: the sums over them; a and b are 0. */
linear ss_varpro_project_all(varpro *v, const ss_window *window, size_t n);

/* Begin sums of windows that begin at origin or behind it. */
void ss_varpro_sums_start(const varpro *v, size_t origin, varpro_sums *sums);

/* Add the sums of samples up to room behind the origin. */
void ss_varpro_sums_add(varpro *v, ss_window more, varpro_sums *sums);

/* The residual sum of squares of the same fit, by the sums. */
double ss_varpro_left(varpro_sums *sums);

/* to = the first n elements of l^-1 of. */
void ss_varpro_substitute(const varpro_factor *f, const double of[VARPRO_COLUMNS], double to[VARPRO_COLUMNS], size_t n);

/* What the derivatives by w and s are along the last two of the orthonormal columns that l^-1 makes. */
void ss_varpro_derivatives(const varpro_factor *f, double a, double b, double by_w[2], double by_s[2]);

/* Fit w and s to n windows, from their present values, to a relative tolerance.  1: the fit has converged. */
int ss_varpro_fit(varpro *v, const ss_window *window, size_t n, double tol);

/* --- all parts ---------------------------------------------------------------------------------- */

/* Lengths in periods of the oscillation. */
#define FIT_LEAST 2.0           /* shorter windows cannot separate oscillation, line and decay */
#define FIT_BLOCK 0.125         /* a step of growth, or of a search in a window */
#define FIT_TRIM_END 0.4        /* left out at the end found: a misfit not seen yet may hide there */

#define FIT_CHANCE 1e-3         /* probability that a test errs */
#define FIT_MISFIT 1e-3         /* part of the oscillation's amplitude: a misfit so small counts as noise */
enum { FIT_FEW = 4 };           /* windows that a jackknife needs */
#define FIT_FINE 1e-8           /* tolerance of the last fits */

typedef struct fitter {
    varpro fit;
    const ringdown *of;
    ss_window *window;          /* of each anchor */
    size_t n;                   /* anchors */
    double noise;               /* variance */
} fitter;

/* The samples in so many periods. */
static inline size_t
periods(const fitter *k, double n)
{
    return (size_t)ceil(n * (2 * M_PI / k->fit.w));
}

/* --- sticks.c: where a stick begins and ends, as the w, s and noise at hand show it ----------- */

/* Find the variance of the noise in the windows. */
ss_status ss_sticks_noise(fitter *k);

int ss_sticks_is_barred(const fitter *k, ss_window win);

/* The window of so many periods about an anchor in which the line and the oscillation leave least, among the
 * places that have at least a quarter of the largest oscillation. */
ss_window ss_sticks_place(fitter *k, size_t anchor, double size_in_periods);

/* Do the q samples that raise the sum of squares by rise belong to the stick? */
int ss_sticks_belong(const fitter *k, double rise, size_t q);

/* Grow windows about one of every so many cores, up to limit samples. */
void ss_sticks_grow(fitter *k, const ss_window *core, size_t every, size_t limit);

/* Cut all windows in two, so many samples behind their starts, and keep the parts that are longer in all,
 * trimmed at that place; 0: too little would be left, and they stay as they were. */
int ss_sticks_split(fitter *k, size_t at);

/* Trim both ends as growth found them; empty: the rest is shorter than the least length. */
ss_window ss_sticks_trim(const fitter *k, ss_window win);

/* --- slips.c: micro-slips too weak for any one window, and what rings behind the windows ------ */

/* What a chi-square of two degrees of freedom exceeds with this chance. */
static inline double
ss_chisq2(double chance)
{
    return -2 * log(chance);
}

/* Find where the gain changes most, so many samples behind the starts of the windows; *at becomes 0 if it does
 * not change. */
ss_status ss_slips_find(fitter *k, size_t *at);

/* Does the gain change once a period, as in a train of micro-slips? */
int ss_slips_recur(fitter *k);

/* Empty the windows whose own gains change most at a place: one window of up to 31. */
ss_status ss_slips_drop_worst(fitter *k, size_t at);

/* *is becomes 1 if it rings on behind the windows, or hums. */
ss_status ss_slips_ring_on(fitter *k, int *is);

#endif
