/* period.h -- the time after which a signal repeats itself. */
#ifndef PERIOD_H
#define PERIOD_H

#include <stddef.h>
#include <stickslip/features.h>

/* In samples, with its standard error; NaN if nothing repeats twice in the record. */
ss_status ss_period_find(const double *x, size_t n, ss_value *period);

#endif
