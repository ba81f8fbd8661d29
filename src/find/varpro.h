/* varpro.h -- a damped oscillation fitted to windows of a signal; its linear
 * parameters are projected out. */
#ifndef VARPRO_H
#define VARPRO_H

#include <stddef.h>
#include <stickslip/status.h>
#include "find/window.h"

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

#endif
