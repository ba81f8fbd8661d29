/* fitter.h -- what the parts of the fit of a damped oscillation share; see ringdown.c. */
#ifndef FITTER_H
#define FITTER_H

#include <math.h>
#include <stickslip/features.h>
#include "find/ringdown.h"
#include "find/varpro.h"

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

/* --- errors.c: standard errors ---------------------------------------------------------------- */

/* The errors of the w and s of k, fitted to its windows. */
ss_status ss_errors_find(fitter *k, ss_value value[2]);

/* The errors of a fit from its curvature: those of white noise that leaves what it leaves. */
void ss_errors_by_curvature(const fitter *k, const linear *fit, ss_value value[2]);

#endif
