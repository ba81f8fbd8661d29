/* varpro.h -- a damped oscillation fitted to windows of a signal; its linear
 * parameters are projected out. */
#ifndef VARPRO_H
#define VARPRO_H

#include <stddef.h>
#include <stickslip/status.h>
#include "features/window.h"

enum { VARPRO_COLUMNS = 7, VARPRO_DERIVATIVES = 4 };

/* exp(-s t) cos(w t) and exp(-s t) sin(w t), t in samples, as many samples as were asked for yet. */
typedef struct wave {
    double w, s;                /* per sample */
    size_t n;
    double *cos, *sin;
} wave;

/* The orthonormal columns that are projected out of windows of n samples; the last two are the
 * oscillation's.  Windows of one length share it. */
typedef struct basis {
    size_t n, columns;          /* n is 0: none yet */
    double w, s, forcing, line;
    double *q[VARPRO_COLUMNS];
    double norm[VARPRO_COLUMNS], cross;        /* of a column less those before; of sin along cos */
} basis;

typedef struct varpro {
    const double *x;
    size_t room;                /* samples of the longest window */
    double w, s;                /* of the oscillation, per sample */
    double forcing;             /* per sample: 1, cos, sin are the slow part; 0: 1 and t */
    int is_cubic;               /* t^2 (of the line only) and t^3 are in the slow part, too */
    double line;                /* per sample: a steady line that each window has, too; 0: none */
    size_t columns;             /* of the slow part, the line and the oscillation */
    wave slow, steady, ring;    /* cos and sin of the forcing and the line; the oscillation */
    basis basis;
    double *r;                  /* the residual */
    double *j[VARPRO_DERIVATIVES];      /* its derivatives; two are by w and by s, two spare */
    size_t n_windows;           /* that are being fitted */
    const ss_window *window;
    double *memory;
} varpro;

typedef struct linear {         /* what projecting a window gave */
    double rss;                 /* sum of squares left */
    double ring;                /* sum of squares that the oscillation explains */
    double a, b;                /* of cos and sin */
} linear;

/* For windows of up to room samples, out of x, which stays the caller's. */
ss_status ss_varpro_init(varpro *v, const double *x, size_t room);
void ss_varpro_free(varpro *v);

/* Start from w and s; forcing: see above. */
void ss_varpro_start(varpro *v, double w, double s, double forcing);

/* Let the slow part bend as a cubic does, or no more. */
void ss_varpro_bend(varpro *v, int is_cubic);

/* Let each window have a steady line of this frequency per sample, too; 0: no more. */
void ss_varpro_add_line(varpro *v, double line);

/* Fit the amplitudes to a window of more samples than columns: makes the basis, fills r. */
linear ss_varpro_project(varpro *v, ss_window win);

/* The same, and the derivatives of r by w and by s into j[0] and j[1]. */
linear ss_varpro_derive(varpro *v, ss_window win);

/* Subtract from n samples of y the columns that were projected out last. */
void ss_varpro_project_out(const varpro *v, double *y, size_t n);

/* Fit w and s to n windows, from where they stand, to a relative tolerance.  *ok: they have
 * converged. */
ss_status ss_varpro_fit(varpro *v, const ss_window *window, size_t n, double tol, int *ok);

double ss_dot(const double *a, const double *b, size_t n);

#endif
