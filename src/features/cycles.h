/* cycles.h -- whether a signal repeats itself from cycle to cycle, and how regularly. */
#ifndef CYCLES_H
#define CYCLES_H

#include <stddef.h>
#include <stickslip/features.h>

typedef struct ss_cycles {
    ss_value period;            /* in samples; NaN: the signal does not repeat itself */
    ss_value frequency;         /* per sample */
    size_t n;                   /* cycles that hold energy */
    double likeness;            /* median correlation of a cycle with the next */
    double symmetry;            /* the same with the signal half a period later: -1 where the second
                                   half of a cycle mirrors the first */
    double overtones;           /* share of a cycle's power beyond its fundamental */
    int modulated;              /* 1: the cycles swell and fade in turn */
    const char *why;            /* there is no period; NULL where there is one */
} ss_cycles;

/* A cycle is accepted if it explains CYCLES_LIKE squared of the variance of the next. A caller who
 * knows from elsewhere that each cycle is an event may accept less, CYCLES_ALIKE. */
#define CYCLES_LIKE 0.95
#define CYCLES_ALIKE 0.70

/* The cycles of the n samples of x, each of which has at least the likeness to the next. */
ss_status ss_cycles_find(const double *x, size_t n, double likeness, ss_cycles *out);

#endif
