/* decay.h -- an independent simulator of free decays, in long double.
 *
 * It has no code of the library and includes no header of it.  The motion
 *   x'' + 2 zeta w x' + quadratic x' |x'| + w^2 (x + sum over i of kappa_i z_i + drag sgn x') = 0
 * starts at rest at x = amplitude, all sliders loaded in that direction; z_i follows x between -d_i and d_i.
 * Between events, at which a slider slips or the motion turns, it is a damped oscillation about a constant:
 * closed forms.  Only the quadratic drag is integrated, by Runge and Kutta's steps of a 2000th of a period,
 * from turn to turn.  With friction (drag) the mass stops where the spring cannot move it. */
#ifndef DECAY_H
#define DECAY_H

#include <stddef.h>

enum { DECAY_SLIDERS = 200 };

typedef struct decay {
    long double w, amplitude;           /* [rad/s], [m] */
    long double zeta, quadratic, drag;  /* [1], [1/m], [m]: drag is the friction force over the stiffness */
    size_t sliders;
    long double kappa[DECAY_SLIDERS], d[DECAY_SLIDERS];     /* stiffness re the spring's [1]; [m] */
} decay;

typedef struct decay_turn {             /* x' = 0 */
    long double t, x;
} decay_turn;

/* x, x' and x'' (each may be NULL) of n samples, the i-th at i dt.  Returns the turns, to be freed, the start
 * among them; *turns is their number. */
decay_turn *decay_run(const decay *of, long double dt, size_t n, double *x, double *v, double *a, size_t *turns);
/* The frequency [Hz], the damping ratio and the amplitude at t, by a polynomial of fourth order through the
 * logarithms of the amplitudes of the turns, and through their times.  0: t is too near to an end. */
int decay_truth(const decay_turn *turn, size_t turns, long double t, double *f, double *zeta, double *amplitude);

#endif
