/* oracle.h -- the motion of Coulomb and compliant scenes in closed form, in long double, and that of
 * state-variable scenes.
 *
 * Independent of the library: in the frame of the laboratory, between events, the motion is the sum of
 * a steady sinusoid, a line and what dies out, and so within a contact's gap and on either side of it;
 * events are found by scanning that sum in steps of 1/500
 * of its fastest period, with a look at every minimum between, and bisection to the last bit. */
#ifndef ORACLE_H
#define ORACLE_H

#include <stddef.h>
#include <stickslip.h>

enum { ALIKE = 2 };
typedef struct oracle_piece {       /* what holds from one event to the next */
    long double t0;                 /* [s] from the start of settling */
    int mode;                       /* 0 stick or microstick, else the sign of the slip */
    int side;                       /* of a contact's play: +1, -1, 0 in the gap; ALIKE: it has no sides */
    int is_event;                   /* 0: it begins where the contact goes from side to side */
    ss_event_kind kind;             /* of the event that it begins with */
    int direction;
    long double x_ref, belt;        /* x = x_ref + belt (t - t0) + q */
    long double c, k, f0, ramp;     /* m q'' + c q' + k q = swing - f0 + ramp (t - t0) */
    long double q0, v0, at_rest;    /* at t0; at_rest: q is the same throughout */
} oracle_piece;

typedef struct oracle {
    const ss_scene *scene;
    size_t n, room;
    oracle_piece *piece;            /* the first one is not an event if the scene starts in stick */
    int starts_with_event;
} oracle;

oracle *oracle_new(const ss_scene *scene, double t_end);
void oracle_at(const oracle *o, size_t piece, long double t, long double out[3]);    /* x, v, a */
void oracle_free(oracle *o);

/* The state-variable model has no closed form: x at n samples from t = 0, steps of which are good to
 * 1e-16 of its scale, by extrapolation (Gragg, Bulirsch, Stoer) of order 20 in long double. */
void oracle_smooth(const ss_scene *scene, size_t n, double x[]);

#endif
