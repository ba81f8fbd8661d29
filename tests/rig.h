/* rig.h -- an independent simulator of forced rigs with dry friction, in long double.
 *
 * It has no code of the library and includes no header of it.  Between events the motion
 *   m x'' + D x' + K x = F + sum over h of k A_h cos(w_h t + p_h)
 * is a steady part for each harmonic h of the base, a constant, and what dies out.  Events are found by
 * scanning this sum in steps of 1/64 of the fastest period, with a look at each extremum between two
 * steps, and bisection.  Coulomb rigs stick truly; elastic contacts slip at K_y |y| = f_s (or, with
 * is_total, at |K_y y + c v| = f_s) and begin a stick with |y| = f_k / K_y. */
#ifndef RIG_H
#define RIG_H

#include <stddef.h>

enum { RIG_HARMONICS = 4 };

typedef struct rig {
    long double m, k, d;                /* mass, spring and damping of the rig [kg, N/m, N s/m] */
    long double f_k, f_s;               /* [N] f_s >= f_k */
    int is_elastic, is_total;           /* is_elastic: with a contact K_y, c */
    long double K_y, c;                 /* [N/m, N s/m] */
    int n_harmonics;                    /* of the base: A [m], f [Hz], p [rad] */
    long double A[RIG_HARMONICS], f[RIG_HARMONICS], p[RIG_HARMONICS];
} rig;

typedef struct rig_piece {              /* what holds from one event to the next */
    long double t;                      /* [s] its start */
    int mode;                           /* 0: stick or microstick, else the sign of the slip */
    long double K, D, F;                /* of the equation above; K < 0: x stands still */
    long double x, P, Q;                /* x: in a true stick; P, Q: of what dies out, re its start */
} rig_piece;

typedef struct rig_motion {
    rig of;
    size_t n, room;
    rig_piece *piece;
    long double end;                    /* [s] */
} rig_motion;

/* From rest at x = 0 to t = end.  0: more than `most` events, or a rig that is no oscillator. */
int rig_run(rig_motion *out, const rig *of, long double end, size_t most);
/* x, v, a and the friction force f = k (z - x) - d v - m a at t; *at is the piece found last, for the next call. */
void rig_at(const rig_motion *motion, long double t, size_t *at, double out[4]);
void rig_free(rig_motion *motion);

#endif
