/* cycles.h -- whether a signal repeats itself from cycle to cycle, and how regularly; what hums beside it. */
#ifndef CYCLES_H
#define CYCLES_H

#include <stddef.h>
#include <stickslip/features.h>

typedef struct ss_cycles {
    ss_value period;            /* in samples; NaN: the signal does not repeat itself */
    ss_value frequency;         /* per sample */
    size_t n;                   /* cycles with energy */
    double likeness;            /* median correlation of a cycle with the next */
    double lasting;             /* correlation of the record with itself 8 cycles later, or a quarter of it */
    double symmetry;            /* the same with the signal half a period later: -1 where the second
                                   half of a cycle mirrors the first */
    double wander;              /* relative error of times by a clock that wanders: the scatter of the cycles' lengths
                                   over the root of their number, if noise does not explain it; else 0 */
    double hum;                 /* frequency of one line that is nearly all that differs from cycle to cycle, per
                                   sample; 0: no line is */
    int modulated;              /* 1: the cycles swell and fade in turn */
    const char *why;            /* why there is no period; NULL: there is one */
} ss_cycles;

/* The median cycle explains CYCLES_LIKE squared of the variance of the next if nothing else says that the
 * signal repeats; CYCLES_ALIKE squared if each cycle is known to be an event. */
#define CYCLES_LIKE 0.95
#define CYCLES_UNLIKE 0.5         /* narrow noise, and ringing behind slips at random times, lasts less */
#define CYCLES_ALIKE 0.70

/* Find the cycles of the n samples of x, whose likeness must be at least CYCLES_ALIKE.  about: what their period was
 * in samples before; NaN: nothing repeated; 0: not known. */
ss_status ss_cycles_find(const double *x, size_t n, double about, ss_cycles *out);

/* The time after which n samples repeat themselves, in samples; NaN: nothing repeats twice. */
ss_status ss_period_find(const double *x, size_t n, double *period);

/* --- hum.c -------------------------------------------------------------------------------------- */

typedef enum ss_hum {
    SS_HUM_NONE, SS_HUM_SUBTRACTED,
    SS_HUM_HIDDEN               /* there is one, but too near a harmonic of the cycle */
} ss_hum;

/* Subtract from the n samples of x the steady lines between half and one and a half times the frequency f
 * [per sample] that do not repeat with the period [samples].  None is sought in fewer than six periods.
 * None is subtracted from a part in which one is hidden. */
ss_status ss_hum_subtract(double *x, size_t n, double f, double period, ss_hum *found);

#endif
