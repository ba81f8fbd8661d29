/* hum.h -- steady lines in a signal that are no part of what repeats in it. */
#ifndef HUM_H
#define HUM_H

#include <stddef.h>
#include <stickslip/status.h>

typedef enum ss_hum {
    SS_HUM_NONE, SS_HUM_SUBTRACTED,
    SS_HUM_HIDDEN               /* there is one, but too near a harmonic of the cycle */
} ss_hum;

/* Subtract from the n samples of x the steady lines between half and one and a half times the frequency f
 * [per sample] that do not repeat with the period [samples].  None is sought in fewer than six periods.
 * None is subtracted from a part in which one is hidden. */
ss_status ss_hum_subtract(double *x, size_t n, double f, double period, ss_hum *found);

#endif
